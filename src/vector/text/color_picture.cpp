// The graph is walked twice: once for the box of all its shapes, then with a layer of pixels to paint on. A shape is a
// mask of exact widths on eight lines a pixel; what is composited has layers of its own.
#include "vector/text/color_picture.h"

#include "vector/text/color_blend.h"
#include "vector/text/color_table.h"

#include <functional>

namespace gpgp::text {
namespace {

constexpr float kPi = 3.14159265358979f;

struct Vec {
  float x = 0, y = 0;
};
Vec mapped(const Affine& m, Vec p) { return {m[0] * p.x + m[2] * p.y + m[4], m[1] * p.x + m[3] * p.y + m[5]}; }

float encoded(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

using Mask = std::vector<float>; ///< how much of each pixel is covered
using Layer = std::vector<Pixel>;

/// Of a picture that covers a box of em.
struct Grid {
  uint32_t width = 0, height = 0;
  float left = 0, top = 0, scale = 1;
  size_t size() const { return size_t(width) * height; }
};

/// The area of a path whose points are in em, y down, by its non-zero rule.
class Rasteriser {
public:
  explicit Rasteriser(const Grid& grid) : grid_(grid), lines_(size_t(grid.height) * kLines) {}

  Mask cover(const GpgpPath& path) {
    const float* p = path.points;
    Vec at, start;
    const auto next = [&] {
      const Vec v{(p[0] - grid_.left) * grid_.scale, (p[1] - grid_.top) * grid_.scale};
      p += 2;
      return v;
    };
    const auto curve = [&](const std::function<Vec(float)>& place) {
      constexpr int kSteps = 24;
      for (int i = 1; i <= kSteps; ++i) {
        const Vec to = place(static_cast<float>(i) / kSteps);
        edge(at, to), at = to;
      }
    };
    for (uint32_t i = 0; i < path.verbCount; ++i) switch (path.verbs[i]) {
      case GPGP_PATH_MOVE: edge(at, start), at = start = next(); break;
      case GPGP_PATH_LINE: {
        const Vec to = next();
        edge(at, to), at = to;
        break;
      }
      case GPGP_PATH_QUAD: {
        const Vec a = at, b = next(), c = next();
        curve([&](float t) {
          const float u = 1 - t;
          return Vec{u * u * a.x + 2 * u * t * b.x + t * t * c.x, u * u * a.y + 2 * u * t * b.y + t * t * c.y};
        });
        break;
      }
      case GPGP_PATH_CUBIC: {
        const Vec a = at, b = next(), c = next(), d = next();
        curve([&](float t) {
          const float u = 1 - t, k[4] = {u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t};
          return Vec{k[0] * a.x + k[1] * b.x + k[2] * c.x + k[3] * d.x,
                     k[0] * a.y + k[1] * b.y + k[2] * c.y + k[3] * d.y};
        });
        break;
      }
      default: edge(at, start), at = start; break;
      }
    edge(at, start);
    Mask mask(grid_.size(), 0.f);
    for (size_t line = 0; line < lines_.size(); ++line) {
      auto& crossings = lines_[line];
      std::sort(crossings.begin(), crossings.end());
      int winding = 0;
      for (size_t k = 0; k + 1 < crossings.size(); ++k) {
        winding += crossings[k].second;
        if (winding != 0) span(mask.data() + line / kLines * grid_.width, crossings[k].first, crossings[k + 1].first);
      }
    }
    return mask;
  }

private:
  static constexpr size_t kLines = 8; // a pixel

  void edge(Vec a, Vec b) {
    const int direction = a.y < b.y ? 1 : -1;
    if (direction < 0) std::swap(a, b);
    const auto most = static_cast<float>(lines_.size());
    const float from = std::clamp(std::ceil(a.y * kLines - 0.5f), 0.f, most);
    const float to = std::clamp(std::ceil(b.y * kLines - 0.5f), 0.f, most);
    for (auto line = static_cast<size_t>(from); line < static_cast<size_t>(to); ++line) {
      const float y = (static_cast<float>(line) + 0.5f) / kLines;
      lines_[line].emplace_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y), direction);
    }
  }
  void span(float* row, float from, float to) const {
    from = std::clamp(from, 0.f, static_cast<float>(grid_.width));
    to = std::clamp(to, 0.f, static_cast<float>(grid_.width));
    for (auto x = static_cast<size_t>(from); static_cast<float>(x) < to; ++x) {
      const auto left = static_cast<float>(x);
      row[x] += (std::min(to, left + 1) - std::max(from, left)) / kLines;
    }
  }

