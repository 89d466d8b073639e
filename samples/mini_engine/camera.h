// A camera that looks at a point. Right-handed world, +Y up; clip space is Vulkan's: +Y down, depth 0 to 1.
#pragma once
#include <glm/glm.hpp>

namespace mini {

struct Camera {
  glm::vec3 eye{0};
  glm::mat4 viewProjection{1};
  float daylight = 1; // 0: night
  /// As shaders have it.
  glm::vec4 eyeAndLight() const { return glm::vec4(eye, daylight); }
};

/// fieldOfView: vertical, radians. near and far: distances along the view direction, metres.
Camera lookAt(const glm::vec3& eye, const glm::vec3& target, float fieldOfView, float aspect, float near, float far);

} // namespace mini
