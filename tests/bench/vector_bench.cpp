// What drawings cost: conversion on one thread, GPU time by pass, and cairo's time in the same process.
//
//   vector_bench [--repeat N] [--size PIXELS] [--out FOLDER] [map | contours | page | FILE.svg]...
//
// map, contours and page are generated: a street map (45 000 paths, 545 000 curves), a contour map (53 000 paths,
// 188 000 curves), a page of 12 000 glyph-like shapes. Prints medians and ratios; asserts nothing about time, but fails
// where a record fails or drops paths.
#include "host/busy_work.h"
#include "host/files.h"
#include "host/frames.h"
#include "host/memory.h"
#include "host/picture.h"
#include "vector/import/svg/document.h"
#include "vector/import/svg/import.h"

#include <gpgp/vector.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#ifdef GPGP_WITH_CAIRO
#include <cairo.h>
#endif

namespace {
using namespace gpgp;
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

struct Shape {
  std::vector<GpgpPathVerb> verbs;
  std::vector<float> points;
  float color[4] = {0, 0, 0, 1};
  GpgpFillRule rule = GPGP_FILL_NON_ZERO;
  const GpgpGradient* gradient = nullptr;
  uint32_t group = 0;
  void add(GpgpPathVerb verb, std::initializer_list<double> values) {
    verbs.push_back(verb);
    for (const double v : values) points.push_back(static_cast<float>(v));
  }
  GpgpPath view() const {
    return {verbs.data(),  static_cast<uint32_t>(verbs.size()),
            points.data(), static_cast<uint32_t>(points.size() / 2),
            rule,          {color[0], color[1], color[2], color[3]},
            gradient,      nullptr,
            nullptr,       0,
            group};
  }
};
struct Scene {
  std::string name;
  std::vector<Shape> shapes;
  double width = 1000, height = 1000;
  std::shared_ptr<void> source; // what shapes and groups refer to
  std::span<const GpgpPathGroup> groups = {};
};

void paint(Shape& shape, std::mt19937& random, float alpha = 1) {
  std::uniform_real_distribution<float> light(0.05f, 0.9f);
  shape.color[0] = light(random), shape.color[1] = light(random), shape.color[2] = light(random);
  shape.color[3] = alpha;
}

/// A strip of constant width along a wavy line of `count` quadratics: a road, a contour.
void strip(Shape& shape, double x, double y, double angle, double length, double width, int count,
           std::mt19937& random) {
  std::uniform_real_distribution<double> bend(-0.5, 0.5);
  std::vector<std::array<double, 2>> line{{x, y}};
  const double step = length / (2 * count);
  for (int i = 0; i < 2 * count; ++i) {
    angle += bend(random) * 0.6;
    x += std::cos(angle) * step, y += std::sin(angle) * step;
    line.push_back({x, y});
  }
  const auto side = [&](size_t i, double w) {
    const size_t a = i ? i - 1 : 0, b = std::min(i + 1, line.size() - 1);
    const double dx = line[b][0] - line[a][0], dy = line[b][1] - line[a][1], l = std::hypot(dx, dy) + 1e-9;
    return std::array<double, 2>{line[i][0] - dy / l * w, line[i][1] + dx / l * w};
  };
  const auto first = side(0, width);
  shape.add(GPGP_PATH_MOVE, {first[0], first[1]});
  for (size_t i = 1; i + 1 < line.size(); i += 2) {
    const auto c = side(i, width), e = side(i + 1, width);
    shape.add(GPGP_PATH_QUAD, {c[0], c[1], e[0], e[1]});
  }
  const auto turn = side(line.size() - 1, -width);
  shape.add(GPGP_PATH_LINE, {turn[0], turn[1]});
  for (size_t i = line.size() - 1; i >= 2; i -= 2) {
    const auto c = side(i - 1, -width), e = side(i - 2, -width);
    shape.add(GPGP_PATH_QUAD, {c[0], c[1], e[0], e[1]});
  }
  shape.add(GPGP_PATH_CLOSE, {});
}

Scene streetMap() {
  Scene scene{"map", {}};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(0, 1000), size(1.5, 6), wobble(0.7, 1.1), turn(0, 6.28);
  for (int i = 0; i < 300; ++i) { // parks and water
    Shape s;
    const double x = at(random), y = at(random), r = 4 * size(random);
    s.add(GPGP_PATH_MOVE, {x + r, y});
    for (int k = 1; k <= 12; ++k) {
      const double a = k * 0.5235988, b = a - 0.2617994, q = k == 12 ? r : r * wobble(random);
      s.add(GPGP_PATH_QUAD, {x + r * std::cos(b), y + r * std::sin(b), x + q * std::cos(a), y + q * std::sin(a)});
    }
    paint(s, random);
    scene.shapes.push_back(s);
  }
  for (int i = 0; i < 33700; ++i) { // buildings: twelve corners
    Shape s;
    const double x = at(random), y = at(random), r = size(random) * 0.5, start = turn(random);
    for (int k = 0; k < 12; ++k) {
      const double a = start + k * 0.5235988, q = r * wobble(random);
      s.add(k ? GPGP_PATH_LINE : GPGP_PATH_MOVE, {x + q * std::cos(a), y + q * std::sin(a)});
    }
    s.add(GPGP_PATH_CLOSE, {});
    paint(s, random);
    scene.shapes.push_back(s);
  }
  for (int i = 0; i < 11000; ++i) { // streets, some across the whole town
    Shape s;
    strip(s, at(random), at(random), turn(random), i % 100 == 0 ? 900 : 30, i % 10 == 0 ? 1.2 : 0.5, 6, random);
    paint(s, random);
    scene.shapes.push_back(s);
  }
  return scene;
}

Scene contourMap() {
  Scene scene{"contours", {}};
  std::mt19937 random(2);
  std::uniform_real_distribution<double> at(0, 1000), turn(0, 6.28), length(5, 40);
  for (int i = 0; i < 53000; ++i) {
    Shape s;
    strip(s, at(random), at(random), turn(random), length(random), 0.15, i % 4 == 0 ? 2 : 1, random);
    paint(s, random);
    scene.shapes.push_back(s);
  }
  return scene;
}

Scene page() {
  Scene scene{"page", {}};
  std::mt19937 random(3);
  for (int i = 0; i < 12000; ++i) { // a bowl and a stem, one way or another
    Shape s;
    const double x = 10 + (i % 150) * 6.5, y = 10 + (i / 150) * 12.2, w = 4.5,
                 h = 3 + 2.5 * static_cast<double>(random() % 3), k = 0.55;
    const auto ring = [&](double cx, double cy, double a, double b, bool inner) {
      const double f = inner ? -1 : 1;
      s.add(GPGP_PATH_MOVE, {cx + a, cy});
      s.add(GPGP_PATH_CUBIC, {cx + a, cy + f * k * b, cx + k * a, cy + f * b, cx, cy + f * b});
      s.add(GPGP_PATH_CUBIC, {cx - k * a, cy + f * b, cx - a, cy + f * k * b, cx - a, cy});
      s.add(GPGP_PATH_CUBIC, {cx - a, cy - f * k * b, cx - k * a, cy - f * b, cx, cy - f * b});
      s.add(GPGP_PATH_CUBIC, {cx + k * a, cy - f * b, cx + a, cy - f * k * b, cx + a, cy});
    };
    ring(x + w / 2, y + 5, w / 2, 2.5, false);
    ring(x + w / 2, y + 5, w / 3.5, 1.8, true);
    s.add(GPGP_PATH_MOVE, {x, y + 8 - h}), s.add(GPGP_PATH_LINE, {x + 0.8, y + 8 - h});
    s.add(GPGP_PATH_LINE, {x + 0.8, y + 8}), s.add(GPGP_PATH_LINE, {x, y + 8}), s.add(GPGP_PATH_CLOSE, {});
    scene.shapes.push_back(s);
  }
  return scene;
}

Scene fromSvg(const std::string& file) {
  const auto bytes = host::readFile(file);
  vector::svg::Reporter reporter(nullptr, nullptr, file.c_str());
  auto svg = vector::svg::importSvg(std::as_bytes(std::span(bytes)), reporter);
  if (!svg) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), svg.error().text);
    std::exit(1);
  }
  Scene scene{file.substr(file.find_last_of('/') + 1), {}, svg->width, svg->height};
  struct Kept {
    explicit Kept(vector::svg::Imported&& from) : imported(std::move(from)), views(imported) {}
    vector::svg::Imported imported;
    vector::svg::ImportedViews views;
  };
  const auto kept = std::make_shared<Kept>(std::move(*svg));
  scene.source = kept;
  scene.groups = kept->views.groups;
  for (const GpgpPath& path : kept->views.paths) {
    Shape s;
    s.verbs.assign(path.verbs, path.verbs + path.verbCount);
    s.points.assign(path.points, path.points + size_t(path.pointCount) * 2);
    std::copy_n(path.color, 4, s.color);
    s.rule = path.fillRule;
    s.gradient = path.gradient;
    s.group = path.group;
    scene.shapes.push_back(std::move(s));
  }
  return scene;
}

