// The reference by rays: against closed forms and against trying each triangle for each ray; cracks, ties, faces. And
// the methods against it, on small pictures of the measured scenes.
#include "measured_scenes.h"
#include "ray_scene_of.h"
#include "visibility/reference/ray_segments.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>
#include <random>

namespace gpgp::test {
namespace {
using namespace visibility;

/// x and y are the picture's, z is depth.
Scene flat(uint32_t width, uint32_t height) {
  Scene scene;
  scene.setCamera(glm::mat4(1.0f), width, height);
  return scene;
}

/// A rectangle of two triangles that face the camera.
void addRectangle(Scene& scene, glm::vec3 low, glm::vec3 high) {
  const uint32_t a = scene.addVertex(low.x, low.y, low.z), b = scene.addVertex(high.x, low.y, low.z),
                 c = scene.addVertex(high.x, high.y, high.z), d = scene.addVertex(low.x, high.y, high.z);
  scene.indices.insert(scene.indices.end(), {a, c, b, a, d, c});
}

uint32_t countOf(const std::vector<uint32_t>& bits) {
  uint32_t count = 0;
  for (const uint32_t word : bits) count += static_cast<uint32_t>(std::popcount(word));
  return count;
}

TEST(RayReference, HalvesOfAPictureShareItWithoutLeak) {
  for (const uint32_t samples : {1u, 4u, 16u, 64u}) {
    Scene scene = flat(8, 4);
    addRectangle(scene, {-1, -1, 0.5f}, {1, 1, 0.5f});
    scene.addDraw(scene.addMesh(0));
    const RaySceneOf rays(scene);
    const std::vector<uint32_t> areas = rayReference(rays, scene, samples).areas();
    const uint64_t all = samples == 1 ? 32 : 32 * (uint64_t(samples) * samples + 1);
    EXPECT_EQ(areas[0] + areas[1], all) << samples;
    // What lies on the diagonal is both's: the lower number's.
    EXPECT_GE(areas[0], areas[1]) << samples;
    EXPECT_NEAR(static_cast<double>(areas[0]), static_cast<double>(all) / 2, 8.0 * samples) << samples;
  }
}

TEST(RayReference, NearnessDecidesAndThenTheLowerNumber) {
  for (const bool reversed : {false, true}) {
    Scene scene = flat(4, 4);
    addRectangle(scene, {-1, -1, 0.6f}, {1, 1, 0.6f}); // 0, 1
    addRectangle(scene, {-1, -1, 0.4f}, {0, 1, 0.4f}); // 2, 3
    addRectangle(scene, {-1, -1, 0.4f}, {0, 1, 0.4f}); // 4, 5
    scene.addDraw(scene.addMesh(0));
    scene.params.reversedDepth = reversed;
    const RaySceneOf rays(scene);
    EXPECT_EQ(rayReference(rays, scene, 8).bits()[0], reversed ? 0b000011u : 0b001111u);
  }
}

// Turning the corners of the same triangle changes nothing of where it lies.
TEST(RayReference, TheSameTriangleTwiceIsTheLowerNumber) {
  Scene scene = foliage(500);
  const std::vector<uint32_t> first = scene.indices;
  for (shader::Mesh& mesh : scene.meshes) {
    const uint32_t begin = static_cast<uint32_t>(scene.indices.size());
    for (uint32_t i = mesh.firstIndex; i < mesh.firstIndex + mesh.indexCount; i += 3)
      scene.indices.insert(scene.indices.end(), {first[i + 1], first[i + 2], first[i]});
    mesh.firstIndex = begin;
  }
  const uint32_t half = scene.params.triangleCount;
  std::vector<shader::Draw> draws = scene.draws;
  const auto meshes = static_cast<uint32_t>(scene.meshes.size());
  for (uint32_t mesh = 0, begin = 0; mesh < meshes; ++mesh) {
    scene.meshes.push_back({begin, scene.meshes[mesh].indexCount, scene.meshes[mesh].vertexOffset});
    begin += scene.meshes[mesh].indexCount;
  }
  for (shader::Draw draw : draws) {
    draw.mesh += meshes;
    draw.firstTriangle += half;
    scene.draws.push_back(draw);
  }
  scene.params.triangleCount *= 2;
  setWalkingCamera(scene, {1, 1.7f, 7}, {0, 1.5f, 0}, 64, 36, true);
  const RaySceneOf rays(scene);
  const std::vector<uint32_t> areas = rayReference(rays, scene, 16).areas();
  uint32_t lower = 0;
  for (uint32_t i = 0; i < half; ++i) {
    lower += areas[i] > 0;
    EXPECT_EQ(areas[half + i], 0u) << i;
  }
  EXPECT_GT(lower, 300u);
}

TEST(RayReference, FacesAreAsTheDrawsSay) {
  const glm::mat4 mirror = glm::scale(glm::mat4(1.0f), {-1, 1, 1});
  for (const auto& [transform, flags, seen] : {std::tuple(glm::mat4(1.0f), 0u, true),
                                               {glm::mat4(1.0f), shader::kClockwise, false},
                                               {mirror, 0u, true},
                                               {mirror, shader::kClockwise, false},
                                               {mirror, shader::kTwoSided | shader::kClockwise, true}}) {
    Scene scene = flat(4, 4);
    addRectangle(scene, {-1, -1, 0.5f}, {1, 1, 0.5f});
    scene.addDraw(scene.addMesh(0), transform, flags);
    const RaySceneOf rays(scene);
    EXPECT_EQ(countOf(rayReference(rays, scene, 4).bits()), seen ? 2u : 0u) << flags;
  }
}

/// Where the ray through a point of the picture (pixels) meets a triangle: homogeneous coordinates, without clipping or
/// projecting (as oracle.cpp). margin: how far, in shares of the triangle, it is from not doing so or from the reverse.
struct Meeting {
  bool meets = false;
  double depth = 2, margin = 1;
  bool possible = false; ///< it lies before the camera, or nearly
};
Meeting meet(const glm::dmat4& camera, const std::array<glm::dvec3, 3>& corners, double px, double py,
             const shader::Params& params) {
  const double nx = px / params.width * 2 - 1, ny = py / params.height * 2 - 1;
  std::array<glm::dvec3, 3> p;
  std::array<double, 3> z;
  for (size_t i = 0; i < 3; ++i) {
    const glm::dvec4 at = camera * glm::dvec4(corners[i], 1);
    p[i] = {at.x - nx * at.w, at.y - ny * at.w, at.w};
    z[i] = at.z;
  }
  std::array<double, 3> share;
  double sum = 0;
  for (size_t i = 0; i < 3; ++i) {
    const glm::dvec3 &a = p[(i + 1) % 3], &b = p[(i + 2) % 3];
    sum += share[i] = a.x * b.y - a.y * b.x;
  }
  Meeting result;
  if (sum == 0) return {};
  double depth = 0, w = 0;
  result.meets = true;
  for (size_t i = 0; i < 3; ++i) {
    share[i] /= sum;
    result.margin = std::min(result.margin, std::abs(share[i]));
    if (share[i] < 0) result.meets = false;
    depth += share[i] * z[i], w += share[i] * p[i].z;
  }
  if (!(w > 0) || depth < 0 || depth > w) result.meets = false;
  // How far it is from a plane decides less than how far from an edge: depth is dense there.
  result.margin =
      std::min({result.margin, std::abs(w) * 1e4, std::abs(depth / w) * 1e4, std::abs(1 - depth / w) * 1e4});
  result.possible = w > -1e-8 && depth > -1e-8 && depth < w + 1e-8;
  result.depth = params.reversedDepth ? 1 - depth / w : depth / w;
  return result;
}

// Random triangles, some behind the camera or through its planes.
TEST(RayReference, EqualsTryingEachTriangleForEachRay) {
  constexpr uint32_t kSamples = 4;
  for (uint32_t seed = 0; seed < 8; ++seed) {
    Scene scene = randomSoup(seed, 60, 40, 23, true, seed % 2);
    const RaySceneOf rays(scene);
    const std::vector<uint32_t> areas = rayReference(rays, scene, kSamples).areas();
    const RayTriangles triangles(rays);
    const glm::dmat4 camera(glm::make_mat4(scene.params.viewProjection));
    std::vector<uint32_t> expected(areas.size()), unsure(areas.size());
    for (uint32_t y = 0; y < scene.params.height; ++y)
      for (uint32_t x = 0; x < scene.params.width; ++x)
        for (uint32_t s = 0; s <= kSamples * kSamples; ++s) {
          const bool centre = s == kSamples * kSamples;
          const double px = x + (centre ? 0.5 : (s % kSamples + 0.5) / kSamples);
          const double py = y + (centre ? 0.5 : (s / kSamples + 0.5) / kSamples);
          double nearest = 2, second = 3;
          uint32_t found = UINT32_MAX;
          std::vector<double> close; // depths
          for (size_t i = 0; i < triangles.size(); ++i) {
            const RayTriangles::Triangle triangle = triangles.at(i);
            const Meeting m = meet(camera, triangle.corners, px, py, scene.params);
            if (m.margin < 1e-4 && m.possible) close.push_back(m.depth); // or in its rim
            if (!m.meets) continue;
            if (m.depth < nearest)
              second = nearest, nearest = m.depth, found = triangle.number;
            else
              second = std::min(second, m.depth);
          }
          const bool decided = second - nearest > 1e-9 && std::none_of(close.begin(), close.end(), [&](double depth) {
                                 return depth < nearest + 1e-9;
                               });
          if (!decided)
            for (uint32_t& number : unsure) ++number; // whichever it is
          else if (found != UINT32_MAX)
            ++expected[found];
        }
    uint64_t together = 0;
    for (size_t i = 0; i < areas.size(); ++i) {
      EXPECT_GE(areas[i], expected[i]) << "seed " << seed << ", triangle " << i;
      EXPECT_LE(areas[i], expected[i] + unsure[i]) << "seed " << seed << ", triangle " << i;
      together += expected[i];
    }
    EXPECT_GT(together, 2000u) << "or nothing was tested";
    EXPECT_LT(unsure[0], 400u) << "and nothing where all is unsure";
  }
}

/// A wall of rows of tiles, each row cut elsewhere, placed anywhere: corners lie on other tiles' edges as well as float
/// numbers allow. Behind it fine triangles of which nothing can be seen.
Scene staggeredWall(uint32_t seed, uint32_t& hidden, int rows = 12, uint32_t width = 96, uint32_t height = 64) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  const glm::mat4 turn =
      glm::rotate(glm::mat4(1.0f), unit(random) * 6, glm::normalize(glm::vec3(unit(random), 1, unit(random))));
  const glm::vec3 move(unit(random) * 20, unit(random) * 20, unit(random) * 20);
  Scene scene;
  const auto vertex = [&](float x, float y, float z) {
    const glm::vec3 p = glm::vec3(turn * glm::vec4(x, y, z, 0)) + move;
    return scene.addVertex(p.x, p.y, p.z);
  };
  const auto rectangle = [&](float x0, float y0, float x1, float y1, float z) {
    const uint32_t a = vertex(x0, y0, z), b = vertex(x1, y0, z), c = vertex(x1, y1, z), d = vertex(x0, y1, z);
    scene.indices.insert(scene.indices.end(), {a, b, c, a, c, d});
  };
  const auto count = static_cast<float>(rows);
  for (int row = 0; row < rows; ++row) {
    const int columns = 3 + static_cast<int>(random() % 6);
    for (int column = 0; column < columns; ++column)
      rectangle(-2 + 4.0f * static_cast<float>(column) / static_cast<float>(columns),
                -2 + 4.0f * static_cast<float>(row) / count,
                -2 + 4.0f * static_cast<float>(column + 1) / static_cast<float>(columns),
                -2 + 4.0f * static_cast<float>(row + 1) / count, 0);
  }
  hidden = static_cast<uint32_t>(scene.indices.size() / 3);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x)
      rectangle(-1.9f + static_cast<float>(x) * 0.06f, -1.9f + static_cast<float>(y) * 0.06f,
                -1.9f + static_cast<float>(x + 1) * 0.06f, -1.9f + static_cast<float>(y + 1) * 0.06f, -1);
  scene.addDraw(scene.addMesh(0));
  const glm::vec3 eye = glm::vec3(turn * glm::vec4(0.3f, 0.2f, 2.5f, 0)) + move;
  scene.setCamera(perspective(0.9f, 1.5f, 0.1f, 100) * lookAt(eye, move), width, height);
  return scene;
}

