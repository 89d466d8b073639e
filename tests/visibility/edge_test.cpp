// Edge cases of input, one by one and with every method: the GPU against the CPU reference, and against what must be
// seen.
#include "gpu.h"

#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <limits>

namespace gpgp::test {
namespace {
using namespace visibility;
using Triangles = std::vector<uint32_t>;

/// A camera at the origin that looks along -Z; at z = -2 it sees -1 to 1.
void setStraightCamera(Scene& scene, uint32_t width, uint32_t height) {
  scene.setCamera(perspective(2 * std::atan(0.5f), 1.0f, 0.5f, 100.0f), width, height);
  scene.params.heuristics = GPGP_HEURISTICS_DEFAULT;
  scene.params.epsilonStatic = scene.params.epsilonDynamic = 0.05f;
}
void addTriangle(Scene& scene, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  for (const glm::vec3& p : {a, b, c}) scene.indices.push_back(scene.addVertex(p.x, p.y, p.z));
}
/// Counter-clockwise as seen, far larger than what the camera sees there.
void addWall(Scene& scene, float z) { addTriangle(scene, {-30, -30, z}, {30, -30, z}, {0, 60, z}); }
void addSmall(Scene& scene, float z) { addTriangle(scene, {-0.5f, -0.5f, z}, {0.5f, -0.5f, z}, {0, 0.5f, z}); }

struct EdgeTest : VisibilityGpuTest {
  GpgpRecorder recorder = nullptr;
  void SetUp() override {
    VisibilityGpuTest::SetUp();
    recorder = createRecorder(64, 64, 4096, true, 15, 4);
  }
  /// The same triangles for all methods.
  GpuResult expect(Scene& scene, const Triangles& triangles, const std::string& what) {
    GpuResult last;
    for (const GpgpSamplingMethod method :
         {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_CONSERVATIVE, GPGP_SAMPLING_REFERENCE, GPGP_SAMPLING_EXACT}) {
      const std::string name = what + ", method " + std::to_string(method);
      const GpgpAsset set = createGeometrySet(scene);
      scene.input();
      last = sample(scene, recorder, set, {.method = method, .samples = method == GPGP_SAMPLING_REFERENCE ? 4u : 0u});
      gpgpDestroyAsset(set);
      EXPECT_EQ(last.list, triangles) << name;
      EXPECT_EQ(last.report.base.status, GPGP_SUCCESS) << name;
      if (method == GPGP_SAMPLING_REFERENCE) continue; // the CPU reference's grid is the centre
      CpuInput input = scene.input();
      const CpuResult cpu = method == GPGP_SAMPLING_STANDARD ? sampleOnCpu(input)
                            : method == GPGP_SAMPLING_EXACT  ? sampleExactOnCpu(input)
                                                             : sampleConservativelyOnCpu(input);
      EXPECT_EQ(last.bits, cpu.bits) << name;
      EXPECT_EQ(last.report.skippedTriangles, cpu.counters.skippedTriangles) << name;
    }
    return last;
  }
};

TEST_F(EdgeTest, OneTriangle) {
  for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(64, 64), glm::uvec2(64, 1), glm::uvec2(3, 64)}) {
    Scene scene;
    addWall(scene, -2);
    scene.addDraw(scene.addMesh(0));
    setStraightCamera(scene, size.x, size.y);
    expect(scene, {0}, std::to_string(size.x) + " x " + std::to_string(size.y));
  }
}

TEST_F(EdgeTest, BehindTheCameraAndBeforeTheNearPlane) {
  Scene scene;
  addWall(scene, 3);     // behind, and so it faces away
  addWall(scene, -0.3f); // before the near plane
  addTriangle(scene, {-30, -30, 3}, {0, 60, 3}, {30, -30, 3});
  scene.addDraw(scene.addMesh(0), glm::mat4(1.0f), shader::kTwoSided);
  setStraightCamera(scene, 64, 64);
  expect(scene, {}, "behind");
}

