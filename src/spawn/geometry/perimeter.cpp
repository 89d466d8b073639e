// Parts of a face's perimeter, each set back by a depth of its own: CGA's splitAndSetbackPerimeter.
//
// An edge sweeps a quadrangle as deep as its part of the perimeter is. At a convex corner the quadrangle reaches along
// the next edge, where that is long enough, so that strips leave no wedge between them and the outline; at a reflex
// corner it ends in the mitre of two edges of one part, else at a right angle. What of it lies in the face and hangs
// together with the edge is the strip; where strips overlap, the deeper one has it, and of equal ones the earlier.
#include "spawn/geometry/pieces.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gpgp::spawn {

using namespace shader;

namespace {

using glm::dvec3;

/// An edge of the face's outline, along the axes of the face's own scope, as its pieces are.
struct Edge {
  dvec3 from, along, inwards; ///< unit length
  double length = 0;
  uint32_t corner = 0;           ///< of the mesh
  size_t before = 0, behind = 0; ///< edges
};
/// Of an edge, in metres from where it begins.
struct Stretch {
  size_t edge;
  double from, to;
};

dvec3 placed(const Scope& scope, const vec3& p) {
  const dvec3 arm = dvec3(p) - dvec3(scope.origin);
  return {glm::dot(arm, dvec3(scope.axisX)), glm::dot(arm, dvec3(scope.axisY)), glm::dot(arm, dvec3(scope.axisZ))};
}

std::vector<Edge> edgesOf(MeshPool& pool, const Form& form, uint32_t face, const Scope& scope) {
  std::vector<Edge> edges;
  const vec3 n = faceNormal(pool, form, face);
  const dvec3 normal(glm::dot(n, scope.axisX), glm::dot(n, scope.axisY), glm::dot(n, scope.axisZ));
  const Face f = faceOf(pool, form.mesh, face);
  for (uint l = 0; l < f.loops; ++l) {
    const Loop loop = loopOf(pool, form.mesh, f.firstLoop + l);
    const size_t first = edges.size(), count = loop.corners;
    for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
      Edge edge;
      edge.from = placed(scope, framePosition(pool, form, c));
      edge.along = placed(scope, framePosition(pool, form, nextCorner(loop, c))) - edge.from;
      edge.length = glm::length(edge.along);
      edge.along = edge.length > 0 ? edge.along / edge.length : dvec3(0);
      edge.inwards = glm::cross(normal, edge.along);
      edge.corner = c;
      const size_t i = edges.size() - first;
      edge.before = first + (i + count - 1) % count;
      edge.behind = first + (i + 1) % count;
      edges.push_back(edge);
    }
  }
  return edges;
}

/// The stretches of the edges of a chain from a place along it to another one; beyond its end it begins again.
std::vector<Stretch> stretchesOf(const std::vector<Edge>& edges, const std::vector<size_t>& chain, double whole,
                                 double from, double to) {
  std::vector<Stretch> result;
  const double slack = 1e-6 * whole;
  from -= std::floor(from / whole) * whole;
  double left = std::min(to, whole);
  // At most once around, and a second time for what lies before its beginning.
  double at = 0;
  for (size_t i = 0; i < 2 * chain.size() && left > slack; ++i) {
    const Edge& edge = edges[chain[i % chain.size()]];
    const double begin = std::max(from - at, 0.0);
    at += edge.length;
    if (begin > edge.length - slack) continue;
    const double end = std::min(edge.length, begin + left);
    left -= end - begin;
    from = at;
    result.push_back(
        {chain[i % chain.size()], begin < slack ? 0.0 : begin, end > edge.length - slack ? edge.length : end});
  }
  return result;
}

/// Where the strip of an edge ends that reaches a corner: depth metres inwards. other: the edge beyond the corner.
dvec3 endOf(const Edge& edge, const Edge& other, bool isAtEnd, double depth, bool isMitred) {
  const dvec3 corner = isAtEnd ? other.from : edge.from;
  const dvec3 straight = corner + edge.inwards * depth;
  const dvec3 beyond = isAtEnd ? other.along : other.along * -1.0; // along the other edge, away from the corner
  const double rise = glm::dot(beyond, edge.inwards);
  constexpr double kStraight = 1e-4;
  if (rise > kStraight) { // convex
    const double reach = depth / rise;
    return reach <= other.length * (1 + 1e-6) ? corner + beyond * reach : straight;
  }
  // The mitre of two edges that nearly turn back would reach too far.
  const double turn = glm::dot(edge.inwards, other.inwards);
  if (rise < -kStraight && isMitred && turn > -0.9)
    return corner + (edge.inwards + other.inwards) * (depth / (1 + turn));
  return straight;
}