TEST(RayReference, NothingShowsThroughCornersOnEdges) {
  for (uint32_t seed = 0; seed < 6; ++seed) {
    uint32_t hidden = 0;
    const Scene scene = staggeredWall(seed, hidden);
    const RaySceneOf rays(scene);
    const std::vector<uint32_t> areas = rayReference(rays, scene, 64).areas();
    uint32_t through = 0, seen = 0;
    for (uint32_t i = 0; i < areas.size(); ++i) (i < hidden ? seen : through) += areas[i] > 0;
    EXPECT_EQ(through, 0u) << "seed " << seed;
    EXPECT_GT(seen, 60u) << "seed " << seed;
  }
}

// A limit of exact sampling at T-junctions: tiles of a wall that are too thin for margins leave cracks, through which
// triangles behind it show that no ray meets. The shares are what is measured; a mend makes them less.
// Tiles are 1/11, 1/45 and 1/90 pixel high.
TEST(RayReference, ThinTilesLeaveCracksToExactSampling) {
  // Of the triangles behind the rows, how many show in hundreds at least and at most.
  for (const auto& [rows, least, most] : {std::tuple(300, 0u, 0u), {1200, 0u, 1u}, {2400, 8u, 20u}}) {
    uint32_t hidden = 0;
    Scene scene = staggeredWall(3, hidden, rows, 24, 16);
    const RaySceneOf rays(scene);
    const std::vector<uint32_t> areas = rayReference(rays, scene, 16).areas();
    const CpuResult exact = sampleExactOnCpu(scene.input());
    uint32_t met = 0, through = 0;
    for (uint32_t i = hidden; i < areas.size(); ++i) {
      met += areas[i] > 0;
      through += exact.bits[i / 32] >> (i % 32) & 1;
    }
    EXPECT_EQ(met, 0u) << rows;
    const uint32_t behind = scene.params.triangleCount - hidden;
    EXPECT_GE(through * 100, behind * least) << rows;
    EXPECT_LE(through * 100, behind * most) << rows;
  }
}

