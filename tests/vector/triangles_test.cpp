// Triangles of lists against a plain rasteriser in double precision, and what must hold of them: no seams, no matter
// what a toolkit sends.
#include "ui_fixture.h"

#include <deque>

namespace {
using namespace gpgp;
using namespace gpgp::test;

using Color = std::array<double, 4>;

/// Where the sample in a row of a pixel lies.
double column(uint32_t row, uint32_t samples) { return (shader::sampleColumn(row, samples) + 0.5) / samples; }

/// A rasteriser of triangles as plain as can be: each sample of each pixel by three signed areas, triangle over
/// triangle; colours in the plane of the list, found by the inverse map.
struct Rasteriser {
  vector::Map map;
  uint32_t width, height, samples;
  std::vector<Color> picture; ///< premultiplied

  Rasteriser(const GpgpCanvasItem& item, uint32_t w, uint32_t h, uint32_t n)
      : map(vector::toMap(item.transform, item.perspective)), width(w), height(h), samples(n),
        picture(size_t(w) * h * n, Color{}) {}

  /// The point of the list that a point of the canvas shows.
  bool unmap(double px, double py, double& u, double& v) const {
    const double a = map.a - map.p * px, c = map.c - map.q * px, e = map.r * px - map.e;
    const double b = map.b - map.p * py, d = map.d - map.q * py, f = map.r * py - map.f;
    u = (e * d - c * f) / (a * d - c * b), v = (a * f - e * b) / (a * d - c * b);
    return map.p * u + map.q * v + map.r > 0;
  }
  /// A pixel takes the mean colour of the samples that a triangle covers of it.
  void draw(const GpgpListVertex* t, bool premultiplied) {
    const auto cross = [](double ax, double ay, double bx, double by) { return ax * by - ay * bx; };
    const double ux = double(t[1].x) - t[0].x, uy = double(t[1].y) - t[0].y, vx = double(t[2].x) - t[0].x,
                 vy = double(t[2].y) - t[0].y, area = cross(ux, uy, vx, vy);
    if (area == 0) return;
    for (size_t pixel = 0; pixel < size_t(width) * height; ++pixel) {
      Color color{};
      uint32_t covered = 0, count = 0;
      for (uint32_t row = 0; row < samples; ++row) {
        const double px = double(pixel % width) + column(row, samples);
        const double py = double(pixel / width) + (row + 0.5) / samples;
        double x, y;
        if (!unmap(px, py, x, y)) continue;
        const double second = cross(x - t[0].x, y - t[0].y, vx, vy) / area,
                     third = cross(ux, uy, x - t[0].x, y - t[0].y) / area, first = 1 - second - third;
        if (first < 0 || second < 0 || third < 0) continue;
        covered |= 1u << row;
        ++count;
        for (size_t k = 0; k < 4; ++k)
          color[k] += (first * t[0].color[k] + second * t[1].color[k] + third * t[2].color[k]) / 255;
      }
      if (!count) continue;
      for (double& c : color) c /= count;
      for (size_t k = 0; k < 3 && !premultiplied; ++k) color[k] *= color[3];
      for (uint32_t row = 0; row < samples; ++row)
        for (size_t k = 0; k < 4 && covered >> row & 1; ++k) {
          double& to = picture[pixel * samples + row][k];
          to = color[k] + to * (1 - color[3]);
        }
    }
  }
  Color pixel(size_t i) const {
    Color sum{};
    for (size_t k = 0; k < samples; ++k)
      for (size_t c = 0; c < 4; ++c) sum[c] += picture[i * samples + k][c] / samples;
    return sum;
  }
};

GpgpListVertex corner(float x, float y, std::array<uint8_t, 4> color, float u = 0, float v = 0) {
  return {x, y, {color[0], color[1], color[2], color[3]}, u, v};
}

struct TrianglesTest : CanvasTest {
  std::mt19937 random{7};
  float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); }
  uint8_t byte(uint32_t most = 255) { return static_cast<uint8_t>(random() % (most + 1)); }
  std::array<uint8_t, 4> color(bool premultiplied) {
    const uint8_t alpha = random() % 2 ? 255 : byte();
    const uint32_t most = premultiplied ? alpha : 255;
    return {byte(most), byte(most), byte(most), alpha};
  }
  /// A fan around a point that covers everything near it, as triangles in a random order.
  std::vector<GpgpListVertex> fan(float x, float y, float radius, uint32_t spokes, std::array<uint8_t, 4> shade) {
    std::vector<float> angles;
    for (uint32_t i = 0; i < spokes; ++i) angles.push_back(between(0, 6.2831853f));
    for (const float even : {0.3f, 2.2f, 4.4f}) angles.push_back(even); // no gap is half a turn wide
    std::sort(angles.begin(), angles.end());
    std::vector<std::array<GpgpListVertex, 3>> triangles;
    for (size_t i = 0; i < angles.size(); ++i) {
      const float a = angles[i], b = angles[(i + 1) % angles.size()];
      std::array t{corner(x, y, shade), corner(x + radius * std::cos(a), y + radius * std::sin(a), shade),
                   corner(x + radius * std::cos(b), y + radius * std::sin(b), shade)};
      std::rotate(t.begin(), t.begin() + random() % 3, t.end());
      if (random() % 2) std::swap(t[0], t[1]);
      triangles.push_back(t);
    }
    std::shuffle(triangles.begin(), triangles.end(), random);
    std::vector<GpgpListVertex> flat;
    for (const auto& t : triangles) flat.insert(flat.end(), t.begin(), t.end());
    return flat;
  }
};

