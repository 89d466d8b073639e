// Pictures of graphs: everything is in them, boxes are apart, edges go around boxes.
#include "graphs.h"
#include "spawn/graph/export.h"
#include "spawn/graph/export_labels.h"
#include "spawn/graph/export_layout.h"
#include "spawn/graph/heuristics.h"

#include <gtest/gtest.h>

namespace {
using namespace gpgp;
using namespace gpgp::spawn;
using namespace gpgp::test;

size_t occurrences(const std::string& text, const std::string& word) {
  size_t count = 0;
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

/// Every tag is closed in order, and nothing stands in text or attributes that would have to be escaped.
void expectWellFormed(const std::string& xml) {
  std::vector<std::string> open;
  for (size_t at = 0; at < xml.size(); ++at) {
    if (xml[at] == '&') {
      const std::string entity = xml.substr(at, xml.find(';', at) - at + 1);
      EXPECT_TRUE(entity == "&lt;" || entity == "&gt;" || entity == "&amp;" || entity == "&quot;")
          << xml.substr(at, 20);
    }
    if (xml[at] != '<') continue;
    const size_t end = xml.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string tag = xml.substr(at + 1, end - at - 1);
    EXPECT_EQ(tag.find('<'), std::string::npos);
    EXPECT_EQ(occurrences(tag, "\"") % 2, 0u) << tag;
    if (tag[0] == '/') {
      ASSERT_FALSE(open.empty());
      EXPECT_EQ(open.back(), tag.substr(1));
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(tag.substr(0, tag.find(' ')));
    }
    at = end;
  }
  EXPECT_TRUE(open.empty());
}

TEST(Export, PicturesShowEveryNodeEdgeAndGroup) {
  for (uint32_t seed = 0; seed < 300; ++seed) {
    const Graph graph = compiled(randomGrammar(seed));
    const Flow flow = makeFlow(graph);
    std::mt19937 random(seed);
    const Partition partition = makePartition(flow, randomPartition(flow, random));
    size_t live = graph.axioms[0].node != kNoNode, fixed = 0, queued = 0;
    for (const Edge& edge : graph.edges) live += edge.target != kNoNode;
    const size_t dependencies = dependenciesOf(graph).size();
    live += dependencies;
    for (const Group& group : partition.groups) {
      fixed += group.staticEdges.size();
      queued += group.dynamicEdges.size();
    }
    const std::string svg = exportSvg(graph, &partition), plain = exportSvg(graph);
    expectWellFormed(svg);
    EXPECT_EQ(occurrences(svg, "<title>group "), partition.groups.size()) << seed;
    EXPECT_EQ(occurrences(svg, "<path fill=\"none\""), live) << seed;
    EXPECT_EQ(occurrences(svg, "stroke=\"#1b7837\""), fixed) << seed;
    EXPECT_EQ(occurrences(svg, "<g>"), graph.nodes.size() + 1) << seed; // and the start
    EXPECT_EQ(occurrences(plain, "<path fill=\"none\""), live) << seed;
    EXPECT_EQ(occurrences(plain, "<g>"), graph.nodes.size() + 1) << seed;
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    const std::string dot = exportDot(graph, &partition);
    EXPECT_EQ(occurrences(dot, "subgraph cluster"), partition.groups.size()) << seed;
    EXPECT_EQ(occurrences(dot, " -> "), graph.edges.size() + 1 + dependencies) << seed;
    EXPECT_EQ(occurrences(dot, "color=darkgreen"), fixed) << seed;
    EXPECT_GE(occurrences(dot, ", color=blue]"), queued) << seed;
  }
}

TEST(Export, DependenciesAreDrawn) {
  const Graph graph = ofRules("A = Replicate() { Collider(wall) T | Collider(wall) U | Collider(1) T |"
                              "  IfCollides(wall) { T | IfCollides(1) { T | U } } };");
  EXPECT_EQ(dependenciesOf(graph).size(), 3u);
  EXPECT_EQ(occurrences(exportDot(graph, nullptr), "style=dashed, color=red"), 3u);
  const Flow flow = makeFlow(graph);
  const Partition partition = makePartition(flow, heuristicPartition(graph, flow));
  EXPECT_FALSE(violation(flow, partition.groupOf));
  for (const Partition* drawn : {static_cast<const Partition*>(nullptr), &partition}) {
    const std::string svg = exportSvg(graph, drawn);
    expectWellFormed(svg);
    EXPECT_EQ(occurrences(svg, "IfCollides(wall) depends on Collider(wall)"), 2u);
    EXPECT_EQ(occurrences(svg, "IfCollides(1) depends on Collider(1)"), 1u);
  }
}

TEST(Export, TextIsEscaped) {
  const Graph graph = ofRules("A = If(ShapeSize(X) < 1 && ShapeSize(Y) > 2) { T | U };");
  const std::string svg = exportSvg(graph);
  EXPECT_NE(svg.find("<title>If(((ShapeSize(X) &lt; 1) &amp;&amp; (ShapeSize(Y) &gt; 2)))</title>"), std::string::npos);
  expectWellFormed(svg);
}

TEST(Export, GroupsHaveTheirOwnColours) {
  for (uint32_t g = 1; g < 12; ++g)
    for (uint32_t h = 0; h < g; ++h) EXPECT_NE(groupColour(g), groupColour(h));
}

TEST(Layout, BoxesAreApartAndEdgesGoAroundThem) {
  for (uint32_t seed = 0; seed < 500; ++seed) {
    std::mt19937 generator(seed);
    const auto below = [&](uint32_t n) { return static_cast<uint32_t>(generator() % n); };
    Layout layout;
    const uint32_t count = 2 + below(20);
    for (uint32_t b = 0; b < count; ++b)
      layout.boxes.push_back({10.0 + below(90), 10.0 + below(50), b + 1 == count && seed % 2});
    for (uint32_t e = 0; e < count * 3 / 2; ++e) {
      const uint32_t to = below(count);
      uint32_t from = below(count);
      if (layout.boxes[from].isLast) from = 0;
      layout.edges.push_back({from, to, 0, 0});
    }
    layout.gap = 20;
    layout.run();
    for (uint32_t a = 0; a < count; ++a) {
      const LayoutBox& box = layout.boxes[a];
      const double left = box.x - box.width / 2, right = box.x + box.width / 2, bottom = box.top + box.height;
      EXPECT_TRUE(left > -1e-6 && right < layout.width + 1e-6 && box.top >= 0 && bottom < layout.height + 1e-6) << seed;
      EXPECT_LE(bottom, box.layerBottom);
      for (uint32_t b = 0; b < a; ++b) {
        const LayoutBox& other = layout.boxes[b];
        EXPECT_TRUE(right <= other.x - other.width / 2 || left >= other.x + other.width / 2 || bottom <= other.top ||
                    box.top >= other.top + other.height)
            << seed << ": " << a << ", " << b;
      }
      for (const LayoutEdge& edge : layout.edges)
        for (const LayoutLane& lane : edge.lanes)
          EXPECT_TRUE(lane.x <= left || lane.x >= right || lane.bottom <= box.top || lane.top >= bottom) << seed;
    }
    for (const LayoutEdge& edge : layout.edges) {
      const LayoutBox &from = layout.boxes[edge.from], &to = layout.boxes[edge.to];
      if (edge.isBack) {
        EXPECT_FALSE(edge.lanes.empty());
        EXPECT_TRUE(edge.to <= edge.from && to.top <= from.top) << seed;
        continue;
      }
      double y = from.layerBottom; // layer by layer, down
      for (const LayoutLane& lane : edge.lanes) {
        EXPECT_NEAR(lane.top, y + layout.gap, 1e-6) << seed;
        y = lane.bottom;
      }
      EXPECT_NEAR(to.top, y + layout.gap, 1e-6) << seed;
    }
  }
}

} // namespace
