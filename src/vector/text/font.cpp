// Opens fonts and reads what they say of themselves.
#include "vector/text/font.h"

#include "core/open_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <span>

#include FT_FONT_FORMATS_H
#include FT_MULTIPLE_MASTERS_H
#include <hb-ot.h>
#include <unicode/uchar.h>

namespace gpgp::text {
namespace {

struct TagText {
  char text[5];
  explicit TagText(GpgpTag tag) {
    for (int i = 0; i < 4; ++i) {
      const char letter = static_cast<char>(tag >> (24 - 8 * i) & 255);
      text[i] = letter >= ' ' && letter <= '~' ? letter : '?';
    }
    text[4] = 0;
  }
};

/// Beside those that may be emoji, as U+2139.
bool hasLetters(hb_face_t* face) {
  const std::unique_ptr<hb_set_t, void (*)(hb_set_t*)> characters(hb_set_create(), hb_set_destroy);
  hb_face_collect_unicodes(face, characters.get());
  for (hb_codepoint_t c = HB_SET_VALUE_INVALID; hb_set_next(characters.get(), &c);) {
    const auto character = static_cast<UChar32>(c);
    if (u_isalpha(character) && !u_hasBinaryProperty(character, UCHAR_EMOJI)) return true;
  }
  return false;
}

Result<std::vector<char>> readFile(const char* path, const GpgpFileSystem* fileSystem) {
  if (fileSystem && fileSystem->read) {
    size_t size = 0;
    if (const GpgpResult code = fileSystem->read(fileSystem->userData, path, nullptr, 0, &size); code != GPGP_SUCCESS)
      return makeError(GPGP_ERROR_IO, "cannot read %s: the file callback returned %d", path, code);
    std::vector<char> bytes(size);
    if (const GpgpResult code = fileSystem->read(fileSystem->userData, path, bytes.data(), bytes.size(), &size);
        code != GPGP_SUCCESS || size != bytes.size())
      return makeError(GPGP_ERROR_IO, "cannot read %s: the file callback returned %d and %zu bytes", path, code, size);
    return bytes;
  }
  const core::File file = core::openToRead(path);
  if (!file) return makeError(GPGP_ERROR_IO, "cannot open %s", path);
  std::vector<char> bytes;
  char block[1 << 16];
  while (const size_t count = std::fread(block, 1, sizeof block, file.get()))
    bytes.insert(bytes.end(), block, block + count);
  if (std::ferror(file.get())) return makeError(GPGP_ERROR_IO, "cannot read %s", path);
  return bytes;
}

std::string nameOf(hb_face_t* face, hb_ot_name_id_t id) {
  const hb_language_t english = hb_language_from_string("en", -1);
  char text[256];
  unsigned size = sizeof text;
  if (hb_ot_name_get_utf8(face, id, english, &size, text) == 0) return {};
  return std::string(text, std::min<size_t>(size, sizeof text - 1));
}

/// A table that does not lie within the file, 0 where all do. FreeType leaves such a one out, and may say that all
/// glyphs are empty then; browsers refuse the font.
GpgpTag cutOffTable(std::span<const unsigned char> bytes, uint32_t face) {
  const auto number = [&](uint64_t at, int count) {
    uint64_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | (at + i < bytes.size() ? bytes[at + i] : 0);
    return value;
  };
  const uint64_t start = number(0, 4) == GPGP_TAG('t', 't', 'c', 'f') ? number(12 + 4 * uint64_t(face), 4) : 0;
  const uint64_t count = number(start + 4, 2);
  for (uint64_t at = start + 12; at < start + 12 + 16 * count; at += 16) {
    if (number(at + 8, 4) + number(at + 12, 4) > bytes.size()) return static_cast<GpgpTag>(number(at, 4));
  }
  return 0;
}

/// The size at which FreeType scales outlines: units become pixels, so that 26.6 keeps parts of a unit. Its CFF engine
/// refuses sizes beyond 2000.
uint32_t outlineSize(FT_Face face) {
  uint32_t size = face->units_per_EM;
  const bool compact = std::strcmp(FT_Get_Font_Format(face), "CFF") == 0;
  while (compact && size > 2000) size /= 2;
  return size;
}

} // namespace

Result<void> Font::openBoth(const GpgpFontCreateInfo& info) {
  OpenFont& open = *open_;
  const char* bytes = static_cast<const char*>(info.data);
  size_t size = info.size;
  if (info.filePath) {
    auto read = readFile(info.filePath, info.fileSystem);
    if (!read) return read.error();
    open.bytes = std::move(*read);
  } else if (!info.keepData) {
    open.bytes.assign(bytes, bytes + size);
  }
  if (info.filePath || !info.keepData) {
    bytes = open.bytes.data();
    size = open.bytes.size();
  }
  if (size > 0x7fffffff) return makeError(GPGP_ERROR_UNSUPPORTED, "the font has 2 GiB or more");

  FT_Library library = nullptr;
  if (FT_Init_FreeType(&library)) return makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "FreeType cannot start");
  open.library.reset(library);
  FT_Face outlines = nullptr;
  const auto openFace = [&](FT_Long index) {
    return FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(bytes), static_cast<FT_Long>(size), index,
                              &outlines);
  };
  if (const FT_Error error = openFace(-1))
    return makeError(GPGP_ERROR_INVALID_DATA, "not a font, or a broken one (FreeType's error %d)", error);
  const uint32_t faces = static_cast<uint32_t>(std::clamp<FT_Long>(outlines->num_faces, 1, 65535));
  FT_Done_Face(outlines);
  if (info.face >= faces)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "face is %u, but there are %u", info.face, faces);
  if (const FT_Error error = openFace(static_cast<FT_Long>(info.face)))
    return makeError(GPGP_ERROR_INVALID_DATA, "face %u is broken (FreeType's error %d)", info.face, error);
  open.outlines.reset(outlines);

  const Owned<hb_blob_t> blob(
      hb_blob_create(bytes, static_cast<unsigned>(size), HB_MEMORY_MODE_READONLY, nullptr, nullptr));
  open.face.reset(hb_face_create(blob.get(), info.face));
  const uint32_t glyphs = hb_face_get_glyph_count(open.face.get());
  if (!FT_IS_SFNT(outlines) || glyphs == 0)
    return makeError(GPGP_ERROR_UNSUPPORTED, "a font without OpenType tables (%s)", FT_Get_Font_Format(outlines));
  if (const GpgpTag tag = cutOffTable({reinterpret_cast<const unsigned char*>(bytes), size}, info.face))
    return makeError(GPGP_ERROR_INVALID_DATA, "its table '%s' ends beyond the file", TagText(tag).text);
  info_.face = info.face;
  info_.faceCount = faces;
  info_.glyphCount = std::min<uint32_t>(glyphs, static_cast<uint32_t>(outlines->num_glyphs));
  info_.unitsPerEm = hb_face_get_upem(open.face.get());

  // Axes: values for both, in the font's order.
  unsigned count = hb_ot_var_get_axis_count(open.face.get());
  std::vector<hb_ot_var_axis_info_t> axes(count);
  hb_ot_var_get_axis_infos(open.face.get(), 0, &count, axes.data());
  for (const auto& axis : axes) {
    names_.push_back(nameOf(open.face.get(), axis.name_id));
    axes_.push_back({axis.tag, nullptr, axis.min_value, axis.default_value, axis.max_value, axis.default_value});
  }
  for (uint32_t i = 0; i < info.axisCount; ++i) {
    const auto [tag, value] = info.axes[i];
    const auto named = [tag = tag](const GpgpFontAxis& axis) { return axis.tag == tag; };
    if (std::none_of(axes_.begin(), axes_.end(), named))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axes[%u]: the font has no axis '%s'", i, TagText(tag).text);
    for (GpgpFontAxis& axis : axes_) {
      if (!named(axis)) continue;
      if (!(value >= axis.minimum && value <= axis.maximum))
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axes[%u]: '%s' is %g; expected %g to %g", i, TagText(tag).text,
                         static_cast<double>(value), static_cast<double>(axis.minimum),
                         static_cast<double>(axis.maximum));
      axis.value = value;
    }
  }

  open.shaping.reset(hb_font_create(open.face.get()));
  const int scale = static_cast<int>(info_.unitsPerEm) * kUnits;
  hb_font_set_scale(open.shaping.get(), scale, scale);
  if (!axes_.empty()) {
    std::vector<float> values;
    std::vector<FT_Fixed> fixed;
    for (const GpgpFontAxis& axis : axes_) {
      values.push_back(axis.value);
      fixed.push_back(static_cast<FT_Fixed>(std::lround(static_cast<double>(axis.value) * 65536)));
    }
    hb_font_set_var_coords_design(open.shaping.get(), values.data(), static_cast<unsigned>(values.size()));
    if (FT_Set_Var_Design_Coordinates(outlines, static_cast<FT_UInt>(fixed.size()), fixed.data()))
      return makeError(GPGP_ERROR_INVALID_DATA, "its tables of variations are broken");
  }
  hb_font_make_immutable(open.shaping.get());
  const Owned<hb_blob_t> compact(hb_face_reference_table(open.face.get(), HB_TAG('C', 'F', 'F', '2')));
  open.variesCompact = !axes_.empty() && hb_blob_get_length(compact.get()) > 0;

  if (FT_IS_SCALABLE(outlines)) {
    const uint32_t pixels = outlineSize(outlines);
    if (pixels == 0 || FT_Set_Char_Size(outlines, 0, static_cast<FT_F26Dot6>(pixels) * 64, 72, 72))
      return makeError(GPGP_ERROR_INVALID_DATA, "its units per em are %u", outlines->units_per_EM);
    open.emPerUnit = 1.f / (64 * static_cast<float>(pixels));
  } else if (!FT_HAS_FIXED_SIZES(outlines)) {
    return makeError(GPGP_ERROR_INVALID_DATA, "it has neither outlines nor bitmaps");
  }
  return {};
}

