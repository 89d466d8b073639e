// The drawing has two levels: nodes are laid out within their group, then groups as boxes. Static edges stay inside a
// group's box; a dynamic edge leaves it at the lower side and enters another at the root, which is on top.
#include "spawn/graph/export.h"
#include "spawn/graph/export_labels.h"
#include "spawn/graph/export_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace gpgp::spawn {
namespace {
using namespace shader;

constexpr double kCharacter = 6.6, kRow = 17, kPad = 8, kGroupPad = 12, kNodeGap = 26, kGroupGap = 44, kMargin = 16;
constexpr size_t kLongest = 36; // characters; the whole text is in the tooltip

std::string shortened(const std::string& text) {
  return text.size() <= kLongest ? text : text.substr(0, kLongest - 1) + "\u2026";
}
size_t lengthOf(const std::string& text) { // of UTF-8
  return static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) switch (c) {
    case '<': result += "&lt;"; break;
    case '>': result += "&gt;"; break;
    case '&': result += "&amp;"; break;
    case '"': result += "&quot;"; break;
    default: result += c;
    }
  return result;
}

/// A node as drawn: its label, and below it a cell for each edge.
struct Card {
  std::string label, title;
  struct Cell {
    std::string text, title;
    double offset = 0, width = 0; // of its centre from the card's
  };
  std::vector<Cell> cells;
  double width = 0, height = 0;
  const char* stroke = "#444";

  void measure() {
    double row = 0;
    for (Cell& cell : cells) {
      cell.width = kCharacter * static_cast<double>(lengthOf(cell.text)) + kPad;
      row += cell.width;
    }
    width = std::max(kCharacter * static_cast<double>(lengthOf(label)) + 2 * kPad, row);
    double x = -width / 2;
    for (Cell& cell : cells) {
      cell.width *= width / row;
      cell.offset = x + cell.width / 2;
      x += cell.width;
    }
    height = kRow * (cells.empty() ? 1 : 2) + 6;
  }
};

Card cardOf(const Graph& graph, const Node& node) {
  Card card;
  card.title = nodeText(graph, node);
  card.label = shortened(card.title);
  for (uint32_t e = 0; e < node.edgeCount; ++e) {
    const bool discarded = graph.edges[node.firstEdge + e].target == kNoNode;
    const std::string value = edgeValueText(graph, node, e);
    Card::Cell cell;
    cell.title = value + (value.empty() ? "" : ": ") + multiplicityText(graph, node, e) + (discarded ? " Discard" : "");
    cell.text =
        shortened(value) + (value.empty() ? "" : ": ") + (discarded ? "\u00d7" : multiplicityText(graph, node, e));
    card.cells.push_back(cell);
  }
  if (node.op == kOpTerminal) card.stroke = "#e08214";
  card.measure();
  return card;
}

/// Nodes that are drawn in one box. Links within are laid out inside; those that leave have an exit.
struct Unit {
  std::vector<uint32_t> nodes;
  bool isGroup = false;
  Layout layout;             // the nodes' boxes, then one for each exit
  std::vector<Link> inside;  // as layout.edges, before the exits
  std::vector<Link> leaving; // as the exits
  double padding() const { return isGroup ? kGroupPad : 0; }
};

class Drawing {
public:
  Drawing(const Graph& graph, const Partition* partition) : graph_(graph), partition_(partition) {
    for (const Node& node : graph.nodes) cards_.push_back(cardOf(graph, node));
    for (const Axiom& axiom : graph.axioms) { // as nodes with numbers from graph.nodes.size() on
      Card start;
      start.title = start.label = axiomText(graph, axiom);
      start.cells.push_back({"*", "any number of axioms"});
      start.stroke = "#2166ac";
      start.measure();
      cards_.push_back(start);
    }
    makeUnits();
    for (Unit& unit : units_) layOutUnit(unit);
    layOutUnits();
  }

