// What gpgp::rmlui_list makes of RmlUi's calls, without RmlUi: against a renderer of the plainest kind, which keeps
// each layer as an image and does every call at once.
#include "text_mesh.h"
#include "writer.h"

#include "stage.h"
#include <gpgp/gpgp.hpp>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

namespace {

using namespace gpgp;
using namespace gpgp::rmlui;
constexpr int kSide = 48;

using Color = std::array<float, 4>; // premultiplied, sRGB

struct Image {
  std::vector<Color> pixels = std::vector<Color>(size_t{kSide} * kSide, Color{});
  Color& at(int x, int y) { return pixels[size_t(y) * kSide + size_t(x)]; }
  Color get(int x, int y) const {
    return x < 0 || y < 0 || x >= kSide || y >= kSide ? Color{} : pixels[size_t(y) * kSide + size_t(x)];
  }
};

/// Corners at whole numbers.
GeometryPointer boxes(const std::vector<Box>& all, const std::array<uint8_t, 4>& color) {
  auto made = std::make_shared<Geometry>();
  for (const Box& box : all) {
    const auto first = static_cast<uint32_t>(made->vertices.size());
    for (int corner = 0; corner < 4; ++corner)
      made->vertices.push_back({box[corner == 1 || corner == 2 ? 2 : 0],
                                box[corner < 2 ? 1 : 3],
                                {color[0], color[1], color[2], color[3]},
                                0,
                                0});
    for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) made->indices.push_back(first + corner);
  }
  made->shape = findShape(made->vertices, made->indices);
  return made;
}

/// Every call at once.
struct Immediate {
  std::vector<Image> layers{1};
  std::optional<Box> scissor;
  std::vector<bool> stencil = std::vector<bool>(size_t{kSide} * kSide, true);
  bool clipped = false;
  Transform transform;

  bool inScissor(int x, int y) const {
    const float cx = float(x) + 0.5f, cy = float(y) + 0.5f;
    return !scissor || (cx > (*scissor)[0] && cy > (*scissor)[1] && cx < (*scissor)[2] && cy < (*scissor)[3]);
  }
  bool shows(int x, int y) const { return inScissor(x, y) && (!clipped || stencil[size_t(y) * kSide + size_t(x)]); }