/// Rectangles, each twice: cut along one diagonal, and, with higher numbers, along the other one. Corners are multiples
/// of 2^-8, so that all four lie in exactly one plane. facing: at one depth each.
Scene otherDiagonals(uint32_t seed, bool facing, uint32_t& again) {
  std::mt19937 random(seed);
  const auto number = [&](int most) {
    return static_cast<float>(static_cast<int>(random() % (2 * static_cast<uint32_t>(most) + 1)) - most) / 256;
  };
  Scene scene;
  std::vector<uint32_t> others;
  for (uint32_t i = 0; i < 300; ++i) {
    const glm::vec3 middle(number(700), number(450), number(256));
    const glm::vec3 u(number(64), number(64), facing ? 0 : number(64)), v(-u.y, u.x, facing ? 0 : number(64));
    const auto corner = [&](float s, float t) {
      const glm::vec3 p = middle + u * s + v * t;
      return scene.addVertex(p.x, p.y, p.z);
    };
    const uint32_t a = corner(-1, -1), b = corner(1, -1), c = corner(1, 1), d = corner(-1, 1);
    scene.indices.insert(scene.indices.end(), {a, b, c, a, c, d});
    others.insert(others.end(), {a, b, d, b, c, d});
  }
  again = static_cast<uint32_t>(scene.indices.size() / 3);
  scene.indices.insert(scene.indices.end(), others.begin(), others.end());
  scene.addDraw(scene.addMesh(0), glm::mat4(1.0f), shader::kTwoSided);
  scene.setCamera(perspective(0.9f, 1.5f, 0.1f, 100) * lookAt({0, 0, 5}, {0, 0, 0}), 96, 64);
  return scene;
}

