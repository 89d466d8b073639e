// View and projection in one matrix.
#include "camera.h"

#include <algorithm>
#include <cmath>

namespace mini {

Camera lookAt(const glm::vec3& eye, const glm::vec3& target, float fieldOfView, float aspect, float near, float far) {
  const glm::vec3 back = glm::normalize(eye - target);
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back));
  const glm::vec3 up = glm::cross(back, right);
  const glm::mat4 view(glm::vec4(right.x, up.x, back.x, 0), glm::vec4(right.y, up.y, back.y, 0),
                       glm::vec4(right.z, up.z, back.z, 0),
                       glm::vec4(-glm::dot(right, eye), -glm::dot(up, eye), -glm::dot(back, eye), 1));
  constexpr float kAcross = 16.0f / 9.0f; // a narrower picture shows as much across, and more above and below
  const float scale = std::min(1.0f, aspect / kAcross) / std::tan(fieldOfView * 0.5f);
  glm::mat4 projection(0.0f);
  projection[0][0] = scale / aspect;
  projection[1][1] = -scale; // +Y of the view is up, of clip space down
  projection[2][2] = far / (near - far);
  projection[2][3] = -1.0f;
  projection[3][2] = near * far / (near - far);
  return {eye, projection * view};
}

} // namespace mini
