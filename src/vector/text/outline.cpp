// Glyphs to paths: FreeType's unhinted outlines at a size where a font unit is a pixel (or half of one), so that
// its 26.6 points keep what variations add to a unit (but for the places of a composite glyph's parts, which it rounds
// to units), and HarfBuzz's of CFF2, whose parts of a unit FreeType drops; and bitmap glyphs to images with their box.
#include "vector/text/color_picture.h"
#include "vector/text/glyph_paths.h"

#include <algorithm>
#include <cmath>

namespace gpgp::text {

Affine concat(const Affine& o, const Affine& i) {
  return {o[0] * i[0] + o[2] * i[1], o[1] * i[0] + o[3] * i[1],        o[0] * i[2] + o[2] * i[3],
          o[1] * i[2] + o[3] * i[3], o[0] * i[4] + o[2] * i[5] + o[4], o[1] * i[4] + o[3] * i[5] + o[5]};
}

void GlyphPaths::begin(float x, float y) {
  if (open_) verbs_.push_back(GPGP_PATH_CLOSE);
  open_ = true;
  verbs_.push_back(GPGP_PATH_MOVE);
  point(x, y);
}

void GlyphPaths::point(float x, float y) {
  x *= scale_;
  y *= scale_;
  const Affine& m = transform_;
  points_.push_back(m[0] * x + m[2] * y + m[4]);
  points_.push_back(-(m[1] * x + m[3] * y + m[5]));
}

bool GlyphPaths::decompose(FT_Outline& outline) {
  FT_Outline_Funcs functions{};
  functions.move_to = [](const FT_Vector* to, void* user) {
    static_cast<GlyphPaths*>(user)->begin(static_cast<float>(to->x), static_cast<float>(to->y));
    return 0;
  };
  functions.line_to = [](const FT_Vector* to, void* user) {
    auto& self = *static_cast<GlyphPaths*>(user);
    self.verbs_.push_back(GPGP_PATH_LINE);
    self.point(static_cast<float>(to->x), static_cast<float>(to->y));
    return 0;
  };
  functions.conic_to = [](const FT_Vector* control, const FT_Vector* to, void* user) {
    auto& self = *static_cast<GlyphPaths*>(user);
    self.verbs_.push_back(GPGP_PATH_QUAD);
    for (const FT_Vector* at : {control, to}) self.point(static_cast<float>(at->x), static_cast<float>(at->y));
    return 0;
  };
  functions.cubic_to = [](const FT_Vector* first, const FT_Vector* second, const FT_Vector* to, void* user) {
    auto& self = *static_cast<GlyphPaths*>(user);
    self.verbs_.push_back(GPGP_PATH_CUBIC);
    for (const FT_Vector* at : {first, second, to}) self.point(static_cast<float>(at->x), static_cast<float>(at->y));
    return 0;
  };
  return FT_Outline_Decompose(&outline, &functions, this) == 0;
}

void GlyphPaths::draw(const Font& font, uint32_t glyph) { // CFF2 has lines and cubics
  const Owned<hb_draw_funcs_t> functions(hb_draw_funcs_create());
  hb_draw_funcs_set_move_to_func(
      functions.get(),
      [](hb_draw_funcs_t*, void* user, hb_draw_state_t*, float x, float y, void*) {
        static_cast<GlyphPaths*>(user)->begin(x, y);
      },
      nullptr, nullptr);
  hb_draw_funcs_set_line_to_func(
      functions.get(),
      [](hb_draw_funcs_t*, void* user, hb_draw_state_t*, float x, float y, void*) {
        auto& self = *static_cast<GlyphPaths*>(user);
        self.verbs_.push_back(GPGP_PATH_LINE);
        self.point(x, y);
      },
      nullptr, nullptr);
  hb_draw_funcs_set_cubic_to_func(
      functions.get(),
      [](hb_draw_funcs_t*, void* user, hb_draw_state_t*, float ax, float ay, float bx, float by, float x, float y,
         void*) {
        auto& self = *static_cast<GlyphPaths*>(user);
        self.verbs_.push_back(GPGP_PATH_CUBIC);
        self.point(ax, ay);
        self.point(bx, by);
        self.point(x, y);
      },
      nullptr, nullptr);
#if HB_VERSION_ATLEAST(7, 0, 0)
  hb_font_draw_glyph(font.shaping(), glyph, functions.get(), this);
#else
  hb_font_get_glyph_shape(font.shaping(), glyph, functions.get(), this);
#endif
}

Result<void> GlyphPaths::addGlyph(Font& font, uint32_t glyph, const Affine& transform) {
  const FT_Face face = font.opened().outlines.get(); // also where HarfBuzz draws, which does not say what is broken
  if (const FT_Error error = FT_Load_Glyph(face, glyph, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP))
    return makeError(GPGP_ERROR_INVALID_DATA, "glyph %u is broken (FreeType's error %d)", glyph, error);
  if (face->glyph->format != FT_GLYPH_FORMAT_OUTLINE)
    return makeError(GPGP_ERROR_INVALID_DATA, "glyph %u has no outline", glyph);
  const bool compact = font.opened().variesCompact;
  scale_ = compact ? font.emPerShapingUnit() : font.opened().emPerUnit;
  transform_ = transform;
  open_ = false;
  const auto before = static_cast<std::ptrdiff_t>(points_.size());
  bool whole = true;
  if (compact)
    draw(font, glyph);
  else
    whole = decompose(face->glyph->outline);
  if (open_) verbs_.push_back(GPGP_PATH_CLOSE);
  if (!whole ||
      !std::all_of(points_.begin() + before, points_.end(), [](float value) { return std::abs(value) <= 1e7f; }))
    return makeError(GPGP_ERROR_INVALID_DATA, "glyph %u has a broken outline", glyph);
  return {};
}

GlyphPaths::Part* GlyphPaths::close() {
  const uint32_t verbs = static_cast<uint32_t>(verbs_.size()), points = static_cast<uint32_t>(points_.size() / 2);
  if ((parts_.empty() ? 0 : parts_.back().verbs) == verbs) return nullptr;
  parts_.push_back({verbs, points, {}, nullptr, nullptr});
  return &parts_.back();
}

void GlyphPaths::paint(const float (&color)[4], bool foreground, const GpgpStroke* stroke) {
  Part* part = close();
  if (!part) return;
  std::copy_n(color, 4, part->color);
  part->stroke = stroke;
  foreground_.push_back(foreground);
}

void GlyphPaths::paint(const GpgpGradient& gradient, const float (&color)[4]) {
  Part* part = close();
  if (!part) return;
  std::copy_n(color, 4, part->color);
  const auto& stops = stops_.emplace_back(gradient.stops, gradient.stops + gradient.stopCount);
  part->gradient = &gradients_.emplace_back(gradient);
  gradients_.back().stops = stops.data();
  foreground_.push_back(VK_FALSE);
}

GpgpGlyphOutline GlyphPaths::outline(uint32_t glyph) {
  GpgpGlyphOutline result{};
  result.glyph = glyph;
  uint32_t verb = 0, at = 0;
  for (const Part& part : parts_) {
    GpgpPath path{};
    path.verbs = verbs_.data() + verb;
    path.verbCount = part.verbs - verb;
    path.points = points_.data() + size_t(at) * 2;
    path.pointCount = part.points - at;
    path.fillRule = GPGP_FILL_NON_ZERO;
    std::copy_n(part.color, 4, path.color);
    path.gradient = part.gradient;
    path.stroke = part.stroke;
    paths_.push_back(path);
    verb = part.verbs;
    at = part.points;
  }
  result.paths = paths_.data();
  result.pathCount = static_cast<uint32_t>(paths_.size());
  result.foreground = foreground_.data();
  for (size_t i = 0; i + 1 < size_t(at) * 2; i += 2) {
    for (size_t axis = 0; axis < 2; ++axis) {
      const float value = points_[i + axis];
      result.box[axis] = i == 0 ? value : std::min(result.box[axis], value);
      result.box[axis + 2] = i == 0 ? value : std::max(result.box[axis + 2], value);
    }
  }
  return result;
}

namespace {

struct Picture {
  std::vector<uint8_t> pixels;
  GpgpGlyphImage image{};
};

/// The glyph's bitmap of the largest strike, nothing where it has none in colour; an error where it is broken. Leaves
/// FreeType's size as it was.
Result<Picture> loadPicture(Font& font, uint32_t glyph) {
  Picture picture;
  OpenFont& open = font.opened();
  const FT_Face face = open.outlines.get();
  int strike = 0;
  for (int i = 1; i < face->num_fixed_sizes; ++i)
    if (face->available_sizes[i].y_ppem > face->available_sizes[strike].y_ppem) strike = i;
  if (face->num_fixed_sizes == 0 || FT_Select_Size(face, strike)) return picture;
  const FT_Bitmap_Size size = face->available_sizes[strike];
  const FT_Error error = FT_Load_Glyph(face, glyph, FT_LOAD_COLOR | FT_LOAD_NO_HINTING);
  const FT_Bitmap& bitmap = face->glyph->bitmap;
  if (!error && face->glyph->format == FT_GLYPH_FORMAT_BITMAP && bitmap.pixel_mode == FT_PIXEL_MODE_BGRA &&
      bitmap.width && bitmap.rows && size.x_ppem > 0 && size.y_ppem > 0) {
    picture.pixels.resize(size_t(4) * bitmap.width * bitmap.rows);
    uint8_t* to = picture.pixels.data();
    for (unsigned row = 0; row < bitmap.rows; ++row) {
      const uint8_t* from = bitmap.buffer + static_cast<std::ptrdiff_t>(row) * bitmap.pitch;
      for (unsigned column = 0; column < bitmap.width; ++column, from += 4, to += 4) {
        const unsigned alpha = from[3]; // premultiplied, blue first
        for (int c = 0; c < 3; ++c)
          to[c] = static_cast<uint8_t>(alpha ? std::min(255u, (from[2 - c] * 255u + alpha / 2) / alpha) : 0);
        to[3] = static_cast<uint8_t>(alpha);
      }
    }
    const float x = 64.f / static_cast<float>(size.x_ppem), y = 64.f / static_cast<float>(size.y_ppem);
    const float left = static_cast<float>(face->glyph->bitmap_left) * x;
    const float top = -static_cast<float>(face->glyph->bitmap_top) * y;
    picture.image = {
        picture.pixels.data(),
        bitmap.width,
        bitmap.rows,
        {left, top, left + static_cast<float>(bitmap.width) * x, top + static_cast<float>(bitmap.rows) * y}};
  }
  if (open.emPerUnit > 0) FT_Set_Char_Size(face, 0, static_cast<FT_F26Dot6>(std::lround(1 / open.emPerUnit)), 72, 72);
  if (error && error != FT_Err_Missing_Bitmap)
    return makeError(GPGP_ERROR_INVALID_DATA, "glyph %u has a broken bitmap (FreeType's error %d)", glyph, error);
  return picture;
}

} // namespace

namespace {

/// The glyph's paths, or its picture. `font` is locked.
Result<void> collect(Font& font, const GpgpGlyphOutlineInfo& info, GlyphPaths& paths, Picture& picture,
                     bool& incomplete) {
  const bool plain = info.plain || info.stroke, scalable = font.opened().emPerUnit > 0;
  const GpgpFontColors colors = font.info().colors;
  if (!plain && scalable && (colors & (GPGP_FONT_COLOR_LAYERS | GPGP_FONT_COLOR_PAINTS))) {
    ColorPicture painted;
    const auto colored = addColors(font, info, paths, painted, incomplete);
    if (!colored) return colored.error();
    if (!painted.pixels.empty()) {
      paths = {};
      picture.pixels = std::move(painted.pixels);
      picture.image = {picture.pixels.data(), painted.width, painted.height, {}};
      std::copy_n(painted.box, 4, picture.image.box);
    }
    if (*colored) return {};
  }
  if (!plain && (colors & GPGP_FONT_COLOR_BITMAPS)) {
    auto loaded = loadPicture(font, info.glyph);
    if (!loaded && !scalable) return loaded.error();
    if (loaded) picture = std::move(*loaded);
    if (!picture.pixels.empty()) return {};
  }
  if (!scalable) return {};
  if (auto ok = paths.addGlyph(font, info.glyph, kIdentity); !ok) return ok;
  const float black[4] = {0, 0, 0, 1};
  const bool unset = std::all_of(info.color, info.color + 4, [](float value) { return value == 0; });
  if (unset)
    paths.paint(black, true, info.stroke);
  else
    paths.paint(info.color, true, info.stroke);
  if (!plain && (colors & GPGP_FONT_COLOR_SVG)) incomplete = true;
  return {};
}

void warn(const Font& font, const core::Error& warning) {
  font.messages.send(GPGP_SEVERITY_WARNING, warning.code, "gpgpGetGlyphOutline", warning.text);
}

} // namespace

Result<void> deliverGlyph(Font& font, const GpgpGlyphOutlineInfo& info, GpgpGlyphFn glyphFn, void* userData) {
  GlyphPaths paths;
  Picture picture;
  bool incomplete = false;
  Result<void> whole;
  {
    const std::lock_guard lock(font.opened().lock);
    whole = collect(font, info, paths, picture, incomplete);
    if (!whole) { // the sign for a missing character instead; nothing where that is broken, too
      GpgpGlyphOutlineInfo sign = info;
      sign.glyph = 0;
      paths = {};
      if (info.glyph == 0 || !collect(font, sign, paths, picture, incomplete)) paths = {};
    }
  }
  if (!whole) {
    char name[64];
    hb_font_glyph_to_string(font.shaping(), info.glyph, name, sizeof name);
    warn(font, makeError(whole.error().code, "%s; it is named %s and drawn as a missing character", whole.error().text,
                         name));
  }
  if (incomplete)
    warn(font, makeError(GPGP_ERROR_UNSUPPORTED, "glyph %u has paints that are not supported", info.glyph));
  GpgpGlyphOutline outline = paths.outline(info.glyph);
  if (!picture.pixels.empty()) outline.image = &picture.image;
  outline.incomplete = incomplete;
  outline.broken = !whole;
  glyphFn(userData, &outline);
  return {};
}

} // namespace gpgp::text
