// Layers on the canvas: blend modes, masks, clips and filters against closed forms; plans that must not change what is
// drawn; order, budgets and errors.
#include "layers_fixture.h"
#include "ui_fixture.h"

#include <functional>

namespace {
using namespace gpgp;
using namespace gpgp::test;

// ---------------------------------------------------------------- blend modes

/// The specification's formulas, written again.
double channel(int mode, double b, double s) {
  switch (mode) {
  case GPGP_BLEND_MULTIPLY: return b * s;
  case GPGP_BLEND_SCREEN: return b + s - b * s;
  case GPGP_BLEND_OVERLAY: return channel(GPGP_BLEND_HARD_LIGHT, s, b);
  case GPGP_BLEND_DARKEN: return std::min(b, s);
  case GPGP_BLEND_LIGHTEN: return std::max(b, s);
  case GPGP_BLEND_COLOR_DODGE: return b == 0 ? 0 : s == 1 ? 1 : std::min(1.0, b / (1 - s));
  case GPGP_BLEND_COLOR_BURN: return b == 1 ? 1 : s == 0 ? 0 : 1 - std::min(1.0, (1 - b) / s);
  case GPGP_BLEND_HARD_LIGHT: return s <= 0.5 ? b * 2 * s : b + (2 * s - 1) - b * (2 * s - 1);
  case GPGP_BLEND_SOFT_LIGHT: {
    if (s <= 0.5) return b - (1 - 2 * s) * b * (1 - b);
    const double d = b <= 0.25 ? ((16 * b - 12) * b + 4) * b : std::sqrt(b);
    return b + (2 * s - 1) * (d - b);
  }
  case GPGP_BLEND_DIFFERENCE: return std::abs(b - s);
  case GPGP_BLEND_EXCLUSION: return b + s - 2 * b * s;
  default: return s;
  }
}
using Color = std::array<double, 3>;
double lum(const Color& c) { return 0.3 * c[0] + 0.59 * c[1] + 0.11 * c[2]; }
Color setLum(Color c, double l) {
  const double d = l - lum(c);
  for (double& v : c) v += d;
  const double own = lum(c), low = std::min({c[0], c[1], c[2]}), high = std::max({c[0], c[1], c[2]});
  for (double& v : c) {
    if (low < 0) v = own + (v - own) * own / (own - low);
  }
  for (double& v : c)
    if (high > 1) v = own + (v - own) * (1 - own) / (high - own);
  return c;
}
double sat(const Color& c) { return std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]}); }
Color setSat(Color c, double s) {
  std::array<size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](size_t i, size_t k) { return c[i] < c[k]; });
  Color out{};
  if (c[order[2]] > c[order[0]]) {
    out[order[1]] = (c[order[1]] - c[order[0]]) * s / (c[order[2]] - c[order[0]]);
    out[order[2]] = s;
  }
  return out;
}
Color blendOf(int mode, const Color& b, const Color& s) {
  switch (mode) {
  case GPGP_BLEND_HUE: return setLum(setSat(s, sat(b)), lum(b));
  case GPGP_BLEND_SATURATION: return setLum(setSat(b, sat(s)), lum(b));
  case GPGP_BLEND_COLOR: return setLum(s, lum(b));
  case GPGP_BLEND_LUMINOSITY: return setLum(b, lum(s));
  default: {
    Color out{};
    for (size_t k = 0; k < 3; ++k) out[k] = channel(mode, b[k], s[k]);
    return out;
  }
  }
}
std::array<double, 4> mixed(int mode, const std::array<double, 4>& b, const std::array<double, 4>& s) { // straight
  const double ab = b[3], as = s[3];
  if (mode == GPGP_BLEND_PLUS_LIGHTER) {
    std::array<double, 4> out{};
    for (size_t k = 0; k < 3; ++k) out[k] = std::min(1.0, b[k] * ab + s[k] * as);
    out[3] = std::min(1.0, ab + as);
    return out;
  }
  const Color both = blendOf(mode, {b[0], b[1], b[2]}, {s[0], s[1], s[2]});
  std::array<double, 4> out{};
  for (size_t k = 0; k < 3; ++k) out[k] = as * (1 - ab) * s[k] + as * ab * both[k] + (1 - as) * ab * b[k];
  out[3] = as + ab * (1 - as);
  return out;
}

