// Fonts: what they say of themselves against FreeType, outlines against HarfBuzz's own reading of the same tables (an
// implementation independent of FreeType's), colour glyphs of a font made here, errors.
#include "fonts.h"
#include "tiny_font.h"

#include <cmath>
#include <thread>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_COLOR_H
#include FT_MULTIPLE_MASTERS_H
#include FT_OUTLINE_H
#include FT_TRUETYPE_TABLES_H
#include <hb-ot.h>

using namespace gpgp::test;

namespace {

/// An outline by what does not depend on where contours begin: areas under curves, a box, how many curves.
struct Shape {
  double area = 0, box[4] = {1e9, 1e9, -1e9, -1e9};
  uint32_t quads = 0, cubics = 0, contours = 0;
  double x = 0, y = 0;
  double startX = 0, startY = 0;

  void see(double px, double py) {
    box[0] = std::min(box[0], px);
    box[1] = std::min(box[1], py);
    box[2] = std::max(box[2], px);
    box[3] = std::max(box[3], py);
  }
  void to(double px, double py) {
    see(px, py);
    x = px;
    y = py;
  }
  static double cross(double ax, double ay, double bx, double by) { return ax * by - ay * bx; }
  void move(double px, double py) {
    ++contours;
    to(px, py);
    startX = px;
    startY = py;
  }
  void line(double px, double py) {
    area += cross(x, y, px, py) / 2;
    to(px, py);
  }
  void quad(double cx, double cy, double px, double py) {
    ++quads;
    area += (2 * cross(x, y, cx, cy) + 2 * cross(cx, cy, px, py) + cross(x, y, px, py)) / 6;
    see(cx, cy);
    to(px, py);
  }
  void cubic(double ax, double ay, double bx, double by, double px, double py) {
    ++cubics;
    area += (6 * cross(x, y, ax, ay) + 3 * cross(x, y, bx, by) + cross(x, y, px, py) + 3 * cross(ax, ay, bx, by) +
             3 * cross(ax, ay, px, py) + 6 * cross(bx, by, px, py)) /
            20;
    see(ax, ay);
    see(bx, by);
    to(px, py);
  }
  void close() { line(startX, startY); }

  explicit Shape(const GpgpPath& path) {
    const float* p = path.points;
    for (uint32_t i = 0; i < path.verbCount; ++i) switch (path.verbs[i]) {
      case GPGP_PATH_MOVE: move(double(p[0]), double(-p[1])), p += 2; break;
      case GPGP_PATH_LINE: line(double(p[0]), double(-p[1])), p += 2; break;
      case GPGP_PATH_QUAD: quad(double(p[0]), double(-p[1]), double(p[2]), double(-p[3])), p += 4; break;
      case GPGP_PATH_CUBIC:
        cubic(double(p[0]), double(-p[1]), double(p[2]), double(-p[3]), double(p[4]), double(-p[5]));
        p += 6;
        break;
      default: close();
      }
    EXPECT_EQ(p, path.points + size_t(path.pointCount) * 2);
  }
  Shape() = default;
};

struct Glyph {
  std::vector<Shape> shapes;
  std::vector<GpgpPath> paths; // colours; pointers are gone
  std::vector<std::vector<GpgpGradientStop>> stops;
  std::vector<GpgpGradient> gradients;
  std::vector<bool> foreground;
  std::vector<float> points; // of the first path
  GpgpGlyphOutline outline{};
  std::vector<uint8_t> pixels;
  GpgpGlyphImage image{};
};

GpgpResult glyphOf(GpgpFont font, const GpgpGlyphOutlineInfo& info, Glyph& glyph) {
  return gpgpGetGlyphOutline(
      font, &info,
      [](void* user, const GpgpGlyphOutline* outline) {
        auto& to = *static_cast<Glyph*>(user);
        to.outline = *outline;
        for (uint32_t i = 0; i < outline->pathCount; ++i) {
          const GpgpPath& path = outline->paths[i];
          EXPECT_EQ(path.fillRule, GPGP_FILL_NON_ZERO);
          to.shapes.emplace_back(path);
          to.paths.push_back(path);
          to.foreground.push_back(outline->foreground[i] != 0);
          if (i == 0) to.points.assign(path.points, path.points + size_t(path.pointCount) * 2);
          if (path.gradient) {
            to.gradients.push_back(*path.gradient);
            to.stops.emplace_back(path.gradient->stops, path.gradient->stops + path.gradient->stopCount);
          }
        }
        if (outline->image) {
          to.image = *outline->image;
          to.pixels.assign(to.image.pixels, to.image.pixels + size_t(to.image.width) * to.image.height * 4);
        }
      },
      &glyph);
}
Glyph glyphOf(GpgpFont font, uint32_t id) {
  GpgpGlyphOutlineInfo info = GPGP_GLYPH_OUTLINE_INFO_INIT;
  info.glyph = id;
  Glyph glyph;
  EXPECT_EQ(glyphOf(font, info, glyph), GPGP_SUCCESS) << "glyph " << id;
  return glyph;
}

/// HarfBuzz on the same file.
struct HarfBuzz {
  hb_font_t* font = nullptr;
  float units = 0;
  HarfBuzz(const std::string& name, uint32_t index, const std::vector<GpgpFontAxisValue>& axes)
      : HarfBuzz(hb_blob_create_from_file(fontPath(name).c_str()), index, axes) {}
  HarfBuzz(hb_blob_t* blob, uint32_t index, const std::vector<GpgpFontAxisValue>& axes) {
    hb_face_t* face = hb_face_create(blob, index);
    hb_blob_destroy(blob);
    font = hb_font_create(face);
    units = static_cast<float>(hb_face_get_upem(face));
    const int scale = static_cast<int>(units) * 64;
    hb_font_set_scale(font, scale, scale);
    std::vector<hb_variation_t> variations;
    for (const auto& axis : axes) variations.push_back({axis.tag, axis.value});
    hb_font_set_variations(font, variations.data(), static_cast<unsigned>(variations.size()));
    hb_face_destroy(face);
  }
  HarfBuzz(const HarfBuzz&) = delete;
  ~HarfBuzz() { hb_font_destroy(font); }
  Shape shape(uint32_t glyph) const {
    struct Scaled {
      Shape shape;
      double scale;
    } to{{}, 1 / (64 * static_cast<double>(units))};
    hb_draw_funcs_t* functions = hb_draw_funcs_create();
    hb_draw_funcs_set_move_to_func(
        functions,
        [](hb_draw_funcs_t*, void* data, hb_draw_state_t*, float x, float y, void*) {
          auto& t = *static_cast<Scaled*>(data);
          t.shape.move(double(x) * t.scale, double(y) * t.scale);
        },
        nullptr, nullptr);
    hb_draw_funcs_set_line_to_func(
        functions,
        [](hb_draw_funcs_t*, void* data, hb_draw_state_t*, float x, float y, void*) {
          auto& t = *static_cast<Scaled*>(data);
          t.shape.line(double(x) * t.scale, double(y) * t.scale);
        },
        nullptr, nullptr);
    hb_draw_funcs_set_quadratic_to_func(
        functions,
        [](hb_draw_funcs_t*, void* data, hb_draw_state_t*, float cx, float cy, float x, float y, void*) {
          auto& t = *static_cast<Scaled*>(data);
          t.shape.quad(double(cx) * t.scale, double(cy) * t.scale, double(x) * t.scale, double(y) * t.scale);
        },
        nullptr, nullptr);
    hb_draw_funcs_set_cubic_to_func(
        functions,
        [](hb_draw_funcs_t*, void* data, hb_draw_state_t*, float ax, float ay, float bx, float by, float x, float y,
           void*) {
          auto& t = *static_cast<Scaled*>(data);
          t.shape.cubic(double(ax) * t.scale, double(ay) * t.scale, double(bx) * t.scale, double(by) * t.scale,
                        double(x) * t.scale, double(y) * t.scale);
        },
        nullptr, nullptr);
    hb_draw_funcs_set_close_path_func(
        functions,
        [](hb_draw_funcs_t*, void* data, hb_draw_state_t*, void*) { static_cast<Scaled*>(data)->shape.close(); },
        nullptr, nullptr);
    hb_font_get_glyph_shape(font, glyph, functions, &to);
    hb_draw_funcs_destroy(functions);
    return to.shape;
  }
};

struct Case {
  const char* file;
  uint32_t face = 0;
  std::vector<GpgpFontAxisValue> axes = {};
  bool cubic = false;
};
const std::vector<Case> kCases = {{"DejaVuSans.ttf"},
                                  {"NotoSansDevanagari-Regular.ttf"},
                                  {"NotoNaskhArabic-Regular.ttf"},
                                  {"Cantarell-Regular.otf", 0, {}, true},
                                  {"NotoSansCJK-Regular.ttc", 2, {}, true},
                                  {"Inter-roman.var.ttf"},
                                  {"Inter-roman.var.ttf", 0, {{GPGP_TAG('w', 'g', 'h', 't'), 650}}},
                                  {"Inter-roman.var.ttf", 0, {{GPGP_TAG('w', 'g', 'h', 't'), 137}}}};

} // namespace

