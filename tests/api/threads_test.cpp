// Assets are created on loading threads while the frames of the same context go on, and while they are recorded.
// tests/sanitizers/tsan.sh runs this with ThreadSanitizer.
#include "scenarios.h"

#ifdef GPGP_WITH_VECTOR
#include "vector/patch/glyphs.h"
#endif

#include <gpgp/gpgp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
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
/// 200 glyphs, as a file has them.
GpgpResult createBakedGlyphSet(GpgpContext context, uint32_t, GpgpAsset* asset) {
  static const auto kBytes = [] {
    const GpgpPath path = trianglePath();
    std::vector<GpgpGlyph> glyphs(200, GpgpGlyph{0, &path, 1});
    for (size_t i = 0; i < glyphs.size(); ++i) glyphs[i].key = i;
    std::pmr::memory_resource* memory = std::pmr::get_default_resource();
    return vector::bakeGlyphs(*vector::makeGlyphs(glyphs, memory, nullptr), memory);
  }();
  GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
  info.data = kBytes.data();
  info.size = kBytes.size();
  info.methods = GPGP_DRAWING_FLATTENED | GPGP_DRAWING_IN_PASS;
  return gpgpCreateGlyphSet(context, &info, asset);
}
#if defined(GPGP_WITH_COMPILER)
/// A frame of an animation, read and evaluated on the loading thread.
GpgpResult createLottieFrame(GpgpContext context, uint32_t number, GpgpAsset* asset) {
  static constexpr char kText[] =
      R"({"v":"5.5.0","fr":30,"ip":0,"op":60,"w":100,"h":80,"layers":[{"ty":4,"ip":0,"op":60,"st":0,"ks":{"r":{"a":1,
      "k":[{"t":0,"s":[20],"o":{"x":0.3,"y":0},"i":{"x":0.6,"y":1}},{"t":60,"s":[90]}]}},"shapes":[{"ty":"gr","it":[
      {"ty":"rc","p":{"k":[0,0]},"s":{"k":[40,30]},"r":{"k":5}},{"ty":"st","c":{"k":[1,0,0,1]},"o":{"k":100},"w":{"k":3}
      },{"ty":"tr","p":{"k":[0,0]},"a":{"k":[0,0]},"s":{"k":[100,100]},"r":{"k":10},"o":{"k":100}}]}]}]})";
  GpgpLottieSource source = GPGP_LOTTIE_SOURCE_INIT;
  source.data = kText;
  source.size = sizeof kText - 1;
  GpgpLottie lottie = nullptr;
  if (const GpgpResult result = gpgpCreateLottie(&source, &lottie); result != GPGP_SUCCESS) return result;
  GpgpLottieFrame frame = GPGP_LOTTIE_FRAME_INIT;
  GpgpResult result = gpgpEvaluateLottie(lottie, number % 60, &frame);
  GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
  info.paths = frame.paths;
  info.pathCount = frame.pathCount;
  info.groups = frame.groups;
  info.groupCount = frame.groupCount;
  if (result == GPGP_SUCCESS) result = gpgpCreateDrawing(context, &info, asset);
  gpgpDestroyLottie(lottie);
  return result;
}
#endif
#endif
#if defined(GPGP_WITH_SPAWN) && defined(GPGP_WITH_COMPILER)
GpgpResult createGrammar(GpgpContext context, uint32_t, GpgpAsset* asset) {
  static constexpr char kText[] = "axiom Box A; terminal Cube (1, 0); A = SubDiv(X) { -1: Cube | -1: Cube };";
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.name = "halves.pga";
  source.text = kText;
  source.size = sizeof kText - 1;
  GpgpBlob blob{};
  if (const GpgpResult result = gpgpCompileGrammar(&source, &blob); result != GPGP_SUCCESS) return result;
  GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
  info.data = blob.data;
  info.size = blob.size;
  const GpgpResult result = gpgpCreateGrammar(context, &info, asset);
  gpgpFreeBlob(&blob);
  return result;
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
    createDrawing,     createGlyphSet, createBakedGlyphSet,
#if defined(GPGP_WITH_COMPILER)
    createLottieFrame,
#endif
#endif
#if defined(GPGP_WITH_SPAWN) && defined(GPGP_WITH_COMPILER)
    createGrammar,
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

  explicit Frames(const GpgpHostAllocator* host = nullptr) {
    GpgpContextCreateInfo info = device.contextCreateInfo();
    info.hostAllocator = host;
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

// Each service's job is recorded, submitted and reported frame by frame while loading threads create and, on the
// frames' thread, assets go: what is recorded stays the same.
TEST(Threads, FramesAreRecordedBesideLoaders) {
  Frames beside;
  std::vector<std::unique_ptr<Scenario>> scenarios;
  std::vector<std::vector<uint32_t>> wanted;
  for (const std::string& name : scenarioNames()) {
    auto made = makeScenario(name, beside.device);
    ASSERT_EQ(made->createAsset(beside.context), GPGP_SUCCESS);
    ASSERT_EQ(made->createRecorder(beside.context, {name.c_str(), beside.device.graphics().family, 0, VK_FALSE}),
              GPGP_SUCCESS);
    ASSERT_EQ(made->createView(beside.context), GPGP_SUCCESS);
    ASSERT_EQ(made->prewarm(), GPGP_SUCCESS);
    scenarios.push_back(std::move(made));
  }
  while (beside.next() > 0) {
  }
  const auto frame = [&] {
    beside.next();
    beside.device.submitAndWait([&](VkCommandBuffer cmd) {
      for (const auto& scenario : scenarios) EXPECT_EQ(scenario->record(cmd, beside.frame, {}), GPGP_SUCCESS);
    });
    std::vector<std::vector<uint32_t>> results;
    for (const auto& scenario : scenarios) {
      results.push_back(scenario->results());
      GpgpReportHeader header{};
      bool meaningful = false;
      (void)scenario->takeReport(header, meaningful);
    }
    return results;
  };
  wanted = frame();

  std::atomic<uint32_t> ended{0};
  std::vector<std::vector<GpgpAsset>> assets(kLoaders);
  std::vector<std::thread> threads;
  for (uint32_t loader = 0; loader < kLoaders; ++loader)
    threads.emplace_back([&, loader] {
      assets[loader] = load(beside.context, loader);
      ++ended;
    });
  uint32_t frames = 0;
  do {
    GpgpAsset own = nullptr;
    EXPECT_EQ(kCreates[0](beside.context, 0, &own), GPGP_SUCCESS);
    EXPECT_EQ(frame(), wanted) << "frame " << frames;
    gpgpDestroyAsset(own);
    ++frames;
  } while (ended < kLoaders || frames < 3);
  for (std::thread& thread : threads) thread.join();
  for (const auto& made : assets)
    for (const GpgpAsset asset : made) gpgpDestroyAsset(asset);
  EXPECT_EQ(frame(), wanted);
  for (const auto& scenario : scenarios) scenario->destroy();
}

/// Host memory that a loading thread only gets when a whole frame has gone by: the first times, and then after each
/// eighth more allocations.
struct FramesBetween {
  std::mutex mutex;
  std::condition_variable changed;
  std::thread::id loader;
  uint64_t allocations = 0, next = 1, asked = 0, done = 0, stuck = 0;
  bool ended = false;
  GpgpHostAllocator callbacks{};

  FramesBetween() {
    callbacks.userData = this;
    callbacks.allocate = [](void* user, size_t size, size_t alignment) -> void* {
      static_cast<FramesBetween*>(user)->wait();
      return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    };
    callbacks.free = [](void*, void* memory, size_t, size_t) { std::free(memory); };
  }
  void wait() {
    std::unique_lock lock(mutex);
    if (std::this_thread::get_id() != loader || stuck) return;
    if (++allocations < next) return;
    next += 1 + allocations / 8;
    const uint64_t own = ++asked;
    changed.notify_all();
    if (!changed.wait_for(lock, std::chrono::seconds(20), [&] { return done >= own; })) ++stuck; // or it hangs
  }
};

// While assets are validated and converted, whole frames go by on the frames' thread: wherever a creation asks for
// memory, it holds nothing that a frame waits for.
TEST(Threads, FramesGoByWithinEachCreation) {
  FramesBetween between;
  Frames beside(&between.callbacks);
  GpgpAsset first = nullptr; // the first asset makes room for others' handles, and buffers
  for (const Create create : kCreates) {
    ASSERT_EQ(create(beside.context, 0, &first), GPGP_SUCCESS);
    uint64_t frames = 0;
    GpgpAsset asset = nullptr;
    between.ended = false;
    between.allocations = 0, between.next = 1;
    std::thread loader([&] {
      {
        const std::lock_guard lock(between.mutex);
        between.loader = std::this_thread::get_id();
      }
      EXPECT_EQ(create(beside.context, 1, &asset), GPGP_SUCCESS);
      const std::lock_guard lock(between.mutex);
      between.loader = {};
      between.ended = true;
      between.changed.notify_all();
    });
    std::unique_lock lock(between.mutex);
    while (!between.ended) {
      between.changed.wait(lock, [&] { return between.ended || between.asked > between.done; });
      if (between.asked == between.done) continue;
      lock.unlock();
      beside.next();
      lock.lock();
      ++between.done, ++frames;
      between.changed.notify_all();
    }
    lock.unlock();
    loader.join();
    EXPECT_GT(frames, 2u) << "hardly anything was asked for";
    ASSERT_EQ(between.stuck, 0u) << "a frame waited for a creation, at allocation " << frames;
    gpgpDestroyAsset(asset);
    gpgpDestroyAsset(first);
    beside.next();
    beside.next();
  }
}

// What the frames' thread frees does not wait for memory that a loading thread asks the engine for.
TEST(Threads, FreeingDoesNotWaitForAllocations) {
  if (std::size(kCreates) == 0) GTEST_SKIP() << "built without vector and visibility";
  struct Slow {
    host::HeadlessDevice& device = sharedDevice();
    std::atomic<bool> blocks{false}, entered{false};
    std::atomic<int> living{0}, overlapping{0};
  } slow;
  GpgpGpuAllocator gpu{};
  gpu.userData = &slow;
  gpu.allocate = [](void* user, const GpgpGpuAllocationRequest* request, GpgpGpuAllocation* allocation) -> VkResult {
    Slow& self = *static_cast<Slow*>(user);
    if (++self.overlapping != 1) ADD_FAILURE() << "calls overlap";
    self.entered = true;
    while (self.blocks) std::this_thread::yield();
    const VkMemoryAllocateInfo info{
        VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, request->requirements.size,
        self.device.memoryType(request->requirements.memoryTypeBits, request->required, request->preferred)};
    const VolkDeviceTable& vk = self.device.vk();
    VkResult result = vk.vkAllocateMemory(self.device.device(), &info, nullptr, &allocation->memory);
    allocation->mapped = nullptr;
    if (result == VK_SUCCESS && (request->required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT))
      result = vk.vkMapMemory(self.device.device(), allocation->memory, 0, VK_WHOLE_SIZE, 0, &allocation->mapped);
    self.living += result == VK_SUCCESS;
    --self.overlapping;
    return result;
  };
  gpu.free = [](void* user, const GpgpGpuAllocation* allocation) {
    Slow& self = *static_cast<Slow*>(user);
    if (++self.overlapping != 1) ADD_FAILURE() << "calls overlap";
    self.device.vk().vkFreeMemory(self.device.device(), allocation->memory, nullptr);
    --self.living;
    --self.overlapping;
  };
  GpgpContextCreateInfo info = slow.device.contextCreateInfo();
  info.gpuAllocator = &gpu;
  GpgpContext context = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
  GpgpFrame frame{1, 0};
  GpgpAsset own = nullptr, others = nullptr;
  ASSERT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS);
  ASSERT_EQ(kCreates[std::size(kCreates) - 1](context, 0, &own), GPGP_SUCCESS);
  slow.blocks = true;
  slow.entered = false;
  std::thread loader([&] { EXPECT_EQ(kCreates[0](context, 0, &others), GPGP_SUCCESS); });
  while (!slow.entered) std::this_thread::yield();
  gpgpDestroyAsset(own); // a test that hangs here is one that failed
  for (int i = 0; i < 3; ++i) {
    frame = {frame.current + 1, frame.current};
    EXPECT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS);
  }
  GpgpMemoryReport report = GPGP_MEMORY_REPORT_INIT;
  EXPECT_EQ(gpgpGetMemoryReport(context, &report), GPGP_SUCCESS);
  slow.blocks = false;
  loader.join();
  gpgpDestroyAsset(others);
  gpgpDestroyContext(context);
  EXPECT_EQ(slow.living, 0);
}
} // namespace
