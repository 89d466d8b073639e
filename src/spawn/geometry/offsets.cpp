// Setbacks and offsets of faces, tapered extrusions, and rectangles within faces.
#include "spawn/geometry/waves.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn {

using namespace shader;

namespace {

/// Room for what a wavefront gives: each edge makes a face, and events corners.
Builder builderOfWaves(MeshPool& pool, const Form& form) {
  const uint corners = meshCorners(pool, form.mesh);
  return newBuilder(pool, 24 * corners + 64, 24 * corners + 64, 4 * corners + 16, 4 * corners + 16,
                    meshUvSets(pool, form.mesh));
}

void addWaveFace(MeshPool& pool, Builder& b, const Waves& w, const WaveFace& f, float slope, uint32_t tags) {
  beginFace(pool, b, tags);
  beginLoop(pool, b);
  for (const uint32_t node : f.nodes) {
    const vec3 p = w.nodes[node];
    addCorner(pool, b, addVertex(pool, b, fromPlane(w.outline.basis, vec2(p.x, p.y), multiply(p.z, slope))), 0);
  }
  if (b.status) return;
  // The edge's own tags, and those of the new edge.
  const uint first = workWord(pool, b.loopAt + kLoopWords * (b.loops - 1));
  for (uint i = 0; i < f.nodes.size(); ++i) {
    const bool isFront = i > 0 && f.beside[i] == kNone;
    setWorkWord(pool, b.cornerAt + kCornerWords * (first + i) + 1, isFront ? kTagSetback : 0u);
  }
}

} // namespace

Status setback(MeshPool& pool, const Form& form, std::span<const float> distances, std::vector<Form>& pieces,
               Form& remainder) {
  const uint corners = meshCorners(pool, form.mesh);
  if (distances.size() != corners) return kGeometryBadArgument;
  float largest = 0;
  for (const float d : distances) {
    if (!std::isfinite(d)) return kGeometryBadArgument;
    largest = std::max(largest, d);
  }
  Attempt attempt(pool);
  if (form.mesh == 0) return attempt.end(kGeometryEmpty);
  std::vector<Form> made(corners, Form{form.scope, vec3(1.0f), 0});
  Form rest = form;
  Waves w;
  Builder left = builderOfWaves(pool, form);
  std::vector<float> speeds;
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const Loop all = faceCorners(pool, form.mesh, f);
    float own = 0;
    for (uint c = 0; c < all.corners; ++c) {
      own = std::max(own, distances[all.firstCorner + c]);
    }
    if (own == 0) {
      const uint first = left.vertices;
      for (uint c = 0; c < all.corners; ++c) {
        addVertex(pool, left, localPosition(pool, form, all.firstCorner + c));
      }
      const Face face = faceOf(pool, form.mesh, f);
      beginFace(pool, left, face.tags);
      for (uint l = 0; l < face.loops; ++l) {
        const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
        beginLoop(pool, left);
        for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
          const uint corner = addCorner(pool, left, first + c - all.firstCorner, cornerTags(pool, form.mesh, c));
          copyCornerUv(pool, left, corner, form.mesh, c, c, 0.0f);
        }
      }
      continue;
    }
    speeds.clear();
    for (uint c = 0; c < all.corners; ++c) {
      speeds.push_back(divide(std::max(distances[all.firstCorner + c], 0.0f), own));
    }
    if (const Status status = makeWaves(pool, form, f, speeds, own, false, w)) return attempt.end(status);
    const uint mark = workMark(pool);
    for (const WaveFace& face : w.faces) {
      if (!(speeds[w.cornerOf[face.edge] - all.firstCorner] > 0)) continue;
      Builder b = newBuilder(pool, uint(face.nodes.size()), uint(face.nodes.size()), 1, 1, 0);
      addWaveFace(pool, b, w, face, 0.0f, faceOf(pool, form.mesh, f).tags);
      const Status status = finishForm(pool, b, made[w.cornerOf[face.edge]], true);
      if (status > kGeometryEmpty) return attempt.end(status);
    }
    releaseWork(pool, mark);
    addLoops(pool, left, w.outline.basis, w.fronts, 0.0f, false, faceOf(pool, form.mesh, f).tags, kTagSetback);
  }
  const Status status = finishForm(pool, left, rest, true);
  if (status > kGeometryEmpty) return attempt.end(status);
  if (status == kGeometryEmpty) rest.mesh = 0;
  pieces = std::move(made);
  remainder = rest;
  return attempt.end(kGeometryOk);
}

