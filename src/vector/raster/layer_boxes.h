// What the planner's two sources share: boxes of pixels, and pictures as operations name them.
#pragma once
#include "vector/raster/layer_plan.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector {

constexpr int kFar = 1 << 20; ///< pixels that boxes may lie beyond the canvas
constexpr double kBlurReach = 3.5;

inline PixelBox join(const PixelBox& a, const PixelBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}
inline PixelBox meet(const PixelBox& a, const PixelBox& b) {
  const PixelBox box{std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right),
                     std::min(a.bottom, b.bottom)};
  return box.empty() ? PixelBox{} : box;
}
inline PixelBox grow(const PixelBox& a, double x, double y) {
  if (a.empty()) return a;
  const int dx = static_cast<int>(std::ceil(std::min(x, double(kFar)))),
            dy = static_cast<int>(std::ceil(std::min(y, double(kFar))));
  return meet(PixelBox{a.left - dx, a.top - dy, a.right + dx, a.bottom + dy}, PixelBox{-kFar, -kFar, kFar, kFar});
}
inline PixelBox moved(const PixelBox& a, double x, double y) { // with a pixel to spare
  if (a.empty()) return a;
  const auto clamped = [](double v) { return static_cast<int>(std::clamp(v, double(-kFar), double(kFar))); };
  return {clamped(std::floor(a.left + x)), clamped(std::floor(a.top + y)), clamped(std::ceil(a.right + x)),
          clamped(std::ceil(a.bottom + y))};
}
inline PixelBox divided(const PixelBox& a, int x, int y) {
  const auto down = [](int v, int by) { return v >= 0 ? v / by : -((-v + by - 1) / by); };
  return {down(a.left, x), down(a.top, y), -down(-a.right, x), -down(-a.bottom, y)};
}
inline uint32_t roundUp(uint32_t v, uint32_t to) { return (v + to - 1) / to * to; }
inline Map toMap6(const float* t) { return toMap(t, nullptr); }
inline float narrow(double v) { return static_cast<float>(v); }
inline uint32_t widthOf(const PixelBox& box) { return static_cast<uint32_t>(std::max(box.right - box.left, 0)); }
inline uint32_t heightOf(const PixelBox& box) { return static_cast<uint32_t>(std::max(box.bottom - box.top, 0)); }

/// How many pixels a unit of each axis is.
inline double lengthX(const Map& m) { return std::hypot(m.a, m.b); }
inline double lengthY(const Map& m) { return std::hypot(m.c, m.d); }
/// Pixels that a box of filter space, half as wide and high, reaches.
inline double reachX(const Map& m, double x, double y) { return std::abs(m.a) * x + std::abs(m.c) * y; }
inline double reachY(const Map& m, double x, double y) { return std::abs(m.b) * x + std::abs(m.d) * y; }

inline shader::PictureRecord recordOf(const LayerTables::Picture& p) {
  shader::PictureRecord record{};
  record.left = p.box.left, record.top = p.box.top, record.right = p.box.right, record.bottom = p.box.bottom;
  record.first = p.region ? p.x : p.first; // finish() makes places of them
  record.stride = p.region ? 0 : widthOf(p.box);
  record.pad0 = p.region ? p.y : p.maker;
  record.pad1 = 1;
  return record;
}
inline void convertA(shader::OperationRecord& o, const LayerTables::Picture& from, bool srgb) {
  o.a = recordOf(from);
  if (from.srgb != srgb) o.flags |= srgb ? shader::kEncodeA : shader::kDecodeA;
}
inline void convertB(shader::OperationRecord& o, const LayerTables::Picture& from, bool srgb) {
  o.b = recordOf(from);
  if (from.srgb != srgb) o.flags |= srgb ? shader::kEncodeB : shader::kDecodeB;
}
/// Shaders of operations, as OPERATIONS says (operate.comp).
enum OperationShader : uint32_t { kComposite, kBlur, kColors, kNeighbourhoods, kNoise, kLights };

} // namespace gpgp::vector
