// What drawings cost: conversion on one thread, GPU time by pass, and cairo's time in the same process.
//
//   vector_bench [--repeat N] [--size PIXELS] [--out FOLDER] [map | contours | page | ... | FILE.svg]...
//
// The generated drawings are in vector_scenes.h. Prints medians and ratios; asserts nothing about time, but fails where
// a record fails or drops paths.
#include "host/busy_work.h"
#include "host/frames.h"
#include "host/memory.h"
#include "host/picture.h"
#include "vector_scenes.h"

#include <gpgp/vector.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {
using namespace gpgp;
using namespace gpgp::bench;
using Clock = std::chrono::steady_clock;

double milliseconds(Clock::duration d) { return std::chrono::duration<double, std::milli>(d).count(); }
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

void run(host::HeadlessDevice& device, const Scene& scene, uint32_t size, uint32_t samples, int repeat,
         const std::string& out) {
  GpgpContextCreateInfo contextInfo = device.contextCreateInfo();
  contextInfo.uploadRingBytes = 128 << 20;
  contextInfo.messageFn = [](void*, const GpgpMessage* m) { std::fprintf(stderr, "%s\n", m->text); };
  GpgpContext context = nullptr;
  expect(gpgpCreateContext(&contextInfo, &context), "gpgpCreateContext");
  std::vector<GpgpPath> paths;
  for (const Shape& s : scene.shapes) paths.push_back(s.view());
  GpgpDrawingCreateInfo drawingInfo = GPGP_DRAWING_CREATE_INFO_INIT;
  drawingInfo.paths = paths.data();
  drawingInfo.pathCount = static_cast<uint32_t>(paths.size());
  drawingInfo.groups = scene.groups.data();
  drawingInfo.groupCount = static_cast<uint32_t>(scene.groups.size());
  GpgpAsset drawing = nullptr;
  const auto begin = Clock::now();
  expect(gpgpCreateDrawing(context, &drawingInfo, &drawing), "gpgpCreateDrawing");
  const double convert = milliseconds(Clock::now() - begin);
  GpgpDrawingInfo facts = GPGP_DRAWING_INFO_INIT;
  expect(gpgpGetDrawingInfo(drawing, &facts), "gpgpGetDrawingInfo");
  GpgpCanvasCreateInfo canvasInfo = GPGP_CANVAS_CREATE_INFO_INIT;
  canvasInfo.base = {"bench", device.graphics().family, 0, VK_FALSE};
  canvasInfo.maxWidth = canvasInfo.maxHeight = size;
  canvasInfo.maxPatches = std::max(facts.patches, 1024u);
  canvasInfo.maxTileEntries = 1u << 19;
  GpgpWorker canvas = nullptr;
  expect(gpgpCreateCanvas(context, &canvasInfo, &canvas), "gpgpCreateCanvas");
  const GpgpPrewarmInfo prewarm = GPGP_PREWARM_INFO_INIT;
  expect(gpgpPrewarm(canvas, &prewarm), "gpgpPrewarm");
  uint32_t passes = 0;
  expect(gpgpGetPasses(canvas, &passes, nullptr), "gpgpGetPasses");
  std::vector<const char*> names(passes);
  expect(gpgpGetPasses(canvas, &passes, names.data()), "gpgpGetPasses");
  const VolkDeviceTable& vk = device.vk();
  const VkQueryPoolCreateInfo queryInfo{
      VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, nullptr, 0, VK_QUERY_TYPE_TIMESTAMP, passes + 3, 0};
  VkQueryPool queries = VK_NULL_HANDLE;
  host::check(vk.vkCreateQueryPool(device.device(), &queryInfo, nullptr, &queries), "vkCreateQueryPool");
  const host::Image target(device, {.format = VK_FORMAT_R8G8B8A8_UNORM, .width = size, .height = size}, "picture");
  const double scale = std::min(size / scene.width, size / scene.height);
  const GpgpCanvasItem item{drawing, {static_cast<float>(scale), 0, 0, static_cast<float>(scale), 0, 0}, 1};
  const double period = static_cast<double>(device.properties().limits.timestampPeriod) * 1e-6;
  std::vector<double> totals, record;
  std::vector<std::vector<double>> each(passes);
  uint32_t entries = 0;
  host::BusyWork busy(device);
  busy.warmUp();
  // Records in turn with a timestamp after each pass, which takes time itself, and with two around it all.
  for (int i = 0; i < 2 * repeat + 2; ++i) {
    const bool split = i % 2 == 0;
    const uint64_t number = 2 * static_cast<uint64_t>(i) + 1;
    const GpgpFrame frame{number, number - 1};
    expect(gpgpAdvance(context, &frame), "gpgpAdvance");
    device.submitAndWait([&](VkCommandBuffer cmd) {
      expect(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), "gpgpRecordUpload");
      busy.record(cmd);
      vk.vkCmdResetQueryPool(cmd, queries, 0, passes + 3);
      GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
      if (split) info.base.timestamps = {queries, 0, passes + 1};
      info.width = info.height = size;
      info.items = &item;
      info.itemCount = 1;
      info.samples = samples;
      info.background[0] = info.background[1] = info.background[2] = info.background[3] = 1;
      info.target = target.target(
          {}, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL});
      info.encodeSrgb = VK_TRUE;
      info.exactArea = VK_TRUE;
      vk.vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries, passes + 1);
      const auto start = Clock::now();
      expect(gpgpRecordPrepareCanvas(canvas, cmd, &frame, &info), "gpgpRecordPrepareCanvas");
      if (i >= 2 && !split) record.push_back(milliseconds(Clock::now() - start) * 1000);
      vk.vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries, passes + 2);
    });
    const GpgpFrame done{number + 1, number};
    expect(gpgpAdvance(context, &done), "gpgpAdvance");
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    expect(gpgpGetCanvasReport(canvas, &report), "gpgpGetCanvasReport");
    if (report.pathsDropped) {
      std::fprintf(stderr, "%s: %u paths dropped, %u entries needed\n", scene.name.c_str(), report.pathsDropped,
                   report.tileEntries);
      std::exit(1);
    }
    entries = report.tileEntries;
    std::vector<uint64_t> times(split ? passes + 1 : 2);
    host::check(vk.vkGetQueryPoolResults(device.device(), queries, split ? 0 : passes + 1,
                                         static_cast<uint32_t>(times.size()), times.size() * 8, times.data(), 8,
                                         VK_QUERY_RESULT_64_BIT),
                "vkGetQueryPoolResults");
    if (i < 2) continue;
    if (!split) totals.push_back(static_cast<double>(times.back() - times.front()) * period);
    if (!split) continue;
    for (uint32_t k = 0; k < passes; ++k) each[k].push_back(static_cast<double>(times[k + 1] - times[k]) * period);
  }
  std::vector<uint8_t> cairoPixels;
  const double cairo = cairoTime(scene, size, size, std::min(repeat, 5), scale, &cairoPixels);
  std::printf(
      "%-16s %4u px %2u samples: %6u paths %7u curves %6u entries; made in %.1f ms, recorded in %.1f us, GPU %.4f ms",
      scene.name.c_str(), size, samples, facts.paths, facts.curves, entries, convert, median(record), median(totals));
  if (cairo > 0) std::printf(", cairo %.2f ms (ratio %.3f)", cairo, median(totals) / cairo);
  std::printf(" |");
  for (uint32_t k = 0; k < passes; ++k)
    if (const double t = median(each[k]); t > 0.0012) std::printf(" %s %.4f", names[k], t);
  std::printf("\n");
  std::fflush(stdout);
  if (!out.empty()) {
    const std::vector<uint8_t> pixels = host::downloadImage(device, target, VK_IMAGE_LAYOUT_GENERAL);
    host::writePng(out + "/" + scene.name + ".png", host::fromPremultiplied(size, size, pixels));
    for (size_t i = 0; i < cairoPixels.size(); i += 4)
      std::swap(cairoPixels[i], cairoPixels[i + 2]), cairoPixels[i + 3] = 255;
    if (cairo > 0) host::writePng(out + "/" + scene.name + ".cairo.png", {size, size, cairoPixels});
  }
  vk.vkDestroyQueryPool(device.device(), queries, nullptr);
  device.waitIdle();
  gpgpDestroyContext(context);
}
} // namespace

int main(int argc, char** argv) {
  int repeat = 20;
  uint32_t size = 1024, samples = 16;
  std::string out;
  std::vector<Scene> scenes;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&] { return i + 1 < argc ? argv[++i] : "1"; };
    if (word == "--repeat")
      repeat = std::max(1, std::atoi(value()));
    else if (word == "--size")
      size = static_cast<uint32_t>(std::clamp(std::atoi(value()), 1, 16384));
    else if (word == "--samples")
      samples = static_cast<uint32_t>(std::atoi(value()));
    else if (word == "--out")
      out = value();
    else
      scenes.push_back(sceneOf(word));
  }
  if (scenes.empty()) scenes = {streetMap(), contourMap(), page()};
  host::HeadlessDevice device;
  std::printf("device %s, %d records, medians\n", device.name().c_str(), repeat);
  for (const Scene& scene : scenes) run(device, scene, size, samples, repeat, out);
  return 0;
}
