// Counts, areas, volumes and extents of forms.
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace gpgp::spawn {

using namespace shader;

std::vector<uint32_t> weldVertices(const MeshPool& constPool, const Form& form) {
  MeshPool& pool = readable(constPool);
  const uint32_t count = meshVertices(pool, form.mesh);
  countSteps(pool, count);
  std::vector<vec3> positions(count);
  vec3 low(std::numeric_limits<float>::max()), high(-std::numeric_limits<float>::max());
  for (uint32_t i = 0; i < count; ++i) {
    positions[i] = scaled3(vertexPosition(pool, form.mesh, i), form.scale);
    low = glm::min(low, positions[i]);
    high = glm::max(high, positions[i]);
  }
  std::vector<uint32_t> order(count), first(count);
  std::iota(order.begin(), order.end(), 0u);
  std::iota(first.begin(), first.end(), 0u);
  if (count == 0) return first;
  const auto leadOf = [&first](uint32_t i) {
    while (first[i] != i) i = first[i] = first[first[i]];
    return i;
  };
  const auto join = [&](uint32_t a, uint32_t b) { // the smaller number of both groups leads
    const uint32_t x = leadOf(a), y = leadOf(b);
    first[std::max(x, y)] = std::min(x, y);
  };
  // Vertices in one place join first, so that only one of them is compared with what is near.
  const auto coordinates = [&positions](uint32_t i) {
    return std::tuple(positions[i].x, positions[i].y, positions[i].z);
  };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return coordinates(a) != coordinates(b) ? coordinates(a) < coordinates(b) : a < b;
  });
  std::vector<uint32_t> places;
  for (const uint32_t i : order) {
    if (!places.empty() && positions[places.back()] == positions[i])
      join(places.back(), i);
    else
      places.push_back(i);
  }
  // Cells of twice the distance within which vertices join: of a vertex's own cell and the 26 around it, the three
  // along x lie in a row.
  const float apart = 2e-6f * std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  if (places.size() > 1 && apart > 0) {
    constexpr uint64_t kRow = uint64_t(1) << 20, kLayer = kRow << 20;
    const auto cellOf = [&](uint32_t i) {
      const glm::dvec3 cell = glm::floor(glm::dvec3(positions[i] - low) / (2.0 * static_cast<double>(apart)));
      return (uint64_t(cell.z) + 1) * kLayer + (uint64_t(cell.y) + 1) * kRow + uint64_t(cell.x) + 1;
    };
    std::vector<std::pair<uint64_t, uint32_t>> cells;
    for (const uint32_t i : places) cells.emplace_back(cellOf(i), i);
    std::sort(cells.begin(), cells.end());
    for (const auto& [cell, i] : cells) {
      for (const uint64_t layer : {cell - kLayer, cell, cell + kLayer}) {
        for (const uint64_t row : {layer - kRow, layer, layer + kRow}) {
          for (auto at = std::lower_bound(cells.begin(), cells.end(), std::pair(row - 1, 0u));
               at != cells.end() && at->first <= row + 1; ++at) {
            const vec3 d = glm::abs(positions[i] - positions[at->second]);
            if (std::max({d.x, d.y, d.z}) <= apart) join(i, at->second);
          }
        }
      }
    }
  }
  for (uint32_t i = 0; i < count; ++i) first[i] = leadOf(i);
  return first;
}

std::vector<uint32_t> cornerFaces(const MeshPool& constPool, uint32_t mesh) {
  MeshPool& pool = readable(constPool);
  std::vector<uint32_t> faces(meshCorners(pool, mesh));
  for (uint32_t f = 0; f < meshFaces(pool, mesh); ++f) {
    const Loop all = faceCorners(pool, mesh, f);
    std::fill_n(faces.begin() + all.firstCorner, all.corners, f);
  }
  return faces;
}

std::vector<MeshEdge> meshEdges(const MeshPool& constPool, const Form& form) {
  MeshPool& pool = readable(constPool);
  const std::vector<uint32_t> welded = weldVertices(pool, form);
  countSteps(readable(pool), meshCorners(readable(pool), form.mesh));
  std::vector<MeshEdge> edges;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> found;
  for (uint32_t f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const Face face = faceOf(pool, form.mesh, f);
    for (uint32_t l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      for (uint32_t c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
        const uint32_t a = welded[cornerVertex(pool, form.mesh, c)];
        const uint32_t b = welded[cornerVertex(pool, form.mesh, nextCorner(loop, c))];
        const auto [at, isNew] = found.try_emplace({std::min(a, b), std::max(a, b)}, uint32_t(edges.size()));
        if (isNew) {
          edges.push_back({std::min(a, b), std::max(a, b), c, f, 1, c, f, true});
          continue;
        }
        MeshEdge& e = edges[at->second];
        if (e.faces++ == 1) {
          e.otherCorner = c;
          e.otherFace = f;
        }
        if (welded[cornerVertex(pool, form.mesh, e.corner)] == a) e.opposed = false;
      }
    }
  }
  return edges;
}

