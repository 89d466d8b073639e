// The tables and figures of the thesis's section 5.4 for this library, as Markdown.
//
// The drawings are the files, and generated ones in place of the thesis's. Times are medians
// of N records (20), by two timestamps around each; passes are timed in records of their own, as timestamps between
// them take time. Nothing about time is asserted; it fails where a record fails or drops paths.
#include "arguments.h"
#include "cli/vector/patch_tiles.h"
#include "cli/vector/reference.h"
#include "joined_patches.h"
#include "vector/raster/segments.h"
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

std::vector<GpgpPath> pathsOf(const Scene& scene) {
  std::vector<GpgpPath> paths;
  for (const Shape& s : scene.shapes) paths.push_back(s.view());
  return paths;
}

vector::Drawing drawingOf(const Scene& scene) {
  auto drawing = vector::makeDrawing(pathsOf(scene), scene.groups, std::pmr::get_default_resource());
  if (!drawing) {
    std::fprintf(stderr, "%s: %s\n", scene.name.c_str(), drawing.error().text);
    std::exit(1);
  }
  return std::move(*drawing);
}

cli::PatchTiles tilesOf(const Scene& scene, const vector::Drawing& drawing, std::span<const uint32_t> next = {}) {
  const float scale = static_cast<float>(std::min(1024 / scene.width, 1024 / scene.height));
  return cli::countPatchTiles(drawing, {scale, 0, 0, scale, 0, 0}, 1024, 1024, next);
}

void statistics(const std::vector<Scene>& scenes) {
  std::printf(
      "\n| drawing | paths | curves | patches | curves a patch | tile references | patches a tile | curves a patch "
      "in a tile |\n|---|---|---|---|---|---|---|---|\n");
  for (const Scene& scene : scenes) {
    const vector::Drawing drawing = drawingOf(scene);
    const cli::PatchTiles tiles = tilesOf(scene, drawing);
    std::printf("| %s | %zu | %zu | %zu | %.2f | %.0f | %.2f | %.2f |\n", scene.name.c_str(), scene.shapes.size(),
                curvesOf(scene), drawing.patches.size(), tiles.curvesPerPatch, tiles.patchesPerTile * 128 * 128,
                tiles.patchesPerTile, tiles.curvesPerPatchTiled);
  }
}

/// Patches as they are, and joined to up to four and eight curves. A joined one's record has its curves, its box and
/// its path.
void patches(const std::vector<Scene>& scenes) {
  std::printf(
      "\n| drawing | form | patches | curves a patch | tile references | patches a tile | curves a patch in a tile "
      "| curves a tile | bytes | joined ms |\n|---|---|---|---|---|---|---|---|---|---|\n");
  const struct {
    const char* name;
    uint32_t most;
    Beyond beyond;
    size_t bytes;
  } forms[] = {{"slabs", 2, Beyond::Free, sizeof(vector::PatchRecord)},
               {"4, tangents", 4, Beyond::Tangent, 40},
               {"8, tangents", 8, Beyond::Tangent, 56},
               {"4, own rows", 4, Beyond::Free, 40},
               {"8, own rows", 8, Beyond::Free, 56}};
  for (const Scene& scene : scenes) {
    const vector::Drawing drawing = drawingOf(scene);
    const size_t segments = vector::makeOutlines(drawing, std::pmr::get_default_resource()).segments.size();
    for (const auto& form : forms) {
      const auto begin = Clock::now();
      const auto next = form.most > 2 ? joinPatches(drawing, form.most, form.beyond) : std::vector<uint32_t>{};
      const double time = milliseconds(Clock::now() - begin);
      const cli::PatchTiles tiles = tilesOf(scene, drawing, next);
      std::printf("| %s | %s | %zu | %.2f | %.0f | %.2f | %.2f | %.2f | %zu | %.2f |\n", scene.name.c_str(), form.name,
                  tiles.patches, tiles.curvesPerPatch, tiles.patchesPerTile * 128 * 128, tiles.patchesPerTile,
                  tiles.curvesPerPatchTiled, tiles.patchesPerTile * tiles.curvesPerPatchTiled,
                  tiles.patches * form.bytes, time);
    }
    std::printf("| %s | outlines | %zu segments | | | | | | %zu | |\n", scene.name.c_str(), segments,
                segments * sizeof(shader::SegmentRecord));
    std::fflush(stdout);
  }
}

