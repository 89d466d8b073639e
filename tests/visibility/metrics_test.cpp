// Metrics: the GPU's comparison with a reference against counting on the CPU, and the cameras of a view cell.
#include "gpu.h"
#include "measured_scenes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <set>

namespace gpgp::test {
namespace {
using Words = std::vector<uint32_t>;
constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr GpgpAccess kRead{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, {}};

struct MetricsTest : VisibilityGpuTest {
  GpgpRecorder recorder = nullptr;
  void SetUp() override {
    VisibilityGpuTest::SetUp();
    recorder = createRecorder(64, 64, 0, false, GPGP_SAMPLING_STANDARD_BIT | GPGP_SAMPLING_REFERENCE_BIT, 4);
    advance(); // what the tests before left is there
    GpgpVisibilityReport report = GPGP_VISIBILITY_REPORT_INIT;
    while (gpgpGetVisibilityReport(recorder, &report) == GPGP_SUCCESS) continue;
  }
  struct Measured {
    GpgpVisibilityReport report = GPGP_VISIBILITY_REPORT_INIT;
    Words positives, negatives;
  };
  Measured measure(uint32_t triangles, const Words& visible, const Words& reference, const Words& counts,
                   const Words& recheck, bool masks) {
    Measured result;
    const auto make = [&](const Words& words, const char* name) {
      return words.empty() ? host::Buffer() : host::makeBuffer(device, words, kStorage, name);
    };
    const host::Buffer visibleBits = make(visible, "visible"), referenceBits = make(reference, "reference");
    const host::Buffer referenceCounts = make(counts, "counts"), recheckBits = make(recheck, "recheck");
    const host::Buffer positives(device, visible.size() * 4, kStorage), negatives(device, visible.size() * 4, kStorage);
    GpgpVisibilityMetricsInfo info = GPGP_VISIBILITY_METRICS_INFO_INIT;
    info.triangleCount = triangles;
    info.visibleBits = visibleBits.range();
    info.referenceBits = referenceBits.range();
    if (!counts.empty()) info.referenceCounts = referenceCounts.range();
    if (!recheck.empty()) info.recheckBits = recheckBits.range();
    if (masks) {
      info.falsePositives = positives.range({}, kRead);
      info.falseNegatives = negatives.range({}, kRead);
    }
    const GpgpFrame f = advance();
    device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordPrepareVisibilityMetrics(recorder, cmd, &f, &info), GPGP_SUCCESS);
    });
    advance();
    EXPECT_EQ(gpgpGetVisibilityReport(recorder, &result.report), GPGP_SUCCESS);
    if (masks) {
      result.positives = host::download<uint32_t>(device, positives, visible.size());
      result.negatives = host::download<uint32_t>(device, negatives, visible.size());
    }
    return result;
  }
};

TEST_F(MetricsTest, AreThoseOfCountingTriangleByTriangle) {
  std::mt19937 random(4);
  for (const uint32_t triangles : {1u, 31u, 32u, 1000u, 70001u})
    for (const bool full : {true, false}) {
      const size_t words = (triangles + 31) / 32;
      Words visible(words), reference(words), recheck(full ? words : 0), counts(full ? triangles : 0);
      for (uint32_t& w : visible) w = static_cast<uint32_t>(random()); // also behind the last triangle
      for (uint32_t& w : reference) w = static_cast<uint32_t>(random() & random());
      for (uint32_t& w : recheck) w = static_cast<uint32_t>(random() & random());
      for (uint32_t& c : counts) c = static_cast<uint32_t>(random() % 8 ? random() % 5000 : 0xffffffffu - random() % 9);
      uint32_t all = 0, found = 0, extra = 0;
      double area = 0, foundArea = 0;
      Words positives(words), negatives(words);
      for (uint32_t t = 0; t < triangles; ++t) {
        const auto in = [&](const Words& bits) { return !bits.empty() && (bits[t / 32] >> t % 32 & 1u); };
        const bool isTrue = in(reference) || (in(visible) && in(recheck));
        const double samples = full && isTrue ? counts[t] : 0;
        all += isTrue;
        found += isTrue && in(visible);
        extra += !isTrue && in(visible);
        area += samples;
        if (in(visible)) foundArea += samples;
        if (!isTrue && in(visible)) positives[t / 32] |= 1u << t % 32;
        if (isTrue && !in(visible)) negatives[t / 32] |= 1u << t % 32;
      }
      const Measured m = measure(triangles, visible, reference, counts, recheck, full);
      EXPECT_EQ(m.report.reference, all);
      EXPECT_EQ(m.report.falsePositives, extra);
      EXPECT_EQ(m.report.falseNegatives, all - found);
      EXPECT_EQ(m.report.visible, 0u); // nothing was sampled
      if (all) {
        EXPECT_FLOAT_EQ(m.report.coverage, static_cast<float>(found) / static_cast<float>(all));
        EXPECT_FLOAT_EQ(m.report.overestimation, static_cast<float>(extra) / static_cast<float>(all));
      }
      if (area > 0) {
        EXPECT_FLOAT_EQ(m.report.coverageArea, static_cast<float>(foundArea / area));
        EXPECT_FLOAT_EQ(m.report.overestimationArea, static_cast<float>(extra / area));
      } else {
        EXPECT_EQ(m.report.coverageArea, 0.0f);
      }
      if (full) {
        EXPECT_EQ(m.positives, positives);
        EXPECT_EQ(m.negatives, negatives);
      }
    }
}

