// Convex pieces of faces, in double precision: what Boolean operations and strips along perimeters are made of.
#pragma once
#include "spawn/geometry/internal.h"

namespace gpgp::spawn {

struct Plane {
  glm::dvec3 normal{0};
  double at = 0;
  double height(const glm::dvec3& p) const { return glm::dot(normal, p) - at; }
};
struct Piece {
  std::vector<glm::dvec3> points;
  Plane plane;
  uint32_t tags = 0;
};

/// What of a polygon is in front of a plane and behind it; both are empty where it has no area there.
void divide(const Piece& piece, const Plane& plane, double slack, Piece& front, Piece& back);

/// Convex pieces of all faces, in metres along the axes of `scope` from its origin.
Status piecesOf(MeshPool& pool, const Form& form, const Scope& scope, uint32_t tags, std::vector<Piece>& pieces);

/// What of polygons lies outside all others, or inside any of them; all in one plane, the others apart. False: out of
/// steps.
bool cutFlat(MeshPool& pool, const std::vector<Piece>& pieces, const std::vector<Piece>& others, bool inside,
             double slack, std::vector<Piece>& kept);

/// The polygons as a form in its scope; where an edge passes a corner of another polygon it gets one.
Status join(MeshPool& pool, const std::vector<Piece>& pieces, double slack, Form& form);

} // namespace gpgp::spawn