/// Whether two segments of the face's plane lie one on the other, over more than the slack.
bool overlap(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d, double slack) {
  const double length = glm::length(b - a);
  if (length <= slack) return false;
  const dvec3 along = (b - a) / length;
  const double tc = glm::dot(c - a, along), td = glm::dot(d - a, along);
  if (glm::length(c - a - along * tc) > slack || glm::length(d - a - along * td) > slack) return false;
  return std::min(std::max(tc, td), length) - std::max(std::min(tc, td), 0.0) > slack;
}
bool haveEdgesTogether(const Piece& piece, const Piece& other, double slack) {
  const auto next = [](const Piece& p, size_t i) { return p.points[(i + 1) % p.points.size()]; };
  for (size_t i = 0; i < piece.points.size(); ++i)
    for (size_t k = 0; k < other.points.size(); ++k)
      if (overlap(piece.points[i], next(piece, i), other.points[k], next(other, k), slack)) return true;
  return false;
}

/// The pieces that hang together with an edge.
bool keepConnected(MeshPool& pool, std::vector<Piece>& pieces, const Piece& edge, double slack) {
  if (!countSteps(pool, 16 * pieces.size() * pieces.size())) return false;
  std::vector<Piece> kept;
  std::vector<bool> taken(pieces.size(), false);
  const auto take = [&](const Piece& from) {
    for (size_t i = 0; i < pieces.size(); ++i) {
      if (taken[i] || !haveEdgesTogether(pieces[i], from, slack)) continue;
      taken[i] = true;
      kept.push_back(pieces[i]);
    }
  };
  take(edge);
  for (size_t next = 0; next < kept.size(); ++next) take(Piece(kept[next]));
  pieces = std::move(kept);
  return true;
}

/// Edges that lie on the face's own ones get their tags, the others kTagSetback.
Status tagEdges(MeshPool& pool, Form& form, const Form& whole, const Scope& scope, const std::vector<Edge>& edges,
                double slack) {
  Builder b = builderFor(pool, form.mesh, 1);
  copyVertices(pool, b, form);
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const Face face = faceOf(pool, form.mesh, f);
    beginFace(pool, b, face.tags);
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      beginLoop(pool, b);
      for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
        const dvec3 p = placed(scope, framePosition(pool, form, c));
        const dvec3 q = placed(scope, framePosition(pool, form, nextCorner(loop, c)));
        uint32_t tags = kTagSetback;
        for (const Edge& edge : edges) {
          const auto isOn = [&](const dvec3& point) {
            const double t = glm::dot(point - edge.from, edge.along);
            return t > -slack && t < edge.length + slack && glm::length(point - edge.from - edge.along * t) <= slack;
          };
          if (isOn(p) && isOn(q)) tags = cornerTags(pool, whole.mesh, edge.corner);
        }
        addCorner(pool, b, cornerVertex(pool, form.mesh, c), tags);
      }
    }
    if (!countSteps(pool, uint64_t{edges.size()} * faceCorners(pool, form.mesh, f).corners)) return kGeometryTooLarge;
  }
  return finishForm(pool, b, form, true);
}

/// What a part of the perimeter sweeps within the face, in its pieces' axes. False: out of steps.
bool sweep(MeshPool& pool, const std::vector<Piece>& face, const std::vector<Edge>& edges,
           const std::vector<Stretch>& stretches, double depth, double slack, std::vector<Piece>& strip) {
  const auto isThere = [&](size_t edge, bool atEnd) { // another stretch of the part, from or to the corner
    return std::any_of(stretches.begin(), stretches.end(), [&](const Stretch& s) {
      return s.edge == edge && (atEnd ? s.to == edges[edge].length : s.from == 0);
    });
  };
  for (const Stretch& s : stretches) {
    const Edge& edge = edges[s.edge];
    const dvec3 p = edge.from + edge.along * s.from, q = edge.from + edge.along * s.to;
    dvec3 farP = p + edge.inwards * depth, farQ = q + edge.inwards * depth;
    if (s.from == 0) farP = endOf(edge, edges[edge.before], false, depth, isThere(edge.before, true));
    if (s.to == edge.length) farQ = endOf(edge, edges[edge.behind], true, depth, isThere(edge.behind, false));
    Piece quad{{p, q, farQ, farP}, face[0].plane, 0};
    const double a = glm::dot(farP - p, edge.along), b = glm::dot(farQ - q, edge.along), width = s.to - s.from;
    if (width + b - a <= slack) // the ends meet before
      quad.points = {p, q, p + (farP - p) * std::min(1.0, width / (a - b))};
    std::vector<Piece> within, fresh;
    if (!cutFlat(pool, face, {quad}, true, slack, within)) return false;
    if (!keepConnected(pool, within, Piece{{p, q}, {}, 0}, 4 * slack)) return false;
    if (!cutFlat(pool, within, strip, false, slack, fresh)) return false;
    strip.insert(strip.end(), fresh.begin(), fresh.end());
  }
  return true;
}