Status shapeWings(MeshPool& pool, const Form& form, float front, float right, float back, float left, Form& shape,
                  Form& remainder) {
  Attempt attempt(pool);
  if (form.mesh == 0) return attempt.end(kGeometryEmpty);
  const Axes axes = axesOf(form.scope);
  const std::pair<Selector, float> sides[] = {
      {Selector::Front, front}, {Selector::Right, right}, {Selector::Back, back}, {Selector::Left, left}};
  const Components edges(pool, form, Component::FaceEdges);
  std::vector<float> distances(edges.count(), 0.0f);
  for (uint c = 0; c < distances.size(); ++c) {
    for (const auto& [selector, distance] : sides) {
      if (distance > 0 && edges.matches(c, selector, axes)) distances[c] = distance;
    }
  }
  std::vector<Form> pieces;
  Form rest{};
  if (const Status status = setback(pool, form, distances, pieces, rest)) return attempt.end(status);
  std::erase_if(pieces, [](const Form& f) { return f.mesh == 0; });
  Form made{form.scope, vec3(1.0f), 0};
  if (!pieces.empty()) {
    if (const Status status = combine(pool, pieces, made)) return attempt.end(status);
    // Wings are one polygon.
    if (const Status status = cleanup(pool, made)) return attempt.end(status);
  }
  shape = made;
  remainder = rest;
  return attempt.end(kGeometryOk);
}

Status offset(MeshPool& pool, Form& form, float distance, OffsetPart part) {
  if (!std::isfinite(distance)) return kGeometryBadArgument;
  Attempt attempt(pool);
  if (form.mesh == 0) return attempt.end(kGeometryEmpty);
  if (distance == 0) return attempt.end(kGeometryOk);
  Form made = form;
  Waves w;
  Builder b = builderOfWaves(pool, form);
  b.uvSets = 0;
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const uint32_t tags = faceOf(pool, form.mesh, f).tags;
    if (const Status status = makeWaves(pool, form, f, {}, std::fabs(distance), distance > 0, w))
      return attempt.end(status);
    // Outwards, fronts have the polygon to their right.
    if (distance > 0)
      for (auto& loop : w.fronts) {
        std::reverse(loop.begin(), loop.end());
      }
    if (part != OffsetPart::Border) addLoops(pool, b, w.outline.basis, w.fronts, 0.0f, false, tags, kTagSetback);
    if (part != OffsetPart::Inside)
      for (const WaveFace& face : w.faces) {
        addWaveFace(pool, b, w, face, 0.0f, tags);
      }
  }
  const Status status = finishForm(pool, b, made, true);
  if (status <= kGeometryEmpty) form = made;
  return attempt.end(status);
}

Status extrudeTapered(MeshPool& pool, Form& form, float distance, float inset) {
  if (!std::isfinite(distance) || !std::isfinite(inset) || inset < 0) return kGeometryBadArgument;
  if (inset == 0) return extrude(pool, form, Extrusion::FaceNormal, distance);
  Attempt attempt(pool);
  if (form.mesh == 0) return attempt.end(kGeometryEmpty);
  Form made = form;
  Waves w;
  Builder b = builderOfWaves(pool, form);
  b.uvSets = 0;
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    if (const Status status = makeWaves(pool, form, f, {}, inset, false, w)) return attempt.end(status);
    const uint bottom = b.vertices;
    const Face face = faceOf(pool, form.mesh, f);
    const Loop all = faceCorners(pool, form.mesh, f);
    for (uint c = 0; c < all.corners; ++c) {
      addVertex(pool, b, localPosition(pool, form, all.firstCorner + c));
    }
    beginFace(pool, b, face.tags | kTagExtrudeBottom);
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      beginLoop(pool, b);
      for (uint i = loop.corners; i-- > 0;) {
        addCorner(pool, b, bottom + loop.firstCorner + i - all.firstCorner, 0);
      }
    }
    for (const WaveFace& side : w.faces) {
      addWaveFace(pool, b, w, side, divide(distance, inset), kTagExtrudeSide);
    }
    addLoops(pool, b, w.outline.basis, w.fronts, distance, false, face.tags | kTagExtrudeTop, 0);
  }
  Status status = finishForm(pool, b, made, true);
  if (status == kGeometryOk && distance < 0) status = reverseNormals(pool, made);
  if (status <= kGeometryEmpty) form = made;
  return attempt.end(status);
}

} // namespace gpgp::spawn
