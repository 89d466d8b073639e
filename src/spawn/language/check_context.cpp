// An IfCollides waits for every Collider with its tag, so none of these may come after it: neither along edges nor by
// way of other tags.
#include "spawn/language/check_context.h"

#include "spawn/graph/export_labels.h"
#include "spawn/graph/partition.h"

#include <algorithm>

namespace gpgp::spawn {
namespace {
using namespace shader;

class ContextCheck {
public:
  ContextCheck(const Graph& graph, std::span<const NodePlace> places, std::span<const GrammarPart> parts)
      : graph_(graph), places_(places), parts_(parts) {}

  void checkOrder() {
    if (graph_.phases == kNoPhases) refusePhases();
  }
  void checkEffect() {
    for (uint32_t n = 0; n < graph_.nodes.size(); ++n) {
      const Node& node = graph_.nodes[n];
      const bool collider = node.op == kOpCollider;
      const uint32_t other = collider ? kOpIfCollides : kOpCollider;
      if (!isContext(node.op) || std::any_of(graph_.nodes.begin(), graph_.nodes.end(), [&](const Node& o) {
            return o.op == other && o.argument == node.argument &&
                   (collider ? node.priority >= o.priority : o.priority >= node.priority);
          }))
        continue;
      warn(n, other);
    }
  }

private:
  Diagnostics& diagnosticsOf(uint32_t node) const { return *parts_[places_[node].part].diagnostics; }
  /// As a message at another node says it.
  std::string where(uint32_t node, uint32_t from) const {
    const std::string text = diagnosticsOf(node).where(places_[node].place);
    const uint32_t part = places_[node].part;
    return part == places_[from].part ? text : text + " of " + parts_[part].file;
  }

  void warn(uint32_t n, uint32_t other) {
    const std::string tag = std::string("(").append(tagText(graph_, graph_.nodes[n].argument)).append(")");
    const bool is = std::any_of(graph_.nodes.begin(), graph_.nodes.end(),
                                [&](const Node& o) { return o.op == other && o.argument == graph_.nodes[n].argument; });
    const char* priority = !is                    ? ""
                           : other == kOpCollider ? " of its priority or a higher one"
                                                  : " of its priority or a lower one";
    diagnosticsOf(n).warning(places_[n].place, operatorName(graph_.nodes[n].op) + tag + " has no effect: there is no " +
                                                   operatorName(other) + tag + priority);
  }
  std::string named(uint32_t n) const {
    const Node& node = graph_.nodes[n];
    return std::string(operatorName(node.op)).append("(").append(tagText(graph_, node.argument)) + ") of priority " +
           std::to_string(node.priority);
  }
  void refuse(const Dependency& d) {
    if (graph_.nodes[d.source].priority > graph_.nodes[d.target].priority) {
      diagnosticsOf(d.target).error(places_[d.target].place, named(d.target) + " waits for " + named(d.source) +
                                                                 " in " + where(d.source, d.target) +
                                                                 ", which comes after it");
      return;
    }
    const std::string tag = std::string("(").append(tagText(graph_, graph_.nodes[d.target].argument)).append(")");
    diagnosticsOf(d.target).error(places_[d.target].place, "IfCollides" + tag + " waits for all of Collider" + tag +
                                                               " in " + where(d.source, d.target) +
                                                               ", which comes after it");
  }

  void refusePhases() {
    const std::vector<Dependency> dependencies = dependenciesOf(graph_);
    bool found = false;
    for (uint32_t n = 0; n < graph_.nodes.size(); ++n) {
      if (!isContext(graph_.nodes[n].op)) continue;
      std::vector<bool> reached(graph_.nodes.size());
      std::vector<uint32_t> open{n};
      const auto reach = [&](uint32_t node) {
        if (node == kNoNode || reached[node]) return;
        reached[node] = true;
        open.push_back(node);
      };
      while (!open.empty()) {
        const uint32_t from = open.back();
        open.pop_back();
        for (uint32_t e = 0; e < graph_.nodes[from].edgeCount; ++e)
          reach(graph_.edges[graph_.nodes[from].firstEdge + e].target);
        for (const Dependency& d : dependencies)
          if (d.source == from) reach(d.target);
      }
      for (const Dependency& d : dependencies) {
        if (d.target != n || !reached[d.source]) continue;
        refuse(d);
        found = true;
        break;
      }
    }
    for (uint32_t n = 0; !found && n < graph_.nodes.size(); ++n)
      if (graph_.nodes[n].op == kOpIfCollides && graph_.nodes[n].argument2 + 1 == kMaxPhases) {
        diagnosticsOf(n).error(places_[n].place, "IfCollides and Collider wait for each other in more than " +
                                                     std::to_string(kMaxPhases) + " phases");
        found = true;
      }
  }

  const Graph& graph_;
  std::span<const NodePlace> places_;
  std::span<const GrammarPart> parts_;
};
} // namespace

void checkOrder(const Graph& graph, std::span<const NodePlace> places, std::span<const GrammarPart> parts) {
  ContextCheck(graph, places, parts).checkOrder();
}

void checkEffect(const Graph& graph, std::span<const NodePlace> places, std::span<const GrammarPart> parts) {
  ContextCheck(graph, places, parts).checkEffect();
}

} // namespace gpgp::spawn