TEST_F(LayersTest, BlendModesAreTheirFormulas) {
  makeLayerCanvas();
  constexpr std::array<float, 4> kBackdrops[] = {
      {0.2f, 0.5f, 0.9f, 1}, {0.7f, 0.1f, 0.3f, 0.6f}, {0, 1, 0.5f, 1}, {0.25f, 0.25f, 0.25f, 0}};
  constexpr std::array<float, 4> kSources[] = {
      {0.8f, 0.3f, 0.1f, 1}, {0.4f, 0.9f, 0.6f, 0.5f}, {1, 0, 0.5f, 1}, {0.5f, 0.5f, 0.5f, 0.25f}};
  for (int mode = GPGP_BLEND_NORMAL; mode <= GPGP_BLEND_PLUS_LIGHTER; ++mode) {
    Scene scene;
    for (int b = 0; b < 4; ++b) scene.add(solid(0, float(b * 16), 64, float(b * 16 + 16), kBackdrops[b]));
    GpgpLayer layer = plainLayer();
    layer.blend = mode;
    const uint32_t group = scene.group(0, 1, &layer);
    for (int s = 0; s < 4; ++s) scene.add(solid(float(s * 16), 0, float(s * 16 + 16), 64, kSources[s]), group);
    const auto pixels = draw(scene, 64);
    for (size_t b = 0; b < 4; ++b)
      for (size_t s = 0; s < 4; ++s) {
        const auto wide = [](const std::array<float, 4>& c) { return std::array<double, 4>{c[0], c[1], c[2], c[3]}; };
        expectNear(pixels[(b * 16 + 8) * 64 + s * 16 + 8], mixed(mode, wide(kBackdrops[b]), wide(kSources[s])), 2e-3,
                   "mode " + std::to_string(mode) + " backdrop " + std::to_string(b) + " source " + std::to_string(s));
      }
  }
}

// ---------------------------------------------------------------- masks, clips, opacity

TEST_F(LayersTest, MasksTakeLuminanceOrAlpha) {
  makeLayerCanvas();
  for (const GpgpMaskKind kind : {GPGP_MASK_LUMINANCE, GPGP_MASK_ALPHA}) {
    Scene scene;
    GpgpLayer layer = plainLayer();
    layer.mask = 2;
    layer.maskKind = kind;
    const uint32_t group = scene.group(0, 0.5f, &layer), mask = scene.group();
    scene.add(solid(0, 0, 64, 64, {0, 0, 1, 1}));
    scene.add(solid(0, 0, 64, 64, {1, 0.5f, 0, 1}), group);
    scene.add(solid(8, 0, 32, 64, {0, 1, 0, 1}), mask);
    scene.add(solid(32, 0, 64, 64, {1, 1, 1, 0.25f}), mask);
    const auto pixels = draw(scene, 64);
    const double left = kind == GPGP_MASK_ALPHA ? 1 : 0.7152, right = 0.25;
    const auto want = [](double m) { return std::array<double, 4>{0.5 * m, 0.25 * m, 1 - 0.5 * m, 1}; };
    expectNear(pixels[32 * 64 + 4], want(0), 1e-3, "outside");
    expectNear(pixels[32 * 64 + 16], want(left), 1e-3, "left");
    expectNear(pixels[32 * 64 + 48], want(right), 1e-3, "right");
  }
}

TEST_F(LayersTest, MaskRegionsAndClipsCutLayers) {
  makeLayerCanvas();
  Scene scene;
  GpgpLayer layer = plainLayer();
  layer.mask = 2;
  layer.maskRegion[0] = 0.125f, layer.maskRegion[1] = 0.25f, layer.maskRegion[2] = 0.5f, layer.maskRegion[3] = 1;
  layer.maskTransform[0] = layer.maskTransform[3] = 64;
  const uint32_t group = scene.group(0, 1, &layer), mask = scene.group();
  scene.clip(group, solid(0, 0, 24.5f, 64));
  scene.add(solid(0, 0, 64, 64, {1, 0, 0, 1}), group);
  scene.add(solid(0, 0, 64, 64, {1, 1, 1, 1}), mask);
  const auto pixels = draw(scene, 64);
  for (uint32_t y = 0; y < 64; ++y)
    for (uint32_t x = 0; x < 64; ++x) {
      const double shown = y < 16 || x < 8 || x > 24 ? 0 : x == 24 ? 0.5 : 1;
      ASSERT_NEAR(pixels[y * 64 + x].a, shown, 2e-3) << x << ", " << y;
    }
}

TEST_F(LayersTest, OpacitiesAreAsDeepAsLayersAre) {
  makeLayerCanvas();
  Scene scene;
  uint32_t group = 0;
  for (int i = 0; i < 12; ++i) group = scene.group(group, 0.9f);
  scene.add(solid(0, 0, 32, 32, {1, 0, 0, 1}), group);
  scene.add(solid(16, 0, 48, 32, {0, 1, 0, 1}), group);
  const auto pixels = draw(scene, 64);
  const double faded = std::pow(0.9, 12);
  expectNear(pixels[8 * 64 + 8], {faded, 0, 0, faded}, 2e-3, "left");
  expectNear(pixels[8 * 64 + 24], {0, faded, 0, faded}, 2e-3, "both");
}

