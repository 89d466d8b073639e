// What a drawing should look like: 16 x 16 samples a pixel on a grid, each composited by itself from winding numbers.
//
// Written apart from the library's conversion and raster, in double precision: a path's curves are cut where they turn
// in y, and where a row of samples meets them is found by bisection. One row of pixels is in memory at a time.
#pragma once
#include "host/picture.h"

#include <gpgp/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace gpgp::cli {

class WindingPath {
public:
  explicit WindingPath(const GpgpPath& path) : path_(&path) {
    const float* p = path.points;
    double sx = 0, sy = 0, x = 0, y = 0;
    const auto at = [&p](int i) { return static_cast<double>(p[i]); };
    const auto curve = [&](double a, double b, double c, double d, double u, double v) {
      add({x, y, a, b, c, d, u, v});
      x = u, y = v;
    };
    const auto line = [&](double u, double v) {
      curve(x + (u - x) / 3, y + (v - y) / 3, x + (u - x) * 2 / 3, y + (v - y) * 2 / 3, u, v);
    };
    for (uint32_t i = 0; i < path.verbCount; ++i) {
      const GpgpPathVerb verb = path.verbs[i];
      if (verb == GPGP_PATH_MOVE) line(sx, sy), sx = x = at(0), sy = y = at(1), p += 2;
      if (verb == GPGP_PATH_LINE) line(at(0), at(1)), p += 2;
      if (verb == GPGP_PATH_QUAD) {
        curve(x + (at(0) - x) * 2 / 3, y + (at(1) - y) * 2 / 3, at(2) + (at(0) - at(2)) * 2 / 3,
              at(3) + (at(1) - at(3)) * 2 / 3, at(2), at(3));
        p += 4;
      }
      if (verb == GPGP_PATH_CUBIC) curve(at(0), at(1), at(2), at(3), at(4), at(5)), p += 6;
      if (verb == GPGP_PATH_CLOSE) line(sx, sy);
    }
    line(sx, sy);
  }
  const GpgpPath& path() const { return *path_; }
  bool inside(int winding) const { return path_->fillRule == GPGP_FILL_EVEN_ODD ? (winding & 1) != 0 : winding != 0; }
  struct Crossing {
    double x;
    int direction;
  };
  /// Where the row y meets the path, from left to right.
  void crossings(double y, std::vector<Crossing>& row) const {
    row.clear();
    if (!(y >= top_ && y <= bottom_)) return;
    for (const Piece& p : pieces_) {
      const bool down = p.y0 <= y && y < p.y1, up = p.y1 <= y && y < p.y0;
      if (!down && !up) continue;
      double low = p.t0, high = p.t1;
      for (int i = 0; i < 40; ++i) {
        const double t = 0.5 * (low + high);
        ((point(p.c, 1, t) <= y) == down ? low : high) = t;
      }
      row.push_back({point(p.c, 0, 0.5 * (low + high)), down ? 1 : -1});
    }
    std::sort(row.begin(), row.end(), [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
  }

private:
  using Cubic = std::array<double, 8>;
  struct Piece { // grows in y from t0 to t1, or shrinks
    Cubic c;
    double t0, t1, y0, y1;
  };
  static double point(const Cubic& c, size_t axis, double t) {
    const double s = 1 - t;
    return s * s * s * c[axis] + 3 * s * s * t * c[2 + axis] + 3 * s * t * t * c[4 + axis] + t * t * t * c[6 + axis];
  }
  void add(const Cubic& c) {
    const double a = c[7] - 3 * c[5] + 3 * c[3] - c[1], b = 2 * (c[5] - 2 * c[3] + c[1]), d = c[3] - c[1];
    std::array<double, 4> cuts{0, 1, 1, 1}; // y' = 3 (a t^2 + b t + d)
    size_t count = 1;
    const auto cut = [&](double t) {
      if (t > 0 && t < 1) cuts[count++] = t;
    };
    if (std::abs(a) < 1e-12 * (std::abs(b) + std::abs(d))) {
      if (b != 0) cut(-d / b);
    } else if (const double inner = b * b - 4 * a * d; inner >= 0) {
      const double q = -0.5 * (b + std::copysign(std::sqrt(inner), b));
      cut(q / a);
      if (q != 0) cut(d / q);
    }
    std::sort(cuts.begin(), cuts.end());
    for (size_t i = 0; i < 3; ++i) {
      if (cuts[i] == cuts[i + 1]) continue;
      const Piece piece{c, cuts[i], cuts[i + 1], cuts[i] == 0 ? c[1] : point(c, 1, cuts[i]),
                        cuts[i + 1] == 1 ? c[7] : point(c, 1, cuts[i + 1])};
      pieces_.push_back(piece);
      top_ = std::min({top_, piece.y0, piece.y1});
      bottom_ = std::max({bottom_, piece.y0, piece.y1});
    }
  }
  const GpgpPath* path_;
  std::vector<Piece> pieces_;
  double top_ = 1e30, bottom_ = -1e30;
};

/// A gradient's colour at a point of the drawing, straight alpha, in double precision, written apart from the shader's.
inline std::array<double, 4> referenceOfGradient(const GpgpGradient& g, double x, double y) {
  const auto at = [](float v) { return static_cast<double>(v); };
  const double t0 = at(g.transform[0]), t1 = at(g.transform[1]), t2 = at(g.transform[2]), t3 = at(g.transform[3]);
  const double dx = x - at(g.transform[4]), dy = y - at(g.transform[5]), det = t0 * t3 - t1 * t2;
  const double u = (t3 * dx - t2 * dy) / det - at(g.start[0]), v = (t0 * dy - t1 * dx) / det - at(g.start[1]);
  const double ex = at(g.end[0]) - at(g.start[0]), ey = at(g.end[1]) - at(g.start[1]);
  double t = (u * ex + v * ey) / (ex * ex + ey * ey);
  if (g.kind == GPGP_GRADIENT_RADIAL) {
    const double r0 = at(g.startRadius), dr = at(g.endRadius) - r0;
    const double a = ex * ex + ey * ey - dr * dr, b = u * ex + v * ey + r0 * dr, c = u * u + v * v - r0 * r0;
    const bool touching = std::abs(a) <= 1e-6 * (ex * ex + ey * ey + dr * dr);
    const double root = touching ? 0 : std::sqrt(b * b - a * c); // NaN where no circle passes
    t = -std::numeric_limits<double>::infinity();
    for (const double place : {touching ? c / (2 * b) : (b + root) / a, touching ? c / (2 * b) : (b - root) / a})
      if (r0 + place * dr >= 0) t = std::max(t, place);
    if (det != 0 && !std::isfinite(t)) return {};
  }
  if (!(det != 0) || !std::isfinite(t)) t = 1;
  if (g.spread == GPGP_SPREAD_REPEAT) t -= std::floor(t);
  if (g.spread == GPGP_SPREAD_REFLECT) t = std::abs(t - 2 * std::floor(t / 2 + 0.5));
  t = std::clamp(t, 0.0, 1.0);
  uint32_t next = 0;
  double before = 0, after = 0;
  for (; next < g.stopCount && std::max(after, at(g.stops[next].offset)) <= t; ++next)
    before = after = std::max(after, at(g.stops[next].offset));
  std::array<double, 4> color{};
  for (size_t k = 0; k < 4; ++k) {
    const bool encoded = k < 3 && g.interpolateSrgb;
    const auto stop = [&](uint32_t i) {
      const float value = g.stops[i].color[k];
      return at(encoded ? host::srgbFromLinear(value) : value);
    };
    const double low = stop(next ? next - 1 : 0), high = stop(std::min(next, g.stopCount - 1));
    const double to = next < g.stopCount ? std::max(after, at(g.stops[next].offset)) : 1;
    color[k] = next == 0 || next == g.stopCount ? low : low + (high - low) * (t - before) / (to - before);
    if (encoded) color[k] = at(host::linearFromSrgb(static_cast<float>(color[k])));
  }
  return color;
}

enum class Blend { Linear, Srgb };

/// Premultiplied colour of each pixel, 4 floats: linear, or as sRGB encodes it where colours mix so; the background is
/// the same kind of colour. `t`, drawing to pixel, scales and shifts only.
inline std::vector<float> vectorReference(std::span<const GpgpPath> paths, std::span<const GpgpPathGroup> groups,
                                          const float t[6], const float background[4], uint32_t width, uint32_t height,
                                          Blend blend = Blend::Linear) {
  constexpr size_t kGrid = 16, kSamples = kGrid * kGrid;
  std::vector<WindingPath> windings(paths.begin(), paths.end());
  std::vector<std::vector<WindingPath>> clips(groups.size());
  for (size_t g = 0; g < groups.size(); ++g)
    for (uint32_t k = 0; k < groups[g].clipCount; ++k) clips[g].emplace_back(groups[g].clip[k]);
  const size_t rowSamples = size_t(width) * kSamples;
  std::vector<float> pixels(size_t(width) * height * 4);
  std::vector<WindingPath::Crossing> ofPath, ofClip; // one is read while the other is made
  const auto mixed = [blend](double linear) {
    const float value = static_cast<float>(linear);
    return blend == Blend::Srgb ? host::srgbFromLinear(value) : value;
  };
  const auto number = [t](int i) { return static_cast<double>(t[i]); };
  // Calls with each sample of a row of pixels that a path covers, and where it lies in the drawing.
  const auto forSamples = [&](const WindingPath& path, uint32_t y, std::vector<WindingPath::Crossing>& row,
                              const auto& call) {
    for (size_t line = 0; line < kGrid; ++line) {
      const double dy = (y + (static_cast<double>(line) + 0.5) / kGrid - number(5)) / number(3);
      path.crossings(dy, row);
      int winding = 0;
      for (size_t next = 0; next + 1 < row.size(); ++next) {
        winding += row[next].direction;
        if (!path.inside(winding)) continue;
        // The samples at or right of one crossing and left of the next.
        const auto sampleAt = [&](double x) {
          return std::clamp(std::ceil((x * number(0) + number(4)) * kGrid - 0.5), 0.0, double(width) * kGrid);
        };
        const size_t end = static_cast<size_t>(sampleAt(row[next + 1].x));
        for (size_t x = static_cast<size_t>(sampleAt(row[next].x)); x < end; ++x)
          call(x / kGrid * kSamples + line * kGrid + x % kGrid,
               ((static_cast<double>(x) + 0.5) / kGrid - number(4)) / number(0), dy);
      }
    }
  };
  struct Level { // a group that fades, being painted
    uint32_t group;
    std::vector<float> samples;
  };
  for (uint32_t y = 0; y < height; ++y) {
    std::vector<std::vector<uint8_t>> shown(groups.size()); // of clips, made when first asked for
    const auto showing = [&](uint32_t group) -> const std::vector<uint8_t>& {
      std::vector<uint8_t>& mask = shown[group - 1];
      if (mask.empty()) {
        mask.assign(rowSamples, 0);
        for (const WindingPath& path : clips[group - 1])
          forSamples(path, y, ofClip, [&](size_t sample, double, double) { mask[sample] = 1; });
      }
      return mask;
    };
    std::vector<Level> levels(1);
    levels[0].samples.resize(rowSamples * 4);
    for (size_t i = 0; i < rowSamples * 4; ++i) levels[0].samples[i] = background[i % 4];
    const auto leave = [&] {
      const Level inner = std::move(levels.back());
      levels.pop_back();
      const float opacity = groups[inner.group - 1].opacity;
      std::vector<float>& below = levels.back().samples;
      for (size_t i = 0; i < below.size(); ++i)
        below[i] = inner.samples[i] * opacity + below[i] * (1 - inner.samples[i | 3] * opacity);
    };
    for (const WindingPath& path : windings) {
      const uint32_t group = groups.empty() ? 0 : path.path().group;
      std::vector<uint32_t> fading, clipping; // around the path, the innermost first
      for (uint32_t g = group; g; g = groups[g - 1].parent) {
        if (groups[g - 1].opacity < 1) fading.push_back(g);
        if (groups[g - 1].clip) clipping.push_back(g);
      }
      const auto holds = [&](uint32_t g) { return std::find(fading.begin(), fading.end(), g) != fading.end(); };
      bool entered = false; // not before the row has something of the path
      const auto enter = [&] {
        while (levels.size() > 1 && !holds(levels.back().group)) leave();
        for (size_t k = fading.size(); k-- > 0;)
          if (fading.size() - k >= levels.size()) levels.push_back({fading[k], std::vector<float>(rowSamples * 4)});
        entered = true;
      };
      const float* color = path.path().color;
      const float plain[4] = {mixed(static_cast<double>(color[0])), mixed(static_cast<double>(color[1])),
                              mixed(static_cast<double>(color[2])), color[3]};
      forSamples(path, y, ofPath, [&](size_t sample, double dx, double dy) {
        for (const uint32_t g : clipping)
          if (!showing(g)[sample]) return;
        if (!entered) enter();
        float own[4] = {plain[0], plain[1], plain[2], plain[3]};
        if (path.path().gradient) {
          const auto ramp = referenceOfGradient(*path.path().gradient, dx, dy);
          for (size_t c = 0; c < 3; ++c) own[c] = mixed(ramp[c]);
          own[3] *= static_cast<float>(ramp[3]);
        }
        float* s = &levels.back().samples[sample * 4];
        for (size_t c = 0; c < 4; ++c) s[c] = (c == 3 ? 1 : own[c]) * own[3] + s[c] * (1 - own[3]);
      });
    }
    while (levels.size() > 1) leave();
    const std::vector<float>& samples = levels[0].samples;
    for (size_t x = 0; x < width; ++x)
      for (size_t c = 0; c < 4; ++c) {
        double sum = 0;
        for (size_t k = 0; k < kSamples; ++k) sum += static_cast<double>(samples[(x * kSamples + k) * 4 + c]);
        pixels[(size_t(y) * width + x) * 4 + c] = static_cast<float>(sum / kSamples);
      }
  }
  return pixels;
}

/// Decibels between two pictures of premultiplied colour, both over white and sRGB-encoded.
inline double psnrOverWhite(std::span<const float> a, std::span<const float> b, Blend blend = Blend::Linear) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); i += 4)
    for (size_t c = 0; c < 3; ++c) {
      const auto encoded = [&](std::span<const float> p) {
        const float value = std::clamp(p[i + c] + 1 - p[i + 3], 0.0f, 1.0f);
        return static_cast<double>(blend == Blend::Srgb ? value : host::srgbFromLinear(value));
      };
      sum += (encoded(a) - encoded(b)) * (encoded(a) - encoded(b));
    }
  return -10 * std::log10(sum / (0.75 * static_cast<double>(a.size())) + 1e-12);
}

} // namespace gpgp::cli
