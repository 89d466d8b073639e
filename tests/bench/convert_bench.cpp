// What it costs to convert paths to CPatches, on one thread.
//
// Drawings (strokes to fills and the outlines that are uploaded included, parsing not), glyphs of a font, and made
// paths of 10^2 to 10^5 curves in one path, whose cost per curve tells whether the conversion is linear. Baseline in
// the same process: cairo filling the same paths into a picture of 1024 x 1024 pixels, which flattens and tessellates
// them each time. Prints medians and ratios; asserts nothing about time.
#include "arguments.h"
#include "host/files.h"
#include "measuring.h"
#include "vector/import/svg/import.h"
#include "vector/patch/drawing.h"
#include "vector/raster/segments.h"

#include <cairo.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

namespace {
using namespace gpgp;
using bench::Clock;

template <class Work> double medianOf(int rounds, Work&& work) {
  std::vector<double> times;
  for (int i = 0; i < rounds; ++i) {
    const auto start = Clock::now();
    work();
    times.push_back(bench::milliseconds(Clock::now() - start));
  }
  return bench::median(std::move(times));
}

struct Path {
  std::vector<GpgpPathVerb> verbs;
  std::vector<float> points;
  GpgpPath view() const {
    GpgpPath path{};
    path.verbs = verbs.data();
    path.verbCount = static_cast<uint32_t>(verbs.size());
    path.points = points.data();
    path.pointCount = static_cast<uint32_t>(points.size() / 2);
    path.color[3] = 1;
    return path;
  }
  void add(GpgpPathVerb verb, std::initializer_list<float> values) {
    verbs.push_back(verb);
    points.insert(points.end(), values);
  }
};

void cairoFill(cairo_t* cr, const GpgpPath& path, double scale) {
  cairo_save(cr);
  cairo_scale(cr, scale, scale);
  cairo_new_path(cr);
  const float* p = path.points;
  for (uint32_t i = 0; i < path.verbCount; ++i) switch (path.verbs[i]) {
    case GPGP_PATH_MOVE: cairo_move_to(cr, p[0], p[1]), p += 2; break;
    case GPGP_PATH_LINE: cairo_line_to(cr, p[0], p[1]), p += 2; break;
    case GPGP_PATH_QUAD: {
      double x, y;
      cairo_get_current_point(cr, &x, &y);
      cairo_curve_to(cr, x + (p[0] - x) * 2 / 3, y + (p[1] - y) * 2 / 3, p[2] + (p[0] - p[2]) * 2.0 / 3,
                     p[3] + (p[1] - p[3]) * 2.0 / 3, p[2], p[3]);
      p += 4;
      break;
    }
    case GPGP_PATH_CUBIC: cairo_curve_to(cr, p[0], p[1], p[2], p[3], p[4], p[5]), p += 6; break;
    default: cairo_close_path(cr); break;
    }
  cairo_set_fill_rule(cr, path.fillRule == GPGP_FILL_EVEN_ODD ? CAIRO_FILL_RULE_EVEN_ODD : CAIRO_FILL_RULE_WINDING);
  cairo_fill(cr);
  cairo_restore(cr);
}

size_t curvesOf(std::span<const GpgpPath> paths) {
  size_t count = 0;
  for (const GpgpPath& path : paths)
    for (uint32_t i = 0; i < path.verbCount; ++i) count += path.verbs[i] != GPGP_PATH_MOVE;
  return count;
}

void row(const char* name, int rounds, std::span<const GpgpPath> paths, double extra, double size) {
  std::pmr::memory_resource* memory = std::pmr::new_delete_resource();
  size_t patches = 0, curves = 0;
  const double ours = extra + medianOf(rounds, [&] {
                        const auto drawing = vector::makeDrawing(paths, memory);
                        if (!drawing) {
                          std::fprintf(stderr, "%s: %s\n", name, drawing.error().text);
                          std::exit(1);
                        }
                        vector::makeOutlines(*drawing, memory);
                        patches = drawing->patches.size();
                        curves = drawing->curves.size();
                      });
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1024, 1024);
  cairo_t* cr = cairo_create(surface);
  const double cairo = medianOf(std::min(rounds, 5), [&] {
    for (const GpgpPath& path : paths) cairoFill(cr, path, 1024 / size);
  });
  cairo_destroy(cr);
  cairo_surface_destroy(surface);
  const size_t in = curvesOf(paths);
  std::printf("%-16s %7zu %8zu %8zu %8zu %10.3f %9.1f %10.3f %7.2f\n", name, paths.size(), in, curves, patches, ours,
              ours * 1e6 / static_cast<double>(in), cairo, ours / cairo);
}