TEST_F(MetricsTest, OfNoTrianglesAreZero) {
  GpgpVisibilityMetricsInfo info = GPGP_VISIBILITY_METRICS_INFO_INIT;
  const GpgpFrame f = advance();
  device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
    EXPECT_EQ(gpgpRecordPrepareVisibilityMetrics(recorder, cmd, &f, &info), GPGP_SUCCESS);
  });
  advance();
  GpgpVisibilityReport report = GPGP_VISIBILITY_REPORT_INIT;
  EXPECT_EQ(gpgpGetVisibilityReport(recorder, &report), GPGP_SUCCESS);
  EXPECT_EQ(report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(report.reference + report.falsePositives + report.falseNegatives, 0u);
}

TEST_F(MetricsTest, BadBuffersAreRefusedByName) {
  const host::Buffer words(device, 16, kStorage);
  GpgpVisibilityMetricsInfo good = GPGP_VISIBILITY_METRICS_INFO_INIT;
  good.triangleCount = 100;
  good.visibleBits = good.referenceBits = words.range();
  const GpgpFrame f = advance();
  const auto expectBad = [&](const char* text, auto change) {
    GpgpVisibilityMetricsInfo info = good;
    change(info);
    device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordPrepareVisibilityMetrics(recorder, cmd, &f, &info), GPGP_ERROR_INVALID_ARGUMENT) << text;
    });
    ASSERT_EQ(messages.size(), 1u) << text;
    EXPECT_NE(messages[0].find(text), std::string::npos) << messages[0];
    messages.clear();
  };
  expectBad("visibleBits.buffer is NULL", [](auto& i) { i.visibleBits = {}; });
  expectBad("referenceBits.buffer is NULL", [](auto& i) { i.referenceBits = {}; });
  expectBad("referenceBits.size is 16", [](auto& i) {
    i.triangleCount = 129;
    i.visibleBits.size = 32;
  });
  expectBad("referenceCounts.size is 16", [&](auto& i) { i.referenceCounts = words.range(); });
  expectBad("recheckBits.size is 8", [&](auto& i) { i.recheckBits = words.range(), i.recheckBits.size = 8; });
  expectBad("falsePositives.size is 12",
            [&](auto& i) { i.falsePositives = words.range(), i.falsePositives.size = 12; });
  expectBad("falseNegatives.size is 4", [&](auto& i) { i.falseNegatives = words.range(), i.falseNegatives.size = 4; });
  expectBad("referenceBits.offset must be", [](auto& i) { i.referenceBits.offset = 1; });
  expectBad("triangleCount", [](auto& i) { i.triangleCount = 0x80000001u; });
  GpgpVisibilityMetricsInfo info = good;
  info.sType = GPGP_STRUCTURE_VISIBILITY_INFO;
  EXPECT_EQ(gpgpRecordPrepareVisibilityMetrics(recorder, VK_NULL_HANDLE, &f, &info), GPGP_ERROR_INVALID_STRUCT);
  messages.clear();
  device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
    EXPECT_EQ(gpgpRecordPrepareVisibilityMetrics(recorder, cmd, &f, &good), GPGP_SUCCESS);
  });
  EXPECT_TRUE(messages.empty());
}

