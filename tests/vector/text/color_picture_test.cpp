// Colour glyphs that become pictures: composite modes beside cairo's operators, sweep gradients and shapes in shapes as
// closed forms.
#include "tiny_font.h"
#include "vector/text/color_blend.h"

#include <gpgp/text.h>

#include <gtest/gtest.h>

#include <cairo.h>

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using text::Pixel;

/// A glyph's picture, asked by places in em, y up.
struct Picture {
  std::vector<uint8_t> pixels;
  GpgpGlyphImage image{};
  uint32_t paths = 0;
  bool incomplete = false, broken = false;
  std::string said;

  /// Straight alpha; transparent outside.
  std::array<int, 4> at(double x, double y) const {
    const auto side = [this](size_t i) { return static_cast<double>(image.box[i]); };
    const double u = (x - side(0)) / (side(2) - side(0)) * image.width,
                 v = (-y - side(1)) / (side(3) - side(1)) * image.height;
    if (u < 0 || v < 0 || u >= image.width || v >= image.height) return {};
    const uint8_t* p = &pixels[(static_cast<size_t>(v) * image.width + static_cast<size_t>(u)) * 4];
    return {p[0], p[1], p[2], p[3]};
  }
};

Picture pictureOf(const std::vector<char>& bytes, uint32_t glyph = tiny::kSweep) {
  Picture picture;
  GpgpFontCreateInfo info = GPGP_FONT_CREATE_INFO_INIT;
  info.data = bytes.data();
  info.size = bytes.size();
  info.messageUserData = &picture.said;
  info.messageFn = [](void* user, const GpgpMessage* message) { *static_cast<std::string*>(user) += message->text; };
  GpgpFont font = nullptr;
  EXPECT_EQ(gpgpCreateFont(&info, &font), GPGP_SUCCESS);
  GpgpGlyphOutlineInfo asked = GPGP_GLYPH_OUTLINE_INFO_INIT;
  asked.glyph = glyph;
  EXPECT_EQ(gpgpGetGlyphOutline(
                font, &asked,
                [](void* user, const GpgpGlyphOutline* outline) {
                  auto& to = *static_cast<Picture*>(user);
                  to.paths = outline->pathCount;
                  to.incomplete = outline->incomplete, to.broken = outline->broken;
                  if (!outline->image) return;
                  to.image = *outline->image;
                  to.pixels.assign(to.image.pixels, to.image.pixels + size_t(4) * to.image.width * to.image.height);
                },
                &picture),
            GPGP_SUCCESS);
  gpgpDestroyFont(font);
  return picture;
}

constexpr cairo_operator_t kOperators[text::kCompositeModes] = {
    CAIRO_OPERATOR_CLEAR,      CAIRO_OPERATOR_SOURCE,
    CAIRO_OPERATOR_DEST,       CAIRO_OPERATOR_OVER,
    CAIRO_OPERATOR_DEST_OVER,  CAIRO_OPERATOR_IN,
    CAIRO_OPERATOR_DEST_IN,    CAIRO_OPERATOR_OUT,
    CAIRO_OPERATOR_DEST_OUT,   CAIRO_OPERATOR_ATOP,
    CAIRO_OPERATOR_DEST_ATOP,  CAIRO_OPERATOR_XOR,
    CAIRO_OPERATOR_ADD,        CAIRO_OPERATOR_SCREEN,
    CAIRO_OPERATOR_OVERLAY,    CAIRO_OPERATOR_DARKEN,
    CAIRO_OPERATOR_LIGHTEN,    CAIRO_OPERATOR_COLOR_DODGE,
    CAIRO_OPERATOR_COLOR_BURN, CAIRO_OPERATOR_HARD_LIGHT,
    CAIRO_OPERATOR_SOFT_LIGHT, CAIRO_OPERATOR_DIFFERENCE,
    CAIRO_OPERATOR_EXCLUSION,  CAIRO_OPERATOR_MULTIPLY,
    CAIRO_OPERATOR_HSL_HUE,    CAIRO_OPERATOR_HSL_SATURATION,
    CAIRO_OPERATOR_HSL_COLOR,  CAIRO_OPERATOR_HSL_LUMINOSITY};

/// Of straight colours; premultiplied, of 255.
std::array<double, 4> byCairo(uint32_t mode, const Pixel& source, const Pixel& backdrop) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, 1, 1);
  cairo_t* cr = cairo_create(surface);
  const auto paint = [cr](cairo_operator_t by, const Pixel& c) {
    cairo_set_operator(cr, by);
    cairo_set_source_rgba(cr, static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2]),
                          static_cast<double>(c[3]));
    cairo_paint(cr);
  };
  paint(CAIRO_OPERATOR_SOURCE, backdrop);
  paint(kOperators[mode], source);
  cairo_surface_flush(surface);
  const uint8_t* p = cairo_image_surface_get_data(surface);
  const std::array<double, 4> made = {double(p[2]), double(p[1]), double(p[0]), double(p[3])};
  cairo_destroy(cr);
  cairo_surface_destroy(surface);
  return made;
}

