// Runs a scene through the C API as an engine would, and brings back everything that can be compared with the CPU
// reference.
#pragma once
#include "../device_test.h"
#include "host/frames.h"
#include "host/memory.h"
#include "scenes.h"

#include <gpgp/visibility.h>
#include <gtest/gtest.h>
#include <optional>

namespace gpgp::test {

struct GpuOptions {
  uint32_t listTriangles = UINT32_MAX; ///< the list's budget; UINT32_MAX: all; 0: no list
  bool count = true;
  GpgpHistory view = nullptr;
  uint64_t tag = 0;
  GpgpSamplingMethod method = GPGP_SAMPLING_STANDARD;
  uint32_t samples = 0, slice = 0;
  uint32_t refinements = 0;
  uint32_t width = 0, height = 0; ///< 0: the scene's
  float resolution = 0, reach = 0;
  bool clusters = false;                                          ///< makes and uses them
  uint32_t changedTriangles = UINT32_MAX;                         ///< with a view: room for changes; UINT32_MAX: all
  bool byDraw = true;                                             ///< lists by draw, commands, sizes
  uint32_t drawTriangles = UINT32_MAX, drawCommands = UINT32_MAX; ///< their budgets
};

struct GpuResult {
  std::vector<uint32_t> sizes;                                    ///< samples per triangle
  std::vector<uint32_t> drawCommands, drawIndices, drawTriangles; ///< a draw's triangles ascending
  std::vector<uint32_t> extents;
  std::vector<uint32_t> bits, list, count; ///< list: as much as was written
  std::vector<uint32_t> changed;           ///< with a view: the whole buffer
  std::vector<uint32_t> depth, ids;        ///< from the scratch buffer
  uint32_t chunks = 0, keptChunks = 0;     ///< likewise
  uint32_t reuseFirst = 0, reuseShare = 0; ///< likewise: the arc of groups that were decided (reuse.h)
  GpgpVisibilityReport report = GPGP_VISIBILITY_REPORT_INIT;
};

/// The engine's side of one scene: its buffers on the device.
struct SceneBuffers {
  SceneBuffers(host::HeadlessDevice& device, Scene& scene);
  SceneBuffers(const SceneBuffers&) = delete;
  SceneBuffers& operator=(const SceneBuffers&) = delete;
  ~SceneBuffers();
  host::Buffer positions, indices, draws, commands, numbers, drawCount, coordinates;
  std::vector<host::Image> textures;
  std::vector<GpgpAlphaTest> alphaTests;

private:
  host::HeadlessDevice& device_;
  VkSampler samplers_[2] = {}; // nearest, linear
};

struct VisibilityGpuTest : DeviceTest {
  const host::Queue& queue() const { return device.computeOnly() ? *device.computeOnly() : device.graphics(); }

  GpgpRecorder createRecorder(uint32_t width, uint32_t height, uint32_t maxTriangles = 0, bool engineScratch = false,
                              uint32_t methods = 0, uint32_t maxSamples = 0, uint32_t maxCandidates = 0,
                              uint32_t maxPairs = 0, uint32_t maxCameras = 0, uint32_t maxDraws = 0,
                              uint32_t maxNonOpaque = 0);
  GpgpAsset createGeometrySet(const Scene& scene);
  GpgpHistory createView(uint32_t maxTriangles, float maxLate = 0);
  /// Copies all that is pending.
  void upload();
  /// An info with everything but outputs and view.
  static GpgpVisibilityInfo sampleInfo(const Scene& scene, const SceneBuffers& buffers, GpgpAsset geometrySet);

  /// Samples once, with scratch that was poisoned before, and waits. maxTriangles: of the recorder; 0: the default.
  GpuResult sample(Scene& scene, const GpuOptions& options = {}, uint32_t maxTriangles = 0);
  /// The same with the recorder and the geometry set given.
  GpuResult sample(Scene& scene, GpgpRecorder recorder, GpgpAsset geometrySet, const GpuOptions& options);
};

/// Everything equal, bit for bit.
void expectEqual(const GpuResult& gpu, const visibility::CpuResult& cpu, const std::string& what);

} // namespace gpgp::test
