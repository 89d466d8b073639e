// The table COLR of a font with the colours of a palette, as what paints its glyphs reads them.
#pragma once
#include "vector/text/glyph_paths.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include <hb-ot.h>

namespace gpgp::text {

inline float linear(uint32_t srgb) {
  const float value = static_cast<float>(srgb) / 255;
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

/// A place in the table, read forwards. Beyond the table's end everything is 0, and `broken` set.
struct Reader {
  std::span<const uint8_t> table;
  size_t at = 0;
  bool broken = false;

  uint32_t bytes(size_t count) {
    if (at > table.size() || table.size() - at < count) {
      broken = true;
      return 0;
    }
    uint32_t value = 0;
    for (; count > 0; --count) value = value << 8 | table[at++];
    return value;
  }
  uint32_t u8() { return bytes(1); }
  uint32_t u16() { return bytes(2); }
  uint32_t u24() { return bytes(3); }
  uint32_t u32() { return bytes(4); }
  float i16() { return static_cast<float>(static_cast<int16_t>(bytes(2))); }
  float f2dot14() { return i16() / 16384; }
  float fixed() { return static_cast<float>(static_cast<int32_t>(bytes(4))) / 65536; }
  Reader from(size_t offset) const { return {table, offset}; }
};

/// Linear, straight alpha.
struct Color {
  float value[4];
  bool foreground;
};

class ColorTable {
public:
  ColorTable(Font& font, const GpgpGlyphOutlineInfo& info)
      : font_(font), info_(info), emPerUnit_(1.f / static_cast<float>(font.info().unitsPerEm)) {
    hb_face_t* face = font.opened().face.get();
    blob_.reset(hb_face_reference_table(face, HB_TAG('C', 'O', 'L', 'R')));
    unsigned size = 0;
    const char* bytes = hb_blob_get_data(blob_.get(), &size);
    table_.table = {reinterpret_cast<const uint8_t*>(bytes), size};
    const uint32_t palette = info.palette < font.info().paletteCount ? info.palette : 0;
    unsigned count = hb_ot_color_palette_get_colors(face, palette, 0, nullptr, nullptr);
    palette_.resize(count);
    hb_ot_color_palette_get_colors(face, palette, 0, &count, palette_.data());
    for (const GpgpFontAxis& axis : std::span(font.info().axes, font.info().axisCount))
      varied_ = varied_ || axis.value != axis.normal;
  }

protected:
  core::Error broken() const {
    return makeError(GPGP_ERROR_INVALID_DATA, "glyph %u: the table COLR is broken", info_.glyph);
  }

  Color color(uint32_t entry, float alpha) const {
    Color result{{0, 0, 0, 1}, false};
    if (entry == 0xffff) {
      result.foreground = true;
      if (std::any_of(info_.color, info_.color + 4, [](float value) { return value != 0; }))
        std::copy_n(info_.color, 4, result.value);
    } else if (entry < palette_.size()) {
      const hb_color_t from = palette_[entry];
      result = {{linear(hb_color_get_red(from)), linear(hb_color_get_green(from)), linear(hb_color_get_blue(from)),
                 static_cast<float>(hb_color_get_alpha(from)) / 255},
                false};
    }
    for (uint32_t i = 0; i < info_.colorCount; ++i)
      if (info_.colors[i].entry == entry) std::copy_n(info_.colors[i].color, 4, result.value);
    result.value[3] *= std::clamp(alpha, 0.f, 1.f);
    return result;
  }

  /// The record of a glyph among those that lie sorted at an offset.
  std::optional<size_t> find(size_t records, uint32_t count, size_t size, uint32_t glyph = ~0u) const {
    if (glyph == ~0u) glyph = info_.glyph;
    for (uint32_t low = 0, high = count; low < high;) {
      const uint32_t middle = low + (high - low) / 2;
      const size_t at = records + size * middle;
      Reader record = table_.from(at);
      const uint32_t there = record.u16();
      if (record.broken) return {};
      if (there == glyph) return at;
      (there < glyph ? low : high) = there < glyph ? middle + 1 : middle;
    }
    return {};
  }

  std::optional<size_t> paintOf(uint32_t glyph) const {
    Reader version = table_.from(0);
    if (version.u16() < 1) return {};
    const uint32_t list = table_.from(14).u32();
    if (list == 0) return {};
    const auto found = find(size_t(list) + 4, table_.from(list).u32(), 6, glyph);
    if (!found) return {};
    return list + table_.from(*found + 2).u32();
  }

  float em(float units) const { return units * emPerUnit_; }

  /// m about a point that follows in the table.
  Affine around(const Affine& m, Reader& center) const {
    const float x = em(center.i16()), y = em(center.i16());
    return concat({1, 0, 0, 1, x, y}, concat(m, {1, 0, 0, 1, -x, -y}));
  }

  /// Of a paint from format 12 to 31, whose format was read: where what it transforms lies from `offset`, and how.
  /// Variable formats have their normal form. Nothing where the table ends.
  std::optional<std::pair<uint32_t, Affine>> transformOf(Reader paint, size_t offset, uint32_t format) const {
    constexpr float pi = 3.14159265358979f;
    const uint32_t child = paint.u24(), kind = format & ~1u;
    Affine m = kIdentity;
    const auto about = [&](const Affine& inner, bool hasCenter) { return hasCenter ? around(inner, paint) : inner; };
    switch (kind) {
    case 12: {
      Reader a = table_.from(offset + paint.u24());
      for (size_t i = 0; i < 6; ++i) m[i] = i < 4 ? a.fixed() : em(a.fixed());
      if (a.broken) return {};
      break;
    }
    case 14: m[4] = em(paint.i16()), m[5] = em(paint.i16()); break;
    case 16:   // scale in x and y
    case 18:   // the same about a point
    case 20:   // alike in both
    case 22: { // the same about a point
      const float x = paint.f2dot14(), y = kind < 20 ? paint.f2dot14() : x;
      m = about({x, 0, 0, y, 0, 0}, kind == 18 || kind == 22);
      break;
    }
    case 24:
    case 26: { // rotate: half turns
      const float angle = paint.f2dot14() * pi, c = std::cos(angle), s = std::sin(angle);
      m = about({c, s, -s, c, 0, 0}, kind == 26);
      break;
    }
    default: { // skew
      const float x = std::tan(paint.f2dot14() * pi), y = std::tan(paint.f2dot14() * pi);
      m = about({1, y, -x, 1, 0, 0}, kind == 30);
      break;
    }
    }
    if (paint.broken) return {};
    return std::pair(child, m);
  }

  Font& font_;
  const GpgpGlyphOutlineInfo& info_;
  float emPerUnit_;
  Owned<hb_blob_t> blob_;
  Reader table_;
  std::vector<hb_color_t> palette_;
  bool varied_ = false;
};

} // namespace gpgp::text
