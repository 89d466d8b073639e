// Extrusions, and pyramids.
#include "spawn/geometry/internal.h"

#include <cmath>

namespace gpgp::spawn {

using namespace shader;

namespace {

/// Along the mean normals of vertices at one place, lengthened so that faces move by the distance.
Status extrudeVertices(MeshPool& pool, Form& form, float distance) {
  const std::vector<uint32_t> welded = weldVertices(pool, form);
  const uint vertices = meshVertices(pool, form.mesh), corners = meshCorners(pool, form.mesh);
  const uint faces = meshFaces(pool, form.mesh), loops = meshLoops(pool, form.mesh);
  std::vector<vec3> sums(vertices, vec3(0.0f)), normals(faces);
  // Each face counts once at a place, by its angle there.
  for (uint f = 0; f < faces; ++f) {
    normals[f] = localNormal(pool, form, f);
    const Face face = faceOf(pool, form.mesh, f);
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
        const float angle = cornerAngle(pool, form, f, c - faceCorners(pool, form.mesh, f).firstCorner);
        vec3& sum = sums[welded[cornerVertex(pool, form.mesh, c)]];
        sum = along3(sum, normals[f], angle);
      }
    }
  }
  for (vec3& sum : sums) {
    sum = unit3(sum);
  }
  std::vector<float> reach(vertices, 0.0f);
  const std::vector<uint32_t> faceAt = cornerFaces(pool, form.mesh);
  for (uint c = 0; c < corners; ++c) {
    const uint v = welded[cornerVertex(pool, form.mesh, c)];
    const float cosine = std::max(inner3(sums[v], normals[faceAt[c]]), 0.2f);
    reach[v] = std::max(reach[v], divide(1.0f, cosine));
  }
  const std::vector<MeshEdge> edges = meshEdges(pool, form);
  Builder b = newBuilder(pool, 2 * vertices, 2 * corners + 4 * uint(edges.size()), 2 * loops + uint(edges.size()),
                         2 * faces + uint(edges.size()), meshUvSets(pool, form.mesh));
  copyVertices(pool, b, form);
  for (uint v = 0; v < vertices; ++v) {
    const uint w = welded[v];
    const vec3 p = scaled3(vertexPosition(pool, form.mesh, v), form.scale);
    addVertex(pool, b, along3(p, sums[w], multiply(distance, reach[w])));
  }
  const bool reversed = distance < 0;
  for (uint f = 0; f < faces; ++f) {
    copyFace(pool, b, form.mesh, f, 0, !reversed, kTagExtrudeBottom);
    copyFace(pool, b, form.mesh, f, vertices, reversed, kTagExtrudeTop);
  }
  for (const MeshEdge& e : edges) {
    if (e.faces != 1) continue;
    const Face face = faceOf(pool, form.mesh, e.face);
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      if (e.corner < loop.firstCorner || e.corner >= loop.firstCorner + loop.corners) continue;
      const uint v0 = cornerVertex(pool, form.mesh, e.corner);
      const uint v1 = cornerVertex(pool, form.mesh, nextCorner(loop, e.corner));
      beginFace(pool, b, kTagExtrudeSide);
      beginLoop(pool, b);
      addCorner(pool, b, reversed ? v1 : v0, 0);
      addCorner(pool, b, reversed ? v0 : v1, 0);
      addCorner(pool, b, (reversed ? v0 : v1) + vertices, 0);
      addCorner(pool, b, (reversed ? v1 : v0) + vertices, 0);
    }
  }
  return finishForm(pool, b, form, true);
}

} // namespace

Status extrude(MeshPool& pool, Form& form, Extrusion kind, float distance, vec3 direction) {
  if (!std::isfinite(distance)) return kGeometryBadArgument;
  Attempt attempt(pool);
  if (form.mesh == 0) return attempt.end(kGeometryEmpty);
  Form made = form;
  Status status = kGeometryOk;
  if (kind == Extrusion::VertexNormal) {
    if (distance != 0) status = extrudeVertices(pool, made, distance);
  } else {
    const uint how = kind == Extrusion::FaceNormal  ? kExtrudeFaceNormal
                     : kind == Extrusion::Direction ? kExtrudeDirection
                                                    : kExtrudeFlatTop;
    status = extrudeFaces(pool, made, how, distance, unit3(inScope(form.scope, direction)));
  }
  if (status <= kGeometryEmpty) form = made;
  return attempt.end(status);
}

Status taper(MeshPool& pool, Form& form, float distance) {
  if (!std::isfinite(distance)) return kGeometryBadArgument;
  Attempt attempt(pool);
  if (form.mesh == 0) return attempt.end(kGeometryEmpty);
  const uint faces = meshFaces(pool, form.mesh), corners = meshCorners(pool, form.mesh);
  Builder b = newBuilder(pool, meshVertices(pool, form.mesh) + faces, 4 * corners, meshLoops(pool, form.mesh) + corners,
                         faces + corners, meshUvSets(pool, form.mesh));
  copyVertices(pool, b, form);
  for (uint f = 0; f < faces; ++f) {
    const Face face = faceOf(pool, form.mesh, f);
    // The centroid of the face, holes taken out.
    const vec3 normal = localNormal(pool, form, f);
    const vec3 origin = localPosition(pool, form, faceCorners(pool, form.mesh, f).firstCorner);
    glm::dvec3 moment{};
    double weight = 0;
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
        const glm::dvec3 p(localPosition(pool, form, c) - origin);
        const glm::dvec3 q(localPosition(pool, form, nextCorner(loop, c)) - origin);
        const double twice = glm::dot(glm::dvec3(normal), glm::cross(p, q));
        weight += twice;
        moment += twice * (p + q) / 3.0;
      }
    }
    const vec3 middle = weight != 0 ? origin + vec3(moment / weight) : origin;
    const uint apex = addVertex(pool, b, along3(middle, normal, distance));
    const bool reversed = distance < 0;
    copyFace(pool, b, form.mesh, f, 0, !reversed, kTagExtrudeBottom);
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
        const uint v0 = cornerVertex(pool, form.mesh, c);
        const uint v1 = cornerVertex(pool, form.mesh, nextCorner(loop, c));
        beginFace(pool, b, kTagExtrudeSide);
        beginLoop(pool, b);
        addCorner(pool, b, reversed ? v1 : v0, cornerTags(pool, form.mesh, c));
        addCorner(pool, b, reversed ? v0 : v1, 0);
        addCorner(pool, b, apex, 0);
      }
    }
  }
  Form made = form;
  const Status status = finishForm(pool, b, made, true);
  if (status <= kGeometryEmpty) form = made;
  return attempt.end(status);
}

} // namespace gpgp::spawn
