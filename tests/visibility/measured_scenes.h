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
/// A camera in a street of the city or between the columns, at eye height.
void setWalkingCamera(Scene& scene, glm::vec3 eye, glm::vec3 target, uint32_t width, uint32_t height,
                      bool reversed = false);

} // namespace gpgp::test
