// Colour glyphs to painted paths: COLR version 0's layers, and of version 1 the graph of paints as far as it is shapes,
// each with a solid colour or a linear or radial gradient, transformed and laid over each other. Read from the table as
// the OpenType specification 1.9.1 has it: FreeType's own reading of version 1 is newer than what distributions ship.
//
// Of the rest (sweep gradients, composite modes other than source over, a shape cut out of another, variations of
// paints) what can be is painted, and `incomplete` set. Tables that are broken, and graphs that go round in circles or
// are too large, end with an error.
#include "vector/text/glyph_paths.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <hb-ot.h>

namespace gpgp::text {
namespace {

constexpr float kPi = 3.14159265358979f;

float linear(uint32_t srgb) {
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

struct Color {
  float value[4];
  bool foreground;
};

class Painter {
public:
  Painter(Font& font, const GpgpGlyphOutlineInfo& info, GlyphPaths& paths)
      : font_(font), info_(info), paths_(paths), emPerUnit_(1.f / static_cast<float>(font.info().unitsPerEm)) {
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

  /// Version 0. False: the glyph has no layers.
  Result<bool> layers() {
    Reader header = table_.from(2);
    const uint32_t count = header.u16(), bases = header.u32(), list = header.u32(), all = header.u16();
    const auto found = find(bases, count, 6);
    if (!found) return false;
    Reader record = table_.from(*found + 2);
    const uint32_t first = record.u16(), used = record.u16();
    if (record.broken || first + used > all) return broken();
    Reader layer = table_.from(size_t(list) + size_t(first) * 4);
    for (uint32_t i = 0; i < used; ++i) {
      const uint32_t glyph = layer.u16();
      const Color painted = color(layer.u16(), 1);
      if (layer.broken) return broken();
      if (auto ok = shape(glyph, kIdentity); !ok) return ok.error();
      paths_.paint(painted.value, painted.foreground);
    }
    return true;
  }

  /// Version 1. False: the glyph has no paint.
  Result<bool> paints() {
    const auto root = paintOf(info_.glyph);
    if (!root) return false;
    if (auto ok = walk(*root, kIdentity, nullptr, 0); !ok) return ok.error();
    return true;
  }

  bool incomplete() const { return incomplete_; }

private:
  struct Shape {
    uint32_t glyph;
    Affine transform;
  };

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

  Result<void> shape(uint32_t glyph, const Affine& transform) { return paths_.addGlyph(font_, glyph, transform); }

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

  /// The paint at an offset of the table.
  Result<void> walk(size_t offset, const Affine& transform, const Shape* shapeOf, int depth) {
    if (depth > 64 || ++visited_ > 65536)
      return makeError(GPGP_ERROR_INVALID_DATA, "glyph %u: its graph of paints is too deep or too large", info_.glyph);
    Reader paint = table_.from(offset);
    const uint32_t format = paint.u8();
    if (paint.broken) return broken();
    const bool variable = format >= 3 && format < 32 && format % 2 && format != 11; // as its normal form
    incomplete_ = incomplete_ || (variable && varied_);
    const auto inner = [&](uint32_t child, const Affine& m) -> Result<void> {
      if (paint.broken) return broken();
      return walk(offset + child, concat(transform, m), shapeOf, depth + 1);
    };
    switch (variable ? format - 1 : format) {
    case 1: { // layers
      const uint32_t count = paint.u8(), first = paint.u32(), list = table_.from(18).u32();
      Reader layers = table_.from(list);
      if (paint.broken || list == 0 || uint64_t(first) + count > layers.u32()) return broken();
      layers.at += size_t(first) * 4;
      for (uint32_t i = 0; i < count; ++i) {
        const size_t layer = list + size_t(layers.u32());
        if (layers.broken) return broken();
        if (auto ok = walk(layer, transform, shapeOf, depth + 1); !ok) return ok;
      }
      return {};
    }
    case 11: { // another glyph's paint
      const auto root = paintOf(paint.u16());
      if (paint.broken || !root) return broken();
      return walk(*root, transform, shapeOf, depth + 1);
    }
    case 10: { // a shape
      const size_t child = offset + paint.u24();
      const Shape next{paint.u16(), transform};
      if (paint.broken) return broken();
      if (shapeOf) incomplete_ = true; // within a shape: the inner one alone is painted
      return walk(child, transform, &next, depth + 1);
    }
    case 2:
    case 4:
    case 6:
    case 8: {
      if (!shapeOf) { // would paint all the plane
        incomplete_ = true;
        return {};
      }
      if (auto ok = shape(shapeOf->glyph, shapeOf->transform); !ok) return ok;
      if (format > 3) return gradient(paint, offset, format, transform);
      const uint32_t entry = paint.u16();
      const Color solid = color(entry, paint.f2dot14());
      if (paint.broken) return broken();
      paths_.paint(solid.value, solid.foreground);
      return {};
    }
    case 12: {
      const uint32_t child = paint.u24();
      Reader a = table_.from(offset + paint.u24());
      Affine m{};
      for (int i = 0; i < 6; ++i) m[static_cast<size_t>(i)] = i < 4 ? a.fixed() : em(a.fixed());
      if (a.broken) return broken();
      return inner(child, m);
    }
    case 14: {
      const uint32_t child = paint.u24();
      const float x = em(paint.i16()), y = em(paint.i16());
      return inner(child, {1, 0, 0, 1, x, y});
    }
    case 16:   // scale in x and y
    case 18:   // the same about a point
    case 20:   // alike in both
    case 22: { // the same about a point
      const uint32_t child = paint.u24(), kind = format & ~1u;
      const float x = paint.f2dot14(), y = kind < 20 ? paint.f2dot14() : x;
      const Affine m = {x, 0, 0, y, 0, 0};
      return inner(child, kind == 18 || kind == 22 ? around(m, paint) : m);
    }
    case 24:
    case 26: { // rotate: half turns
      const uint32_t child = paint.u24();
      const float angle = paint.f2dot14() * kPi, c = std::cos(angle), s = std::sin(angle);
      const Affine m = {c, s, -s, c, 0, 0};
      return inner(child, format >= 26 ? around(m, paint) : m);
    }
    case 28:
    case 30: { // skew
      const uint32_t child = paint.u24();
      const float x = std::tan(paint.f2dot14() * kPi), y = std::tan(paint.f2dot14() * kPi);
      const Affine m = {1, y, -x, 1, 0, 0};
      return inner(child, format >= 30 ? around(m, paint) : m);
    }
    case 32: {
      const uint32_t source = paint.u24(), mode = paint.u8(), backdrop = paint.u24();
      constexpr uint32_t kClear = 0, kSource = 1, kBackdrop = 2, kSourceOver = 3;
      if (mode == kClear) return {};
      if (mode > kSourceOver) incomplete_ = true;
      if (mode != kSource)
        if (auto ok = inner(backdrop, kIdentity); !ok) return ok;
      if (mode != kBackdrop) return inner(source, kIdentity);
      return {};
    }
    default: incomplete_ = true; return {};
    }
  }

  /// Paints the shape that was added last with a gradient.
  Result<void> gradient(Reader paint, size_t offset, uint32_t format, const Affine& transform) {
    const bool variable = format % 2, isLinear = format / 2 == 2, isRadial = format / 2 == 3;
    Reader line = table_.from(offset + paint.u24());
    GpgpGradient result{};
    const uint32_t extend = line.u8(), count = line.u16();
    result.spread = extend == 1 ? GPGP_SPREAD_REPEAT : extend == 2 ? GPGP_SPREAD_REFLECT : GPGP_SPREAD_PAD;
    std::vector<GpgpGradientStop> stops;
    for (uint32_t i = 0; i < count && !line.broken; ++i) {
      GpgpGradientStop stop{line.f2dot14(), {}};
      const uint32_t entry = line.u16();
      const Color painted = color(entry, line.f2dot14());
      if (variable) line.u32();
      std::copy_n(painted.value, 4, stop.color);
      stops.push_back(stop);
    }
    float numbers[6] = {};
    if (isLinear || isRadial)
      for (int i = 0; i < 6; ++i)
        numbers[i] = em(isRadial && i % 3 == 2 ? static_cast<float>(paint.u16()) : paint.i16());
    if (line.broken || paint.broken) return broken();
    if (stops.empty()) {
      const float nothing[4] = {};
      paths_.paint(nothing, false);
      return {};
    }
    std::stable_sort(stops.begin(), stops.end(), [](auto& a, auto& b) { return a.offset < b.offset; });
    result.interpolateSrgb = VK_TRUE;
    // y up in the font, down in the glyph
    for (size_t i = 0; i < 6; ++i) result.transform[i] = i % 2 ? -transform[i] : transform[i];
    float* start = result.start;
    float* end = result.end;
    start[0] = numbers[0], start[1] = numbers[1];
    if (isLinear) {
      // The colours run along the part of p0 -> p1 that is at right angles to p0 -> p2.
      const float x = numbers[2] - start[0], y = numbers[3] - start[1];
      const float nx = -(numbers[5] - start[1]), ny = numbers[4] - start[0];
      const float square = nx * nx + ny * ny;
      const float along = square > 0 ? (x * nx + y * ny) / square : 0;
      end[0] = start[0] + along * nx, end[1] = start[1] + along * ny;
      result.kind = GPGP_GRADIENT_LINEAR;
    } else if (isRadial) {
      result.startRadius = numbers[2];
      end[0] = numbers[3], end[1] = numbers[4], result.endRadius = numbers[5];
      result.kind = GPGP_GRADIENT_RADIAL;
    }
    // Stops may lie beyond 0 to 1: the ends move to where they do.
    const float first = stops.front().offset, last = stops.back().offset;
    const auto between = [](float a, float b, float t) { return a + (b - a) * t; };
    GpgpGradient moved = result;
    for (int i = 0; i < 2; ++i) {
      moved.start[i] = between(start[i], end[i], first);
      moved.end[i] = between(start[i], end[i], last);
    }
    moved.startRadius = between(result.startRadius, result.endRadius, first);
    moved.endRadius = between(result.startRadius, result.endRadius, last);
    for (GpgpGradientStop& stop : stops) stop.offset = last > first ? (stop.offset - first) / (last - first) : 0;
    if (isRadial && moved.startRadius > moved.endRadius) {
      std::swap(moved.startRadius, moved.endRadius);
      std::swap(moved.start, moved.end);
      std::reverse(stops.begin(), stops.end());
      for (GpgpGradientStop& stop : stops) stop.offset = 1 - stop.offset;
    }
    const bool degenerate = isLinear ? start[0] == end[0] && start[1] == end[1]
                                     : moved.startRadius < 0 || moved.startRadius >= moved.endRadius;
    if ((!isLinear && !isRadial) || !(last > first) || degenerate) {
      incomplete_ = incomplete_ || (!isLinear && (!isRadial || degenerate));
      paths_.paint(stops.back().color, false);
      return {};
    }
    const float opaque[4] = {0, 0, 0, 1};
    moved.stops = stops.data();
    moved.stopCount = static_cast<uint32_t>(stops.size());
    paths_.paint(moved, opaque);
    return {};
  }

  Font& font_;
  const GpgpGlyphOutlineInfo& info_;
  GlyphPaths& paths_;
  float emPerUnit_;
  Owned<hb_blob_t> blob_;
  Reader table_;
  std::vector<hb_color_t> palette_;
  uint32_t visited_ = 0;
  bool varied_ = false, incomplete_ = false;
};

} // namespace

Result<bool> addColors(Font& font, const GpgpGlyphOutlineInfo& info, GlyphPaths& paths, bool& incomplete) {
  Painter painter(font, info, paths);
  auto done = painter.paints();
  if (done && !*done) done = painter.layers();
  incomplete = painter.incomplete();
  return done;
}

} // namespace gpgp::text
