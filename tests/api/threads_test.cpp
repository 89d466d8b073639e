// Assets are created on loading threads while the frames of the same context go on.
#include "scenarios.h"

#include <gpgp/gpgp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr uint32_t kLoaders = 3, kAssets = 40; // of each kind, on each loader

#if defined(GPGP_WITH_VECTOR)
GpgpPath trianglePath() {
  static constexpr GpgpPathVerb kVerbs[] = {GPGP_PATH_MOVE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
  static constexpr float kPoints[] = {4, 4, 60, 10, 20, 60};
  return {kVerbs, 4, kPoints, 3, GPGP_FILL_NON_ZERO, {1, 0, 0, 1}};
}
GpgpResult createDrawing(GpgpContext context, uint32_t, GpgpAsset* asset) {
  const std::vector<GpgpPath> paths(100, trianglePath());
  GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
  info.paths = paths.data();
  info.pathCount = static_cast<uint32_t>(paths.size());
  return gpgpCreateDrawing(context, &info, asset);
}
GpgpResult createGlyphSet(GpgpContext context, uint32_t number, GpgpAsset* asset) {
  GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
  info.maxGlyphs = 8 + number;
  info.maxBytes = 4096;
  return gpgpCreateGlyphSet(context, &info, asset);
}
#endif
#if defined(GPGP_WITH_VISIBILITY)
GpgpResult createGeometrySet(GpgpContext context, uint32_t number, GpgpAsset* asset) {
  const std::vector<GpgpMesh> meshes(10 + number);
  GpgpGeometrySetCreateInfo info = GPGP_GEOMETRY_SET_CREATE_INFO_INIT;
  info.meshes = meshes.data();
  info.meshCount = static_cast<uint32_t>(meshes.size());
  return gpgpCreateGeometrySet(context, &info, asset);
}
#endif

using Create = GpgpResult (*)(GpgpContext, uint32_t, GpgpAsset*);
constexpr Create kCreates[] = {
#if defined(GPGP_WITH_VECTOR)
    createDrawing,
    createGlyphSet,
#endif
#if defined(GPGP_WITH_VISIBILITY)
    createGeometrySet,
#endif
};

/// Frames of one context, each with an upload of at most some KiB.
struct Frames {
  host::HeadlessDevice& device = sharedDevice();
  GpgpContext context = nullptr;
  GpgpFrame frame{1, 0};

  Frames() {
    const GpgpContextCreateInfo info = device.contextCreateInfo();
    EXPECT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
  }
  ~Frames() {
    gpgpDestroyContext(context);
    for (const std::string& message : device.takeValidationMessages()) ADD_FAILURE() << message;
  }
  VkDeviceSize next() {
    ++frame.current;
    frame.safe = frame.current - 1;
    VkDeviceSize pending = 0;
    EXPECT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS);
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordUpload(context, cmd, &frame, 16 << 10, &pending), GPGP_SUCCESS);
    });
    return pending;
  }
  GpgpMemoryReport memory() {
    GpgpMemoryReport report = GPGP_MEMORY_REPORT_INIT;
    EXPECT_EQ(gpgpGetMemoryReport(context, &report), GPGP_SUCCESS);
    return report;
  }
};

std::vector<GpgpAsset> load(GpgpContext context, uint32_t loader) {
  std::vector<GpgpAsset> assets;
  for (uint32_t i = 0; i < kAssets; ++i)
    for (const Create create : kCreates) {
      GpgpAsset asset = nullptr;
      EXPECT_EQ(create(context, loader * kAssets + i, &asset), GPGP_SUCCESS);
      assets.push_back(asset);
    }
  return assets;
}

TEST(Threads, AssetsAreCreatedBesideFrames) {
  if (std::size(kCreates) == 0) GTEST_SKIP() << "built without vector and visibility";
  Frames beside, alone;
  std::atomic<uint32_t> ended{0};
  std::vector<std::vector<GpgpAsset>> assets(kLoaders);
  std::vector<std::thread> threads;
  for (uint32_t loader = 0; loader < kLoaders; ++loader)
    threads.emplace_back([&, loader] {
      assets[loader] = load(beside.context, loader);
      ++ended;
    });
  while (ended < kLoaders) { // destroying goes on beside them as well
    GpgpAsset own = nullptr;
    ASSERT_EQ(kCreates[0](beside.context, 0, &own), GPGP_SUCCESS);
    beside.next();
    gpgpDestroyAsset(own);
  }
  for (std::thread& thread : threads) thread.join();
  for (int frames = 0; beside.next() > 0; ++frames) ASSERT_LT(frames, 10000);
  beside.next();

  std::vector<GpgpAsset> expected;
  for (uint32_t loader = 0; loader < kLoaders; ++loader) {
    const auto made = load(alone.context, loader);
    expected.insert(expected.end(), made.begin(), made.end());
  }
  for (const auto& made : assets)
    for (const GpgpAsset asset : made) {
      VkBool32 resident = VK_FALSE;
      ASSERT_EQ(gpgpGetResidency(asset, &resident), GPGP_SUCCESS);
      EXPECT_TRUE(resident);
    }
  // As many bytes as one thread allocates, and none once all is destroyed.
  const GpgpMemoryReport before = beside.memory(), wanted = alone.memory();
  for (uint32_t service = 0; service < GPGP_SERVICE_COUNT; ++service) {
    EXPECT_EQ(before.services[service].deviceBytes, wanted.services[service].deviceBytes);
    EXPECT_EQ(before.services[service].pendingBytes, 0u);
  }
  for (const auto& made : assets)
    for (const GpgpAsset asset : made) gpgpDestroyAsset(asset);
  beside.next();
  beside.next();
  for (const GpgpServiceMemory& service : beside.memory().services) {
    EXPECT_EQ(service.deviceBytes, 0u);
    EXPECT_EQ(service.pendingBytes, 0u);
  }
}
} // namespace
