// Union, difference and intersection: of polygons in one plane, and of closed meshes.
//
// Polygons: convex pieces of one operand are cut along the edges of the convex pieces of the other. Meshes: binary
// space partitions of both surfaces clip each other (Naylor, Amanatides, Thibault 1990). Places within the slack are
// one, and corners are added where an edge passes another's, so that faces of one plane join again.
#include "spawn/geometry/pieces.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace gpgp::spawn {

using namespace shader;

namespace {

using glm::dvec3;

class Partition {
public:
  Partition(MeshPool& pool, double slack) : pool_(pool), slack_(slack) {}
  /// False: out of steps, or too deep.
  bool build(const std::vector<Piece>& pieces) { return build(root_, pieces, 0); }
  bool clip(std::vector<Piece>& pieces) const {
    std::vector<Piece> kept;
    if (root_ && !clip(*root_, std::move(pieces), kept)) return false;
    if (root_) pieces = std::move(kept);
    return true;
  }
  bool clipTo(const Partition& other) { return !root_ || clipTo(*root_, other); }
  void invert() {
    if (root_) invert(*root_);
  }
  void collect(std::vector<Piece>& pieces) const {
    if (root_) collect(*root_, pieces);
  }

private:
  static constexpr uint32_t kDeepest = 4096;
  struct Node {
    Plane plane;
    std::vector<Piece> pieces;
    std::unique_ptr<Node> front, back;
  };

  bool build(std::unique_ptr<Node>& node, const std::vector<Piece>& pieces, uint32_t depth) {
    if (pieces.empty()) return true;
    if (depth == kDeepest || !countSteps(pool_, 4 * pieces.size())) return false;
    node = std::make_unique<Node>();
    node->plane = pieces[pieces.size() / 2].plane;
    std::vector<Piece> fronts, backs;
    for (const Piece& piece : pieces) sort(piece, node->plane, node->pieces, node->pieces, fronts, backs);
    return build(node->front, fronts, depth + 1) && build(node->back, backs, depth + 1);
  }
  void sort(const Piece& piece, const Plane& plane, std::vector<Piece>& sameSide, std::vector<Piece>& otherSide,
            std::vector<Piece>& fronts, std::vector<Piece>& backs) const {
    bool front = false, back = false;
    for (const dvec3& p : piece.points) {
      const double h = plane.height(p);
      front = front || h > slack_;
      back = back || h < -slack_;
    }
    if (!front && !back) {
      (glm::dot(plane.normal, piece.plane.normal) > 0 ? sameSide : otherSide).push_back(piece);
    } else if (!back) {
      fronts.push_back(piece);
    } else if (!front) {
      backs.push_back(piece);
    } else {
      Piece f, b;
      divide(piece, plane, slack_, f, b);
      if (!f.points.empty()) fronts.push_back(std::move(f));
      if (!b.points.empty()) backs.push_back(std::move(b));
    }
  }
  bool clip(const Node& node, std::vector<Piece> pieces, std::vector<Piece>& kept) const {
    if (pieces.empty()) return true;
    if (!countSteps(pool_, 4 * pieces.size())) return false;
    std::vector<Piece> fronts, backs;
    for (const Piece& piece : pieces) sort(piece, node.plane, fronts, backs, fronts, backs);
    pieces.clear();
    if (node.front) {
      if (!clip(*node.front, std::move(fronts), kept)) return false;
    } else {
      kept.insert(kept.end(), fronts.begin(), fronts.end());
    }
    return !node.back || clip(*node.back, std::move(backs), kept);
  }
  bool clipTo(Node& node, const Partition& other) {
    return other.clip(node.pieces) && (!node.front || clipTo(*node.front, other)) &&
           (!node.back || clipTo(*node.back, other));
  }
  static void invert(Node& node) {
    for (Piece& piece : node.pieces) {
      std::reverse(piece.points.begin(), piece.points.end());
      piece.plane = {-piece.plane.normal, -piece.plane.at};
    }
    node.plane = {-node.plane.normal, -node.plane.at};
    std::swap(node.front, node.back);
    if (node.front) invert(*node.front);
    if (node.back) invert(*node.back);
  }
  static void collect(const Node& node, std::vector<Piece>& pieces) {
    pieces.insert(pieces.end(), node.pieces.begin(), node.pieces.end());
    if (node.front) collect(*node.front, pieces);
    if (node.back) collect(*node.back, pieces);
  }