  /// Whether a pixel's middle lies in one of the boxes, which are moved and then transformed.
  bool covers(const Geometry& geometry, float dx, float dy, int x, int y) const {
    const auto& m = transform.map;
    for (size_t i = 0; i < geometry.vertices.size(); i += 4) {
      const GpgpListVertex &a = geometry.vertices[i], &c = geometry.vertices[i + 2];
      const float ax = a.x + dx, ay = a.y + dy, cx = c.x + dx, cy = c.y + dy;
      const float x0 = m[0] * ax + m[2] * ay + m[4], y0 = m[1] * ax + m[3] * ay + m[5];
      const float x1 = m[0] * cx + m[2] * cy + m[4], y1 = m[1] * cx + m[3] * cy + m[5];
      const float px = float(x) + 0.5f, py = float(y) + 0.5f;
      if (px > std::min(x0, x1) && px < std::max(x0, x1) && py > std::min(y0, y1) && py < std::max(y0, y1)) return true;
    }
    return false;
  }
  static void over(Color& below, const Color& above) {
    for (size_t c = 0; c < 4; ++c) below[c] = above[c] + below[c] * (1 - above[3]);
  }
  template <class Do> static void each(Do&& action) {
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) action(x, y);
  }
  void draw(const Geometry& geometry, float dx, float dy) {
    each([&](int x, int y) {
      if (!shows(x, y) || !covers(geometry, dx, dy, x, y)) return;
      const uint8_t* from = geometry.vertices[0].color;
      over(layers.back().at(x, y),
           {float(from[0]) / 255, float(from[1]) / 255, float(from[2]) / 255, float(from[3]) / 255});
    });
  }
  void clip(ClipOperation operation, const Geometry& geometry, float dx, float dy) {
    each([&](int x, int y) {
      const bool in = covers(geometry, dx, dy, x, y);
      const size_t i = size_t(y) * kSide + size_t(x);
      stencil[i] = operation == ClipOperation::set          ? in
                   : operation == ClipOperation::setInverse ? !in
                                                            : stencil[i] && in;
    });
    clipped = true;
  }
  Image cut(const Image& image) const {
    Image made;
    each([&](int x, int y) {
      if (inScissor(x, y)) made.at(x, y) = image.get(x, y);
    });
    return made;
  }
  Image filtered(const Image& image, const Filter& filter, const Image& mask) const {
    Image made;
    each([&](int x, int y) {
      const Color c = image.get(x, y);
      Color& to = made.at(x, y);
      if (filter.kind == Filter::Kind::opacity || filter.kind == Filter::Kind::mask) {
        const float factor = filter.kind == Filter::Kind::opacity ? filter.opacity : mask.get(x, y)[3];
        for (size_t i = 0; i < 4; ++i) to[i] = c[i] * factor;
      } else if (filter.step.kind == GPGP_FILTER_COLOR_MATRIX) {
        for (size_t i = 0; i < 3 && c[3] > 0; ++i) {
          float sum = filter.step.values[i * 5 + 4];
          for (size_t k = 0; k < 3; ++k) sum += filter.step.values[i * 5 + k] * c[k] / c[3];
          to[i] = std::clamp(sum, 0.0f, 1.0f) * c[3];
        }
        to[3] = c[3];
      } else { // a shadow without blur, black
        const float* v = filter.step.values;
        to = c;
        Color shadow{0, 0, 0, image.get(x - int(v[2]), y - int(v[3]))[3] * v[7]};
        over(shadow, c);
        to = shadow;
      }
    });
    return cut(made);
  }
  void composite(size_t source, size_t destination, bool replace, const std::vector<FilterPointer>& filters,
                 const std::vector<Image>& masks) {
    Image image = cut(layers[source]);
    for (size_t i = 0; i < filters.size(); ++i) image = filtered(image, *filters[i], masks[i]);
    each([&](int x, int y) {
      if (!shows(x, y)) return;
      if (replace)
        layers[destination].at(x, y) = image.get(x, y);
      else
        over(layers[destination].at(x, y), image.get(x, y));
    });
  }
};

struct NoPainter final : Painter {
  std::vector<std::string> named;
  uint32_t image(const Texture&) override { return GPGP_IMAGE_NONE; }
  GpgpResult text(List&, const Geometry&, float, float, const TextStyle&) override { return GPGP_SUCCESS; }
  void unsupported(const char* what) override { named.emplace_back(what); }
};

/// Shared by all tests: its pipelines take long.
struct Canvases {
  test::Stage stage{VK_FORMAT_R8G8B8A8_UNORM, kSide, kSide, VK_IMAGE_USAGE_STORAGE_BIT};
  Canvas canvas;
  List list;

