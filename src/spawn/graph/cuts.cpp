// Which polygons come to which node is found as types are, from the axioms and rules on. A part of a SubDiv by weights
// is the same share of a polygon whatever its size, so its piece is known here: the polygon clipped by two lines
// (Sutherland and Hodgman 1974), stretched to the part's own frame.
#include "spawn/graph/cuts.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <set>

namespace gpgp::spawn {
namespace {
using namespace shader;

using Point = std::array<double, 2>;
using Points = std::pmr::vector<Point>;
using Corners = std::pmr::vector<float>; // two each
using Numbers = std::pmr::vector<uint32_t>;

/// What lies above (side 1) or below (side -1) a place on an axis; nothing where that would be several pieces.
std::optional<Points> clipped(const Points& points, size_t axis, double place, double side) {
  Points result(points.get_allocator());
  uint32_t crossings = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const Point &a = points[i], &b = points[(i + 1) % points.size()];
    const double above = side * (a[axis] - place), next = side * (b[axis] - place);
    if (above >= 0) result.push_back(a);
    if ((above > 0 && next < 0) || (above < 0 && next > 0)) {
      Point cut;
      cut[axis] = place;
      cut[1 - axis] = a[1 - axis] + (b[1 - axis] - a[1 - axis]) * (above / (above - next));
      result.push_back(cut);
    }
    crossings += (above >= 0) != (next >= 0);
  }
  return crossings > 2 ? std::nullopt : std::optional(result);
}

/// Where the line lies along an edge, what is cut goes there and back.
void removeSpikes(Points& points) {
  for (size_t i = 0, steady = 0; points.size() > 2 && steady < points.size(); ++steady) {
    const size_t n = points.size();
    const Point &a = points[i % n], &b = points[(i + 1) % n], &c = points[(i + 2) % n];
    const Point in{b[0] - a[0], b[1] - a[1]}, out{c[0] - b[0], c[1] - b[1]};
    const bool spike = in[0] * out[1] == in[1] * out[0] && in[0] * out[0] + in[1] * out[1] <= 0;
    if (!spike) {
      ++i;
      continue;
    }
    points.erase(points.begin() + std::ptrdiff_t((i + 1) % n));
    steady = 0;
  }
}

/// The piece from `from` to `to`, shares of the axis, as corners in its own frame; empty where there is none.
std::optional<Corners> pieceOf(const Points& points, size_t axis, double from, double to) {
  const auto above = clipped(points, axis, from - 0.5, 1);
  if (!above) return std::nullopt;
  auto piece = clipped(*above, axis, to - 0.5, -1);
  if (!piece) return std::nullopt;
  removeSpikes(*piece);
  Corners corners(points.get_allocator());
  for (Point p : *piece) {
    p[axis] = (p[axis] - (from + to) / 2 + 0.5) / (to - from);
    for (const double v : p) corners.push_back(static_cast<float>(std::clamp(v, -0.5, 0.5)));
    const size_t n = corners.size();
    if (n > 2 && corners[n - 2] == corners[n - 4] && corners[n - 1] == corners[n - 3]) corners.resize(n - 2);
  }
  while (corners.size() > 2 && corners[0] == corners[corners.size() - 2] && corners[1] == corners.back())
    corners.resize(corners.size() - 2);
  double area = 0;
  for (size_t i = 0; i < corners.size(); i += 2) {
    const size_t j = (i + 2) % corners.size();
    area += double(corners[i]) * corners[j + 1] - double(corners[j]) * corners[i + 1];
  }
  if (area < 2e-6) corners.clear(); // of an area of 1
  return corners;
}

class Cutter {
public:
  explicit Cutter(Graph& graph)
      : graph_(graph), memory_(graph.nodes.get_allocator().resource()), arrived_(graph.nodes.size(), memory_),
        changed_(memory_), cuts_(graph.nodes.size(), memory_), numbers_(memory_) {
    for (uint32_t p = 0; p < graph.polygons.size(); ++p) numbers_.try_emplace(cornersOf(p), p);
  }