TEST(TextFont, OutlinesAreThoseThatHarfBuzzReads) {
  GPGP_NEEDS_FONTS();
  for (const Case& each : kCases) {
    SCOPED_TRACE(std::string(each.file) + (each.axes.empty() ? "" : " at " + std::to_string(each.axes[0].value)));
    const FontHandle font = openFont(each.file, each.face, each.axes);
    ASSERT_TRUE(font);
    const HarfBuzz reference(each.file, each.face, each.axes);
    const uint32_t count = infoOf(font.get()).glyphCount, step = std::max(1u, count / 300);
    uint32_t curves = 0;
    for (uint32_t id = 0; id < count; id += step) {
      const Glyph glyph = glyphOf(font.get(), id);
      const Shape theirs = reference.shape(id);
      ASSERT_EQ(glyph.shapes.size(), theirs.contours ? 1u : 0u) << "glyph " << id;
      if (!theirs.contours) continue;
      const Shape& ours = glyph.shapes[0];
      // Points are within 1/64 of a font unit. At axes FreeType rounds the places of a composite glyph's parts to
      // units.
      const double unit = (each.axes.empty() ? 1. / 64 : 0.52) / static_cast<double>(reference.units);
      EXPECT_NEAR(ours.area, theirs.area, 8 * unit) << "glyph " << id;
      for (int i = 0; i < 4; ++i) EXPECT_NEAR(ours.box[i], theirs.box[i], unit) << "glyph " << id << " side " << i;
      EXPECT_EQ(ours.contours, theirs.contours) << "glyph " << id;
      EXPECT_EQ(ours.quads, theirs.quads) << "glyph " << id;
      EXPECT_EQ(ours.cubics, theirs.cubics) << "glyph " << id;
      const float ownBox[4] = {float(ours.box[0]), float(-ours.box[3]), float(ours.box[2]), float(-ours.box[1])};
      for (int i = 0; i < 4; ++i) EXPECT_EQ(glyph.outline.box[i], ownBox[i]);
      curves += each.cubic ? ours.cubics : ours.quads;
      EXPECT_EQ(each.cubic ? ours.quads : ours.cubics, 0u);
    }
    EXPECT_GT(curves, 1000u);
  }
}

