// The tables and figures of the thesis's section 5.4 for this library, as Markdown.
//
//   vector_tables [--repeat N] [--sizes PIXELS,...] [statistics | times | quality | curves]... [FILE.svg]...
//
//   statistics  table 5.1: paths, curves, patches, and how patches spread over tiles of 8 x 8 pixels at 1024 x 1024
//   times       table 5.2 and figure 5.11: GPU milliseconds at 1 and 16 samples and with exact areas, cairo's time in
//   the
//               same process, and how the GPU's time falls to its passes
//   quality     figure 5.12: a feather at 12 x 14 pixels against 256 samples a pixel, cairo's beside it
//   curves      cost over the number of paths, of curves in a path, and of pixels
//
// Without words all of them. The drawings are the files, and generated ones in place of the thesis's. Times are medians
// of N records (20), by two timestamps around each; passes are timed in records of their own, as timestamps between
// them take time. Nothing about time is asserted; it fails where a record fails or drops paths.
#include "cli/patch_tiles.h"
#include "cli/vector_truth.h"
#include "host/busy_work.h"
#include "host/memory.h"
#include "vector_scenes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::bench;
using Clock = std::chrono::steady_clock;

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}
void expect(GpgpResult result, const char* what) {
  if (result == GPGP_SUCCESS) return;
  std::fprintf(stderr, "%s: %s\n", what, gpgpResultString(result));
  std::exit(1);
}

constexpr uint32_t kArea = 0; // in place of a number of samples

struct Times {
  double total = 0;
  std::map<std::string, double> passes;
  std::vector<uint8_t> pixels; // RGBA, sRGB over white
};

class Bench {
public:
  explicit Bench(uint32_t largest) : busy_(device_) {
    GpgpContextCreateInfo info = device_.contextCreateInfo();
    info.uploadRingBytes = 128 << 20;
    info.messageFn = [](void*, const GpgpMessage* m) { std::fprintf(stderr, "%s\n", m->text); };
    expect(gpgpCreateContext(&info, &context_), "gpgpCreateContext");
    GpgpCanvasCreateInfo canvas = GPGP_CANVAS_CREATE_INFO_INIT;
    canvas.base = {"tables", device_.graphics().family, 0, VK_FALSE};
    canvas.maxWidth = canvas.maxHeight = largest;
    canvas.maxPatches = 1 << 21;
    canvas.maxTileEntries = 1 << 19;
    expect(gpgpCreateCanvas(context_, &canvas, &canvas_), "gpgpCreateCanvas");
    const GpgpPrewarmInfo prewarm = GPGP_PREWARM_INFO_INIT;
    expect(gpgpPrewarm(canvas_, &prewarm), "gpgpPrewarm");
    uint32_t passes = 0;
    expect(gpgpGetPasses(canvas_, &passes, nullptr), "gpgpGetPasses");
    names_.resize(passes);
    expect(gpgpGetPasses(canvas_, &passes, names_.data()), "gpgpGetPasses");
    const VkQueryPoolCreateInfo query{
        VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, nullptr, 0, VK_QUERY_TYPE_TIMESTAMP, passes + 3, 0};
    host::check(device_.vk().vkCreateQueryPool(device_.device(), &query, nullptr, &queries_), "vkCreateQueryPool");
  }
  ~Bench() {
    device_.waitIdle();
    device_.vk().vkDestroyQueryPool(device_.device(), queries_, nullptr);
    gpgpDestroyContext(context_);
  }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  std::string name() const { return device_.name(); }

  GpgpAsset make(const Scene& scene, double* milliseconds = nullptr) {
    std::vector<GpgpPath> paths;
    for (const Shape& s : scene.shapes) paths.push_back(s.view());
    GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
    info.paths = paths.data();
    info.pathCount = static_cast<uint32_t>(paths.size());
    info.groups = scene.groups.data();
    info.groupCount = static_cast<uint32_t>(scene.groups.size());
    GpgpAsset drawing = nullptr;
    const auto begin = Clock::now();
    expect(gpgpCreateDrawing(context_, &info, &drawing), "gpgpCreateDrawing");
    if (milliseconds) *milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    return drawing;
  }

