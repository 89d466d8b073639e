// Blend modes (W3C Compositing and Blending 1) and Porter and Duff's operators, on premultiplied colours.
#ifndef GPGP_SHADERS_VECTOR_BLEND_H
#define GPGP_SHADERS_VECTOR_BLEND_H
#include "vector/layers/operation.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kBlendNormal = 0u, kBlendMultiply = 1u, kBlendScreen = 2u, kBlendOverlay = 3u, kBlendDarken = 4u,
                kBlendLighten = 5u, kBlendColorDodge = 6u, kBlendColorBurn = 7u, kBlendHardLight = 8u,
                kBlendSoftLight = 9u, kBlendDifference = 10u, kBlendExclusion = 11u, kBlendHue = 12u,
                kBlendSaturation = 13u, kBlendColor = 14u, kBlendLuminosity = 15u, kBlendPlusLighter = 16u;
GPGP_CONST uint kOperatorOver = 0u, kOperatorIn = 1u, kOperatorOut = 2u, kOperatorAtop = 3u, kOperatorXor = 4u,
                kOperatorLighter = 5u, kOperatorArithmetic = 6u;

// One channel: s on b.
GPGP_FN float blendHard(float b, float s) { return s <= 0.5f ? b * 2.0f * s : b + (2.0f * s - 1.0f) * (1.0f - b); }
GPGP_FN float blendSoft(float b, float s) {
  if (s <= 0.5f) return b - (1.0f - 2.0f * s) * b * (1.0f - b);
  const float d = b <= 0.25f ? ((16.0f * b - 12.0f) * b + 4.0f) * b : sqrt(b);
  return b + (2.0f * s - 1.0f) * (d - b);
}
GPGP_FN float blendChannel(uint mode, float b, float s) {
  if (mode == kBlendMultiply) return b * s;
  if (mode == kBlendDarken) return min(b, s);
  if (mode == kBlendLighten) return max(b, s);
  if (mode == kBlendDifference) return abs(b - s);
  b = min(b, 1.0f);
  s = min(s, 1.0f);
  if (mode == kBlendScreen) return b + s - b * s;
  if (mode == kBlendOverlay) return blendHard(s, b);
  if (mode == kBlendColorDodge) return b <= 0.0f ? 0.0f : (s >= 1.0f ? 1.0f : min(1.0f, b / (1.0f - s)));
  if (mode == kBlendColorBurn) return b >= 1.0f ? 1.0f : (s <= 0.0f ? 0.0f : 1.0f - min(1.0f, (1.0f - b) / s));
  if (mode == kBlendHardLight) return blendHard(b, s);
  if (mode == kBlendSoftLight) return blendSoft(b, s);
  if (mode == kBlendExclusion) return b + s - 2.0f * b * s;
  return s;
}

GPGP_FN float luminosity(vec3 c) { return 0.3f * c.x + 0.59f * c.y + 0.11f * c.z; }
GPGP_FN vec3 withLuminosity(vec3 c, float l) {
  c = c + (l - luminosity(c));
  const float low = min(min(c.x, c.y), c.z), high = max(max(c.x, c.y), c.z);
  if (low < 0.0f) c = l + (c - l) * (l / (l - low));
  if (high > 1.0f) c = l + (c - l) * ((1.0f - l) / (high - l));
  return c;
}
GPGP_FN float saturation(vec3 c) { return max(max(c.x, c.y), c.z) - min(min(c.x, c.y), c.z); }
GPGP_FN vec3 withSaturation(vec3 c, float s) {
  const float low = min(min(c.x, c.y), c.z), range = saturation(c);
  return range > 0.0f ? (c - low) * (s / range) : vec3(0.0f);
}

// B(b, s) of the specification: straight colours.
GPGP_FN vec3 blendColors(uint mode, vec3 b, vec3 s) {
  if (mode < kBlendHue)
    return vec3(blendChannel(mode, b.x, s.x), blendChannel(mode, b.y, s.y), blendChannel(mode, b.z, s.z));
  b = min(b, vec3(1.0f));
  s = min(s, vec3(1.0f));
  if (mode == kBlendHue) return withLuminosity(withSaturation(s, saturation(b)), luminosity(b));
  if (mode == kBlendSaturation) return withLuminosity(withSaturation(b, saturation(s)), luminosity(b));
  if (mode == kBlendColor) return withLuminosity(s, luminosity(b));
  return withLuminosity(b, luminosity(s));
}

GPGP_FN vec3 straightOf(vec4 color) { return color.w > 0.0f ? max(vec3(color) / color.w, vec3(0.0f)) : vec3(0.0f); }

// Premultiplied: s on b.
GPGP_FN vec4 blendOver(uint mode, vec4 b, vec4 s) {
  if (mode == kBlendPlusLighter) {
    const vec4 sum = b + s;
    return min(sum, max(vec4(1.0f), max(b, s)));
  }
  vec4 mixed = s + b * (1.0f - s.w);
  const float both = b.w * s.w;
  if (mode == kBlendNormal || both <= 0.0f) return mixed;
  const vec3 color = blendColors(mode, straightOf(b), straightOf(s));
  return mixed + vec4(color * both - vec3(s) * b.w, 0.0f);
}

// Premultiplied: a on b.
GPGP_FN vec4 operate(uint mode, vec4 a, vec4 b, vec4 k) {
  if (mode == kOperatorOver) return a + b * (1.0f - a.w);
  if (mode == kOperatorIn) return a * b.w;
  if (mode == kOperatorOut) return a * (1.0f - b.w);
  if (mode == kOperatorAtop) return a * b.w + b * (1.0f - a.w);
  if (mode == kOperatorXor) return a * (1.0f - b.w) + b * (1.0f - a.w);
  if (mode == kOperatorLighter) return min(a + b, max(vec4(1.0f), max(a, b)));
  const vec4 sum = clamp(k.x * a * b + k.y * a + k.z * b + vec4(k.w), vec4(0.0f), vec4(1.0f));
  return vec4(min(vec3(sum), vec3(sum.w)), sum.w);
}

GPGP_SHADER_END
#endif