#ifdef GPGP_WITH_CAIRO
void trace(cairo_t* c, const GpgpPath& path) {
  const float* p = path.points;
  double x = 0, y = 0;
  const auto take = [&p, &x, &y] { x = static_cast<double>(p[0]), y = static_cast<double>(p[1]), p += 2; };
  for (const GpgpPathVerb verb : std::span(path.verbs, path.verbCount)) {
    if (verb == GPGP_PATH_MOVE) take(), cairo_move_to(c, x, y);
    if (verb == GPGP_PATH_LINE) take(), cairo_line_to(c, x, y);
    if (verb == GPGP_PATH_CLOSE) cairo_close_path(c);
    if (verb == GPGP_PATH_QUAD) {
      double ax, ay;
      cairo_get_current_point(c, &ax, &ay);
      take();
      const double bx = x, by = y;
      take();
      cairo_curve_to(c, (ax + 2 * bx) / 3, (ay + 2 * by) / 3, (x + 2 * bx) / 3, (y + 2 * by) / 3, x, y);
    }
    if (verb == GPGP_PATH_CUBIC) {
      take();
      const double ax = x, ay = y;
      take();
      const double bx = x, by = y;
      take();
      cairo_curve_to(c, ax, ay, bx, by, x, y);
    }
  }
  cairo_set_fill_rule(c, path.fillRule == GPGP_FILL_EVEN_ODD ? CAIRO_FILL_RULE_EVEN_ODD : CAIRO_FILL_RULE_WINDING);
}

