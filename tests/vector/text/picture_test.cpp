// A page in seven scripts: our outlines at our places filled by cairo, beside pango's layout of the same text as a path
// filled by the same cairo. Both are unhinted and placed in parts of a pixel, so what differs is the layout.
//
// Where GPGP_TEXT_PICTURES names a folder, both pages and their difference are written there.
#include "fonts.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fontconfig/fontconfig.h>
#include <pango/pangocairo.h>
#include <pango/pangofc-fontmap.h>

using namespace gpgp::test;

namespace {

constexpr int kWidth = 560, kMargin = 20;
constexpr float kSize = 20;

struct Surface {
  cairo_surface_t* surface;
  cairo_t* cairo;
  explicit Surface(int height) : surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, kWidth, height)) {
    cairo = cairo_create(surface);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    cairo_set_source_rgb(cairo, 0, 0, 0);
    cairo_set_tolerance(cairo, 0.01);
  }
  Surface(const Surface&) = delete;
  ~Surface() {
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
  }
  int at(int x, int y) const { // grey
    cairo_surface_flush(surface);
    return cairo_image_surface_get_data(surface)[y * cairo_image_surface_get_stride(surface) + x * 4];
  }
  void save(const char* name) const {
    if (const char* folder = std::getenv("GPGP_TEXT_PICTURES"))
      cairo_surface_write_to_png(surface, (std::string(folder) + "/" + name + ".png").c_str());
  }
};

/// Traces a glyph at its place.
void trace(cairo_t* cairo, const GpgpTextGlyph& glyph, double left, double top) {
  struct Place {
    cairo_t* cairo;
    double x, y, size;
  } place{cairo, left + double(glyph.x), top + double(glyph.y), double(glyph.size)};
  GpgpGlyphOutlineInfo info = GPGP_GLYPH_OUTLINE_INFO_INIT;
  info.glyph = glyph.glyph;
  const GpgpResult result = gpgpGetGlyphOutline(
      glyph.font, &info,
      [](void* user, const GpgpGlyphOutline* outline) {
        const auto [cr, x0, y0, size] = *static_cast<Place*>(user);
        for (uint32_t i = 0; i < outline->pathCount; ++i) {
          const GpgpPath& path = outline->paths[i];
          const float* p = path.points;
          const auto x = [&, x0 = x0, size = size](int k) { return x0 + double(p[2 * k]) * size; };
          const auto y = [&, y0 = y0, size = size](int k) { return y0 + double(p[2 * k + 1]) * size; };
          for (uint32_t v = 0; v < path.verbCount; ++v) switch (path.verbs[v]) {
            case GPGP_PATH_MOVE: cairo_move_to(cr, x(0), y(0)), p += 2; break;
            case GPGP_PATH_LINE: cairo_line_to(cr, x(0), y(0)), p += 2; break;
            case GPGP_PATH_QUAD: {
              double cx = 0, cy = 0;
              cairo_get_current_point(cr, &cx, &cy);
              cairo_curve_to(cr, cx + (x(0) - cx) * 2 / 3, cy + (y(0) - cy) * 2 / 3, x(1) + (x(0) - x(1)) * 2 / 3,
                             y(1) + (y(0) - y(1)) * 2 / 3, x(1), y(1));
              p += 4;
              break;
            }
            case GPGP_PATH_CUBIC: cairo_curve_to(cr, x(0), y(0), x(1), y(1), x(2), y(2)), p += 6; break;
            default: cairo_close_path(cr);
            }
        }
      },
      &place);
  EXPECT_EQ(result, GPGP_SUCCESS);
}

} // namespace

