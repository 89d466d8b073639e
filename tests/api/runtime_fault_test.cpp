// Faults while the game runs: allocations fail under lists, glyphs, live drawings, tiles and whole frames. Calls that
// fail say so, change nothing and can be made again; recordings need no memory at all.
#include "fault_sweep.h"
#include "host/frames.h"
#include "scenarios.h"
#include "vulkan_proxy.h"

#include <gpgp/gpgp.h>

#include <cstring>

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct RuntimeFaults : testing::Test {
  host::HeadlessDevice& device = sharedDevice();
  VulkanProxy proxy{device}; // what Vulkan allocates does not fail
  FailingHost allocator;
  ErrorCount messages;
  GpgpContext context = nullptr;
  GpgpFrame frame{1, 0};

  void SetUp() override {
    GpgpContextCreateInfo info = scenarioContextInfo(device, nullptr);
    info.getInstanceProcAddr = VulkanProxy::getInstanceProcAddr();
    info.messageUserData = &messages;
    info.messageFn = ErrorCount::count<GpgpMessage>;
    const GpgpHostAllocator host = allocator.callbacks();
    info.hostAllocator = &host;
    ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
  }
  void TearDown() override {
    device.waitIdle();
    gpgpDestroyContext(context);
    EXPECT_EQ(allocator.living, 0) << "host allocations leaked";
    for (const std::string& message : device.takeValidationMessages()) ADD_FAILURE() << message;
  }
  GpgpResult advance() {
    ++frame.current, frame.safe = frame.current - 1;
    return gpgpAdvance(context, &frame);
  }
  /// A frame in which all that is pending is uploaded, and what else is recorded runs.
  void runFrame(const std::function<void(VkCommandBuffer)>& record = {}) {
    ASSERT_EQ(advance(), GPGP_SUCCESS);
    proxy.clear();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      ASSERT_EQ(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), GPGP_SUCCESS);
      if (record) record(cmd);
    });
  }
};

void append(std::string& text, const void* data, size_t size) { text.append(static_cast<const char*>(data), size); }
template <class T> void append(std::string& text, const T& value) { append(text, &value, sizeof value); }

// ---------------------------------------------------------------- frames

struct RuntimeFaultFrames : RuntimeFaults, testing::WithParamInterface<std::string> {};