/// Cairo mixes stops as sRGB encodes them, whatever the gradient says.
void setGradient(cairo_t* c, const GpgpGradient& g, float alpha) {
  const auto at = [](float v) { return static_cast<double>(v); };
  const auto encode = [](float v) { return static_cast<double>(host::srgbFromLinear(v)); };
  cairo_pattern_t* pattern =
      g.kind == GPGP_GRADIENT_RADIAL
          ? cairo_pattern_create_radial(at(g.start[0]), at(g.start[1]), at(g.startRadius), at(g.end[0]), at(g.end[1]),
                                        at(g.endRadius))
          : cairo_pattern_create_linear(at(g.start[0]), at(g.start[1]), at(g.end[0]), at(g.end[1]));
  for (uint32_t i = 0; i < g.stopCount; ++i) {
    const float* color = g.stops[i].color;
    cairo_pattern_add_color_stop_rgba(pattern, at(g.stops[i].offset), encode(color[0]), encode(color[1]),
                                      encode(color[2]), at(color[3] * alpha));
  }
  cairo_pattern_set_extend(pattern, g.spread == GPGP_SPREAD_REPEAT    ? CAIRO_EXTEND_REPEAT
                                    : g.spread == GPGP_SPREAD_REFLECT ? CAIRO_EXTEND_REFLECT
                                                                      : CAIRO_EXTEND_PAD);
  cairo_matrix_t matrix; // from the drawing to the gradient
  cairo_matrix_init(&matrix, at(g.transform[0]), at(g.transform[1]), at(g.transform[2]), at(g.transform[3]),
                    at(g.transform[4]), at(g.transform[5]));
  if (cairo_matrix_invert(&matrix) == CAIRO_STATUS_SUCCESS) cairo_pattern_set_matrix(pattern, &matrix);
  cairo_set_source(c, pattern);
  cairo_pattern_destroy(pattern);
}
#endif

/// Median milliseconds of cairo; 0 where it is not built in.
double cairoTime([[maybe_unused]] const Scene& scene, [[maybe_unused]] uint32_t size, [[maybe_unused]] int repeat,
                 [[maybe_unused]] double scale, [[maybe_unused]] const std::string& picture) {
#ifdef GPGP_WITH_CAIRO
  cairo_surface_t* surface =
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, static_cast<int>(size), static_cast<int>(size));
  std::vector<double> times;
  for (int i = 0; i < repeat; ++i) {
    const auto begin = Clock::now();
    cairo_t* c = cairo_create(surface);
    cairo_set_source_rgb(c, 1, 1, 1);
    cairo_paint(c);
    cairo_scale(c, scale, scale);
    std::vector<uint32_t> open; // groups, the outermost first
    const auto enter = [&](uint32_t group) {
      std::vector<uint32_t> around;
      for (uint32_t g = group; g; g = scene.groups[g - 1].parent) around.insert(around.begin(), g);
      size_t same = 0;
      while (same < std::min(open.size(), around.size()) && open[same] == around[same]) ++same;
      for (; open.size() > same; open.pop_back()) {
        const double opacity = static_cast<double>(scene.groups[open.back() - 1].opacity);
        if (opacity < 1) cairo_pop_group_to_source(c), cairo_paint_with_alpha(c, opacity);
        cairo_restore(c);
      }
      for (; open.size() < around.size(); open.push_back(around[open.size()])) {
        const GpgpPathGroup& g = scene.groups[around[open.size()] - 1];
        cairo_save(c);
        for (uint32_t k = 0; k < g.clipCount; ++k) trace(c, g.clip[k]); // all by the last one's fill rule
        if (g.clip) cairo_clip(c);
        if (g.opacity < 1) cairo_push_group(c);
      }
    };
    for (const Shape& s : scene.shapes) {
      enter(s.group);
      const GpgpPath path = s.view();
      trace(c, path);
      const auto encode = [](float v) { return static_cast<double>(host::srgbFromLinear(v)); };
      if (s.gradient)
        setGradient(c, *s.gradient, s.color[3]);
      else
        cairo_set_source_rgba(c, encode(s.color[0]), encode(s.color[1]), encode(s.color[2]),
                              static_cast<double>(s.color[3]));
      cairo_fill(c);
    }
    enter(0);
    cairo_destroy(c);
    cairo_surface_flush(surface);
    times.push_back(milliseconds(Clock::now() - begin));
  }
  if (!picture.empty()) cairo_surface_write_to_png(surface, picture.c_str());
  cairo_surface_destroy(surface);
  return median(times);