TEST_F(EdgeTest, ThroughTheNearPlane) {
  Scene scene; // a ground from behind the camera to far away, and what it hides below
  addTriangle(scene, {-50, -0.4f, 5}, {50, -0.4f, 5}, {0, -0.4f, -90});
  addTriangle(scene, {-50, -0.6f, 5}, {50, -0.6f, 5}, {0, -0.6f, -50});
  scene.addDraw(scene.addMesh(0));
  setStraightCamera(scene, 64, 64);
  expect(scene, {0}, "ground");
}

TEST_F(EdgeTest, DegenerateTrianglesShowNothingAndHideNothing) {
  Scene scene;
  addTriangle(scene, {-1, -1, -1.5f}, {1, 1, -1.5f}, {1, 1, -1.5f});         // two corners in one
  addTriangle(scene, {-1, -1, -1.5f}, {0, 0, -1.5f}, {1, 1, -1.5f});         // on a line
  addTriangle(scene, {0, 0, -1.5f}, {0, 0, -1.5f}, {0, 0, -1.5f});           // a point
  addTriangle(scene, {0, 0, -1.5f}, {1e-30f, 0, -1.5f}, {0, 1e-30f, -1.5f}); // smaller than the grid
  addWall(scene, -2);
  scene.addDraw(scene.addMesh(0), glm::mat4(1.0f), shader::kTwoSided);
  glm::mat4 flat(1.0f); // a transform that flattens onto a line
  flat[0][0] = 0;
  scene.addDraw(0, flat, shader::kTwoSided);
  setStraightCamera(scene, 64, 64);
  expect(scene, {4}, "degenerate");
}

TEST_F(EdgeTest, BackFacesCountWhereTwoSided) {
  for (const bool twoSided : {false, true}) {
    Scene scene;
    addTriangle(scene, {-0.5f, -0.5f, -2}, {0, 0.5f, -2}, {0.5f, -0.5f, -2});
    addWall(scene, -3);
    scene.addDraw(scene.addMesh(0), glm::mat4(1.0f), twoSided ? shader::kTwoSided : 0);
    setStraightCamera(scene, 64, 64);
    expect(scene, twoSided ? Triangles{0, 1} : Triangles{1}, "back face");
  }
}

TEST_F(EdgeTest, OfIdenticalTrianglesTheFirstIsSeen) {
  Scene scene;
  addSmall(scene, -2);
  addSmall(scene, -2);
  addWall(scene, -3);
  scene.addDraw(scene.addMesh(0));
  scene.addDraw(0);
  setStraightCamera(scene, 64, 64);
  expect(scene, {0, 2}, "identical");
}

TEST_F(EdgeTest, BetweenTheCentres) {
  Scene scene; // a tenth of a pixel wide: the centres lie 1/64 to each side of x = 0
  addTriangle(scene, {-0.001f, -0.5f, -2}, {0.001f, -0.5f, -2}, {0, 0.5f, -2});
  addWall(scene, -2.01f);
  addSmall(scene, -3); // hidden
  scene.addDraw(scene.addMesh(0));
  setStraightCamera(scene, 64, 64);
  scene.input();
  const GpgpAsset set = createGeometrySet(scene);
  EXPECT_EQ(sample(scene, recorder, set, {.method = GPGP_SAMPLING_STANDARD}).list, Triangles{1});
  EXPECT_EQ(sample(scene, recorder, set, {.method = GPGP_SAMPLING_CONSERVATIVE}).list, (Triangles{0, 1}));
  EXPECT_EQ(sample(scene, recorder, set, {.method = GPGP_SAMPLING_EXACT}).list, (Triangles{0, 1}));
}

TEST_F(EdgeTest, EmptyMeshesAndDraws) {
  Scene scene;
  addWall(scene, -2);
  const uint32_t wall = scene.addMesh(0);
  scene.meshes.push_back({0, 0, 0}); // no index
  scene.addDraw(1);
  scene.addDraw(wall);
  scene.addDraw(1);
  setStraightCamera(scene, 64, 64);
  expect(scene, {0}, "empty draws");
  Scene nothing;
  addWall(nothing, -2);
  nothing.meshes.push_back({0, 0, 0});
  nothing.addDraw(0);
  setStraightCamera(nothing, 64, 64);
  expect(nothing, {}, "only an empty draw");
}

