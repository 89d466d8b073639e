// Colour glyphs to painted paths: COLR version 0's layers, and of version 1 the graph of paints as far as it is shapes,
// each with a solid colour or a linear or radial gradient, transformed and laid over each other. Read from the table as
// the OpenType specification 1.9.1 has it: FreeType's own reading of version 1 is newer than what distributions ship.
//
// A graph with more than that (sweep gradients, composite modes other than source over, shapes in shapes) becomes a
// picture (color_picture.h). Where paints vary, their normal form is painted, and `incomplete` set. Tables that are
// broken, and graphs that go round in circles or are too large, end with an error.
#include "vector/text/color_picture.h"
#include "vector/text/color_table.h"

namespace gpgp::text {
namespace {

class Painter : ColorTable {
public:
  Painter(Font& font, const GpgpGlyphOutlineInfo& info, GlyphPaths& paths) : ColorTable(font, info), paths_(paths) {}

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
  /// Paths do not show all of it.
  bool needsPicture() const { return needsPicture_; }

private:
  struct Shape {
    uint32_t glyph;
    Affine transform;
  };

  Result<void> shape(uint32_t glyph, const Affine& transform) { return paths_.addGlyph(font_, glyph, transform); }

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
      if (shapeOf) needsPicture_ = true; // within a shape: the inner one alone is painted
      return walk(child, transform, &next, depth + 1);
    }
    case 2:
    case 4:
    case 6:
    case 8: {
      if (!shapeOf) { // would paint all the plane
        needsPicture_ = true;
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
    case 32: {
      const uint32_t source = paint.u24(), mode = paint.u8(), backdrop = paint.u24();
      constexpr uint32_t kClear = 0, kSource = 1, kBackdrop = 2, kSourceOver = 3;
      if (mode == kClear) return {};
      if (mode > kSourceOver) needsPicture_ = true;
      if (mode != kSource)
        if (auto ok = inner(backdrop, kIdentity); !ok) return ok;
      if (mode != kBackdrop) return inner(source, kIdentity);
      return {};
    }
    default: break;
    }
    if (format < 12 || format > 31) {
      incomplete_ = true;
      return {};
    }
    const auto moved = transformOf(paint, offset, format);
    if (!moved) return broken();
    return walk(offset + moved->first, concat(transform, moved->second), shapeOf, depth + 1);
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
      needsPicture_ = needsPicture_ || (!isLinear && (!isRadial || degenerate));
      paths_.paint(stops.back().color, false);
      return {};
    }
    const float opaque[4] = {0, 0, 0, 1};
    moved.stops = stops.data();
    moved.stopCount = static_cast<uint32_t>(stops.size());
    paths_.paint(moved, opaque);
    return {};
  }

  GlyphPaths& paths_;
  uint32_t visited_ = 0;
  bool incomplete_ = false, needsPicture_ = false;
};

} // namespace

Result<bool> addColors(Font& font, const GpgpGlyphOutlineInfo& info, GlyphPaths& paths, ColorPicture& picture,
                       bool& incomplete) {
  Painter painter(font, info, paths);
  auto done = painter.paints();
  if (done && !*done) done = painter.layers();
  incomplete = painter.incomplete();
  if (!done || !painter.needsPicture()) return done;
  auto painted = paintColorPicture(font, info);
  if (!painted)
    incomplete = true; // and the paths are what can be shown
  else if (painted->pixels.empty())
    paths = {}; // its clip box is empty
  else
    picture = std::move(*painted);
  return done;
}

} // namespace gpgp::text