/// Pieces of a face as a form with other axes.
Status formOf(MeshPool& pool, const std::vector<Piece>& pieces, const Form& face, const Form& whole,
              const std::vector<Edge>& edges, double slack, Form& form) {
  form.mesh = 0;
  if (pieces.empty()) return kGeometryOk;
  Form made{face.scope, vec3(1.0f), 0};
  Status status = join(pool, pieces, slack, made);
  const Cleanup exact{true, true, 0.001f};
  if (status == kGeometryOk) status = cleanup(pool, made, exact);
  if (status == kGeometryOk) status = tagEdges(pool, made, whole, face.scope, edges, 8 * slack);
  if (status == kGeometryOk) status = alignScope(pool, made, axesOf(whole.scope));
  if (status == kGeometryEmpty) return kGeometryOk;
  if (status == kGeometryOk) form = made;
  return status;
}

} // namespace

Status setbackPerimeter(MeshPool& pool, const Form& form, uint32_t face, std::span<const uint32_t> chain,
                        std::span<const PerimeterPart> parts, std::vector<Form>& pieces, Form& remainder) {
  for (const PerimeterPart& part : parts)
    if (!std::isfinite(part.from) || !std::isfinite(part.to) || !std::isfinite(part.depth)) return kGeometryBadArgument;
  if (face >= meshFaces(pool, form.mesh)) return kGeometryBadArgument;
  Attempt attempt(pool);
  Form own{};
  const uint32_t faces[] = {face};
  if (const Status status = toComponents(pool, form, Component::Faces, faces, own)) return attempt.end(status);
  const std::vector<Edge> edges = edgesOf(pool, form, face, own.scope);
  std::vector<size_t> order;
  double whole = 0, extent = 0;
  for (const uint32_t corner : chain) {
    const auto found = std::find_if(edges.begin(), edges.end(), [&](const Edge& e) { return e.corner == corner; });
    if (found == edges.end()) return attempt.end(kGeometryBadArgument);
    order.push_back(static_cast<size_t>(found - edges.begin()));
    whole += found->length;
  }
  for (const Edge& edge : edges)
    extent = std::max({extent, std::fabs(edge.from.x), std::fabs(edge.from.y), std::fabs(edge.from.z)});
  const double slack = 4e-6 * extent;
  std::vector<Piece> all;
  if (const Status status = piecesOf(pool, own, own.scope, 0, all)) return attempt.end(status);
  if (all.empty()) return attempt.end(kGeometryEmpty);
  std::vector<size_t> deepest(parts.size());
  std::iota(deepest.begin(), deepest.end(), size_t{0});
  std::stable_sort(deepest.begin(), deepest.end(), [&](size_t a, size_t b) { return parts[a].depth > parts[b].depth; });
  std::vector<Piece> rest = all;
  std::vector<Form> made(parts.size(), Form{form.scope, vec3(1.0f), 0});
  for (const size_t i : deepest) {
    const PerimeterPart& part = parts[i];
    if (!(part.depth > 0) || !(part.to > part.from) || !(whole > 0)) continue;
    const auto stretches = stretchesOf(edges, order, whole, double(part.from), double(part.to) - double(part.from));
    std::vector<Piece> strip, free, left;
    // What is still free of it; deeper parts come first.
    if (!sweep(pool, all, edges, stretches, double(part.depth), slack, strip) ||
        !cutFlat(pool, rest, strip, true, slack, free) || !cutFlat(pool, rest, strip, false, slack, left))
      return attempt.end(kGeometryTooLarge);
    rest = std::move(left);
    if (const Status status = formOf(pool, free, own, form, edges, slack, made[i])) return attempt.end(status);
  }
  Form last{form.scope, vec3(1.0f), 0};
  if (const Status status = formOf(pool, rest, own, form, edges, slack, last)) return attempt.end(status);
  remainder = last;
  pieces = std::move(made);
  return attempt.end(kGeometryOk);
}

} // namespace gpgp::spawn
