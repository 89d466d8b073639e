// The CPU reference of what paints: gradients and images at a point, with bounds of what a device may make of it.
//
// Vulkan leaves + - * to single rounding (contracted or not), division to 2.5 units of the last place, square roots to
// about as much, and filters place samples between texels to 1/256 (subTexelPrecisionBits). So a point in the paint's
// space is known to `reach`, which sums up what its operands' magnitudes allow, and the colours at the corners of that
// box bound the colour: also where a ramp begins anew or ends.
#include "vector/raster/paint.h"
#include "vector/cpu_reference/cpu_reference.h"
#include "vector/shared/color.h"
#include "vector/shared/triangle.h"

#include <algorithm>

namespace gpgp::vector {
using shader::ItemRecord;
using shader::PaintRecord;
using shader::vec2;
using shader::vec3;
using shader::vec4;

namespace {

constexpr float kUnit = 1.0f / (1 << 24); // half a unit in the last place of 1
constexpr float kSteps = 16;              // that a few operations may be off by, of what they add up
/// pow is exp2(y log2 x): log2 is off by 3 units of its result's last place (which is below 16) or 2^-21, exp2 by
/// 3 + 2 |y log2 x| of its own; in all less than this part of the result, for x from 0.003 to 10000.
constexpr float kPower = 2e-5f;

/// Grows by colours.
struct Bounds {
  vec4 low = vec4(3e38f), high = vec4(-3e38f);
  void add(const vec4& color, float part = 0) {
    const vec4 more(vec3(part * glm::abs(vec3(color))), 0);
    low = glm::min(low, color - more);
    high = glm::max(high, color + more);
  }
  CpuColor around(const vec4& color) const { return {color, glm::max(high - color, color - low)}; }
};

vec4 premultiplied(const vec4& straight) { return {vec3(straight) * straight.w, straight.w}; }
/// A texel's colour may be off by as much where a sampler that filters is asked for it alone (paint.glsl).
constexpr float kAlone = 1.0f / 1024 + 1e-5f;

struct Paint {
  const CpuInput& input;
  uint32_t slot;
  PaintRecord record;
  Paint(const CpuInput& from, uint32_t slotIndex, uint32_t at) : input(from), slot(slotIndex) {
    std::memcpy(&record, &from.fetch(slot, at), sizeof record);
  }
  bool blendSrgb() const { return input.header.flags & shader::kBlendSrgb; }

  vec4 stopColor(float t) const {
    const size_t first = input.slots(slot).stops + record.firstStop * 2;
    uint32_t before = 0; // stops that lie at or before t
    while (before < record.stopCount && input.fetch(slot, first + before * 2 + 1).x <= t) ++before;
    if (before == 0) return input.fetch(slot, first);
    const vec4 a = input.fetch(slot, first + (before - 1) * 2);
    if (before == record.stopCount) return a;
    const float from = input.fetch(slot, first + (before - 1) * 2 + 1).x,
                to = input.fetch(slot, first + before * 2 + 1).x;
    return glm::mix(a, input.fetch(slot, first + before * 2), (t - from) / (to - from));
  }
  /// Around point p of gradient space.
  CpuColor gradient(vec2 p, vec2 reach) const {
    Bounds bounds;
    const bool encoded = record.flags & shader::kInterpolateSrgb, convert = encoded != blendSrgb();
    const auto colorAt = [&](float t) {
      vec4 color = stopColor(t);
      if (convert) color = vec4(shader::convertSrgb(vec3(color), blendSrgb()), color.w);
      color = premultiplied(color);
      bounds.add(color, convert ? kPower : 0);
      return color;
    };
    const auto at = [&](vec2 point) {
      const float t = shader::rampAt(record, point);
      if (t < 0) {
        bounds.add(vec4(0));
        return vec4(0);
      }
      colorAt(std::max(t - kSteps * kUnit, 0.0f));
      colorAt(std::min(t + kSteps * kUnit, 1.0f));
      return colorAt(t);
    };
    const vec4 middle = at(p);
    for (const vec2 corner : {vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(1, 1)}) at(p + corner * reach);
    return bounds.around(middle);
  }