  Canvases() {
    auto info = init<GpgpCanvasCreateInfo>();
    info.base.queueFamily = stage.device.family;
    info.maxWidth = info.maxHeight = kSide;
    info.maxDrawings = 4096;
    info.maxShapes = 8192;
    info.maxLayerPixels = 1u << 21;
    info.maxLayerOperations = 4096;
    info.targets = GPGP_CANVAS_TARGET_RGBA8;
    canvas = *Canvas::create(stage.context, info);
    EXPECT_EQ(canvas.prewarm(), GPGP_SUCCESS);
    list = *List::create(stage.context);
  }
  std::vector<uint8_t> draw(const Contents& contents, NoPainter& painter) {
    list.clear();
    Writer writer(list, painter);
    EXPECT_EQ(writer.write(contents, {0, 0, kSide, kSide}), GPGP_SUCCESS) << last();
    VkCommandBuffer commands = stage.frames.begin();
    EXPECT_EQ(stage.context.advance(stage.frames.number()), GPGP_SUCCESS);
    GpgpCanvasItem item = GPGP_CANVAS_ITEM_INIT;
    item.list = list;
    auto info = init<GpgpCanvasInfo>();
    info.width = info.height = kSide;
    info.items = &item;
    info.itemCount = 1;
    info.blendSrgb = info.encodeSrgb = VK_TRUE;
    info.target = {stage.image,
                   stage.view,
                   stage.format,
                   0,
                   0,
                   kSide,
                   kSide,
                   {VK_PIPELINE_STAGE_2_COPY_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED},
                   {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}};
    EXPECT_EQ(canvas.recordPrepare(commands, stage.frames.number(), info), GPGP_SUCCESS) << last();
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {kSide, kSide, 1};
    vkCmdCopyImageToBuffer(commands, stage.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, stage.buffer, 1, &copy);
    stage.frames.submit();
    stage.frames.finish();
    EXPECT_EQ(stage.context.advance(stage.frames.number()), GPGP_SUCCESS);
    const Result<GpgpCanvasReport> report = canvas.report();
    EXPECT_TRUE(report) << "no report";
    if (report) {
      EXPECT_EQ(report->base.status, GPGP_SUCCESS);
    }
    const auto* from = static_cast<const uint8_t*>(stage.mapped);
    return {from, from + size_t{kSide} * kSide * 4};
  }
  std::string last() const { return stage.messages.empty() ? "" : stage.messages.back(); }
};

std::unique_ptr<Canvases> shared;

struct RmlUiList : testing::Test {
  CallRecorder recorder;
  NoPainter painter;
  void SetUp() override { recorder.begin(); }
  std::vector<uint8_t> draw() { return shared->draw(recorder.base(), painter); }
};

/// The largest difference of any pixel, in 1/255, and where it is.
float worst(const std::vector<uint8_t>& pixels, const Image& wanted, std::string& where) {
  float most = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      for (size_t c = 0; c < 4; ++c) {
        const float off = std::abs(float(pixels[(size_t(y) * kSide + size_t(x)) * 4 + c]) - 255 * wanted.get(x, y)[c]);
        if (off <= most) continue;
        most = off;
        where = std::to_string(x) + " " + std::to_string(y) + " channel " + std::to_string(c);
      }
  return most;
}

FilterPointer makeStep(GpgpFilterKind kind, std::initializer_list<float> values) {
  auto filter = std::make_shared<Filter>();
  filter->step.kind = kind;
  std::copy(values.begin(), values.end(), filter->step.values);
  return filter;
}

/// A random stream of calls, to both.
struct Stream {
  std::mt19937 random;
  CallRecorder& recorder;
  Immediate immediate;
  int composites = 0;

