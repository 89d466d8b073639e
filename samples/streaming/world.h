// What server and client both have: the scene's geometry and materials, and the viewer's walk through it.
#pragma once
#include "camera.h"
#include "scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace streaming {

/// Of one draw; as shaders read it (surface.glsl).
struct Material {
  glm::vec3 colour; ///< linear reflectance
  float pattern;    ///< kPattern... of surface.glsl
};

struct World {
  mini::Model model;
  std::vector<Material> materials; ///< one for each draw
  /// Of all that both sides must agree in: triangles, places, materials.
  uint64_t hash() const;
  /// The draw's colour under mean light, RGBA in bytes, sRGB-encoded: what is shown of a triangle never seen before.
  std::vector<uint32_t> meanColours() const;
};

/// Streets of houses with fences, trees of single leaves and wires; 3 000 triangles a house, most of them thin.
/// houses: on each of the two sides of the street, 1 to 64.
World makeVillage(uint32_t houses);
/// A binary glTF 2 file, placed on the ground. Throws std::runtime_error where it cannot be read.
World loadWorld(const std::string& file);

/// Where the viewer is and looks, and how that changes.
struct View {
  glm::vec3 eye{0, 1.6f, 0}, forward{0, 0, -1}; ///< metres; forward has length 1
  glm::vec3 velocity{0};                        ///< metres per second
  float turnRate = 0, tiltRate = 0;             ///< radians per second, absolute
};
/// The walk at a time in seconds: along the street, looking to both sides; around the model where there is no street.
View walkAt(double seconds, const World& world);
/// Of a picture of this size; fieldOfView: vertical, radians.
mini::Camera cameraOf(const View& view, float fieldOfView, uint32_t width, uint32_t height);

} // namespace streaming
