// Union, difference and intersection: of polygons in one plane, and of closed meshes.
//
// Polygons: convex pieces of one operand are cut along the edges of the convex pieces of the other. Meshes: binary
// space partitions of both surfaces clip each other (Naylor, Amanatides, Thibault 1990). Places within the slack are
// one, and corners are added where an edge passes another's, so that faces of one plane join again.
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

namespace gpgp::spawn {

using namespace shader;

namespace {

using glm::dvec3;

struct Plane {
  dvec3 normal{0};
  double at = 0;
  double height(const dvec3& p) const { return glm::dot(normal, p) - at; }
};
struct Piece {
  std::vector<dvec3> points;
  Plane plane;
  uint32_t tags = 0;
};

/// What of a polygon is in front of a plane and behind it; both are empty where it has no area there.
void divide(const Piece& piece, const Plane& plane, double slack, Piece& front, Piece& back) {
  front = {{}, piece.plane, piece.tags};
  back = front;
  const size_t n = piece.points.size();
  for (size_t i = 0; i < n; ++i) {
    const dvec3 &p = piece.points[i], &q = piece.points[(i + 1) % n];
    const double hp = plane.height(p), hq = plane.height(q);
    if (hp >= -slack) front.points.push_back(p);
    if (hp <= slack) back.points.push_back(p);
    if ((hp > slack && hq < -slack) || (hp < -slack && hq > slack)) {
      const dvec3 cut = p + (q - p) * (hp / (hp - hq));
      front.points.push_back(cut);
      back.points.push_back(cut);
    }
  }
  const auto tidy = [&](Piece& part) {
    bool isBeyond = false;
    for (const dvec3& p : part.points) isBeyond = isBeyond || std::fabs(plane.height(p)) > slack;
    if (!isBeyond || part.points.size() < 3) part.points.clear();
  };
  tidy(front);
  tidy(back);
}

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

/// Convex pieces of all faces, in metres along the axes of `scope` from its origin.
Status piecesOf(MeshPool& pool, const Form& form, const Scope& scope, uint32_t tags, std::vector<Piece>& pieces) {
  Form convex = form;
  if (const Status status = convexify(pool, convex)) return status;
  for (uint f = 0; f < meshFaces(pool, convex.mesh); ++f) {
    const Loop loop = faceCorners(pool, convex.mesh, f);
    Piece piece;
    piece.tags = faceOf(pool, convex.mesh, f).tags | tags;
    for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
      const dvec3 arm = dvec3(framePosition(pool, convex, c)) - dvec3(scope.origin);
      piece.points.emplace_back(glm::dot(arm, dvec3(scope.axisX)), glm::dot(arm, dvec3(scope.axisY)),
                                glm::dot(arm, dvec3(scope.axisZ)));
    }
    dvec3 sum(0);
    for (size_t i = 1; i + 1 < piece.points.size(); ++i)
      sum += glm::cross(piece.points[i] - piece.points[0], piece.points[i + 1] - piece.points[0]);
    const double length = glm::length(sum);
    if (!(length > 0)) continue;
    piece.plane.normal = sum / length;
    for (const dvec3& p : piece.points) piece.plane.at += glm::dot(piece.plane.normal, p);
    piece.plane.at /= static_cast<double>(piece.points.size());
    pieces.push_back(std::move(piece));
  }
  return kGeometryOk;
}

/// Outwards, through each edge of a convex polygon.
std::vector<Plane> sidesOf(const Piece& piece) {
  std::vector<Plane> sides;
  for (size_t i = 0; i < piece.points.size(); ++i) {
    const dvec3 &p = piece.points[i], &q = piece.points[(i + 1) % piece.points.size()];
    const dvec3 out = glm::cross(q - p, piece.plane.normal);
    const double length = glm::length(out);
    if (length > 0) sides.push_back({out / length, glm::dot(out / length, p)});
  }
  return sides;
}

/// What of polygons lies outside all others, or inside any of them; all in one plane, the others apart.
bool cutFlat(MeshPool& pool, const std::vector<Piece>& pieces, const std::vector<Piece>& others, bool inside,
             double slack, std::vector<Piece>& kept) {
  std::vector<Piece> left = pieces;
  for (const Piece& other : others) {
    const std::vector<Plane> sides = sidesOf(other);
    std::vector<Piece> next;
    for (const Piece& piece : left) {
      if (!countSteps(pool, sides.size() * piece.points.size())) return false;
      Piece rest = piece;
      std::vector<Piece> outer;
      for (const Plane& side : sides) {
        Piece front, back;
        divide(rest, side, slack, front, back);
        if (!front.points.empty()) outer.push_back(std::move(front));
        rest = std::move(back);
        if (rest.points.empty()) break;
      }
      if (rest.points.empty()) { // apart from it
        next.push_back(piece);
        continue;
      }
      if (inside) kept.push_back(std::move(rest));
      next.insert(next.end(), outer.begin(), outer.end());
    }
    left = std::move(next);
  }
  if (!inside) kept.insert(kept.end(), left.begin(), left.end());
  return true;
}

/// Numbers for places: points within the slack of an earlier one have its number.
class Places {
public:
  explicit Places(double slack) : slack_(slack), cell_(4 * slack) {}
  uint32_t number(const dvec3& p) {
    const glm::i64vec3 at(glm::floor(p / cell_));
    for (int64_t x = -1; x <= 1; ++x)
      for (int64_t y = -1; y <= 1; ++y)
        for (int64_t z = -1; z <= 1; ++z) {
          const auto found = cells_.find({at.x + x, at.y + y, at.z + z});
          if (found == cells_.end()) continue;
          for (const uint32_t i : found->second)
            if (glm::length(points[i] - p) <= slack_) return i;
        }
    cells_[{at.x, at.y, at.z}].push_back(static_cast<uint32_t>(points.size()));
    points.push_back(p);
    return static_cast<uint32_t>(points.size() - 1);
  }
  std::vector<dvec3> points;

private:
  double slack_, cell_;
  std::map<std::tuple<int64_t, int64_t, int64_t>, std::vector<uint32_t>> cells_;
};

/// The polygons as a form; where an edge passes a corner of another polygon it gets one.
Status join(MeshPool& pool, const std::vector<Piece>& pieces, double slack, Form& form) {
  Places places(slack);
  std::vector<std::vector<uint32_t>> loops(pieces.size());
  for (size_t i = 0; i < pieces.size(); ++i)
    for (const dvec3& p : pieces[i].points) {
      const uint32_t v = places.number(p);
      if (loops[i].empty() || (loops[i].back() != v && loops[i].front() != v)) loops[i].push_back(v);
    }
  const std::vector<dvec3>& at = places.points;
  std::vector<uint32_t> order(at.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return at[a].x < at[b].x; });
  size_t corners = 0;
  for (std::vector<uint32_t>& loop : loops) {
    std::vector<uint32_t> whole;
    for (size_t i = 0; i < loop.size() && loop.size() >= 3; ++i) {
      const uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      whole.push_back(a);
      const dvec3 along = at[b] - at[a];
      const double squared = glm::dot(along, along);
      const double low = std::min(at[a].x, at[b].x) - slack, high = std::max(at[a].x, at[b].x) + slack;
      auto it = std::lower_bound(order.begin(), order.end(), low, [&](uint32_t v, double x) { return at[v].x < x; });
      std::vector<std::pair<double, uint32_t>> between;
      uint64_t looked = 1;
      for (; it != order.end() && at[*it].x <= high; ++it, ++looked) {
        if (*it == a || *it == b) continue;
        const double t = glm::dot(at[*it] - at[a], along) / squared;
        if (t <= 0 || t >= 1 || glm::length(at[a] + along * t - at[*it]) > slack) continue;
        between.emplace_back(t, *it);
      }
      if (!countSteps(pool, looked)) return kGeometryTooLarge;
      std::sort(between.begin(), between.end());
      for (const auto& [t, v] : between) whole.push_back(v);
    }
    loop = std::move(whole);
    corners += loop.size();
  }
  if (corners > (1u << 24)) return kGeometryTooLarge;
  Builder b = newBuilder(pool, uint(at.size()), uint(corners), uint(loops.size()), uint(loops.size()), 0);
  for (const dvec3& p : at) addVertex(pool, b, vec3(p));
  for (size_t i = 0; i < loops.size(); ++i) {
    if (loops[i].size() < 3) continue;
    beginFace(pool, b, pieces[i].tags);
    beginLoop(pool, b);
    for (const uint32_t v : loops[i]) addCorner(pool, b, v, 0);
  }
  return finishForm(pool, b, form, true);
}

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