// An engine's whole way: reference in slices, a method, the comparison; and a record of the method goes on as before.
TEST_F(MetricsTest, OfASceneAreThoseOfItsBits) {
  Scene scene = bunny(64, 64);
  const visibility::CpuResult standard = visibility::sampleOnCpu(scene.input());
  std::vector<uint32_t> sizes;
  const visibility::CpuResult reference = visibility::referenceOnCpu(scene.input(), 8, sizes);
  const GpgpAsset set = createGeometrySet(scene);
  const SceneBuffers buffers(device, scene);
  upload();
  const host::Buffer bits(device, standard.bits.size() * 4, kStorage),
      referenceBits(device, reference.bits.size() * 4, kStorage);
  const host::Buffer counts(device, sizes.size() * 4, kStorage);
  GpgpVisibilityReport report = GPGP_VISIBILITY_REPORT_INIT;
  const auto record = [&](auto call) {
    const GpgpFrame f = advance();
    device.submitAndWait(queue(), [&](VkCommandBuffer cmd) { EXPECT_EQ(call(cmd, f), GPGP_SUCCESS); });
    advance();
    EXPECT_EQ(gpgpGetVisibilityReport(recorder, &report), GPGP_SUCCESS);
  };
  const auto sampleInto = [&](const host::Buffer& to, GpgpSamplingMethod method, uint32_t slice) {
    record([&](VkCommandBuffer cmd, const GpgpFrame& f) {
      GpgpVisibilityInfo info = sampleInfo(scene, buffers, set);
      info.method = method;
      info.samples = method == GPGP_SAMPLING_REFERENCE ? 8 : 1;
      info.slice = slice;
      info.accumulate = slice > 0;
      info.visibleBits = to.range();
      if (method == GPGP_SAMPLING_REFERENCE) info.pixelCounts = counts.range();
      return gpgpRecordPrepareVisibility(recorder, cmd, &f, &info);
    });
  };
  for (uint32_t slice = 0; slice <= 4; ++slice) sampleInto(referenceBits, GPGP_SAMPLING_REFERENCE, slice);
  sampleInto(bits, GPGP_SAMPLING_STANDARD, 0);
  EXPECT_EQ(report.visible, standard.counters.visible);
  EXPECT_EQ(report.reference, 0u);
  record([&](VkCommandBuffer cmd, const GpgpFrame& f) {
    GpgpVisibilityMetricsInfo info = GPGP_VISIBILITY_METRICS_INFO_INIT;
    info.triangleCount = scene.params.triangleCount;
    info.visibleBits = bits.range();
    info.referenceBits = referenceBits.range();
    info.referenceCounts = counts.range();
    return gpgpRecordPrepareVisibilityMetrics(recorder, cmd, &f, &info);
  });
  uint32_t all = 0, found = 0;
  uint64_t area = 0, foundArea = 0;
  for (size_t t = 0; t < sizes.size(); ++t) {
    const bool isTrue = reference.bits[t / 32] >> t % 32 & 1u, isFound = standard.bits[t / 32] >> t % 32 & 1u;
    all += isTrue;
    found += isTrue && isFound;
    area += sizes[t];
    if (isFound) foundArea += sizes[t];
  }
  EXPECT_EQ(report.reference, all);
  EXPECT_EQ(report.falsePositives, 0u); // the centre is one of the reference's samples
  EXPECT_EQ(report.falseNegatives, all - found);
  EXPECT_GT(report.falseNegatives, 100u);
  EXPECT_FLOAT_EQ(report.coverageArea, static_cast<float>(static_cast<double>(foundArea) / static_cast<double>(area)));
  sampleInto(bits, GPGP_SAMPLING_STANDARD, 0);
  EXPECT_EQ(report.visible, standard.counters.visible);
}

