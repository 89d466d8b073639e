// A village from a few numbers, or a model from a file.
#include "world.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>

namespace streaming {
namespace {

constexpr float kPlain = 0, kBricks = 1, kPlanks = 2, kTiles = 3, kGrass = 4; // surface.glsl
constexpr float kHousePitch = 11;                                             // metres from house to house

/// Meshes of quads: triangles 2n and 2n + 1 share a diagonal, so that each pair has one block of the atlas.
class Builder {
public:
  explicit Builder(World& world) : world_(world) {}

  void begin(const Material& material) {
    mesh_ = {static_cast<uint32_t>(world_.model.indices.size()), 0, 0};
    world_.materials.push_back(material);
  }
  void end() {
    mini::Model& model = world_.model;
    mesh_.indexCount = static_cast<uint32_t>(model.indices.size()) - mesh_.firstIndex;
    model.meshes.push_back(mesh_);
    model.addDraw(static_cast<uint32_t>(model.meshes.size() - 1), glm::mat4(1));
  }
  /// a, b, c, d counter-clockwise as seen from the front; in parts of at most `part` metres.
  void quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d, float part = 1.5f) {
    const auto parts = [part](float length) { return std::max(1u, static_cast<uint32_t>(std::ceil(length / part))); };
    const uint32_t columns = parts(std::max(glm::distance(a, b), glm::distance(d, c)));
    const uint32_t rows = parts(std::max(glm::distance(a, d), glm::distance(b, c)));
    const auto first = static_cast<uint32_t>(world_.model.positions.size() / 3);
    for (uint32_t y = 0; y <= rows; ++y)
      for (uint32_t x = 0; x <= columns; ++x) {
        const float u = static_cast<float>(x) / static_cast<float>(columns);
        const float v = static_cast<float>(y) / static_cast<float>(rows);
        const glm::vec3 p = glm::mix(glm::mix(a, b, u), glm::mix(d, c, u), v);
        world_.model.positions.insert(world_.model.positions.end(), {p.x, p.y, p.z});
        world_.model.normals.insert(world_.model.normals.end(), {0, 0, 0}); // flat
      }
    for (uint32_t y = 0; y < rows; ++y)
      for (uint32_t x = 0; x < columns; ++x) {
        const uint32_t i = first + y * (columns + 1) + x, below = i + columns + 1;
        world_.model.indices.insert(world_.model.indices.end(), {i, i + 1, below + 1, i, below + 1, below});
      }
  }
  void box(const glm::vec3& low, const glm::vec3& high, float part = 1.5f) {
    const auto at = [&](int i) {
      return glm::vec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    };
    constexpr std::array<std::array<int, 4>, 6> kSides = {
        {{0, 4, 6, 2}, {5, 1, 3, 7}, {0, 1, 5, 4}, {6, 7, 3, 2}, {1, 0, 2, 3}, {4, 5, 7, 6}}};
    for (const auto& side : kSides) quad(at(side[0]), at(side[1]), at(side[2]), at(side[3]), part);
  }

private:
  World& world_;
  GpgpMesh mesh_{};
};

/// One house in its garden: `way` is where the street lies, +1 or -1 in x.
void addHouse(Builder& builder, std::mt19937& random, const glm::vec3& foot, float way) {
  const auto chance = [&random](float low, float high) {
    return low + (high - low) * static_cast<float>(random() >> 8) / 16777216.0f;
  };
  const float halfX = chance(2.6f, 3.4f), halfZ = chance(2.8f, 3.8f), wall = chance(3.0f, 4.6f);
  const glm::vec3 walls = chance(0, 1) < 0.5f ? glm::vec3(0.55f, 0.27f, 0.18f) : glm::vec3(0.62f, 0.56f, 0.44f);
  builder.begin({walls, kBricks});
  builder.box(foot + glm::vec3(-halfX, 0, -halfZ), foot + glm::vec3(halfX, wall, halfZ));
  builder.end();

  builder.begin({{0.36f, 0.13f, 0.09f}, kTiles});
  const float over = 0.35f, ridge = wall + chance(1.6f, 2.4f);
  const auto at = [&](float x, float y, float z) { return foot + glm::vec3(x, y, z); };
  const float rx = halfX + over, rz = halfZ + over, eaves = wall - 0.1f;
  builder.quad(at(rx, eaves, rz), at(rx, eaves, -rz), at(0, ridge, -rz), at(0, ridge, rz));
  builder.quad(at(-rx, eaves, -rz), at(-rx, eaves, rz), at(0, ridge, rz), at(0, ridge, -rz));
  builder.quad(at(-halfX, wall, halfZ), at(halfX, wall, halfZ), at(0, ridge, halfZ), at(0, ridge, halfZ), 8);
  builder.quad(at(halfX, wall, -halfZ), at(-halfX, wall, -halfZ), at(0, ridge, -halfZ), at(0, ridge, -halfZ), 8);
  builder.end();

  // Windows with frames and glazing bars towards the street, a door.
  builder.begin({{0.75f, 0.73f, 0.68f}, kPlain});
  const float face = way * halfX;
  const auto bar = [&](float y0, float y1, float z0, float z1, float depth) {
    builder.box(at(std::min(face, face + way * depth), y0, z0), at(std::max(face, face + way * depth), y1, z1));
  };
  for (int i = -1; i <= 1; ++i) {
    const float z = static_cast<float>(i) * halfZ * 0.6f, low = i ? 1.0f : 0.0f, high = 2.2f;
    for (const float side : {-0.5f, 0.46f}) bar(low, high, z + side, z + side + 0.04f, 0.06f);
    bar(high, high + 0.05f, z - 0.55f, z + 0.55f, 0.09f);
    if (i == 0) continue;
    bar(low - 0.05f, low, z - 0.55f, z + 0.55f, 0.09f);
    for (int k = 1; k < 4; ++k)
      bar(low, high, z - 0.5f + 0.25f * static_cast<float>(k), z - 0.485f + 0.25f * static_cast<float>(k), 0.03f);
    for (int k = 1; k < 4; ++k)
      bar(low + 0.3f * static_cast<float>(k), low + 0.015f + 0.3f * static_cast<float>(k), z - 0.5f, z + 0.5f, 0.03f);
  }
  builder.end();
  builder.begin({{0.10f, 0.13f, 0.17f}, kPlain});
  for (int i = -1; i <= 1; ++i) {
    const float z = static_cast<float>(i) * halfZ * 0.6f;
    bar(i ? 1.0f : 0.0f, 2.2f, z - 0.46f, z + 0.46f, 0.01f);
  }
  builder.end();

  // A fence of pickets along the street.
  builder.begin({{0.52f, 0.44f, 0.33f}, kPlanks});
  const float fence = way * (halfX + 1.9f);
  for (float z = -kHousePitch * 0.5f; z < kHousePitch * 0.5f - 1.2f; z += 0.14f)
    builder.box(at(fence - 0.012f, 0.08f, z), at(fence + 0.012f, 0.95f + 0.05f * std::sin(z * 40.0f), z + 0.05f));
  for (const float y : {0.3f, 0.75f})
    builder.box(at(fence - 0.03f, y, -kHousePitch * 0.5f), at(fence - 0.012f, y + 0.05f, kHousePitch * 0.5f - 1.2f));
  builder.end();

  // A tree beside the house, of single leaves.
  const glm::vec3 tree = at(way * (halfX + chance(0.6f, 1.2f)), 0, halfZ + chance(0.7f, 1.2f));
  const float crown = chance(2.6f, 3.6f);
  builder.begin({{0.20f, 0.14f, 0.09f}, kPlanks});
  builder.box(tree + glm::vec3(-0.1f, 0, -0.1f), tree + glm::vec3(0.1f, crown, 0.1f));
  builder.end();
  builder.begin({{0.13f, 0.27f, 0.06f}, kPlain});
  for (int i = 0; i < 420; ++i) {
    const float around = chance(0, glm::two_pi<float>()), up = chance(-1, 1), out = std::cbrt(chance(0, 1)) * 1.3f;
    const float flat = std::sqrt(1 - up * up);
    const glm::vec3 middle =
        tree + glm::vec3(0, crown, 0) + out * glm::vec3(flat * std::cos(around), up, flat * std::sin(around));
    const glm::vec3 along = glm::normalize(glm::vec3(chance(-1, 1), chance(-1, 0.4f), chance(-1, 1.01f)));
    const glm::vec3 across = glm::normalize(glm::cross(along, glm::vec3(0.3f, 1, 0.2f))) * 0.07f;
    builder.quad(middle - along * 0.11f, middle + across, middle + along * 0.11f, middle - across);
  }
  builder.end();
}

glm::vec3 lightOf(float up) { // mean of the sun's and the sky's, as surface.glsl has them
  return glm::vec3(0.75f, 0.70f, 0.62f) * (0.6f + 0.3f * up);
}

uint32_t encoded(const glm::vec3& linear) {
  uint32_t word = 0xff000000u;
  for (int i = 0; i < 3; ++i) {
    const float c = std::clamp(linear[i], 0.0f, 1.0f);
    const float s = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
    word |= static_cast<uint32_t>(s * 255.0f + 0.5f) << (8 * i);
  }
  return word;
}

} // namespace