  const Grid& grid_;
  std::vector<std::vector<std::pair<float, int>>> lines_;
};

/// The colours of a gradient along its parameter.
struct ColorLine {
  struct Stop {
    float offset;
    Pixel color; ///< encoded, straight alpha
  };
  std::vector<Stop> stops;
  uint32_t extend = 0; ///< 0: pad, 1: repeat, 2: reflect

  Pixel at(float t) const { // premultiplied
    if (stops.empty()) return {};
    const float first = stops.front().offset, range = stops.back().offset - first;
    if (extend != 0 && range > 0) {
      const float period = extend == 1 ? range : 2 * range;
      t = std::fmod(t - first, period);
      if (t < 0) t += period;
      if (t > range) t = 2 * range - t;
      t += first;
    }
    size_t i = 0;
    while (i < stops.size() && stops[i].offset <= t) ++i;
    Pixel color = stops[i == 0 ? 0 : i - 1].color;
    if (i > 0 && i < stops.size()) {
      const float part = (t - stops[i - 1].offset) / (stops[i].offset - stops[i - 1].offset);
      for (size_t c = 0; c < 4; ++c) color[c] += (stops[i].color[c] - color[c]) * part;
    }
    for (size_t c = 0; c < 3; ++c) color[c] *= color[3];
    return color;
  }
};

class PicturePainter : ColorTable {
public:
  using ColorTable::ColorTable;

  Result<ColorPicture> paint() {
    const auto root = paintOf(info_.glyph);
    if (!root) return broken();
    ColorPicture picture;
    Layer none;
    if (auto ok = walk(*root, kIdentity, nullptr, none, 0); !ok) return ok.error();
    if (fillsPlane_) { // as far as the em
      const GpgpFontInfo& font = font_.info();
      include(0, -font.ascent), include(1, font.descent);
    }
    clipToBox();
    const float width = box_[2] - box_[0], height = box_[3] - box_[1];
    if (!(width > 0 && height > 0)) return picture;
    grid_.scale = std::min(ColorPicture::kTexels, (ColorPicture::kMost - 4) / std::max(width, height));
    // The baseline and the origin lie between texels: edges of shapes that stand on them are not blurred.
    const auto first = [&](float side) { return std::floor(side * grid_.scale) - 1; };
    const auto count = [&](float from, float to) {
      return static_cast<uint32_t>(std::ceil(to * grid_.scale) + 1 - from);
    };
    const float left = first(box_[0]), top = first(box_[1]);
    grid_.width = count(left, box_[2]), grid_.height = count(top, box_[3]);
    grid_.left = left / grid_.scale, grid_.top = top / grid_.scale;
    visited_ = 0, isMeasured_ = true;
    Layer layer(grid_.size());
    Mask whole;
    if (isClipped_) whole = boxMask();
    if (auto ok = walk(*root, kIdentity, isClipped_ ? &whole : nullptr, layer, 0); !ok) return ok.error();
    picture.width = grid_.width, picture.height = grid_.height;
    const float right = grid_.left + static_cast<float>(grid_.width) / grid_.scale;
    const float sides[4] = {grid_.left, grid_.top, right, grid_.top + static_cast<float>(grid_.height) / grid_.scale};
    std::copy_n(sides, 4, picture.box);
    picture.pixels.reserve(4 * grid_.size());
    for (const Pixel& p : layer)
      for (size_t c = 0; c < 4; ++c) {
        const float value = c == 3 ? p[3] : p[3] > 0 ? p[c] / p[3] : 0;
        picture.pixels.push_back(static_cast<uint8_t>(std::lround(std::clamp(value, 0.f, 1.f) * 255)));
      }
    return picture;
  }

private:
  void include(float x, float y) {
    box_[0] = std::min(box_[0], x), box_[1] = std::min(box_[1], y);
    box_[2] = std::max(box_[2], x), box_[3] = std::max(box_[3], y);
  }