/// Random shapes in random groups, with layers that do nothing around some of them: the same picture.
TEST_F(LayersTest, NeutralLayersChangeNothing) {
  makeLayerCanvas();
  std::mt19937 random(7);
  for (int turn = 0; turn < 6; ++turn) {
    blendSrgb = turn & 1;
    Scene scenes[2]; // without layers, with them
    const auto at = [&](float most) { return std::uniform_real_distribution<float>(0, most)(random); };
    std::vector<uint32_t> open[2] = {{0}, {0}};
    for (int i = 0; i < 24; ++i) {
      const int what = static_cast<int>(at(4));
      if (what == 0 && open[0].size() < 4) {
        const float opacity = at(1) < 0.5f ? 1 : 0.5f + at(0.4f);
        const bool neutral = at(1) < 0.7f, clipped = at(1) < 0.4f;
        const TestPath clip = randomShape(static_cast<uint32_t>(random()), 160);
        for (int k = 0; k < 2; ++k) {
          GpgpLayer layer = k && neutral ? scenes[k].filter({step(GPGP_FILTER_OFFSET)}) : GpgpLayer{};
          open[k].push_back(scenes[k].group(open[k].back(), opacity, layer.filter ? &layer : nullptr));
          if (clipped) scenes[k].clip(open[k].back(), clip);
        }
      } else if (what == 1 && open[0].size() > 1) {
        for (auto& o : open) o.pop_back();
      } else {
        TestPath shape = randomShape(static_cast<uint32_t>(random()), 128);
        shape.color = {at(1), at(1), at(1), 0.4f + at(0.6f)};
        for (int k = 0; k < 2; ++k) scenes[k].add(shape, open[k].back());
      }
    }
    const auto want = draw(scenes[0], 160), got = draw(scenes[1], 160);
    // Where edges of several runs share a pixel, samples are no longer told apart: few pixels, by less than a half.
    size_t apart = 0;
    for (size_t i = 0; i < want.size(); ++i) {
      const float d = std::max({std::abs(want[i].r - got[i].r), std::abs(want[i].g - got[i].g),
                                std::abs(want[i].b - got[i].b), std::abs(want[i].a - got[i].a)});
      ASSERT_LT(d, 0.5f) << turn << ": " << i % 160 << ", " << i / 160;
      apart += d > 0.006f;
    }
    EXPECT_LT(apart, want.size() / 8) << turn;
  }
}

// ---------------------------------------------------------------- filters

TEST_F(LayersTest, ABlurredEdgeIsTheErrorFunction) {
  makeLayerCanvas();
  for (const float deviation : {0.7f, 2.f, 5.f, 9.f, 17.f, 40.f, 100.f})
    for (const bool upright : {false, true}) {
      Scene scene;
      const GpgpLayer layer = scene.filter({step(GPGP_FILTER_GAUSSIAN_BLUR, {deviation, deviation})});
      const uint32_t group = scene.group(0, 1, &layer);
      scene.add(upright ? solid(-3000, -3000, 3000, 100) : solid(-3000, -3000, 100, 3000), group);
      const auto pixels = draw(scene, 200);
      for (uint32_t i = 0; i < 200; ++i) {
        const double want = cumulative((100 - (i + 0.5)) / static_cast<double>(deviation));
        const float got = pixels[upright ? i * 200 + 77 : 77 * 200 + i].a;
        // The narrowest one is summed over whole pixels, which the edge between two of them shows.
        ASSERT_NEAR(got, want, deviation < 1 ? 0.025 : 0.004) << deviation << " at " << i;
      }
    }
}

/// A space that is turned by an angle about a place of the canvas, and boxes in it.
struct TurnedSpace {
  double angle;
  float middle;
  float c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));

  void setFilterSpace(GpgpLayer& layer) const {
    const float transform[6] = {c, s, -s, c, middle, middle};
    std::copy_n(transform, 6, layer.filterTransform);
  }
  TestPath box(float left, float top, float right, float bottom) const {
    const auto corner = [&](float x, float y) { return std::pair(c * x - s * y + middle, s * x + c * y + middle); };
    const auto [x0, y0] = corner(left, top);
    const auto [x1, y1] = corner(right, top);
    const auto [x2, y2] = corner(right, bottom);
    const auto [x3, y3] = corner(left, bottom);
    TestPath path;
    path.move(x0, y0).line(x1, y1).line(x2, y2).line(x3, y3).close();
    path.color = {1, 1, 1, 1};
    return path;
  }
};

/// Turned, the blur of a small square is that of the square in its own space, turned.
TEST_F(LayersTest, ABlurTurnsWithItsSpace) {
  makeLayerCanvas();
  for (const double angle : {0.0, 0.5, 1.5707963267948966, 2.2}) {
    Scene scene;
    GpgpLayer layer = scene.filter({step(GPGP_FILTER_GAUSSIAN_BLUR, {6, 2})});
    const TurnedSpace space{angle, 64};
    space.setFilterSpace(layer);
    scene.add(space.box(-10, -10, 10, 10), scene.group(0, 1, &layer));
    const auto pixels = draw(scene, 128);
    for (int y = 0; y < 128; y += 3)
      for (int x = 0; x < 128; x += 3) {
        const double px = x + 0.5 - 64, py = y + 0.5 - 64, u = std::cos(angle) * px + std::sin(angle) * py,
                     v = -std::sin(angle) * px + std::cos(angle) * py;
        const auto along = [](double at, double d) { return cumulative((at + 10) / d) - cumulative((at - 10) / d); };
        ASSERT_NEAR(pixels[static_cast<size_t>(y * 128 + x)].a, along(u, 6) * along(v, 2), 0.02)
            << angle << " at " << x << ", " << y;
      }
  }
}

