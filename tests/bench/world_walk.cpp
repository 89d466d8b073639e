// A city of 4096 x 4096 metres that streams around somebody who walks or drives through it: blocks within a radius, and
// nearer ones with their rooms, as tiles of samples/world/block.pga. One block and one inside are derived a frame at
// most. Each tile's report is compared with the CPU's derivation, and at the end all that is in the buffers.
#include "arguments.h"
#include "host/busy_work.h"
#include "host/frames.h"
#include "host/memory.h"
#include "measuring.h"

#include <gpgp/evaluator.hpp>
#include <gpgp/tiles.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace {
using namespace gpgp;
using bench::Usage;

const char* const kUsage = R"(usage: world_walk [options]

  --frames N     default 10000
  --speed M      metres a second at 60 frames a second, default 1.5
  --radius M     blocks within are derived, default 256
  --inside M     blocks within have rooms, default 48
  --plot FILE    the cost of each frame as SVG
  --validate     with the validation layer

A table: frames, tiles, GPU time of spawn a frame. Ends with 1 where a tile differs from the CPU's, memory has grown, or
something did not fit.
)";

struct Options {
  uint32_t frames = 10000;
  double speed = 1.5, radius = 256, inside = 48;
  std::string plot;
  bool validate = false;
};

constexpr int kBlocks = 64; // a side
constexpr float kBlock = 64;
constexpr double kFrame = 1.0 / 60, kHysteresis = 32;
constexpr VkBufferUsageFlags kUsed = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

struct Place {
  double x, z;
};
/// Along the streets: east for five blocks, south for three, and so on, from the middle of the city; back at its edge.
class Walker {
public:
  Place at() const { return {x_, z_}; }
  void go(double metres) {
    while (metres > 0) {
      const double step = std::min(metres, left_);
      (alongX_ ? x_ : z_) += step * (alongX_ ? signX_ : signZ_);
      metres -= step;
      left_ -= step;
      if (left_ > 0) continue;
      alongX_ = !alongX_;
      left_ = (alongX_ ? 5 : 3) * double(kBlock);
      if (x_ < 400 || x_ > kBlocks * double(kBlock) - 400) signX_ = x_ < 400 ? 1 : -1;
      if (z_ < 400 || z_ > kBlocks * double(kBlock) - 400) signZ_ = z_ < 400 ? 1 : -1;
    }
  }

private:
  double x_ = kBlocks / 2 * double(kBlock) + 5, z_ = kBlocks / 2 * double(kBlock) + 5;
  double left_ = 5 * double(kBlock), signX_ = 1, signZ_ = 1;
  bool alongX_ = true;
};

GpgpAxiom axiomOf(uint32_t block, uint32_t start) {
  GpgpAxiom axiom{};
  axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1;
  axiom.transform[3] = kBlock * (float(block % kBlocks) + 0.5f);
  axiom.transform[7] = 20;
  axiom.transform[11] = kBlock * (float(block / kBlocks) + 0.5f);
  axiom.size[0] = axiom.size[2] = kBlock;
  axiom.size[1] = 40;
  axiom.seed = block * 2654435761u + 12345;
  axiom.id = block;
  axiom.start = start;
  return axiom;
}

double distanceTo(uint32_t block, const Place& from) {
  const auto beyond = [](double v, uint32_t cell) {
    const double low = double(cell) * double(kBlock), high = low + double(kBlock);
    return v < low ? low - v : v > high ? v - high : 0;
  };
  return std::hypot(beyond(from.x, block % kBlocks), beyond(from.z, block / kBlocks));
}

struct Tile {
  GpgpTile handle = 0;
  uint64_t recorded = 0; ///< in which frame
};

/// Blocks, or their insides.
struct Layer {
  const char* name;
  uint32_t start, capacity, maxTiles;
  double radius;
  host::Buffer instances, draws;
  gpgp::TileSet set;
  std::map<uint32_t, Tile> tiles = {}; ///< by block
  uint64_t derived = 0, freed = 0, most = 0;
};

