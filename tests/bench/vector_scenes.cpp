// Generated drawings; their random numbers are the same everywhere.
#include "vector_scenes.h"

#include "host/files.h"
#include "host/picture.h"
#include "measuring.h"
#include "vector/import/svg/document.h"
#include "vector/import/svg/import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#ifdef GPGP_WITH_CAIRO
#include "../cairo_draw.h"
#endif

namespace gpgp::bench {
namespace {

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

} // namespace

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

namespace {
/// A bowl and a stem of height h on the baseline at x, y; an em has `em` units.
Shape letter(double x, double y, double h, double em) {
  Shape s;
  const double w = 4.5, k = 0.55;
  const auto add = [&](GpgpPathVerb verb, std::initializer_list<double> values) {
    s.verbs.push_back(verb);
    bool isX = true;
    for (const double v : values) {
      s.points.push_back(static_cast<float>((isX ? x : y) + v * em / 8));
      isX = !isX;
    }
  };
  const auto ring = [&](double a, double b, double f) {
    const double cx = w / 2, cy = -3;
    add(GPGP_PATH_MOVE, {cx + a, cy});
    add(GPGP_PATH_CUBIC, {cx + a, cy + f * k * b, cx + k * a, cy + f * b, cx, cy + f * b});
    add(GPGP_PATH_CUBIC, {cx - k * a, cy + f * b, cx - a, cy + f * k * b, cx - a, cy});
    add(GPGP_PATH_CUBIC, {cx - a, cy - f * k * b, cx - k * a, cy - f * b, cx, cy - f * b});
    add(GPGP_PATH_CUBIC, {cx + k * a, cy - f * b, cx + a, cy - f * k * b, cx + a, cy});
  };
  ring(w / 2, 2.5, 1);
  ring(w / 3.5, 1.8, -1);
  add(GPGP_PATH_MOVE, {0, -h}), add(GPGP_PATH_LINE, {0.8, -h});
  add(GPGP_PATH_LINE, {0.8, 0}), add(GPGP_PATH_LINE, {0, 0}), add(GPGP_PATH_CLOSE, {});
  return s;
}
} // namespace

Scene page() {
  Scene scene{"page", {}};
  std::mt19937 random(3);
  constexpr double kHeights[] = {3, 5.5, 8};
  for (const double h : kHeights) scene.glyphs.push_back(letter(0, 0, h, 1));
  for (int i = 0; i < 12000; ++i) {
    const double x = 10 + (i % 150) * 6.5, y = 18 + (i / 150) * 12.2;
    const auto which = static_cast<uint32_t>(random() % 3);
    scene.shapes.push_back(letter(x, y, kHeights[which], 8));
    scene.text.push_back({1 + which, static_cast<float>(x), static_cast<float>(y), 8, {0, 0, 0, 1}});
  }
  return scene;
}

Scene livePage() {
  Scene scene = page();
  scene.name = "live page";
  scene.changes = true;
  return scene;
}

Scene drops() {
  Scene scene{"drops", {}};
  std::mt19937 random(4);
  std::uniform_real_distribution<double> at(0, 1000), size(8, 60);
  for (int i = 0; i < 204; ++i) {
    Shape s;
    const double x = at(random), y = at(random), r = size(random), k = 0.5522847 * r;
    s.add(GPGP_PATH_MOVE, {x, y - 2.2 * r});
    s.add(GPGP_PATH_CUBIC, {x + 0.2 * r, y - 1.4 * r, x + r, y - k, x + r, y});
    s.add(GPGP_PATH_CUBIC, {x + r, y + k, x + k, y + r, x, y + r});
    s.add(GPGP_PATH_CUBIC, {x - k, y + r, x - r, y + k, x - r, y});
    s.add(GPGP_PATH_CUBIC, {x - r, y - k, x - 0.2 * r, y - 1.4 * r, x, y - 2.2 * r});
    s.add(GPGP_PATH_CLOSE, {});
    paint(s, random, i % 3 == 0 ? 0.6f : 1);
    scene.shapes.push_back(s);
  }
  return scene;
}

namespace {
/// A closed outline of smooth cubics around a point, its radius varying by `wobble`.
void blob(Shape& s, double x, double y, double radius, int curves, double wobble, std::mt19937& random) {
  std::uniform_real_distribution<double> vary(1 - wobble, 1);
  const double step = 6.283185307 / curves, handle = 4.0 / 3 * std::tan(step / 4);
  double before = radius * vary(random);
  const double first = before;
  s.add(GPGP_PATH_MOVE, {x + before, y});
  for (int i = 1; i <= curves; ++i) {
    const double a = (i - 1) * step, b = i * step, next = i == curves ? first : radius * vary(random);
    s.add(GPGP_PATH_CUBIC,
          {x + before * (std::cos(a) - handle * std::sin(a)), y + before * (std::sin(a) + handle * std::cos(a)),
           x + next * (std::cos(b) + handle * std::sin(b)), y + next * (std::sin(b) - handle * std::cos(b)),
           x + next * std::cos(b), y + next * std::sin(b)});
    before = next;
  }
  s.add(GPGP_PATH_CLOSE, {});
}
} // namespace

Scene embrace() {
  Scene scene{"embrace", {}};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(100, 900), size(20, 120);
  for (int i = 0; i < 225; ++i) {
    Shape s;
    blob(s, at(random), at(random), size(random), 22, 0.25, random);
    paint(s, random);
    scene.shapes.push_back(s);
  }
  return scene;
}

Scene clipArt() {
  Scene scene{"clip art", {}};
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 691; ++i) { // a hundred small pictures of seven shapes
    Shape s;
    const int cell = i / 7;
    const double r = 48 * (1 - 0.12 * (i % 7)), x = 50 + (cell % 10) * 100 + 8 * unit(random),
                 y = 50 + (cell / 10 % 10) * 100 + 8 * unit(random);
    if (i % 3 == 0) {
      blob(s, x, y, r, 10, 0.05, random);
    } else if (i % 3 == 1) {
      blob(s, x, y, r, 8, 0.4, random);
    } else {
      for (int k = 0; k < 12; ++k) {
        const double a = k * 0.5235988, q = k % 2 ? r : r * 0.6;
        s.add(k ? GPGP_PATH_LINE : GPGP_PATH_MOVE, {x + q * std::cos(a), y + q * std::sin(a)});
      }
      s.add(GPGP_PATH_CLOSE, {});
    }
    paint(s, random);
    scene.shapes.push_back(s);
  }
  return scene;
}