/// What it costs to convert one path again and to copy the rest, for each path in turn.
void edited(int rounds, std::span<const GpgpPath> paths) {
  std::pmr::memory_resource* memory = std::pmr::new_delete_resource();
  const auto whole = vector::makeDrawing(paths, memory);
  if (!whole) std::exit(1);
  const auto outlines = vector::makeOutlines(*whole, memory);
  const double all = medianOf(rounds, [&] { vector::makeOutlines(*vector::makeDrawing(paths, memory), memory); });
  std::vector<double> times;
  for (uint32_t i = 0; i < paths.size(); ++i)
    times.push_back(medianOf(1, [&] {
      const GpgpPathEdit edit{i, paths[i]};
      const auto drawing = vector::replacePaths(*whole, std::span(&edit, 1), memory);
      vector::editOutlines(*drawing, outlines, std::span(&edit, 1), memory);
    }));
  std::sort(times.begin(), times.end());
  std::printf("%-16s with its outlines %.3f ms; one path replaced: median %.3f, at most %.3f (ratio %.3f)\n", "", all,
              times[times.size() / 2], times.back(), times[times.size() / 2] / all);
}

/// Curves of about the same length, each beginning where the one before ended, turning at random: a scribble that
/// crosses itself about as often as it has curves.
Path scribble(size_t curves) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-1, 1);
  const float step = 1000 / std::sqrt(static_cast<float>(curves));
  Path path;
  float x = 500, y = 500;
  path.add(GPGP_PATH_MOVE, {x, y});
  const auto next = [&](float v) { return std::clamp(v + 1.5f * step * unit(random), 0.0f, 1000.0f); };
  for (size_t i = 0; i < curves; ++i) {
    const float ax = next(x), ay = next(y), bx = next(ax), by = next(ay);
    x = next(bx), y = next(by);
    path.add(GPGP_PATH_CUBIC, {ax, ay, bx, by, x, y});
  }
  return path;
}

/// Small closed shapes side by side in one path, as a town plan has.
Path town(size_t curves) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0, 1);
  const int side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(curves) / 4)));
  const float cell = 1000.0f / static_cast<float>(side);
  Path path;
  for (int i = 0; i < side * side; ++i) {
    const float x = static_cast<float>(i % side) * cell + unit(random) * cell * 0.1f,
                y = static_cast<float>(i / side) * cell + unit(random) * cell * 0.1f, w = cell * 0.8f;
    path.add(GPGP_PATH_MOVE, {x, y});
    path.add(GPGP_PATH_LINE, {x + w, y + unit(random) * cell * 0.1f});
    path.add(GPGP_PATH_QUAD, {x + w * 1.1f, y + w / 2, x + w, y + w});
    path.add(GPGP_PATH_LINE, {x, y + w});
    path.add(GPGP_PATH_CLOSE, {});
  }
  return path;
}

/// Long contours beside each other, as isolines are: every piece meets the same rows as all others.
Path contours(size_t curves) {
  Path path;
  const size_t lines = std::max<size_t>(1, static_cast<size_t>(std::sqrt(static_cast<double>(curves))));
  for (size_t l = 0; l < lines; ++l) {
    const float x = 1000.0f * static_cast<float>(l) / static_cast<float>(lines), w = 400.0f / static_cast<float>(lines),
                h = 1000.0f * static_cast<float>(lines) / static_cast<float>(curves) * 2;
    float y = 0;
    path.add(GPGP_PATH_MOVE, {x, y});
    for (size_t i = 0; i < curves / lines / 2; ++i, y += h)
      path.add(GPGP_PATH_CUBIC, {x + w / 2, y + h / 3, x - w / 2, y + h * 2 / 3, x, y + h});
    path.add(GPGP_PATH_LINE, {x + w, y});
    for (size_t i = 0; i < curves / lines / 2; ++i, y -= h)
      path.add(GPGP_PATH_CUBIC, {x + w / 2, y - h / 3, x + w * 1.5f, y - h * 2 / 3, x + w, y - h});
    path.add(GPGP_PATH_CLOSE, {});
  }
  return path;
}

struct GlyphSink {
  Path path;
  bool open = false;
  static float f(FT_Pos v) { return static_cast<float>(v) / 64; }
  static int move(const FT_Vector* a, void* user) {
    static_cast<GlyphSink*>(user)->path.add(GPGP_PATH_MOVE, {f(a->x), f(a->y)});
    return 0;
  }
  static int line(const FT_Vector* a, void* user) {
    static_cast<GlyphSink*>(user)->path.add(GPGP_PATH_LINE, {f(a->x), f(a->y)});
    return 0;
  }
  static int quad(const FT_Vector* a, const FT_Vector* b, void* user) {
    static_cast<GlyphSink*>(user)->path.add(GPGP_PATH_QUAD, {f(a->x), f(a->y), f(b->x), f(b->y)});
    return 0;
  }
  static int cubic(const FT_Vector* a, const FT_Vector* b, const FT_Vector* c, void* user) {
    static_cast<GlyphSink*>(user)->path.add(GPGP_PATH_CUBIC, {f(a->x), f(a->y), f(b->x), f(b->y), f(c->x), f(c->y)});
    return 0;
  }
};