// What 64 x 64 samples a pixel leave out is little, and covers next to nothing.
TEST_F(MetricsTest, TheReferenceOf64HoldsNearlyAllOfThatOf128) {
  Scene scene = foliage(3000);
  setWalkingCamera(scene, {1, 1.7f, 7}, {0, 1.5f, 0}, 64, 36, true);
  scene.input();
  const GpgpRecorder fineRecorder = createRecorder(64, 36, 0, false, GPGP_SAMPLING_REFERENCE_BIT, 8);
  const GpgpAsset set = createGeometrySet(scene);
  const SceneBuffers buffers(device, scene);
  upload();
  const uint32_t triangles = scene.params.triangleCount;
  const host::Buffer coarse(device, (triangles + 31) / 32 * 4, kStorage), fine(device, coarse.size(), kStorage);
  const host::Buffer counts(device, VkDeviceSize(triangles) * 4, kStorage);
  for (const uint32_t samples : {64u, 128u})
    for (uint32_t slice = 0; slice <= samples / 8 * (samples / 8); ++slice) {
      const GpgpFrame f = advance();
      device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
        GpgpVisibilityInfo info = sampleInfo(scene, buffers, set);
        info.method = GPGP_SAMPLING_REFERENCE;
        info.samples = samples;
        info.slice = slice;
        info.accumulate = slice > 0;
        info.visibleBits = (samples == 64 ? coarse : fine).range();
        if (samples == 128) info.pixelCounts = counts.range();
        ASSERT_EQ(gpgpRecordPrepareVisibility(fineRecorder, cmd, &f, &info), GPGP_SUCCESS);
      });
    }
  GpgpVisibilityMetricsInfo info = GPGP_VISIBILITY_METRICS_INFO_INIT;
  info.triangleCount = triangles;
  info.visibleBits = coarse.range();
  info.referenceBits = fine.range();
  info.referenceCounts = counts.range();
  const GpgpFrame f = advance();
  device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
    ASSERT_EQ(gpgpRecordPrepareVisibilityMetrics(recorder, cmd, &f, &info), GPGP_SUCCESS);
  });
  advance();
  GpgpVisibilityReport report = GPGP_VISIBILITY_REPORT_INIT;
  ASSERT_EQ(gpgpGetVisibilityReport(recorder, &report), GPGP_SUCCESS);
  std::printf("64 x 64 samples: %u triangles fewer than 128 x 128 of %u, %u others; %.6f of the area\n",
              report.falseNegatives, report.reference, report.falsePositives, static_cast<double>(report.coverageArea));
  EXPECT_GT(report.reference, 2000u);
  EXPECT_GE(report.coverage, 0.98f);
  EXPECT_GE(report.coverageArea, 0.999f); // what is missed are slivers along rows and columns
}

TEST_F(MetricsTest, CountsOfTheReferenceStayAtTheLargestNumber) {
  Scene scene = randomSoup(5, 4, 64, 64, true, false);
  scene.input();
  const GpgpAsset set = createGeometrySet(scene);
  const SceneBuffers buffers(device, scene);
  upload();
  const host::Buffer bits(device, 4, kStorage);
  Words start(scene.params.triangleCount, 0xfffffff0u);
  const host::Buffer counts = host::makeBuffer(device, start, kStorage, "counts");
  const GpgpFrame f = advance();
  device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
    GpgpVisibilityInfo info = sampleInfo(scene, buffers, set);
    info.method = GPGP_SAMPLING_REFERENCE;
    info.samples = 4;
    info.accumulate = VK_TRUE;
    info.visibleBits = bits.range();
    info.pixelCounts = counts.range({}, kRead);
    EXPECT_EQ(gpgpRecordPrepareVisibility(recorder, cmd, &f, &info), GPGP_SUCCESS);
  });
  const Words after = host::download<uint32_t>(device, counts, start.size());
  EXPECT_GT(std::count(after.begin(), after.end(), 0xffffffffu), 0);
  for (const uint32_t count : after) EXPECT_GE(count, 0xfffffff0u); // none went through zero
}

GpgpViewCellInfo cellOf(const glm::mat4& camera, bool reversed = false) {
  GpgpViewCellInfo info = GPGP_VIEW_CELL_INFO_INIT;
  std::copy_n(&camera[0][0], 16, info.camera.viewProjection);
  info.camera.reversedDepth = reversed;
  return info;
}
glm::mat4 matrixOf(const GpgpCamera& camera) {
  glm::mat4 m;
  std::copy_n(camera.viewProjection, 16, &m[0][0]);
  return m;
}