// The lower number is nearer where depth is the same for certain: at one depth each. Elsewhere the two have depths that
// differ by rounding, and exact sampling shows most of both: a limit.
TEST(RayReference, OtherDiagonalsOfTheSameRectangles) {
  for (const bool facing : {true, false}) {
    uint32_t again = 0;
    Scene scene = otherDiagonals(1, facing, again);
    const RaySceneOf rays(scene);
    const auto count = [&](const std::vector<uint32_t>& bits, uint32_t from) {
      uint32_t n = 0;
      for (uint32_t i = from; i < from + again; ++i) n += bits[i / 32] >> (i % 32) & 1;
      return n;
    };
    const std::vector<uint32_t> reference = rayReference(rays, scene, 64).bits();
    EXPECT_GT(count(reference, 0), again / 2);
    EXPECT_EQ(count(reference, again), 0u);
    const CpuResult standard = sampleOnCpu(scene.input()), exact = sampleExactOnCpu(scene.input());
    const uint32_t extra = count(exact.bits, again);
    if (facing) {
      EXPECT_EQ(count(standard.bits, again), 0u);
      EXPECT_LE(extra, again / 20); // where one's margin is wider than the other's
    } else {
      EXPECT_GT(extra, again / 2);
    }
    EXPECT_GE(count(exact.bits, 0), count(reference, 0) * 9 / 10);
  }
}