/// One deviation small, the other large, in a turned space: many samples, which are taken with strides.
TEST_F(LayersTest, AnUnevenTurnedBlurOfAnEdgeIsTheErrorFunction) {
  makeLayerCanvas();
  for (const float deviation : {15.f, 40.f, 90.f}) {
    Scene scene;
    GpgpLayer layer = scene.filter({step(GPGP_FILTER_GAUSSIAN_BLUR, {0, deviation})});
    const double angle = 0.6;
    const TurnedSpace space{angle, 100};
    space.setFilterSpace(layer);
    // What lies above the line through the middle, along the space's x axis.
    scene.add(space.box(-3000, -3000, 3000, 0), scene.group(0, 1, &layer));
    const auto pixels = draw(scene, 200);
    for (int y = 0; y < 200; y += 5)
      for (int x = 0; x < 200; x += 5) {
        const double v = -std::sin(angle) * (x + 0.5 - 100) + std::cos(angle) * (y + 0.5 - 100);
        ASSERT_NEAR(pixels[static_cast<size_t>(y * 200 + x)].a, cumulative(-v / static_cast<double>(deviation)), 0.02)
            << deviation << " at " << x << ", " << y;
      }
  }
}

/// A radius far beyond the canvas: dilated, all is covered; eroded, nothing is.
TEST_F(LayersTest, MorphologyReachesAsFarAsThereIsSomething) {
  makeLayerCanvas();
  for (const int mode : {0, 1}) {
    Scene scene;
    const GpgpLayer layer = scene.filter({step(GPGP_FILTER_MORPHOLOGY, {9000, 9000}, mode)});
    scene.add(solid(20, 20, 40, 40), scene.group(0, 1, &layer));
    const auto pixels = draw(scene, 64);
    for (const Rgba& p : pixels) ASSERT_NEAR(p.a, mode, 1e-3);
  }
}

TEST_F(LayersTest, ADropShadowLiesBehind) {
  makeLayerCanvas();
  Scene scene;
  GpgpFilterStep shadow = step(GPGP_FILTER_DROP_SHADOW, {3, 3, 10, 5, 0, 0, 1, 0.5f});
  const GpgpLayer layer = scene.filter({shadow});
  const uint32_t group = scene.group(0, 1, &layer);
  scene.add(solid(20, 20, 60, 60, {1, 0, 0, 1}), group);
  const auto pixels = draw(scene, 100);
  for (uint32_t y = 0; y < 100; ++y)
    for (uint32_t x = 0; x < 100; ++x) {
      const auto along = [](double at, double from, double to) {
        return cumulative((at - from) / 3) - cumulative((at - to) / 3);
      };
      const double dark = 0.5 * along(x + 0.5, 30, 70) * along(y + 0.5, 25, 65);
      const bool own = x >= 20 && x < 60 && y >= 20 && y < 60;
      expectNear(pixels[y * 100 + x], own ? std::array<double, 4>{1, 0, 0, 1} : std::array<double, 4>{0, 0, dark, dark},
                 0.004, std::to_string(x) + ", " + std::to_string(y));
    }
}

TEST_F(LayersTest, ColourFiltersAreTheirFormulas) {
  makeLayerCanvas();
  const std::array<double, 4> a{0.8, 0.3, 0.1, 0.5}; // straight
  const auto run = [&](std::vector<GpgpFilterStep> steps) {
    Scene scene;
    const GpgpLayer layer = scene.filter(std::move(steps));
    scene.add(solid(0, 0, 32, 32, {0.8f, 0.3f, 0.1f, 0.5f}), scene.group(0, 1, &layer));
    return draw(scene, 32)[16 * 32 + 16];
  };
  const std::vector<float> matrix = {0.5f, 0.25f, 0, 0, 0.1f, 0, 2,    0, 0.2f, 0,
                                     0.3f, 0.3f,  1, 0, 0,    0, 0.1f, 0, 1.2f, 0.05f};
  std::array<double, 4> c{};
  for (size_t row = 0; row < 4; ++row) {
    c[row] = static_cast<double>(matrix[row * 5 + 4]);
    for (size_t k = 0; k < 4; ++k) c[row] += static_cast<double>(matrix[row * 5 + k]) * a[k];
    c[row] = std::clamp(c[row], 0.0, 1.0);
  }
  expectNear(run({step(GPGP_FILTER_COLOR_MATRIX, matrix)}), {c[0] * c[3], c[1] * c[3], c[2] * c[3], c[3]}, 2e-3,
             "matrix");

  std::vector<float> table(1024);
  for (size_t i = 0; i < 256; ++i) {
    const float t = static_cast<float>(i) / 255;
    table[i] = t * t, table[256 + i] = 1 - t, table[512 + i] = t < 0.5f ? 0.25f : 0.75f, table[768 + i] = 0.5f * t;
  }
  GpgpFilterStep transfer = step(GPGP_FILTER_COMPONENT_TRANSFER);
  transfer.table = table.data();
  transfer.tableCount = 1024;
  expectNear(run({transfer}), {0.64 * 0.25, 0.7 * 0.25, 0.25 * 0.25, 0.25}, 2e-3, "transfer");

  const std::array<double, 4> f{0.2, 0.6, 1, 0.4}; // the flood
  const GpgpFilterStep flood = step(GPGP_FILTER_FLOOD, {0.2f, 0.6f, 1, 0.4f});
  const auto multiplied = [](const std::array<double, 4>& s) {
    return std::array<double, 4>{s[0] * s[3], s[1] * s[3], s[2] * s[3], s[3]};
  };
  const auto pa = multiplied(a), pf = multiplied(f);
  const float k[4] = {0.5f, 0.4f, 0.3f, 0.1f};
  for (int mode = GPGP_OPERATOR_OVER; mode <= GPGP_OPERATOR_ARITHMETIC; ++mode) {
    std::array<double, 4> want{};
    for (size_t i = 0; i < 4; ++i) {
      const double s = pa[i], b = pf[i], as = pa[3], ab = pf[3];
      const double forms[] = {
          s + b * (1 - as),
          s * ab,
          s * (1 - ab),
          s * ab + b * (1 - as),
          s * (1 - ab) + b * (1 - as),
          std::min(s + b, 1.0),
          std::clamp(double(k[0]) * s * b + double(k[1]) * s + double(k[2]) * b + double(k[3]), 0.0, 1.0)};
      want[i] = forms[mode];
    }
    for (size_t i = 0; i < 3; ++i) want[i] = std::min(want[i], want[3]);
    expectNear(run({flood, step(GPGP_FILTER_COMPOSITE, {k[0], k[1], k[2], k[3]}, mode, GPGP_FILTER_SOURCE,
                                GPGP_FILTER_FIRST_STEP)}),
               want, 2e-3, "operator " + std::to_string(mode));
  }
  for (int mode = GPGP_BLEND_NORMAL; mode <= GPGP_BLEND_PLUS_LIGHTER; ++mode)
    expectNear(run({flood, step(GPGP_FILTER_BLEND, {}, mode, GPGP_FILTER_SOURCE, GPGP_FILTER_FIRST_STEP)}),
               mixed(mode, f, a), 2e-3, "blend " + std::to_string(mode));
}