  /// The glyph's clip box, where the table has one.
  void clipToBox() {
    const uint32_t list = table_.from(22).u32();
    if (list == 0) return;
    Reader clips = table_.from(list);
    if (clips.u8() != 1) return;
    for (uint32_t i = 0, count = clips.u32(); i < count && !clips.broken; ++i) {
      const uint32_t first = clips.u16(), last = clips.u16(), at = clips.u24();
      if (clips.broken || info_.glyph < first || info_.glyph > last) continue;
      Reader box = table_.from(list + at);
      box.u8();
      const float left = em(box.i16()), bottom = em(box.i16()), right = em(box.i16()), top = em(box.i16());
      if (box.broken) return;
      const float sides[4] = {left, -top, right, -bottom};
      std::copy_n(sides, 4, clip_);
      isClipped_ = true;
      box_[0] = std::max(box_[0], left), box_[1] = std::max(box_[1], -top);
      box_[2] = std::min(box_[2], right), box_[3] = std::min(box_[3], -bottom);
      return;
    }
  }
  Mask boxMask() const {
    static constexpr GpgpPathVerb verbs[] = {GPGP_PATH_MOVE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_LINE};
    const float points[] = {clip_[0], clip_[1], clip_[2], clip_[1], clip_[2], clip_[3], clip_[0], clip_[3]};
    GpgpPath path{};
    path.verbs = verbs, path.verbCount = 4, path.points = points, path.pointCount = 4;
    return Rasteriser(grid_).cover(path);
  }

  Result<void> spend() {
    constexpr size_t most = 100'000'000; // pixels
    work_ += isMeasured_ ? grid_.size() : 1;
    if (work_ > most)
      return makeError(GPGP_ERROR_UNSUPPORTED, "glyph %u: its graph of paints takes too much work", info_.glyph);
    return {};
  }

  Pixel encodedOf(const Color& c) const {
    return {encoded(c.value[0]), encoded(c.value[1]), encoded(c.value[2]), c.value[3]};
  }

  /// Paints what the mask covers. `colorOf`: premultiplied, by a place in em, y up, before `transform`.
  template <class ColorOf>
  Result<void> fill(const Affine& transform, const Mask* mask, Layer& layer, const ColorOf& colorOf) {
    if (!isMeasured_) {
      fillsPlane_ = fillsPlane_ || !mask;
      return {};
    }
    if (auto ok = spend(); !ok) return ok;
    const float area = transform[0] * transform[3] - transform[1] * transform[2];
    if (!(std::abs(area) > 1e-12f)) return {};
    const Affine back = {transform[3] / area, -transform[1] / area, -transform[2] / area, transform[0] / area, 0, 0};
    for (size_t i = 0; i < layer.size(); ++i) {
      const float covered = mask ? std::min((*mask)[i], 1.f) : 1;
      if (!(covered > 0)) continue;
      const Vec pixel{grid_.left + (static_cast<float>(i % grid_.width) + 0.5f) / grid_.scale,
                      -(grid_.top + (static_cast<float>(i / grid_.width) + 0.5f) / grid_.scale)};
      Pixel color = colorOf(mapped(back, {pixel.x - transform[4], pixel.y - transform[5]}));
      for (float& c : color) c *= covered;
      layer[i] = composite(3, color, layer[i]);
    }
    return {};
  }

