// Polygons of a graph: the regular ones, and a grammar's own, concave ones cut into quads.
//
// Ears are clipped one after the other (Meisters 1975). The triangles form a tree, each hanging on the one that is cut
// off later behind its diagonal; two that share a diagonal become a quad. Leaves are paired first, so that the number
// of quads is the least possible for these triangles.
#include "spawn/graph/graph.h"

#include <array>

namespace gpgp::spawn {
namespace {

using Corner = std::array<uint32_t, 4>;
using Quads = std::pmr::vector<Corner>;
constexpr uint32_t kNone = UINT32_MAX;

class Clipper {
public:
  Clipper(const float* corners, uint32_t count, std::pmr::memory_resource* memory)
      : corners_(corners), previous_(count, memory), next_(count, memory), behind_(count, memory) {
    for (uint32_t i = 0; i < count; ++i) {
      previous_[i] = i == 0 ? count - 1 : i - 1;
      next_[i] = i + 1 == count ? 0 : i + 1;
      behind_[i] = kNone;
    }
  }

  bool isConvex() const { // no corner turns right, and there is one turn in all
    for (uint32_t i = 0; i < next_.size(); ++i)
      if (turn(previous_[i], i, next_[i]) < 0 || turn(0, i, next_[i]) < 0) return false;
    return true;
  }
  /// Two edges cross, other than by touching.
  bool isCrossed() const {
    for (uint32_t i = 0; i < next_.size(); ++i)
      for (uint32_t j = 0; j < i; ++j)
        if (apart(i, next_[i], j, next_[j]) && apart(j, next_[j], i, next_[i])) return true;
    return false;
  }

  /// Quads as corners 0 1 2 and 0 2 3; a triangle repeats its last one. Nothing where there is no ear left.
  Quads clip() {
    Quads quads(previous_.get_allocator());
    uint32_t left = static_cast<uint32_t>(next_.size()), at = 0, tried = 0;
    bool flat = false; // ears without area count
    while (left >= 3) {
      if (tried == left) {
        if (flat) return Quads(previous_.get_allocator());
        flat = true;
        tried = 0;
      }
      if (!isEar(at, flat)) {
        at = next_[at];
        ++tried;
        continue;
      }
      cutOff(at, quads);
      at = previous_[at];
      tried = 0;
      flat = false;
      --left;
    }
    for (Corner& quad : quads)
      if (quad[3] == kNone) quad[3] = quad[2];
    return quads;
  }

private:
  /// Twice the area of a triangle, positive where it turns left.
  double turn(uint32_t a, uint32_t b, uint32_t c) const {
    const double abX = double(x(b)) - x(a), abY = double(y(b)) - y(a);
    return abX * (double(y(c)) - y(b)) - abY * (double(x(c)) - x(b));
  }
  /// c and d lie on different sides of the line through a and b.
  bool apart(uint32_t a, uint32_t b, uint32_t c, uint32_t d) const {
    const double first = turn(a, b, c), second = turn(a, b, d);
    return (first > 0 && second < 0) || (first < 0 && second > 0);
  }
  float x(uint32_t i) const { return corners_[2 * i]; }
  float y(uint32_t i) const { return corners_[2 * i + 1]; }
  bool same(uint32_t a, uint32_t b) const { return x(a) == x(b) && y(a) == y(b); }

  bool isEar(uint32_t b, bool flat) const {
    const uint32_t a = previous_[b], c = next_[b];
    const double area = turn(a, b, c);
    if (area < 0 || (area == 0 && !flat)) return false;
    if (area == 0) return true;
    for (uint32_t p = next_[c]; p != a; p = next_[p])
      if (turn(previous_[p], p, next_[p]) <= 0 && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0 &&
          !same(p, a) && !same(p, b) && !same(p, c))
        return false;
    return true;
  }

