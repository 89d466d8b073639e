// Wavefronts of faces: the skeleton's nodes and sides, put together to polygons.
#include "spawn/geometry/waves.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn {

using namespace shader;

namespace {

double areaOfLoop(const std::vector<vec2>& loop) {
  double sum = 0;
  for (size_t i = 1; i + 1 < loop.size(); ++i) {
    const glm::dvec2 a(loop[i] - loop[0]), b(loop[i + 1] - loop[0]);
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}
bool contains(const std::vector<vec2>& loop, vec2 p) {
  bool isInside = false;
  for (size_t i = 0; i < loop.size(); ++i) {
    const vec2 a = loop[i], b = loop[(i + 1) % loop.size()];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    const float side = sideOf(a, b, p);
    if (b.y > a.y ? side > 0 : side < 0) isInside = !isInside;
  }
  return isInside;
}

/// Two edges of fronts that cross, or a front of a hole that no outline holds.
bool frontsCross(const std::vector<std::vector<vec2>>& fronts) {
  std::vector<std::pair<vec2, vec2>> edges;
  for (const auto& front : fronts) {
    for (size_t i = 0; i < front.size(); ++i) {
      edges.emplace_back(front[i], front[(i + 1) % front.size()]);
    }
    if (areaOfLoop(front) >= 0) continue;
    if (std::none_of(fronts.begin(), fronts.end(),
                     [&](const auto& other) { return areaOfLoop(other) > 0 && contains(other, front[0]); }))
      return true;
  }
  for (size_t i = 0; i < edges.size(); ++i) {
    const auto [a, b] = edges[i];
    for (size_t j = 0; j < i; ++j) {
      const auto [c, d] = edges[j];
      if (glm::max(a.x, b.x) <= glm::min(c.x, d.x) || glm::max(c.x, d.x) <= glm::min(a.x, b.x)) continue;
      const float slack =
          1e-5f * (std::fabs(b.x - a.x) + std::fabs(b.y - a.y)) * (std::fabs(d.x - c.x) + std::fabs(d.y - c.y));
      const float s0 = sideOf(a, b, c), s1 = sideOf(a, b, d), s2 = sideOf(c, d, a), s3 = sideOf(c, d, b);
      if (((s0 > slack && s1 < -slack) || (s0 < -slack && s1 > slack)) &&
          ((s2 > slack && s3 < -slack) || (s2 < -slack && s3 > slack)))
        return true;
    }
  }
  return false;
}

} // namespace

Status makeWaves(MeshPool& pool, const Form& form, uint32_t face, std::span<const float> speeds, float until,
                 bool outwards, Waves& waves) {
  const uint mark = workMark(pool);
  waves = {};
  waves.outline = outlineOf(pool, form, face);
  const Outline& o = waves.outline;
  const auto leave = [&](Status status) {
    releaseWork(pool, mark);
    return status;
  };
  if (o.status) return leave(o.status);
  const Loop all = faceCorners(pool, form.mesh, face);
  if (!speeds.empty())
    for (uint i = 0; i < o.count; ++i) {
      setWorkFloat(pool, o.points + kPointWords * i + 2, speeds[workWord(pool, o.corners + i) - all.firstCorner]);
    }
  uint points = o.points;
  // Outwards: the loops the other way round; the edge from a point to the next is that of the next one reversed.
  std::vector<uint32_t> original(o.count);
  uint first = 0;
  if (outwards) {
    points = takeWork(pool, kPointWords * o.count);
    if (points == kNoWork) return leave(kGeometryTooLarge);
  }
  for (uint l = 0; l < o.loopCount; ++l) {
    const uint count = workWord(pool, o.loops + l);
    for (uint i = 0; i < count; ++i) {
      const uint from = outwards ? first + count - 1 - i : first + i;
      const uint edge = outwards ? first + (2 * count - 2 - i) % count : first + i;
      original[first + i] = edge;
      const vec2 p = pointAt(pool, o.points, first + i), q = pointAt(pool, o.points, first + (i + 1) % count);
      waves.edges.emplace_back(p, q);
      waves.cornerOf.push_back(workWord(pool, o.corners + first + i));
      if (!outwards) continue;
      for (uint w = 0; w < 2; ++w) {
        setWorkWord(pool, points + kPointWords * (first + i) + w, workWord(pool, o.points + kPointWords * from + w));
      }
      setWorkWord(pool, points + kPointWords * (first + i) + 2, workWord(pool, o.points + kPointWords * edge + 2));
    }
    first += count;
  }
  Skeleton s = skeletonOf(pool, points, o.count, o.loops, o.loopCount, until);
  if (s.status) return leave(s.status);
  countSteps(pool, uint64_t(o.count) * o.count / 8); // fronts against each other
  waves.nodes.reserve(s.nodes);
  for (uint n = 0; n < s.nodes; ++n) {
    waves.nodes.push_back(n < o.count ? vec3(pointAt(pool, points, n), 0.0f) : nodePosition(pool, s, n));
  }
  float extent = 0;
  for (const vec3& n : waves.nodes) {
    extent = std::max({extent, std::fabs(n.x - waves.nodes[0].x), std::fabs(n.y - waves.nodes[0].y)});
  }
  const float apart = 1e-6f * extent;
  const auto samePlace = [&](uint32_t a, uint32_t b) {
    const vec3 d = glm::abs(waves.nodes[a] - waves.nodes[b]);
    return std::max({d.x, d.y, d.z}) <= apart;
  };
  const auto originalOf = [&](uint edge) { return edge < o.count ? original[edge] : kNone; };
  for (uint e = 0; e < o.count; ++e) {
    const uint start = edgeWord(pool, s, e, kEdgeStart), end = edgeWord(pool, s, e, kEdgeEnd);
    WaveFace f{original[e], {start}, {kNone}};
    uint node = end;
    while (node != start) {
      const uint side = takeSide(pool, s, e, node);
      if (side == kNone) return leave(kGeometryNotSimple);
      const uint beside = sideBeside(pool, s, side);
      const uint across = beside == kNone ? kNone : originalOf(beside);
      if (samePlace(node, f.nodes.back())) { // the side before had no length
        f.beside.back() = across;
      } else {
        f.nodes.push_back(node);
        f.beside.push_back(across);
      }
      node = sideEnd(pool, s, side);
    }
    while (f.nodes.size() > 1 && samePlace(f.nodes.back(), f.nodes.front())) {
      f.nodes.pop_back();
      f.beside.pop_back();
    }
    if (f.nodes.size() >= 3) waves.faces.push_back(std::move(f));
  }
  std::vector<bool> seen(s.vertices);
  for (uint i = 0; i < s.running; ++i) {
    uint v = workWord(pool, s.activeAt + i);
    std::vector<vec2> loop;
    std::vector<uint32_t> edges;
    while (!seen[v]) {
      seen[v] = true;
      const vec3 p = waves.nodes[waveWord(pool, s, v, kVertexNode)];
      if (loop.empty() || std::max(std::fabs(p.x - loop.back().x), std::fabs(p.y - loop.back().y)) > apart) {
        loop.emplace_back(p.x, p.y);
        edges.push_back(originalOf(waveWord(pool, s, v, kVertexRight)));
      } else {
        edges.back() = originalOf(waveWord(pool, s, v, kVertexRight));
      }
      v = waveNext(pool, s, v);
    }
    while (loop.size() > 1 &&
           std::max(std::fabs(loop.front().x - loop.back().x), std::fabs(loop.front().y - loop.back().y)) <= apart) {
      loop.pop_back();
      edges.pop_back();
    }
    if (loop.size() < 3) continue;
    waves.fronts.push_back(std::move(loop));
    waves.frontEdges.push_back(std::move(edges));
  }
  // Faces and fronts tile the polygon, or edges overtook each other.
  if (!speeds.empty() && !outwards) {
    double whole = 0, parts = 0;
    for (const auto& [from, to] : waves.edges) {
      const glm::dvec2 a(from - waves.edges[0].first), b(to - waves.edges[0].first);
      whole += a.x * b.y - a.y * b.x;
    }
    for (const auto& front : waves.fronts) {
      parts += areaOfLoop(front);
    }
    std::vector<vec2> polygon;
    for (const WaveFace& f : waves.faces) {
      polygon.clear();
      for (const uint32_t n : f.nodes) {
        polygon.emplace_back(waves.nodes[n].x, waves.nodes[n].y);
      }
      const double swept = areaOfLoop(polygon);
      parts += swept;
      if (swept < -1e-6 * whole) return leave(kGeometryUnsettled);
    }
    if (std::fabs(whole - parts) > 3e-5 * whole || frontsCross(waves.fronts)) return leave(kGeometryUnsettled);
  }
  return leave(kGeometryOk);
}

void addLoops(MeshPool& pool, Builder& b, const PlaneBasis& basis, const std::vector<std::vector<vec2>>& loops,
              float height, bool reversed, uint32_t tags, uint32_t edgeTags) {
  std::vector<double> areas;
  for (const auto& loop : loops) {
    areas.push_back(areaOfLoop(loop));
  }
  const auto add = [&](const std::vector<vec2>& loop) {
    beginLoop(pool, b);
    for (size_t i = 0; i < loop.size(); ++i) {
      const vec2 p = loop[reversed ? loop.size() - 1 - i : i];
      addCorner(pool, b, addVertex(pool, b, fromPlane(basis, p, height)), edgeTags);
    }
  };
  for (size_t i = 0; i < loops.size(); ++i) {
    if (!(areas[i] > 0)) continue;
    beginFace(pool, b, tags);
    add(loops[i]);
    for (size_t j = 0; j < loops.size(); ++j) {
      if (areas[j] >= 0 || !contains(loops[i], loops[j][0])) continue;
      // The smallest of those that hold it.
      bool smallest = true;
      for (size_t k = 0; k < loops.size(); ++k) {
        if (k != i && areas[k] > 0 && areas[k] < areas[i] && contains(loops[k], loops[j][0])) smallest = false;
      }
      if (smallest) add(loops[j]);
    }
  }
}

} // namespace gpgp::spawn