  /// A shape's outline: measured, or as a mask within another.
  Result<void> shape(uint32_t glyph, const Affine& transform, const Mask* outer, Mask& mask) {
    GlyphPaths paths;
    if (auto ok = paths.addGlyph(font_, glyph, transform); !ok) return ok;
    const float black[4] = {0, 0, 0, 1};
    paths.paint(black, false);
    const GpgpGlyphOutline outline = paths.outline(glyph);
    if (!isMeasured_) {
      if (outline.pathCount) include(outline.box[0], outline.box[1]), include(outline.box[2], outline.box[3]);
      return {};
    }
    if (auto ok = spend(); !ok) return ok;
    mask.assign(grid_.size(), 0.f);
    if (outline.pathCount) mask = Rasteriser(grid_).cover(outline.paths[0]);
    if (outer)
      for (size_t i = 0; i < mask.size(); ++i) mask[i] = std::min(mask[i], 1.f) * std::min((*outer)[i], 1.f);
    return {};
  }

  Result<void> walk(size_t offset, const Affine& transform, const Mask* clip, Layer& layer, int depth) {
    if (depth > 64 || ++visited_ > 65536)
      return makeError(GPGP_ERROR_INVALID_DATA, "glyph %u: its graph of paints is too deep or too large", info_.glyph);
    Reader paint = table_.from(offset);
    const uint32_t format = paint.u8();
    if (paint.broken) return broken();
    switch (format) {
    case 1: {
      const uint32_t count = paint.u8(), first = paint.u32(), list = table_.from(18).u32();
      Reader layers = table_.from(list);
      if (paint.broken || list == 0 || uint64_t(first) + count > layers.u32()) return broken();
      layers.at += size_t(first) * 4;
      for (uint32_t i = 0; i < count; ++i) {
        const size_t one = list + size_t(layers.u32());
        if (layers.broken) return broken();
        if (auto ok = walk(one, transform, clip, layer, depth + 1); !ok) return ok;
      }
      return {};
    }
    case 11: {
      const auto root = paintOf(paint.u16());
      if (paint.broken || !root) return broken();
      return walk(*root, transform, clip, layer, depth + 1);
    }
    case 10: {
      const size_t child = offset + paint.u24();
      const uint32_t glyph = paint.u16();
      if (paint.broken) return broken();
      Mask mask;
      if (auto ok = shape(glyph, transform, clip, mask); !ok) return ok;
      return walk(child, transform, &mask, layer, depth + 1);
    }
    case 32: {
      const uint32_t source = paint.u24(), mode = paint.u8(), backdrop = paint.u24();
      if (paint.broken || mode >= kCompositeModes) return broken();
      Layer below(layer.size()), above(layer.size());
      if (auto ok = spend(); !ok) return ok;
      if (auto ok = walk(offset + backdrop, transform, clip, below, depth + 1); !ok) return ok;
      if (auto ok = walk(offset + source, transform, clip, above, depth + 1); !ok) return ok;
      for (size_t i = 0; i < layer.size(); ++i) layer[i] = composite(3, composite(mode, above[i], below[i]), layer[i]);
      return {};
    }
    case 2:
    case 3: {
      const uint32_t entry = paint.u16();
      Pixel color = encodedOf(this->color(entry, paint.f2dot14()));
      if (paint.broken) return broken();
      for (size_t c = 0; c < 3; ++c) color[c] *= color[3];
      return fill(transform, clip, layer, [&](Vec) { return color; });
    }
    case 4:
    case 5:
    case 6:
    case 7:
    case 8:
    case 9: return gradient(paint, offset, format, transform, clip, layer);
    default: break;
    }
    if (format < 12 || format > 31) return {}; // of a later version
    const auto moved = transformOf(paint, offset, format);
    if (!moved) return broken();
    return walk(offset + moved->first, concat(transform, moved->second), clip, layer, depth + 1);
  }