uint32_t faceCount(const MeshPool& pool, const Form& form) { return meshFaces(readable(pool), form.mesh); }
uint32_t edgeCount(MeshPool& pool, const Form& form) { return uint32_t(meshEdges(pool, form).size()); }
uint32_t vertexCount(MeshPool& pool, const Form& form) {
  const std::vector<uint32_t> welded = weldVertices(pool, form);
  uint32_t count = 0;
  for (uint32_t i = 0; i < welded.size(); ++i) {
    count += welded[i] == i;
  }
  return count;
}

vec3 faceNormal(const MeshPool& pool, const Form& form, uint32_t face) {
  if (face >= faceCount(pool, form)) return vec3(0.0f);
  return unit3(scopeDirection(form.scope, faceAreaVector(readable(pool), form, face)));
}
float faceArea(const MeshPool& pool, const Form& form, uint32_t face) {
  if (face >= faceCount(pool, form)) return 0.0f;
  return multiply(length3(faceAreaVector(readable(pool), form, face)), 0.5f);
}
float area(const MeshPool& pool, const Form& form) {
  float sum = 0.0f;
  for (uint32_t f = 0; f < faceCount(pool, form); ++f) {
    sum = add(sum, faceArea(pool, form, f));
  }
  return sum;
}

namespace {

/// Six times the volume between a face and a point, and that volume's first moment about the point.
double faceVolume(MeshPool& pool, const Form& form, uint32_t f, vec3 origin, glm::dvec3& moment) {
  const Face face = faceOf(pool, form.mesh, f);
  glm::dvec3 start{};
  double sum = 0;
  for (uint32_t l = 0; l < face.loops; ++l) {
    const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
    if (l == 0) start = glm::dvec3(localPosition(pool, form, loop.firstCorner) - origin);
    for (uint32_t c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
      const glm::dvec3 a = glm::dvec3(localPosition(pool, form, c) - origin);
      const glm::dvec3 b = glm::dvec3(localPosition(pool, form, nextCorner(loop, c)) - origin);
      const double v = glm::dot(start, glm::cross(a, b));
      sum += v;
      moment += v * (start + a + b) / 4.0;
    }
  }
  return sum;
}
vec3 firstPosition(MeshPool& pool, const Form& form) {
  return meshCorners(pool, form.mesh) > 0 ? localPosition(pool, form, 0) : vec3(0.0f);
}

} // namespace

bool isClosedSurface(MeshPool& pool, const Form& form) {
  const std::vector<MeshEdge> edges = meshEdges(pool, form);
  return !edges.empty() && std::all_of(edges.begin(), edges.end(), [](const MeshEdge& e) {
    // Where solids touch along an edge it has four faces.
    return e.faces % 2 == 0 && (e.faces > 2 || e.opposed);
  });
}

float volume(const MeshPool& constPool, const Form& form) {
  MeshPool& pool = readable(constPool);
  if (!isClosedSurface(pool, form)) return 0.0f;
  double sum = 0;
  glm::dvec3 moment{};
  const vec3 origin = firstPosition(pool, form);
  for (uint32_t f = 0; f < meshFaces(pool, form.mesh); ++f) {
    sum += faceVolume(pool, form, f, origin, moment);
  }
  return float(std::fabs(sum) / 6.0);
}

vec3 centroid(const MeshPool& constPool, const Form& form) {
  MeshPool& pool = readable(constPool);
  const vec3 origin = firstPosition(pool, form);
  glm::dvec3 moment{};
  double weight = 0;
  if (isClosedSurface(pool, form)) {
    for (uint32_t f = 0; f < meshFaces(pool, form.mesh); ++f) {
      weight += faceVolume(pool, form, f, origin, moment);
    }
  }
  if (weight == 0) {
    moment = {};
    for (uint32_t f = 0; f < meshFaces(pool, form.mesh); ++f) {
      const glm::dvec3 normal(localNormal(pool, form, f));
      const Face face = faceOf(pool, form.mesh, f);
      glm::dvec3 start{};
      for (uint32_t l = 0; l < face.loops; ++l) {
        const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
        if (l == 0) start = glm::dvec3(localPosition(pool, form, loop.firstCorner) - origin);
        for (uint32_t c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
          const glm::dvec3 a = glm::dvec3(localPosition(pool, form, c) - origin);
          const glm::dvec3 b = glm::dvec3(localPosition(pool, form, nextCorner(loop, c)) - origin);
          const double twice = glm::dot(normal, glm::cross(a - start, b - start));
          weight += twice;
          moment += twice * (start + a + b) / 3.0;
        }
      }
    }
  }
  const vec3 local = weight != 0 ? origin + vec3(moment / weight) : form.scope.size * 0.5f;
  return scopePoint(form.scope, local);
}

