#include "spawn/cga/box_forms.h"

#include <array>
#include <cmath>

namespace gpgp::spawn::cga {

using namespace shader;

namespace {

/// Quadrilaterals; a texture covers each.
uint32_t writeMesh(MeshPool& pool, std::span<const vec3> vertices, std::span<const std::array<uint32_t, 4>> faces) {
  const uint32_t count = static_cast<uint32_t>(faces.size());
  const uint32_t mesh = takePool(pool, kMeshHeader);
  const uint32_t faceRange = takePool(pool, count * kFaceWords), loopRange = takePool(pool, count * kLoopWords);
  const uint32_t cornerRange = takePool(pool, 4 * count * kCornerWords);
  const uint32_t positions = takePool(pool, static_cast<uint32_t>(3 * vertices.size()));
  if (!mesh || !faceRange || !loopRange || !cornerRange || !positions) return 0;
  for (uint32_t i = 0; i < kMeshHeader; ++i) setPoolWord(pool, mesh + i, 0);
  setPoolWord(pool, mesh + kMeshFaces, count);
  setPoolWord(pool, mesh + kMeshLoops, count);
  setPoolWord(pool, mesh + kMeshCorners, 4 * count);
  setPoolWord(pool, mesh + kMeshVertices, static_cast<uint32_t>(vertices.size()));
  setPoolWord(pool, mesh + kMeshFaceRange, faceRange);
  setPoolWord(pool, mesh + kMeshLoopRange, loopRange);
  setPoolWord(pool, mesh + kMeshCornerRange, cornerRange);
  setPoolWord(pool, mesh + kMeshPositionRange, positions);
  for (uint32_t f = 0; f < count; ++f) {
    setPoolWord(pool, faceRange + f * kFaceWords, f);
    setPoolWord(pool, faceRange + f * kFaceWords + 1, 1);
    setPoolWord(pool, faceRange + f * kFaceWords + 2, 0);
    setPoolWord(pool, loopRange + f * kLoopWords, 4 * f);
    setPoolWord(pool, loopRange + f * kLoopWords + 1, 4);
    for (uint32_t c = 0; c < 4; ++c) {
      setPoolWord(pool, cornerRange + (4 * f + c) * kCornerWords, faces[f][c]);
      setPoolWord(pool, cornerRange + (4 * f + c) * kCornerWords + 1, 0);
    }
  }
  for (uint32_t v = 0; v < vertices.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      setPoolWord(pool, positions + 3 * v + axis, floatBitsToUint(vertices[v][axis]));
  return mesh;
}

} // namespace

void BoxForms::write(MeshPool& pool) {
  const std::array<vec3, 8> v = {vec3(0, 0, 1), vec3(1, 0, 1), vec3(1, 0, 0), vec3(0, 0, 0),
                                 vec3(0, 1, 1), vec3(1, 1, 1), vec3(1, 1, 0), vec3(0, 1, 0)};
  const std::array<vec3, 4> xy = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)};
  const std::array<std::array<uint32_t, 4>, 1> one = {{{0, 1, 2, 3}}};
  const std::array<std::array<uint32_t, 4>, 6> six = {
      {{3, 2, 1, 0}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}}};
  flat = writeMesh(pool, std::span(v).first(4), one);
  upright = writeMesh(pool, xy, one);
  box = writeMesh(pool, v, six);
}

Form BoxForms::make(const Scope& scope, uint32_t mesh) const {
  Form form;
  form.scope = scope;
  form.scale = scope.size;
  form.mesh = mesh;
  return form;
}

Form BoxForms::face(const Form& form, uint32_t face) const {
  const Scope& s = form.scope;
  const vec3 x = s.axisX, y = s.axisY, z = s.axisZ;
  if (form.mesh == upright) return form;
  Scope to;
  const uint32_t which = form.mesh == flat ? 5 : face;
  switch (which) {
  case 0: to = {s.origin, x, z, -y, {s.size.x, s.size.z, 0}}; break;
  case 1: to = {s.origin + z * s.size.z, x, y, z, {s.size.x, s.size.y, 0}}; break;
  case 2: to = {s.origin + x * s.size.x + z * s.size.z, -z, y, x, {s.size.z, s.size.y, 0}}; break;
  case 3: to = {s.origin + x * s.size.x, -x, y, -z, {s.size.x, s.size.y, 0}}; break;
  case 4: to = {s.origin, z, y, -x, {s.size.z, s.size.y, 0}}; break;
  default: to = {s.origin + y * s.size.y + z * s.size.z, x, -z, y, {s.size.x, s.size.z, 0}}; break;
  }
  return make(to, upright);
}

vec3 BoxForms::normal(const Form& form, uint32_t face) const {
  const Scope& s = form.scope;
  if (form.mesh == flat) return s.axisY;
  if (form.mesh == upright) return s.axisZ;
  const vec3 normals[6] = {-s.axisY, s.axisZ, s.axisX, -s.axisZ, -s.axisX, s.axisY};
  return normals[face];
}

bool BoxForms::extrude(Form& form, float distance) const {
  if (form.mesh == box || !(distance > 0)) return false;
  if (form.mesh == flat)
    form.scope.size.y = distance;
  else
    form.scope.size.z = distance;
  form = make(form.scope, box);
  return true;
}

float BoxForms::area(const Form& form) const {
  const vec3 e = form.scope.size;
  if (form.mesh == flat) return e.x * e.z;
  if (form.mesh == upright) return e.x * e.y;
  return 2 * (e.x * e.y + e.y * e.z + e.z * e.x);
}

float BoxForms::volume(const Form& form) const {
  const vec3 e = form.scope.size;
  return form.mesh == box ? e.x * e.y * e.z : 0.0f;
}

Form sliceBox(const Form& form, uint32_t axis, float from, float extent) {
  Form piece = form;
  const vec3 direction = axis == 0 ? form.scope.axisX : axis == 1 ? form.scope.axisY : form.scope.axisZ;
  piece.scope.origin += direction * from;
  piece.scope.size[static_cast<int>(axis)] = extent;
  piece.scale = piece.scope.size;
  return piece;
}

} // namespace gpgp::spawn::cga
