// The tables and figures of the thesis's section 5.4 for this library, as Markdown.
//
// The drawings are the files, and generated ones in place of the thesis's. Times are medians
// of N records (20), by two timestamps around each; passes are timed in records of their own, as timestamps between
// them take time. Nothing about time is asserted; it fails where a record fails or drops paths.
#include "arguments.h"
#include "cli/patch_tiles.h"
#include "cli/vector_truth.h"
#include "vector_runner.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::bench;

constexpr uint32_t kArea = 0; // in place of a number of samples

VectorRunner::Settings settingsOf(uint32_t samples) {
  return {.samples = samples == kArea ? 16 : samples, .exactArea = samples == kArea};
}

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

void times(VectorRunner& runner, const std::vector<Scene>& scenes, const std::vector<uint32_t>& sizes, int repeat) {
  std::printf("\n| drawing | pixels | 1 sample ms | 16 samples | exact area | cairo ms | exact area / cairo |\n"
              "|---|---|---|---|---|---|---|\n");
  std::string shares = "\n| drawing | pixels | samples | share of each pass, % |\n|---|---|---|---|\n";
  for (const Scene& scene : scenes) {
    VectorMade drawing = runner.makeDrawing(scene);
    for (const uint32_t size : sizes) {
      double milliseconds[3];
      size_t column = 0;
      for (const uint32_t samples : {1u, 16u, kArea}) {
        const VectorDrawn t = runner.draw(drawing, scene, size, size, settingsOf(samples), repeat);
        milliseconds[column++] = t.milliseconds;
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
  }
  std::printf("%s", shares.c_str());
}

void quality(VectorRunner& runner) {
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
  VectorMade drawing = runner.makeDrawing(scene);
  std::printf("\n| samples | dB against 256 samples |\n|---|---|\n");
  for (const uint32_t samples : {1u, 4u, 8u, 16u, kArea}) {
    const double value = decibels(runner.draw(drawing, scene, width, height, settingsOf(samples), 1).pixels);
    if (samples == kArea)
      std::printf("| exact area | %.1f |\n", value);
    else
      std::printf("| %u | %.1f |\n", samples, value);
  }
  std::vector<uint8_t> cairo;
  if (cairoTime(scene, width, height, 1, 1, &cairo) > 0) std::printf("| cairo | %.1f |\n", decibels(cairo));
}

void curves(VectorRunner& runner, int repeat, uint32_t largest) {
  std::printf("\n| paths x curves | made ms | us a curve | GPU ms at 1024 | ns a curve |\n|---|---|---|---|---|\n");
  const int counts[][2] = {{10, 16}, {100, 16}, {1000, 16}, {10000, 16}, {100000, 4},
                           {100, 4}, {100, 64}, {100, 256}, {100, 1024}};
  for (const auto& [n, m] : counts) {
    const Scene scene = blobs(n, m);
    VectorMade drawing = runner.makeDrawing(scene);
    const double all = static_cast<double>(n) * m,
                 gpu = runner.draw(drawing, scene, 1024, 1024, {}, repeat).milliseconds;
    std::printf("| %d x %d | %.2f | %.2f | %.3f | %.1f |\n", n, m, drawing.milliseconds,
                drawing.milliseconds * 1e3 / all, gpu, gpu * 1e6 / all);
    std::fflush(stdout);
  }
  std::printf("\n| pixels a side | GPU ms | ns a pixel |\n|---|---|---|\n");
  const Scene scene = clipArt();
  VectorMade drawing = runner.makeDrawing(scene);
  for (uint32_t size = 128; size <= largest; size *= 2) {
    const double gpu = runner.draw(drawing, scene, size, size, {}, repeat).milliseconds;
    std::printf("| %u | %.3f | %.2f |\n", size, gpu, gpu * 1e6 / (static_cast<double>(size) * size));
  }
}

} // namespace

const char* const kUsage =
    "vector_tables [--repeat N] [--sizes PIXELS,...] [statistics | times | quality | curves]... [FILE.svg]...\n"
    "  statistics  table 5.1: paths, curves, patches, and how patches spread over tiles of 8 x 8 pixels at 1024 x "
    "1024\n"
    "  times       table 5.2 and figure 5.11: GPU milliseconds at 1 and 16 samples and with exact areas, cairo's time\n"
    "              in the same process, and how the GPU's time falls to its passes\n"
    "  quality     figure 5.12: a feather at 12 x 14 pixels against 256 samples a pixel, cairo's beside it\n"
    "  curves      cost over the number of paths, of curves in a path, and of pixels\n"
    "Without words all of them.\n";

int runBench(Arguments arguments) {
  int repeat = 20;
  std::vector<uint32_t> sizes;
  std::set<std::string> wanted;
  std::vector<Scene> scenes;
  const std::set<std::string> known = {"statistics", "times", "quality", "curves"};
  while (arguments.next()) {
    const std::string& word = arguments.word();
    if (word == "--repeat") {
      repeat = static_cast<int>(arguments.number());
    } else if (word == "--sizes") {
      const std::string list = arguments.value();
      for (const char* at = list.c_str();; ++at) {
        char* end = nullptr;
        const long size = std::strtol(at, &end, 10);
        if (end == at || (*end && *end != ',') || size < 16 || size > 8192)
          throw Usage("--sizes: '" + list + "' is no list of numbers from 16 to 8192");
        sizes.push_back(static_cast<uint32_t>(size));
        at = end;
        if (!*at) break;
      }
    } else if (known.count(word)) {
      wanted.insert(word);
    } else {
      scenes.push_back(sceneOf(arguments.name()));
    }
  }
  if (sizes.empty()) sizes = {1024, 2048};
  if (wanted.empty()) wanted = known;
  for (Scene (*make)() : {drops, embrace, clipArt, botanical, townPlan, streetMap, contourMap, page})
    scenes.push_back(make());
  if (wanted.count("statistics")) statistics(scenes);
  if (wanted.size() == 1 && wanted.count("statistics")) return 0;
  const uint32_t largest = std::max(*std::max_element(sizes.begin(), sizes.end()), 1024u);
  host::HeadlessDevice device;
  VectorRunner runner(device);
  runner.openCanvas(largest, 1 << 21);
  std::printf("\n%s, medians of %d\n", device.name().c_str(), repeat);
  if (wanted.count("quality")) quality(runner);
  if (wanted.count("curves")) curves(runner, repeat, largest);
  if (wanted.count("times")) times(runner, scenes, sizes, repeat);
  return 0;
}

int main(int argc, char** argv) { return benchMain(argc, argv, kUsage, runBench); }