class World {
public:
  World(const Options& options, host::HeadlessDevice& device)
      : options_(options), device_(device), busy_(device), ring_(device, 3) {
    std::ifstream file(GPGP_BLOCK, std::ios::binary);
    text_.assign(std::istreambuf_iterator<char>(file), {});
    auto source = gpgp::init<GpgpGrammarSource>();
    source.name = "block.pga";
    source.text = text_.data();
    source.size = text_.size();
    source.messageFn = [](void*, const GpgpCompileMessage* m) {
      if (m->severity == GPGP_SEVERITY_ERROR)
        std::fprintf(stderr, "%s:%u:%u: %s\n", m->file, m->line, m->column, m->text);
    };
    if (!device.isSoftware()) source.flags = GPGP_COMPILE_KERNEL;
    auto evaluatorInfo = gpgp::init<GpgpEvaluatorCreateInfo>();
    evaluatorInfo.sources = &source;
    evaluatorInfo.sourceCount = 1;
    evaluator_ = take(gpgp::Evaluator::create(evaluatorInfo), "gpgpCreateEvaluator");
    evaluation_ = take(evaluator_.evaluation(), "gpgpCreateEvaluation");
    GpgpContextCreateInfo info = device.contextCreateInfo();
    info.maxRecordingsPerFrame = 2;
    info.messageFn = [](void*, const GpgpMessage* m) {
      if (m->severity != GPGP_SEVERITY_INFO) std::fprintf(stderr, "%s: %s\n", m->function, m->text);
    };
    context_ = take(gpgp::Context::create(info), "gpgpCreateContext");
    const gpgp::Blob blob = take(gpgp::compileGrammar(source), "gpgpCompileGrammar");
    auto grammarInfo = gpgp::init<GpgpGrammarCreateInfo>();
    grammarInfo.data = blob.data();
    grammarInfo.size = blob.size();
    grammar_ = take(gpgp::Grammar::create(context_, grammarInfo), "gpgpCreateGrammar");
    auto spawnerInfo = gpgp::init<GpgpSpawnerCreateInfo>();
    spawnerInfo.base.queueFamily = device.graphics().family;
    spawnerInfo.maxShapes = spawnerInfo.maxTerminals = 16384;
    spawnerInfo.maxHostAxioms = 1;
    spawner_ = take(gpgp::Spawner::create(context_, spawnerInfo), "gpgpCreateSpawner");
    bench::expect(spawner_.prewarm(), "gpgpPrewarm");
    bench::expect(gpgpPrewarmGrammar(spawner_, grammar_), "gpgpPrewarmGrammar");
    uint32_t terminals = 0;
    bench::expect(grammar_.terminals(terminals, nullptr), "gpgpGetGrammarTerminals");
    buckets_ = terminals;
    stride_ = take(gpgp::tileStride(spawner_, grammar_), "gpgpGetTileStride");
    addLayer("blocks", "Block", options.radius, 4096);
    addLayer("rooms", "Inside", options.inside, 4096);
    VkQueryPoolCreateInfo queries{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
    queries.queryCount = 2 * kSlots;
    host::check(device.vk().vkCreateQueryPool(device.device(), &queries, nullptr, &queries_), "vkCreateQueryPool");
  }
  ~World() {
    device_.waitIdle();
    device_.vk().vkDestroyQueryPool(device_.device(), queries_, nullptr);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  int run() {
    fillUp();
    GpgpMemoryReport before = memory();
    for (Layer& layer : layers_) layer.derived = layer.freed = 0;
    busy_.warmUp();
    for (uint32_t i = 0; i < options_.frames; ++i) {
      walker_.go(options_.speed * kFrame);
      frame(true);
      if (i == options_.frames / 2) before = memory();
    }
    finish();
    const GpgpMemoryReport after = memory();
    for (uint32_t s = 0; s < GPGP_SERVICE_COUNT; ++s)
      if (after.services[s].deviceBytes != before.services[s].deviceBytes ||
          after.services[s].hostBytes > before.services[s].hostBytes)
        wrong("memory has grown");
    compareAll();
    if (!options_.plot.empty()) plot();
    print(after);
    for (const std::string& message : device_.validationMessages()) wrong(message);
    return wrong_ ? 1 : 0;
  }

private:
  template <class T> static T take(gpgp::Result<T> result, const char* what) {
    bench::expect(result.code(), what);
    return *std::move(result);
  }
  void wrong(const std::string& what) {
    if (++wrong_ <= 10) std::fprintf(stderr, "frame %zu: %s\n", milliseconds_.size(), what.c_str());
  }
  GpgpMemoryReport memory() const {
    GpgpMemoryReport report = GPGP_MEMORY_REPORT_INIT;
    bench::expect(gpgpGetMemoryReport(context_, &report), "gpgpGetMemoryReport");
    return report;
  }

  void addLayer(const char* name, const char* start, double radius, uint32_t capacity) {
    const double reach = 2 * (radius + kHysteresis) / double(kBlock) + 3;
    const uint32_t most = static_cast<uint32_t>(reach * reach);
    Layer& layer =
        layers_.emplace_back(Layer{name, take(grammar_.start(start), start), capacity, most, radius, {}, {}, {}});
    layer.instances = host::Buffer(device_, VkDeviceSize{most} * 2048 * sizeof(GpgpInstance), kUsed);
    layer.draws = host::Buffer(device_, stride_ * most, kUsed);
    host::fill(device_, layer.draws, 0);
    auto info = gpgp::init<GpgpTileSetCreateInfo>();
    info.spawner = spawner_;
    info.grammar = grammar_;
    info.maxTiles = most;
    info.instances = layer.instances.range();
    info.draws = layer.draws.range();
    layer.set = take(gpgp::TileSet::create(context_, info), "gpgpCreateTileSet");
  }

  /// All that is within reach before the walk begins.
  void fillUp() {
    for (;;) {
      frame(false);
      bool all = true;
      for (const Layer& layer : layers_) all = all && missing(layer) == UINT32_MAX;
      if (all) break;
    }
    finish();
    milliseconds_.clear();
  }

  /// The nearest block that is within reach and not there.
  uint32_t missing(const Layer& layer) const {
    const Place from = walker_.at();
    const int reach = static_cast<int>(layer.radius / double(kBlock)) + 2;
    const int midX = static_cast<int>(from.x / double(kBlock)), midZ = static_cast<int>(from.z / double(kBlock));
    uint32_t best = UINT32_MAX;
    double nearest = layer.radius;
    for (int z = std::max(midZ - reach, 0); z <= std::min(midZ + reach, kBlocks - 1); ++z)
      for (int x = std::max(midX - reach, 0); x <= std::min(midX + reach, kBlocks - 1); ++x) {
        const uint32_t block = static_cast<uint32_t>(z * kBlocks + x);
        const double distance = distanceTo(block, from);
        if (distance > nearest || layer.tiles.contains(block)) continue;
        best = block;
        nearest = distance;
      }
    return best;
  }

  void frame(bool measured) {
    const VkCommandBuffer cmd = ring_.begin();
    const GpgpFrame frame = ring_.frame();
    const uint32_t slot = static_cast<uint32_t>(frame.current % kSlots);
    if (slots_[slot].used) readTime(slot);
    bench::expect(gpgpAdvance(context_, &frame), "gpgpAdvance");
    takeReports();
    bench::expect(gpgpRecordUpload(context_, cmd, &frame, 0, nullptr), "gpgpRecordUpload");
    const VolkDeviceTable& vk = device_.vk();
    busy_.record(cmd); // the rest of a game's frame, with which the clocks stay up
    vk.vkCmdResetQueryPool(cmd, queries_, 2 * slot, 2);
    vk.vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_, 2 * slot);
    for (size_t i = 0; i < layers_.size(); ++i) change(cmd, frame, static_cast<uint32_t>(i));
    vk.vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_, 2 * slot + 1);
    slots_[slot] = {true, measured};
    ring_.submit();
  }
  void change(VkCommandBuffer cmd, const GpgpFrame& frame, uint32_t which) {
    Layer& layer = layers_[which];
    for (auto it = layer.tiles.begin(); it != layer.tiles.end();) { // at most one a frame
      if (distanceTo(it->first, walker_.at()) <= layer.radius + kHysteresis || it->second.recorded > frame.safe) {
        ++it;
        continue;
      }
      bench::expect(layer.set.recordFree(cmd, frame, it->second.handle), "gpgpRecordFreeTile");
      ++layer.freed;
      layer.tiles.erase(it);
      break;
    }
    const uint32_t block = missing(layer);
    if (block == UINT32_MAX) return;
    const GpgpAxiom axiom = axiomOf(block, layer.start);
    auto info = gpgp::init<GpgpTileInfo>();
    info.base.tag = uint64_t{which} << 32 | block;
    info.hostAxioms = &axiom;
    info.axiomCount = 1;
    info.capacity = layer.capacity;
    Tile tile;
    tile.recorded = frame.current;
    const GpgpResult result = layer.set.record(cmd, frame, info, tile.handle);
    if (result == GPGP_BUDGET_EXCEEDED) return wrong(std::string(layer.name) + " have no room");
    bench::expect(result, "gpgpRecordTile");
    layer.tiles[block] = tile;
    layer.most = std::max<uint64_t>(layer.most, layer.tiles.size());
    ++layer.derived;
  }

