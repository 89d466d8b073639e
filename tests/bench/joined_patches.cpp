// Patches of a path are disjoint and each is as wide as the region at every height, so at most one goes on where
// another ends; chains of them are cut from the top down, which gives the fewest.
#include "joined_patches.h"

#include "vector/raster/segments.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace gpgp::bench {
namespace {
using vector::CurveRecord;
using vector::PatchRecord;

constexpr double kFar = 1e30;

double at(float v) { return static_cast<double>(v); }

/// In the rows of a curve.
double xInside(const CurveRecord& c, double y) {
  const double height = at(c.endY) - at(c.ends.y), wanted = std::clamp(y - at(c.ends.y), 0.0, height);
  double t = height > 0 ? wanted / height : 0;
  if (c.bend >= 0) t = vector::parameterAt(at(c.controls.y), at(c.controls.w), height, wanted);
  const double s = 1 - t;
  if (c.bend < 0) return at(c.ends.x) + t * (at(c.endX) - at(c.ends.x));
  return at(c.ends.x) + 3 * s * s * t * at(c.controls.x) + 3 * s * t * t * at(c.controls.z) +
         t * t * t * (at(c.endX) - at(c.ends.x));
}

/// dx / dy at an end.
double slope(const CurveRecord& c, bool bottom) {
  const double x[4] = {0, at(c.controls.x), at(c.controls.z), at(c.endX) - at(c.ends.x)};
  const double y[4] = {0, at(c.controls.y), at(c.controls.w), at(c.endY) - at(c.ends.y)};
  for (int k = 1; k < 4; ++k) {
    const int a = bottom ? 3 - k : 0, b = bottom ? 3 : k;
    const double dx = x[b] - x[a], dy = y[b] - y[a];
    if (c.bend < 0 && k < 3) continue;
    if (std::abs(dx) + std::abs(dy) > 1e-9 * (std::abs(x[3]) + std::abs(y[3])))
      return std::abs(dx) < kFar * dy ? dx / dy : std::copysign(kFar, dx);
  }
  return 0;
}

/// The border of a curve's half-plane; `side` -1: it bounds on the left, 1: on the right.
double border(const CurveRecord& c, double y, int side, Beyond beyond) {
  const bool above = y<at(c.ends.y), below = y> at(c.endY);
  if (!above && !below) return xInside(c, y);
  if (beyond == Beyond::Free) return side * kFar;
  return above ? at(c.ends.x) + (y - at(c.ends.y)) * slope(c, false) : at(c.endX) + (y - at(c.endY)) * slope(c, true);
}

double slack(double x, double y) { return 1e-6 * (1e-3 + std::abs(x) + std::abs(y)); }
bool same(double a, double b, double y) { return std::abs(a - b) <= slack(a, y); }

class Joining {
public:
  Joining(const vector::Drawing& drawing, uint32_t most, Beyond beyond)
      : drawing_(drawing), most_(most), beyond_(beyond), next_(drawing.patches.size(), kNoPatch) {}

  std::vector<uint32_t> run() {
    for (uint32_t first = 0; first < drawing_.patches.size();) {
      uint32_t last = first;
      while (last < drawing_.patches.size() && drawing_.patches[last].path == drawing_.patches[first].path) ++last;
      path(first, last);
      first = last;
    }
    return next_;
  }

private:
  void path(uint32_t first, uint32_t last) {
    std::vector<uint32_t> order(last - first);
    std::iota(order.begin(), order.end(), first);
    const auto above = [this](uint32_t a, uint32_t b) { return drawing_.patches[a].top < drawing_.patches[b].top; };
    std::stable_sort(order.begin(), order.end(), above);
    std::vector<uint8_t> taken(last - first);
    for (const uint32_t head : order) {
      if (taken[head - first]) continue;
      chain_.assign(1, head);
      for (;;) {
        const uint32_t below = under(order, chain_.back());
        if (below == kNoPatch || taken[below - first]) break;
        if (!joins(below))
          chain_.clear();
        else
          next_[chain_.back()] = below;
        taken[below - first] = 1;
        chain_.push_back(below);
      }
    }
  }

  /// The patch that shares all of the level side below one.
  uint32_t under(std::span<const uint32_t> order, uint32_t patch) const {
    const PatchRecord& p = drawing_.patches[patch];
    const double y = at(p.bottom), left = xOf(p.left, y), right = xOf(p.right, y);
    auto it = std::lower_bound(order.begin(), order.end(), p.bottom,
                               [this](uint32_t a, float top) { return drawing_.patches[a].top < top; });
    for (; it != order.end() && drawing_.patches[*it].top == p.bottom; ++it) {
      const PatchRecord& q = drawing_.patches[*it];
      if (at(q.x0) > left + slack(left, y) || at(q.x1) < right - slack(right, y)) continue;
      if (same(xOf(q.left, y), left, y) && same(xOf(q.right, y), right, y)) return *it;
    }
    return kNoPatch;
  }
  double xOf(uint32_t curve, double y) const { return xInside(drawing_.curves[curve], y); }

  /// Whether the chain may go on with a patch.
  bool joins(uint32_t added) const {
    const PatchRecord& p = drawing_.patches[added];
    std::vector<uint32_t> lefts, rights;
    const auto put = [](std::vector<uint32_t>& list, uint32_t curve) {
      if (std::find(list.begin(), list.end(), curve) == list.end()) list.push_back(curve);
    };
    for (const uint32_t i : chain_) put(lefts, drawing_.patches[i].left), put(rights, drawing_.patches[i].right);
    const std::vector<uint32_t> leftsBefore = lefts, rightsBefore = rights;
    put(lefts, p.left), put(rights, p.right);
    if (lefts.size() + rights.size() > most_) return false;
    if (!holds(p, leftsBefore, rightsBefore)) return false;
    return std::all_of(chain_.begin(), chain_.end(), [&](uint32_t i) {
      return holds(drawing_.patches[i], std::span(&p.left, 1), std::span(&p.right, 1));
    });
  }

  /// Whether curves leave all of a patch that others bound.
  bool holds(const PatchRecord& p, std::span<const uint32_t> lefts, std::span<const uint32_t> rights) const {
    for (int k = 0; k <= 6; ++k) {
      const double y = at(p.top) + (at(p.bottom) - at(p.top)) * k / 6;
      const double left = xOf(p.left, y), right = xOf(p.right, y);
      for (const uint32_t c : lefts)
        if (c != p.left && border(drawing_.curves[c], y, -1, beyond_) > left + slack(left, y)) return false;
      for (const uint32_t c : rights)
        if (c != p.right && border(drawing_.curves[c], y, 1, beyond_) < right - slack(right, y)) return false;
    }
    return true;
  }

  const vector::Drawing& drawing_;
  const uint32_t most_;
  const Beyond beyond_;
  std::vector<uint32_t> next_;
  std::vector<uint32_t> chain_;
};
} // namespace

std::vector<uint32_t> joinPatches(const vector::Drawing& drawing, uint32_t most, Beyond beyond) {
  return Joining(drawing, most, beyond).run();
}

} // namespace gpgp::bench
