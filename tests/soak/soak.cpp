// A game's life, faster: tiles come, are derived anew, move and go; texts, lists and drawings change; cameras jump;
// canvases change their size; grammars are reloaded; command buffers are dropped; and device memory is capped, so that
// some creations are refused. Host and device memory are sampled, and neither may grow.
//
//   soak [--frames 2000] [--seed 1] [--plain] [--csv FILE]
//
// --plain: without the validation layer, for long runs. Ends with 1 where memory grew, a picture changed that should
// not, a call failed that should not, or a validation message came.
#include "api/aligned.h"
#include "api/counting_new.h"
#include "api/scenarios.h"
#include "host/frames.h"

#include <gpgp/gpgp.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct Options {
  uint64_t frames = 2000;
  uint32_t seed = 1;
  bool validation = true;
  const char* csv = nullptr;
};

[[noreturn]] void fail(uint64_t frame, const std::string& what) {
  std::fprintf(stderr, "frame %llu: %s\n", static_cast<unsigned long long>(frame), what.c_str());
  std::exit(1);
}

/// The engine's allocators: they count, and the device's is capped.
struct Memory {
  host::HeadlessDevice& device;
  int64_t hostBytes = 0, deviceBytes = 0, cap = INT64_MAX, refused = 0;

  GpgpHostAllocator hostCallbacks() {
    return {this,
            [](void* user, size_t size, size_t alignment) {
              static_cast<Memory*>(user)->hostBytes += static_cast<int64_t>(size);
              return allocateAligned(size, alignment);
            },
            [](void* user, void* memory, size_t size, size_t) {
              static_cast<Memory*>(user)->hostBytes -= static_cast<int64_t>(size);
              freeAligned(memory);
            }};
  }
  GpgpGpuAllocator gpuCallbacks() {
    return {this,
            [](void* user, const GpgpGpuAllocationRequest* request, GpgpGpuAllocation* allocation) -> VkResult {
              Memory& self = *static_cast<Memory*>(user);
              const int64_t bytes = static_cast<int64_t>(request->requirements.size);
              if (self.deviceBytes + bytes > self.cap) return ++self.refused, VK_ERROR_OUT_OF_DEVICE_MEMORY;
              const VolkDeviceTable& vk = self.device.vk();
              const VkMemoryAllocateInfo info{
                  VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, request->requirements.size,
                  self.device.memoryType(request->requirements.memoryTypeBits, request->required, request->preferred)};
              if (const VkResult r = vk.vkAllocateMemory(self.device.device(), &info, nullptr, &allocation->memory); r)
                return r;
              allocation->mapped = nullptr;
              if (request->required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT)
                vk.vkMapMemory(self.device.device(), allocation->memory, 0, VK_WHOLE_SIZE, 0, &allocation->mapped);
              allocation->userData = new int64_t(bytes);
              self.deviceBytes += bytes;
              return VK_SUCCESS;
            },
            [](void* user, const GpgpGpuAllocation* allocation) {
              Memory& self = *static_cast<Memory*>(user);
              const std::unique_ptr<int64_t> bytes(static_cast<int64_t*>(allocation->userData));
              self.deviceBytes -= *bytes;
              self.device.vk().vkFreeMemory(self.device.device(), allocation->memory, nullptr);
            }};
  }
};

/// Resident bytes of the process, driver and layers included; 0 where the system does not tell.
int64_t residentBytes() {
  long long pages = 0, resident = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lld %lld", &pages, &resident) != 2) resident = 0;
    std::fclose(file);
  }
  return resident * 4096;
}

constexpr uint32_t kTiles = 12, kSize = 64;
constexpr VkDeviceSize kAxiomStride = 256;
constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