TEST(ColorPicture, ModesAreCairos) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> byte(0, 255);
  const auto any = [&](int i) { // also fully transparent, opaque, and grey
    const auto value = [&] { return static_cast<float>(byte(random)) / 255; };
    Pixel c = {value(), value(), value(), i % 5 == 0 ? 0.f : i % 5 == 1 ? 1.f : value()};
    if (i % 7 == 0) c[1] = c[2] = c[0];
    return c;
  };
  const auto premultiplied = [](Pixel c) {
    for (size_t i = 0; i < 3; ++i) c[i] *= c[3];
    return c;
  };
  for (uint32_t mode = 0; mode < text::kCompositeModes; ++mode)
    for (int i = 0; i < 300; ++i) {
      const Pixel source = any(i), backdrop = any(i / 5);
      const Pixel ours = text::composite(mode, premultiplied(source), premultiplied(backdrop));
      const auto theirs = byCairo(mode, source, backdrop);
      // cairo works with bytes: where alpha is small, so is what they hold of a colour.
      const double slack = 2.5 + 2 / std::max(0.02, static_cast<double>(std::min(source[3], backdrop[3])));
      const bool isRough = mode >= 13 && std::min(source[3], backdrop[3]) > 0;
      for (size_t c = 0; c < 4; ++c) {
        // color-dodge and color-burn divide by these: of little, bytes say little.
        if (c < 3 && ((mode == 17 && source[c] > 0.7f) || (mode == 18 && source[c] < 0.3f))) continue;
        EXPECT_NEAR(static_cast<double>(ours[c]) * 255, theirs[c], isRough ? slack : 2.5)
            << "mode " << mode << " case " << i << " channel " << c;
      }
    }
}

TEST(ColorPicture, ShapesAreCompositedByEachMode) {
  const Pixel red = {1, 0, 0, 0.75f}, blue = {0, 0, 1, 1}, none{};
  for (uint32_t mode = 0; mode < text::kCompositeModes; ++mode) {
    SCOPED_TRACE(mode);
    const Picture picture = pictureOf(tinyCompositeFont(mode));
    EXPECT_FALSE(picture.incomplete || picture.broken) << picture.said;
    if (mode <= 3) { // paths say the same
      EXPECT_TRUE(picture.pixels.empty());
      EXPECT_EQ(picture.paths, mode == 0 ? 0u : mode == 3 ? 2u : 1u);
      continue;
    }
    ASSERT_FALSE(picture.pixels.empty());
    EXPECT_EQ(picture.paths, 0u);
    const struct {
      double x, y;
      const Pixel &source, &backdrop;
    } places[] = {{0.05, 0.65, red, none}, {0.1, 0.1, red, blue}, {0.45, 0.45, none, blue}, {0.45, 0.7, none, none}};
    for (const auto& p : places) {
      const auto expected = byCairo(mode, p.source, p.backdrop);
      const std::array<int, 4> is = picture.at(p.x, p.y);
      for (size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(c == 3 ? is[3] : is[c] * is[3] / 255.0, expected[c], 3) << p.x << ' ' << p.y << " channel " << c;
    }
  }
}

TEST(ColorPicture, SweepGradientsTurnAroundTheirCentre) {
  // From half a turn to a whole one, red to blue at half alpha; reflected where the shape is, in the first quarter.
  const Picture picture = pictureOf(tinyFont());
  EXPECT_FALSE(picture.incomplete || picture.broken) << picture.said;
  ASSERT_FALSE(picture.pixels.empty());
  EXPECT_GE(picture.image.width, 102u); // 0.4 em of 256 texels
  EXPECT_GE(picture.image.height, 204u);
  for (double x = 0.02; x < 0.4; x += 0.03)
    for (double y = 0.02; y < 0.8; y += 0.03) {
      const std::array<int, 4> is = picture.at(x, y);
      const double edge = x / 0.4 + y / 0.8;
      if (edge > 1.03) {
        EXPECT_EQ(is[3], 0) << x << ' ' << y;
      }
      if (edge > 0.97) continue;
      const double part = std::abs(std::atan2(y, x) - M_PI) / M_PI; // of the way, whose beginning is half a turn
      const double expected[4] = {255 * (1 - part), 0, 255 * part, 255 * (1 - part / 2)};
      for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(is[c], expected[c], 8) << x << ' ' << y << " channel " << c;
    }
}

TEST(ColorPicture, ShapesInShapesAreWhatBothCover) {
  const Picture picture = pictureOf(tinyNestedFont());
  EXPECT_FALSE(picture.incomplete || picture.broken) << picture.said;
  ASSERT_FALSE(picture.pixels.empty());
  double area = 0;
  for (size_t i = 3; i < picture.pixels.size(); i += 4) area += picture.pixels[i] / 255.0;
  const double texel = static_cast<double>(picture.image.box[2] - picture.image.box[0]) / picture.image.width;
  EXPECT_NEAR(area * texel * texel, 0.16 - 0.5 * 0.15 * 0.3,
              2e-4); // the triangle below half an em
  EXPECT_EQ(picture.at(0.1, 0.1), (std::array<int, 4>{255, 0, 0, 255}));
  EXPECT_EQ(picture.at(0.05, 0.65)[3], 0);
  EXPECT_EQ(picture.at(0.45, 0.45)[3], 0);
}

TEST(ColorPicture, ModesThatDoNotExistAreNamed) {
  const Picture picture = pictureOf(tinyCompositeFont(40));
  EXPECT_TRUE(picture.incomplete);
  EXPECT_TRUE(picture.pixels.empty());
  EXPECT_EQ(picture.paths, 2u);
  EXPECT_NE(picture.said.find("not supported"), std::string::npos) << picture.said;
}

} // namespace