TEST(TextFont, Cff2VariesAlongItsAxis) {
  const std::vector<char> bytes = tinyVariableFont();
  FT_Library library = nullptr;
  ASSERT_EQ(FT_Init_FreeType(&library), 0);
  for (const float weight : {100.f, 217.5f, 400.f, 550.f, 900.f}) {
    SCOPED_TRACE(weight);
    const std::vector<GpgpFontAxisValue> axes = {{GPGP_TAG('w', 'g', 'h', 't'), weight}};
    GpgpFontCreateInfo info = GPGP_FONT_CREATE_INFO_INIT;
    Log log;
    info.data = bytes.data();
    info.size = bytes.size();
    info.axes = axes.data();
    info.axisCount = 1;
    info.messageFn = Log::take;
    info.messageUserData = &log;
    GpgpFont made = nullptr;
    ASSERT_EQ(gpgpCreateFont(&info, &made), GPGP_SUCCESS) << log.text;
    const FontHandle font(made);
    EXPECT_EQ(infoOf(made).axes[0].value, weight);
    const Glyph glyph = glyphOf(made, 1);
    ASSERT_EQ(glyph.shapes.size(), 1u);
    const Shape& ours = glyph.shapes[0];
    EXPECT_EQ(ours.cubics, 1u);
    // The closed form: what the ends of the axis add, in parts of 2^-14.
    const double along = weight > 400 ? (weight - 400) / 500. : (weight - 400) / 300.;
    const double wide = 100 + (along > 0 ? 200 : 60) * along, arch = 100 + (along > 0 ? 40 : 20) * along;
    EXPECT_NEAR(ours.box[0] * 1000, 100, 0.05);
    EXPECT_NEAR(ours.box[2] * 1000, 100 + wide, 0.05);
    // Under the arch: the integral of 3 h t (1 - t) along 3/4 w (1 + 2 t (1 - t)), 21/40 of w h.
    EXPECT_NEAR(std::abs(ours.area) * 1e6, wide * 700 + wide * arch * 0.525, 60);
    // HarfBuzz and FreeType on the same bytes.
    const HarfBuzz harfBuzz(
        hb_blob_create(bytes.data(), static_cast<unsigned>(bytes.size()), HB_MEMORY_MODE_READONLY, nullptr, nullptr), 0,
        axes);
    const Shape theirs = harfBuzz.shape(1);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(ours.box[i], theirs.box[i], 2e-5) << "side " << i;
    EXPECT_NEAR(ours.area, theirs.area, 4e-5);
    FT_Face face = nullptr;
    ASSERT_EQ(FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(bytes.data()),
                                 static_cast<FT_Long>(bytes.size()), 0, &face),
              0);
    FT_Fixed value = static_cast<FT_Fixed>(weight * 65536);
    ASSERT_EQ(FT_Set_Var_Design_Coordinates(face, 1, &value), 0);
    ASSERT_EQ(FT_Set_Char_Size(face, 0, 1000 * 64, 72, 72), 0);
    ASSERT_EQ(FT_Load_Glyph(face, 1, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP), 0);
    const FT_Outline& outline = face->glyph->outline;
    ASSERT_GE(glyph.points.size() / 2, static_cast<size_t>(outline.n_points));
    for (size_t i = 0; i < static_cast<size_t>(outline.n_points); ++i) { // FreeType drops parts of a unit
      EXPECT_EQ(std::floor(glyph.points[2 * i] * 1000 + 0.01f), static_cast<float>(outline.points[i].x) / 64) << i;
      EXPECT_EQ(std::floor(glyph.points[2 * i + 1] * -1000 + 0.01f), static_cast<float>(outline.points[i].y) / 64) << i;
    }
    FT_Done_Face(face);
    // Advances, which another table varies.
    Paper paper;
    ASSERT_EQ(paper.set(textInfo("AA", {made}, 1000)), GPGP_SUCCESS);
    ASSERT_EQ(paper.info.glyphCount, 2u);
    const float advance = 300 + static_cast<float>((along > 0 ? 200 : 60) * along);
    EXPECT_NEAR(paper.info.glyphs[1].x, advance, 0.51f); // HarfBuzz rounds what a table adds to whole units
    EXPECT_NEAR(paper.info.glyphs[1].x, static_cast<float>(hb_font_get_glyph_h_advance(harfBuzz.font, 1)) / 64, 0.05f);
  }
  FT_Done_FreeType(library);
}

TEST(TextFont, SaysWhatFreeTypeSays) {
  GPGP_NEEDS_FONTS();
  FT_Library library = nullptr;
  ASSERT_EQ(FT_Init_FreeType(&library), 0);
  for (const Case& each : kCases) {
    if (!each.axes.empty()) continue;
    SCOPED_TRACE(each.file);
    const FontHandle font = openFont(each.file, each.face);
    const GpgpFontInfo info = infoOf(font.get());
    FT_Face face = nullptr;
    ASSERT_EQ(FT_New_Face(library, fontPath(each.file).c_str(), static_cast<FT_Long>(each.face), &face), 0);
    const float em = 1.f / face->units_per_EM;
    EXPECT_EQ(info.unitsPerEm, face->units_per_EM);
    EXPECT_EQ(info.glyphCount, static_cast<uint32_t>(face->num_glyphs));
    EXPECT_EQ(info.faceCount, static_cast<uint32_t>(face->num_faces));
    EXPECT_STREQ(info.family, face->family_name);
    EXPECT_STREQ(info.style, face->style_name);
    EXPECT_NEAR(info.ascent, face->ascender * em, em);
    EXPECT_NEAR(info.descent, -face->descender * em, em);
    EXPECT_NEAR(info.lineGap, static_cast<float>(face->height - face->ascender + face->descender) * em, em);
    EXPECT_NEAR(info.underlinePosition, -face->underline_position * em, em);
    EXPECT_NEAR(info.underlineThickness, face->underline_thickness * em, em);
    const auto* os2 = static_cast<TT_OS2*>(FT_Get_Sfnt_Table(face, FT_SFNT_OS2));
    ASSERT_TRUE(os2);
    EXPECT_NEAR(info.strikePosition, (-os2->yStrikeoutPosition + os2->yStrikeoutSize / 2.f) * em, em);
    EXPECT_NEAR(info.strikeThickness, os2->yStrikeoutSize * em, em);
    for (const uint32_t character : {U'A', U'é', U'क', U'ا', U'道', U'😀'}) {
      uint32_t glyph = ~0u;
      EXPECT_EQ(gpgpGetNominalGlyph(font.get(), character, &glyph), GPGP_SUCCESS);
      EXPECT_EQ(glyph, FT_Get_Char_Index(face, character));
    }
    FT_Done_Face(face);
  }
  FT_Done_FreeType(library);
  const FontHandle variable = openFont("Inter-roman.var.ttf", 0, {{GPGP_TAG('w', 'g', 'h', 't'), 700}});
  const GpgpFontInfo info = infoOf(variable.get());
  ASSERT_EQ(info.axisCount, 1u);
  EXPECT_EQ(info.axes[0].tag, GPGP_TAG('w', 'g', 'h', 't'));
  EXPECT_STREQ(info.axes[0].name, "Weight");
  EXPECT_EQ(info.axes[0].minimum, 100);
  EXPECT_EQ(info.axes[0].normal, 400);
  EXPECT_EQ(info.axes[0].maximum, 900);
  EXPECT_EQ(info.axes[0].value, 700);
}