  int upTo(int n) { return static_cast<int>(random() % static_cast<uint32_t>(n)); }
  Box box() {
    const int x = upTo(40), y = upTo(40);
    return {float(x), float(y), float(x + 4 + upTo(30)), float(y + 4 + upTo(30))};
  }
  std::array<uint8_t, 4> color() {
    const int alpha = upTo(3) == 0 ? 255 : 60 + upTo(160);
    std::array<uint8_t, 4> made{};
    for (size_t c = 0; c < 3; ++c) made[c] = static_cast<uint8_t>(upTo(alpha + 1));
    made[3] = static_cast<uint8_t>(alpha);
    return made;
  }
  GeometryPointer shape() {
    if (upTo(2) == 0) return boxes({box()}, color());
    const float x = float(upTo(20)), y = float(upTo(20)); // an L, which no clip of a list is
    return boxes({{x, y, x + 8, y + 24}, {x + 8, y + 16, x + 24, y + 24}}, color());
  }
  void filters(std::vector<FilterPointer>& made, std::vector<Image>& masks) {
    for (int i = upTo(3); i > 0; --i) {
      masks.emplace_back();
      switch (upTo(4)) {
      case 0: {
        auto opacity = std::make_shared<Filter>();
        opacity->kind = Filter::Kind::opacity;
        opacity->opacity = float(1 + upTo(4)) / 4;
        made.push_back(opacity);
        break;
      }
      case 1:
        made.push_back(makeStep(GPGP_FILTER_COLOR_MATRIX,
                                {-1, 0, 0, 0, 1, 0, 0.5f, 0, 0, 0.25f, 0, 0.5f, 0.5f, 0, 0, 0, 0, 0, 1, 0}));
        break;
      case 2:
        made.push_back(
            makeStep(GPGP_FILTER_DROP_SHADOW, {0, 0, float(upTo(9) - 4), float(upTo(9) - 4), 0, 0, 0, 0.5f}));
        break;
      default: {
        auto mask = std::make_shared<Filter>();
        mask->kind = Filter::Kind::mask;
        mask->mask = recorder.top();
        masks.back() = immediate.cut(immediate.layers.back());
        made.push_back(mask);
      }
      }
    }
  }
  void step() {
    const int n = static_cast<int>(immediate.layers.size());
    switch (upTo(12)) {
    case 0: {
      immediate.scissor = upTo(3) == 0 ? std::nullopt : std::optional<Box>(box());
      recorder.setScissor(immediate.scissor);
      break;
    }
    case 1:
    case 2: {
      const GeometryPointer geometry = shape();
      const auto operation = static_cast<ClipOperation>(upTo(3));
      const float dx = float(upTo(5)), dy = float(upTo(5));
      immediate.clip(operation, *geometry, dx, dy);
      recorder.clip(operation, geometry, dx, dy);
      break;
    }
    case 3:
      immediate.clipped = false;
      recorder.enableClip(false);
      break;
    case 4: {
      const Transform all[] = {Transform{}, Transform{{1, 0, 0, 1, 7, -3}}, Transform{{2, 0, 0, 2, -20, -9}},
                               Transform{{0, 1, -1, 0, 45, 2}}, Transform{{-1, 0, 0, 1, 44, 0}}};
      immediate.transform = all[upTo(5)];
      recorder.setTransform(&immediate.transform);
      break;
    }
    case 5:
      if (n > 4) break;
      EXPECT_EQ(recorder.pushLayer(), immediate.layers.size());
      immediate.layers.emplace_back();
      break;
    case 6:
    case 7: {
      if (composites == 5) break;
      ++composites;
      std::vector<FilterPointer> made;
      std::vector<Image> masks;
      filters(made, masks);
      const bool replace = !immediate.clipped && upTo(4) == 0;
      const auto from = static_cast<size_t>(upTo(n)), to = static_cast<size_t>(upTo(n));
      EXPECT_TRUE(recorder.composite(from, to, replace, made));
      immediate.composite(from, to, replace, made, masks);
      break;
    }
    case 8:
      EXPECT_EQ(recorder.popLayer(), n > 1);
      if (n > 1) immediate.layers.pop_back();
      break;
    default: {
      const GeometryPointer geometry = shape();
      const float dx = float(upTo(5)), dy = float(upTo(5));
      immediate.draw(*geometry, dx, dy);
      recorder.draw(geometry, dx, dy, nullptr);
    }
    }
  }
};

TEST_F(RmlUiList, StreamsOfCallsAreWhatDoingThemAtOnceIs) {
  int shown = 0;
  for (uint32_t seed = 0; seed < 120; ++seed) {
    recorder.begin();
    Stream stream{std::mt19937(seed), recorder, {}};
    for (int i = 0; i < 40; ++i) stream.step();
    std::string where;
    const auto pixels = draw();
    const float off = worst(pixels, stream.immediate.layers[0], where);
    EXPECT_LE(off, 2.6f) << "seed " << seed << ": " << where;
    shown += std::any_of(pixels.begin(), pixels.end(), [](uint8_t v) { return v != 0; });
    if (HasFailure()) break;
  }
  EXPECT_GT(shown, 80);
  EXPECT_TRUE(painter.named.empty());
}

