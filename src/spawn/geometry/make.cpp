// Polygons, meshes and primitives into the pool.
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gpgp::spawn {

using namespace shader;

namespace {

const Scope kFrame{vec3(0.0f), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(0.0f)};

bool isFinite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

} // namespace

Status makePolygon(MeshPool& pool, std::span<const vec3> points, std::span<const uint32_t> loopSizes, Form& form) {
  const size_t total = std::accumulate(loopSizes.begin(), loopSizes.end(), size_t{0});
  if (loopSizes.empty() || total != points.size() || !std::all_of(points.begin(), points.end(), isFinite))
    return kGeometryBadArgument;
  if (total > kMaxFaceCorners) return kGeometryTooLarge;
  Attempt attempt(pool);
  vec3 low = points[0], high = points[0];
  for (const vec3& p : points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const vec3 extent = high - low;
  const float largest = std::max({extent.x, extent.y, extent.z});
  // Loops without repeated points.
  std::vector<std::vector<vec3>> loops;
  size_t first = 0;
  for (const uint32_t size : loopSizes) {
    std::vector<vec3> loop;
    for (const vec3& p : points.subspan(first, size)) {
      if (loop.empty() || glm::length(p - loop.back()) > 1e-6f * largest) loop.push_back(p);
    }
    while (loop.size() > 1 && glm::length(loop.front() - loop.back()) <= 1e-6f * largest) {
      loop.pop_back();
    }
    if (loop.size() < 3) return attempt.end(kGeometryBadArgument);
    loops.push_back(std::move(loop));
    first += size;
  }
  const auto areaVector = [](const std::vector<vec3>& loop) {
    vec3 sum(0.0f);
    for (size_t i = 0; i < loop.size(); ++i) {
      sum = plus3(sum, outer3(minus3(loop[i], loop[0]), minus3(loop[(i + 1) % loop.size()], loop[0])));
    }
    return sum;
  };
  const vec3 normal = unit3(areaVector(loops[0]));
  if (normal == vec3(0.0f)) return attempt.end(kGeometryNotSimple);
  for (size_t l = 1; l < loops.size(); ++l) {
    if (inner3(areaVector(loops[l]), normal) > 0) std::reverse(loops[l].begin(), loops[l].end());
  }
  const vec3 right = unit3(minus3(loops[0][1], loops[0][0]));
  const vec3 axisX = unit3(along3(right, normal, -inner3(right, normal)));
  Form made{{loops[0][0], axisX, normal, outer3(axisX, normal), vec3(0.0f)}, vec3(1.0f), 0};
  Builder b = newBuilder(pool, uint(total), uint(total), uint(loops.size()), 1, 0);
  beginFace(pool, b, 0);
  for (const std::vector<vec3>& loop : loops) {
    beginLoop(pool, b);
    for (const vec3& p : loop) {
      vec3 local = inScope(made.scope, minus3(p, made.scope.origin));
      if (std::fabs(local.y) > 1e-3f * largest) return attempt.end(kGeometryNotPlanar);
      if (std::fabs(local.y) < 1e-5f * largest) local.y = 0;
      addCorner(pool, b, addVertex(pool, b, local), 0);
    }
  }
  if (const Status status = finishForm(pool, b, made, true)) return attempt.end(status);
  if (const Status status = outlineOf(pool, made, 0).status) return attempt.end(status);
  form = made;
  return attempt.end(kGeometryOk);
}

Status makeMesh(MeshPool& pool, std::span<const vec3> positions, std::span<const uint32_t> corners,
                std::span<const uint32_t> faceSizes, std::span<const vec2> uvs, Form& form) {
  if (std::accumulate(faceSizes.begin(), faceSizes.end(), size_t{0}) != corners.size() ||
      (!uvs.empty() && uvs.size() != corners.size()) || !std::all_of(positions.begin(), positions.end(), isFinite) ||
      std::any_of(corners.begin(), corners.end(), [&](uint32_t c) { return c >= positions.size(); }))
    return kGeometryBadArgument;
  Attempt attempt(pool);
  Builder b = newBuilder(pool, uint(positions.size()), uint(corners.size()), uint(faceSizes.size()),
                         uint(faceSizes.size()), uvs.empty() ? 0 : 1);
  for (const vec3& p : positions) {
    addVertex(pool, b, p);
  }
  size_t at = 0;
  for (const uint32_t size : faceSizes) {
    if (size > kMaxFaceCorners) return attempt.end(kGeometryTooLarge);
    if (size >= 3) {
      beginFace(pool, b, 0);
      beginLoop(pool, b);
      for (size_t i = at; i < at + size; ++i) {
        const uint made = addCorner(pool, b, corners[i], 0);
        if (!uvs.empty()) setCornerUv(pool, b, 0, made, uvs[i]);
      }
    }
    at += size;
  }
  Form made{kFrame, vec3(1.0f), 0};
  const Status status = finishForm(pool, b, made, true);
  if (status <= kGeometryEmpty) form = made;
  return attempt.end(status);
}

Status insertPrimitive(MeshPool& pool, Form& form, Primitive primitive, uint32_t sides, uint32_t rings) {
  const bool flat = primitive == Primitive::Quad || primitive == Primitive::Disk;
  if (sides < 3 || sides > kMaxFaceCorners || rings < 2 || rings > kMaxFaceCorners) return kGeometryBadArgument;
  Attempt attempt(pool);
  const bool sphere = primitive == Primitive::Sphere;
  const bool square = primitive == Primitive::Cube || primitive == Primitive::Quad;
  const uint32_t columns = square ? 4 : sides;
  const uint32_t rows = sphere ? rings + 1 : 2;
  Builder b =
      newBuilder(pool, columns * rows + 2, 4 * columns * rows + 2 * columns, columns * rows + 2, columns * rows + 2, 1);
  // A unit box of the corner (0, 0, 0): rows of vertices upwards, columns counter-clockwise seen from above.
  const auto around = [&](uint32_t c) {
    if (square) {
      // from the front left corner to the right
      return vec2(c == 1 || c == 2 ? 1.0f : 0.0f, c < 2 ? 1.0f : 0.0f);
    }
    const vec2 sc = sineCosineDegrees(360.0f * float(c) / float(columns));
    return vec2(0.5f + 0.5f * sc.y, 0.5f - 0.5f * sc.x);
  };
  const auto ring = [&](float y, float radius) {
    const uint first = b.vertices;
    for (uint32_t c = 0; c < columns; ++c) {
      const vec2 p = around(c);
      addVertex(pool, b, vec3(0.5f + (p.x - 0.5f) * radius, y, 0.5f + (p.y - 0.5f) * radius));
    }
    return first;
  };
  const auto corner = [&](uint vertex, vec2 uv) { setCornerUv(pool, b, 0, addCorner(pool, b, vertex, 0), uv); };
  const auto end = [&](uint first, bool up) {
    beginFace(pool, b, 0);
    beginLoop(pool, b);
    for (uint32_t i = 0; i < columns; ++i) {
      const uint32_t c = up ? i : columns - 1 - i;
      const vec2 p = around(c);
      corner(first + c, vec2(p.x, up ? 1.0f - p.y : p.y));
    }
  };
  const auto band = [&](uint lower, uint upper, bool tip, bool bottomTip, float v0, float v1) {
    for (uint32_t c = 0; c < columns; ++c) {
      const uint32_t next = (c + 1) % columns;
      const float u0 = square ? 0.0f : float(c) / float(columns), u1 = square ? 1.0f : float(c + 1) / float(columns);
      beginFace(pool, b, 0);
      beginLoop(pool, b);
      if (bottomTip) {
        corner(lower, vec2(0.5f * (u0 + u1), v0));
      } else {
        corner(lower + c, vec2(u0, v0));
        corner(lower + next, vec2(u1, v0));
      }
      if (tip) {
        corner(upper, vec2(0.5f * (u0 + u1), v1));
      } else {
        corner(upper + next, vec2(u1, v1));
        corner(upper + c, vec2(u0, v1));
      }
    }
  };
  switch (primitive) {
  case Primitive::Quad:
  case Primitive::Disk: end(ring(0.0f, 1.0f), true); break;
  case Primitive::Cube:
  case Primitive::Cylinder: {
    const uint lower = ring(0.0f, 1.0f), upper = ring(1.0f, 1.0f);
    band(lower, upper, false, false, 0.0f, 1.0f);
    end(upper, true);
    end(lower, false);
    break;
  }
  case Primitive::Cone: {
    const uint lower = ring(0.0f, 1.0f);
    band(lower, addVertex(pool, b, vec3(0.5f, 1.0f, 0.5f)), true, false, 0.0f, 1.0f);
    end(lower, false);
    break;
  }
  case Primitive::Sphere: {
    uint below = addVertex(pool, b, vec3(0.5f, 0.0f, 0.5f));
    for (uint32_t r = 1; r <= rings; ++r) {
      const vec2 sc = sineCosineDegrees(180.0f * float(r) / float(rings));
      const float y = 0.5f - 0.5f * sc.y, v0 = float(r - 1) / float(rings), v1 = float(r) / float(rings);
      const uint above = r == rings ? addVertex(pool, b, vec3(0.5f, 1.0f, 0.5f)) : ring(y, sc.x);
      band(below, above, r == rings, r == 1, v0, v1);
      below = above;
    }
    break;
  }
  }
  uint mesh = 0;
  const Status status = finishMesh(pool, b, mesh);
  if (status != kGeometryOk) return attempt.end(status);
  vec3& size = form.scope.size;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(size[axis] > 0) && !(flat && axis == 1)) size[axis] = 1.0f;
  }
  if (flat) size.y = 0.0f;
  form.mesh = mesh;
  form.scale = size;
  if (flat) form.scale.y = 1.0f;
  return attempt.end(kGeometryOk);
}