TEST(TextFont, OutlinesKeepEveryFontUnit) {
  GPGP_NEEDS_FONTS();
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  ASSERT_EQ(FT_Init_FreeType(&library), 0);
  ASSERT_EQ(FT_New_Face(library, fontPath("DejaVuSans.ttf").c_str(), 0, &face), 0);
  const FontHandle font = openFont("DejaVuSans.ttf");
  for (const char32_t character : U"OBg&@") {
    if (!character) continue;
    const FT_UInt id = FT_Get_Char_Index(face, character);
    ASSERT_EQ(FT_Load_Glyph(face, id, FT_LOAD_NO_SCALE), 0);
    const Glyph glyph = glyphOf(font.get(), id);
    for (int i = 0; i < face->glyph->outline.n_points; ++i) { // each point of the font, control points too
      const FT_Vector at = face->glyph->outline.points[i];
      bool found = false;
      for (size_t p = 0; p < glyph.points.size(); p += 2)
        found |= glyph.points[p] * face->units_per_EM == static_cast<float>(at.x) &&
                 -glyph.points[p + 1] * face->units_per_EM == static_cast<float>(at.y);
      EXPECT_TRUE(found) << "point " << i << " of " << char(character);
    }
  }
  FT_Done_Face(face);
  FT_Done_FreeType(library);
}

TEST(TextFont, StrokesAreHandedOn) {
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("DejaVuSans.ttf");
  GpgpStroke stroke{};
  stroke.width = 0.05f;
  GpgpGlyphOutlineInfo info = GPGP_GLYPH_OUTLINE_INFO_INIT;
  ASSERT_EQ(gpgpGetNominalGlyph(font.get(), 'A', &info.glyph), GPGP_SUCCESS);
  info.stroke = &stroke;
  info.color[0] = 0.25f;
  info.color[3] = 0.5f;
  Glyph glyph;
  ASSERT_EQ(glyphOf(font.get(), info, glyph), GPGP_SUCCESS);
  ASSERT_EQ(glyph.paths.size(), 1u);
  EXPECT_EQ(glyph.paths[0].stroke, &stroke);
  EXPECT_EQ(glyph.paths[0].color[0], 0.25f);
  EXPECT_EQ(glyph.paths[0].color[3], 0.5f);
  EXPECT_TRUE(glyph.foreground[0]);
}

TEST(TextFont, BitmapGlyphsAreImages) {
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("NotoColorEmoji.ttf");
  EXPECT_EQ(infoOf(font.get()).colors, GPGP_FONT_COLOR_BITMAPS);
  uint32_t id = 0;
  ASSERT_EQ(gpgpGetNominalGlyph(font.get(), 0x1f600, &id), GPGP_SUCCESS);
  const Glyph glyph = glyphOf(font.get(), id);
  ASSERT_EQ(glyph.image.width, 136u);
  ASSERT_EQ(glyph.image.height, 128u);
  EXPECT_NEAR(glyph.image.box[2] - glyph.image.box[0], 136.f / 109, 1e-5f); // its strike has 109 pixels an em
  EXPECT_NEAR(glyph.image.box[3] - glyph.image.box[1], 128.f / 109, 1e-5f);
  EXPECT_LT(glyph.image.box[1], -0.5f);
  // FreeType's own, multiplied by alpha.
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  ASSERT_EQ(FT_Init_FreeType(&library), 0);
  ASSERT_EQ(FT_New_Face(library, fontPath("NotoColorEmoji.ttf").c_str(), 0, &face), 0);
  ASSERT_EQ(FT_Select_Size(face, 0), 0);
  ASSERT_EQ(FT_Load_Glyph(face, id, FT_LOAD_COLOR), 0);
  const FT_Bitmap& bitmap = face->glyph->bitmap;
  uint32_t opaque = 0;
  for (uint32_t y = 0; y < bitmap.rows; ++y)
    for (uint32_t x = 0; x < bitmap.width; ++x) {
      const uint8_t* theirs = bitmap.buffer + static_cast<std::ptrdiff_t>(y) * bitmap.pitch + size_t(x) * 4;
      const uint8_t* ours = &glyph.pixels[(size_t(y) * bitmap.width + x) * 4];
      ASSERT_EQ(ours[3], theirs[3]);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(ours[c] * ours[3] / 255., theirs[2 - c], 1);
      opaque += ours[3] == 255;
    }
  EXPECT_GT(opaque, 5000u);
  FT_Done_Face(face);
  FT_Done_FreeType(library);
}

class TextColor : public testing::Test {
protected:
  void SetUp() override {
    bytes_ = tinyFont();
    GpgpFontCreateInfo info = GPGP_FONT_CREATE_INFO_INIT;
    info.data = bytes_.data();
    info.size = bytes_.size();
    info.keepData = VK_TRUE;
    info.label = "tiny";
    info.messageFn = Log::take;
    info.messageUserData = &log_;
    GpgpFont made = nullptr;
    ASSERT_EQ(gpgpCreateFont(&info, &made), GPGP_SUCCESS) << log_.text;
    font_.reset(made);
  }
  static void expectBox(const Shape& shape, double left, double bottom, double right, double top) {
    const double box[4] = {left, bottom, right, top};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(shape.box[i] * 1000, box[i], 0.05) << "side " << i;
  }
  static void expectColor(const float (&color)[4], float r, float g, float b, float a) {
    const float expected[4] = {r, g, b, a};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(color[i], expected[i], 1e-4f) << "component " << i;
  }
  std::vector<char> bytes_;
  Log log_;
  FontHandle font_;
};

