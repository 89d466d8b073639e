// Pixels of many triangles: what exact and conservative sampling miss there, by rays that snap nothing, of all pixels
// and of the worst one.
#include "measured_scenes.h"
#include "ray_scene_of.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace gpgp::test {
namespace {
using namespace visibility;

struct Dice {
  std::mt19937 engine;
  float unit() { return static_cast<float>(engine() >> 8) * 0x1p-24f; }
  float between(float a, float b) { return a + (b - a) * unit(); }
};

/// A pixel of a picture of 960 x 540, at 100 metres.
const float kPixel = 200 * std::tan(3.14159265f / 6) / 540;

/// Sets a camera of such a picture, and leaves the size x size pixels in its middle.
void lookFromAfar(Scene& scene, glm::vec3 eye, uint32_t size) {
  setWalkingCamera(scene, eye, {0, 0, 0}, 960, 540, true);
  scene = cropped(scene, 480 - size / 2, 270 - size / 2, size, size);
}

void addTriangle(Scene& scene, const std::array<glm::vec3, 3>& corners) {
  for (const glm::vec3& p : corners) scene.indices.push_back(scene.addVertex(p.x, p.y, p.z));
}

/// Leaves anywhere in a pixel, each up to `size` pixels to each side.
Scene leafCloud(uint32_t leaves, float size) {
  Scene scene;
  Dice dice{std::mt19937(1)};
  for (uint32_t i = 0; i < leaves; ++i) {
    const glm::vec3 middle(dice.between(0, kPixel), dice.between(0, kPixel), dice.between(-1, 1));
    std::array<glm::vec3, 3> corners{};
    for (glm::vec3& corner : corners)
      for (int axis = 0; axis < 3; ++axis) corner[axis] = middle[axis] + dice.between(-size, size) * kPixel;
    addTriangle(scene, corners);
  }
  scene.addDraw(scene.addMesh(0), glm::mat4(1.0f), shader::kTwoSided);
  lookFromAfar(scene, {0, 0, 100}, 4);
  return scene;
}

/// Fronds two pixels long from one place, as palms have them; width: of a half, in pixels.
Scene fronds(uint32_t count, float width) {
  Scene scene;
  Dice dice{std::mt19937(1)};
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 foot =
        glm::vec3(dice.between(0.4f, 0.6f), dice.between(0.4f, 0.6f), dice.between(-0.1f, 0.1f)) * kPixel;
    const float turn = dice.between(0, 6.28f), rise = dice.between(-0.8f, 0.8f);
    const glm::vec3 axis(std::cos(turn) * std::cos(rise), std::sin(turn) * std::cos(rise), std::sin(rise));
    const glm::vec3 side = glm::normalize(glm::cross(axis, {dice.between(-1, 1), dice.between(-1, 1), 0.3f})) * kPixel;
    addTriangle(scene, {foot - side * width, foot + side * width, foot + axis * (2 * kPixel)});
  }
  scene.addDraw(scene.addMesh(0), glm::mat4(1.0f), shader::kTwoSided);
  lookFromAfar(scene, {0, 0, 100}, 6);
  return scene;
}

/// Rough ground of so many cells a pixel, seen from a height in metres.
Scene ground(float cells, float height) {
  constexpr uint32_t kSide = 160;
  Scene scene;
  Dice dice{std::mt19937(1)};
  const float cell = kPixel / std::sqrt(cells), bump = cell * 0.7f;
  for (uint32_t y = 0; y <= kSide; ++y)
    for (uint32_t x = 0; x <= kSide; ++x)
      scene.addVertex((static_cast<float>(x) - kSide / 2.0f) * cell, dice.between(-bump, bump),
                      (static_cast<float>(y) - kSide / 2.0f) * cell);
  for (uint32_t y = 0; y < kSide; ++y)
    for (uint32_t x = 0; x < kSide; ++x) {
      const uint32_t a = y * (kSide + 1) + x, b = a + 1, c = a + kSide + 1, d = c + 1;
      scene.indices.insert(scene.indices.end(), {a, c, d, a, d, b});
    }
  scene.addDraw(scene.addMesh(0));
  lookFromAfar(scene, {0, height, 100}, 8);
  return scene;
}

struct Grade {
  uint32_t seen = 0, missed = 0, extra = 0, unresolved = 0;
  uint64_t area = 0, missedArea = 0;
};
Grade gradeOf(const std::vector<uint32_t>& areas, const CpuResult& result) {
  Grade g;
  g.unresolved = result.counters.unresolved;
  for (size_t i = 0; i < areas.size(); ++i) {
    const bool visible = (result.bits[i / 32] >> (i % 32) & 1) != 0;
    g.area += areas[i];
    if (areas[i] > 0) ++g.seen;
    if (areas[i] > 0 && !visible) ++g.missed, g.missedArea += areas[i];
    if (areas[i] == 0 && visible) ++g.extra;
  }
  return g;
}
Grade exactGradeOf(Scene& scene) {
  const RaySceneOf rays(scene);
  return gradeOf(rayReference(rays, scene, 64).areas(), sampleExactOnCpu(scene.input()));
}