Status insertForm(MeshPool& pool, Form& form, const Form& asset) {
  (void)pool;
  const vec3 from = asset.scope.size;
  vec3 size = form.scope.size;
  // The smallest factor that the given extents ask for scales the others.
  float factor = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] > 0 && from[axis] > 0) {
      const float f = divide(size[axis], from[axis]);
      factor = factor == 0.0f ? f : std::min(factor, f);
    }
  }
  if (factor == 0.0f) factor = 1.0f;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(size[axis] > 0)) size[axis] = multiply(from[axis], factor);
    const float f = from[axis] > 0 ? divide(size[axis], from[axis]) : 1.0f;
    form.scale[axis] = multiply(asset.scale[axis], f);
    if (!(from[axis] > 0)) size[axis] = 0;
  }
  form.mesh = asset.mesh;
  form.scope.size = size;
  return kGeometryOk;
}

Status combine(MeshPool& pool, std::span<const Form> forms, Form& combined) {
  if (forms.empty()) return kGeometryBadArgument;
  Attempt attempt(pool);
  uint vertices = 0, corners = 0, loops = 0, faces = 0, sets = 0;
  for (const Form& f : forms) {
    vertices += meshVertices(pool, f.mesh);
    corners += meshCorners(pool, f.mesh);
    loops += meshLoops(pool, f.mesh);
    faces += meshFaces(pool, f.mesh);
    sets |= meshUvSets(pool, f.mesh);
  }
  Form made = forms[0];
  Builder b = newBuilder(pool, vertices, corners, loops, faces, sets);
  for (const Form& f : forms) {
    const uint first = b.vertices;
    for (uint v = 0; v < meshVertices(pool, f.mesh); ++v) {
      const vec3 p = scopePoint(f.scope, scaled3(vertexPosition(pool, f.mesh, v), f.scale));
      addVertex(pool, b, inScope(made.scope, minus3(p, made.scope.origin)));
    }
    for (uint face = 0; face < meshFaces(pool, f.mesh); ++face) {
      copyFace(pool, b, f.mesh, face, first, false, 0);
    }
  }
  const Status status = finishForm(pool, b, made, true);
  if (status <= kGeometryEmpty) combined = made;
  return attempt.end(status);
}

} // namespace gpgp::spawn