  std::string run() {
    const double width = outer_.width + 2 * kMargin, height = outer_.height + 2 * kMargin + kGroupGap;
    out_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << std::ceil(width) << "\" height=\""
         << std::ceil(height) << "\" viewBox=\"" << -kMargin << ' ' << -kMargin - kGroupGap / 2 << ' '
         << std::ceil(width) << ' ' << std::ceil(height)
         << "\" font-family=\"DejaVu Sans, Arial, sans-serif\" font-size=\"11\">\n"
         << "<rect x=\"" << -kMargin << "\" y=\"" << -kMargin - kGroupGap / 2
         << "\" width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    for (size_t u = 0; u < units_.size(); ++u) drawGroup(u);
    for (size_t u = 0; u < units_.size(); ++u) drawInside(u);
    drawBetween();
    for (size_t u = 0; u < units_.size(); ++u) drawCards(u);
    for (const Dependency& d : dependenciesOf(graph_)) drawDependency(d);
    out_ << "</svg>\n";
    return out_.str();
  }

private:
  void makeUnits() {
    unitOf_.assign(cards_.size(), 0);
    const auto add = [&](std::vector<uint32_t> nodes, bool isGroup) {
      for (const uint32_t n : nodes) unitOf_[n] = static_cast<uint32_t>(units_.size());
      Unit unit;
      unit.nodes = std::move(nodes);
      unit.isGroup = isGroup;
      units_.push_back(std::move(unit));
    };
    for (uint32_t n = static_cast<uint32_t>(graph_.nodes.size()); n < cards_.size(); ++n) add({n}, false);
    const Flow flow = makeFlow(graph_);
    if (partition_)
      for (const Group& group : partition_->groups) add(group.nodes, true);
    else if (!flow.order.empty())
      add(flow.order, false);
    for (uint32_t n = 0; n < graph_.nodes.size(); ++n)
      if (flow.rank[n] == kNoNode) add({n}, false);
  }

  std::vector<Link> linksOf(uint32_t n) const {
    std::vector<Link> links;
    if (n >= graph_.nodes.size()) {
      const uint32_t target = graph_.axioms[n - graph_.nodes.size()].node;
      if (target != kNoNode) links.push_back({kNoEdge, n, 0, target, kMultiplicityAny});
      return links;
    }
    const Node& node = graph_.nodes[n];
    for (uint32_t slot = 0; slot < node.edgeCount; ++slot) {
      const Edge& edge = graph_.edges[node.firstEdge + slot];
      if (edge.target != kNoNode) links.push_back({node.firstEdge + slot, n, slot, edge.target, edge.multiplicity});
    }
    return links;
  }
  bool isStatic(const Link& link) const {
    return partition_ && unitOf_[link.source] == unitOf_[link.target] && !partition_->isRoot(link.target);
  }

  void layOutUnit(Unit& unit) {
    std::vector<uint32_t> boxOf(cards_.size(), 0);
    for (uint32_t i = 0; i < unit.nodes.size(); ++i) {
      boxOf[unit.nodes[i]] = i;
      unit.layout.boxes.push_back({cards_[unit.nodes[i]].width, cards_[unit.nodes[i]].height});
    }
    for (const uint32_t n : unit.nodes)
      for (const Link& link : linksOf(n)) {
        const bool stays = unit.isGroup ? isStatic(link) : unitOf_[link.target] == unitOf_[n];
        (stays ? unit.inside : unit.leaving).push_back(link);
      }
    for (const Link& link : unit.inside)
      unit.layout.edges.push_back(
          {boxOf[link.source], boxOf[link.target], cards_[link.source].cells[link.slot].offset});
    for (const Link& link : unit.leaving) {
      const uint32_t exit = static_cast<uint32_t>(unit.layout.boxes.size());
      unit.layout.boxes.push_back({2, 0, true});
      unit.layout.edges.push_back({boxOf[link.source], exit, cards_[link.source].cells[link.slot].offset});
    }
    spreadEntries(unit.layout,
                  [&](uint32_t box) { return box < unit.nodes.size() ? cards_[unit.nodes[box]].width : 0; });
    unit.layout.gap = kNodeGap;
    unit.layout.run();
  }

  /// Edges into one box enter side by side.
  template <class WidthOf> static void spreadEntries(Layout& layout, WidthOf&& widthOf) {
    std::vector<std::vector<LayoutEdge*>> into(layout.boxes.size());
    for (LayoutEdge& edge : layout.edges) into[edge.to].push_back(&edge);
    for (uint32_t box = 0; box < into.size(); ++box) {
      const double count = static_cast<double>(into[box].size());
      const double step = std::min(9.0, widthOf(box) * 0.8 / std::max(count, 1.0));
      double x = -step * (count - 1) / 2;
      for (LayoutEdge* edge : into[box]) {
        edge->toOffset += x;
        x += step;
      }
    }
  }

