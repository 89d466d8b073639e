// What drawings cost: conversion on one thread, GPU time by pass, and cairo's time in the same process.
//
// The generated drawings are in vector_scenes.h. Prints medians, or least times, and ratios; asserts nothing about
// time, but fails where a record fails or drops paths.
#include "arguments.h"
#include "host/picture.h"
#include "vector_runner.h"

#include <gpgp/vector.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace {
using namespace gpgp;
using namespace gpgp::bench;

struct Size {
  uint32_t width, height;
};

void run(VectorRunner& runner, const Scene& scene, Size size, VectorRunner::Settings settings, int repeat,
         const std::string& out, bool shapes, bool keep) {
  const auto [width, height] = size;
  VectorMade made = scene.glyphs.empty() || shapes ? runner.makeDrawing(scene) : runner.makeText(scene);
  const GpgpDrawingInfo& facts = made.facts;
  runner.openCanvas(std::max(width, height), std::max(facts.patches, 1024u), made.item.glyphCount);
  const VectorDrawn drawn = runner.draw(made, scene, width, height, settings, repeat);
  std::vector<uint8_t> cairoPixels;
  const double scale = std::min(width / scene.width, height / scene.height);
  const double cairo = cairoTime(scene, width, height, std::min(repeat, 5), scale, &cairoPixels);
  std::printf("%-16s %4u x %u, %2u samples: %6u paths %7u curves %6u entries; made in %.1f ms, recorded in %.1f us, "
              "GPU %.4f ms",
              scene.name.c_str(), width, height, settings.samples, facts.paths, facts.curves, drawn.entries,
              made.milliseconds, drawn.microseconds, drawn.milliseconds);
  if (made.item.glyphCount) std::printf(", %.1f ns a glyph", drawn.microseconds * 1000 / made.item.glyphCount);
  if (cairo > 0) std::printf(", cairo %.2f ms (ratio %.3f)", cairo, drawn.milliseconds / cairo);
  std::printf(" |");
  for (const auto& [name, time] : drawn.passes)
    if (time > 0.0012) std::printf(" %s %.4f", name.c_str(), time);
  std::printf("\n");
  settings.keep = keep;
  for (const double share : {0.01, 0.0}) { // of the text's glyphs, one after another
    if (!keep || (share > 0 && !made.item.glyphCount)) continue;
    settings.edits = static_cast<uint32_t>(share * made.item.glyphCount);
    const VectorDrawn kept = runner.draw(made, scene, width, height, settings, repeat);
    std::printf("  kept, %u glyphs change: %u of %u tiles, recorded in %.1f us, GPU %.4f ms (%.0f %%)\n",
                settings.edits, kept.tilesDrawn, kept.tiles, kept.microseconds, kept.milliseconds,
                100 * kept.milliseconds / drawn.milliseconds);
  }
  std::fflush(stdout);
  if (out.empty()) return;
  host::writePng(out + "/" + scene.name + ".png", host::fromPremultiplied(width, height, drawn.pixels));
  for (size_t i = 0; i < cairoPixels.size(); i += 4)
    std::swap(cairoPixels[i], cairoPixels[i + 2]), cairoPixels[i + 3] = 255;
  if (cairo > 0) host::writePng(out + "/" + scene.name + ".cairo.png", {width, height, cairoPixels});
}

Size sizeOf(const std::string& text) { // "1024" or "1920x1080"
  Size size{};
  char rest = 0;
  if (std::sscanf(text.c_str(), "%5u%c", &size.width, &rest) == 1)
    size.height = size.width;
  else if (std::sscanf(text.c_str(), "%5ux%5u%c", &size.width, &size.height, &rest) != 2)
    size = {};
  if (size.width < 1 || size.width > 16384 || size.height < 1 || size.height > 16384)
    throw Usage("--size: '" + text + "' is not like 1024 or 1920x1080, up to 16384");
  return size;
}
} // namespace

const char* const kUsage =
    "vector_bench [--repeat N] [--least] [--size PIXELS | WxH] [--samples N] [--out FOLDER] [--shapes] [--keep] [--svg "
    "FOLDER] "
    "[SCENE]...\n"
    "  --least   prints least times instead of medians, for machines that do other work as well\n"
    "  --shapes  draws pages as one drawing instead of a text\n"
    "  --keep    also records again what did not change, and pages of which one glyph in a hundred changes\n"
    "  --svg     writes generated scenes as SVG instead\n"
    "  SCENE     map contours page live drops embrace clipart botanical plan feather panels, or FILE.svg\n";

int runBench(Arguments arguments) {
  int repeat = 20;
  Size size{1024, 1024};
  uint32_t samples = 16;
  bool shapes = false, least = false, keep = false;
  std::string out, svg;
  std::vector<Scene> scenes;
  while (arguments.next()) {
    const std::string& word = arguments.word();
    if (word == "--repeat")
      repeat = static_cast<int>(arguments.number());
    else if (word == "--size")
      size = sizeOf(arguments.value());
    else if (word == "--least")
      least = true;
    else if (word == "--samples")
      samples = arguments.number(1, 16);
    else if (word == "--out")
      out = arguments.value();
    else if (word == "--svg")
      svg = arguments.value();
    else if (word == "--shapes")
      shapes = true;
    else if (word == "--keep")
      keep = true;
    else
      scenes.push_back(sceneOf(arguments.name()));
  }
  if (scenes.empty()) scenes = {streetMap(), contourMap(), page(), livePage()};
  for (const Scene& scene : scenes)
    if (!svg.empty()) writeSvg(scene, svg + "/" + scene.name + ".svg");
  if (!svg.empty()) return 0;
  host::HeadlessDevice device;
  std::printf("device %s, %d records, %s\n", device.name().c_str(), repeat, least ? "least times" : "medians");
  VectorRunner runner(device);
  for (const Scene& scene : scenes)
    run(runner, scene, size, {.samples = samples, .blendSrgb = false, .least = least}, repeat, out, shapes, keep);
  return 0;
}

int main(int argc, char** argv) { return benchMain(argc, argv, kUsage, runBench); }