  void run() {
    const auto start = [&](uint32_t node, const Axiom& axiom) { arrive(node, axiom.shape | axiom.polygon << 8); };
    for (const Axiom& axiom : graph_.axioms) start(axiom.node, axiom);
    for (const Rule& rule : graph_.rules) start(rule.node, graph_.axioms[rule.axiom]);
    while (!changed_.empty()) {
      const auto [node, geometry] = changed_.back();
      changed_.pop_back();
      pass(node, geometry);
    }
    for (uint32_t n = 0; n < graph_.nodes.size(); ++n) {
      if (cuts_[n].empty()) continue;
      graph_.divisions[graph_.nodes[n].division + kDivisionCuts] =
          static_cast<uint32_t>(graph_.divisions.size()) - graph_.nodes[n].division;
      graph_.divisions.push_back(static_cast<uint32_t>(cuts_[n].size()));
      for (const auto& [polygon, pieces] : cuts_[n]) {
        graph_.divisions.push_back(polygon);
        graph_.divisions.insert(graph_.divisions.end(), pieces.begin(), pieces.end());
      }
    }
  }

private:
  Corners cornersOf(uint32_t polygon) const {
    const Polygon& p = graph_.polygons[polygon];
    const auto first = graph_.vertices.begin() + 2 * std::ptrdiff_t(p.firstVertex);
    return Corners(first, first + 2 * std::ptrdiff_t(p.vertexCount), memory_);
  }
  void arrive(uint32_t node, uint32_t geometry) {
    if (node != kNoNode && arrived_[node].insert(geometry).second) changed_.push_back({node, geometry});
  }
  void pass(uint32_t index, uint32_t geometry) {
    const Node node = graph_.nodes[index];
    const uint32_t shape = geometry & 0xff, polygon = geometry >> 8;
    const bool cut = node.op == kOpSubDiv && isCut(shape, node.argument);
    if (cut && shape > kShapeSphere) graph_.nodes[index].uncut = true;
    if (cut && (shape > kShapeSphere || !cutInto(index, polygon))) return;
    for (uint32_t e = 0; e < node.edgeCount; ++e) {
      const uint32_t target = graph_.edges[node.firstEdge + e].target;
      if (outputOf(node, e, shape) == 0) continue;
      uint32_t to = geometry;
      if (cut) {
        const uint32_t piece = cuts_[index].at(polygon)[e];
        if (piece == kNoPiece) continue;
        to = pieceShape(shape) | piece << 8;
      } else if (node.op == kOpSetGeometry) {
        to = node.argument | node.argument2 << 8;
      } else if (node.op == kOpGrowAlong || node.op == kOpToFace) {
        to = (node.op == kOpGrowAlong ? kShapeBox : kShapeQuad) | kQuadPolygon << 8;
      } else if (node.op == kOpRaiseRoof && (kRectangleShapes >> shape & 1)) {
        to = kShapeRoof;
      } else if (node.op == kOpToRoofFace && shape == kShapeRoof) {
        arrive(target, kShapeTrapezoid);
        to = kShapeQuad | kQuadPolygon << 8;
      } else if (node.op == kOpExtrude && isPolygon(shape)) {
        to = prismOf(shape) | polygon << 8;
      } else if (node.op == kOpCompSplit && e == 2) {
        to = kShapeQuad | kQuadPolygon << 8;
      } else if (node.op == kOpCompSplit && isPrism(shape)) {
        to = polygonOf(shape) | (polygon ^ e) << 8;
      }
      arrive(target, to);
    }
  }
  /// All pieces of a polygon at a SubDiv; false where there is one that cannot be made.
  bool cutInto(uint32_t index, uint32_t polygon) {
    const Node& node = graph_.nodes[index];
    if (!node.cuts) return false;
    if (cuts_[index].count(polygon)) return true;
    if (cuts_[index].size() == kMostCuts) {
      graph_.nodes[index].uncut = true;
      return false;
    }
    // A prism's polygon has -z as its y.
    Points points(memory_);
    const Corners corners = cornersOf(polygon);
    for (size_t i = 0; i < corners.size(); i += 2) points.push_back({corners[i], corners[i + 1]});
    Numbers pieces(memory_);
    for (uint32_t e = 0; e < node.edgeCount; ++e) {
      const uint32_t* part = graph_.divisions.data() + node.division + kDivisionParts + e * kPartSize;
      const double before = uintBitsToFloat(part[kPartShareBefore]), share = uintBitsToFloat(part[kPartShare]);
      pieces.push_back(kNoPiece);
      if (share <= 0 || graph_.edges[node.firstEdge + e].target == kNoNode) continue;
      const bool turned = node.argument == 2;
      const auto piece = pieceOf(points, node.argument == 0 ? 0 : 1, turned ? 1 - before - share : before,
                                 turned ? 1 - before : before + share);
      if (!piece || (!piece->empty() && (pieces.back() = numberOf(*piece)) == kNoPiece)) {
        graph_.nodes[index].uncut = true;
        return false;
      }
    }
    cuts_[index].emplace(polygon, std::move(pieces));
    return true;
  }
  uint32_t numberOf(const Corners& corners) {
    const auto known = numbers_.find(corners);
    if (known != numbers_.end()) return known->second;
    if (graph_.pieces >= kMostPieces) return kNoPiece;
    const uint32_t number = addPolygon(graph_, corners.data(), static_cast<uint32_t>(corners.size() / 2));
    if (number == kNoPolygon) return kNoPiece;
    graph_.pieces += 2;
    numbers_.try_emplace(corners, number);
    numbers_.try_emplace(cornersOf(number + 1), number + 1);
    return number;
  }

  Graph& graph_;
  std::pmr::memory_resource* const memory_;
  std::pmr::vector<std::pmr::set<uint32_t>> arrived_; // geometries, by node
  std::pmr::vector<std::pair<uint32_t, uint32_t>> changed_;
  std::pmr::vector<std::pmr::map<uint32_t, Numbers>> cuts_; // by node and polygon: pieces by edge
  std::pmr::map<Corners, uint32_t> numbers_;                // polygons by their corners
};
} // namespace

void cutPolygons(Graph& graph) {
  for (Node& node : graph.nodes) node.uncut = false;
  if (std::any_of(graph.nodes.begin(), graph.nodes.end(), isCutting)) Cutter(graph).run();
}

} // namespace gpgp::spawn