Bounds scopeBounds(const MeshPool& constPool, const Form& form) {
  MeshPool& pool = readable(constPool);
  Bounds b{vec3(0.0f), vec3(0.0f)};
  for (uint32_t v = 0; v < meshVertices(pool, form.mesh); ++v) {
    const vec3 p = scaled3(vertexPosition(pool, form.mesh, v), form.scale);
    b.low = v == 0 ? p : glm::min(b.low, p);
    b.high = v == 0 ? p : glm::max(b.high, p);
  }
  return b;
}
Bounds frameBounds(const MeshPool& constPool, const Form& form) {
  MeshPool& pool = readable(constPool);
  Bounds b{form.scope.origin, form.scope.origin};
  for (uint32_t v = 0; v < meshVertices(pool, form.mesh); ++v) {
    const vec3 p = scopePoint(form.scope, scaled3(vertexPosition(pool, form.mesh, v), form.scale));
    b.low = v == 0 ? p : glm::min(b.low, p);
    b.high = v == 0 ? p : glm::max(b.high, p);
  }
  return b;
}

namespace {

/// Sine and cosine of the turn at a corner, of unit vectors, seen against the normal; positive: to the left.
std::pair<float, float> turnAt(MeshPool& pool, const Form& form, Loop loop, uint32_t corner, vec3 normal) {
  const vec3 here = localPosition(pool, form, corner);
  const vec3 in = unit3(here - localPosition(pool, form, previousCorner(loop, corner)));
  const vec3 out = unit3(localPosition(pool, form, nextCorner(loop, corner)) - here);
  return {inner3(outer3(in, out), normal), inner3(in, out)};
}

} // namespace

bool isConcave(const MeshPool& constPool, const Form& form) {
  MeshPool& pool = readable(constPool);
  for (uint32_t f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const Face face = faceOf(pool, form.mesh, f);
    if (face.loops > 1) return true;
    const vec3 normal = localNormal(pool, form, f);
    const Loop loop = loopOf(pool, form.mesh, face.firstLoop);
    for (uint32_t c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
      if (turnAt(pool, form, loop, c, normal).first < -1e-4f) return true;
    }
  }
  return false;
}

bool isPlanar(const MeshPool& constPool, const Form& form) {
  MeshPool& pool = readable(constPool);
  const Bounds b = scopeBounds(pool, form);
  const float slack = 1e-4f * glm::max(b.high.x - b.low.x, glm::max(b.high.y - b.low.y, b.high.z - b.low.z));
  if (meshFaces(pool, form.mesh) == 0) return true;
  const vec3 normal = localNormal(pool, form, 0);
  const vec3 origin = firstPosition(pool, form);
  for (uint32_t v = 0; v < meshVertices(pool, form.mesh); ++v) {
    const vec3 p = scaled3(vertexPosition(pool, form.mesh, v), form.scale);
    if (std::fabs(inner3(normal, p - origin)) > slack) return false;
  }
  return true;
}

bool isRectangular(const MeshPool& constPool, const Form& form) {
  MeshPool& pool = readable(constPool);
  if (meshFaces(pool, form.mesh) != 1) return false;
  const Face face = faceOf(pool, form.mesh, 0);
  if (face.loops != 1) return false;
  const vec3 normal = localNormal(pool, form, 0);
  const Loop loop = loopOf(pool, form.mesh, face.firstLoop);
  uint32_t right = 0;
  for (uint32_t c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
    const auto [sine, cosine] = turnAt(pool, form, loop, c, normal);
    if (std::fabs(sine) < 1e-3f && cosine > 0) continue;
    if (std::fabs(cosine) > 1e-3f || sine < 0) return false;
    right += 1;
  }
  return right == 4 && isPlanar(pool, form);
}

float cornerAngle(const MeshPool& constPool, const Form& form, uint32_t f, uint32_t corner) {
  MeshPool& pool = readable(constPool);
  if (f >= meshFaces(pool, form.mesh)) return 0.0f;
  const Face face = faceOf(pool, form.mesh, f);
  const vec3 normal = localNormal(pool, form, f);
  for (uint32_t l = 0; l < face.loops; ++l) {
    const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
    if (corner >= loop.corners) {
      corner -= loop.corners;
      continue;
    }
    const auto [sine, cosine] = turnAt(pool, form, loop, loop.firstCorner + corner, normal);
    return 180.0f - float(std::atan2(double(sine), double(cosine)) * 57.29577951308232);
  }
  return 0.0f;
}

void uvBounds(const MeshPool& constPool, const Form& form, uint32_t set, vec2& low, vec2& high) {
  MeshPool& pool = readable(constPool);
  low = high = vec2(0.0f);
  for (uint32_t c = 0; c < meshCorners(pool, form.mesh); ++c) {
    const vec2 uv = set < kMaxUvSets ? cornerUv(pool, form.mesh, set, c) : vec2(0.0f);
    low = c == 0 ? uv : glm::min(low, uv);
    high = c == 0 ? uv : glm::max(high, uv);
  }
}

} // namespace gpgp::spawn