  Times draw(GpgpAsset drawing, const Scene& scene, uint32_t width, uint32_t height, uint32_t samples, int repeat) {
    const host::Image target(device_, {.width = width, .height = height}, "picture");
    const uint32_t passes = static_cast<uint32_t>(names_.size());
    const float scale = static_cast<float>(std::min(width / scene.width, height / scene.height));
    GpgpCanvasItem item{};
    item.drawing = drawing;
    item.transform[0] = item.transform[3] = scale;
    item.opacity = 1;
    const VolkDeviceTable& vk = device_.vk();
    const double period = static_cast<double>(device_.properties().limits.timestampPeriod) * 1e-6;
    std::vector<double> totals;
    std::vector<std::vector<double>> each(passes);
    busy_.warmUp();                            // converting may have taken seconds
    for (int i = 0; i < 2 * repeat + 2; ++i) { // records timed as a whole and by pass, in turn
      const bool split = i % 2 == 0;
      frame_ += 2;
      const GpgpFrame frame{frame_ - 1, frame_ - 2}, done{frame_, frame_ - 1};
      expect(gpgpAdvance(context_, &frame), "gpgpAdvance");
      device_.submitAndWait([&](VkCommandBuffer cmd) {
        expect(gpgpRecordUpload(context_, cmd, &frame, 0, nullptr), "gpgpRecordUpload");
        busy_.record(cmd);
        vk.vkCmdResetQueryPool(cmd, queries_, 0, passes + 3);
        GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
        if (split) info.base.timestamps = {queries_, 0, passes + 1};
        info.width = width;
        info.height = height;
        info.items = &item;
        info.itemCount = 1;
        info.samples = samples == kArea ? 16 : samples;
        info.exactArea = samples == kArea;
        std::fill_n(info.background, 4, 1.0f);
        info.target = target.target(
            {}, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL});
        info.encodeSrgb = info.blendSrgb = VK_TRUE;
        vk.vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_, passes + 1);
        expect(gpgpRecordPrepareCanvas(canvas_, cmd, &frame, &info), "gpgpRecordPrepareCanvas");
        vk.vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_, passes + 2);
      });
      expect(gpgpAdvance(context_, &done), "gpgpAdvance");
      GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
      expect(gpgpGetCanvasReport(canvas_, &report), "gpgpGetCanvasReport");
      if (report.pathsDropped) {
        std::fprintf(stderr, "%s: %u paths dropped, %u entries needed\n", scene.name.c_str(), report.pathsDropped,
                     report.tileEntries);
        std::exit(1);
      }
      const uint32_t count = split ? passes + 1 : 2;
      std::vector<uint64_t> times(count);
      host::check(vk.vkGetQueryPoolResults(device_.device(), queries_, split ? 0 : passes + 1, count, count * 8,
                                           times.data(), 8, VK_QUERY_RESULT_64_BIT),
                  "vkGetQueryPoolResults");
      if (i < 2) continue;
      if (!split) totals.push_back(static_cast<double>(times[1] - times[0]) * period);
      for (uint32_t k = 0; split && k < passes; ++k)
        each[k].push_back(static_cast<double>(times[k + 1] - times[k]) * period);
    }
    Times result;
    result.total = median(totals);
    for (uint32_t k = 0; k < passes; ++k) result.passes[names_[k]] = median(each[k]);
    result.pixels = host::downloadImage(device_, target, VK_IMAGE_LAYOUT_GENERAL);
    return result;
  }

  void destroy(GpgpAsset drawing) { gpgpDestroyAsset(drawing); }

private:
  host::HeadlessDevice device_;
  host::BusyWork busy_;
  GpgpContext context_ = nullptr;
  GpgpWorker canvas_ = nullptr;
  std::vector<const char*> names_;
  VkQueryPool queries_ = VK_NULL_HANDLE;
  uint64_t frame_ = 0;
};

