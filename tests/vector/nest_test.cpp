// Lists of random pushes in each other, shapes with gradients and images, texts and drawings: every pixel away from
// edges beside what a reader of the calls paints there, one thing after the other, and the hit test beside what lies on
// top.
#include "ui_fixture.h"

#include <functional>

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct Point {
  double x, y;
};
using Inside = std::function<bool(Point)>;

/// Rows of a projective map.
struct Matrix {
  double m[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  static Matrix of(const std::array<float, 9>& t) {
    const double last = t[6] == 0 && t[7] == 0 && t[8] == 0 ? 1 : static_cast<double>(t[8]);
    return {{{t[0], t[2], t[4]}, {t[1], t[3], t[5]}, {t[6], t[7], last}}};
  }
  Matrix operator*(const Matrix& b) const {
    Matrix c;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) c.m[i][k] = m[i][0] * b.m[0][k] + m[i][1] * b.m[1][k] + m[i][2] * b.m[2][k];
    return c;
  }
  /// What this takes to p; false: nothing before the eye.
  bool back(Point p, Point& from) const {
    double c[3]; // by Cramer's rule, of (u, v, 1) / w
    const auto det = [](const double(&a)[3][3]) {
      return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
             a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    };
    const double whole = det(m), right[3] = {p.x, p.y, 1};
    for (int k = 0; k < 3; ++k) {
      double with[3][3];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) with[i][j] = j == k ? right[i] : m[i][j];
      c[k] = det(with) / whole;
    }
    from = {c[0] / c[2], c[1] / c[2]};
    return c[2] > 0;
  }
};

struct Bound { ///< an edge in a space
  Matrix map;
  Inside inside;
  bool at(Point p) const {
    Point local{};
    return map.back(p, local) && inside(local);
  }
};

struct Step {
  enum { paint, begin, end } what = paint;
  std::vector<size_t> bounds;       ///< clips, and the shape's own
  std::function<Rgba(Point)> color; ///< premultiplied, with opacity; of a point of the canvas
  float opacity = 1;                ///< of a group
  uint64_t id = 0;
};

struct Reader {
  std::vector<Bound> bounds;
  std::vector<Step> steps;

  /// Where no edge is within a pixel and a half; what is painted, and the topmost id.
  bool read(Point p, Rgba& color, uint64_t& top) const {
    std::vector<bool> in(bounds.size());
    for (size_t i = 0; i < bounds.size(); ++i) {
      in[i] = bounds[i].at(p);
      for (int k = 0; k < 49; ++k)
        if (bounds[i].at({p.x + (k % 7 - 3) * 0.5, p.y + (k / 7 - 3) * 0.5}) != in[i]) return false;
    }
    std::vector<Rgba> layers(1);
    top = GPGP_ID_NOT_HIT;
    const auto over = [&layers](const Rgba& c) {
      Rgba& to = layers.back();
      to = {c.r + to.r * (1 - c.a), c.g + to.g * (1 - c.a), c.b + to.b * (1 - c.a), c.a + to.a * (1 - c.a)};
    };
    for (const Step& step : steps) {
      if (step.what == Step::begin) layers.emplace_back();
      if (step.what == Step::end) {
        const Rgba c = layers.back();
        layers.pop_back();
        over({c.r * step.opacity, c.g * step.opacity, c.b * step.opacity, c.a * step.opacity});
      }
      if (step.what != Step::paint ||
          !std::all_of(step.bounds.begin(), step.bounds.end(), [&](size_t i) { return in[i]; }))
        continue;
      over(step.color(p));
      if (step.id != GPGP_ID_NOT_HIT) top = step.id;
    }
    color = layers.back();
    return true;
  }
};

/// A list and its reader, filled by the same calls.
struct Nest {
  TestList& list;
  Reader reader;
  struct State {
    Matrix map;
    std::vector<size_t> clips;
    float opacity = 1, group = -1; ///< group: of the one that this push began
    size_t groups = 0;
  };
  std::vector<State> stack = {{}};
  State& now() { return stack.back(); }