TEST(ViewCell, AGridOfPixelsMovesWhatLiesAtItsDistanceByPixels) {
  const glm::vec3 eye(3, 2, 5), target(0, 1, -4);
  const glm::mat4 middle = perspective(1.0f, 1.5f, 0.1f, 100.0f) * lookAt(eye, target);
  const float distance = glm::length(target - eye);
  GpgpViewCellInfo info = cellOf(middle);
  info.columns = 4;
  info.rows = 2;
  info.height = 400;
  info.distance = distance;
  uint32_t count = 0;
  ASSERT_EQ(gpgpGetViewCellCameras(&info, &count, nullptr), GPGP_SUCCESS);
  ASSERT_EQ(count, 9u);
  std::vector<GpgpCamera> cameras(count);
  ASSERT_EQ(gpgpGetViewCellCameras(&info, &count, cameras.data()), GPGP_SUCCESS);
  EXPECT_EQ(matrixOf(cameras[0]), middle);
  for (uint32_t i = 0; i < 8; ++i) {
    const glm::vec4 p = matrixOf(cameras[i + 1]) * glm::vec4(target, 1);
    // The eye moves right: the point moves left; clip space has y down.
    EXPECT_NEAR(p.x / p.w * 300, 1.5f - static_cast<float>(i % 4), 1e-3f);
    EXPECT_NEAR(p.y / p.w * 200, static_cast<float>(i / 4) - 0.5f, 1e-3f);
    EXPECT_NEAR(p.w, distance, 1e-3f);
  }
}

TEST(ViewCell, SkipsKeepTheMiddleInTheCentre) {
  GpgpViewCellInfo info = cellOf(perspective(1.0f, 1.0f, 0.1f, 100.0f));
  info.columns = info.rows = 32;
  info.height = 100;
  info.distance = 10;
  for (const auto& [skip, expected] : {std::pair(0u, 1025u), {1u, 1025u}, {8u, 17u}, {32u, 1u}, {11u, 9u}}) {
    info.skip = skip;
    uint32_t count = 0;
    ASSERT_EQ(gpgpGetViewCellCameras(&info, &count, nullptr), GPGP_SUCCESS);
    EXPECT_EQ(count, expected) << skip;
    std::vector<GpgpCamera> cameras(count);
    ASSERT_EQ(gpgpGetViewCellCameras(&info, &count, cameras.data()), GPGP_SUCCESS);
    glm::vec2 sum(0);
    for (const GpgpCamera& camera : cameras) sum += glm::vec2(camera.viewProjection[12], camera.viewProjection[13]);
    EXPECT_NEAR(glm::length(sum), 0, 1e-3f);
  }
}

TEST(ViewCell, PointsAreWorldUnitsAlongTheCamerasAxes) {
  const float points[] = {0.5f, 0, 0, 0, 0.25f, 0, 0, 0, 2};
  const glm::vec3 eye(1, 2, 3);
  glm::mat4 parallel(1.0f); // a box of 8 x 8 x 50 in front of the eye
  parallel[0][0] = 0.25f;
  parallel[1][1] = -0.25f;
  parallel[2][2] = -1.0f / 50;
  glm::mat4 reversed = parallel;
  reversed[2][2] = 1.0f / 50;
  reversed[3][2] = 1;
  glm::mat4 offCentre = perspective(1.0f, 1.5f, 0.1f, 100.0f); // as for a headset's eye
  offCentre[2][0] = 0.3f;
  offCentre[2][1] = -0.2f;
  for (const auto& [projection, isReversed] : {std::pair(perspective(1.0f, 1.5f, 0.1f, 100.0f), false),
                                               {offCentre, false},
                                               {parallel, false},
                                               {reversed, true}}) {
    GpgpViewCellInfo info = cellOf(projection * lookAt(eye, eye - glm::vec3(0, 0, 1)), isReversed);
    info.points = points;
    info.pointCount = 3;
    GpgpCamera cameras[4];
    uint32_t count = 4;
    ASSERT_EQ(gpgpGetViewCellCameras(&info, &count, cameras), GPGP_SUCCESS);
    ASSERT_EQ(count, 4u);
    const glm::vec3 places[] = {eye, eye + glm::vec3(0.5f, 0, 0), eye + glm::vec3(0, 0.25f, 0),
                                eye + glm::vec3(0, 0, 2)};
    for (int i = 0; i < 4; ++i) {
      const glm::mat4 expected = projection * lookAt(places[i], places[i] - glm::vec3(0, 0, 1));
      for (int k = 0; k < 16; ++k)
        EXPECT_NEAR(cameras[i].viewProjection[k], expected[k / 4][k % 4], 2e-5f) << i << ' ' << k;
    }
  }
}