  void layOutUnits() {
    for (const Unit& unit : units_)
      outer_.boxes.push_back({unit.layout.width + 2 * unit.padding(), unit.layout.height + 2 * unit.padding()});
    for (uint32_t u = 0; u < units_.size(); ++u) {
      const Unit& unit = units_[u];
      for (size_t i = 0; i < unit.leaving.size(); ++i) {
        const uint32_t target = unitOf_[unit.leaving[i].target];
        const Unit& other = units_[target];
        const auto box = static_cast<size_t>(std::find(other.nodes.begin(), other.nodes.end(), unit.leaving[i].target) -
                                             other.nodes.begin());
        outer_.edges.push_back({u, target, unit.layout.boxes[unit.nodes.size() + i].x - unit.layout.width / 2,
                                other.layout.boxes[box].x - other.layout.width / 2});
        betweenLinks_.push_back(unit.leaving[i]);
      }
    }
    spreadEntries(outer_, [&](uint32_t u) { return cards_[units_[u].nodes[0]].width; });
    outer_.gap = kGroupGap;
    outer_.run();
  }

  double left(size_t u) const { return outer_.boxes[u].x - outer_.boxes[u].width / 2; }
  double nodesLeft(size_t u) const { return left(u) + units_[u].padding(); }
  double nodesTop(size_t u) const { return outer_.boxes[u].top + units_[u].padding(); }

  // ---------------------------------------------------------------- drawing

  /// Down, or up where the next point is above; always straight at the ends.
  void curve(double x0, double y0, double x1, double y1, bool turns) {
    const double middle = (y0 + y1) / 2, out = kNodeGap * 0.9;
    const double first = !turns ? middle : y0 + out, second = !turns ? middle : y1 + out;
    out_ << " C" << x0 << ' ' << first << ' ' << x1 << ' ' << second << ' ' << x1 << ' ' << y1;
  }

  /// From the lower side of a box, down past its layer, along the lanes, to the upper side of another.
  void path(const LayoutEdge& edge, double dx, double dy, double x, double y, double endX, double endY) {
    out_ << " V" << y;
    for (size_t l = 0; l < edge.lanes.size(); ++l) {
      const LayoutLane& lane = edge.lanes[l];
      const double laneX = lane.x + dx, in = (edge.isBack ? lane.bottom : lane.top) + dy,
                   leave = (edge.isBack ? lane.top : lane.bottom) + dy;
      curve(x, y, laneX, in, edge.isBack && l == 0);
      out_ << " V" << leave;
      x = laneX;
      y = leave;
    }
    if (edge.isBack) {
      const double out = kNodeGap * 0.9;
      out_ << " C" << x << ' ' << std::min(y, endY) - out << ' ' << endX << ' ' << std::min(y, endY) - out << ' '
           << endX << ' ' << endY;
    } else {
      curve(x, y, endX, endY, false);
    }
  }
  void beginPath(const Link& link, double x, double y) {
    const char* colour = !partition_ ? "#555" : isStatic(link) ? "#1b7837" : "#2166ac";
    out_ << "<path fill=\"none\" stroke=\"" << colour << "\" stroke-width=\"1.2\" d=\"M" << x << ' ' << y;
  }
  void endPath(const Link& link, double x, double y) {
    const char* colour = !partition_ ? "#555" : isStatic(link) ? "#1b7837" : "#2166ac";
    out_ << "\"/>\n<path fill=\"" << colour << "\" d=\"M" << x << ' ' << y << " l-3 -6 h6 z\"/>\n";
  }

  void drawGroup(size_t u) {
    if (!units_[u].isGroup) return;
    const LayoutBox& box = outer_.boxes[u];
    const uint32_t group = partition_->groupOf[units_[u].nodes[0]];
    out_ << "<rect x=\"" << left(u) << "\" y=\"" << box.top << "\" width=\"" << box.width << "\" height=\""
         << box.height << "\" rx=\"8\" fill=\"" << groupColour(group) << "\" stroke=\"#999\"><title>group " << group
         << "</title></rect>\n";
  }

  void drawInside(size_t u) {
    const Unit& unit = units_[u];
    const double dx = nodesLeft(u), dy = nodesTop(u);
    for (size_t i = 0; i < unit.inside.size(); ++i) {
      const LayoutEdge& edge = unit.layout.edges[i];
      const LayoutBox &from = unit.layout.boxes[edge.from], &to = unit.layout.boxes[edge.to];
      const double x = dx + from.x + edge.fromOffset, endX = dx + to.x + edge.toOffset, endY = dy + to.top;
      beginPath(unit.inside[i], x, dy + from.top + from.height);
      path(edge, dx, dy, x, dy + from.layerBottom, endX, endY);
      endPath(unit.inside[i], endX, endY);
    }
  }