void statistics(const std::vector<Scene>& scenes) {
  std::printf(
      "\n| drawing | paths | curves | patches | curves a patch | tile references | patches a tile | curves a patch "
      "in a tile |\n|---|---|---|---|---|---|---|---|\n");
  for (const Scene& scene : scenes) {
    std::vector<GpgpPath> paths;
    for (const Shape& s : scene.shapes) paths.push_back(s.view());
    const auto drawing = vector::makeDrawing(paths, scene.groups, std::pmr::get_default_resource());
    if (!drawing) {
      std::fprintf(stderr, "%s: %s\n", scene.name.c_str(), drawing.error().text);
      std::exit(1);
    }
    const float scale = static_cast<float>(std::min(1024 / scene.width, 1024 / scene.height));
    const float transform[6] = {scale, 0, 0, scale, 0, 0};
    const cli::PatchTiles tiles = cli::countPatchTiles(*drawing, transform, 1024, 1024);
    std::printf("| %s | %zu | %zu | %zu | %.2f | %.0f | %.2f | %.2f |\n", scene.name.c_str(), paths.size(),
                curvesOf(scene), drawing->patches.size(), tiles.curvesPerPatch, tiles.patchesPerTile * 128 * 128,
                tiles.patchesPerTile, tiles.curvesPerPatchTiled);
  }
}

void times(Bench& bench, const std::vector<Scene>& scenes, const std::vector<uint32_t>& sizes, int repeat) {
  std::printf("\n| drawing | pixels | 1 sample ms | 16 samples | exact area | cairo ms | exact area / cairo |\n"
              "|---|---|---|---|---|---|---|\n");
  std::string shares = "\n| drawing | pixels | samples | share of each pass, % |\n|---|---|---|---|\n";
  for (const Scene& scene : scenes) {
    const GpgpAsset drawing = bench.make(scene);
    for (const uint32_t size : sizes) {
      double milliseconds[3];
      size_t column = 0;
      for (const uint32_t samples : {1u, 16u, kArea}) {
        const Times t = bench.draw(drawing, scene, size, size, samples, repeat);
        milliseconds[column++] = t.total;
        if (samples == kArea) continue;
        double sum = 0;
        for (const auto& [name, time] : t.passes) sum += time;
        char text[160];
        std::snprintf(text, sizeof text, "| %s | %u | %u |", scene.name.c_str(), size, samples);
        shares += text;
        std::map<std::string, double> kinds; // variants of a pass that did not run take next to nothing
        for (const auto& [name, time] : t.passes) {
          std::string kind = name.substr(0, name.find(','));
          if (kind.rfind("raster", 0) == 0) kind = "raster";
          if (kind.rfind("crowded", 0) == 0) kind = "crowded";
          if (kind.rfind("solid", 0) == 0) kind = "solid tiles";
          kinds[kind] += time;
        }
        for (const auto& [kind, time] : kinds) {
          if (time < 0.01 * sum) continue;
          std::snprintf(text, sizeof text, " %s %.0f", kind.c_str(), 100 * time / sum);
          shares += text;
        }
        shares += " |\n";
      }
      const double cairo =
          cairoTime(scene, size, size, std::min(repeat, 3), std::min(size / scene.width, size / scene.height));
      std::printf("| %s | %u | %.3f | %.3f | %.3f |", scene.name.c_str(), size, milliseconds[0], milliseconds[1],
                  milliseconds[2]);
      if (cairo > 0)
        std::printf(" %.1f | %.3f |\n", cairo, milliseconds[2] / cairo);
      else
        std::printf(" | |\n");
      std::fflush(stdout);
    }
    bench.destroy(drawing);
  }
  std::printf("%s", shares.c_str());
}