TEST(TextPicture, APageInSevenScriptsIsPangos) {
  GPGP_NEEDS_FONTS();
  FcConfig* config = FcConfigCreate();
  for (const Sample& sample : samples())
    ASSERT_TRUE(FcConfigAppFontAddFile(config, reinterpret_cast<const FcChar8*>(fontPath(sample.font).c_str())));
  PangoFontMap* map = pango_cairo_font_map_new_for_font_type(CAIRO_FONT_TYPE_FT);
  pango_fc_font_map_set_config(PANGO_FC_FONT_MAP(map), config);
  pango_cairo_font_map_set_resolution(PANGO_CAIRO_FONT_MAP(map), 72);

  // A paragraph of each script, in a font that has all of it (where fonts change, which of them has a space is a matter
  // of taste; so is a Thai word that only one of two dictionaries knows), and one of mixed directions.
  std::vector<Sample> paragraphs = samples();
  paragraphs[2].text = "החלון פתוח בבוקר ואנשים הולכים לאט בדרך הארוכה";
  paragraphs[4].text = "ตอนเช้าหน้าต่างเปิดอยู่และผู้คนเดินช้าๆบนถนน";
  paragraphs.push_back({"mixed", "DejaVuSans.ttf", "en", "office (שלום 12.5% מחר) الطريق الطويل, [abc] end."});
  Surface ours(760), theirs(760), difference(760);
  double top = kMargin;
  Paper paper;
  for (const Sample& sample : paragraphs) {
    SCOPED_TRACE(sample.name);
    const FontHandle font = openFont(sample.font, sample.face);
    const std::string family = infoOf(font.get()).family;
    const std::vector<GpgpFont> fonts = {font.get()};
    const std::string text = std::string(sample.text) + " " + sample.text;
    GpgpTextInfo info = textInfo(text, fonts, kSize, kWidth - 2 * kMargin);
    info.style.language = sample.language;
    ASSERT_EQ(paper.set(info), GPGP_SUCCESS);

    PangoContext* context = pango_font_map_create_context(map);
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(context, options);
    cairo_font_options_destroy(options);
    pango_context_set_round_glyph_positions(context, FALSE);
    PangoLayout* layout = pango_layout_new(context);
    pango_layout_set_text(layout, text.data(), static_cast<int>(text.size()));
    pango_layout_set_width(layout, (kWidth - 2 * kMargin) * PANGO_SCALE);
    pango_layout_set_wrap(layout, PANGO_WRAP_WORD_CHAR);
    PangoFontDescription* description = pango_font_description_new();
    pango_font_description_set_family(description, family.c_str());
    pango_font_description_set_absolute_size(description, double(kSize) * PANGO_SCALE);
    PangoAttrList* attributes = pango_attr_list_new();
    pango_attr_list_insert(attributes, pango_attr_font_desc_new(description));
    pango_attr_list_insert(attributes, pango_attr_language_new(pango_language_from_string(sample.language)));
    pango_layout_set_attributes(layout, attributes);
    pango_attr_list_unref(attributes);
    pango_font_description_free(description);

    // The same lines, as wide. Pango counts in 1/1024 pixels.
    ASSERT_EQ(pango_layout_get_line_count(layout), static_cast<int>(paper.info.lineCount));
    for (uint32_t i = 0; i < paper.info.lineCount; ++i) {
      const GpgpTextLine& line = paper.info.lines[i];
      PangoLayoutLine* other = pango_layout_get_line_readonly(layout, static_cast<int>(i));
      EXPECT_EQ(static_cast<int>(line.begin), other->start_index);
      EXPECT_EQ(line.rightToLeft != 0, other->resolved_dir == PANGO_DIRECTION_RTL);
      PangoRectangle extents{};
      pango_layout_line_get_extents(other, nullptr, &extents);
      EXPECT_NEAR(line.width, extents.width / double(PANGO_SCALE), 0.2) << "line " << i;
      // Lines of both at our places, as the distance of lines is a matter of taste.
      const double baseline = top + double(line.baseline);
      for (uint32_t g = 0; g < line.glyphCount; ++g)
        trace(ours.cairo, paper.info.glyphs[line.firstGlyph + g], kMargin, top);
      cairo_move_to(theirs.cairo, kMargin + double(line.left), baseline);
      pango_cairo_layout_line_path(theirs.cairo, other);
    }
    cairo_fill(ours.cairo);
    cairo_fill(theirs.cairo);
    g_object_unref(layout);
    g_object_unref(context);
    top += double(paper.info.height) + 8;
  }
  EXPECT_LT(top, 760);
  ours.save("gpgp");
  theirs.save("pango");

  double sum = 0, ink = 0;
  int different = 0;
  for (int y = 0; y < 760; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const int a = ours.at(x, y), b = theirs.at(x, y), off = std::abs(a - b);
      sum += off;
      ink += 255 - b;
      different += off > 32;
      const double grey = 1 - std::min(1., off / 64.);
      cairo_set_source_rgb(difference.cairo, grey, grey, grey);
      cairo_rectangle(difference.cairo, x, y, 1, 1);
      cairo_fill(difference.cairo);
    }
  difference.save("difference");
  const double pixels = 760. * kWidth;
  // In steps of 1/255: the mean over the page, and how many pixels are off by more than an eighth.
  EXPECT_GT(ink / pixels, 10);
  EXPECT_LT(sum / pixels, 0.2);
  EXPECT_EQ(different, 0);
  std::printf("mean %.4f of 255, %d of %.0f pixels off by more than 32\n", sum / pixels, different, pixels);
  g_object_unref(map);
  FcConfigDestroy(config);
}