class Soak {
public:
  Soak(const Options& options, host::HeadlessDevice& device)
      : options_(options), device_(device), memory_{device}, random_(options.seed),
        axioms_(device, kAxiomStride * kTiles * 4, kUsage, host::Memory::host),
        instances_(device, sizeof(GpgpInstance) * 1024, kUsage), draws_(device, 16384, kUsage), ring_(device, 3) {
    GpgpContextCreateInfo info = scenarioContextInfo(device, &messages_);
    const GpgpHostAllocator host = memory_.hostCallbacks();
    const GpgpGpuAllocator gpu = memory_.gpuCallbacks();
    info.hostAllocator = &host;
    info.gpuAllocator = &gpu;
    info.maxRecordingsPerFrame = 4;
    check(gpgpCreateContext(&info, &context_), "gpgpCreateContext");
    host::fill(device_, draws_, 0);
    for (const std::string& name : scenarioNames()) {
      auto made = makeScenario(name, device);
      check(made->createAsset(context_), "createAsset");
      check(made->createRecorder(context_, {name.c_str(), device.graphics().family, 0, VK_FALSE}), "createRecorder");
      check(made->createView(context_), "createView");
      check(made->prewarm(), "prewarm");
      scenarios_.push_back(std::move(made));
    }
    spawn_ = find("spawn");
    vector_ = find("vector");
    visibility_ = find("visibility");
    GpgpGlyphSetCreateInfo glyphs = GPGP_GLYPH_SET_CREATE_INFO_INIT;
    glyphs.maxGlyphs = 24;
    glyphs.maxBytes = 16384;
    check(gpgpCreateGlyphSet(context_, &glyphs, &glyphSet_), "gpgpCreateGlyphSet");
    reload();
    memory_.cap = memory_.deviceBytes + (int64_t(6) << 20);
  }