  static int wrapped(int i, int size, VkSamplerAddressMode mode) { // -1: the border
    if (mode == VK_SAMPLER_ADDRESS_MODE_REPEAT) return (i % size + size) % size;
    if (mode == VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT) {
      const int k = (i % (2 * size) + 2 * size) % (2 * size);
      return k < size ? k : 2 * size - 1 - k;
    }
    if (mode == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER) return i < 0 || i >= size ? -1 : i;
    return std::clamp(i, 0, size - 1);
  }
  static vec4 texel(const CpuImage& image, int x, int y) {
    const int u = wrapped(x, static_cast<int>(image.width), image.mode);
    const int v = wrapped(y, static_cast<int>(image.height), image.mode);
    if (u < 0 || v < 0) return vec4(0); // transparent black
    const uint32_t word = image.texels[static_cast<size_t>(v) * image.width + static_cast<size_t>(u)];
    return vec4(word & 255, word >> 8 & 255, word >> 16 & 255, word >> 24) / 255.0f;
  }
  static vec4 sampled(const CpuImage& image, vec2 at) { // in texels
    if (image.filter == VK_FILTER_NEAREST)
      return texel(image, static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y)));
    const vec2 corner = at - 0.5f, whole = glm::floor(corner), part = corner - whole;
    const int x = static_cast<int>(whole.x), y = static_cast<int>(whole.y);
    return glm::mix(glm::mix(texel(image, x, y), texel(image, x + 1, y), part.x),
                    glm::mix(texel(image, x, y + 1), texel(image, x + 1, y + 1), part.x), part.y);
  }
  /// Around point p of the paint's space.
  CpuColor image(const ItemRecord& item, vec2 p, vec2 reach) const {
    const uint32_t which = item.firstImage + record.firstStop;
    const CpuImage& image = input.images[which];
    const vec2 size(image.width, image.height);
    const uint32_t holds = input.header.images >> which * shader::kImageBits;
    const bool encodes = ((holds & shader::kImageEncoded) != 0) != blendSrgb();
    const auto textureAt = [&](vec2 u) {
      if (record.kind != shader::kPaintSlices) return u;
      const size_t slices = input.slots(slot).stops + record.slices * 2;
      const vec4 places = input.fetch(slot, slices), there = input.fetch(slot, slices + 1);
      const vec4 across = input.fetch(slot, slices + 2), down = input.fetch(slot, slices + 3);
      const vec2 texels = across.w + down.w > 0 ? size : vec2(1);
      return vec2(shader::sliceAt(u.x, vec2(places.x, places.y), vec2(there.x, there.y), across, texels.x).x,
                  shader::sliceAt(u.y, vec2(places.z, places.w), vec2(there.z, there.w), down, texels.y).x);
    };
    Bounds bounds;
    // What the device may make of a colour that it knows to `coarse`.
    const auto painted = [&](const vec4& color, float coarse) {
      Bounds around;
      const auto paint = [&](const vec4& c) {
        const vec4 mixes = shader::imageColor(c, holds, input.header.flags);
        around.add(mixes, encodes ? kPower : 0);
        return mixes;
      };
      for (const float more : {-coarse, coarse})
        for (const float alpha : {-coarse, coarse}) paint(glm::clamp(color + vec4(vec3(more), alpha), 0.0f, 1.0f));
      return std::pair(paint(color), around);
    };
    // A filter's weights and sums of 8-bit texels may be as coarse as these are.
    const bool filters = image.filter == VK_FILTER_LINEAR, byTexel = (holds & shader::kImageByTexel) != 0;
    const float subTexel = byTexel ? 0 : input.subTexel;
    const auto at = [&](vec2 point) {
      if (!byTexel) {
        const auto [color, around] = painted(sampled(image, point), filters ? 1.0f / 255 : 0);
        bounds.add(around.low);
        bounds.add(around.high);
        return color;
      }
      const vec4 place = shader::texelsAround(point);
      vec4 sum(0), low(0), high(0);
      for (uint32_t k = 0; k < 4; ++k) {
        const int x = static_cast<int>(place.x) + static_cast<int>(k & 1), y = static_cast<int>(place.y) + (k > 1);
        const auto [color, around] = painted(texel(image, x, y), filters ? kAlone : 0);
        const float weight = shader::texelWeight(place, k);
        sum += color * weight;
        low += around.low * weight;
        high += around.high * weight;
      }
      bounds.add(low);
      bounds.add(high);
      return sum;
    };
    const vec2 texture = textureAt(p);
    const vec4 middle = at(texture * size);
    for (const vec2 corner : {vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(1, 1)}) {
      const vec2 there = textureAt(p + corner * reach) * size;
      at(there + corner * (subTexel + kSteps * kUnit * glm::abs(there)));
    }
    return bounds.around(middle);
  }
};

