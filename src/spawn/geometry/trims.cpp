// Planes in which faces meet, by which what is inserted into a face is cut off; and normals across edges.
#include "spawn/geometry/internal.h"

#include <cmath>
#include <unordered_map>

namespace gpgp::spawn {

using namespace shader;

namespace {

/// The plane between two faces with an edge at `at`: of faces that lean towards each other as of those that lean away
/// it bisects the angle, and the face's own side is in front.
bool planeBetween(vec3 own, vec3 other, vec3 at, vec3 out, TrimPlane& plane) {
  vec3 normal = minus3(own, other);
  const float length = std::sqrt(inner3(normal, normal));
  if (length < 1e-4f) { // one plane: at right angles to it
    normal = out * -1.0f;
  } else {
    normal = normal * (1.0f / length);
    if (length > 1.99999f) return false; // back to back: there is no plane between
    if (inner3(normal, out) > 0) normal = normal * -1.0f;
  }
  plane.normal = normal;
  plane.offset = inner3(normal, at);
  return true;
}

} // namespace

std::vector<std::vector<TrimPlane>> trimPlanes(MeshPool& pool, const Form& form) {
  std::vector<std::vector<TrimPlane>> planes(meshFaces(pool, form.mesh));
  std::vector<vec3> normals;
  for (uint32_t f = 0; f < planes.size(); ++f) normals.push_back(faceNormal(pool, form, f));
  for (const MeshEdge& edge : meshEdges(pool, form)) {
    if (edge.faces != 2) continue;
    for (const bool first : {true, false}) {
      const uint32_t face = first ? edge.face : edge.otherFace, other = first ? edge.otherFace : edge.face;
      const uint32_t corner = first ? edge.corner : edge.otherCorner;
      if (face == other) continue;
      const Face found = faceOf(pool, form.mesh, face);
      Loop loop = loopOf(pool, form.mesh, found.firstLoop);
      for (uint32_t l = 0; l < found.loops; ++l) {
        loop = loopOf(pool, form.mesh, found.firstLoop + l);
        if (corner < loop.firstCorner + loop.corners) break;
      }
      const vec3 from = framePosition(pool, form, corner), to = framePosition(pool, form, nextCorner(loop, corner));
      const vec3 along = unit3(minus3(to, from));
      TrimPlane plane;
      plane.along = along;
      if (planeBetween(normals[face], normals[other], from, outer3(along, normals[face]), plane))
        planes[face].push_back(plane);
    }
  }
  return planes;
}

void softenNormals(std::span<OutputVertex> vertices, float degrees) {
  if (!(degrees > 0) || vertices.empty()) return;
  vec3 low = vertices[0].position, high = low;
  for (const OutputVertex& v : vertices)
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::fmin(low[axis], v.position[axis]);
      high[axis] = std::fmax(high[axis], v.position[axis]);
    }
  const vec3 extent = high - low;
  const double cell = 1e-5 * std::fmax(1e-3, std::fmax(extent.x, std::fmax(extent.y, extent.z)));
  const auto key = [&](vec3 p) {
    uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis)
      hash = hash * 0x9e3779b97f4a7c15u + static_cast<uint64_t>(std::llround((p[axis] - low[axis]) / cell));
    return hash;
  };
  std::unordered_map<uint64_t, std::vector<size_t>> places;
  for (size_t i = 0; i < vertices.size(); ++i) places[key(vertices[i].position)].push_back(i);
  const float least = sineCosineDegrees(degrees < 180 ? degrees : 180).y;
  std::vector<vec3> soft(vertices.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    vec3 sum(0);
    for (const size_t k : places[key(vertices[i].position)])
      if (degrees >= 180 || k == i || inner3(vertices[i].normal, vertices[k].normal) > least) sum += vertices[k].normal;
    const float length = std::sqrt(inner3(sum, sum));
    soft[i] = length > 1e-6f ? sum * (1.0f / length) : vertices[i].normal;
  }
  for (size_t i = 0; i < vertices.size(); ++i) vertices[i].normal = soft[i];
}

} // namespace gpgp::spawn