void Font::readNames() {
  hb_face_t* face = open_->face.get();
  // Names point into names_, which grows no more after this.
  const auto first = [&](hb_ot_name_id_t id, hb_ot_name_id_t otherwise) {
    std::string name = nameOf(face, id);
    return name.empty() ? nameOf(face, otherwise) : name;
  };
  names_.push_back(first(HB_OT_NAME_ID_TYPOGRAPHIC_FAMILY, HB_OT_NAME_ID_FONT_FAMILY));
  names_.push_back(first(HB_OT_NAME_ID_TYPOGRAPHIC_SUBFAMILY, HB_OT_NAME_ID_FONT_SUBFAMILY));
  for (size_t i = 0; i < axes_.size(); ++i) axes_[i].name = names_[i].c_str();
  info_.family = names_[axes_.size()].c_str();
  info_.style = names_[axes_.size() + 1].c_str();
  info_.axes = axes_.data();
  info_.axisCount = static_cast<uint32_t>(axes_.size());
}

void Font::readMetrics() {
  hb_font_t* font = shaping();
  const float em = emPerShapingUnit();
  const auto metric = [&](hb_ot_metrics_tag_t tag, float otherwise) {
    hb_position_t value = 0;
    return hb_ot_metrics_get_position(font, tag, &value) ? static_cast<float>(value) * em : otherwise;
  };
  info_.ascent = metric(HB_OT_METRICS_TAG_HORIZONTAL_ASCENDER, 0.8f);
  info_.descent = -metric(HB_OT_METRICS_TAG_HORIZONTAL_DESCENDER, -0.2f);
  info_.lineGap = std::max(metric(HB_OT_METRICS_TAG_HORIZONTAL_LINE_GAP, 0), 0.f);
  info_.capHeight = metric(HB_OT_METRICS_TAG_CAP_HEIGHT, 0);
  info_.xHeight = metric(HB_OT_METRICS_TAG_X_HEIGHT, 0);
  // Tables give the upper edge of the strike and, in OpenType's words, of the underline; here it is the middle.
  info_.underlineThickness = metric(HB_OT_METRICS_TAG_UNDERLINE_SIZE, 0);
  if (info_.underlineThickness <= 0) info_.underlineThickness = 0.05f;
  info_.underlinePosition = -metric(HB_OT_METRICS_TAG_UNDERLINE_OFFSET, -0.1f) + info_.underlineThickness / 2;
  info_.strikeThickness = metric(HB_OT_METRICS_TAG_STRIKEOUT_SIZE, 0);
  if (info_.strikeThickness <= 0) info_.strikeThickness = info_.underlineThickness;
  info_.strikePosition = -metric(HB_OT_METRICS_TAG_STRIKEOUT_OFFSET, 0.3f) + info_.strikeThickness / 2;
  // Where the font does not say: a fifth and two fifths of an em (CSS Inline 3).
  info_.subscript = metric(HB_OT_METRICS_TAG_SUBSCRIPT_EM_Y_OFFSET, 0.2f);
  info_.superscript = metric(HB_OT_METRICS_TAG_SUPERSCRIPT_EM_Y_OFFSET, 0.4f);

  hb_face_t* face = open_->face.get();
  if (hb_ot_color_has_layers(face)) info_.colors |= GPGP_FONT_COLOR_LAYERS;
  const Owned<hb_blob_t> colr(hb_face_reference_table(face, HB_TAG('C', 'O', 'L', 'R')));
  unsigned size = 0;
  const char* bytes = hb_blob_get_data(colr.get(), &size);
  if (size >= 2 && (bytes[0] || bytes[1])) info_.colors |= GPGP_FONT_COLOR_PAINTS;
  if (hb_ot_color_has_png(face)) info_.colors |= GPGP_FONT_COLOR_BITMAPS;
  if (hb_ot_color_has_svg(face)) info_.colors |= GPGP_FONT_COLOR_SVG;
  emojiFont_ = info_.colors && !hasLetters(face);
  info_.paletteCount = hb_ot_color_palette_get_count(face);
}

Result<Font*> Font::create(const GpgpFontCreateInfo& info) {
  FontReference font(new Font);
  font->messages = messagesOf(info);
  font->open_ = std::make_unique<OpenFont>();
  if (auto ok = font->openBoth(info); !ok) return ok.error();
  font->readNames();
  font->readMetrics();
  return font.release();
}

} // namespace gpgp::text