  void drawBetween() {
    size_t next = 0;
    for (size_t u = 0; u < units_.size(); ++u) {
      const Unit& unit = units_[u];
      const double dx = nodesLeft(u), dy = nodesTop(u);
      for (size_t i = 0; i < unit.leaving.size(); ++i, ++next) {
        const LayoutEdge& inner = unit.layout.edges[unit.inside.size() + i];
        const LayoutBox &from = unit.layout.boxes[inner.from], &exit = unit.layout.boxes[inner.to];
        const double x = dx + from.x + inner.fromOffset;
        beginPath(unit.leaving[i], x, dy + from.top + from.height);
        path(inner, dx, dy, x, dy + from.layerBottom, dx + exit.x, dy + exit.top);
        const LayoutEdge& edge = outer_.edges[next];
        const size_t t = edge.to;
        const double endX = outer_.boxes[t].x + edge.toOffset, endY = nodesTop(t);
        path(edge, 0, 0, dx + exit.x, outer_.boxes[u].layerBottom, endX, outer_.boxes[t].top);
        out_ << " V" << endY;
        endPath(betweenLinks_[next], endX, endY);
      }
    }
  }

  /// Of a card: its centre and half of its size.
  std::array<double, 4> placeOf(uint32_t node) const {
    const uint32_t u = unitOf_[node];
    const auto& nodes = units_[u].nodes;
    const auto box = static_cast<size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
    const double height = cards_[node].height;
    return {nodesLeft(u) + units_[u].layout.boxes[box].x, nodesTop(u) + units_[u].layout.boxes[box].top + height / 2,
            cards_[node].width / 2, height / 2};
  }
  /// Above all else, from side to side: dependencies are no part of the layout.
  void drawDependency(const Dependency& d) {
    const auto [x, y, halfWidth, halfHeight] = placeOf(d.source);
    const auto [endX, endY, endHalfWidth, endHalfHeight] = placeOf(d.target);
    const double side = endX >= x ? 1 : -1; // leaves towards the target, enters from the same side
    const double from = x + side * halfWidth, to = endX + side * endHalfWidth;
    const double bend = side * (kGroupGap + std::abs(to - from) / 4);
    out_ << "<path fill=\"none\" stroke=\"#d73027\" stroke-width=\"1.4\" stroke-dasharray=\"5 3\" d=\"M" << from << ' '
         << y << " C" << from + bend << ' ' << y << ' ' << to + bend << ' ' << endY << ' ' << to << ' ' << endY
         << "\"><title>" << escaped(nodeText(graph_, graph_.nodes[d.target])) << " depends on "
         << escaped(nodeText(graph_, graph_.nodes[d.source])) << "</title></path>\n<path fill=\"#d73027\" d=\"M" << to
         << ' ' << endY << " l" << side * 6 << " -3 v6 z\"/>\n";
  }

  void text(double x, double y, const std::string& words, const char* colour) {
    out_ << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"middle\" fill=\"" << colour << "\">"
         << escaped(words) << "</text>\n";
  }

  void drawCards(size_t u) {
    const Unit& unit = units_[u];
    for (size_t i = 0; i < unit.nodes.size(); ++i) {
      const Card& card = cards_[unit.nodes[i]];
      const LayoutBox& box = unit.layout.boxes[i];
      const double x = nodesLeft(u) + box.x, y = nodesTop(u) + box.top;
      const bool unreached =
          unit.nodes[i] < graph_.nodes.size() && partition_ && partition_->groupOf[unit.nodes[i]] == kNoGroup;
      out_ << "<g><title>" << escaped(card.title) << "</title><rect x=\"" << x - card.width / 2 << "\" y=\"" << y
           << "\" width=\"" << card.width << "\" height=\"" << card.height << "\" rx=\"4\" fill=\"white\" stroke=\""
           << card.stroke << "\" stroke-width=\"1.4\"" << (unreached ? " stroke-dasharray=\"4 3\"" : "") << "/></g>\n";
      text(x, y + kRow - 3, card.label, "#111");
      if (!card.cells.empty())
        out_ << "<path stroke=\"#ccc\" d=\"M" << x - card.width / 2 << ' ' << y + kRow + 2 << " h" << card.width
             << "\"/>\n";
      for (const Card::Cell& cell : card.cells) text(x + cell.offset, y + 2 * kRow, cell.text, "#666");
    }
  }

  const Graph& graph_;
  const Partition* partition_;
  std::vector<Card> cards_; // by node, then the starts
  std::vector<uint32_t> unitOf_;
  std::vector<Unit> units_;
  Layout outer_;
  std::vector<Link> betweenLinks_; // as outer_.edges
  std::ostringstream out_;
};
} // namespace

std::string exportSvg(const Graph& graph, const Partition* partition) { return Drawing(graph, partition).run(); }

} // namespace gpgp::spawn