// ---------------------------------------------------------------- order, budgets

TEST_F(LayersTest, ItemsComeInOrder) {
  makeLayerCanvas();
  Scene scene, plain;
  const GpgpLayer layer = scene.filter({step(GPGP_FILTER_OFFSET, {4, 0})});
  scene.add(solid(0, 8, 64, 24, {0, 1, 0, 1}), scene.group(0, 1, &layer));
  plain.add(solid(8, 0, 24, 64, {1, 0, 0, 1}));
  const GpgpAsset layered = makeDrawing(scene.paths(), scene.groups), other = makeDrawing(plain.paths());
  std::vector<GpgpCanvasItem> items = {place(other), place(layered), place(other, 1, 20), place(layered, 1, 0, 20),
                                       place(other, 1, 30)};
  const auto pixels = raster(items, 64, 64, 16);
  const auto at = [&](uint32_t x, uint32_t y) { return pixels[y * 64 + x]; };
  expectNear(at(10, 4), {1, 0, 0, 1}, 1e-3, "behind");
  expectNear(at(10, 16), {0, 1, 0, 1}, 1e-3, "the first layer on it");
  expectNear(at(2, 16), {0, 0, 0, 0}, 1e-3, "moved");
  expectNear(at(30, 16), {1, 0, 0, 1}, 1e-3, "in front of the first layer");
  expectNear(at(30, 36), {0, 1, 0, 1}, 1e-3, "the second layer on it");
  expectNear(at(46, 36), {1, 0, 0, 1}, 1e-3, "in front of all");
  gpgpDestroyAsset(layered);
  gpgpDestroyAsset(other);
}

/// Regions of layers lie beside and below the canvas in one picture: what is plain stays out of them.
TEST_F(LayersTest, WhatIsPlainStaysOnTheCanvas) {
  makeLayerCanvas();
  Scene scene, plain, above;
  const GpgpLayer layer = scene.filter({step(GPGP_FILTER_OFFSET, {16, 0})});
  scene.add(solid(4, 4, 12, 12, {0, 1, 0, 1}), scene.group(0, 1, &layer));
  plain.add(solid(-400, -400, 800, 800, {1, 0, 0, 0.5f}));
  above.add(solid(0, -40, 64, -2, {0, 0, 1, 1}));
  const GpgpAsset layered = makeDrawing(scene.paths(), scene.groups), other = makeDrawing(plain.paths()),
                  hidden = makeDrawing(above.paths());
  const auto pixels = raster({place(other), place(layered), place(hidden)}, 64, 64, 16);
  for (uint32_t y = 0; y < 64; ++y)
    for (uint32_t x = 0; x < 64; ++x)
      if (x >= 20 && x < 28 && y >= 4 && y < 12)
        expectNear(pixels[y * 64 + x], {0, 1, 0, 1}, 1e-3, "the layer, moved");
      else
        expectNear(pixels[y * 64 + x], {0.5, 0, 0, 0.5}, 1e-3, std::to_string(x) + ", " + std::to_string(y));
  for (const GpgpAsset asset : {layered, other, hidden}) gpgpDestroyAsset(asset);
}