TEST_F(TextColor, LayersOfVersion0) {
  const GpgpFontInfo font = infoOf(font_.get());
  EXPECT_EQ(font.colors, uint32_t(GPGP_FONT_COLOR_LAYERS) | GPGP_FONT_COLOR_PAINTS);
  EXPECT_EQ(font.paletteCount, 2u);
  GpgpGlyphOutlineInfo info = GPGP_GLYPH_OUTLINE_INFO_INIT;
  info.glyph = tiny::kLayers;
  info.color[1] = 0.5f;
  info.color[3] = 1;
  {
    Glyph glyph;
    ASSERT_EQ(glyphOf(font_.get(), info, glyph), GPGP_SUCCESS);
    ASSERT_EQ(glyph.shapes.size(), 2u);
    expectBox(glyph.shapes[0], 0, 0, 500, 500);
    expectBox(glyph.shapes[1], 0, 0, 400, 800);
    expectColor(glyph.paths[0].color, 1, 0, 0, 1);
    expectColor(glyph.paths[1].color, 0, 0.5f, 0, 1);
    EXPECT_FALSE(glyph.foreground[0]);
    EXPECT_TRUE(glyph.foreground[1]);
    EXPECT_FALSE(glyph.outline.incomplete);
  }
  { // the second palette: green 255, alpha 128
    info.palette = 1;
    Glyph glyph;
    ASSERT_EQ(glyphOf(font_.get(), info, glyph), GPGP_SUCCESS);
    expectColor(glyph.paths[0].color, 0, 1, 0, 128 / 255.f);
  }
  {
    const GpgpPaletteColor own = {0, {0.1f, 0.2f, 0.3f, 0.4f}};
    info.colors = &own;
    info.colorCount = 1;
    Glyph glyph;
    ASSERT_EQ(glyphOf(font_.get(), info, glyph), GPGP_SUCCESS);
    expectColor(glyph.paths[0].color, 0.1f, 0.2f, 0.3f, 0.4f);
    info.colors = nullptr;
    info.colorCount = 0;
  }
  { // without its colours: the glyph's own outline
    info.plain = VK_TRUE;
    Glyph glyph;
    ASSERT_EQ(glyphOf(font_.get(), info, glyph), GPGP_SUCCESS);
    ASSERT_EQ(glyph.shapes.size(), 1u);
    EXPECT_TRUE(glyph.foreground[0]);
  }
}

TEST_F(TextColor, PaintsOfVersion1) {
  const Glyph glyph = glyphOf(font_.get(), tiny::kPaints);
  ASSERT_EQ(glyph.shapes.size(), 4u);
  EXPECT_FALSE(glyph.outline.incomplete) << log_.text;
  expectBox(glyph.shapes[0], 0, 0, 500, 500);
  expectColor(glyph.paths[0].color, 1, 0, 0, 1);
  expectBox(glyph.shapes[1], 100, 200, 500, 1000);
  expectBox(glyph.shapes[2], -500, 0, 0, 500);  // turned by a quarter, counter-clockwise
  expectBox(glyph.shapes[3], 10, 20, 810, 820); // x' = 2x + y/2 + 10, y' = y + 20
  expectColor(glyph.paths[3].color, 0, 0, 0, 0.5f);
  EXPECT_TRUE(glyph.foreground[3]);
  EXPECT_FALSE(glyph.foreground[0]);

  ASSERT_EQ(glyph.gradients.size(), 2u);
  const GpgpGradient& linear = glyph.gradients[0];
  EXPECT_EQ(linear.kind, GPGP_GRADIENT_LINEAR);
  EXPECT_EQ(linear.spread, GPGP_SPREAD_REFLECT);
  // (400, 0) at right angles to (100, 400): along (400, -100) by 400 * 400 / 170000
  EXPECT_NEAR(linear.start[0], 0, 1e-5f);
  EXPECT_NEAR(linear.start[1], 0, 1e-5f);
  EXPECT_NEAR(linear.end[0] * 1000, 400 * 160000. / 170000, 0.05);
  EXPECT_NEAR(linear.end[1] * 1000, -100 * 160000. / 170000, 0.05);
  // Maps the font's (0, 0) to the drawing's (100, -200), y down.
  const float moved[6] = {1, 0, 0, -1, 0.1f, -0.2f};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(linear.transform[i], moved[i], 1e-5f) << i;
  ASSERT_EQ(glyph.stops[0].size(), 2u);
  EXPECT_EQ(glyph.stops[0][0].offset, 0);
  EXPECT_EQ(glyph.stops[0][1].offset, 1);
  expectColor(glyph.stops[0][0].color, 1, 0, 0, 1);
  expectColor(glyph.stops[0][1].color, 0, 0, 1, 0.5f);
  const GpgpGradient& radial = glyph.gradients[1];
  EXPECT_EQ(radial.kind, GPGP_GRADIENT_RADIAL);
  EXPECT_NEAR(radial.end[0], 0.25f, 1e-5f);
  EXPECT_NEAR(radial.startRadius, 0, 1e-5f);
  EXPECT_NEAR(radial.endRadius, 0.3f, 1e-5f);
  const float turned[6] = {0, -1, -1, 0, 0, 0};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(radial.transform[i], turned[i], 1e-4f) << i;
}

TEST_F(TextColor, WhatIsBrokenIsSaid) {
  Glyph circle;
  GpgpGlyphOutlineInfo info = GPGP_GLYPH_OUTLINE_INFO_INIT;
  info.glyph = tiny::kCircle;
  EXPECT_EQ(glyphOf(font_.get(), info, circle), GPGP_SUCCESS);
  EXPECT_TRUE(circle.outline.broken);
  EXPECT_NE(log_.text.find("glyph 6"), std::string::npos) << log_.text;
}