// A rim is not seen: a sliver that no ray meets, but that some pass within its rounding, is not in the reference.
TEST(RayReference, RimsHideButAreNotSeen) {
  Scene scene = flat(16, 16);
  addRectangle(scene, {-1, -1, 0.5f}, {1, 1, 0.5f});
  // Just left of the rays through x = 8.5 pixels, and thinner than a float number's rounding there.
  const float x = 1.0f / 16 - 0x1p-24f, left = x - 0x1p-26f;
  scene.indices.insert(scene.indices.end(),
                       {scene.addVertex(left, -1, 0.4f), scene.addVertex(x, 1, 0.4f), scene.addVertex(x, -1, 0.4f)});
  scene.addDraw(scene.addMesh(0));
  const RaySceneOf rays(scene);
  EXPECT_EQ(rayReference(rays, scene, 16).bits()[0], 0b011u);
}

TEST(RaySegments, OnlyWhatLiesBetweenBlocks) {
  Scene scene;
  addRectangle(scene, {-1, -1, 0}, {1, 1, 0});
  scene.addDraw(scene.addMesh(0), glm::translate(glm::mat4(1.0f), {0, 0, 5}));
  const RaySceneOf rays(scene);
  const std::vector<glm::dvec3> ends = {{0, 0, 4.9}, {0, 0, 5.1},  {0, 0, -9}, {0.5, 0.5, 9},
                                        {3, 0, 5.1}, {0, 0, 4.99}, {1, 1, 9},  {0.3, 0.3, 1}};
  EXPECT_EQ(blockedWays(rays, {0, 0, 1}, ends),
            (std::vector<bool>{false, true, false, true, false, false, true, false}));
  EXPECT_EQ(blockedWays(rays, {0, 0, 9}, ends)[0], true) << "from behind as well";
}

struct Compared {
  uint32_t reference = 0, found = 0, extra = 0;
};
Compared compare(const std::vector<uint32_t>& bits, const std::vector<uint32_t>& reference) {
  Compared c;
  for (size_t i = 0; i < reference.size(); ++i) {
    c.reference += static_cast<uint32_t>(std::popcount(reference[i]));
    c.found += static_cast<uint32_t>(std::popcount(reference[i] & bits[i]));
    c.extra += static_cast<uint32_t>(std::popcount(bits[i] & ~reference[i]));
  }
  return c;
}

// By a reference of its own the CPU reference's exact method, and its reference, are as good as by the reference that
// snaps as it does.
TEST(RayReference, GradesTheMethods) {
  std::vector<std::pair<std::string, Scene>> scenes;
  const auto add = [&](const char* name, Scene&& scene) -> Scene& {
    return scenes.emplace_back(name, std::move(scene)).second;
  };
  setOrbitCamera(add("bunnies", bunnyGrid(1, 2)), 1, 8, 3.0f, 96, 72);
  setWalkingCamera(add("foliage", foliage(4000)), {1, 1.7f, 7}, {0, 1.5f, 0}, 80, 45, true);
  setOrbitCamera(add("city", city(6)), 1, 8, 1.2f, 96, 54);
  for (auto& [name, scene] : scenes) {
    const RaySceneOf rays(scene);
    const std::vector<uint32_t> reference = rayReference(rays, scene, 64).bits();
    std::vector<uint32_t> sizes;
    for (const auto& [method, bits, found, extra] :
         {std::tuple("exact", sampleExactOnCpu(scene.input()).bits, 0.99, 0.01),
          {"reference", referenceOnCpu(scene.input(), 64, sizes).bits, 0.99, 0.01}}) {
      const Compared c = compare(bits, reference);
      EXPECT_GE(c.found, c.reference * found) << name << ' ' << method;
      EXPECT_LE(c.extra, c.reference * extra) << name << ' ' << method;
    }
    EXPECT_LT(compare(sampleOnCpu(scene.input()).bits, reference).found, 0.8 * countOf(reference)) << name;
  }
}

} // namespace
} // namespace gpgp::test
