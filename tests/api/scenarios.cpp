#include "scenarios.h"

#include <gpgp/gpgp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <stdexcept>

namespace gpgp::test {

void Scenario::destroy() {
  gpgpDestroyHistory(view);
  gpgpDestroyRecorder(recorder);
  gpgpDestroyAsset(secondAsset);
  gpgpDestroyAsset(asset);
#if defined(GPGP_WITH_VECTOR)
  gpgpDestroyList(shownList);
  shownList = nullptr;
#endif
  view = nullptr, recorder = nullptr, asset = secondAsset = nullptr;
}

GpgpContextCreateInfo scenarioContextInfo(host::HeadlessDevice& device, std::vector<std::string>* messages) {
  GpgpContextCreateInfo info = device.contextCreateInfo();
  info.label = "contract";
  info.maxFramesInFlight = 3;
  info.maxRecordingsPerFrame = 4;
  info.uploadRingBytes = 1 << 20;
  info.messageUserData = messages;
  info.messageFn = [](void* user, const GpgpMessage* m) {
    if (user) static_cast<std::vector<std::string>*>(user)->push_back(std::string(m->function) + ": " + m->text);
  };
  return info;
}

namespace {
constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

#if defined(GPGP_WITH_SPAWN) && defined(GPGP_WITH_COMPILER)
class SpawnScenario final : public Scenario {
public:
  static constexpr uint32_t kAxioms = 3;
  static constexpr uint32_t kInstances = 3 * 8 * 2;
  explicit SpawnScenario(host::HeadlessDevice& d)
      : Scenario(d), axioms_(d, sizeof(GpgpAxiom) * kAxioms, kStorage, host::Memory::host),
        instances_(d, sizeof(GpgpInstance) * 64, kStorage),
        draws_(d, sizeof(VkDrawIndexedIndirectCommand) * 2, kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT),
        count_(d, 4, kStorage) {
    for (uint32_t i = 0; i < kAxioms; ++i) {
      GpgpAxiom axiom{};
      axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1;
      axiom.transform[3] = 10.0f * static_cast<float>(i);
      axiom.size[0] = axiom.size[1] = axiom.size[2] = 4;
      axiom.seed = i + 1;
      axiom.id = i;
      axiom.start = GPGP_AXIOM_DEFAULT_START;
      axiom.attribute = 0.5f;
      axioms_.as<GpgpAxiom>()[i] = axiom;
    }
  }
  const char* name() const override { return "spawn"; }
  GpgpResult createAsset(GpgpContext context) override {
    // Eight sub-boxes of each axiom, each a tower and its roof.
    static constexpr char kText[] = "axiom Box A; terminal Tower (1, 0); terminal Roof (1, 1);\n"
                                    "A = SubDiv(X) { -1: B | -1: B };\n"
                                    "B = SubDiv(Y) { -1: C | -1: C };\n"
                                    "C = SubDiv(Z) { -1: D | -1: D };\n"
                                    "D = Replicate() { Tower | Translate(0, 1, 0) Roof };\n";
    GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
    source.name = "towers.pga";
    source.text = kText;
    source.size = sizeof kText - 1;
    GpgpBlob blob{};
    if (const GpgpResult result = gpgpCompileGrammar(&source, &blob); result != GPGP_SUCCESS)
      throw std::runtime_error("the scenario's grammar does not compile");
    GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
    info.label = "towers";
    info.data = blob.data;
    info.size = blob.size;
    const GpgpResult result = gpgpCreateGrammar(context, &info, &asset);
    gpgpFreeBlob(&blob);
    return result;
  }
  GpgpResult createRecorder(GpgpContext context, const GpgpRecorderCreateInfo& base) override {
    GpgpSpawnerCreateInfo info = GPGP_SPAWNER_CREATE_INFO_INIT;
    info.base = base;
    info.maxShapes = 1024;
    info.maxDepth = 16;
    return gpgpCreateSpawner(context, &info, &recorder);
  }
  GpgpResult record(VkCommandBuffer cmd, const GpgpFrame& frame, const GpgpRecordingInfo& base) override {
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.base = base;
    info.grammar = asset;
    info.axioms = axioms_.range(kBefore);
    info.axiomCount = kAxioms;
    info.instances = instances_.range(kBefore, kAfter);
    info.draws = draws_.range(kBefore, kAfter);
    info.count = count_.range(kBefore, kAfter);
    return gpgpRecordPrepareSpawn(recorder, cmd, &frame, &info);
  }
  std::vector<uint32_t> results() override {
    const auto count = host::download<uint32_t>(device, count_, 1);
    auto draws = host::download<VkDrawIndexedIndirectCommand>(device, draws_, 2);
    auto instances = host::download<GpgpInstance>(device, instances_, std::min(count[0], 64u));
    std::sort(instances.begin(), instances.end(), [](const GpgpInstance& a, const GpgpInstance& b) {
      return std::array{a.bucket, a.axiomId, a.key[0], a.key[1]} < std::array{b.bucket, b.axiomId, b.key[0], b.key[1]};
    });
    std::vector<uint32_t> words{count[0]};
    for (const auto& draw : draws) words.insert(words.end(), {draw.instanceCount, draw.firstInstance});
    const size_t start = words.size();
    words.resize(start + instances.size() * sizeof(GpgpInstance) / 4);
    std::memcpy(words.data() + start, instances.data(), instances.size() * sizeof(GpgpInstance));
    return words;
  }
  void clearOutputs() override {
    host::fill(device, instances_, 0xffffffffu);
    host::fill(device, draws_, 0xffffffffu);
    host::fill(device, count_, 0xffffffffu);
  }
  GpgpResult takeReport(GpgpReportHeader& header, bool& meaningful) override {
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    const GpgpResult result = gpgpGetSpawnReport(recorder, &report);
    header = report.base;
    meaningful = report.terminals == kInstances && report.instancesWritten == kInstances;
    return result;
  }

private:
  host::Buffer axioms_, instances_, draws_, count_;
};
#endif

#if defined(GPGP_WITH_VECTOR)
class VectorScenario final : public Scenario {
public:
  static constexpr uint32_t kSize = 64;
  explicit VectorScenario(host::HeadlessDevice& d) : Scenario(d), image_(d, {VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize}) {}
  const char* name() const override { return "vector"; }
  GpgpResult createAsset(GpgpContext context) override {
    // A disc-like cubic loop over a triangle.
    static constexpr GpgpPathVerb kTriangle[] = {GPGP_PATH_MOVE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
    static constexpr float kTrianglePoints[] = {4, 4, 60, 10, 20, 60};
    static constexpr GpgpPathVerb kLoop[] = {GPGP_PATH_MOVE, GPGP_PATH_CUBIC, GPGP_PATH_CUBIC, GPGP_PATH_CLOSE};
    static constexpr float kLoopPoints[] = {10, 32, 10, 0, 54, 0, 54, 32, 54, 64, 10, 64, 10, 32};
    GpgpPath paths[2] = {};
    paths[0] = {kTriangle, 4, kTrianglePoints, 3, GPGP_FILL_NON_ZERO, {1, 0, 0, 1}};
    paths[1] = {kLoop, 4, kLoopPoints, 7, GPGP_FILL_EVEN_ODD, {0, 0, 1, 0.5f}};
    GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
    info.label = "loop";
    info.paths = paths;
    info.pathCount = 2;
    secondAsset = nullptr;
    shownList = nullptr;
    if (const GpgpResult result = gpgpCreateDrawing(context, &info, &asset); result != GPGP_SUCCESS) return result;
    // A text over it, of the triangle as a glyph.
    GpgpGlyphSetCreateInfo setInfo = GPGP_GLYPH_SET_CREATE_INFO_INIT;
    setInfo.label = "glyphs";
    setInfo.maxGlyphs = 8;
    setInfo.maxBytes = 4096;
    if (const GpgpResult result = gpgpCreateGlyphSet(context, &setInfo, &secondAsset); result != GPGP_SUCCESS)
      return result;
    const GpgpGlyph glyph{17, paths, 1, nullptr};
    uint32_t index = 0;
    if (const GpgpResult result = gpgpAddGlyphs(secondAsset, &glyph, 1, &index); result != GPGP_SUCCESS) return result;
    for (size_t i = 0; i < std::size(glyphs_); ++i)
      glyphs_[i] = {index, 10 * static_cast<float>(i), 4, 0.25f, {0, 1, 0, 1}};
    return createList(context);
  }
  /// A shape and the text within a clip that is turned, and within a scissor.
  GpgpResult createList(GpgpContext context) {
    const GpgpListCreateInfo info = GPGP_LIST_CREATE_INFO_INIT;
    if (const GpgpResult result = gpgpCreateList(context, &info, &shownList); result != GPGP_SUCCESS) return result;
    GpgpListShape shape{};
    shape.kind = GPGP_LIST_ELLIPSE;
    shape.box[2] = shape.box[3] = 40;
    shape.color[1] = shape.color[3] = 0.5f;
    constexpr float kTurn[] = {0.8f, 0.6f, -0.6f, 0.8f, 20, 0}, kBox[] = {4, 4, 50, 50};
    GpgpResult result = gpgpPushClip(shownList, kBox, nullptr);
    if (!result) result = gpgpPushTransform(shownList, kTurn, nullptr);
    if (!result) result = gpgpPushClip(shownList, kBox, nullptr);
    if (!result) result = gpgpAddShapes(shownList, &shape, 1);
    if (!result) result = gpgpAddText(shownList, secondAsset, glyphs_, 5, 0);
    for (int i = 0; i < 3 && !result; ++i) result = gpgpPopState(shownList);
    return result;
  }
  GpgpResult createRecorder(GpgpContext context, const GpgpRecorderCreateInfo& base) override {
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = base;
    info.maxWidth = info.maxHeight = kSize;
    info.maxPaths = 256;
    info.maxTileEntries = 4096;
    info.maxDrawings = 5;
    info.maxGlyphs = 10;
    info.maxShapes = 2;
    info.targets = GPGP_CANVAS_TARGET_HISTORY | GPGP_CANVAS_TARGET_RGBA8;
    return gpgpCreateCanvas(context, &info, &recorder);
  }
  GpgpResult createView(GpgpContext context) override {
    GpgpCanvasHistoryCreateInfo info = GPGP_CANVAS_HISTORY_CREATE_INFO_INIT;
    info.label = "loop view";
    info.width = info.height = kSize;
    return gpgpCreateCanvasHistory(context, &info, &view);
  }
  GpgpResult record(VkCommandBuffer cmd, const GpgpFrame& frame, const GpgpRecordingInfo& base) override {
    GpgpCanvasItem items[3] = {
        {asset, {1, 0, 0, 1, 0, 0}, 1}, {nullptr, {1, 0, 0, 1, 0, 0}, 1}, {nullptr, {1, 0, 0, 1, 0, 0}, 1}};
    items[1].glyphSet = secondAsset;
    items[1].glyphs = glyphs_;
    items[1].glyphCount = static_cast<uint32_t>(std::size(glyphs_));
    items[2].list = shownList;
    GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
    info.base = base;
    info.width = info.height = kSize;
    info.items = items;
    info.itemCount = 3;
    info.history = view;
    info.target =
        image_.target({VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED},
                      {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_GENERAL});
    return gpgpRecordPrepareCanvas(recorder, cmd, &frame, &info);
  }
  std::vector<uint32_t> results() override {
    const auto bytes = host::downloadImage(device, image_, VK_IMAGE_LAYOUT_GENERAL);
    std::vector<uint32_t> words(bytes.size() / 4);
    std::memcpy(words.data(), bytes.data(), bytes.size());
    return words;
  }
  void clearOutputs() override {
    device.submitAndWait([&](VkCommandBuffer cmd) {
      host::imageBarrier(device, cmd, image_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
      const VkClearColorValue grey{{0.5f, 0.5f, 0.5f, 0.5f}};
      const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
      device.vk().vkCmdClearColorImage(cmd, image_.handle(), VK_IMAGE_LAYOUT_GENERAL, &grey, 1, &range);
    });
  }
  GpgpResult takeReport(GpgpReportHeader& header, bool& meaningful) override {
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    const GpgpResult result = gpgpGetCanvasReport(recorder, &report);
    header = report.base;
    meaningful = report.paths > 0 && report.tileEntries > 0 && report.pathsDropped == 0 &&
                 report.glyphs == 2 * std::size(glyphs_) && report.shapes == 2 && report.items == 4;
    return result;
  }

private:
  host::Image image_;
  GpgpGlyphInstance glyphs_[5] = {};
};
#endif

#if defined(GPGP_WITH_VISIBILITY)
class VisibilityScenario final : public Scenario {
public:
  static constexpr uint32_t kTriangles = 4;
  explicit VisibilityScenario(host::HeadlessDevice& d)
      : Scenario(d), positions_(d, sizeof(float) * 3 * 8, kStorage, host::Memory::host),
        indices_(d, sizeof(uint32_t) * 6, kStorage, host::Memory::host),
        draws_(d, sizeof(GpgpVisibilityDraw) * 2, kStorage, host::Memory::host), bits_(d, 16, kStorage),
        list_(d, 64, kStorage), count_(d, 16, kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT) {
    // A unit quad, drawn twice: the second, smaller and nearer, hides part of the first.
    constexpr float kQuad[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    constexpr uint32_t kIndices[] = {0, 1, 2, 0, 2, 3};
    std::memcpy(positions_.mapped(), kQuad, sizeof kQuad);
    std::memcpy(indices_.mapped(), kIndices, sizeof kIndices);
    for (uint32_t i = 0; i < 2; ++i) {
      GpgpVisibilityDraw draw{};
      const float scale = i ? 0.5f : 1.0f;
      draw.transform[0] = draw.transform[5] = draw.transform[10] = scale;
      draw.transform[11] = i ? 0.25f : 0.5f; // depth, as the camera below looks along +Z
      draw.firstTriangle = i * 2;
      draw.flags = GPGP_DRAW_TWO_SIDED;
      draws_.as<GpgpVisibilityDraw>()[i] = draw;
    }
  }
  const char* name() const override { return "visibility"; }
  GpgpResult createAsset(GpgpContext context) override {
    const GpgpMesh mesh{0, 6, 0};
    GpgpGeometrySetCreateInfo info = GPGP_GEOMETRY_SET_CREATE_INFO_INIT;
    info.label = "quad";
    info.meshes = &mesh;
    info.meshCount = 1;
    return gpgpCreateGeometrySet(context, &info, &asset);
  }
  GpgpResult createRecorder(GpgpContext context, const GpgpRecorderCreateInfo& base) override {
    GpgpVisibilityRecorderCreateInfo info = GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT;
    info.base = base;
    info.maxWidth = info.maxHeight = 64;
    info.maxDraws = 4;
    info.maxTriangles = 64;
    return gpgpCreateVisibilityRecorder(context, &info, &recorder);
  }
  GpgpResult createView(GpgpContext context) override {
    GpgpCameraHistoryCreateInfo info = GPGP_CAMERA_HISTORY_CREATE_INFO_INIT;
    info.label = "camera";
    info.maxTriangles = 64;
    return gpgpCreateCameraHistory(context, &info, &view);
  }
  GpgpResult record(VkCommandBuffer cmd, const GpgpFrame& frame, const GpgpRecordingInfo& base) override {
    GpgpVisibilityInfo info = GPGP_VISIBILITY_INFO_INIT;
    info.base = base;
    info.geometrySet = asset;
    info.history = view;
    for (int i = 0; i < 4; ++i) info.camera.viewProjection[i * 5] = 1;
    info.width = info.height = 64;
    info.positions = positions_.range(kBefore);
    info.positionStride = 12;
    info.indices = indices_.range(kBefore);
    info.indexType = VK_INDEX_TYPE_UINT32;
    info.draws = draws_.range(kBefore);
    info.drawCount = 2;
    info.triangleCount = kTriangles;
    info.visibleBits = bits_.range(kBefore, kAfter);
    info.visibleList = list_.range(kBefore, kAfter);
    info.visibleCount = count_.range(kBefore, kAfter);
    return gpgpRecordPrepareVisibility(recorder, cmd, &frame, &info);
  }
  std::vector<uint32_t> results() override {
    std::vector<uint32_t> words{host::download<uint32_t>(device, bits_, 1)[0]};
    const auto count = host::download<uint32_t>(device, count_, 4);
    auto list = host::download<uint32_t>(device, list_, std::min(count[0], 16u));
    std::sort(list.begin(), list.end());
    words.insert(words.end(), count.begin(), count.end());
    words.insert(words.end(), list.begin(), list.end());
    return words;
  }
  void clearOutputs() override {
    for (const host::Buffer* buffer : {&bits_, &list_, &count_}) host::fill(device, *buffer, 0xffffffffu);
  }
  GpgpResult takeReport(GpgpReportHeader& header, bool& meaningful) override {
    GpgpVisibilityReport report = GPGP_VISIBILITY_REPORT_INIT;
    const GpgpResult result = gpgpGetVisibilityReport(recorder, &report);
    header = report.base;
    meaningful = report.visible == kTriangles && report.listed == kTriangles && report.coveredPixels > 0;
    return result;
  }

private:
  host::Buffer positions_, indices_, draws_, bits_, list_, count_;
};
#endif
} // namespace

std::vector<std::string> scenarioNames() {
  std::vector<std::string> names;
#if defined(GPGP_WITH_SPAWN) && defined(GPGP_WITH_COMPILER)
  names.push_back("spawn");
#endif
#if defined(GPGP_WITH_VECTOR)
  names.push_back("vector");
#endif
#if defined(GPGP_WITH_VISIBILITY)
  names.push_back("visibility");
#endif
  return names;
}

std::unique_ptr<Scenario> makeScenario(const std::string& name, host::HeadlessDevice& device) {
#if defined(GPGP_WITH_SPAWN) && defined(GPGP_WITH_COMPILER)
  if (name == "spawn") return std::make_unique<SpawnScenario>(device);
#endif
#if defined(GPGP_WITH_VECTOR)
  if (name == "vector") return std::make_unique<VectorScenario>(device);
#endif
#if defined(GPGP_WITH_VISIBILITY)
  if (name == "visibility") return std::make_unique<VisibilityScenario>(device);
#endif
  throw std::runtime_error("no scenario " + name);
}

} // namespace gpgp::test
