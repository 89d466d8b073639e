// What a drawing with layers should look like: pictures of whole pages in floats, worked out group by group with the
// formulas of Compositing and Blending 1, CSS Masking 1 and Filter Effects 1. Written apart from the library. Edges
// come from cli::vectorReference. Noise and light are not here.
#pragma once
#include "cli/vector/reference.h"
#include "vector/import/svg/import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace gpgp::test {

class LayerOracle {
public:
  using Color = std::array<double, 4>;
  using Pixels = std::vector<Color>; ///< premultiplied, as sRGB encodes colours

  /// `scale`: pixels per pixel of the page.
  LayerOracle(const vector::svg::Imported& svg, uint32_t width, uint32_t height, double scale)
      : svg_(svg), views_(svg), width_(width), height_(height), scale_(scale), layered_(svg.groups.size() + 1) {
    for (size_t g = svg.groups.size(); g > 0; --g) {
      const auto& group = svg.groups[g - 1];
      layered_[g] = layered_[g] || group.layer;
      if (group.parent && layered_[g]) layered_[group.parent] = true;
    }
  }

  Pixels draw() const {
    std::vector<bool> referred(svg_.groups.size() + 1);
    for (const auto& group : svg_.groups) {
      if (!group.layer) continue;
      referred[group.layer->layer.mask] = true;
      for (const GpgpFilterStep& s : group.layer->steps) referred[s.group] = true;
    }
    std::vector<uint32_t> paths;
    for (uint32_t i = 0; i < views_.paths.size(); ++i) {
      const uint32_t top = topOf(views_.paths[i].group);
      if (!top || !referred[top]) paths.push_back(i);
    }
    return content(paths, 0);
  }

private:
  struct Map {
    double a, b, c, d, e, f;
    std::array<double, 2> at(double x, double y) const { return {a * x + c * y + e, b * x + d * y + f}; }
  };
  static Map mapOf(const float* t) {
    const auto at = [t](int i) { return static_cast<double>(t[i]); };
    return {at(0), at(1), at(2), at(3), at(4), at(5)};
  }
  static Map inverse(const Map& m) {
    const double k = 1 / (m.a * m.d - m.b * m.c);
    return {m.d * k, -m.b * k, -m.c * k, m.a * k, (m.c * m.f - m.d * m.e) * k, (m.b * m.e - m.a * m.f) * k};
  }
  uint32_t topOf(uint32_t group) const {
    while (group && views_.groups[group - 1].parent) group = views_.groups[group - 1].parent;
    return group;
  }
  size_t at(uint32_t x, uint32_t y) const { return size_t{y} * width_ + x; }
  Pixels blank() const { return Pixels(size_t{width_} * height_, Color{}); }

  /// Of paths inside a group (0: the drawing).
  Pixels content(const std::vector<uint32_t>& paths, uint32_t owner) const {
    Pixels below = blank();
    const auto layerOf = [&](uint32_t path) {
      uint32_t found = 0;
      for (uint32_t g = views_.paths[path].group; g && g != owner; g = views_.groups[g - 1].parent)
        if (layered_[g]) found = g;
      return found;
    };
    for (size_t i = 0, end = 0; i < paths.size(); i = end) {
      const uint32_t layer = layerOf(paths[i]);
      std::vector<uint32_t> part;
      for (end = i; end < paths.size() && layerOf(paths[end]) == layer; ++end) part.push_back(paths[end]);
      const Pixels top = layer ? shown(part, layer) : run(part, owner);
      const GpgpLayer* l = layer ? views_.groups[layer - 1].layer : nullptr;
      for (size_t p = 0; p < below.size(); ++p) below[p] = mixed(l ? l->blend : 0, below[p], top[p]);
    }
    return below;
  }
  /// Paths with plain groups alone between them and the owner.
  Pixels run(const std::vector<uint32_t>& paths, uint32_t owner) const {
    std::vector<GpgpPath> own;
    for (const uint32_t i : paths) own.push_back(views_.paths[i]);
    std::vector<GpgpPathGroup> groups = views_.groups;
    for (uint32_t g = owner; g; g = groups[g - 1].parent)
      groups[g - 1].opacity = 1, groups[g - 1].clip = nullptr, groups[g - 1].clipCount = 0;
    return picture(own, groups);
  }
  Pixels picture(const std::vector<GpgpPath>& paths, const std::vector<GpgpPathGroup>& groups) const {
    const float s = static_cast<float>(scale_), t[6] = {s, 0, 0, s, 0, 0}, none[4] = {};
    const std::vector<float> made = cli::vectorReference(paths, groups, t, none, width_, height_, cli::Blend::Srgb);
    Pixels pixels(made.size() / 4);
    for (size_t i = 0; i < made.size(); ++i) pixels[i / 4][i % 4] = static_cast<double>(made[i]);
    return pixels;
  }
  Pixels ofGroup(uint32_t group) const {
    std::vector<uint32_t> paths;
    for (uint32_t i = 0; i < views_.paths.size(); ++i)
      if (topOf(views_.paths[i].group) == group) paths.push_back(i);
    return layered_[group] ? shown(paths, group) : content(paths, 0);
  }