/// RmlUi's backdrop-filter: the list's own layer for it, which blurs what lies below and reads beyond the clip.
TEST_F(RmlUiList, BackdropsReadWhatLiesBelow) {
  recorder.draw(boxes({{0, 0, 24, kSide}}, {255, 255, 255, 255}), 0, 0, nullptr);
  recorder.setScissor(Box{0, 0, kSide, kSide});
  recorder.pushLayer();
  const float deviation = 3;
  recorder.composite(0, 1, false, {makeStep(GPGP_FILTER_GAUSSIAN_BLUR, {deviation, deviation})});
  recorder.setScissor(Box{0, 12, kSide, 36});
  recorder.composite(1, 0, false, {});
  recorder.popLayer();
  const auto pixels = draw();
  for (int x = 4; x < kSide - 12; ++x) {
    const double blurred = 0.5 * std::erfc((double(x) + 0.5 - 24) / (double(deviation) * std::numbers::sqrt2));
    const double below = x < 24 ? 1 : 0;
    const double wanted = blurred + below * (1 - blurred); // the result lies over what it was made of
    EXPECT_NEAR(pixels[(size_t{24} * kSide + size_t(x)) * 4] / 255.0, wanted, 0.02) << x;
    EXPECT_NEAR(pixels[(size_t{6} * kSide + size_t(x)) * 4] / 255.0, below, 0.01) << x;
  }
}

// ---------------------------------------------------------------- shapes

/// A box with round corners as RmlUi tessellates it: a fan of the outline.
Geometry roundBox(const Box& box, const std::array<float, 4>& rx, const std::array<float, 4>& ry, int points) {
  Geometry made;
  for (size_t corner = 0; corner < 4; ++corner)
    for (int i = 0; i < (rx[corner] > 0 ? points : 1); ++i) {
      const float turn =
          (float(corner) + 2 + (points > 1 ? float(i) / float(points - 1) : 0)) * std::numbers::pi_v<float> / 2;
      const float x = corner == 0 || corner == 3 ? box[0] + rx[corner] : box[2] - rx[corner];
      const float y = corner < 2 ? box[1] + ry[corner] : box[3] - ry[corner];
      GpgpListVertex v{x, y, {255, 255, 255, 255}, 0, 0};
      if (rx[corner] > 0) v.x += std::cos(turn) * rx[corner], v.y += std::sin(turn) * ry[corner];
      made.vertices.push_back(v);
    }
  for (uint32_t i = 1; i + 1 < made.vertices.size(); ++i) {
    made.indices.insert(made.indices.end(), {0u, i, i + 1});
  }
  return made;
}

TEST(RmlUiShapes, BoxesWithRoundCornersAreFound) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> at(0, 100), size(40, 200);
  for (int i = 0; i < 200; ++i) {
    const float x = at(random), y = at(random), w = size(random), h = size(random);
    std::array<float, 4> radii{};
    for (float& radius : radii) radius = random() % 3 == 0 ? 0 : (1 + at(random)) / 101 * std::min(w, h) / 2;
    const Geometry geometry = roundBox({x, y, x + w, y + h}, radii, radii, 3 + int(random() % 5));
    const std::optional<RoundBox> found = findShape(geometry.vertices, geometry.indices);
    ASSERT_TRUE(found) << i;
    for (size_t side = 0; side < 4; ++side) {
      EXPECT_NEAR(found->radii[side], radii[side], 0.05f);
      EXPECT_NEAR(found->box[side], (std::array{x, y, x + w, y + h}[side]), 0.001f);
    }
  }
}

