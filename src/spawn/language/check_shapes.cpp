// The input-output relation of each operator (thesis 4.1) against the types of shapes that arrive at it.
#include "spawn/language/check_shapes.h"

namespace gpgp::spawn {
namespace {
using namespace shader;

std::string list(uint32_t shapes) {
  std::string text;
  for (uint32_t s = 0; s < kShapeCount; ++s)
    if (shapes >> s & 1) text += (text.empty() ? "" : ", ") + std::string(shapeName(s));
  return text;
}

/// Types that come from axioms, and of which an operator makes nothing that goes on.
void warnOfEnds(const Graph& graph, const Node& node, Place place, Diagnostics& diagnostics) {
  uint32_t ending = 0;
  bool leads = false;
  for (uint32_t s = 0; s < kShapeCount; ++s) {
    if (!(node.axiomShapes >> s & 1)) continue;
    bool goesOn = false;
    for (uint32_t e = 0; e < node.edgeCount; ++e) {
      const bool kept = graph.edges[node.firstEdge + e].target != kNoNode;
      leads = leads || kept;
      goesOn = goesOn || (kept && outputOf(node, e, s) != 0);
    }
    if (!goesOn) ending |= 1u << s;
  }
  if (ending && leads && node.op == kOpSubDiv) {
    diagnostics.warning(place, "SubDiv cuts nothing of " + list(ending) +
                                   ", which can arrive: by lengths, its pieces would have other corners for each size. "
                                   "Such shapes are dropped and counted; expected constant weights alone");
    return;
  }
  if (node.uncut)
    diagnostics.warning(place, "SubDiv cannot cut some shapes that can arrive: they would fall into several pieces, or "
                               "there would be too many different ones. Such shapes are dropped and counted");
  if (ending && leads)
    diagnostics.warning(place, std::string(operatorName(node.op)) + " passes on nothing of " + list(ending) +
                                   ", which can arrive: such shapes end here");
}

/// Instances have no polygons: a mesh stands for whatever shape it is.
void tellOfPolygons(const Graph& graph, const Node& node, Place place, Diagnostics& diagnostics) {
  if (node.op != kOpTerminal || graph.terminals[node.argument].kind != 1 || !(node.axiomShapes & kDynamicShapes))
    return;
  diagnostics.info(place, std::string("instances of '") + graph.nameAt(graph.terminals[node.argument].name) +
                              "' do not say the corners of " + list(node.axiomShapes & kDynamicShapes) +
                              ": its mesh must have them, or a spawner for vertices write them");
}

void warnOfNoEffect(const Node& node, Place place, Diagnostics& diagnostics) {
  if ((node.shapes & kOperators[node.op].shapes) == 0)
    diagnostics.warning(place, std::string(operatorName(node.op)) + " has no effect here: only " + list(node.shapes) +
                                   " arrives");
}
} // namespace

void checkShapes(const Graph& graph, std::span<const NodePlace> places, std::span<const GrammarPart> parts) {
  for (size_t i = 0; i < graph.nodes.size(); ++i) {
    const Node& node = graph.nodes[i];
    const GrammarPart& part = parts[places[i].part];
    if ((part.baked && !part.places) || node.shapes == 0) continue;
    warnOfEnds(graph, node, places[i].place, *part.diagnostics);
    tellOfPolygons(graph, node, places[i].place, *part.diagnostics);
    warnOfNoEffect(node, places[i].place, *part.diagnostics);
  }
}

} // namespace gpgp::spawn