  MeshPool& pool_;
  double slack_;
  std::unique_ptr<Node> root_;
};

} // namespace

Status boolean(MeshPool& pool, const Form& a, const Form& b, Boolean what, Form& result) {
  if (a.mesh == 0 || b.mesh == 0) {
    result = what == Boolean::Union && a.mesh == 0 ? b : a;
    if (what == Boolean::Intersection) result.mesh = 0;
    return result.mesh ? kGeometryOk : kGeometryEmpty;
  }
  Attempt attempt(pool);
  std::vector<Piece> pieces, others;
  if (const Status status = piecesOf(pool, a, a.scope, 0, pieces)) return attempt.end(status);
  if (const Status status = piecesOf(pool, b, a.scope, 0, others)) return attempt.end(status);
  double extent = 0;
  for (const std::vector<Piece>* list : {&pieces, &others})
    for (const Piece& piece : *list)
      for (const dvec3& p : piece.points) extent = std::max({extent, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  const double slack = 4e-6 * extent;
  const bool flat = isPlanar(pool, a) && isPlanar(pool, b);
  std::vector<Piece> kept;
  if (flat && !pieces.empty() && !others.empty()) {
    const Plane plane = pieces[0].plane;
    for (Piece& piece : others) {
      for (const dvec3& p : piece.points)
        if (std::fabs(plane.height(p)) > 50 * slack) return attempt.end(kGeometryNotPlanar);
      if (glm::dot(piece.plane.normal, plane.normal) > 0) continue;
      std::reverse(piece.points.begin(), piece.points.end());
      piece.plane = plane;
    }
    for (Piece& piece : pieces)
      if (glm::dot(piece.plane.normal, plane.normal) < 0) return attempt.end(kGeometryNotPlanar);
    const bool fits = what == Boolean::Union
                          ? cutFlat(pool, others, pieces, false, slack, kept)
                          : cutFlat(pool, pieces, others, what == Boolean::Intersection, slack, kept);
    if (!fits) return attempt.end(kGeometryTooLarge);
    if (what == Boolean::Union) kept.insert(kept.end(), pieces.begin(), pieces.end());
    for (Piece& piece : kept) piece.tags = pieces[0].tags;
  } else {
    if (!isClosedSurface(pool, a) || !isClosedSurface(pool, b)) return attempt.end(kGeometryBadArgument);
    for (Piece& piece : pieces) piece.tags |= kTagBooleanA;
    for (Piece& piece : others) piece.tags |= kTagBooleanB;
    Partition one(pool, slack), two(pool, slack);
    bool fits = one.build(pieces) && two.build(others);
    if (what != Boolean::Union) one.invert();
    if (what == Boolean::Intersection) {
      fits = fits && two.clipTo(one);
      two.invert();
      fits = fits && one.clipTo(two) && two.clipTo(one);
    } else {
      fits = fits && one.clipTo(two) && two.clipTo(one);
      two.invert();
      fits = fits && two.clipTo(one);
      two.invert();
    }
    if (!fits) return attempt.end(kGeometryTooLarge);
    if (what != Boolean::Union) {
      one.invert();
      two.invert();
    }
    one.collect(kept);
    two.collect(kept);
  }
  if (kept.empty()) return attempt.end(kGeometryEmpty);
  Form made{a.scope, vec3(1.0f), 0};
  Status status = join(pool, kept, slack, made);
  const Cleanup exact{true, true, 0.001f};
  if (status == kGeometryOk) status = cleanup(pool, made, exact);
  if (status == kGeometryOk) status = fitScope(pool, made);
  if (status <= kGeometryEmpty) result = made;
  return attempt.end(status);
}

} // namespace gpgp::spawn