TEST_F(LayersTest, ClipsOfAListBehindALayerLieWhereTheListLies) {
  makeLayerCanvas();
  Scene scene;
  const GpgpLayer layer = scene.filter({step(GPGP_FILTER_OFFSET, {4, 0})});
  scene.add(solid(20, 20, 40, 40, {0, 1, 0, 1}), scene.group(0, 1, &layer));
  const GpgpAsset layered = makeDrawing(scene.paths(), scene.groups);
  TestList list(context);
  list.clip({2, 2, 62, 62}, {8, 8, 8, 8}).add(rectangle(0, 0, 64, 64, {0, 0, 1, 1})).pop();
  const auto pixels = raster({place(layered), list.item()}, 64, 64, 16);
  expectNear(pixels[32 * 64 + 8], {0, 0, 1, 1}, 1e-3, "inside");
  expectNear(pixels[32 * 64 + 60], {0, 0, 1, 1}, 1e-3, "inside, right");
  expectNear(pixels[3 * 64 + 3], {0, 0, 0, 0}, 1e-3, "beyond the round corner");
  expectNear(pixels[32 * 64 + 1], {0, 0, 0, 0}, 1e-3, "outside");
  gpgpDestroyAsset(layered);
}

/// More regions than one column of the raster holds; the sum of all is what a formula says.
TEST_F(LayersTest, ManyLayersOnOneAnotherFit) {
  layerPixels = 1 << 24;
  operations = 4096;
  drawings = 1024;
  makeLayerCanvas();
  Scene scene;
  GpgpLayer layer = plainLayer();
  layer.blend = GPGP_BLEND_MULTIPLY;
  double want = 1;
  scene.add(solid(0, 0, 256, 256, {1, 1, 1, 1}));
  for (int i = 0; i < 80; ++i) {
    scene.add(solid(0, 0, 256, 256, {0.98f, 0.98f, 0.98f, 1}), scene.group(0, 1, &layer));
    want *= static_cast<double>(0.98f);
  }
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  const auto pixels = draw(scene, 256, &report);
  EXPECT_EQ(report.base.status, GPGP_SUCCESS);
  for (const uint32_t at : {0u, 255u, 128u * 256 + 128, 65535u})
    expectNear(pixels[at], {want, want, want, 1}, 0.01, std::to_string(at));
}

TEST_F(LayersTest, WhatFindsNoRoomIsLeftOutAndCounted) {
  Scene scene, plain;
  const GpgpLayer layer = scene.filter({step(GPGP_FILTER_GAUSSIAN_BLUR, {4, 4})});
  scene.add(solid(0, 8, 64, 24, {0, 1, 0, 1}), scene.group(0, 1, &layer));
  plain.add(solid(8, 0, 24, 64, {1, 0, 0, 1}));
  const GpgpAsset layered = makeDrawing(scene.paths(), scene.groups), other = makeDrawing(plain.paths());
  const std::vector<GpgpCanvasItem> items = {place(other), place(layered), place(other, 1, 30)};
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  makeLayerCanvas();
  const auto whole = raster(items, 64, 64, 16, &report);
  EXPECT_EQ(report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(report.layerPixelsGiven, layerPixels);
  const uint32_t pixels = report.layerPixels, needed = report.layerOperations;
  EXPECT_GT(pixels, 64u * 64);
  struct Case {
    uint32_t pixels, operations;
    bool fits;
  };
  for (const Case& c : {Case{pixels, needed, true}, Case{pixels - 1, needed, false}, Case{pixels, needed - 1, false},
                        Case{1, needed, false}, Case{0, 0, false}}) {
    layerPixels = c.pixels;
    operations = c.operations;
    makeLayerCanvas();
    const auto part = raster(items, 64, 64, 16, &report);
    const std::string what = std::to_string(c.pixels) + " pixels, " + std::to_string(c.operations);
    EXPECT_EQ(report.base.status, c.fits ? GPGP_SUCCESS : GPGP_BUDGET_EXCEEDED) << what;
    EXPECT_EQ(report.layerPixels, pixels) << what;
    EXPECT_EQ(report.layerOperations, needed) << what;
    EXPECT_EQ(report.pathsDropped > 0, !c.fits) << what;
    expectNear(part[50 * 64 + 10], {1, 0, 0, 1}, 1e-3, what);
    expectNear(part[50 * 64 + 40], c.fits ? std::array<double, 4>{1, 0, 0, 1} : std::array<double, 4>{0, 0, 0, 0}, 1e-3,
               what);
    for (size_t i = 0; i < part.size() && c.fits; ++i) ASSERT_EQ(part[i].g, whole[i].g) << what;
  }
  gpgpDestroyAsset(layered);
  gpgpDestroyAsset(other);
}

TEST_F(LayersTest, ListsShowThem) {
  makeLayerCanvas();
  Scene scene;
  const GpgpLayer layer = scene.filter({step(GPGP_FILTER_OFFSET, {4, 0})});
  scene.add(solid(0, 8, 40, 24, {0, 1, 0, 1}), scene.group(0, 1, &layer));
  const GpgpAsset layered = makeDrawing(scene.paths(), scene.groups);
  TestList list(context);
  list.add(rectangle(0, 0, 64, 64, {1, 0, 0, 1})).push({1, 0, 0, 1, 8, 0, 0, 0, 0}).add(layered).pop();
  list.add(rectangle(20, 0, 28, 64, {0, 0, 1, 1}));
  GpgpCanvasItem item = list.item();
  item.scissor[2] = 40, item.scissor[3] = 64;
  const auto pixels = raster({item}, 64, 64, 16);
  const auto at = [&](uint32_t x) { return pixels[16 * 64 + x]; };
  expectNear(at(11), {1, 0, 0, 1}, 1e-3, "before the layer, which is moved by both");
  expectNear(at(13), {0, 1, 0, 1}, 1e-3, "the layer");
  expectNear(at(24), {0, 0, 1, 1}, 1e-3, "in front of it");
  expectNear(at(39), {0, 1, 0, 1}, 1e-3, "up to the scissor");
  expectNear(at(41), {0, 0, 0, 0}, 1e-3, "beyond it");

  list.reset().group(0.5f).add(layered).pop();
  const std::vector<GpgpCanvasItem> items = {list.item()};
  const host::Image image(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = 64, .height = 64});
  const GpgpFrame frame = advance();
  device.submitAndWait([&](VkCommandBuffer commands) {
    GpgpCanvasInfo info = infoOf(items, 64, 64);
    info.target =
        image.target({}, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL});
    EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_ERROR_UNSUPPORTED);
  });
  EXPECT_NE(lastMessage().find("items[0].list, entry 0: its drawing has layers"), std::string::npos) << lastMessage();
  gpgpDestroyAsset(layered);
}