TEST_F(TrianglesTest, AreWhatAPlainRasteriserDraws) {
  makeCanvas(128);
  constexpr uint32_t kWidth = 96, kHeight = 80;
  TestList list(context);
  for (const auto& map : kMaps)
    for (const bool premultiplied : {false, true})
      for (const uint32_t samples : {1u, 16u}) {
        exactArea = samples == 16 && premultiplied;
        GpgpCanvasItem item = list.item();
        std::copy_n(map.data(), 6, item.transform);
        std::copy_n(map.data() + 6, 3, item.perspective);
        Rasteriser expected(item, kWidth, kHeight, samples);
        std::vector<GpgpListVertex> mesh;
        for (int i = 0; i < 12; ++i) // some large, some thin
          for (int k = 0; k < 3; ++k)
            mesh.push_back(corner(between(-20, 110), between(-20, 100), color(premultiplied)));
        for (int i = 0; i < 6; ++i) { // feathers: a pixel wide, from opaque to nothing
          const float x = between(0, 90), y = between(0, 70), dx = between(-30, 30), dy = between(-30, 30);
          const float length = std::hypot(dx, dy), nx = -dy / length, ny = dx / length;
          const uint8_t none = premultiplied ? 0 : 200;
          const std::array<uint8_t, 4> full{200, 90, 10, 255}, out{none, none, none, 0};
          const GpgpListVertex a = corner(x, y, full), b = corner(x + dx, y + dy, full),
                               c = corner(x + nx, y + ny, out), d = corner(x + dx + nx, y + dy + ny, out);
          for (const GpgpListVertex& v : {a, b, c, b, d, c}) mesh.push_back(v);
        }
        list.reset().add(mesh, premultiplied);
        for (size_t i = 0; i < mesh.size(); i += 3) expected.draw(&mesh[i], premultiplied);
        const auto pixels = raster({item}, kWidth, kHeight, samples);
        double worst = 0, worstTile = 0;
        for (uint32_t tile = 0; tile < kWidth / 8 * (kHeight / 8); ++tile) {
          Color sum{};
          for (uint32_t k = 0; k < 64; ++k) {
            const size_t i = (tile / (kWidth / 8) * 8 + k / 8) * kWidth + tile % (kWidth / 8) * 8 + k % 8;
            const Color wanted = expected.pixel(i);
            const float got[4] = {pixels[i].r, pixels[i].g, pixels[i].b, pixels[i].a};
            for (size_t c = 0; c < 4; ++c) {
              const double difference = std::abs(double(got[c]) - wanted[c]);
              worst = std::max(worst, difference);
              sum[c] += difference / 64;
            }
          }
          for (const double s : sum) worstTile = std::max(worstTile, s);
        }
        // A sample on an edge may go either way.
        EXPECT_LE(worst, 1.1 / samples) << &map - kMaps << " " << premultiplied << " " << samples;
        EXPECT_LE(worstTile, samples == 1 ? 0.02 : 0.003) << &map - kMaps << " " << premultiplied << " " << samples;
        if (&map == kMaps && samples == 16)
          show(premultiplied ? "triangles_premultiplied" : "triangles", pixels, kWidth, kHeight);
      }
}

