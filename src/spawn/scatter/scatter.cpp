#include "spawn/scatter/scatter.h"

#include "core/random.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace gpgp::spawn {
namespace {
constexpr int kTries = 4, kSide = 3, kReach = 2;
/// Decisions in a row, each of which looks kReach cells far.
constexpr int kHalo = kTries * kSide * kSide * kReach;
constexpr double kMostWide = 2048, kMostFar = 65536;
constexpr uint32_t kMostField = 16384;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// What a cell's numbers are drawn for; tries take two each.
enum Draw : uint32_t { kKeep = 1000, kSeed, kId };

uint32_t cellSeed(uint32_t seed, int x, int y) {
  using namespace shader;
  return childSeed(childSeed(childSeed(seed, 0x73637472u), static_cast<uint32_t>(x)), static_cast<uint32_t>(y));
}

/// A place within a cell, as parts of it.
struct Place {
  float x = kNone, y = kNone;
  bool exists() const { return x == x; }
};

int modulo(int value, int of) { return (value % of + of) % of; }

/// The points of a range of cells, and of those around it that decide about them.
class Pattern {
public:
  Pattern(uint32_t seed, int firstX, int firstY, int width, int height)
      : seed_(seed), x_(firstX - kHalo), y_(firstY - kHalo), width_(width + 2 * kHalo), height_(height + 2 * kHalo),
        places_(size_t(width_) * size_t(height_)) {
    for (int attempt = 0; attempt < kTries; ++attempt)
      for (int phase = 0; phase < kSide * kSide; ++phase) decide(attempt, phase % kSide, phase / kSide);
  }
  const Place& at(int x, int y) const { return places_[size_t(y - y_) * size_t(width_) + size_t(x - x_)]; }

private:
  void decide(int attempt, int phaseX, int phaseY) {
    for (int y = y_ + modulo(phaseY - y_, kSide); y < y_ + height_; y += kSide)
      for (int x = x_ + modulo(phaseX - x_, kSide); x < x_ + width_; x += kSide) {
        Place& place = places_[size_t(y - y_) * size_t(width_) + size_t(x - x_)];
        if (place.exists()) continue;
        const uint32_t cell = cellSeed(seed_, x, y), draw = 2 * static_cast<uint32_t>(attempt);
        const Place drawn{shader::unitFloat(shader::childSeed(cell, draw)),
                          shader::unitFloat(shader::childSeed(cell, draw + 1))};
        if (isFree(x, y, drawn)) place = drawn;
      }
  }
  /// In units of cells, where the distance is the square root of 2.
  bool isFree(int x, int y, const Place& drawn) const {
    for (int dy = -kReach; dy <= kReach; ++dy)
      for (int dx = -kReach; dx <= kReach; ++dx) {
        const int ox = x + dx, oy = y + dy;
        if (ox < x_ || oy < y_ || ox >= x_ + width_ || oy >= y_ + height_) continue;
        const Place& other = at(ox, oy);
        if (!other.exists()) continue;
        const float wide = static_cast<float>(dx) + other.x - drawn.x;
        const float deep = static_cast<float>(dy) + other.y - drawn.y;
        if (wide * wide + deep * deep < kNearest) return false;
      }
    return true;
  }
  /// The square of the distance, with room for the rounding of places in metres.
  static constexpr float kNearest = 2.0001f;