/// A real font with COLR version 0: every glyph's layers and colours as FreeType reads them.
TEST(ColorFont, LayersAreFreeTypes) {
  constexpr const char* kFont = "AmiriQuranColored.ttf";
  if (!std::filesystem::exists(fontPath(kFont))) GTEST_SKIP() << "needs tests/data/fetch.sh --only fonts";
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  ASSERT_EQ(FT_Init_FreeType(&library), 0);
  ASSERT_EQ(FT_New_Face(library, fontPath(kFont).c_str(), 0, &face), 0);
  FT_Color* palette = nullptr;
  ASSERT_EQ(FT_Palette_Select(face, 0, &palette), 0);
  const FontHandle font = openFont(kFont);
  EXPECT_TRUE(infoOf(font.get()).colors & GPGP_FONT_COLOR_LAYERS);
  const auto linear = [](FT_Byte byte) {
    const double value = byte / 255.;
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  };
  uint32_t colored = 0, foregrounds = 0;
  size_t most = 0;
  for (FT_UInt id = 0; id < static_cast<FT_UInt>(face->num_glyphs) && !HasFailure(); ++id) {
    SCOPED_TRACE(id);
    struct Layer {
      FT_UInt glyph, color;
    };
    std::vector<Layer> layers;
    Layer layer{};
    FT_LayerIterator next{};
    while (FT_Get_Color_Glyph_Layer(face, id, &layer.glyph, &layer.color, &next)) layers.push_back(layer);
    if (layers.empty()) continue;
    const Glyph glyph = glyphOf(font.get(), id);
    EXPECT_FALSE(glyph.outline.incomplete || glyph.outline.broken);
    ASSERT_EQ(glyph.paths.size(), layers.size());
    for (size_t i = 0; i < layers.size(); ++i) {
      ASSERT_EQ(FT_Load_Glyph(face, layers[i].glyph, FT_LOAD_NO_SCALE), 0);
      FT_Outline& outline = face->glyph->outline;
      const Shape& shape = glyph.shapes[i];
      EXPECT_EQ(shape.contours, static_cast<uint32_t>(outline.n_contours));
      if (outline.n_points > 0) {
        FT_BBox box{};
        FT_Outline_Get_CBox(&outline, &box);
        const FT_Pos sides[4] = {box.xMin, box.yMin, box.xMax, box.yMax};
        for (int side = 0; side < 4; ++side) // of parts that are scaled FreeType rounds each point to a unit
          EXPECT_NEAR(shape.box[side] * face->units_per_EM, static_cast<double>(sides[side]), 0.51);
      }
      const bool foreground = layers[i].color == 0xffff;
      const FT_Color color = foreground ? FT_Color{0, 0, 0, 255} : palette[layers[i].color];
      EXPECT_EQ(glyph.foreground[i], foreground);
      EXPECT_NEAR(glyph.paths[i].color[0], linear(color.red), 1e-5);
      EXPECT_NEAR(glyph.paths[i].color[1], linear(color.green), 1e-5);
      EXPECT_NEAR(glyph.paths[i].color[2], linear(color.blue), 1e-5);
      EXPECT_NEAR(glyph.paths[i].color[3], color.alpha / 255., 1e-5);
      foregrounds += foreground;
    }
    ++colored;
    most = std::max(most, layers.size());
  }
  std::printf("%s: %u glyphs in colour, up to %zu layers, %u in the text's colour\n", kFont, colored, most,
              foregrounds);
  EXPECT_GT(colored, 500u);
  EXPECT_GT(most, 30u);
  FT_Done_Face(face);
  FT_Done_FreeType(library);
}

TEST(TextFont, RefusesWhatIsNoFont) {
  Log log;
  GpgpFontCreateInfo info = GPGP_FONT_CREATE_INFO_INIT;
  info.messageFn = Log::take;
  info.messageUserData = &log;
  GpgpFont font = nullptr;
  const auto refused = [&](GpgpResult expected, const char* words) {
    log.text.clear();
    EXPECT_EQ(gpgpCreateFont(&info, &font), expected);
    EXPECT_NE(log.text.find(words), std::string::npos) << log.text;
    EXPECT_EQ(font, nullptr);
  };
  refused(GPGP_ERROR_INVALID_ARGUMENT, "exactly one of data and filePath");
  info.data = "not a font at all";
  info.size = 17;
  refused(GPGP_ERROR_INVALID_DATA, "not a font");
  info.size = 0;
  refused(GPGP_ERROR_INVALID_DATA, "not a font");
  info.data = nullptr;
  info.filePath = "/nowhere/at/all.ttf";
  refused(GPGP_ERROR_IO, "/nowhere/at/all.ttf");
  std::vector<char> bytes = tinyFont();
  info.filePath = nullptr;
  info.data = bytes.data();
  info.size = bytes.size();
  info.face = 1;
  refused(GPGP_ERROR_INVALID_ARGUMENT, "face is 1, but there are 1");
  info.face = 0;
  const GpgpFontAxisValue axis = {GPGP_TAG('w', 'g', 'h', 't'), 400};
  info.axes = &axis;
  info.axisCount = 1;
  refused(GPGP_ERROR_INVALID_ARGUMENT, "no axis 'wght'");
  info.axisCount = 0;
  info.sType = GPGP_STRUCTURE_FONT_INFO;
  info.messageFn = nullptr;
  EXPECT_EQ(gpgpCreateFont(&info, &font), GPGP_ERROR_INVALID_STRUCT);
  EXPECT_EQ(gpgpCreateFont(nullptr, &font), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpGetFontInfo(nullptr, nullptr), GPGP_ERROR_INVALID_HANDLE);
  gpgpDestroyFont(nullptr);
  if (!std::filesystem::exists(fontPath("Inter-roman.var.ttf"))) return;
  const std::string path = fontPath("Inter-roman.var.ttf");
  const GpgpFontAxisValue heavy = {GPGP_TAG('w', 'g', 'h', 't'), 1000};
  info = GPGP_FONT_CREATE_INFO_INIT;
  info.messageFn = Log::take;
  info.messageUserData = &log;
  info.filePath = path.c_str();
  info.axes = &heavy;
  info.axisCount = 1;
  refused(GPGP_ERROR_INVALID_ARGUMENT, "'wght' is 1000; expected 100 to 900");
}

