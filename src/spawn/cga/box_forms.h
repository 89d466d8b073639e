// The three meshes that most shapes of a derivation are: a rectangle flat on the ground, an upright one, and a box.
//
// They fill their scopes, so that splits, components and extrusions of them are new scopes around the same meshes: no
// geometry is written. Results are those of the operators in src/spawn/geometry.
#pragma once
#include "spawn/geometry/geometry.h"

namespace gpgp::spawn::cga {

/// Written into each pool once, first of all.
struct BoxForms {
  uint32_t flat = 0;    ///< xz, normal +y, first edge along +x at the far end of z
  uint32_t upright = 0; ///< xy, normal +z, first edge along +x
  uint32_t box = 0;     ///< faces: bottom, front (+z), right, back, left, top
  bool areUsed = true;  ///< not where faces shall be told apart by their tags: these meshes have none

  void write(MeshPool& pool);
  bool is(const Form& form) const { return areUsed && isShared(form) && form.scale == form.scope.size; }
  /// Its mesh is one of these, which nothing may write to.
  bool isShared(const Form& form) const {
    return form.mesh != 0 && (form.mesh == box || form.mesh == flat || form.mesh == upright);
  }
  /// Fitted to the scope.
  Form make(const Scope& scope, uint32_t mesh) const;

  uint32_t faces(const Form& form) const { return form.mesh == box ? 6u : 1u; }
  /// As toComponent() does for faces.
  Form face(const Form& form, uint32_t face) const;
  vec3 normal(const Form& form, uint32_t face) const;
  /// Of a face as operator graphs count them: top, bottom, back, front, left, right; the one of a rectangle is 0.
  uint32_t number(const Form& form, uint32_t face) const {
    constexpr uint32_t kNumbers[6] = {1, 3, 5, 2, 4, 0};
    return form.mesh == box ? kNumbers[face] : 0;
  }
  /// Along the normal of a rectangle, up from it; false: it is a box.
  bool extrude(Form& form, float distance) const;
  float area(const Form& form) const;
  float volume(const Form& form) const;
};

/// From a place along an axis on; the form fills its scope.
Form sliceBox(const Form& form, uint32_t axis, float from, float extent);

} // namespace gpgp::spawn::cga