void glyphs(const std::string& file, const char* name, int rounds) {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  if (FT_Init_FreeType(&library) || FT_New_Face(library, file.c_str(), 0, &face)) {
    std::printf("%-16s is not there: tests/data/fetch.sh --only fonts\n", name);
    return;
  }
  FT_Set_Pixel_Sizes(face, 0, 64);
  std::vector<double> times;
  size_t curves = 0, patches = 0;
  for (FT_UInt i = 0; i < static_cast<FT_UInt>(std::min(face->num_glyphs, 1000L)); ++i) {
    if (FT_Load_Glyph(face, i, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP)) continue;
    GlyphSink sink;
    const FT_Outline_Funcs functions{GlyphSink::move, GlyphSink::line, GlyphSink::quad, GlyphSink::cubic, 0, 0};
    FT_Outline_Decompose(&face->glyph->outline, &functions, &sink);
    if (sink.path.verbs.empty()) continue;
    const GpgpPath view = sink.path.view();
    times.push_back(medianOf(std::max(rounds / 2, 1), [&] {
      const auto drawing = vector::makeDrawing(std::span(&view, 1), std::pmr::new_delete_resource());
      if (!drawing) std::exit(1);
      patches += drawing->patches.size();
    }));
    curves += curvesOf(std::span(&view, 1));
  }
  std::sort(times.begin(), times.end());
  std::printf("%-16s %5zu glyphs of %.1f curves: median %.2f us, nine tenths below %.2f, at most %.2f\n", name,
              times.size(), static_cast<double>(curves) / static_cast<double>(times.size()),
              1e3 * times[times.size() / 2], 1e3 * times[times.size() * 9 / 10], 1e3 * times.back());
  FT_Done_Face(face);
  FT_Done_FreeType(library);
}

} // namespace

const char* const kUsage = "convert_bench [ROUNDS]     20 rounds where it does not say\n";

int runBench(bench::Arguments arguments) {
  const int rounds = arguments.next() ? static_cast<int>(arguments.count()) : 20;
  const std::string data = GPGP_TEST_DATA;
  std::printf("%-16s %7s %8s %8s %8s %10s %9s %10s %7s\n", "drawing", "paths", "in", "curves", "patches", "ms",
              "ns/curve", "cairo ms", "ratio");
  for (const char* name : {"tiger", "car", "gallardo"}) {
    const std::string file = data + "/fetched/svg/" + name + ".svgz";
    if (!std::filesystem::exists(file)) {
      std::printf("%-16s is not there: tests/data/fetch.sh --only svg\n", name);
      continue;
    }
    const auto bytes = host::readFile(file);
    vector::svg::Reporter reporter(nullptr, nullptr, name);
    double strokes = 1e30, size = 1;
    std::vector<GpgpPath> paths;
    core::Result<vector::svg::Imported> svg = core::Error{};
    for (int i = 0; i < rounds; ++i) {
      svg = vector::svg::importSvg(std::as_bytes(std::span(bytes)), reporter);
      if (!svg) return std::fprintf(stderr, "%s: %s\n", name, svg.error().text), 1;
      strokes = std::min(strokes, svg->strokeMilliseconds);
    }
    size = std::max({svg->width, svg->height, 1.0});
    for (const auto& path : svg->paths) paths.push_back(path.view());
    row(name, rounds, paths, strokes, size);
    std::printf("%-16s strokes to fills: %.3f ms of that\n", "", strokes);
    edited(rounds, paths);
  }
  for (const auto& [name, make] : {std::pair{"scribble", &scribble}, {"town", &town}, {"contours", &contours}})
    for (const size_t curves : {100, 1000, 10000, 100000}) {
      const Path path = make(curves);
      const GpgpPath view = path.view();
      row(name, curves > 10000 ? std::min(rounds, 3) : rounds, std::span(&view, 1), 0, 1000);
    }
  glyphs(data + "/fetched/fonts/DejaVuSans.ttf", "DejaVu Sans", rounds);
  glyphs(data + "/fetched/fonts/NotoSansCJK-Regular.ttc", "Noto Sans CJK", rounds);
  return 0;
}

int main(int argc, char** argv) { return bench::benchMain(argc, argv, kUsage, runBench); }