TEST(TextFont, NumbersOfGlyphsAreChecked) {
  const std::vector<char> bytes = tinyFont();
  GpgpFontCreateInfo open = GPGP_FONT_CREATE_INFO_INIT;
  Log log;
  open.data = bytes.data();
  open.size = bytes.size();
  open.messageFn = Log::take;
  open.messageUserData = &log;
  GpgpFont raw = nullptr;
  ASSERT_EQ(gpgpCreateFont(&open, &raw), GPGP_SUCCESS);
  const FontHandle font(raw);
  const auto refused = [&](auto change, const char* words) {
    GpgpGlyphOutlineInfo info = GPGP_GLYPH_OUTLINE_INFO_INIT;
    GpgpPaletteColor entry{0, {0, 0, 0, 1}};
    GpgpStroke stroke{};
    stroke.width = 0.1f;
    info.glyph = tiny::kSquare;
    info.colors = &entry;
    info.colorCount = 1;
    info.stroke = &stroke;
    Glyph glyph;
    ASSERT_EQ(glyphOf(raw, info, glyph), GPGP_SUCCESS) << log.text;
    change(info, entry, stroke);
    EXPECT_EQ(glyphOf(raw, info, glyph), GPGP_ERROR_INVALID_ARGUMENT) << words;
    EXPECT_NE(log.text.find(words), std::string::npos) << log.text;
  };
  using Info = GpgpGlyphOutlineInfo;
  using Entry = GpgpPaletteColor;
  using Stroke = GpgpStroke;
  refused([](Info& info, Entry&, Stroke&) { info.color[1] = NAN; }, "color[1] is nan");
  refused([](Info& info, Entry&, Stroke&) { info.color[3] = 1.5f; }, "color[3] is 1.5");
  refused([](Info&, Entry& entry, Stroke&) { entry.color[2] = -1; }, "colors[0].color[2] is -1");
  refused([](Info&, Entry&, Stroke& stroke) { stroke.width = NAN; }, "stroke.width is nan");
  refused([](Info&, Entry&, Stroke& stroke) { stroke.width = -1; }, "stroke.width is -1");
  refused([](Info&, Entry&, Stroke& stroke) { stroke.join = 7; }, "stroke.join is 7");
  refused([](Info&, Entry&, Stroke& stroke) { stroke.scale = INFINITY; }, "stroke.scale is inf");
  refused([](Info& info, Entry&, Stroke&) { info.glyph = tiny::kGlyphs; }, "glyph is 7; the font has 7");

  Paper paper;
  const std::vector<GpgpFont> fonts = {raw};
  const auto textRefused = [&](auto change, const char* words) {
    GpgpTextSpan span{1, 2, {}};
    GpgpTextInfo info = textInfo("ABC", fonts, 12);
    span.style = info.style;
    info.spans = &span;
    info.spanCount = 1;
    ASSERT_EQ(paper.set(info), GPGP_SUCCESS) << paper.log.text;
    change(info, span.style);
    EXPECT_EQ(paper.set(info), GPGP_ERROR_INVALID_ARGUMENT) << words;
    EXPECT_NE(paper.log.text.find(words), std::string::npos) << paper.log.text;
  };
  using Text = GpgpTextInfo;
  using Style = GpgpTextStyle;
  textRefused([](Text& text, Style&) { text.style.outlineWidth = NAN; }, "style.outlineWidth is nan");
  textRefused([](Text&, Style& style) { style.outlineWidth = -1; }, "spans[0].style.outlineWidth is -1");
  textRefused([](Text&, Style& style) { style.outlineColor[0] = NAN; }, "spans[0].style.outlineColor[0] is nan");
  textRefused([](Text& text, Style&) { text.style.color[2] = 2; }, "style.color[2] is 2");
  textRefused([](Text& text, Style&) { text.style.size = 2e5f; }, "style.size is 200000");
  textRefused([](Text& text, Style&) { text.style.size = 0; }, "style.size is 0");
  textRefused([](Text&, Style& style) { style.letterSpacing = -2e5f; }, "spans[0].style.letterSpacing is -200000");
  textRefused([](Text& text, Style&) { text.width = -1; }, "width is -1");
  textRefused([](Text& text, Style&) { text.lineHeight = INFINITY; }, "lineHeight is inf");
}

/// Where a table begins.
size_t tableOf(const std::vector<char>& bytes, const char* tag) {
  const auto at = [&](size_t i) { return size_t{static_cast<unsigned char>(bytes[i])}; };
  for (size_t i = 0; i < at(4) * 256 + at(5); ++i) {
    const size_t entry = 12 + i * 16;
    if (std::equal(tag, tag + 4, bytes.begin() + static_cast<std::ptrdiff_t>(entry)))
      return at(entry + 8) << 24 | at(entry + 9) << 16 | at(entry + 10) << 8 | at(entry + 11);
  }
  ADD_FAILURE() << tag;
  return 0;
}

/// The font with contours that are not there in a glyph.
void breakGlyph(std::vector<char>& bytes, uint32_t glyph) {
  const auto at = [&](size_t i) { return size_t{static_cast<unsigned char>(bytes[i])}; };
  const size_t loca = tableOf(bytes, "loca");
  const bool isLong = at(tableOf(bytes, "head") + 51) == 1;
  const size_t entry = loca + glyph * (isLong ? 4u : 2u);
  const size_t offset = isLong ? at(entry) << 24 | at(entry + 1) << 16 | at(entry + 2) << 8 | at(entry + 3)
                               : (at(entry) << 8 | at(entry + 1)) * 2;
  const size_t contours = tableOf(bytes, "glyf") + offset;
  bytes[contours] = 0x7f;
  bytes[contours + 1] = 0x7f;
}

FontHandle openBytes(const std::vector<char>& bytes, Log& log, GpgpResult expected = GPGP_SUCCESS) {
  GpgpFontCreateInfo info = GPGP_FONT_CREATE_INFO_INIT;
  info.data = bytes.data();
  info.size = bytes.size();
  info.messageFn = Log::take;
  info.messageUserData = &log;
  GpgpFont font = nullptr;
  EXPECT_EQ(gpgpCreateFont(&info, &font), expected) << log.text;
  return FontHandle(font);
}