  const uint32_t seed_;
  const int x_, y_, width_, height_;
  std::vector<Place> places_;
};

float valueAt(const GpgpGroundField& field, double x, double z) {
  const auto along = [](double at, double low, double high, uint32_t count, uint32_t& first) {
    first = 0;
    if (count == 1) return 0.0;
    const double place = std::clamp((at - low) / (high - low), 0.0, 1.0) * (count - 1);
    first = std::min(static_cast<uint32_t>(place), count - 2);
    return place - first;
  };
  uint32_t column = 0, row = 0;
  const double u = along(x, field.min[0], field.max[0], field.width, column);
  const double v = along(z, field.min[1], field.max[1], field.height, row);
  const auto value = [&](uint32_t dx, uint32_t dz) {
    const uint32_t c = std::min(column + dx, field.width - 1), r = std::min(row + dz, field.height - 1);
    return static_cast<double>(field.values[size_t(r) * field.width + c]);
  };
  const double near = value(0, 0) + u * (value(1, 0) - value(0, 0));
  const double far = value(0, 1) + u * (value(1, 1) - value(0, 1));
  return static_cast<float>(near + v * (far - near));
}

bool isValidField(const GpgpGroundField* field) {
  if (!field) return true;
  if (!field->values || !field->width || !field->height || field->width > kMostField || field->height > kMostField)
    return false;
  for (int axis = 0; axis < 2; ++axis) {
    if (!std::isfinite(field->min[axis]) || !std::isfinite(field->max[axis])) return false;
    if ((axis ? field->height : field->width) > 1 && !(field->min[axis] < field->max[axis])) return false;
  }
  return std::all_of(field->values, field->values + size_t(field->width) * field->height,
                     [](float value) { return std::isfinite(value); });
}
} // namespace

bool isValid(const GpgpScatterInfo& info) {
  if (!(info.distance >= 1e-3f) || !std::isfinite(info.distance)) return false;
  for (int axis = 0; axis < 2; ++axis) {
    const double low = info.min[axis], high = info.max[axis], distance = info.distance;
    if (!(low <= high) || !(std::abs(low) <= kMostFar * distance) || !(std::abs(high) <= kMostFar * distance) ||
        !(high - low <= kMostWide * distance))
      return false;
  }
  return info.minHeight <= info.maxHeight && isValidField(info.density) && isValidField(info.heights);
}

std::vector<GpgpAxiom> scatter(const GpgpScatterInfo& info) {
  const double cell = double(info.distance) * 0.70710678118654752; // the diagonal is the distance
  const auto cellOf = [&](float at) { return static_cast<int>(std::floor(double(at) / cell)); };
  // A cell more on each side: places are rounded to floats, and may come to lie on the other side of an edge.
  const int firstX = cellOf(info.min[0]) - 1, firstZ = cellOf(info.min[1]) - 1;
  const int lastX = cellOf(info.max[0]) + 1, lastZ = cellOf(info.max[1]) + 1;
  const Pattern pattern(info.seed, firstX, firstZ, lastX - firstX + 1, lastZ - firstZ + 1);
  const bool banded = info.minHeight != 0 || info.maxHeight != 0;
  std::vector<GpgpAxiom> axioms;
  for (int z = firstZ; z <= lastZ; ++z)
    for (int x = firstX; x <= lastX; ++x) {
      const Place& place = pattern.at(x, z);
      if (!place.exists()) continue;
      const float atX = static_cast<float>((x + double(place.x)) * cell);
      const float atZ = static_cast<float>((z + double(place.y)) * cell);
      if (atX < info.min[0] || atX >= info.max[0] || atZ < info.min[1] || atZ >= info.max[1]) continue;
      const uint32_t own = cellSeed(info.seed, x, z);
      if (info.density && shader::unitFloat(shader::childSeed(own, kKeep)) >= valueAt(*info.density, atX, atZ))
        continue;
      const float ground = info.heights ? valueAt(*info.heights, atX, atZ) : 0;
      if (banded && (ground < info.minHeight || ground > info.maxHeight)) continue;
      GpgpAxiom axiom = info.base;
      axiom.transform[3] += atX;
      axiom.transform[7] += ground + 0.5f * axiom.size[1];
      axiom.transform[11] += atZ;
      axiom.seed = shader::childSeed(own, kSeed);
      axiom.id = shader::childSeed(own, kId);
      axioms.push_back(axiom);
    }
  return axioms;
}

} // namespace gpgp::spawn