Scene botanical() {
  Scene scene{"botanical", {}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(0, 1000), turn(0, 6.28), size(15, 90), tooth(0.7, 1.1);
  constexpr int kTeeth = 23; // on each side
  for (int i = 0; i < 1137; ++i) {
    Shape s;
    const double x = at(random), y = at(random), angle = turn(random), l = size(random);
    const double c = std::cos(angle), d = std::sin(angle);
    const auto to = [&](double u, double v) { return std::array{x + u * c - v * d, y + u * d + v * c}; };
    const auto side = [&](double t) { return 0.35 * l * std::sin(3.14159 * std::pow(t, 0.8)); };
    s.add(GPGP_PATH_MOVE, {x, y});
    for (int half = 0; half < 2; ++half)
      for (int k = 0; k < kTeeth; ++k) {
        const double t0 = k / double(kTeeth), t1 = (k + 1) / double(kTeeth), sign = half ? -1 : 1;
        const double a = half ? 1 - t0 : t0, b = half ? 1 - t1 : t1, out = sign * side((a + b) / 2) * tooth(random);
        const auto c0 = to(l * a, out), c1 = to(l * b, out * 1.15), e = to(l * b, sign * side(b) * 0.9);
        s.add(GPGP_PATH_CUBIC, {c0[0], c0[1], c1[0], c1[1], e[0], e[1]});
      }
    s.add(GPGP_PATH_CLOSE, {});
    paint(s, random);
    scene.shapes.push_back(s);
  }
  return scene;
}

Scene townPlan() {
  Scene scene{"town plan", {}};
  std::mt19937 random(8);
  std::uniform_real_distribution<double> at(0, 1000), size(6, 22), wobble(0.75, 1.05), turn(0, 6.28);
  for (int i = 0; i < 1922; ++i) {
    Shape s;
    if (i < 322) {
      blob(s, at(random), at(random), 2 * size(random), 16, 0.2, random);
    } else if (i < 1522) {
      const double x = at(random), y = at(random), r = size(random), start = turn(random);
      for (int k = 0; k < 14; ++k) {
        const double a = start + k * 0.4487990, q = r * wobble(random);
        s.add(k ? GPGP_PATH_LINE : GPGP_PATH_MOVE, {x + q * std::cos(a), y + q * std::sin(a)});
      }
      s.add(GPGP_PATH_CLOSE, {});
    } else {
      strip(s, at(random), at(random), turn(random), 200, 1.5, 7, random);
    }
    paint(s, random);
    scene.shapes.push_back(s);
  }
  return scene;
}

Scene feather() {
  Scene scene{"feather", {}, 12, 14};
  std::mt19937 random(9);
  std::uniform_real_distribution<double> vary(-0.06, 0.06);
  for (int i = 0; i < 180; ++i) { // barbs on both sides of a quill that bends
    Shape s;
    const double t = (i / 2) / 90.0, sign = i % 2 ? -1 : 1;
    const double x = 6 + 1.2 * std::sin(2.2 * t), y = 12.5 - 11.5 * t, l = 4.6 * std::sqrt(t + 0.02) * (1.15 - t);
    const double tipX = x + sign * l, tipY = y - 0.55 * l + vary(random), w = 0.035;
    s.add(GPGP_PATH_MOVE, {x, y - w});
    s.add(GPGP_PATH_CUBIC, {x + sign * l * 0.4, y - w, x + sign * l * 0.8, tipY + 0.2, tipX, tipY});
    s.add(GPGP_PATH_CUBIC, {x + sign * l * 0.8, tipY + 0.2 + 2 * w, x + sign * l * 0.4, y + w, x, y + w});
    s.add(GPGP_PATH_CLOSE, {});
    scene.shapes.push_back(s);
  }
  return scene;
}

Scene blobs(int paths, int curves) {
  Scene scene{std::to_string(paths) + " x " + std::to_string(curves), {}};
  std::mt19937 random(10);
  std::uniform_real_distribution<double> at(0, 1000);
  const double radius = std::sqrt(0.5e6 / (3.14159 * paths));
  for (int i = 0; i < paths; ++i) {
    Shape s;
    blob(s, at(random), at(random), radius, curves, 0.2, random);
    paint(s, random);
    scene.shapes.push_back(s);
  }
  return scene;
}

namespace {
Scene fromSvg(const std::string& file, std::span<const std::byte> bytes, double arcs) {
  vector::svg::Reporter reporter(nullptr, nullptr, file.c_str());
  auto svg = vector::svg::importSvg(bytes, reporter, {}, {}, {.arcs = arcs});
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
} // namespace

Scene panels(double arcs) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  std::string svg = "<svg xmlns='http://www.w3.org/2000/svg' width='1024' height='1024'>";
  const auto add = [&svg](const char* form, auto... values) {
    char text[300];
    std::snprintf(text, sizeof text, form, values...);
    svg += text;
  };
  const auto color = [&] { return static_cast<unsigned>(random() % 0xffffff); };
  for (int i = 0; i < 16; ++i) { // windows of round corners, with what lies in them
    const int column = i % 4, row = i / 4;
    const double x = 8 + column * 256, y = 8 + row * 256;
    add("<rect x='%g' y='%g' width='240' height='240' rx='12' fill='#%06x'/>", x, y, color());
    add("<rect x='%g' y='%g' width='240' height='28' rx='12' fill='#%06x'/>", x, y, color());
    for (int k = 0; k < 3; ++k) add("<circle cx='%g' cy='%g' r='6' fill='#%06x'/>", x + 16 + 18 * k, y + 14, color());
    for (int k = 0; k < 6; ++k) { // buttons, and switches with their knobs
      const double at = y + 38 + 33 * k;
      add("<rect x='%g' y='%g' width='80' height='26' rx='5' fill='#%06x'/>", x + 10, at, color());
      add("<rect x='%g' y='%g' width='40' height='20' rx='10' fill='#%06x'/>", x + 100, at + 3, color());
      add("<circle cx='%g' cy='%g' r='8' fill='#%06x'/>", x + 100 + (k % 2 ? 10 : 30), at + 13, color());
    }
    double angle = 0; // a pie chart and a gauge
    while (angle < 6.2) {
      const double next = std::min(angle + 0.4 + 1.2 * unit(random), 6.2), cx = x + 192, cy = y + 80, r = 40;
      add("<path d='M%g %gL%g %gA40 40 0 0 1 %g %gZ' fill='#%06x'/>", cx, cy, cx + r * std::cos(angle),
          cy + r * std::sin(angle), cx + r * std::cos(next), cy + r * std::sin(next), color());
      angle = next;
    }
    add("<path d='M%g %ga36 36 0 0 1 72 0h-8a28 28 0 0 0 -56 0z' fill='#%06x'/>", x + 156, y + 200, color());
    add("<path d='M%g %gh60' stroke='#%06x' stroke-width='6' stroke-linecap='round'/>", x + 160, y + 220, color());
  }
  svg += "</svg>";
  return fromSvg("panels", std::as_bytes(std::span(svg)), arcs);
}

Scene sceneOf(const std::string& word, double arcs) {
  const struct {
    const char* word;
    Scene (*make)();
  } made[] = {{"map", streetMap}, {"contours", contourMap}, {"page", page},       {"live", livePage},
              {"drops", drops},   {"embrace", embrace},     {"clipart", clipArt}, {"botanical", botanical},
              {"plan", townPlan}, {"feather", feather}};
  for (const auto& m : made)
    if (word == m.word) return m.make();
  if (word == "panels") return panels(arcs);
  const auto bytes = host::readFile(word);
  return fromSvg(word, std::as_bytes(std::span(bytes)), arcs);
}

void writeSvg(const Scene& scene, const std::string& path) {
  std::string svg;
  char word[160];
  const auto add = [&](const char* format, auto... values) {
    svg.append(word, static_cast<size_t>(std::snprintf(word, sizeof word, format, values...)));
  };
  add("<svg xmlns='http://www.w3.org/2000/svg' width='%g' height='%g'>\n", scene.width, scene.height);
  bool plain = scene.groups.empty();
  for (const Shape& s : scene.shapes) {
    plain = plain && !s.gradient;
    const auto byte = [&](int k) { return static_cast<unsigned>(255 * host::srgbFromLinear(s.color[k]) + 0.5f); };
    add("<path fill='#%02x%02x%02x' fill-opacity='%g' fill-rule='%s' d='", byte(0), byte(1), byte(2),
        static_cast<double>(s.color[3]), s.rule == GPGP_FILL_EVEN_ODD ? "evenodd" : "nonzero");
    const float* p = s.points.data();
    for (const GpgpPathVerb verb : s.verbs) {
      const int pairs = verb == GPGP_PATH_CLOSE ? 0 : verb == GPGP_PATH_CUBIC ? 3 : verb == GPGP_PATH_QUAD ? 2 : 1;
      svg += verb == GPGP_PATH_MOVE ? 'M' : verb == GPGP_PATH_LINE ? 'L' : pairs == 3 ? 'C' : pairs == 2 ? 'Q' : 'Z';
      for (int k = 0; k < 2 * pairs; ++k) add(k ? " %.7g" : "%.7g", static_cast<double>(*p++));
    }
    svg += "'/>\n";
  }
  svg += "</svg>\n";
  std::ofstream file(path, std::ios::binary);
  if (!plain || !(file << svg).flush()) {
    std::fprintf(stderr, "%s: %s\n", path.c_str(), plain ? "cannot be written" : "only plain paths can be written");
    std::exit(1);
  }
}

size_t curvesOf(const Scene& scene) {
  size_t count = 0;
  for (const Shape& s : scene.shapes)
    for (const GpgpPathVerb verb : s.verbs) count += verb != GPGP_PATH_MOVE && verb != GPGP_PATH_CLOSE;
  return count;
}

double cairoTime([[maybe_unused]] const Scene& scene, [[maybe_unused]] uint32_t width, [[maybe_unused]] uint32_t height,
                 [[maybe_unused]] int repeat, [[maybe_unused]] double scale,
                 [[maybe_unused]] std::vector<uint8_t>* pixels) {
#ifdef GPGP_WITH_CAIRO
  cairo_surface_t* surface =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height));
  std::vector<GpgpPath> paths;
  for (const Shape& s : scene.shapes) paths.push_back(s.view());
  std::vector<double> times;
  for (int i = 0; i < repeat; ++i) {
    const auto begin = Clock::now();
    cairo_t* c = cairo_create(surface);
    cairo_set_source_rgb(c, 1, 1, 1);
    cairo_paint(c);
    cairo_scale(c, scale, scale);
    drawWithCairo(c, paths, scene.groups);
    cairo_destroy(c);
    cairo_surface_flush(surface);
    times.push_back(milliseconds(Clock::now() - begin));
  }
  if (pixels)
    for (uint32_t y = 0; y < height; ++y) {
      const uint8_t* row =
          cairo_image_surface_get_data(surface) + size_t(y) * size_t(cairo_image_surface_get_stride(surface));
      pixels->insert(pixels->end(), row, row + size_t(width) * 4);
    }
  cairo_surface_destroy(surface);
  return median(times);
#else
  return 0;
#endif
}

} // namespace gpgp::bench
