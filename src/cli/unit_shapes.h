// Triangles of the unit shapes that spawn's terminals are: each spans [-0.5, 0.5], planar ones lie in z = 0, prisms
// stand along y. Those without area are left out.
#pragma once
#include <gpgp/spawn.h>

#include <glm/glm.hpp>

#include <vector>

namespace gpgp::cli {

/// Three corners per triangle, counter-clockwise from outside. Shapes with corners of their own (the dynamic ones) come
/// as their box.
std::vector<glm::vec3> unitShape(GpgpShape shape);
/// The unit shape's point p placed by the instance.
glm::vec3 placed(const GpgpInstance& instance, const glm::vec3& p);

} // namespace gpgp::cli