/// A canvas point in a drawing, and how exactly it is known.
void drawingPoint(const CpuInput& input, const shader::PlacementRecord& placement, const ItemRecord& item, vec2 middle,
                  vec2& at, vec2& reach) {
  const auto magnitude = [](vec4 v) { return glm::abs(v); };
  at = vec2(item.inverse.x * middle.x + item.inverse.z * middle.y + item.offsets.x,
            item.inverse.y * middle.x + item.inverse.w * middle.y + item.offsets.y);
  // The map is a source's after a move and a scale (placement.h), whose terms may cancel.
  const ItemRecord& source = input.sources[placement.source & ((1u << shader::kSlotBit) - 1)];
  const float unit = placement.size > 0 ? 1 / placement.size : 0;
  const vec4 moved = magnitude(source.inverse) +
                     std::abs(placement.x) * magnitude(vec4(source.eye.x, 0, source.eye.y, 0)) +
                     std::abs(placement.y) * magnitude(vec4(0, source.eye.x, 0, source.eye.y));
  const float nearest = source.perspective.w > 0 ? std::abs(source.eye.z) : 1;
  const vec2 offset(std::abs(source.offsets.x) + std::abs(placement.x) * nearest,
                    std::abs(source.offsets.y) + std::abs(placement.y) * nearest);
  reach = kSteps * kUnit * unit *
          vec2(moved.x * middle.x + moved.z * middle.y + offset.x, moved.y * middle.x + moved.w * middle.y + offset.y);
  if (shader::projects(item)) {
    const float far = item.eye.x * middle.x + item.eye.y * middle.y + item.eye.z;
    const float terms = std::abs(item.eye.x) * middle.x + std::abs(item.eye.y) * middle.y + std::abs(item.eye.z);
    at /= far;
    reach = reach / std::abs(far) + glm::abs(at) * (kSteps * kUnit * terms / std::abs(far));
  }
}

/// How far a triangle's weights may be off at a point that is known to `reach`.
vec3 weightDoubt(const shader::ShapeRecord& s, const shader::TriangleWeights& w, vec2 at, vec2 reach) {
  const vec2 size = glm::abs(at) + glm::abs(shader::triangleCorner(s, 0)) + glm::abs(shader::triangleCorner(s, 1)) +
                    glm::abs(shader::triangleCorner(s, 2));
  const vec2 place = reach + kSteps * kUnit * size;
  return glm::abs(w.across) * place.x + glm::abs(w.down) * place.y;
}

} // namespace

CpuColor paintAt(const CpuInput& input, const CpuPlaces& places, const shader::PlacedPath& path, uint32_t x, uint32_t y,
                 uint32_t mask) {
  const bool encoded = input.header.flags & shader::kBlendSrgb;
  // What is in no gradient was encoded by the device.
  CpuColor color{path.color, vec4(vec3(path.color) * (encoded ? kPower : 0), 0)};
  if (path.paint == 0) return color;
  const ItemRecord& item = places.items[path.item];
  const bool triangle = path.paint & shader::kPaintsTriangle;
  const vec2 middle = vec2(x, y) + (triangle ? shader::middleOf(mask, input.header.samples) : vec2(0.5f));
  vec2 at, reach;
  drawingPoint(input, input.placements[path.item], item, middle, at, reach);
  // (c + d)(p + q) - c p, of which all are positive.
  const auto paintBy = [&color](const CpuColor& painted) {
    color = {color.color * painted.color, color.color * painted.doubt + color.doubt * (painted.color + painted.doubt)};
  };
  const uint32_t record = path.paint & ~shader::kPaintsTriangle;
  if (triangle) {
    const shader::ShapeRecord shape = shapeOf(input, item);
    const auto weights = shader::triangleWeights(shape, at);
    const vec3 doubt = weightDoubt(shape, weights, at, reach);
    const vec4 own = shader::triangleColor(shape, weights.at);
    // No channel is above 1, and straight colours are multiplied by another one.
    paintBy({own, vec4(2 * (doubt.x + doubt.y + doubt.z) + kSteps * kUnit)});
    if (!record) return color;
    const Paint paint(input, item.slot, record - 1);
    const vec4 m = paint.record.matrix, o = paint.record.origin;
    paintBy(paint.image(item, shader::triangleTexture(m, o, weights.at),
                        shader::triangleTexture(glm::abs(m), glm::abs(o), doubt + kSteps * kUnit * weights.at)));
    return color;
  }
  const Paint paint(input, item.slot, record - 1);
  const vec4 m = glm::abs(paint.record.matrix), o = glm::abs(paint.record.origin);
  const vec2 p = shader::paintPoint(paint.record.matrix, paint.record.origin, at);
  const float circles = paint.record.kind == shader::kPaintRadial ? std::abs(paint.record.startRadius) + o.z + o.w : 0;
  const vec2 size = glm::abs(at);
  const vec2 own(m.x * reach.x + m.z * reach.y + kSteps * kUnit * (m.x * size.x + m.z * size.y + o.x + circles),
                 m.y * reach.x + m.w * reach.y + kSteps * kUnit * (m.y * size.x + m.w * size.y + o.y + circles));
  paintBy(paint.record.kind >= shader::kPaintImage ? paint.image(item, p, own) : paint.gradient(p, own));
  return color;
}

} // namespace gpgp::vector