std::vector<std::pair<std::string, Scene>> denseScenes() {
  std::vector<std::pair<std::string, Scene>> scenes;
  for (const uint32_t count : {10u, 100u, 300u, 1000u, 10000u}) {
    for (const float size : {0.05f, 0.2f, 0.6f})
      scenes.emplace_back(std::to_string(count) + " leaves of " + std::to_string(size), leafCloud(count, size));
    for (const float width : {0.01f, 0.05f})
      if (count < 10000)
        scenes.emplace_back(std::to_string(count) + " fronds of " + std::to_string(width), fronds(count, width));
  }
  for (const float cells : {1.0f, 10.0f, 50.0f, 150.0f, 500.0f})
    for (const float height : {10.0f, 60.0f})
      scenes.emplace_back("ground of " + std::to_string(cells) + " from " + std::to_string(height),
                          ground(cells, height));
  return scenes;
}

// What is missed has at most a sample or two. Whatever else is not right is counted.
TEST(DensePixels, WhatExactSamplingMissesIsFewOrCounted) {
  Grade all;
  for (auto& [name, scene] : denseScenes()) {
    const Grade g = exactGradeOf(scene);
    EXPECT_LE(g.missed, g.seen * 0.015 + 2) << name;
    EXPECT_LE(static_cast<double>(g.missedArea), static_cast<double>(g.area) * 0.005 + 1) << name;
    EXPECT_LE(g.extra, g.seen * 0.025 + 1 + g.unresolved) << name;
    all.seen += g.seen, all.missed += g.missed;
  }
  EXPECT_LE(all.missed, all.seen * 0.004);
  EXPECT_GT(all.seen, 100000u);
}

// Conservative sampling asks whether a pixel is touched, and may show all; so it misses less.
TEST(DensePixels, ConservativeSamplingMissesLess) {
  for (auto& [name, scene] : denseScenes()) {
    const RaySceneOf rays(scene);
    CpuInput input = scene.input();
    input.params.heuristics = 0;
    const Grade g = gradeOf(rayReference(rays, scene, 64).areas(), sampleConservativelyOnCpu(input));
    EXPECT_LE(g.missed, g.seen * 0.006) << name;
  }
}

// Each pixel alone, by the same rule: the worst one is not hidden among others.
TEST(DensePixels, TheWorstPixelToo) {
  uint32_t crowded = 0;
  for (auto& [name, scene] : denseScenes())
    for (uint32_t y = 0; y < scene.params.height; ++y)
      for (uint32_t x = 0; x < scene.params.width; ++x) {
        Scene pixel = cropped(scene, x, y, 1, 1);
        if (pixel.params.triangleCount < 100) continue;
        ++crowded;
        const Grade g = exactGradeOf(pixel);
        EXPECT_LE(g.missed, g.seen * 0.03 + 2) << name << ", " << x << ", " << y;
        EXPECT_LE(g.extra, g.seen * 0.06 + 5 + g.unresolved) << name << ", " << x << ", " << y;
      }
  EXPECT_GT(crowded, 200u);
}

// The scenes of the other tests, and of the results: by rays the goals are met that are stated there, 99 % with at most
// 1.5 % too many, but for those whose triangles are slivers.
TEST(DensePixels, AllScenesByRays) {
  std::vector<std::tuple<std::string, double, double, Scene>> scenes;
  const auto add = [&](const char* name, double found, double extra, Scene&& scene) -> Scene& {
    return std::get<3>(scenes.emplace_back(name, found, extra, std::move(scene)));
  };
  setOrbitCamera(add("bunnies", 0.998, 0.002, bunnyGrid(1, 2)), 1, 8, 3.0f, 96, 72);
  setWalkingCamera(add("foliage", 0.998, 0.002, foliage(4000)), {1, 1.7f, 7}, {0, 1.5f, 0}, 80, 45, true);
  setOrbitCamera(add("city", 0.998, 0.002, city(6)), 1, 8, 1.2f, 96, 54);
  setWalkingCamera(add("street", 0.997, 0.01, city(20)), {30, 1.7f, 30}, {100, 5, 100}, 160, 90, true);
  setWalkingCamera(add("colonnade", 0.996, 0.018, colonnadeWithWires(0.4f)), {0.3f, 1.7f, 3}, {0, 1.5f, -10}, 96, 54,
                   true);
  setWalkingCamera(add("fronts", 0.995, 0.01, houseFronts()), {12, 26, 60}, {0, 8, -20}, 160, 90, true);
  setWalkingCamera(add("far fronts", 0.99, 0.01, houseFronts()), {12, 26, 60}, {0, 8, -20}, 48, 27, true);
  setWalkingCamera(add("hedge", 0.99, 0.01, foliage(20000)), {1, 1.7f, 7}, {0, 1.5f, 0}, 12, 7, true);
  for (auto& [name, found, extra, scene] : scenes) {
    const Grade g = exactGradeOf(scene);
    EXPECT_GT(g.seen, 2000u) << name;
    EXPECT_LE(g.missed, g.seen * (1 - found)) << name;
    EXPECT_LE(g.extra, g.seen * extra + g.unresolved) << name;
    const RaySceneOf rays(scene);
    const Grade standard = gradeOf(rayReference(rays, scene, 64).areas(), sampleOnCpu(scene.input()));
    EXPECT_GT(standard.missed, g.seen * 0.2) << name; // or the scene tests nothing
  }
}

} // namespace
} // namespace gpgp::test