  void push(const std::array<float, 9>& t) {
    list.push(t);
    stack.push_back(now());
    now().group = -1;
    now().map = now().map * Matrix::of(t);
  }
  void clip(const GpgpListShape& s) {
    list.clip({s.box[0], s.box[1], s.box[2], s.box[3]}, {s.radii[0], s.radii[1], s.radii[2], s.radii[3]});
    stack.push_back(now());
    now().group = -1;
    now().clips.push_back(add([s](Point p) { return inShape(s, p.x, p.y); }));
  }
  void fade(float opacity) {
    list.fade(opacity);
    stack.push_back(now());
    now().group = -1;
    now().opacity *= opacity;
  }
  void group(float opacity) {
    list.group(opacity);
    stack.push_back(now());
    now().group = opacity * now().opacity;
    now().opacity = 1;
    ++now().groups;
    reader.steps.push_back({Step::begin, {}, {}, 1, 0});
  }
  void pop() {
    list.pop();
    if (now().group >= 0) reader.steps.push_back({Step::end, {}, {}, now().group, 0});
    stack.pop_back();
  }
  size_t add(Inside inside) {
    reader.bounds.push_back({now().map, std::move(inside)});
    return reader.bounds.size() - 1;
  }
  /// color: straight, of a point of the space.
  void paint(Inside inside, std::function<std::array<float, 4>(Point)> color, uint64_t id) {
    std::vector<size_t> bounds = now().clips;
    bounds.push_back(add(std::move(inside)));
    const auto placed = [map = now().map, opacity = now().opacity, color = std::move(color)](Point p) {
      Point local{};
      map.back(p, local);
      const std::array<float, 4> c = color(local);
      const float a = c[3] * opacity;
      return Rgba{c[0] * a, c[1] * a, c[2] * a, a};
    };
    reader.steps.push_back({Step::paint, std::move(bounds), placed, 1, id});
  }
};