  int run() {
    const uint64_t every = std::max<uint64_t>(options_.frames / 200, 1);
    std::FILE* csv = options_.csv ? std::fopen(options_.csv, "w") : nullptr;
    if (csv) std::fprintf(csv, "frame,host bytes,device bytes,resident bytes,blocks of operator new\n");
    for (number_ = 1; number_ <= options_.frames; ++number_) {
      frame();
      if (!messages_.empty()) fail(number_, messages_.front());
      if (number_ % 64 == 0)
        for (const std::string& message : device_.takeValidationMessages()) fail(number_, message);
      hostMost_[half()] = std::max(hostMost_[half()], memory_.hostBytes);
      deviceMost_[half()] = std::max(deviceMost_[half()], memory_.deviceBytes);
      if (number_ % every) continue;
      const int64_t resident = residentBytes();
      if (number_ > options_.frames / 10) residentMost_[half()] = std::max(residentMost_[half()], resident);
      if (csv)
        std::fprintf(csv, "%llu,%lld,%lld,%lld,%lld\n", static_cast<unsigned long long>(number_),
                     static_cast<long long>(memory_.hostBytes), static_cast<long long>(memory_.deviceBytes),
                     static_cast<long long>(resident), static_cast<long long>(livingNews()));
    }
    if (csv) std::fclose(csv);
    ring_.waitAll();
    expectUnchanged();
    gpgpDestroyContext(context_);
    for (const std::string& message : device_.takeValidationMessages()) fail(number_, message);
    std::printf("%llu frames: %llu tiles derived, %llu freed, %llu glyphs added, %llu edits, %llu reloads, %llu sizes, "
                "%llu drops, %lld allocations refused\n",
                static_cast<unsigned long long>(options_.frames), count(derived_), count(freed_), count(glyphsAdded_),
                count(edits_), count(reloads_), count(sizes_), count(drops_), static_cast<long long>(memory_.refused));
    std::printf("most memory, first and second half, KiB: host %lld %lld, device %lld %lld, process %lld %lld\n",
                kib(hostMost_[0]), kib(hostMost_[1]), kib(deviceMost_[0]), kib(deviceMost_[1]), kib(residentMost_[0]),
                kib(residentMost_[1]));
    if (memory_.hostBytes || memory_.deviceBytes) fail(number_, "the context left memory behind");
    if (!derived_ || !freed_ || !glyphsAdded_ || !edits_ || !reloads_ || !sizes_ || !drops_ || !memory_.refused)
      fail(number_, "too few frames: not everything has happened");
    // What lives at a time varies from frame to frame, so that the second half may meet a worse one: by 5 %.
    if (hostMost_[1] > hostMost_[0] + hostMost_[0] / 20) fail(number_, "host memory grew");
    if (deviceMost_[1] > deviceMost_[0] + deviceMost_[0] / 20) fail(number_, "device memory grew");
    // The driver and the layers are the process, too: half a megabyte in a thousand frames is theirs to lose.
    const int64_t theirs = (int64_t(8) << 20) + static_cast<int64_t>(options_.frames) * 512;
    if (residentMost_[1] > residentMost_[0] + theirs) fail(number_, "the process grew");
    return 0;
  }

private:
  static long long kib(int64_t bytes) { return static_cast<long long>(bytes >> 10); }
  static unsigned long long count(uint64_t n) { return n; }
  size_t half() const { return 2 * number_ > options_.frames; }
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(random_() % n); }
  Scenario* find(const char* name) {
    for (const auto& scenario : scenarios_)
      if (std::strcmp(scenario->name(), name) == 0) return scenario.get();
    return nullptr;
  }
  void check(GpgpResult result, const char* what) {
    if (result != GPGP_SUCCESS)
      fail(number_,
           std::string(what) + ": " + gpgpResultString(result) + (messages_.empty() ? "" : ", " + messages_.back()));
  }
  /// Creation under the cap: done, or refused for want of device memory.
  bool made(GpgpResult result, const char* what) {
    if (result == GPGP_SUCCESS) return true;
    if (result != GPGP_ERROR_OUT_OF_DEVICE_MEMORY || messages_.size() != 1) check(result, what);
    messages_.clear();
    return false;
  }

  // ---------------------------------------------------------------- spawn
  /// Another grammar for the tiles: the old one goes, with its tiles.
  void reload() {
    if (!spawn_) return;
    char text[256];
    std::snprintf(text, sizeof text,
                  "axiom Box A; terminal Tower (1, 0); A = SubDiv(X) { %u: B | -1: B }; B = SubDiv(Y) { -1: Tower | "
                  "-1: Tower };",
                  1 + below(3));
    GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
    source.name = "reloaded.pga";
    source.text = text;
    source.size = std::strlen(text);
    GpgpBlob blob{};
    check(gpgpCompileGrammar(&source, &blob), "gpgpCompileGrammar");
    GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
    info.data = blob.data;
    info.size = blob.size;
    GpgpAsset grammar = nullptr;
    const bool good = made(gpgpCreateGrammar(context_, &info, &grammar), "gpgpCreateGrammar");
    gpgpFreeBlob(&blob);
    if (!good) return;
    gpgpDestroyHistory(tileSet_);
    gpgpDestroyAsset(grammar_);
    grammar_ = grammar;
    GpgpTileSetCreateInfo setInfo = GPGP_TILE_SET_CREATE_INFO_INIT;
    setInfo.spawner = spawn_->recorder;
    setInfo.grammar = grammar_;
    setInfo.maxTiles = kTiles;
    setInfo.instances = instances_.range(Scenario::kAfter, Scenario::kAfter);
    setInfo.draws = draws_.range(Scenario::kAfter, Scenario::kAfter);
    check(gpgpCreateTileSet(context_, &setInfo, &tileSet_), "gpgpCreateTileSet");
    std::fill_n(tiles_, kTiles, GpgpTile(0));
    ++reloads_;
  }
  void changeTile(VkCommandBuffer cmd, const GpgpFrame& frame) {
    const uint32_t which = below(kTiles);
    GpgpTile& tile = tiles_[which];
    if (tile && below(3) == 0) {
      check(gpgpRecordFreeTile(tileSet_, cmd, &frame, tile, 0), "gpgpRecordFreeTile");
      tile = 0;
      ++freed_;
      return;
    }
    const uint32_t slot = which * 4 + static_cast<uint32_t>(frame.current % 4); // three frames are in flight
    GpgpAxiom axiom{};
    axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1;
    axiom.size[0] = axiom.size[1] = axiom.size[2] = 8;
    axiom.seed = below(1u << 30);
    axiom.start = GPGP_AXIOM_DEFAULT_START;
    std::memcpy(axioms_.as<char>() + slot * kAxiomStride, &axiom, sizeof axiom);
    GpgpTileInfo info = GPGP_TILE_INFO_INIT;
    info.axioms = axioms_.range(Scenario::kBefore, {}, slot * kAxiomStride, sizeof axiom);
    info.axiomCount = 1;
    info.capacity = 1 + below(12); // sometimes too little, which the report says
    if (below(4) == 0) info.flags = GPGP_TILE_MOVE;
    const GpgpResult result = gpgpRecordTile(tileSet_, cmd, &frame, &info, &tile);
    if (result == GPGP_NOT_READY) { // the grammar's upload waits for the ring
      messages_.clear();
      return;
    }
    if (result != GPGP_BUDGET_EXCEEDED) check(result, "gpgpRecordTile");
    derived_ += result == GPGP_SUCCESS;
  }

  // ---------------------------------------------------------------- vector
  static GpgpPath path(const float (&points)[10], float blue) {
    static constexpr GpgpPathVerb kVerbs[] = {GPGP_PATH_MOVE, GPGP_PATH_CUBIC, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
    return {kVerbs, 4, points, 5, GPGP_FILL_NON_ZERO, {1, 0, blue, 0.75f}};
  }
  void changeText() {
    float points[10];
    GpgpPath outline = path(points, 0);
    GpgpGlyph glyphs[6];
    uint32_t indices[6];
    for (float& p : points) p = static_cast<float>(below(64)) / 64;
    for (GpgpGlyph& glyph : glyphs) glyph = {1 + below(200), &outline, 1, nullptr};
    const GpgpResult result = gpgpAddGlyphs(glyphSet_, glyphs, 6, indices);
    if (result != GPGP_BUDGET_EXCEEDED) check(result, "gpgpAddGlyphs");
    for (int i = 0; i < 6; ++i) {
      glyphsAdded_ += indices[i] != GPGP_GLYPH_NONE;
      text_[i] = {indices[i], 9 * static_cast<float>(i), 20, 12, {0, 1, 0, 1}};
    }
  }
  void changeList() {
    GpgpList& list = list_;
    if (!list) {
      const GpgpListCreateInfo info = GPGP_LIST_CREATE_INFO_INIT;
      check(gpgpCreateList(context_, &info, &list), "gpgpCreateList");
    }
    check(gpgpResetList(list), "gpgpResetList");
    const float turn[] = {0.8f, 0.6f, -0.6f, 0.8f, static_cast<float>(below(40)), 0};
    check(gpgpPushTransform(list, turn, nullptr), "gpgpPushTransform");
    GpgpListShape shape{};
    shape.kind = GPGP_LIST_ELLIPSE;
    shape.box[2] = shape.box[3] = static_cast<float>(4 + below(40));
    shape.color[1] = shape.color[3] = 0.5f;
    check(gpgpAddShapes(list, &shape, 1), "gpgpAddShapes");
    check(gpgpAddText(list, glyphSet_, text_, 6, 1), "gpgpAddText");
    if (drawing_) check(gpgpAddDrawing(list, drawing_, 0, 2), "gpgpAddDrawing");
    check(gpgpPopState(list), "gpgpPopState");
  }
  void editDrawing() {
    float points[10];
    for (float& p : points) p = static_cast<float>(below(64));
    GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
    info.editable = VK_TRUE;
    const GpgpPath first[2] = {path(points, 0), path(points, 1)};
    const GpgpPathEdit edit{below(2), path(points, 0.5f)};
    if (drawing_) {
      info.base = drawing_;
      info.edits = &edit;
      info.editCount = 1;
    } else {
      info.paths = first;
      info.pathCount = 2;
    }
    GpgpAsset asset = nullptr;
    if (!made(gpgpCreateDrawing(context_, &info, &asset), "gpgpCreateDrawing")) return;
    gpgpDestroyAsset(drawing_);
    drawing_ = asset;
    ++edits_;
  }
  void changeSize() {
    GpgpCanvasHistoryCreateInfo info = GPGP_CANVAS_HISTORY_CREATE_INFO_INIT;
    info.width = kSize + below(200), info.height = kSize + below(200);
    GpgpHistory history = nullptr;
    if (made(gpgpCreateCanvasHistory(context_, &info, &history), "gpgpCreateCanvasHistory")) {
      gpgpDestroyHistory(vector_->view);
      vector_->view = history;
      ++sizes_;
    }
    info.width = info.height = 4096; // 128 MiB: more than the cap leaves
    history = nullptr;
    if (made(gpgpCreateCanvasHistory(context_, &info, &history), "a history beyond the cap"))
      fail(number_, "the cap was not met");
  }

  // ---------------------------------------------------------------- frames
  void frame() {
    const VkCommandBuffer cmd = ring_.begin();
    const GpgpFrame frame = ring_.frame();
    check(gpgpAdvance(context_, &frame), "gpgpAdvance");
    takeReports();
    if (number_ % 64 == 0) reload();
    if (vector_) {
      if (number_ % 3 == 0) changeText();
      if (number_ % 8 == 0) editDrawing();
      changeList();
      if (number_ % 50 == 0) changeSize();
    }
    if (visibility_ && number_ % 40 == 0) { // the camera jumps: what it remembered is worth nothing
      GpgpHistory old = visibility_->view;
      if (made(visibility_->createView(context_), "createView"))
        gpgpDestroyHistory(old);
      else
        visibility_->view = old;
    }
    check(gpgpRecordUpload(context_, cmd, &frame, 64 << 10, nullptr), "gpgpRecordUpload");
    if (spawn_) changeTile(cmd, frame);
    if (vector_) std::swap(vector_->shownList, list_);
    Scenario* const shown = scenarios_[number_ % scenarios_.size()].get(); // one a frame
    const GpgpResult recorded = shown->record(cmd, frame, {});
    if (recorded == GPGP_NOT_READY)
      messages_.clear();
    else
      check(recorded, shown->name());
    if (vector_) std::swap(vector_->shownList, list_);
    if (number_ % 97 == 0) { // as where a window was resized
      ring_.drop();
      ++drops_;
      if (!messages_.empty()) messages_.clear();
      if (spawn_) dropTiles();
    } else {
      ring_.submit();
    }
    // That an upload or a recording was dropped is a message of the next gpgpAdvance.
    dropped_ = number_ % 97 == 0 ? number_ : dropped_;
  }
  /// What the dropped command buffer would have written is unknown: those tiles are given up with their set.
  void dropTiles() { reload(); }
  void takeReports() {
    if (number_ - dropped_ <= 4 && dropped_) messages_.clear();
    for (const auto& scenario : scenarios_) {
      GpgpReportHeader header{};
      bool meaningful = false;
      while (scenario->takeReport(header, meaningful) == GPGP_SUCCESS)
        if (header.status != GPGP_SUCCESS && header.status != GPGP_NOT_EXECUTED &&
            header.status != GPGP_BUDGET_EXCEEDED)
          fail(number_, std::string(scenario->name()) + " reports " + gpgpResultString(header.status));
    }
  }
  /// The jobs of a fresh program, after all of this: the same results.
  void expectUnchanged() {
    for (const auto& scenario : scenarios_) {
      std::vector<uint32_t> results[2];
      auto other = makeScenario(scenario->name(), device_);
      GpgpContextCreateInfo info = scenarioContextInfo(device_, &messages_);
      GpgpContext fresh = nullptr;
      check(gpgpCreateContext(&info, &fresh), "gpgpCreateContext");
      check(other->createAsset(fresh), "createAsset");
      check(other->createRecorder(fresh, {"fresh", device_.graphics().family, 0, VK_FALSE}), "createRecorder");
      check(other->createView(fresh), "createView");
      check(other->prewarm(), "prewarm");
      const auto once = [&](Scenario& job, GpgpContext context, GpgpFrame frame) {
        check(gpgpAdvance(context, &frame), "gpgpAdvance");
        messages_.clear();
        job.clearOutputs();
        device_.submitAndWait([&](VkCommandBuffer cmd) {
          check(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), "gpgpRecordUpload");
          check(job.record(cmd, frame, {}), job.name());
        });
        return job.results();
      };
      const uint64_t last = ring_.frame().current + (++extra_);
      results[0] = once(*scenario, context_, {last, last - 1});
      results[1] = once(*other, fresh, {1, 0});
      if (results[0] != results[1])
        fail(number_, std::string(scenario->name()) + " has another result than a fresh one");
      gpgpDestroyContext(fresh);
      other->asset = other->secondAsset = nullptr, other->recorder = nullptr, other->view = nullptr;
    }
  }

  const Options options_;
  host::HeadlessDevice& device_;
  Memory memory_;
  std::mt19937 random_;
  std::vector<std::string> messages_;
  GpgpContext context_ = nullptr;
  std::vector<std::unique_ptr<Scenario>> scenarios_;
  Scenario *spawn_ = nullptr, *vector_ = nullptr, *visibility_ = nullptr;
  host::Buffer axioms_, instances_, draws_;
  host::FrameRing ring_;
  GpgpAsset grammar_ = nullptr, glyphSet_ = nullptr, drawing_ = nullptr;
  GpgpHistory tileSet_ = nullptr;
  GpgpList list_ = nullptr;
  GpgpTile tiles_[kTiles] = {};
  GpgpGlyphInstance text_[6] = {};
  uint64_t number_ = 0, extra_ = 0, dropped_ = 0;
  uint64_t derived_ = 0, freed_ = 0, glyphsAdded_ = 0, edits_ = 0, reloads_ = 0, sizes_ = 0, drops_ = 0;
  int64_t hostMost_[2] = {}, deviceMost_[2] = {}, residentMost_[2] = {};
};
} // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    const char* const value = i + 1 < argc ? argv[i + 1] : "";
    if (argument == "--plain")
      options.validation = false;
    else if (argument == "--frames" && ++i < argc)
      options.frames = std::strtoull(value, nullptr, 10);
    else if (argument == "--seed" && ++i < argc)
      options.seed = static_cast<uint32_t>(std::strtoul(value, nullptr, 10));
    else if (argument == "--csv" && ++i < argc)
      options.csv = value;
    else
      return std::fprintf(stderr, "soak: unknown option '%s'\n", argv[i]), 2;
  }
  host::HeadlessDevice device(host::DeviceOptions{.validation = options.validation});
  const int result = Soak(options, device).run();
  device.waitIdle();
  return result;
}