TEST(ViewCell, AWalkingViewersPointsFillTheSquareUpToItsBorder) {
  const glm::mat4 projection = perspective(1.0f, 1.0f, 0.1f, 100.0f);
  GpgpViewCellInfo info = cellOf(projection);
  info.walkCount = 64;
  info.walkDistance = 0.5f;
  uint32_t count = 65;
  std::vector<GpgpCamera> cameras(count);
  ASSERT_EQ(gpgpGetViewCellCameras(&info, &count, cameras.data()), GPGP_SUCCESS);
  ASSERT_EQ(count, 65u);
  std::set<std::pair<int, int>> parts; // of 4 x 4
  std::set<float> columns, rows;
  uint32_t atBorder = 0;
  for (uint32_t i = 1; i < count; ++i) {
    const float* m = cameras[i].viewProjection;
    const float x = -m[12] / projection[0][0], y = -m[13] / projection[1][1];
    EXPECT_LE(std::max(std::abs(x), std::abs(y)), 0.50001f);
    EXPECT_NEAR(m[14], projection[3][2], 1e-6f);
    parts.emplace(static_cast<int>(x * 3.99f + 2), static_cast<int>(y * 3.99f + 2));
    columns.insert(x);
    rows.insert(y);
    atBorder += std::max(std::abs(x), std::abs(y)) > 0.4f;
  }
  EXPECT_EQ(parts.size(), 16u);
  EXPECT_EQ(columns.size(), 64u);
  EXPECT_EQ(rows.size(), 64u);
  EXPECT_GT(atBorder, 32u); // of 23 if they lay evenly
  info.walkDistance = 0;
  EXPECT_EQ(gpgpGetViewCellCameras(&info, &count, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  info.walkDistance = 1;
  info.walkCount = 1025;
  EXPECT_EQ(gpgpGetViewCellCameras(&info, &count, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
}

TEST(ViewCell, ArgumentsAreChecked) {
  GpgpViewCellInfo info = cellOf(perspective(1.0f, 1.0f, 0.1f, 100.0f));
  uint32_t count = 0;
  EXPECT_EQ(gpgpGetViewCellCameras(&info, nullptr, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  info.columns = 65;
  info.rows = 1;
  info.height = 10;
  info.distance = 1;
  EXPECT_EQ(gpgpGetViewCellCameras(&info, &count, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  info.columns = 2;
  info.distance = 0;
  EXPECT_EQ(gpgpGetViewCellCameras(&info, &count, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  info.distance = 1;
  EXPECT_EQ(gpgpGetViewCellCameras(&info, &count, nullptr), GPGP_SUCCESS);
  GpgpCamera cameras[2]{};
  count = 2;
  EXPECT_EQ(gpgpGetViewCellCameras(&info, &count, cameras), GPGP_INCOMPLETE);
  EXPECT_EQ(count, 3u);
  EXPECT_NE(cameras[1].viewProjection[0], 0.0f);
  info.pointCount = 1;
  EXPECT_EQ(gpgpGetViewCellCameras(&info, &count, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  const float bad[] = {0, NAN, 0};
  info.points = bad;
  EXPECT_EQ(gpgpGetViewCellCameras(&info, &count, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  info = cellOf(glm::mat4(0.0f));
  EXPECT_EQ(gpgpGetViewCellCameras(&info, &count, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  info.sType = 0;
  EXPECT_EQ(gpgpGetViewCellCameras(&info, &count, nullptr), GPGP_ERROR_INVALID_STRUCT);
}

} // namespace
} // namespace gpgp::test
