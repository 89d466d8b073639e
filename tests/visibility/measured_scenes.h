// The scenes that coverage, overestimation and time are measured on: each generated from a few numbers, each with the
// geometry that makes one kind of visibility hard.
#pragma once
#include "scenes.h"

namespace gpgp::test {

/// Orbit camera k of n as `gpgp visibility` places it: towards the centre of the scene's bounding sphere, 20 degrees
/// above the horizon, 60 degrees vertical field of view, `distance` radii away.
void setOrbitCamera(Scene& scene, uint32_t k, uint32_t n, float distance, uint32_t width, uint32_t height,
                    bool reversed = false);

/// nx x nz bunnies (tests/data/fetch.sh --only models), turned differently, on a plane.
Scene bunnyGrid(uint32_t nx, uint32_t nz);
/// Two rows of fluted columns, wires between them, trees of single leaves and gratings; detail 1 is 0.1 million
/// triangles, and they grow with its square.
Scene colonnadeWithWires(float detail);
/// A hedge: leaves (two-sided, two triangles each) in a box, and a wall behind.
Scene foliage(uint32_t leaves);
/// Houses of boxes with window frames, in blocks x blocks streets; 10 million triangles at 160.
Scene city(uint32_t blocks);
/// A row of house fronts in the plane x = 0 whose ledges, windows, rails and cornices cut the walls and each other or
/// lie in one plane with them.
Scene houseFronts();
/// A camera in a street of the city or between the columns, at eye height.
void setWalkingCamera(Scene& scene, glm::vec3 eye, glm::vec3 target, uint32_t width, uint32_t height,
                      bool reversed = false);

/// A window of the scene's picture (pixels from its upper left corner), so that small pictures have the pixels of a
/// large one. Without the triangles that lie outside it for the camera and for others up to `margin` away (metres).
Scene cropped(const Scene& scene, uint32_t left, uint32_t top, uint32_t width, uint32_t height, float margin = 0);

} // namespace gpgp::test