  Pixels shown(const std::vector<uint32_t>& paths, uint32_t group) const {
    const GpgpPathGroup& g = views_.groups[group - 1];
    Pixels own = content(paths, group);
    const auto fade = [&](const auto& by) {
      for (uint32_t y = 0; y < height_; ++y)
        for (uint32_t x = 0; x < width_; ++x) {
          const double k = by(x, y);
          for (double& c : own[at(x, y)]) c *= k;
        }
    };
    if (g.layer && g.layer->filter) own = filtered(*g.layer, own);
    if (g.clip) {
      static const GpgpPathVerb verbs[] = {GPGP_PATH_MOVE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_LINE};
      static const float points[] = {-1e6f, -1e6f, 1e6f, -1e6f, 1e6f, 1e6f, -1e6f, 1e6f};
      GpgpPath all{};
      all.verbs = verbs, all.verbCount = 4, all.points = points, all.pointCount = 4, all.color[3] = 1, all.group = 1;
      GpgpPathGroup clip{};
      clip.opacity = 1, clip.clip = g.clip, clip.clipCount = g.clipCount;
      const Pixels cover = picture({all}, {clip});
      fade([&](uint32_t x, uint32_t y) { return cover[at(x, y)][3]; });
    }
    if (g.layer && g.layer->mask) {
      const GpgpLayer& l = *g.layer;
      const Pixels mask = ofGroup(l.mask);
      const Map map = mapOf(l.maskTransform);
      fade([&](uint32_t x, uint32_t y) {
        const Color& m = mask[at(x, y)];
        double k = m[3];
        if (l.maskKind == GPGP_MASK_LUMINANCE) {
          const auto value = [&](size_t c) {
            const double straight = m[3] > 0 ? m[c] / m[3] : 0;
            return l.maskEncoding == GPGP_IMAGE_LINEAR ? linear(straight) : straight;
          };
          k = m[3] * (0.2125 * value(0) + 0.7154 * value(1) + 0.0721 * value(2));
        }
        return k * inside(map, l.maskRegion, x, y);
      });
    }
    fade([&](uint32_t, uint32_t) { return static_cast<double>(g.opacity); });
    return own;
  }

  /// What of a pixel is inside of a region: 16 samples.
  double inside(const Map& toPage, const float* region, uint32_t x, uint32_t y) const {
    const Map back = inverse(toPage);
    int count = 0;
    for (int i = 0; i < 16; ++i) {
      const auto p = back.at((x + (i % 4 + 0.5) / 4) / scale_, (y + (i / 4 + 0.5) / 4) / scale_);
      count += p[0] >= static_cast<double>(region[0]) && p[0] < static_cast<double>(region[2]) &&
               p[1] >= static_cast<double>(region[1]) && p[1] < static_cast<double>(region[3]);
    }
    return count / 16.0;
  }