// However many triangles meet in a point and whatever covers it, each sample lies in exactly one of a fan's.
TEST_F(TrianglesTest, FansHaveNoSeams) {
  makeCanvas(64);
  TestList list(context);
  for (const auto& map : kMaps)
    for (const uint32_t samples : {1u, 4u, 8u, 16u})
      for (const bool area : {false, true}) {
        exactArea = area;
        GpgpCanvasItem item = list.item();
        std::copy_n(map.data(), 6, item.transform);
        std::copy_n(map.data() + 6, 3, item.perspective);
        const auto shape = fan(between(10, 50), between(10, 50), 40, 40, {255, 255, 255, 128});
        list.reset().add(shape);
        const auto pixels = raster({item}, 64, 64, samples);
        // Inside of the hull of the fan, found by the triangles' own weights, each pixel is even.
        const Rasteriser space(item, 64, 64, 1);
        size_t whole = 0;
        for (uint32_t i = 0; i < 64 * 64; ++i) {
          bool inside = true;
          for (int k = 0; k < 4 && inside; ++k) {
            double u, v;
            inside = space.unmap(i % 64 + (k & 1 ? 1.3 : -0.3), i / 64 + (k & 2 ? 1.3 : -0.3), u, v);
            bool covered = false;
            for (size_t t = 0; t < shape.size() && inside && !covered; t += 3) {
              int sides = 0;
              for (size_t e = 0; e < 3; ++e) {
                const GpgpListVertex &a = shape[t + e], &b = shape[t + (e + 1) % 3];
                const double turn = (double(b.x) - a.x) * (v - a.y) - (double(b.y) - a.y) * (u - a.x);
                sides += turn >= -1e-6 ? 1 : 0;
                sides += turn <= 1e-6 ? 4 : 0;
              }
              covered = (sides & 3) == 3 || sides >= 12;
            }
            inside = inside && covered;
          }
          if (!inside) continue;
          ++whole;
          ASSERT_NEAR(pixels[i].a, 128 / 255.0f, 0.001f)
              << &map - kMaps << ", samples " << samples << ", area " << area << ": " << i % 64 << " " << i / 64;
        }
        if (&map == kMaps) {
          EXPECT_GT(whole, 1000u);
        }
      }
}