  const GpgpEvaluatedAxiom& evaluated(uint32_t block, uint32_t start, bool countOnly) {
    const GpgpAxiom axiom = axiomOf(block, start);
    auto info = gpgp::init<GpgpEvaluationInfo>();
    info.axioms = &axiom;
    info.axiomCount = 1;
    info.flags = countOnly ? GPGP_EVALUATION_COUNT_ONLY : 0;
    bench::expect(evaluation_.derive(info), "gpgpEvaluate");
    result_ = *evaluation_.result();
    return result_.axioms[0];
  }
  void takeReports() {
    for (;;) {
      const gpgp::Result<GpgpSpawnReport> report = spawner_.report();
      if (report.code() != GPGP_SUCCESS) return;
      Layer& layer = layers_.at(report->base.tag >> 32);
      const uint32_t block = static_cast<uint32_t>(report->base.tag);
      const GpgpEvaluatedAxiom& cpu = evaluated(block, layer.start, true);
      if (report->base.status != GPGP_SUCCESS || report->terminals != cpu.terminals ||
          report->keyHash[0] != cpu.keyHash[0] || report->keyHash[1] != cpu.keyHash[1])
        wrong(std::string(layer.name) + " of block " + std::to_string(block) + " are not the CPU's");
      terminals_ += report->terminals;
      const auto found = layer.tiles.find(block);
      if (found != layer.tiles.end() && found->second.recorded == report->base.frame)
        bench::expect(layer.set.trim(found->second.handle, report->instancesWritten), "gpgpTrimTile");
    }
  }
  void readTime(uint32_t slot) {
    uint64_t ticks[2] = {};
    host::check(device_.vk().vkGetQueryPoolResults(device_.device(), queries_, 2 * slot, 2, sizeof ticks, ticks, 8,
                                                   VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                "vkGetQueryPoolResults");
    const double period = static_cast<double>(device_.properties().limits.timestampPeriod);
    if (slots_[slot].measured) milliseconds_.push_back(static_cast<double>(ticks[1] - ticks[0]) * period * 1e-6);
    slots_[slot].used = false;
  }
  void finish() {
    ring_.waitAll();
    const uint64_t last = ring_.frame().current;
    for (uint64_t f = last + 1 > kSlots ? last + 1 - kSlots : 1; f <= last; ++f) // in order
      if (slots_[f % kSlots].used) readTime(static_cast<uint32_t>(f % kSlots));
    const VkCommandBuffer cmd = ring_.begin();
    (void)cmd;
    const GpgpFrame frame = ring_.frame();
    bench::expect(gpgpAdvance(context_, &frame), "gpgpAdvance");
    takeReports();
    ring_.submit();
    ring_.waitAll();
  }

  /// What the draws show is what the CPU derives of the same blocks, key by key.
  void compareAll() {
    for (Layer& layer : layers_) {
      std::vector<char> draws(layer.draws.size());
      host::downloadBytes(device_, layer.draws, draws.data(), draws.size());
      std::vector<GpgpInstance> instances(layer.instances.size() / sizeof(GpgpInstance));
      host::downloadBytes(device_, layer.instances, instances.data(), instances.size() * sizeof(GpgpInstance));
      using Keys = std::multiset<std::array<uint32_t, 4>>;
      Keys shown, expected;
      for (uint32_t slot = 0; slot < layer.maxTiles; ++slot)
        for (uint32_t b = 0; b < buckets_; ++b) {
          VkDrawIndexedIndirectCommand draw;
          std::memcpy(&draw, draws.data() + slot * stride_ + b * sizeof draw, sizeof draw);
          for (uint32_t i = 0; i < draw.instanceCount; ++i) {
            const GpgpInstance& instance = instances.at(draw.firstInstance + i);
            shown.insert({instance.axiomId, instance.key[0], instance.key[1], instance.terminal});
          }
        }
      for (const auto& [block, tile] : layer.tiles) {
        const GpgpEvaluatedAxiom& cpu = evaluated(block, layer.start, false);
        for (uint32_t i = 0; i < cpu.instanceCount; ++i) {
          const GpgpInstance& instance = cpu.instances[i];
          expected.insert({instance.axiomId, instance.key[0], instance.key[1], instance.terminal});
        }
      }
      if (shown != expected) wrong(std::string(layer.name) + " in the buffers are not the CPU's");
      shown_[layer.name] = shown.size();
    }
  }

  void print(const GpgpMemoryReport& memory) const {
    std::vector<double> sorted = milliseconds_;
    std::sort(sorted.begin(), sorted.end());
    double sum = 0;
    for (const double ms : sorted) sum += ms;
    const auto share = [&](double part) {
      return sorted.empty() ? 0
                            : sorted[std::min(sorted.size() - 1, static_cast<size_t>(part * double(sorted.size())))];
    };
    const auto above = [&](double limit) {
      return sorted.end() - std::upper_bound(sorted.begin(), sorted.end(), limit);
    };
    std::printf("%s: %u frames at %g m/s\n", device_.name().c_str(), options_.frames, options_.speed);
    for (const Layer& layer : layers_)
      std::printf("  %-7s %llu tiles derived, %llu freed, at most %llu at a time, %zu instances at the end\n",
                  layer.name, static_cast<unsigned long long>(layer.derived),
                  static_cast<unsigned long long>(layer.freed), static_cast<unsigned long long>(layer.most),
                  shown_.at(layer.name));
    std::printf("  spawn, GPU ms a frame: mean %.4f, median %.4f, 99 %% %.4f, most %.4f; %td frames above 0.5 ms, %td "
                "above 1, %td above 2\n",
                sum / std::max<double>(double(sorted.size()), 1), share(0.5), share(0.99),
                sorted.empty() ? 0 : sorted.back(), above(0.5), above(1), above(2));
    std::printf("  gpgp holds %.1f MiB on the device; %llu terminals derived; %zu faults\n",
                double(memory.services[GPGP_SERVICE_SPAWN].deviceBytes) / 1048576,
                static_cast<unsigned long long>(terminals_), wrong_);
  }
  /// A point for the dearest of some frames each.
  void plot() const {
    constexpr double kWidth = 900, kHeight = 240, kEdge = 44;
    double most = 0.1;
    for (const double ms : milliseconds_) most = std::max(most, ms);
    const size_t group = std::max<size_t>(1, milliseconds_.size() / 800);
    std::ofstream svg(options_.plot);
    svg << "<svg xmlns='http://www.w3.org/2000/svg' width='" << kWidth << "' height='" << kHeight
        << "' font-family='sans-serif' font-size='11'><rect width='100%' height='100%' fill='white'/><text x='" << kEdge
        << "' y='16'>" << device_.name() << ", " << options_.speed << " m/s: spawn, ms of each frame (the most of "
        << group << ")</text>\n";
    const auto y = [&](double ms) { return kHeight - 28 - ms / most * (kHeight - 60); };
    for (const double ms : {0.0, most / 2, most})
      svg << "<path d='M" << kEdge << ' ' << y(ms) << 'H' << kWidth - 10 << "' stroke='#ccc'/><text x='4' y='"
          << y(ms) + 4 << "'>" << std::round(ms * 1000) / 1000 << "</text>\n";
    svg << "<path fill='none' stroke='#1b6ca8' d='";
    for (size_t i = 0; i < milliseconds_.size(); i += group) {
      const double ms =
          *std::max_element(milliseconds_.begin() + static_cast<ptrdiff_t>(i),
                            milliseconds_.begin() + static_cast<ptrdiff_t>(std::min(i + group, milliseconds_.size())));
      svg << (i ? 'L' : 'M') << kEdge + double(i) / double(milliseconds_.size()) * (kWidth - kEdge - 10) << ' '
          << y(ms);
    }
    svg << "'/>\n<text x='" << kWidth - 10 << "' y='" << kHeight - 8 << "' text-anchor='end'>" << milliseconds_.size()
        << " frames</text></svg>\n";
    if (!svg.flush()) throw std::runtime_error(options_.plot + " cannot be written");
  }

  static constexpr uint32_t kSlots = 8; // more than frames in flight
  struct Slot {
    bool used = false, measured = false;
  };
  const Options options_;
  host::HeadlessDevice& device_;
  host::BusyWork busy_;
  host::FrameRing ring_;
  std::string text_;
  gpgp::Evaluator evaluator_;
  gpgp::Evaluation evaluation_;
  GpgpEvaluationResult result_ = GPGP_EVALUATION_RESULT_INIT;
  gpgp::Context context_;
  gpgp::Grammar grammar_;
  gpgp::Spawner spawner_;
  std::vector<Layer> layers_;
  std::map<std::string, size_t> shown_;
  Walker walker_;
  VkQueryPool queries_ = VK_NULL_HANDLE;
  Slot slots_[kSlots] = {};
  std::vector<double> milliseconds_;
  uint32_t buckets_ = 0;
  VkDeviceSize stride_ = 0;
  uint64_t terminals_ = 0;
  size_t wrong_ = 0;
};

int run(bench::Arguments arguments) {
  Options options;
  while (arguments.next()) {
    const std::string& word = arguments.word();
    if (word == "--frames")
      options.frames = arguments.number();
    else if (word == "--speed")
      options.speed = arguments.real(0.1, 100);
    else if (word == "--radius")
      options.radius = arguments.real(32, 1000);
    else if (word == "--inside")
      options.inside = arguments.real(0, 500);
    else if (word == "--plot")
      options.plot = arguments.value();
    else if (word == "--validate")
      options.validate = true;
    else
      throw Usage("'" + word + "' is no option");
  }
  host::HeadlessDevice device(host::DeviceOptions{.validation = options.validate});
  return World(options, device).run();
}
} // namespace

int main(int argc, char** argv) { return bench::benchMain(argc, argv, kUsage, run); }