  static double linear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }
  static double encoded(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }
  template <class F> static Color straightly(const Color& c, const F& change) {
    if (!(c[3] > 0)) return c;
    Color out = c;
    for (size_t i = 0; i < 3; ++i) out[i] = change(std::clamp(c[i] / c[3], 0.0, 1.0)) * c[3];
    return out;
  }
  static Pixels converted(Pixels pixels, int32_t from, int32_t to) {
    if (from == to) return pixels;
    for (Color& c : pixels) c = straightly(c, to == GPGP_IMAGE_LINEAR ? linear : encoded);
    return pixels;
  }

  // Compositing and Blending 1, chapters 5 and 10.
  static double luminosity(const Color& c) { return 0.3 * c[0] + 0.59 * c[1] + 0.11 * c[2]; }
  static double saturationOf(const Color& c) { return std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]}); }
  static Color withLuminosity(Color c, double l) {
    const double by = l - luminosity(c);
    for (size_t i = 0; i < 3; ++i) c[i] += by;
    const double own = luminosity(c), low = std::min({c[0], c[1], c[2]}), high = std::max({c[0], c[1], c[2]});
    for (size_t i = 0; i < 3; ++i) {
      if (low < 0) c[i] = own + (c[i] - own) * own / (own - low);
    }
    for (size_t i = 0; i < 3; ++i)
      if (high > 1) c[i] = own + (c[i] - own) * (1 - own) / (high - own);
    return c;
  }
  static Color withSaturation(Color c, double s) {
    const double low = std::min({c[0], c[1], c[2]}), span = saturationOf(c);
    for (size_t i = 0; i < 3; ++i) c[i] = span > 0 ? (c[i] - low) * s / span : 0;
    return c;
  }
  static double blended(int32_t mode, double b, double s) {
    switch (mode) {
    case GPGP_BLEND_MULTIPLY: return b * s;
    case GPGP_BLEND_SCREEN: return b + s - b * s;
    case GPGP_BLEND_OVERLAY: return blended(GPGP_BLEND_HARD_LIGHT, s, b);
    case GPGP_BLEND_DARKEN: return std::min(b, s);
    case GPGP_BLEND_LIGHTEN: return std::max(b, s);
    case GPGP_BLEND_COLOR_DODGE: return b == 0 ? 0 : s >= 1 ? 1 : std::min(1.0, b / (1 - s));
    case GPGP_BLEND_COLOR_BURN: return b >= 1 ? 1 : s <= 0 ? 0 : 1 - std::min(1.0, (1 - b) / s);
    case GPGP_BLEND_HARD_LIGHT: return s <= 0.5 ? 2 * b * s : b + (2 * s - 1) - b * (2 * s - 1);
    case GPGP_BLEND_SOFT_LIGHT: {
      if (s <= 0.5) return b - (1 - 2 * s) * b * (1 - b);
      const double d = b <= 0.25 ? ((16 * b - 12) * b + 4) * b : std::sqrt(b);
      return b + (2 * s - 1) * (d - b);
    }
    case GPGP_BLEND_DIFFERENCE: return std::abs(b - s);
    case GPGP_BLEND_EXCLUSION: return b + s - 2 * b * s;
    default: return s;
    }
  }
  static Color mixed(int32_t mode, const Color& below, const Color& top) {
    Color out;
    if (mode == GPGP_BLEND_PLUS_LIGHTER) {
      for (size_t i = 0; i < 4; ++i) out[i] = std::min(1.0, below[i] + top[i]);
      return out;
    }
    const double ab = below[3], as = top[3];
    Color b{}, s{};
    for (size_t i = 0; i < 3; ++i) b[i] = ab > 0 ? below[i] / ab : 0, s[i] = as > 0 ? top[i] / as : 0;
    Color m{};
    switch (mode) {
    case GPGP_BLEND_HUE: m = withLuminosity(withSaturation(s, saturationOf(b)), luminosity(b)); break;
    case GPGP_BLEND_SATURATION: m = withLuminosity(withSaturation(b, saturationOf(s)), luminosity(b)); break;
    case GPGP_BLEND_COLOR: m = withLuminosity(s, luminosity(b)); break;
    case GPGP_BLEND_LUMINOSITY: m = withLuminosity(b, luminosity(s)); break;
    default:
      for (size_t i = 0; i < 3; ++i) m[i] = blended(mode, b[i], s[i]);
    }
    for (size_t i = 0; i < 3; ++i) out[i] = as * ((1 - ab) * s[i] + ab * m[i]) + (1 - as) * below[i];
    out[3] = as + ab - as * ab;
    return out;
  }

  Pixels filtered(const GpgpLayer& l, const Pixels& content) const {
    const Map map = mapOf(l.filterTransform);
    const auto cut = [&](Pixels pixels, const float* region) {
      for (uint32_t y = 0; y < height_; ++y)
        for (uint32_t x = 0; x < width_; ++x) {
          const double k = inside(map, region, x, y);
          for (double& c : pixels[at(x, y)]) c *= k;
        }
      return pixels;
    };
    const Pixels source = cut(content, l.filterRegion);
    std::vector<Pixels> results;
    for (uint32_t i = 0; i < l.filterCount; ++i) {
      const GpgpFilterStep& s = l.filter[i];
      const auto input = [&](uint32_t which) {
        Pixels p = which >= GPGP_FILTER_FIRST_STEP    ? results[which - GPGP_FILTER_FIRST_STEP]
                   : which == GPGP_FILTER_TRANSPARENT ? blank()
                                                      : source;
        if (which == GPGP_FILTER_SOURCE_ALPHA)
          for (Color& c : p) c = {0, 0, 0, c[3]};
        return converted(std::move(p), GPGP_IMAGE_SRGB, s.encoding);
      };
      results.push_back(cut(converted(step(l, s, map, input), s.encoding, GPGP_IMAGE_SRGB), s.region));
    }
    return results.back();
  }

  /// Between pixels, bilinear; transparent outside.
  Color sample(const Pixels& p, double x, double y) const {
    const double fx = std::floor(x - 0.5), fy = std::floor(y - 0.5), u = x - 0.5 - fx, v = y - 0.5 - fy;
    Color out{};
    for (int k = 0; k < 4; ++k) {
      const double px = fx + (k & 1), py = fy + (k >> 1), w = (k & 1 ? u : 1 - u) * (k >> 1 ? v : 1 - v);
      if (!(px >= 0 && py >= 0 && px < width_ && py < height_) || w == 0) continue;
      for (size_t c = 0; c < 4; ++c) out[c] += w * p[at(static_cast<uint32_t>(px), static_cast<uint32_t>(py))][c];
    }
    return out;
  }
  Pixels moved(const Pixels& p, double dx, double dy) const {
    Pixels out = blank();
    for (uint32_t y = 0; y < height_; ++y)
      for (uint32_t x = 0; x < width_; ++x) out[at(x, y)] = sample(p, x + 0.5 - dx, y + 0.5 - dy);
    return out;
  }
  /// With the Gaussian itself, whatever the map.
  Pixels blurred(const Pixels& p, double sx, double sy, const Map& map) const {
    const double ax = map.a * scale_ * sx, ay = map.b * scale_ * sx, bx = map.c * scale_ * sy, by = map.d * scale_ * sy;
    const auto along = [&](const Pixels& from, double x, double y) {
      const double length = std::hypot(x, y);
      if (length < 1e-6) return from;
      Pixels out = blank();
      const int steps = std::max(8, static_cast<int>(std::ceil(length * 8)));
      double sum = 0;
      for (int k = -4 * steps; k <= 4 * steps; ++k)
        sum += std::exp(-0.5 * k * k / (steps * static_cast<double>(steps)));
      for (int k = -4 * steps; k <= 4 * steps; ++k) {
        const double t = k / static_cast<double>(steps), w = std::exp(-0.5 * t * t) / sum;
        for (uint32_t py = 0; py < height_; ++py)
          for (uint32_t px = 0; px < width_; ++px) {
            const Color c = sample(from, px + 0.5 - t * x, py + 0.5 - t * y);
            for (size_t n = 0; n < 4; ++n) out[at(px, py)][n] += w * c[n];
          }
      }
      return out;
    };
    return along(along(p, ax, ay), bx, by);
  }

  template <class Input>
  Pixels step(const GpgpLayer& l, const GpgpFilterStep& s, const Map& map, const Input& input) const {
    const auto v = [&](size_t i) { return static_cast<double>(s.values[i]); };
    Pixels out = blank();
    const auto flood = [&](size_t first) {
      Color c{};
      for (size_t i = 0; i < 3; ++i)
        c[i] = (s.encoding == GPGP_IMAGE_LINEAR ? v(first + i) : encoded(v(first + i))) * v(first + 3);
      c[3] = v(first + 3);
      return c;
    };
    const double dx = map.a * scale_, dy = map.d * scale_; // where the map is straight
    switch (s.kind) {
    case GPGP_FILTER_FLOOD: std::fill(out.begin(), out.end(), flood(0)); return out;
    case GPGP_FILTER_GAUSSIAN_BLUR: return blurred(input(s.input), v(0), v(1), map);
    case GPGP_FILTER_OFFSET:
      return moved(input(s.input), (map.a * v(0) + map.c * v(1)) * scale_, (map.b * v(0) + map.d * v(1)) * scale_);
    case GPGP_FILTER_DROP_SHADOW: {
      const Pixels top = input(s.input);
      const Pixels soft = moved(blurred(top, v(0), v(1), map), (map.a * v(2) + map.c * v(3)) * scale_,
                                (map.b * v(2) + map.d * v(3)) * scale_);
      const Color c = flood(4);
      for (size_t i = 0; i < out.size(); ++i)
        for (size_t n = 0; n < 4; ++n) out[i][n] = top[i][n] + c[n] * soft[i][3] * (1 - top[i][3]);
      return out;
    }
    case GPGP_FILTER_COLOR_MATRIX:
    case GPGP_FILTER_COMPONENT_TRANSFER: {
      const Pixels in = input(s.input);
      for (size_t i = 0; i < out.size(); ++i) {
        Color c = in[i], r{};
        for (size_t n = 0; n < 3; ++n) c[n] = c[3] > 0 ? c[n] / c[3] : 0;
        for (size_t n = 0; n < 4; ++n) {
          if (s.kind == GPGP_FILTER_COLOR_MATRIX) {
            r[n] = v(5 * n + 4);
            for (size_t k = 0; k < 4; ++k) r[n] += v(5 * n + k) * c[k];
          } else {
            const double place = std::clamp(c[n], 0.0, 1.0) * 255;
            const size_t k = std::min<size_t>(static_cast<size_t>(place), 254);
            const double low = static_cast<double>(s.table[256 * n + k]),
                         high = static_cast<double>(s.table[256 * n + k + 1]);
            r[n] = low + (high - low) * (place - static_cast<double>(k));
          }
          r[n] = std::clamp(r[n], 0.0, 1.0);
        }
        for (size_t n = 0; n < 3; ++n) out[i][n] = r[n] * r[3];
        out[i][3] = r[3];
      }
      return out;
    }
    case GPGP_FILTER_BLEND:
    case GPGP_FILTER_COMPOSITE: {
      const Pixels top = input(s.input), below = input(s.input2);
      for (size_t i = 0; i < out.size(); ++i) {
        const Color &a = top[i], &b = below[i];
        if (s.kind == GPGP_FILTER_BLEND) {
          out[i] = mixed(s.mode, b, a);
          continue;
        }
        const double fa[] = {1, b[3], 1 - b[3], b[3], 1 - b[3], 1}, fb[] = {1 - a[3], 0, 0, 1 - a[3], 1 - a[3], 1};
        for (size_t n = 0; n < 4; ++n)
          out[i][n] = s.mode == GPGP_OPERATOR_ARITHMETIC
                          ? std::clamp(v(0) * a[n] * b[n] + v(1) * a[n] + v(2) * b[n] + v(3), 0.0, 1.0)
                          : std::min(1.0, fa[s.mode] * a[n] + fb[s.mode] * b[n]);
        for (size_t n = 0; n < 3; ++n) out[i][n] = std::min(out[i][n], out[i][3]);
      }
      return out;
    }
    case GPGP_FILTER_MORPHOLOGY: {
      const Pixels in = input(s.input);
      const int rx = static_cast<int>(std::lround(v(0) * dx)), ry = static_cast<int>(std::lround(v(1) * dy));
      for (int y = 0; y < static_cast<int>(height_); ++y)
        for (int x = 0; x < static_cast<int>(width_); ++x)
          for (size_t n = 0; n < 4; ++n) {
            double best = s.mode ? 0 : 1;
            for (int j = y - ry; j <= y + ry; ++j)
              for (int i = x - rx; i <= x + rx; ++i) {
                const bool in_ = i >= 0 && j >= 0 && i < static_cast<int>(width_) && j < static_cast<int>(height_);
                const double c = in_ ? in[at(static_cast<uint32_t>(i), static_cast<uint32_t>(j))][n] : 0;
                best = s.mode ? std::max(best, c) : std::min(best, c);
              }
            out[at(static_cast<uint32_t>(x), static_cast<uint32_t>(y))][n] = best;
          }
      return out;
    }
    case GPGP_FILTER_CONVOLVE_MATRIX: { // where a pixel is a unit; edges like `none`
      const Pixels in = input(s.input);
      const int w = static_cast<int>(v(0)), h = static_cast<int>(v(1));
      for (uint32_t y = 0; y < height_; ++y)
        for (uint32_t x = 0; x < width_; ++x) {
          Color sum{};
          for (int j = 0; j < h; ++j)
            for (int i = 0; i < w; ++i) {
              const double k = static_cast<double>(s.table[(h - 1 - j) * w + (w - 1 - i)]);
              Color c = sample(in, x + 0.5 - v(2) + i, y + 0.5 - v(3) + j);
              if (v(6) != 0)
                for (size_t n = 0; n < 3; ++n) c[n] = c[3] > 0 ? c[n] / c[3] : 0;
              for (size_t n = 0; n < 4; ++n) sum[n] += k * c[n] / v(4);
            }
          const double alpha = v(6) != 0 ? in[at(x, y)][3] : std::clamp(sum[3] + v(5), 0.0, 1.0);
          for (size_t n = 0; n < 3; ++n)
            out[at(x, y)][n] =
                v(6) != 0 ? std::clamp(sum[n] + v(5), 0.0, 1.0) * alpha : std::clamp(sum[n] + v(5) * alpha, 0.0, alpha);
          out[at(x, y)][3] = alpha;
        }
      return out;
    }
    case GPGP_FILTER_DISPLACEMENT_MAP: {
      const Pixels in = input(s.input), by = input(s.input2);
      for (uint32_t y = 0; y < height_; ++y)
        for (uint32_t x = 0; x < width_; ++x) {
          const Color& m = by[at(x, y)];
          const auto channel = [&](int c) { return c == 3 ? m[3] : m[3] > 0 ? m[static_cast<size_t>(c)] / m[3] : 0; };
          out[at(x, y)] = sample(in, x + 0.5 + v(0) * dx * (channel(s.mode % 4) - 0.5),
                                 y + 0.5 + v(0) * dy * (channel(s.mode / 4) - 0.5));
        }
      return out;
    }
    case GPGP_FILTER_TILE: {
      const Pixels in = input(s.input);
      const float* r =
          s.input >= GPGP_FILTER_FIRST_STEP ? l.filter[s.input - GPGP_FILTER_FIRST_STEP].region : l.filterRegion;
      const auto side = [r](size_t i) { return static_cast<double>(r[i]); };
      const auto wrapped = [](double at, double from, double to) {
        return from + (at - from) - std::floor((at - from) / (to - from)) * (to - from);
      };
      const Map back = inverse(map);
      for (uint32_t y = 0; y < height_; ++y)
        for (uint32_t x = 0; x < width_; ++x) {
          const auto p = back.at((x + 0.5) / scale_, (y + 0.5) / scale_);
          const auto q = map.at(wrapped(p[0], side(0), side(2)), wrapped(p[1], side(1), side(3)));
          out[at(x, y)] = sample(in, q[0] * scale_, q[1] * scale_);
        }
      return out;
    }
    case GPGP_FILTER_GROUP: return converted(ofGroup(s.group), GPGP_IMAGE_SRGB, s.encoding);
    default: throw std::runtime_error("this step is not in the oracle");
    }
  }

  const vector::svg::Imported& svg_;
  vector::svg::ImportedViews views_;
  uint32_t width_, height_;
  double scale_;
  std::vector<bool> layered_;
};

} // namespace gpgp::test