// 64 images in one recording, by rectangles, triangles and nine-slices, beside each other and on each other.
TEST_F(TrianglesTest, AnyNumberOfImagesPaints) {
  constexpr uint32_t kImages = 64, kSide = 128;
  std::deque<Texture> textures;
  std::vector<std::array<uint8_t, 4>> texels;
  for (uint32_t i = 0; i < kImages; ++i) {
    const uint8_t alpha = i % 3 ? 255 : 96;
    texels.push_back({byte(alpha), byte(alpha), byte(alpha), alpha});
    const auto& c = texels.back();
    const std::vector<uint32_t> all(4, c[0] | uint32_t(c[1]) << 8 | uint32_t(c[2]) << 16 | uint32_t(c[3]) << 24);
    // One kind of sampler: lavapipe compiles a page's shader anew for each combination.
    textures.emplace_back(device, 2, 2, all, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    images.push_back(textures.back().view(true));
  }
  GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
  info.base = {"canvas", device.graphics().family, 0, VK_FALSE};
  info.maxWidth = info.maxHeight = kSide;
  info.targets = canvasTargets;
  info.maxImages = kImages;
  info.maxImagePixels = 8 * kSide * kSide;
  canvas = recorder(gpgpCreateCanvas, info);

  const std::array<uint8_t, 4> white{255, 255, 255, 255};
  TestList list(context);
  const auto paint = [&](uint32_t i, float x, float y, float side) {
    if (i % 3 == 1) {
      const GpgpListVertex a = corner(x, y, white), b = corner(x + side, y, white, 1, 0),
                           c = corner(x + side, y + side, white, 1, 1), d = corner(x, y + side, white, 0, 1);
      list.add({a, b, c, a, c, d}, false, i);
      return;
    }
    GpgpListShape shape = rectangle(x, y, x + side, y + side);
    const GpgpListImage image{i, {0, 0, 1, 1}, {0.25f, 0.25f, 0.25f, 0.25f}, {1, 1, 1, 1}, {}, {}};
    const GpgpListImage plain{i, {0, 0, 1, 1}, {}, {}, {}, {}};
    shape.image = i % 3 ? &image : &plain;
    list.add(shape);
  };
  const auto fill = [&](bool projective) {
    list.reset().push(projective ? std::array<float, 9>{1, 0, 0, 1, 0, 0, 0, 0.0001f, 1}
                                 : std::array<float, 9>{1, 0, 0, 1, 0, 0, 0, 0, 0});
    for (uint32_t i = 0; i < kImages; ++i) paint(i, float(i % 8 * 16), float(i / 8 * 14), 12);
    for (uint32_t i = 0; i < kImages; ++i) paint(kImages - 1 - i, 3, 116, 9); // all of them in a few tiles
    list.pop();
  };
  for (const bool projective : {false, true}) {
    fill(projective);
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    const auto pixels = raster({list.item()}, kSide, kSide, 16, &report);
    EXPECT_EQ(report.base.status, GPGP_SUCCESS);
    EXPECT_GE(report.imagePixels, kImages * 144);
    EXPECT_EQ(report.imagePixelsGiven, 8 * kSide * kSide);
    show(projective ? "images_projective" : "images", pixels, kSide, kSide);
    const auto expect = [&](uint32_t x, uint32_t y, const std::array<float, 4>& wanted, const std::string& what) {
      if (projective) y = static_cast<uint32_t>((float(y) + 0.5f) / (1 + 0.0001f * (float(y) + 0.5f)));
      const Rgba& p = pixels[y * kSide + x];
      EXPECT_NEAR(p.r, wanted[0], 0.004f) << what;
      EXPECT_NEAR(p.g, wanted[1], 0.004f) << what;
      EXPECT_NEAR(p.b, wanted[2], 0.004f) << what;
      EXPECT_NEAR(p.a, wanted[3], 0.004f) << what;
    };
    std::array<float, 4> stack{};
    for (uint32_t i = kImages; i > 0; --i)
      for (size_t k = 0; k < 4; ++k) stack[k] = texels[i - 1][k] / 255.0f + stack[k] * (1 - texels[i - 1][3] / 255.0f);
    expect(6, 120, stack, "all of them");
    for (uint32_t i = 0; i < kImages; ++i)
      expect(i % 8 * 16 + 5, i / 8 * 14 + 5,
             {texels[i][0] / 255.0f, texels[i][1] / 255.0f, texels[i][2] / 255.0f, texels[i][3] / 255.0f},
             "image " + std::to_string(i));
  }
  // As one of eight images, each paints the same, also where filters mix.
  TestList other(context);
  GpgpListShape turnedBox = rectangle(10, 10, 90, 70);
  std::vector<uint32_t> noise;
  for (uint32_t i = 0; i < 64; ++i) noise.push_back(0xff000000u | byte() << 16 | byte() << 8 | byte());
  const Texture mixed(device, 8, 8, noise, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  images[60] = mixed.view();
  for (const auto& map : kMaps) {
    const GpgpListImage last{60, {0, 0, 3, 1}, {}, {}, {}, {}};
    turnedBox.image = &last;
    other.reset().add(turnedBox);
    GpgpCanvasItem item = other.item();
    std::copy_n(map.data(), 6, item.transform);
    std::copy_n(map.data() + 6, 3, item.perspective);
    const auto paged = raster({item}, 96, 96, 16);
    const std::vector<GpgpCanvasImage> all = images;
    const GpgpListImage only{0, {0, 0, 3, 1}, {}, {}, {}, {}};
    turnedBox.image = &only;
    other.reset().add(turnedBox);
    images = {all[60]};
    const auto named = raster({item}, 96, 96, 16);
    images = all;
    for (size_t i = 0; i < paged.size(); ++i)
      ASSERT_LE(std::max({std::abs(paged[i].r - named[i].r), std::abs(paged[i].g - named[i].g),
                          std::abs(paged[i].b - named[i].b), std::abs(paged[i].a - named[i].a)}),
                0.002f)
          << &map - kMaps << ", pixel " << i;
  }
  // What finds no room is left out, and said.
  fill(false);
  for (int k = 0; k < 8; ++k) paint(5, 0, 0, kSide);
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  raster({list.item()}, kSide, kSide, 16, &report);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_GT(report.imagePixels, report.imagePixelsGiven);
  EXPECT_GE(report.pathsDropped, 1u);
}

TEST_F(TrianglesTest, TooManyImagesAreRefused) {
  makeCanvas(64);
  const std::vector<uint32_t> white(4, ~0u);
  const Texture texture(device, 2, 2, white, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT);
  images.assign(9, texture.view());
  TestList list(context);
  const GpgpFrame frame = advance();
  const host::Image target(device, {.format = VK_FORMAT_R16G16B16A16_SFLOAT, .width = 64, .height = 64});
  device.submitAndWait([&](VkCommandBuffer commands) {
    EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
    const GpgpCanvasItem item = list.item();
    GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
    info.width = info.height = 64;
    info.items = &item;
    info.itemCount = 1;
    info.target = target.target({}, {});
    info.images = images.data();
    info.imageCount = 9;
    EXPECT_EQ(gpgpRecordPrepareCanvas(canvas, commands, &frame, &info), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(lastMessage().find("imageCount is 9; the canvas was made for 8"), std::string::npos) << lastMessage();
  });
}

// A quad of two triangles shows an image as a rectangle does.
TEST_F(TrianglesTest, ImagesAreThoseOfRectangles) {
  makeCanvas(64);
  std::vector<uint32_t> texels;
  for (uint32_t i = 0; i < 64; ++i) texels.push_back(0xff000000u | byte() << 16 | byte() << 8 | byte());
  const Texture smooth(device, 8, 8, texels, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  const Texture coarse(device, 8, 8, texels, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT);
  images = {smooth.view(true), coarse.view(true)};
  TestList quad(context), box(context);
  for (const auto& map : kMaps)
    for (const uint32_t image : {0u, 1u}) {
      const std::array<uint8_t, 4> white{255, 255, 255, 255};
      const GpgpListVertex a = corner(8, 8, white, 0, 0), b = corner(48, 8, white, 1.5f, 0),
                           c = corner(48, 40, white, 1.5f, 1), d = corner(8, 40, white, 0, 1);
      quad.reset().add({a, b, c, a, c, d}, false, image);
      GpgpListShape shape = rectangle(8, 8, 48, 40);
      const GpgpListImage picture{image, {0, 0, 1.5f, 1}, {}, {}, {}, {}};
      shape.image = &picture;
      box.reset().add(shape);
      GpgpCanvasItem item = quad.item();
      std::copy_n(map.data(), 6, item.transform);
      std::copy_n(map.data() + 6, 3, item.perspective);
      const auto one = raster({item}, 64, 64, 16);
      item.list = box.list;
      const auto other = raster({item}, 64, 64, 16);
      size_t edges = 0, same = 0;
      for (size_t i = 0; i < one.size(); ++i) {
        ASSERT_EQ(one[i].a, other[i].a) << &map - kMaps << " " << i; // the same samples
        if (other[i].a != 1) continue;
        // Beside an edge and on the diagonal, another place of the image is asked for.
        const float difference = std::max(
            {std::abs(one[i].r - other[i].r), std::abs(one[i].g - other[i].g), std::abs(one[i].b - other[i].b)});
        (difference < 0.02f ? same : edges) += 1;
      }
      EXPECT_LE(edges * 8, same) << &map - kMaps << " " << image;
    }
}

TEST_F(TrianglesTest, StateAppliesToThem) {
  makeCanvas(64);
  const std::array<uint8_t, 4> red{255, 0, 0, 255};
  const std::vector<GpgpListVertex> quad = {corner(0, 0, red), corner(40, 0, red),  corner(40, 40, red),
                                            corner(0, 0, red), corner(40, 40, red), corner(0, 40, red)};
  TestList triangles(context), shapes(context);
  const auto fill = [&](TestList& list, auto&& add) {
    list.reset().push({1, 0, 0, 1, 4, 6}).fade(0.5f).clip({2, 2, 30, 38}).clip({0, 0, 40, 40}, {9, 9, 9, 9});
    add();
    list.pop(3).group(0.25f);
    list.push(turned(20, 0.8f, 12, 4));
    add();
    list.pop(3);
  };
  fill(triangles, [&] { triangles.add(quad); });
  fill(shapes, [&] { shapes.add(rectangle(0, 0, 40, 40, {1, 0, 0, 1})); });
  const auto one = raster({triangles.item()}, 64, 64, 16), other = raster({shapes.item()}, 64, 64, 16);
  for (size_t i = 0; i < one.size(); ++i) {
    ASSERT_NEAR(one[i].r, other[i].r, 0.001f) << i;
    ASSERT_NEAR(one[i].a, other[i].a, 0.001f) << i;
  }
}

// Colours given encoded are what they are where the canvas mixes them so, and in linear light where it does not.
TEST_F(TrianglesTest, ColorsHaveEncodings) {
  makeCanvas(64);
  TestList list(context);
  const std::array<uint8_t, 4> straight{188, 64, 255, 128}, multiplied{94, 32, 128, 128};
  for (const bool premultiplied : {false, true})
    for (const bool blends : {false, true}) {
      const auto c = premultiplied ? multiplied : straight;
      list.reset().add({corner(0, 0, c), corner(200, 0, c), corner(0, 200, c)}, premultiplied, GPGP_IMAGE_NONE,
                       GPGP_IMAGE_SRGB);
      blendSrgb = blends;
      encodeSrgb = true;
      const Rgba p = raster({list.item()}, 16, 16, 4)[40];
      const float alpha = 128 / 255.0f;
      EXPECT_NEAR(p.r, 188 / 255.0f * alpha, 0.003f) << premultiplied << blends;
      EXPECT_NEAR(p.g, 64 / 255.0f * alpha, 0.003f) << premultiplied << blends;
      EXPECT_NEAR(p.b, alpha, 0.003f) << premultiplied << blends;
      EXPECT_NEAR(p.a, alpha, 0.001f) << premultiplied << blends;
    }
}

TEST_F(TrianglesTest, IndicesAndHits) {
  const std::array<uint8_t, 4> white{255, 255, 255, 255}, clear{9, 9, 9, 0};
  const GpgpListVertex corners[] = {corner(0, 0, white), corner(10, 0, white), corner(10, 10, white),
                                    corner(0, 10, white), corner(20, 20, clear)};
  const uint16_t shorts[] = {4, 4, 4, 0, 1, 2, 0, 2, 3};
  const uint32_t words[] = {4, 4, 4, 0, 1, 2, 0, 2, 3};
  for (const bool wide : {false, true}) {
    TestList list(context);
    GpgpListTriangles info{corners,
                           5,
                           wide ? static_cast<const void*>(words) : shorts,
                           9,
                           wide ? VK_INDEX_TYPE_UINT32 : VK_INDEX_TYPE_UINT16,
                           GPGP_IMAGE_LINEAR,
                           VK_FALSE,
                           GPGP_IMAGE_NONE,
                           33};
    list.add(rectangle(0, 0, 30, 30)).push({1, 0, 0, 1, 5, 0});
    ASSERT_EQ(gpgpAddTriangles(list.list, &info), GPGP_SUCCESS) << lastMessage();
    list.pop();
    GpgpHit hit = hitAt(context, {list.item()}, 13, 2);
    EXPECT_EQ(hit.entry, 1u);
    EXPECT_EQ(hit.id, 33u);
    EXPECT_EQ(hit.path, 1u); // the one without extent is counted
    EXPECT_EQ(hit.x, 8);
    hit = hitAt(context, {list.item()}, 6, 8);
    EXPECT_EQ(hit.path, 2u);
    EXPECT_EQ(hitAt(context, {list.item()}, 4, 8).entry, 0u);
    EXPECT_EQ(hitAt(context, {list.item()}, 4, 8).id, 0u);
  }
}

TEST_F(TrianglesTest, WrongOnesAreRefused) {
  const std::array<uint8_t, 4> white{255, 255, 255, 255};
  GpgpListVertex corners[] = {corner(0, 0, white), corner(1, 0, white), corner(0, 1, white)};
  const uint32_t indices[] = {0, 1, 2, 3};
  TestList list(context);
  const GpgpListTriangles good{corners, 3, indices, 3, VK_INDEX_TYPE_UINT32, 0, VK_FALSE, GPGP_IMAGE_NONE, 0};
  const auto refused = [&](const char* why, auto&& change) {
    GpgpListTriangles info = good;
    change(info);
    messages.clear();
    EXPECT_EQ(gpgpAddTriangles(list.list, &info), GPGP_ERROR_INVALID_ARGUMENT) << why;
    EXPECT_NE(lastMessage().find(why), std::string::npos) << lastMessage();
  };
  refused("indexCount is 4", [](GpgpListTriangles& t) { t.indexCount = 4; });
  refused("vertexCount is 2", [](GpgpListTriangles& t) { t.indices = nullptr, t.vertexCount = 2; });
  refused("indices[2] is 2, but vertexCount is 2", [](GpgpListTriangles& t) { t.vertexCount = 2; });
  refused("vertices is NULL", [](GpgpListTriangles& t) { t.vertices = nullptr; });
  refused("indexType is 7", [](GpgpListTriangles& t) { t.indexType = static_cast<VkIndexType>(7); });
  refused("encoding is 2", [](GpgpListTriangles& t) { t.encoding = 2; });
  corners[1].x = NAN;
  refused("vertices[1]: x or y", [](GpgpListTriangles&) {});
  corners[1].x = 1;
  corners[2].v = INFINITY;
  EXPECT_EQ(gpgpAddTriangles(list.list, &good), GPGP_SUCCESS); // no image, no matter
  refused("vertices[2]: u or v", [](GpgpListTriangles& t) { t.image = 0; });
  EXPECT_EQ(hitAt(context, {list.item()}, 0.2f, 0.2f).entry, 0u);
}

} // namespace