uint64_t World::hash() const {
  uint64_t value = 14695981039346656037ull; // FNV-1a
  const auto add = [&value](const void* data, size_t bytes) {
    for (size_t i = 0; i < bytes; ++i) value = (value ^ static_cast<const uint8_t*>(data)[i]) * 1099511628211ull;
  };
  add(model.positions.data(), model.positions.size() * sizeof(float));
  add(model.indices.data(), model.indices.size() * sizeof(uint32_t));
  add(model.meshes.data(), model.meshes.size() * sizeof(GpgpMesh));
  add(model.draws.data(), model.draws.size() * sizeof(GpgpVisibilityDraw));
  add(materials.data(), materials.size() * sizeof(Material));
  return value;
}

std::vector<uint32_t> World::meanColours() const {
  std::vector<uint32_t> colours;
  for (const Material& material : materials)
    colours.push_back(encoded(material.colour * lightOf(material.pattern == kGrass ? 1.0f : 0.0f)));
  return colours;
}

World makeVillage(uint32_t houses) {
  if (houses < 1 || houses > 64) throw std::runtime_error("a village has 1 to 64 houses on each side of its street");
  World world;
  world.model.name = "village of " + std::to_string(2 * houses) + " houses";
  Builder builder(world);
  std::mt19937 random(7);
  const float length = kHousePitch * static_cast<float>(houses), end = 14;
  builder.begin({{0.16f, 0.24f, 0.08f}, kGrass});
  for (const float side : {-1.0f, 1.0f}) {
    const float x0 = side < 0 ? -20.0f : 2.5f, x1 = side < 0 ? -2.5f : 20.0f;
    builder.quad({x0, 0, end}, {x1, 0, end}, {x1, 0, -length - end}, {x0, 0, -length - end}, 2.2f);
  }
  builder.end();
  builder.begin({{0.33f, 0.31f, 0.29f}, kTiles});
  builder.quad({-2.5f, 0, end}, {2.5f, 0, end}, {2.5f, 0, -length - end}, {-2.5f, 0, -length - end}, 1.3f);
  builder.end();
  for (uint32_t i = 0; i < houses; ++i)
    for (const float side : {-1.0f, 1.0f})
      addHouse(builder, random, {side * 8.2f, 0, -kHousePitch * (static_cast<float>(i) + 0.5f)}, -side);
  // Poles with three wires along the street.
  builder.begin({{0.18f, 0.14f, 0.11f}, kPlanks});
  for (uint32_t i = 0; i <= houses; ++i) {
    const float z = -kHousePitch * static_cast<float>(i);
    builder.box({2.6f, 0, z - 0.08f}, {2.76f, 5.6f, z + 0.08f});
    builder.box({2.0f, 5.2f, z - 0.04f}, {3.36f, 5.28f, z + 0.04f});
    if (i == houses) break;
    for (const float x : {2.1f, 2.68f, 3.26f})
      for (int part = 0; part < 12; ++part) {
        const auto sag = [&](int k) {
          const float t = static_cast<float>(k) / 12;
          return glm::vec3(x, 5.3f - 0.5f * 4 * t * (1 - t), z - kHousePitch * t);
        };
        const glm::vec3 a = sag(part), b = sag(part + 1), right(0.009f, 0, 0), up(0, 0.009f, 0);
        builder.quad(a - right, a + up, b + up, b - right, 4);
        builder.quad(a + up, a + right, b + right, b + up, 4);
        builder.quad(a + right, a - right, b - right, b + right, 4);
      }
  }
  builder.end();
  for (GpgpVisibilityDraw& draw : world.model.draws) draw.flags = GPGP_DRAW_TWO_SIDED; // the display culls nothing
  return world;
}