TEST_F(LayersTest, WhatIsWrongIsNamed) {
  const auto refused = [&](const std::function<void(Scene&, GpgpLayer&)>& change, const char* text,
                           GpgpResult result = GPGP_ERROR_INVALID_ARGUMENT) {
    Scene scene;
    GpgpLayer layer = scene.filter({step(GPGP_FILTER_OFFSET), step(GPGP_FILTER_GAUSSIAN_BLUR, {1, 1})});
    change(scene, layer);
    const uint32_t group = scene.group(0, 1, &layer);
    scene.group();
    scene.add(solid(0, 0, 8, 8), group);
    makeDrawing(scene.paths(), scene.groups, result);
    EXPECT_NE(std::string(lastMessage()).find(text), std::string::npos) << text << ", not: " << lastMessage();
  };
  const auto first = [](GpgpLayer& layer) -> GpgpFilterStep& { return const_cast<GpgpFilterStep&>(layer.filter[0]); };
  refused([](Scene&, GpgpLayer& l) { l.blend = 99; }, "groups[0].layer: blend is unknown");
  refused([](Scene&, GpgpLayer& l) { l.mask = 1; }, "groups[0].layer.mask is 1: no later group");
  refused([](Scene&, GpgpLayer& l) { l.mask = 9; }, "groups[0].layer.mask is 9: no later group");
  refused([&](Scene&, GpgpLayer& l) { first(l).kind = 77; }, "groups[0].layer.filter[0]: kind is unknown");
  refused([&](Scene&, GpgpLayer& l) { first(l).input = GPGP_FILTER_FIRST_STEP; },
          "filter[0]: an input is not an earlier");
  refused([&](Scene&, GpgpLayer& l) { first(l).region[0] = NAN; }, "filter[0]: region is not a box");
  refused([&](Scene&, GpgpLayer& l) { first(l).values[0] = INFINITY; }, "filter[0]: values hold a number");
  refused([&](Scene&, GpgpLayer& l) { first(l).group = 1; }, "filter[0].group is 1: no later group");
  refused([](Scene&, GpgpLayer& l) { l.filterTransform[0] = 0; }, "filterTransform has no inverse");

  Scene scene;
  const GpgpLayer layer = scene.filter({step(GPGP_FILTER_OFFSET)});
  scene.add(solid(0, 0, 8, 8), scene.group(0, 1, &layer));
  const std::vector<GpgpPath> paths = scene.paths();
  GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
  info.paths = paths.data();
  info.pathCount = 1;
  info.groups = scene.groups.data();
  info.groupCount = 1;
  GpgpAsset drawing = nullptr;
  const auto unsupported = [&](const char* text) {
    EXPECT_EQ(gpgpCreateDrawing(context, &info, &drawing), GPGP_ERROR_UNSUPPORTED);
    EXPECT_NE(lastMessage().find(text), std::string::npos) << lastMessage();
  };
  info.hitTestable = VK_TRUE;
  unsupported("the drawing has layers: it cannot be hitTestable");
  info.editable = VK_TRUE;
  unsupported("the drawing has layers: it cannot be editable");
  info.editable = info.hitTestable = VK_FALSE;
  info.methods = GPGP_DRAWING_FLATTENED | GPGP_DRAWING_IN_PASS;
  unsupported("the drawing has layers: it cannot be drawn inside a render pass");
}

// ---------------------------------------------------------------- baked