TEST_F(CanvasTest, RandomNestsAreWhatTheirCallsSay) {
  makeCanvas(128);
  // A glyph of two paths: a square in the text's colour at half its alpha, and a smaller one in its own on top.
  TestPath outer = rectanglePath(0, -0.75f, 0.75f, 0), inner = rectanglePath(0.25f, -0.5f, 0.5f, -0.25f);
  outer.color = {0, 0, 0, 0.5f};
  inner.color = {0.25f, 1, 0.5f, 0.75f};
  const GpgpPath glyphPaths[] = {outer.view(), inner.view()};
  const VkBool32 foreground[] = {VK_TRUE, VK_FALSE};
  const GpgpGlyph glyph{1, glyphPaths, 2, foreground};
  const GpgpGlyphSetCreateInfo setInfo = GPGP_GLYPH_SET_CREATE_INFO_INIT;
  GpgpAsset set = nullptr;
  uint32_t index = 0;
  ASSERT_EQ(gpgpCreateGlyphSet(context, &setInfo, &set), GPGP_SUCCESS);
  ASSERT_EQ(gpgpAddGlyphs(set, &glyph, 1, &index), GPGP_SUCCESS);
  // A drawing: two squares that overlap in a group of their own.
  TestPath a = rectanglePath(0, 0, 20, 20), b = rectanglePath(10, 10, 30, 30);
  a.color = {1, 0.5f, 0, 1};
  b.color = {0, 0.5f, 1, 0.5f};
  GpgpPath paths[] = {a.view(), b.view()};
  paths[0].group = paths[1].group = 1;
  const GpgpPathGroup group{0, 0.5f, nullptr, 0};
  GpgpDrawingCreateInfo drawingInfo = GPGP_DRAWING_CREATE_INFO_INIT;
  drawingInfo.paths = paths;
  drawingInfo.pathCount = 2;
  drawingInfo.groups = &group;
  drawingInfo.groupCount = 1;
  drawingInfo.hitTestable = VK_TRUE;
  GpgpAsset drawing = nullptr;
  ASSERT_EQ(gpgpCreateDrawing(context, &drawingInfo, &drawing), GPGP_SUCCESS) << lastMessage();
  // An image of four colours, one of them translucent.
  const std::array<uint32_t, 4> texels = {0xff0000ff, 0xff00ff00, 0xffff0000, 0x80ffffff};
  const Texture texture(device, 2, 2, texels, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  images = {texture.view()};

  std::mt19937 random(41);
  const auto upTo = [&](uint32_t n) { return static_cast<uint32_t>(random() % n); };
  const auto between = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(upTo(1u << 20)) / static_cast<float>(1u << 20);
  };
  const auto inRectangle = [](double l, double t, double r, double bottom) {
    return [=](Point p) { return p.x >= l && p.x <= r && p.y >= t && p.y <= bottom; };
  };
  TestList list(context);
  size_t compared = 0, painted = 0, hits = 0;
  for (uint32_t round = 0; round < 32; ++round) {
    exactArea = round % 2 != 0;
    list.reset();
    Nest nest{list, {}};
    for (uint32_t entries = 0; entries < 30;) {
      const bool deeper = nest.stack.size() < 9;
      const uint64_t id = upTo(5) ? 1000 + entries : GPGP_ID_NOT_HIT;
      const float x = between(-10, 90), y = between(-10, 80), w = between(8, 60), h = between(8, 60);
      GpgpListShape shape = rectangle(x, y, x + w, y + h, {between(0, 1), between(0, 1), between(0, 1), 1});
      shape.color[3] = upTo(2) ? 1 : between(0, 1);
      shape.id = id;
      switch (upTo(16)) {
      case 0:
        if (deeper) nest.push(turned(between(0, 360), between(0.6f, 1.5f), between(20, 60), between(20, 60)));
        continue;
      case 1:
        if (deeper) nest.push({0.9f, 0, 0, 0.9f, between(-5, 10), between(-5, 10)});
        continue;
      case 2:
        if (deeper && upTo(3) == 0)
          nest.push({1, 0, 0.2f, 1, 0, 0, between(0, 0.004f), between(0, 0.004f), 0.9f});
        else if (deeper)
          nest.push({-1, 0, 0, 1.25f, 90, -5});
        continue;
      case 3:
        if (deeper) nest.clip(rectangle(x - 10, y - 10, x + 60, y + 60));
        continue;
      case 4:
        if (deeper) nest.clip(rounded(rectangle(x - 10, y - 10, x + 60, y + 60), 5, 10, 20, 0));
        continue;
      case 5:
        if (deeper) nest.fade(between(0, 1));
        continue;
      case 6:
        if (deeper && nest.now().groups < GPGP_MAX_OPACITY_DEPTH - 1) nest.group(upTo(6) ? between(0, 1) : 1);
        continue;
      case 7:
      case 8:
        if (nest.stack.size() > 1) nest.pop();
        continue;
      case 9: shape = rounded(shape, 4, 8, 2, 6, upTo(2) ? 3.0f : 0.0f); break;
      case 10: shape = ellipse(shape, upTo(2) ? 3.0f : 0.0f); break;
      case 11: {
        const GpgpListShape from = shape;
        shape = line(x, y, x + h, y + w, 5, static_cast<GpgpCap>(upTo(3)));
        std::copy_n(from.color, 4, shape.color);
        shape.id = id;
        break;
      }
      case 12: { // a text of two glyphs
        const std::array<float, 4> c = {shape.color[0], shape.color[1], shape.color[2], shape.color[3]};
        std::vector<GpgpGlyphInstance> glyphs;
        for (const float left : {x, x + w * 0.5f}) glyphs.push_back({index, left, y + h, w, {c[0], c[1], c[2], c[3]}});
        list.add(set, glyphs, id);
        for (const GpgpGlyphInstance& g : glyphs) {
          const double l = g.x, base = g.y, s = g.size;
          nest.paint(
              inRectangle(l, base - 0.75 * s, l + 0.75 * s, base),
              [c](Point) {
                return std::array{c[0], c[1], c[2], c[3] * 0.5f};
              },
              id);
          nest.paint(
              inRectangle(l + 0.25 * s, base - 0.5 * s, l + 0.5 * s, base - 0.25 * s),
              [c](Point) {
                return std::array{0.25f, 1.0f, 0.5f, c[3] * 0.75f};
              },
              id);
        }
        ++entries;
        continue;
      }
      case 13: {
        if (nest.now().groups >= GPGP_MAX_OPACITY_DEPTH - 1) continue;
        nest.push({1, 0, 0, 1, x, y});
        list.add(drawing, id);
        nest.reader.steps.push_back({Step::begin, {}, {}, 1, 0});
        nest.paint(
            inRectangle(0, 0, 20, 20),
            [](Point) {
              return std::array{1.0f, 0.5f, 0.0f, 1.0f};
            },
            id);
        nest.paint(
            inRectangle(10, 10, 30, 30),
            [](Point) {
              return std::array{0.0f, 0.5f, 1.0f, 0.5f};
            },
            id);
        nest.reader.steps.push_back({Step::end, {}, {}, 0.5f, 0});
        nest.pop();
        ++entries;
        continue;
      }
      default: break;
      }
      GpgpGradientStop stops[2] = {{0, {1, 0, 0, 1}}, {1, {0, 0.5f, 1, 0.25f}}};
      GpgpGradient gradient{
          GPGP_GRADIENT_LINEAR, GPGP_SPREAD_PAD, {1, 0, 0, 1, 0, 0}, {x, y}, {x + w, y}, 0, 0, stops, 2, VK_FALSE};
      GpgpListImage image{0, {0, 0, 1, 1}, {}, {}};
      const uint32_t filled = upTo(4);
      const std::array<float, 4> c = {shape.color[0], shape.color[1], shape.color[2], shape.color[3]};
      std::function<std::array<float, 4>(Point)> color = [c](Point) { return c; };
      if (filled == 1) {
        shape.gradient = &gradient;
        color = [c, x, w](Point p) {
          const float t =
              std::clamp(static_cast<float>((p.x - static_cast<double>(x)) / static_cast<double>(w)), 0.0f, 1.0f);
          const std::array<float, 4> mixed = {1 - t, 0.5f * t, t, 1 - 0.75f * t};
          return std::array{c[0] * mixed[0], c[1] * mixed[1], c[2] * mixed[2], c[3] * mixed[3]};
        };
      } else if (filled == 2 && shape.kind != GPGP_LIST_LINE) {
        shape.image = &image;
        const double middleX = x + 0.5 * w, middleY = y + 0.5 * h;
        nest.add([middleX](Point p) { return p.x < middleX; }); // edges, though of no shape
        nest.add([middleY](Point p) { return p.y < middleY; });
        color = [c, middleX, middleY, texels](Point p) {
          const uint32_t texel = texels[(p.y < middleY ? 0 : 2) + (p.x < middleX ? 0 : 1)];
          std::array<float, 4> from{};
          for (uint32_t k = 0; k < 4; ++k) from[k] = c[k] * static_cast<float>(texel >> 8 * k & 255) / 255;
          return from;
        };
      }
      list.add(shape);
      GpgpListShape plain = shape;
      plain.gradient = nullptr, plain.image = nullptr;
      nest.paint([plain](Point p) { return inShape(plain, p.x, p.y); }, std::move(color), id);
      ++entries;
    }
    while (nest.stack.size() > 1) nest.pop();
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    const auto pixels = raster({list.item()}, 100, 90, 16, &report);
    ASSERT_EQ(report.base.status, GPGP_SUCCESS) << "round " << round;
    show(("nest" + std::to_string(round)).c_str(), pixels, 100, 90);
    for (uint32_t i = 0; i < 100 * 90; ++i) {
      const Point p{i % 100 + 0.5, i / 100 + 0.5};
      Rgba color;
      uint64_t top = 0;
      if (!nest.reader.read(p, color, top)) continue;
      ++compared;
      painted += color.a > 0;
      const float off = std::max({std::abs(pixels[i].r - color.r), std::abs(pixels[i].g - color.g),
                                  std::abs(pixels[i].b - color.b), std::abs(pixels[i].a - color.a)});
      ASSERT_LT(off, 0.01f) << "round " << round << ", pixel " << p.x << ", " << p.y << ": " << pixels[i].r << ' '
                            << pixels[i].g << ' ' << pixels[i].b << ' ' << pixels[i].a << ", not " << color.r << ' '
                            << color.g << ' ' << color.b << ' ' << color.a;
      if (i % 7) continue;
      const GpgpHit hit = hitAt(context, {list.item()}, static_cast<float>(p.x), static_cast<float>(p.y));
      ASSERT_EQ(hit.item == GPGP_HIT_NONE ? GPGP_ID_NOT_HIT : hit.id, top)
          << "round " << round << ", " << p.x << ' ' << p.y;
      hits += hit.item != GPGP_HIT_NONE;
    }
  }
  std::printf("%zu pixels compared, %zu painted, %zu hits\n", compared, painted, hits);
  EXPECT_GT(painted, 15000u);
  EXPECT_GT(hits, 1500u);
}
} // namespace