World loadWorld(const std::string& file) {
  World world;
  world.model = mini::loadGltf(file);
  world.model.place(12, 0);
  for (size_t i = 0; i < world.model.draws.size(); ++i) {
    const auto part = static_cast<float>(i % 7) / 7;
    world.materials.push_back({{0.55f - 0.2f * part, 0.42f, 0.3f + 0.2f * part}, kPlanks});
    world.model.draws[i].flags = GPGP_DRAW_TWO_SIDED;
  }
  return world;
}

View walkAt(double seconds, const World& world) {
  const auto poseAt = [&](double time) {
    const auto t = static_cast<float>(time);
    View view;
    float yaw = 0.0f, tilt = 0.0f;
    if (world.materials[0].pattern == kGrass) {
      const float reach = std::max(4.0f, -world.model.low.z - 18), z = std::fmod(1.4f * t, 2 * reach);
      view.eye = {0.9f * std::sin(0.35f * t), 1.65f + 0.03f * std::sin(9.0f * t), 4 - (z < reach ? z : 2 * reach - z)};
      yaw = 0.65f * std::sin(0.7f * t);
      tilt = 0.08f * std::sin(0.5f * t);
    } else {
      const glm::vec3 middle = 0.5f * (world.model.low + world.model.high);
      const float radius = glm::length(world.model.high - world.model.low);
      yaw = 0.12f * t;
      view.eye = middle + radius * glm::vec3(std::sin(yaw), 0.15f, std::cos(yaw));
      tilt = -0.15f;
    }
    view.forward = {-std::sin(yaw) * std::cos(tilt), std::sin(tilt), -std::cos(yaw) * std::cos(tilt)};
    return view;
  };
  constexpr double kStep = 1e-2;
  View view = poseAt(seconds);
  const View next = poseAt(seconds + kStep);
  view.velocity = (next.eye - view.eye) / static_cast<float>(kStep);
  const auto heading = [](const glm::vec3& f) { return std::atan2(-f.x, -f.z); };
  const float turn = std::remainder(heading(next.forward) - heading(view.forward), glm::two_pi<float>());
  view.turnRate = std::abs(turn) / static_cast<float>(kStep);
  view.tiltRate = std::abs(std::asin(next.forward.y) - std::asin(view.forward.y)) / static_cast<float>(kStep);
  return view;
}

mini::Camera cameraOf(const View& view, float fieldOfView, uint32_t width, uint32_t height) {
  return mini::lookAt(view.eye, view.eye + view.forward, fieldOfView,
                      static_cast<float>(width) / static_cast<float>(height), 0.1f, 400.0f);
}

} // namespace streaming