  Result<void> gradient(Reader paint, size_t offset, uint32_t format, const Affine& transform, const Mask* clip,
                        Layer& layer) {
    Reader line = table_.from(offset + paint.u24());
    ColorLine colors;
    colors.extend = line.u8();
    for (uint32_t i = 0, count = line.u16(); i < count && !line.broken; ++i) {
      const float at = line.f2dot14();
      const uint32_t entry = line.u16();
      colors.stops.push_back({at, encodedOf(color(entry, line.f2dot14()))});
      if (format % 2) line.u32();
    }
    std::stable_sort(colors.stops.begin(), colors.stops.end(), [](auto& a, auto& b) { return a.offset < b.offset; });
    const uint32_t kind = format / 2 * 2;
    float n[6] = {};
    for (int i = 0; i < (kind == 8 ? 2 : 6); ++i)
      n[i] = em(kind == 6 && i % 3 == 2 ? static_cast<float>(paint.u16()) : paint.i16());
    const float start = kind == 8 ? (paint.f2dot14() + 1) * kPi : 0, end = kind == 8 ? (paint.f2dot14() + 1) * kPi : 0;
    if (line.broken || paint.broken) return broken();
    if (colors.stops.empty()) return {};
    const float last = colors.stops.back().offset;
    if (kind == 8)
      return fill(transform, clip, layer, [&](Vec p) {
        float angle = std::atan2(p.y - n[1], p.x - n[0]);
        if (angle < 0) angle += 2 * kPi;
        if (start == end) return colors.extend ? Pixel{} : colors.at(angle < start ? -1e9f : 1e9f);
        return colors.at((angle - start) / (end - start));
      });
    if (kind == 4) { // along the part of p0 -> p1 that is at right angles to p0 -> p2
      const float x = n[2] - n[0], y = n[3] - n[1], ax = -(n[5] - n[1]), ay = n[4] - n[0], square = ax * ax + ay * ay;
      const float along = square > 0 ? (x * ax + y * ay) / square : 0, ex = along * ax, ey = along * ay;
      const float length2 = ex * ex + ey * ey;
      return fill(transform, clip, layer, [&](Vec p) {
        return colors.at(length2 > 0 ? ((p.x - n[0]) * ex + (p.y - n[1]) * ey) / length2 : last);
      });
    }
    // Of the circles between and beyond the two, the last one through the place counts.
    const float dx = n[3] - n[0], dy = n[4] - n[1], dr = n[5] - n[2], a = dx * dx + dy * dy - dr * dr;
    return fill(transform, clip, layer, [&](Vec p) {
      const float x = p.x - n[0], y = p.y - n[1], b = x * dx + y * dy + n[2] * dr, c = x * x + y * y - n[2] * n[2];
      float roots[2] = {};
      int count = 0;
      if (std::abs(a) < 1e-9f) {
        if (std::abs(b) > 1e-12f) roots[count++] = c / (2 * b);
      } else if (const float inside = b * b - a * c; inside >= 0) {
        const float root = std::sqrt(inside);
        roots[count++] = (b + root) / a, roots[count++] = (b - root) / a;
        if (roots[0] < roots[1]) std::swap(roots[0], roots[1]);
      }
      for (int i = 0; i < count; ++i)
        if (n[2] + roots[i] * dr >= 0) return colors.at(roots[i]);
      return Pixel{};
    });
  }

  Grid grid_;
  float box_[4] = {1e9f, 1e9f, -1e9f, -1e9f}, clip_[4] = {};
  uint32_t visited_ = 0;
  size_t work_ = 0;
  bool isMeasured_ = false, isClipped_ = false, fillsPlane_ = false;
};

} // namespace

Result<ColorPicture> paintColorPicture(Font& font, const GpgpGlyphOutlineInfo& info) {
  return PicturePainter(font, info).paint();
}

} // namespace gpgp::text