#else
  return 0;
#endif
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
      VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, nullptr, 0, VK_QUERY_TYPE_TIMESTAMP, passes + 1, 0};
  VkQueryPool queries = VK_NULL_HANDLE;
  host::check(vk.vkCreateQueryPool(device.device(), &queryInfo, nullptr, &queries), "vkCreateQueryPool");
  const host::Image target(device, {.format = VK_FORMAT_R8G8B8A8_UNORM, .width = size, .height = size}, "picture");
  const double scale = std::min(size / scene.width, size / scene.height);
  const GpgpCanvasItem item{drawing, {static_cast<float>(scale), 0, 0, static_cast<float>(scale), 0, 0}, 1};
  const double period = static_cast<double>(device.properties().limits.timestampPeriod) * 1e-6;
  std::vector<double> totals, record;
  std::vector<std::vector<double>> each(passes);
  uint32_t entries = 0;
  const host::BusyWork busy(device);
  busy.warmUp();
  for (int i = 0; i < repeat + 2; ++i) {
    const uint64_t number = 2 * static_cast<uint64_t>(i) + 1;
    const GpgpFrame frame{number, number - 1};
    expect(gpgpAdvance(context, &frame), "gpgpAdvance");
    device.submitAndWait([&](VkCommandBuffer cmd) {
      expect(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), "gpgpRecordUpload");
      busy.record(cmd);
      vk.vkCmdResetQueryPool(cmd, queries, 0, passes + 1);
      GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
      info.base.timestamps = {queries, 0, passes + 1};
      info.width = info.height = size;
      info.items = &item;
      info.itemCount = 1;
      info.samples = samples;
      info.background[0] = info.background[1] = info.background[2] = info.background[3] = 1;
      info.target = target.target(
          {}, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL});
      info.encodeSrgb = VK_TRUE;
      info.exactArea = VK_TRUE;
      const auto start = Clock::now();
      expect(gpgpRecordPrepareCanvas(canvas, cmd, &frame, &info), "gpgpRecordPrepareCanvas");
      if (i >= 2) record.push_back(milliseconds(Clock::now() - start) * 1000);
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
    std::vector<uint64_t> times(passes + 1);
    host::check(vk.vkGetQueryPoolResults(device.device(), queries, 0, passes + 1, times.size() * 8, times.data(), 8,
                                         VK_QUERY_RESULT_64_BIT),
                "vkGetQueryPoolResults");
    if (i < 2) continue;
    totals.push_back(static_cast<double>(times.back() - times.front()) * period);
    for (uint32_t k = 0; k < passes; ++k) each[k].push_back(static_cast<double>(times[k + 1] - times[k]) * period);
  }
  const double cairo =
      cairoTime(scene, size, std::min(repeat, 5), scale, out.empty() ? out : out + "/" + scene.name + ".cairo.png");
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
    else if (word == "map")
      scenes.push_back(streetMap());
    else if (word == "contours")
      scenes.push_back(contourMap());
    else if (word == "page")
      scenes.push_back(page());
    else
      scenes.push_back(fromSvg(word));
  }
  if (scenes.empty()) scenes = {streetMap(), contourMap(), page()};
  host::HeadlessDevice device;
  std::printf("device %s, %d records, medians\n", device.name().c_str(), repeat);
  for (const Scene& scene : scenes) run(device, scene, size, samples, repeat, out);
  return 0;
}