  void cutOff(uint32_t b, Quads& quads) {
    const uint32_t a = previous_[b], c = next_[b];
    Corner quad{a, b, c, kNone};
    uint32_t paired = kNone;
    if (isSingle(behind_[a], quads)) { // across a b
      paired = behind_[a];
      quad = {a, quads[paired][1], b, c};
    } else if (isSingle(behind_[b], quads)) { // across b c
      paired = behind_[b];
      quad = {b, quads[paired][1], c, a};
    }
    if (paired == kNone) {
      paired = static_cast<uint32_t>(quads.size());
      quads.push_back(quad);
    } else {
      quads[paired] = quad;
    }
    behind_[a] = paired;
    next_[a] = c;
    previous_[c] = a;
  }
  static bool isSingle(uint32_t quad, const Quads& quads) { return quad != kNone && quads[quad][3] == kNone; }

  const float* corners_;
  std::pmr::vector<uint32_t> previous_, next_;
  std::pmr::vector<uint32_t> behind_; ///< what was cut off along the edge that begins at a corner
};

void addCorners(Graph& graph, const Quads& quads, uint32_t count, bool mirrored) {
  graph.polygons.push_back({static_cast<uint32_t>(graph.vertices.size() / 2), count,
                            static_cast<uint32_t>(graph.quads.size() / 2), static_cast<uint32_t>(quads.size())});
  for (const Corner& q : quads) {
    const Corner c = mirrored ? Corner{count - 1 - q[0], count - 1 - q[3], count - 1 - q[2], count - 1 - q[1]} : q;
    graph.quads.push_back(c[0] | (c[1] << 16));
    graph.quads.push_back(c[2] | (c[3] << 16));
  }
}

} // namespace

uint32_t addPolygon(Graph& graph, const float* corners, uint32_t count) {
  Quads quads(graph.quads.get_allocator());
  Clipper clipper(corners, count, graph.quads.get_allocator().resource());
  if (!clipper.isConvex()) {
    if (!clipper.isCrossed()) quads = clipper.clip();
    if (quads.empty()) return kNoPolygon;
  }
  const uint32_t number = static_cast<uint32_t>(graph.polygons.size());
  addCorners(graph, quads, count, false);
  graph.vertices.insert(graph.vertices.end(), corners, corners + 2 * size_t(count));
  addCorners(graph, quads, count, true);
  for (uint32_t i = count; i-- > 0;) {
    graph.vertices.push_back(corners[2 * i]);
    graph.vertices.push_back(0.0f - corners[2 * i + 1]);
  }
  return number;
}

void addRegularPolygons(Graph& graph) {
  static constexpr std::array<float, 6> kTriangle{0.0f, 0.5f, -0.5f, -0.5f, 0.5f, -0.5f};
  static constexpr std::array<float, 8> kQuad{-0.5f, 0.5f, -0.5f, -0.5f, 0.5f, -0.5f, 0.5f, 0.5f};
  static constexpr std::array<float, 10> kPentagon{0.0f,  0.5f,         -0.5f, 0.118033989f, -0.309016994f,
                                                   -0.5f, 0.309016994f, -0.5f, 0.5f,         0.118033989f};
  static constexpr std::array<float, 12> kHexagon{0.0f, 0.5f,  -0.5f, 0.25f,  -0.5f, -0.25f,
                                                  0.0f, -0.5f, 0.5f,  -0.25f, 0.5f,  0.25f};
  static constexpr std::array<float, 14> kHeptagon{0.0f,          0.5f,          -0.400968868f, 0.301937736f, -0.5f,
                                                   -0.143104135f, -0.222520934f, -0.5f,         0.222520934f, -0.5f,
                                                   0.5f,          -0.143104135f, 0.400968868f,  0.301937736f};
  static constexpr std::array<float, 16> kOctagon{
      -0.207106781f, 0.5f,  -0.5f, 0.207106781f,  -0.5f, -0.207106781f, -0.207106781f, -0.5f,
      0.207106781f,  -0.5f, 0.5f,  -0.207106781f, 0.5f,  0.207106781f,  0.207106781f,  0.5f};
  addPolygon(graph, kTriangle.data(), 3);
  addPolygon(graph, kQuad.data(), 4);
  addPolygon(graph, kPentagon.data(), 5);
  addPolygon(graph, kHexagon.data(), 6);
  addPolygon(graph, kHeptagon.data(), 7);
  addPolygon(graph, kOctagon.data(), 8);
}

} // namespace gpgp::spawn