TEST(RmlUiShapes, WhatIsNoSuchBoxIsNot) {
  const auto found = [](const Geometry& g) { return findShape(g.vertices, g.indices).has_value(); };
  EXPECT_FALSE(found(roundBox({0, 0, 90, 60}, {20, 20, 20, 20}, {9, 9, 9, 9}, 9))) << "elliptic corners";
  EXPECT_FALSE(found(*boxes({{0, 0, 8, 24}, {8, 16, 24, 24}}, {255, 255, 255, 255}))) << "an L";
  EXPECT_FALSE(found(*boxes({{0, 0, 10, 10}, {20, 0, 30, 10}}, {255, 255, 255, 255}))) << "two boxes";
  Geometry turned = *boxes({{0, 0, 10, 10}}, {255, 255, 255, 255});
  for (GpgpListVertex& v : turned.vertices) v = {v.x - v.y, v.x + v.y, {255, 255, 255, 255}, 0, 0};
  EXPECT_FALSE(found(turned)) << "a diamond";
  Geometry triangle = *boxes({{0, 0, 10, 10}}, {255, 255, 255, 255});
  triangle.indices.resize(3);
  EXPECT_FALSE(found(triangle));
}

TEST(RmlUiText, GlyphsAndStylesTravel) {
  const MeshGlyph glyph{7, 60123, -3.25f, 1e4f, 17.5f};
  const auto corners = encode(glyph);
  GpgpListVertex vertices[4]{};
  for (size_t i = 0; i < 4; ++i) vertices[i].u = corners[i][0], vertices[i].v = corners[i][1];
  const MeshGlyph back = decode(vertices);
  EXPECT_EQ(back.font, glyph.font);
  EXPECT_EQ(back.glyph, glyph.glyph);
  EXPECT_EQ(back.x, glyph.x);
  EXPECT_EQ(back.y, glyph.y);
  EXPECT_EQ(back.size, glyph.size);
  const std::optional<TextStyle> style = textStyleOf(textTexture({2.5f, 0.45f}));
  ASSERT_TRUE(style);
  EXPECT_FLOAT_EQ(style->stroke, 2.5f);
  EXPECT_FLOAT_EQ(style->blur, 0.45f);
  EXPECT_FALSE(textStyleOf("data/picture.png"));
}

// ---------------------------------------------------------------- gradients

/// A gradient over the whole canvas, in a box or in an L of the same extent, against its formula at pixel centres.
struct GradientCase {
  const char* name;
  Gradient gradient;
};
Gradient rainbow(Gradient::Kind kind, bool repeating) {
  Gradient g;
  g.kind = kind;
  g.repeating = repeating;
  g.start = kind == Gradient::Kind::linear ? std::array{6.0f, 4.0f} : std::array{20.0f, 26.0f};
  g.extent = kind == Gradient::Kind::linear ? std::array{30.0f, 20.0f} : std::array{26.0f, 18.0f};
  g.angle = 0.7f;
  const float first = repeating ? 0.1f : 0.0f, last = repeating ? 0.45f : 0.9f;
  g.stops = {{first, {1, 0, 0, 1}}, {(first + last) / 2, {0, 0.4f, 0.2f, 0.5f}}, {last, {0.2f, 0.2f, 1, 1}}};
  return g;
}
float positionOf(const Gradient& g, float x, float y) {
  const float dx = x - g.start[0], dy = y - g.start[1];
  float t = 0;
  if (g.kind == Gradient::Kind::linear)
    t = (dx * g.extent[0] + dy * g.extent[1]) / (g.extent[0] * g.extent[0] + g.extent[1] * g.extent[1]);
  else if (g.kind == Gradient::Kind::radial)
    t = std::hypot(dx / g.extent[0], dy / g.extent[1]);
  else
    t = (std::atan2(dx, -dy) - g.angle) / (2 * std::numbers::pi_v<float>);
  if (g.kind == Gradient::Kind::conic) t -= std::floor(t);
  if (!g.repeating) return t;
  const float first = g.stops.front().position, period = g.stops.back().position - first;
  t = (t - first) / period;
  return first + (t - std::floor(t)) * period;
}