void quality(Bench& bench) {
  const Scene scene = feather();
  std::vector<GpgpPath> paths;
  for (const Shape& s : scene.shapes) paths.push_back(s.view());
  const float transform[6] = {1, 0, 0, 1, 0, 0}, white[4] = {1, 1, 1, 1};
  const uint32_t width = 12, height = 14;
  const auto truth = cli::vectorTruth(paths, {}, transform, white, width, height, cli::Blend::Srgb);
  const auto decibels = [&](const std::vector<uint8_t>& bytes) {
    std::vector<float> values(bytes.size());
    for (size_t i = 0; i < bytes.size(); ++i) values[i] = i % 4 == 3 ? 1 : static_cast<float>(bytes[i]) / 255;
    return cli::psnrOverWhite(values, truth, cli::Blend::Srgb);
  };
  const GpgpAsset drawing = bench.make(scene);
  std::printf("\n| samples | dB against 256 samples |\n|---|---|\n");
  for (const uint32_t samples : {1u, 4u, 8u, 16u, kArea}) {
    const double value = decibels(bench.draw(drawing, scene, width, height, samples, 1).pixels);
    if (samples == kArea)
      std::printf("| exact area | %.1f |\n", value);
    else
      std::printf("| %u | %.1f |\n", samples, value);
  }
  std::vector<uint8_t> cairo;
  if (cairoTime(scene, width, height, 1, 1, &cairo) > 0) std::printf("| cairo | %.1f |\n", decibels(cairo));
  bench.destroy(drawing);
}

void curves(Bench& bench, int repeat, uint32_t largest) {
  std::printf("\n| paths x curves | made ms | us a curve | GPU ms at 1024 | ns a curve |\n|---|---|---|---|---|\n");
  const int counts[][2] = {{10, 16}, {100, 16}, {1000, 16}, {10000, 16}, {100000, 4},
                           {100, 4}, {100, 64}, {100, 256}, {100, 1024}};
  for (const auto& [n, m] : counts) {
    const Scene scene = blobs(n, m);
    double made = 0;
    const GpgpAsset drawing = bench.make(scene, &made);
    const double all = static_cast<double>(n) * m, gpu = bench.draw(drawing, scene, 1024, 1024, kArea, repeat).total;
    std::printf("| %d x %d | %.2f | %.2f | %.3f | %.1f |\n", n, m, made, made * 1e3 / all, gpu, gpu * 1e6 / all);
    std::fflush(stdout);
    bench.destroy(drawing);
  }
  std::printf("\n| pixels a side | GPU ms | ns a pixel |\n|---|---|---|\n");
  const Scene scene = clipArt();
  const GpgpAsset drawing = bench.make(scene);
  for (uint32_t size = 128; size <= largest; size *= 2) {
    const double gpu = bench.draw(drawing, scene, size, size, kArea, repeat).total;
    std::printf("| %u | %.3f | %.2f |\n", size, gpu, gpu * 1e6 / (static_cast<double>(size) * size));
  }
  bench.destroy(drawing);
}

} // namespace

int main(int argc, char** argv) {
  int repeat = 20;
  std::vector<uint32_t> sizes;
  std::set<std::string> wanted;
  std::vector<Scene> scenes;
  const std::set<std::string> known = {"statistics", "times", "quality", "curves"};
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--repeat" && i + 1 < argc) {
      repeat = std::max(1, std::atoi(argv[++i]));
    } else if (word == "--sizes" && i + 1 < argc) {
      for (const char* at = argv[++i]; *at;) {
        char* end = nullptr;
        sizes.push_back(static_cast<uint32_t>(std::clamp(std::strtol(at, &end, 10), 16l, 8192l)));
        if (end == at) break;
        at = *end ? end + 1 : end;
      }
    } else if (known.count(word)) {
      wanted.insert(word);
    } else {
      scenes.push_back(sceneOf(word));
    }
  }
  if (sizes.empty()) sizes = {1024, 2048};
  if (wanted.empty()) wanted = known;
  for (Scene (*make)() : {drops, embrace, clipArt, botanical, townPlan, streetMap, contourMap, page})
    scenes.push_back(make());
  if (wanted.count("statistics")) statistics(scenes);
  if (wanted.size() == 1 && wanted.count("statistics")) return 0;
  const uint32_t largest = std::max(*std::max_element(sizes.begin(), sizes.end()), 1024u);
  Bench bench(largest);
  std::printf("\n%s, medians of %d\n", bench.name().c_str(), repeat);
  if (wanted.count("quality")) quality(bench);
  if (wanted.count("curves")) curves(bench, repeat, largest);
  if (wanted.count("times")) times(bench, scenes, sizes, repeat);
  return 0;
}