/// A drawing with layers is the same when it is read back; whatever is changed in it is refused or harmless.
TEST(BakedLayers, AreReadOrRefused) {
  Scene scene;
  GpgpLayer layer =
      scene.filter({step(GPGP_FILTER_GAUSSIAN_BLUR, {3, 3}), step(GPGP_FILTER_TURBULENCE, {0.1f, 0.1f, 2})});
  layer.mask = 3;
  layer.blend = GPGP_BLEND_SCREEN;
  const uint32_t outer = scene.group(0, 0.5f), group = scene.group(outer, 1, &layer), mask = scene.group();
  scene.clip(outer, solid(0, 0, 30, 30));
  scene.add(solid(0, 0, 20, 20), outer);
  scene.add(solid(5, 5, 25, 25), group);
  scene.add(solid(0, 0, 15, 15), mask);
  const auto memory = std::pmr::get_default_resource();
  const auto made = vector::makeDrawing(scene.paths(), scene.groups, memory);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->plan.nodes.size(), 2u); // the clipped group is one as well
  std::pmr::vector<std::byte> bytes = vector::bake(*made, memory);
  const auto read = vector::loadBaked(bytes, memory);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(vector::bake(*read, memory), bytes);

  size_t refused = 0;
  for (size_t at = 16; at + 4 <= bytes.size(); at += 4)
    for (const uint32_t value : {0u, 1u, 3u, 0x7fc00000u, 0xffffffffu}) {
      auto changed = bytes;
      std::memcpy(changed.data() + at, &value, 4);
      const uint64_t sum = vector::checksum(std::span(changed).subspan(16));
      std::memcpy(changed.data() + 8, &sum, 8);
      const auto loaded = vector::loadBaked(changed, memory);
      refused += !loaded;
      if (loaded && !loaded->plan.empty()) {
        const std::vector<vector::Box> boxes(loaded->plan.runs.size(), {0, 0, 9, 9});
        vector::boundsOf(loaded->plan, boxes, memory);
      }
    }
  EXPECT_GT(refused, 500u);
}

/// What nothing refers to is refused, so that the size of what is drawn bounds the work of reading.
TEST(BakedLayers, HoldNothingThatIsNotDrawn) {
  Scene scene;
  GpgpLayer layer = scene.filter({step(GPGP_FILTER_GAUSSIAN_BLUR, {3, 3}), step(GPGP_FILTER_TURBULENCE, {0, 0, 2})});
  layer.mask = 2;
  const uint32_t group = scene.group(0, 1, &layer), mask = scene.group();
  scene.add(solid(0, 0, 20, 20), group);
  scene.add(solid(0, 0, 15, 15), mask);
  const auto memory = std::pmr::get_default_resource();
  const auto made = vector::makeDrawing(scene.paths(), scene.groups, memory);
  ASSERT_TRUE(made);
  const auto errorOf = [&](const std::function<void(vector::LayerPlan&)>& change) {
    vector::Drawing changed = *made;
    change(changed.plan);
    const auto loaded = vector::loadBaked(vector::bake(changed, memory), memory);
    return loaded ? std::string() : std::string(loaded.error().text);
  };
  using Plan = vector::LayerPlan;
  EXPECT_EQ(errorOf([](Plan&) {}), "");
  // Steps that no check would see.
  const std::string stray = "baked drawing: a step is in no filter";
  const std::string limits = "baked drawing: its layers are nested too deep, too many, or not in it";
  EXPECT_EQ(errorOf([](Plan& p) { p.steps.push_back(p.steps[0]); }), stray);
  EXPECT_EQ(errorOf([](Plan& p) { p.steps.emplace_back().values[0] = NAN; }), stray);
  EXPECT_EQ(errorOf([](Plan& p) { --p.nodes[0].stepCount; }), stray);
  EXPECT_EQ(errorOf([](Plan& p) { p.nodes.push_back(p.nodes[0]); }),
            "baked drawing: a layer refers to something that does not exist"); // two filters with the same steps
  // Sequences and layers that nothing shows; of runs alone they are counted as well.
  EXPECT_EQ(errorOf([](Plan& p) { p.sequences.push_back(p.sequences[0]); }), limits);
  EXPECT_EQ(errorOf([](Plan& p) {
              p.nodes.push_back(p.nodes[0]);
              p.nodes.back().filtered = p.nodes.back().stepCount = 0;
            }),
            limits);
  const auto runs = [&](size_t count) {
    return errorOf([&](Plan& p) {
      const vector::LayerToken last = p.tokens.back();
      p.sequences[0] = {static_cast<uint32_t>(p.tokens.size()), static_cast<uint32_t>(count)};
      p.tokens.insert(p.tokens.end(), count - 1, {0, 0});
      p.tokens.push_back(last);
    });
  };
  EXPECT_EQ(runs(1000), "");
  EXPECT_EQ(runs(vector::kMaxLayerNodes + 1), limits);
  EXPECT_EQ(errorOf([](Plan& p) { // the mask
              p.sequences[1] = {static_cast<uint32_t>(p.tokens.size()), vector::kMaxLayerNodes + 1};
              p.tokens.insert(p.tokens.end(), vector::kMaxLayerNodes + 1, {0, 0});
            }),
            limits);
}

} // namespace