TEST_P(RuntimeFaultFrames, NeedNoMemory) {
  const auto scenario = makeScenario(GetParam(), device);
  ASSERT_EQ(scenario->createAsset(context), GPGP_SUCCESS);
  ASSERT_EQ(scenario->createRecorder(context, {"recorder", device.graphics().family, 0, VK_FALSE}), GPGP_SUCCESS);
  ASSERT_EQ(scenario->createView(context), GPGP_SUCCESS);
  ASSERT_EQ(scenario->prewarm(), GPGP_SUCCESS);
  std::vector<uint32_t> wanted;
  uint32_t reports = 0;
  for (const bool starved : {false, true}) {
    scenario->clearOutputs();
    host::FrameRing ring(device, 1);
    const VkCommandBuffer cmd = ring.begin();
    proxy.clear();
    if (starved) failAllocations(1, true);
    GpgpResult results[4] = {advance(), gpgpRecordUpload(context, cmd, &frame, 0, nullptr),
                             scenario->record(cmd, frame, {})};
    failAllocations(0, false);
    ring.submit();
    ring.waitAll();
    if (starved) failAllocations(1, true);
    results[3] = advance();
    GpgpReportHeader header{};
    bool meaningful = false;
    reports += scenario->takeReport(header, meaningful) == GPGP_SUCCESS && meaningful;
    failAllocations(0, false);
    for (const GpgpResult result : results) EXPECT_EQ(result, GPGP_SUCCESS);
    if (!starved) wanted = scenario->results();
  }
  EXPECT_EQ(scenario->results(), wanted);
  EXPECT_EQ(reports, 2u);
}
INSTANTIATE_TEST_SUITE_P(Services, RuntimeFaultFrames, testing::ValuesIn(scenarioNames()),
                         [](const auto& service) { return service.param; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RuntimeFaultFrames);

// ---------------------------------------------------------------- vector
#if defined(GPGP_WITH_VECTOR)

constexpr GpgpPathVerb kVerbs[] = {GPGP_PATH_MOVE, GPGP_PATH_CUBIC, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
constexpr float kPoints[] = {4, 4, 60, 0, 60, 40, 50, 60, 10, 50};
constexpr GpgpGradientStop kStops[] = {{0, {1, 0, 0, 1}}, {0.5f, {0, 1, 0, 1}}, {1, {0, 0, 1, 0.5f}}};

GpgpGradient gradient() {
  GpgpGradient made{};
  made.transform[0] = made.transform[3] = 1;
  made.end[0] = 60;
  made.stops = kStops;
  made.stopCount = 3;
  return made;
}
GpgpPath path(float blue, const GpgpGradient* painted = nullptr, uint32_t group = 0) {
  return {kVerbs, 4, kPoints, 5, GPGP_FILL_NON_ZERO, {1, 0, blue, 0.75f}, painted, nullptr, nullptr, 0, group};
}

/// What is hit at some points of a canvas of 64 x 64 pixels.
void appendHits(std::string& text, GpgpContext context, const GpgpCanvasItem& item) {
  for (float y = 4; y < 64; y += 8)
    for (float x = 4; x < 64; x += 8) {
      GpgpHitTestInfo info = GPGP_HIT_TEST_INFO_INIT;
      info.items = &item;
      info.itemCount = 1;
      info.x = x, info.y = y;
      GpgpHit hit{};
      append(text, gpgpHitTest(context, &info, &hit));
      append(text, hit);
    }
}

TEST_F(RuntimeFaults, ListsAreAsBeforeACallThatFailed) {
  const auto scenario = makeScenario("vector", device);
  ASSERT_EQ(scenario->createAsset(context), GPGP_SUCCESS);
  ASSERT_EQ(scenario->createRecorder(context, {"recorder", device.graphics().family, 0, VK_FALSE}), GPGP_SUCCESS);
  ASSERT_EQ(scenario->createView(context), GPGP_SUCCESS);
  ASSERT_EQ(scenario->prewarm(), GPGP_SUCCESS);
  gpgpDestroyList(scenario->shownList);
  GpgpList& list = scenario->shownList = nullptr;
  uint32_t glyph = 0;
  const uint64_t key = 17;
  ASSERT_EQ(gpgpFindGlyphs(scenario->secondAsset, &key, 1, &glyph), GPGP_SUCCESS);

  const GpgpGradient painted = gradient();
  std::vector<GpgpListShape> shapes(1);
  for (size_t i = 0; i < shapes.size(); ++i) {
    shapes[i].kind = GPGP_LIST_ELLIPSE;
    shapes[i].box[2] = shapes[i].box[3] = 30;
    shapes[i].color[3] = 1;
    shapes[i].gradient = &painted;
    shapes[i].id = 100 + i;
  }
  GpgpGlyphInstance text[3] = {};
  for (int i = 0; i < 3; ++i) text[i] = {glyph, 8.0f * static_cast<float>(i), 20, 0.25f, {0, 1, 0, 1}};
  constexpr float kTurn[] = {0.8f, 0.6f, -0.6f, 0.8f, 20, 0}, kBox[] = {4, 4, 50, 50}, kRadii[] = {5, 5, 5, 5};

  FaultJob job;
  job.messages = &messages;
  job.newsAreOurs = false;
  job.calls = {
      [&] {
        const GpgpListCreateInfo info = GPGP_LIST_CREATE_INFO_INIT;
        return list ? GPGP_SUCCESS : gpgpCreateList(context, &info, &list);
      },
      [&] { return gpgpPushTransform(list, kTurn, nullptr); },
      [&] { return gpgpPushClip(list, kBox, kRadii); },
      [&] { return gpgpPushGroup(list, 0.5f); },
      [&] { return gpgpAddShapes(list, shapes.data(), 1); },
      [&] { return gpgpPopState(list); },
      [&] { return gpgpAddText(list, scenario->secondAsset, text, 3, 7); },
      [&] { return gpgpPushOpacity(list, 0.5f); },
      [&] { return gpgpAddDrawing(list, scenario->asset, 0, 9); },
      [&] { return gpgpPopState(list); },
      [&] { return gpgpPopState(list); },
      [&] { return gpgpPopState(list); },
  };
  job.state = [&] {
    std::string state;
    if (!list) return state;
    GpgpCanvasItem item = GPGP_CANVAS_ITEM_INIT;
    item.list = list;
    appendHits(state, context, item);
    return state;
  };
  std::vector<uint32_t> picture;
  job.end = [&] {
    const auto record = [&](VkCommandBuffer cmd) { ASSERT_EQ(scenario->record(cmd, frame, {}), GPGP_SUCCESS); };
    runFrame(record);
    if (picture.empty()) picture = scenario->results();
    EXPECT_EQ(scenario->results(), picture);
    gpgpDestroyList(list);
    list = nullptr;
    ASSERT_EQ(advance(), GPGP_SUCCESS);
    ASSERT_EQ(advance(), GPGP_SUCCESS);
    proxy.calls = {};
  };
  sweepFaults(job);
}

TEST_F(RuntimeFaults, GlyphSetsAreAsBeforeACallThatFailed) {
  GpgpAsset set = nullptr;
  const GpgpPath outline = path(0);
  const GpgpGradient painted = gradient();
  const GpgpPath colored = path(1, &painted);
  constexpr uint32_t kGlyphs = 5;
  const auto add = [&](uint64_t first) {
    GpgpGlyph glyphs[kGlyphs];
    uint32_t indices[kGlyphs];
    for (uint32_t i = 0; i < kGlyphs; ++i) glyphs[i] = {first + i, i % 2 ? &colored : &outline, 1, nullptr};
    return gpgpAddGlyphs(set, glyphs, kGlyphs, indices);
  };
  const auto settle = [&] { // what was added is uploaded and can be evicted
    const UncountedNew own;
    runFrame();
    EXPECT_EQ(advance(), GPGP_SUCCESS);
    EXPECT_EQ(advance(), GPGP_SUCCESS);
    proxy.calls = {};
    return GPGP_SUCCESS;
  };
  FaultJob job;
  job.messages = &messages;
  job.newsAreOurs = false;
  job.begin = [&] {
    GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
    info.maxGlyphs = 7;
    info.maxBytes = 8192;
    ASSERT_EQ(gpgpCreateGlyphSet(context, &info, &set), GPGP_SUCCESS);
    ASSERT_EQ(add(1), GPGP_SUCCESS);
    settle();
  };
  job.calls = {[&] { return add(3); },
               [&] { // evicts what no unfinished frame has used, or looked for
                 for (int i = 0; i < 2; ++i) EXPECT_EQ(advance(), GPGP_SUCCESS);
                 return add(100);
               }};
  job.state = [&] {
    std::string state;
    GpgpGlyphSetInfo info = GPGP_GLYPH_SET_INFO_INIT;
    EXPECT_EQ(gpgpGetGlyphSetInfo(set, &info), GPGP_SUCCESS);
    append(state, info.glyphs), append(state, info.bytes), append(state, info.evicted);
    for (uint64_t key = 0; key < 120; ++key) {
      uint32_t index = 0;
      append(state, gpgpFindGlyphs(set, &key, 1, &index));
      append(state, index);
    }
    return state;
  };
  job.end = [&] {
    gpgpDestroyAsset(set);
    set = nullptr;
    settle();
  };
  // The second call evicts, for which the first one's glyphs must have settled.
  job.calls.insert(job.calls.begin() + 1, settle);
  sweepFaults(job);
}

TEST_F(RuntimeFaults, DrawingsAreEditedOrNot) {
  GpgpAsset base = nullptr, edited = nullptr, layered = nullptr;
  const GpgpGradient painted = gradient();
  const GpgpPath paths[] = {path(0), path(1, nullptr, 1), path(0, &painted, 2), path(1, nullptr, 2),
                            path(0, nullptr, 3)};
  const GpgpPath clip = path(0);
  GpgpFilterStep blur{};
  blur.kind = GPGP_FILTER_GAUSSIAN_BLUR;
  blur.values[0] = blur.values[1] = 2;
  blur.region[2] = blur.region[3] = 64;
  GpgpLayer layer{};
  layer.blend = GPGP_BLEND_SCREEN;
  layer.mask = 3;
  layer.maskRegion[2] = layer.maskRegion[3] = layer.filterRegion[2] = layer.filterRegion[3] = 64;
  for (const int k : {0, 3}) layer.maskTransform[k] = layer.filterTransform[k] = 1;
  layer.filter = &blur;
  layer.filterCount = 1;
  const GpgpPathGroup groups[] = {
      {0, 0.5f, &clip, 1, nullptr}, {0, 1, nullptr, 0, &layer}, {0, 1, nullptr, 0, nullptr}};
  FaultJob job;
  job.messages = &messages;
  job.newsAreOurs = false;
  job.calls = {[&] {
                 GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
                 info.paths = paths;
                 info.pathCount = 2;
                 info.groups = groups;
                 info.groupCount = 1;
                 info.editable = VK_TRUE;
                 info.methods = GPGP_DRAWING_FLATTENED | GPGP_DRAWING_IN_PASS;
                 return gpgpCreateDrawing(context, &info, &base);
               },
               [&] {
                 const GpgpPathEdit edit{1, path(0, &painted)};
                 GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
                 info.base = base;
                 info.edits = &edit;
                 info.editCount = 1;
                 info.editable = VK_TRUE;
                 return gpgpCreateDrawing(context, &info, &edited);
               },
               [&] {
                 GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
                 info.paths = paths;
                 info.pathCount = 5;
                 info.groups = groups;
                 info.groupCount = 3;
                 return gpgpCreateDrawing(context, &info, &layered);
               }};
  job.state = [&] {
    std::string state;
    for (const GpgpAsset asset : {base, edited, layered}) {
      if (!asset) continue;
      GpgpDrawingInfo info = GPGP_DRAWING_INFO_INIT;
      EXPECT_EQ(gpgpGetDrawingInfo(asset, &info), GPGP_SUCCESS);
      append(state, info.bounds), append(state, info.paths), append(state, info.curves);
      GpgpCanvasItem item = GPGP_CANVAS_ITEM_INIT;
      item.drawing = asset;
      if (asset != layered) appendHits(state, context, item);
    }
    return state;
  };
  job.end = [&] {
    gpgpDestroyAsset(base);
    gpgpDestroyAsset(edited);
    gpgpDestroyAsset(layered);
    base = edited = layered = nullptr;
    runFrame();
    ASSERT_EQ(advance(), GPGP_SUCCESS);
    proxy.calls = {};
  };
  sweepFaults(job);
}

// Device memory that runs out while the game goes on: the new asset is refused, and what is shown stays.
TEST_F(RuntimeFaults, AssetsThatFindNoDeviceMemoryAreRefused) {
  const auto scenario = makeScenario("vector", device);
  ASSERT_EQ(scenario->createAsset(context), GPGP_SUCCESS);
  ASSERT_EQ(scenario->createRecorder(context, {"recorder", device.graphics().family, 0, VK_FALSE}), GPGP_SUCCESS);
  ASSERT_EQ(scenario->createView(context), GPGP_SUCCESS);
  ASSERT_EQ(scenario->prewarm(), GPGP_SUCCESS);
  const auto picture = [&] {
    scenario->clearOutputs();
    runFrame([&](VkCommandBuffer cmd) { ASSERT_EQ(scenario->record(cmd, frame, {}), GPGP_SUCCESS); });
    return scenario->results();
  };
  const auto wanted = picture();
  const std::vector<GpgpPath> many(40000, path(0)); // more than the blocks that there are hold
  const auto bytes = [&] {
    GpgpMemoryReport report = GPGP_MEMORY_REPORT_INIT;
    EXPECT_EQ(gpgpGetMemoryReport(context, &report), GPGP_SUCCESS);
    return report.services[GPGP_SERVICE_VECTOR].deviceBytes;
  };
  const VkDeviceSize before = bytes();
  GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
  info.paths = many.data();
  info.pathCount = static_cast<uint32_t>(many.size());
  uint32_t failures = 0;
  for (const VkResult fault : {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_DEVICE_LOST})
    for (uint32_t n = 1;; ++n) {
      ASSERT_LT(n, 100u);
      GpgpAsset asset = nullptr;
      messages = {};
      proxy.failCreation(n, fault);
      const GpgpResult result = gpgpCreateDrawing(context, &info, &asset);
      proxy.failCreation(0, VK_SUCCESS);
      if (result == GPGP_SUCCESS) {
        gpgpDestroyAsset(asset);
        ASSERT_EQ(advance(), GPGP_SUCCESS);
        ASSERT_EQ(advance(), GPGP_SUCCESS);
        break;
      }
      ++failures;
      EXPECT_EQ(asset, nullptr);
      EXPECT_EQ(messages.errors, 1u);
      EXPECT_EQ(result, fault == VK_ERROR_DEVICE_LOST            ? GPGP_ERROR_DEVICE_LOST
                        : fault == VK_ERROR_OUT_OF_DEVICE_MEMORY ? GPGP_ERROR_OUT_OF_DEVICE_MEMORY
                                                                 : GPGP_ERROR_OUT_OF_HOST_MEMORY);
      EXPECT_EQ(bytes(), before);
    }
  EXPECT_GE(failures, 6u);
  EXPECT_EQ(picture(), wanted);
}
#endif

// ---------------------------------------------------------------- spawn
#if defined(GPGP_WITH_SPAWN) && defined(GPGP_WITH_COMPILER)

TEST_F(RuntimeFaults, TilesNeedNoMemory) {
  const auto scenario = makeScenario("spawn", device);
  ASSERT_EQ(scenario->createAsset(context), GPGP_SUCCESS);
  ASSERT_EQ(scenario->createRecorder(context, {"recorder", device.graphics().family, 0, VK_FALSE}), GPGP_SUCCESS);
  ASSERT_EQ(scenario->prewarm(), GPGP_SUCCESS);
  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
  const host::Buffer instances(device, sizeof(GpgpInstance) * 256, kUsage), draws(device, 4096, kUsage);
  GpgpTileSetCreateInfo setInfo = GPGP_TILE_SET_CREATE_INFO_INIT;
  setInfo.spawner = scenario->recorder;
  setInfo.grammar = scenario->asset;
  setInfo.maxTiles = 4;
  setInfo.instances = instances.range(Scenario::kAfter, Scenario::kAfter);
  setInfo.draws = draws.range(Scenario::kAfter, Scenario::kAfter);
  GpgpHistory set = nullptr;
  for (uint64_t n = 1;; ++n) { // creation at run time: for every n
    failAllocations(n, false);
    const GpgpResult made = gpgpCreateTileSet(context, &setInfo, &set);
    failAllocations(0, false);
    if (made == GPGP_SUCCESS) break;
    ASSERT_EQ(made, GPGP_ERROR_OUT_OF_HOST_MEMORY);
    ASSERT_EQ(set, nullptr);
  }
  const host::Buffer axioms(device, sizeof(GpgpAxiom), kUsage, host::Memory::host);
  GpgpAxiom& axiom = *axioms.as<GpgpAxiom>();
  axiom = {};
  axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1;
  axiom.size[0] = axiom.size[1] = axiom.size[2] = 4;
  axiom.start = GPGP_AXIOM_DEFAULT_START;
  GpgpTileInfo info = GPGP_TILE_INFO_INIT;
  info.axioms = axioms.range(Scenario::kBefore);
  info.axiomCount = 1;
  info.capacity = 16;
  runFrame();
  GpgpTile tiles[3] = {};
  const auto frames = [&](bool starved) { // tiles come, are derived anew, move, are trimmed and go
    std::vector<uint32_t> seen;
    for (int i = 0; i < 6; ++i) {
      host::FrameRing ring(device, 1);
      const VkCommandBuffer cmd = ring.begin();
      proxy.clear();
      GpgpTile& tile = tiles[i % 3];
      axiom.seed = static_cast<uint32_t>(i + 1);
      info.flags = i == 3 ? GPGP_TILE_MOVE : 0;
      if (starved) failAllocations(1, true);
      GpgpResult results[4] = {advance(), gpgpRecordTile(set, cmd, &frame, &info, &tile), GPGP_SUCCESS, GPGP_SUCCESS};
      if (i == 4) results[2] = gpgpTrimTile(set, tile, 16);
      if (i == 5) results[3] = gpgpRecordFreeTile(set, cmd, &frame, tile, 0);
      failAllocations(0, false);
      if (i == 5) tile = 0;
      for (const GpgpResult result : results) EXPECT_EQ(result, GPGP_SUCCESS) << i << ": " << messages.last;
      ring.submit();
      ring.waitAll();
      GpgpTileSetReport report = GPGP_TILE_SET_REPORT_INIT;
      EXPECT_EQ(gpgpGetTileSetReport(set, &report), GPGP_SUCCESS);
      seen.insert(seen.end(), {report.tiles, report.used, report.largest, report.holes});
      if (tile) {
        GpgpTileRange range{};
        EXPECT_EQ(gpgpGetTileRange(set, tile, &range), GPGP_SUCCESS);
        VkDeviceSize stride = 0;
        EXPECT_EQ(gpgpGetTileStride(scenario->recorder, scenario->asset, &stride), GPGP_SUCCESS);
        const auto words = host::download<uint32_t>(device, draws, 10, range.slot * stride);
        seen.insert(seen.end(), {range.first, range.capacity, words[1], words[4], words[6], words[9]});
      }
    }
    for (GpgpTile& tile : tiles) {
      if (tile) runFrame([&](VkCommandBuffer cmd) { gpgpRecordFreeTile(set, cmd, &frame, tile, 0); });
      tile = 0;
    }
    return seen;
  };
  host::fill(device, draws, 0);
  const auto wanted = frames(false);
  host::fill(device, draws, 0);
  EXPECT_EQ(frames(true), wanted);
}
#endif

// ---------------------------------------------------------------- pipeline caches

TEST_F(RuntimeFaults, PipelineCachesOfOthersAreIgnored) {
  size_t size = 0;
  ASSERT_EQ(gpgpGetPipelineCacheData(context, &size, nullptr), GPGP_SUCCESS);
  std::vector<uint8_t> good(size);
  ASSERT_EQ(gpgpGetPipelineCacheData(context, &size, good.data()), GPGP_SUCCESS);
  ASSERT_GE(size, 32u);
  proxy.failCreation(1, VK_ERROR_DEVICE_LOST);
  EXPECT_EQ(gpgpGetPipelineCacheData(context, &size, good.data()), GPGP_ERROR_DEVICE_LOST);
  proxy.failCreation(0, VK_SUCCESS);
  const auto create = [&](const std::vector<uint8_t>& data) { // messages of the context
    std::vector<std::string> texts;
    GpgpContextCreateInfo info = scenarioContextInfo(device, &texts);
    info.pipelineCacheData = data.data();
    info.pipelineCacheSize = data.size();
    GpgpContext made = nullptr;
    EXPECT_EQ(gpgpCreateContext(&info, &made), GPGP_SUCCESS);
    gpgpDestroyContext(made);
    return texts.size();
  };
  EXPECT_EQ(create(good), 0u);
  for (size_t bit = 0; bit < 32 * 8; ++bit) { // of the header: size, version, vendor, device and the driver's UUID
    auto other = good;
    other[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
    if (bit < 32 && other[0] >= 32 && other[1] == 0 && other[2] == 0 && other[3] == 0) continue; // a longer header
    EXPECT_EQ(create(other), 1u) << "bit " << bit;
  }
  for (size_t cut = 1; cut < 32; ++cut) EXPECT_EQ(create({good.begin(), good.begin() + cut}), 1u) << cut << " bytes";
}

} // namespace