TEST(TextFont, ABrokenGlyphIsDrawnAsMissing) {
  GPGP_NEEDS_FONTS();
  std::vector<char> bytes = bytesOf(fontPath("DejaVuSans.ttf"));
  uint32_t e = 0, a = 0;
  const FontHandle whole = openFont("DejaVuSans.ttf");
  ASSERT_EQ(gpgpGetNominalGlyph(whole.get(), 'e', &e), GPGP_SUCCESS);
  ASSERT_EQ(gpgpGetNominalGlyph(whole.get(), 'a', &a), GPGP_SUCCESS);
  breakGlyph(bytes, e);
  Log log;
  for (const bool signToo : {false, true}) {
    if (signToo) breakGlyph(bytes, 0);
    const FontHandle font = openBytes(bytes, log);
    const GpgpFont raw = font.get();
    ASSERT_TRUE(raw);
    struct Seen {
      std::vector<float> points;
      bool broken = false;
      uint32_t glyph = 0;
    };
    const auto look = [&](GpgpFont from, uint32_t glyph) {
      Seen seen;
      GpgpGlyphOutlineInfo info = GPGP_GLYPH_OUTLINE_INFO_INIT;
      info.glyph = glyph;
      EXPECT_EQ(gpgpGetGlyphOutline(
                    from, &info,
                    [](void* user, const GpgpGlyphOutline* outline) {
                      auto& s = *static_cast<Seen*>(user);
                      s.broken = outline->broken;
                      s.glyph = outline->glyph;
                      for (uint32_t i = 0; i < outline->pathCount; ++i)
                        s.points.insert(s.points.end(), outline->paths[i].points,
                                        outline->paths[i].points + size_t(outline->paths[i].pointCount) * 2);
                    },
                    &seen),
                GPGP_SUCCESS);
      return seen;
    };
    const Seen sign = look(whole.get(), 0), seen = look(raw, e);
    EXPECT_TRUE(seen.broken);
    EXPECT_EQ(seen.glyph, e);
    if (signToo)
      EXPECT_TRUE(seen.points.empty());
    else
      EXPECT_EQ(seen.points, sign.points);
    EXPECT_GT(sign.points.size(), 8u);
    EXPECT_NE(log.text.find("glyph " + std::to_string(e)), std::string::npos) << log.text;
    EXPECT_NE(log.text.find("named e "), std::string::npos) << log.text;
    EXPECT_FALSE(look(raw, a).broken) << "others are as they were";
    EXPECT_EQ(look(raw, a).points, look(whole.get(), a).points);
    Paper paper; // it is laid out as before
    const std::vector<GpgpFont> fonts = {raw};
    ASSERT_EQ(paper.set(textInfo("cheese", fonts, 20)), GPGP_SUCCESS);
    EXPECT_EQ(paper.info.glyphCount, 6u);
    EXPECT_EQ(paper.info.missingCount, 0u);
  }
}

TEST(TextFont, AFontThatIsCutOffIsRefused) { // FreeType opens some, and says that their glyphs are empty
  GPGP_NEEDS_FONTS();
  for (const char* name : {"DejaVuSans.ttf", "Inter-roman.var.ttf", "Cantarell-Regular.otf", "AmiriQuranColored.ttf"}) {
    if (!std::filesystem::exists(fontPath(name))) continue;
    const std::vector<char> bytes = bytesOf(fontPath(name));
    for (const double part : {0.05, 0.2, 0.35, 0.5, 0.7}) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(part));
      std::vector<char> cut = bytes;
      cut.resize(static_cast<size_t>(part * static_cast<double>(bytes.size())));
      Log log;
      openBytes(cut, log, GPGP_ERROR_INVALID_DATA);
      EXPECT_FALSE(log.text.empty());
    }
  }
}

TEST(TextFont, ABrokenBitmapIsDrawnAsMissing) {
  GPGP_NEEDS_FONTS();
  std::vector<char> bytes = bytesOf(fontPath("NotoColorEmoji.ttf"));
  const FontHandle whole = openFont("NotoColorEmoji.ttf");
  uint32_t id = 0;
  ASSERT_EQ(gpgpGetNominalGlyph(whole.get(), 0x1f600, &id), GPGP_SUCCESS);
  const size_t pictures = tableOf(bytes, "CBDT");
  const std::string png = "\x89PNG";
  size_t broken = 0;
  for (auto at = bytes.begin() + static_cast<std::ptrdiff_t>(pictures);
       (at = std::search(at, bytes.end(), png.begin(), png.end())) != bytes.end(); ++at, ++broken)
    *at = 0;
  ASSERT_GT(broken, 1000u);
  Log log;
  const FontHandle font = openBytes(bytes, log);
  EXPECT_FALSE(glyphOf(whole.get(), id).outline.broken);
  EXPECT_TRUE(glyphOf(font.get(), id).outline.broken);
  EXPECT_NE(log.text.find("glyph " + std::to_string(id) + " has a broken bitmap"), std::string::npos) << log.text;
  uint32_t space = 0;
  ASSERT_EQ(gpgpGetNominalGlyph(font.get(), ' ', &space), GPGP_SUCCESS);
  EXPECT_FALSE(glyphOf(font.get(), space).outline.broken) << "has none";
}

TEST(TextFont, CharactersOfGlyphsThatAreNotThereAreMissing) {
  GPGP_NEEDS_FONTS();
  std::vector<char> bytes = bytesOf(fontPath("DejaVuSans.ttf"));
  const size_t count = tableOf(bytes, "maxp") + 4;
  bytes[count] = 0;
  bytes[count + 1] = 32;
  Log log;
  const FontHandle font = openBytes(bytes, log);
  ASSERT_EQ(infoOf(font.get()).glyphCount, 32u);
  Paper paper;
  ASSERT_EQ(paper.set(textInfo("!Hi", {font.get()}, 20)), GPGP_SUCCESS);
  ASSERT_EQ(paper.info.glyphCount, 3u);
  for (uint32_t i = 0; i < 3; ++i) EXPECT_LT(paper.info.glyphs[i].glyph, 32u);
  ASSERT_EQ(paper.info.missingCount, 2u);
  EXPECT_EQ(paper.info.missing[0].character, uint32_t('H'));
}

TEST(TextFont, IsSharedByThreads) {
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("DejaVuSans.ttf");
  std::vector<double> areas(4);
  std::vector<std::thread> threads;
  for (double& area : areas)
    threads.emplace_back([&] {
      Paper paper;
      const std::string text = "shared by threads";
      for (int i = 0; i < 20; ++i) {
        ASSERT_EQ(paper.set(textInfo(text, {font.get()}, 10 + float(i))), GPGP_SUCCESS);
        for (uint32_t g = 0; g < paper.info.glyphCount; ++g)
          for (const Shape& shape : glyphOf(font.get(), paper.info.glyphs[g].glyph).shapes) area += shape.area;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_NE(areas[0], 0);
  for (const double area : areas) EXPECT_EQ(area, areas[0]);
}