/// How far the table's curves of a circle lie from it, at most.
double offCircle(const vector::Drawing& drawing, double radius) {
  double off = 0;
  for (const vector::CurveRecord& c : drawing.curves) {
    const auto at = [](double t, float start, float a, float b, float end) {
      const double s = 1 - t;
      return static_cast<double>(start) + 3 * s * s * t * static_cast<double>(a) +
             3 * s * t * t * static_cast<double>(b) + t * t * t * static_cast<double>(end);
    };
    for (int k = 0; k <= 100; ++k)
      off = std::max(off, std::abs(std::hypot(at(k / 100.0, c.ends.x, c.controls.x, c.controls.z, c.ends.z),
                                              at(k / 100.0, c.ends.y, c.controls.y, c.controls.w, c.ends.w)) -
                                   radius));
  }
  return off;
}

/// What arcs cost as cubics, against as few as a primitive of their own would be: a curve for each quarter of a circle.
void arcs(VectorRunner& runner, const std::vector<std::string>& words, int repeat) {
  std::printf("\n| radius, pixels | curves of a circle | off by, pixels | shown 16 times as large | off by 1/32 when "
              "enlarged |\n|---|---|---|---|---|\n");
  for (const double radius : {4.0, 12.0, 40.0, 200.0, 1000.0, 4000.0}) {
    Scene scene;
    Shape shape;
    shape.add(GPGP_PATH_MOVE, {radius, 0});
    shape.add(GPGP_PATH_ARC, {radius, radius, 0, GPGP_ARC_SWEEP, -radius, 0});
    shape.add(GPGP_PATH_ARC, {radius, radius, 0, GPGP_ARC_SWEEP, radius, 0});
    scene.shapes.push_back(shape);
    const vector::Drawing drawing = drawingOf(scene);
    const double off = offCircle(drawing, radius);
    std::printf("| %g | %zu | %.2g | %.2g | %.0f times |\n", radius, drawing.curves.size(), off, 16 * off,
                1 / (32 * off));
  }
  std::printf("\n| drawing | arcs | curves | patches | segments | baked bytes | converted ms | GPU ms at 1024 |\n"
              "|---|---|---|---|---|---|---|---|\n");
  for (const std::string& word : words) {
    constexpr double kFew = 1e9;
    const Scene scenes[2] = {sceneOf(word), sceneOf(word, kFew)};
    double convert[2] = {1e30, 1e30}, gpu[2] = {1e30, 1e30};
    VectorMade made[2] = {runner.makeDrawing(scenes[0]), runner.makeDrawing(scenes[1])};
    for (int i = 0; i < 5 * repeat; ++i)
      for (size_t k = 0; k < 2; ++k) {
        const auto paths = pathsOf(scenes[k]);
        const auto begin = Clock::now();
        const auto drawing = vector::makeDrawing(paths, scenes[k].groups, std::pmr::get_default_resource());
        vector::makeOutlines(*drawing, std::pmr::get_default_resource());
        convert[k] = std::min(convert[k], milliseconds(Clock::now() - begin));
      }
    for (int i = 0; i < 3; ++i)
      for (size_t k = 0; k < 2; ++k)
        gpu[k] = std::min(gpu[k], runner.draw(made[k], scenes[k], 1024, 1024, {}, repeat).milliseconds);
    for (size_t k = 0; k < 2; ++k) {
      const vector::Drawing drawing = drawingOf(scenes[k]);
      const auto outlines = vector::makeOutlines(drawing, std::pmr::get_default_resource());
      std::printf("| %s | %s | %zu | %zu | %zu | %zu | %.3f | %.4f |\n", scenes[k].name.c_str(),
                  k ? "a curve a quarter" : "within 1e-4", drawing.curves.size(), drawing.patches.size(),
                  outlines.segments.size(), vector::bake(drawing, std::pmr::get_default_resource()).size(), convert[k],
                  gpu[k]);
    }
    std::fflush(stdout);
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
  const std::vector<GpgpPath> paths = pathsOf(scene);
  const float transform[6] = {1, 0, 0, 1, 0, 0}, white[4] = {1, 1, 1, 1};
  const uint32_t width = 12, height = 14;
  const auto reference = cli::vectorReference(paths, {}, transform, white, width, height, cli::Blend::Srgb);
  const auto decibels = [&](const std::vector<uint8_t>& bytes) {
    std::vector<float> values(bytes.size());
    for (size_t i = 0; i < bytes.size(); ++i) values[i] = i % 4 == 3 ? 1 : static_cast<float>(bytes[i]) / 255;
    return cli::psnrOverWhite(values, reference, cli::Blend::Srgb);
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
    "vector_tables [--repeat N] [--sizes PIXELS,...] [statistics | patches | times | quality | curves | arcs]... "
    "[FILE.svg]...\n"
    "  statistics  table 5.1: paths, curves, patches, and how patches spread over tiles of 8 x 8 pixels at 1024 x "
    "1024\n"
    "  patches     the same for patches joined to up to four and eight curves\n"
    "  times       table 5.2 and figure 5.11: GPU milliseconds at 1 and 16 samples and with exact areas, cairo's time\n"
    "              in the same process, and how the GPU's time falls to its passes\n"
    "  quality     figure 5.12: a feather at 12 x 14 pixels against 256 samples a pixel, cairo's beside it\n"
    "  curves      cost over the number of paths, of curves in a path, and of pixels\n"
    "  arcs        circular arcs as cubics: how exact, and what they cost against a curve a quarter of a circle, of "
    "the\n"
    "              files and of a screen of an application\n"
    "Without words all of them.\n";

int runBench(Arguments arguments) {
  int repeat = 20;
  std::vector<uint32_t> sizes;
  std::set<std::string> wanted;
  std::vector<std::string> files;
  const std::set<std::string> known = {"statistics", "patches", "times", "quality", "curves", "arcs"};
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
      files.push_back(arguments.name());
    }
  }
  if (sizes.empty()) sizes = {1024, 2048};
  if (wanted.empty()) wanted = known;
  std::vector<Scene> scenes;
  scenes.reserve(files.size() + 8);
  for (const std::string& file : files) scenes.push_back(sceneOf(file));
  for (Scene (*make)() : {drops, embrace, clipArt, botanical, townPlan, streetMap, contourMap, page})
    scenes.push_back(make());
  if (wanted.count("statistics")) statistics(scenes);
  if (wanted.count("patches")) patches(scenes);
  if (wanted.size() == wanted.count("statistics") + wanted.count("patches")) return 0;
  const uint32_t largest = std::max(*std::max_element(sizes.begin(), sizes.end()), 1024u);
  host::HeadlessDevice device;
  VectorRunner runner(device);
  runner.openCanvas(largest, 1 << 21);
  std::printf("\n%s, medians of %d\n", device.name().c_str(), repeat);
  if (wanted.count("quality")) quality(runner);
  if (wanted.count("curves")) curves(runner, repeat, largest);
  if (wanted.count("arcs")) {
    files.push_back("panels");
    arcs(runner, files, repeat);
  }
  if (wanted.count("times")) times(runner, scenes, sizes, repeat);
  return 0;
}

int main(int argc, char** argv) { return benchMain(argc, argv, kUsage, runBench); }
