#include "spawn/geometry/pieces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace gpgp::spawn {

using namespace shader;
using glm::dvec3;

namespace {

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

} // namespace

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

} // namespace gpgp::spawn
