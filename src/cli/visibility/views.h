// The cameras of `gpgp visibility`: from a file, on an orbit, and those of a view cell round one.
#pragma once
#include "cli/shared/common.h"
#include "cli/shared/painter.h"

#include <gpgp/visibility.h>

#include <optional>

namespace gpgp::cli {

/// Of positions and moves, from the origin: a camera's numbers are products of two lengths.
constexpr float kMostReach = 1e18f;

struct View {
  glm::mat4 camera{1.0f};
  bool reversed = false;
};

/// Camera k of n on a circle 20 degrees above the horizon, 60 degrees of vertical field of view, `distance` radii of
/// the bounds away.
View orbitView(const Bounds& bounds, uint32_t k, uint32_t n, float distance, Size size);

/// 16 numbers, column-major, world to clip; a 17th that is not 0: near is 1. The view is from where positions count
/// from `origin`. Throws Failure where the file holds anything else, or a matrix without inverse.
View readView(const std::string& file, const glm::dvec3& origin);

/// Where a camera's x, y and w are all 0; parallel cameras have no such place.
std::optional<glm::dvec3> eyeOf(const View& view);

/// A view cell, but for its camera: COLUMNSxROWS[/SKIP] in pixels, or RADIUS:POINTS in world units, a square number of
/// them; none: one view.
struct Cell {
  GpgpViewCellInfo info = GPGP_VIEW_CELL_INFO_INIT;
  std::vector<float> points;

  explicit Cell(const std::string& spec);
};

/// The views of a cell; one of its pixels is one of the picture's where `centre` lies.
std::vector<View> viewsOf(const Cell& cell, const View& view, const glm::vec3& centre, uint32_t height);

} // namespace gpgp::cli