TEST_F(EdgeTest, IndicesOutOfRangeAreSkippedAndCounted) {
  Scene scene;
  addSmall(scene, -2);
  addWall(scene, -3);
  addSmall(scene, -1);
  scene.indices[6] = 9;
  for (const uint32_t bad : {9u, 0x7fffffffu, 0xffffffffu}) {
    Scene copy = scene;
    copy.indices[6] = bad;
    copy.addDraw(copy.addMesh(0));
    setStraightCamera(copy, 64, 64);
    EXPECT_EQ(expect(copy, {0, 1}, "index " + std::to_string(bad)).report.skippedTriangles, 1u);
  }
}

TEST_F(EdgeTest, PositionsThatAreNoNumbersAreSkippedAndCounted) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::max()}) {
    Scene scene;
    addSmall(scene, -2);
    addWall(scene, -3);
    addSmall(scene, -1);
    scene.positions[20] = bad;
    scene.addDraw(scene.addMesh(0));
    setStraightCamera(scene, 64, 64);
    EXPECT_EQ(expect(scene, {0, 1}, std::to_string(bad)).report.skippedTriangles, 1u);
  }
}

// As large as viewports get. Needs a device that binds 512 MiB.
TEST_F(VisibilityGpuTest, AViewportOf8192SquaredEqualsTheCpuReference) {
  if (device.properties().limits.maxStorageBufferRange < 8192u * 8192u * 8u)
    GTEST_SKIP() << device.name() << " binds too little for 8192 x 8192 pixels";
  Scene scene = sheet(1, 300, 0.3f); // 180 000 triangles of some hundred pixels
  scene.addDraw(0);
  scene.setCamera(perspective(1.0f, 1.0f, 0.05f, 10.0f) * lookAt({0.1f, 0.05f, 2.2f}, {0, 0, 0}), 8192, 8192);
  CpuInput input = scene.input();
  const GpuResult gpu = sample(scene);
  const CpuResult cpu = sampleOnCpu(input);
  EXPECT_EQ(gpu.report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(gpu.bits, cpu.bits);
  EXPECT_EQ(gpu.report.coveredPixels, cpu.counters.coveredPixels);
  EXPECT_GT(gpu.report.visible, scene.params.triangleCount - 100); // all but what the sheet's waves hide
  EXPECT_GT(gpu.report.coveredPixels, 8192u * 8192u / 3);
}

/// Sheets of 2 x 71 x 71 = 10 082 triangles a thousandth behind one another; the first fills the picture and hides the
/// others.
struct Sheets {
  static constexpr uint32_t kSide = 71, kTriangles = 2 * kSide * kSide;
  Scene scene;
  float halfView = 0; ///< half of what is seen, at distance 1

  Sheets(uint32_t count, uint32_t pixels, float half) : halfView(half) {
    for (uint32_t y = 0; y <= kSide; ++y)
      for (uint32_t x = 0; x <= kSide; ++x)
        scene.addVertex(static_cast<float>(x) * 2 / kSide - 1, static_cast<float>(y) * 2 / kSide - 1, 0);
    for (uint32_t y = 0; y < kSide; ++y)
      for (uint32_t x = 0; x < kSide; ++x) {
        const uint32_t a = y * (kSide + 1) + x, b = a + kSide + 1;
        scene.indices.insert(scene.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
      }
    const uint32_t mesh = scene.addMesh(0);
    for (uint32_t i = 0; i < count; ++i) scene.addDraw(mesh, glm::translate(glm::mat4(1.0f), {0, 0, -distanceOf(i)}));
    scene.setCamera(perspective(2 * std::atan(half), 1.0f, 0.5f, 100.0f), pixels, pixels);
    scene.params.maxItems = scene.params.triangleCount;
    scene.input();
  }
  static float distanceOf(uint32_t sheet) { return 2.0f + static_cast<float>(sheet) * 0.001f; }
  /// Whether a triangle reaches, or else fills, what is seen less `margin` pixels on each side. Its square's numbers
  /// tell.
  bool isInView(uint32_t triangle, bool whole, float margin) const {
    const uint32_t square = triangle % kTriangles / 2;
    const float distance = distanceOf(triangle / kTriangles), pixel = 2.0f / static_cast<float>(scene.params.width);
    const float limit = (1 - margin * pixel) * halfView * distance;
    bool in = true;
    for (const uint32_t at : {square % kSide, square / kSide}) {
      const float low = static_cast<float>(at) * 2 / kSide - 1, high = static_cast<float>(at + 1) * 2 / kSide - 1;
      in = in && (whole ? low > -limit && high < limit : high > -limit && low < limit);
    }
    return in;
  }
  /// What is so whether or not there is room for all candidates.
  void check(const GpuResult& gpu, size_t more = 0) const {
    EXPECT_EQ(gpu.report.neededTriangles, scene.params.triangleCount);
    EXPECT_EQ(gpu.report.coveredPixels, scene.params.width * scene.params.height);
    EXPECT_EQ(gpu.report.skippedTriangles, 0u);
    EXPECT_EQ(gpu.report.visible, gpu.list.size());
    const auto isVisible = [&](uint32_t triangle) { return gpu.bits[triangle / 32] >> triangle % 32 & 1u; };
    size_t lost = 0, outside = 0, hidden = 0;
    for (uint32_t t = 0; t < kTriangles; ++t) lost += isInView(t, true, 1) && !isVisible(t);
    for (const uint32_t t : gpu.list) {
      outside += !isInView(t, false, -1);
      hidden += t >= kTriangles;
    }
    EXPECT_EQ(lost, 0u) << "of the first sheet, which nothing hides";
    EXPECT_EQ(outside, 0u) << "of any sheet, beside the picture";
    EXPECT_LE(hidden, gpu.report.unresolved + more) << "behind the first sheet only what was not decided";
    EXPECT_EQ(gpu.report.base.status, gpu.report.unresolved ? GPGP_BUDGET_EXCEEDED : GPGP_SUCCESS);
  }
};

TEST_F(VisibilityGpuTest, SheetsOfInstancesWithAndWithoutRoom) {
  const Sheets sheets(20, 256, 0.3f);
  Scene scene = sheets.scene;
  const GpgpAsset set = createGeometrySet(scene);
  const auto run = [&](GpgpSamplingMethod method, uint32_t candidates, uint32_t pairs) {
    const GpgpRecorder recorder =
        createRecorder(256, 256, scene.params.triangleCount, true, GPGP_SAMPLING_STANDARD_BIT | GPGP_SAMPLING_EXACT_BIT,
                       0, candidates, pairs);
    const GpuResult gpu = sample(scene, recorder, set, {.method = method, .byDraw = false});
    sheets.check(gpu);
    return gpu.report.unresolved;
  };
  EXPECT_EQ(run(GPGP_SAMPLING_STANDARD, 0, 0), 0u);
  EXPECT_EQ(run(GPGP_SAMPLING_EXACT, scene.params.triangleCount, 1 << 23), 0u);
  EXPECT_GT(run(GPGP_SAMPLING_EXACT, 1000, 1 << 23), 0u);
  EXPECT_GT(run(GPGP_SAMPLING_EXACT, scene.params.triangleCount, 3000), 0u);
}

// 10^8 triangles. In pixels that no triangle fills, each of the 10 000 sheets has a candidate: there may be more than
// there is room for. What has none is shown, and counted.
TEST_F(VisibilityGpuTest, AHundredMillionTrianglesOfInstances) {
  if (device.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU)
    GTEST_SKIP() << "10^8 triangles are for hardware; this is " << device.name();
  const Sheets sheets(10000, 1024, 0.45f);
  Scene scene = sheets.scene;
  ASSERT_GT(scene.params.triangleCount, 100000000u);
  const GpgpAsset set = createGeometrySet(scene);
  const GpgpRecorder recorder = createRecorder(1024, 1024, scene.params.triangleCount, true,
                                               GPGP_SAMPLING_STANDARD_BIT | GPGP_SAMPLING_EXACT_BIT);
  for (const GpgpSamplingMethod method : {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT}) {
    const GpuResult gpu = sample(scene, recorder, set, {.method = method, .byDraw = false});
    sheets.check(gpu, gpu.report.unresolved / 10000); // what has no room hides nothing: 23 of 24 533 399 once
    EXPECT_TRUE(gpu.report.unresolved == 0 || method == GPGP_SAMPLING_EXACT);
  }
}

} // namespace
} // namespace gpgp::test