TEST(RmlUiGradients, ColoursBetweenStopsAreSmoothSteps) {
  Gradient g;
  g.stops = {{0.2f, {0, 0, 0, 0}}, {0.6f, {1, 0.5f, 0, 1}}, {0.6f, {0, 0, 1, 1}}};
  EXPECT_EQ(colorAt(g, -1), (Color{0, 0, 0, 0}));
  EXPECT_NEAR(colorAt(g, 0.3f)[0], 0.15625f, 1e-5f); // 3 t^2 - 2 t^3 of a quarter
  EXPECT_NEAR(colorAt(g, 0.4f)[1], 0.25f, 1e-5f);
  EXPECT_NEAR(colorAt(g, 0.5f)[3], 0.84375f, 1e-5f);
  EXPECT_NEAR(colorAt(g, 0.5999f)[0], 1, 1e-3f);
  EXPECT_EQ(colorAt(g, 0.6001f), (Color{0, 0, 1, 1})); // two stops at one place
}

TEST_F(RmlUiList, GradientsAreTheirFormulas) {
  for (const auto kind : {Gradient::Kind::linear, Gradient::Kind::radial, Gradient::Kind::conic})
    for (const bool repeating : {false, true})
      for (const bool box : {true, false}) {
        auto paint = std::make_shared<Paint>();
        paint->kind = Paint::Kind::gradient;
        paint->gradient = rainbow(kind, repeating);
        Geometry geometry = *(box ? boxes({{0, 0, kSide, kSide}}, {255, 255, 255, 255})
                                  : boxes({{0, 0, 16, kSide}, {16, 16, kSide, kSide}}, {255, 255, 255, 255}));
        for (GpgpListVertex& v : geometry.vertices) v.u = v.x, v.v = v.y;
        recorder.begin();
        recorder.draw(std::make_shared<Geometry>(geometry), 0, 0, paint);
        const auto pixels = draw();
        int far = 0, compared = 0;
        for (int y = 0; y < kSide; ++y)
          for (int x = 0; x < kSide; ++x) {
            if (!box && x >= 16 && y < 16) {
              EXPECT_EQ(pixels[(size_t(y) * kSide + size_t(x)) * 4 + 3], 0);
              continue;
            }
            // Where the colour jumps within a pixel, or turns about the centre, its middle is not all.
            bool smooth = true;
            const auto colorOf = [&](float dx, float dy) {
              return colorAt(paint->gradient, positionOf(paint->gradient, float(x) + dx, float(y) + dy));
            };
            const Color middle = colorOf(0.5f, 0.5f);
            for (const float dx : {0.0f, 1.0f})
              for (const float dy : {0.0f, 1.0f})
                for (size_t c = 0; c < 4; ++c) smooth = smooth && std::abs(colorOf(dx, dy)[c] - middle[c]) < 0.12f;
            if (!smooth) continue;
            ++compared;
            for (size_t c = 0; c < 4; ++c)
              if (std::abs(float(pixels[(size_t(y) * kSide + size_t(x)) * 4 + c]) / 255 - middle[c]) > 0.03f) {
                if (++far == 1)
                  ADD_FAILURE() << "kind " << int(kind) << (repeating ? " repeating" : "") << (box ? " box " : " L ")
                                << x << " " << y << " channel " << c << ": "
                                << int(pixels[(size_t(y) * kSide + size_t(x)) * 4 + c]) << " of " << middle[c] * 255;
              }
          }
        EXPECT_GT(compared, 100);
        EXPECT_EQ(far, 0);
      }
}

} // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  shared = std::make_unique<Canvases>();
  const int result = RUN_ALL_TESTS();
  shared.reset();
  return result;
}
