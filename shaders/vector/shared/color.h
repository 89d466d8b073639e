// sRGB and linear light, and what a pixel's colour becomes in the view and in the target.
//
// Powers are as exact as the device's (src/vector/cpu_reference/paint.cpp says how exact that is).
#ifndef GPGP_SHADERS_VECTOR_COLOR_H
#define GPGP_SHADERS_VECTOR_COLOR_H
#include "vector/shared/layout.h"

GPGP_SHADER_BEGIN

// Straight colours.
GPGP_FN vec3 encodeSrgb(vec3 v) {
  return mix(1.055f * pow(v, vec3(1.0f / 2.4f)) - 0.055f, v * 12.92f, lessThanEqual(v, vec3(0.0031308f)));
}
GPGP_FN vec3 decodeSrgb(vec3 v) {
  return mix(pow((v + 0.055f) / 1.055f, vec3(2.4f)), v / 12.92f, lessThanEqual(v, vec3(0.04045f)));
}
#if !defined(__cplusplus) && SOFTWARE // which takes both where only one is wanted
vec3 convertSrgb(vec3 v, bool encode) {
  const vec3 power = pow(encode ? v : (v + 0.055) / 1.055, vec3(encode ? 1.0 / 2.4 : 2.4));
  return mix(encode ? 1.055 * power - 0.055 : power, encode ? v * 12.92 : v / 12.92,
             lessThanEqual(v, vec3(encode ? 0.0031308 : 0.04045)));
}
#else
GPGP_FN vec3 convertSrgb(vec3 v, bool encode) { return encode ? encodeSrgb(v) : decodeSrgb(v); }
#endif

// Premultiplied, to sRGB or from it.
GPGP_FN vec4 convert(vec4 color, bool encode) {
  if (color.w <= 0.0f) return color;
  const vec3 straight = max(vec3(color) / color.w, 0.0f);
  return vec4(convertSrgb(straight, encode) * color.w, color.w);
}

// What an image holds, premultiplied, as colours mix. `holds`: kImage...
GPGP_FN vec4 imageColor(vec4 color, uint holds, uint flags) {
  const bool encoded = (holds & kImageEncoded) != 0u, wanted = (flags & kBlendSrgb) != 0u;
  if ((holds & kImagePremultiplied) != 0u) return encoded == wanted ? color : convert(color, wanted);
  vec3 straight = vec3(color);
  if (encoded != wanted) straight = convertSrgb(max(straight, 0.0f), wanted);
  return vec4(straight * color.w, color.w);
}

// A straight linear colour premultiplied, as colours mix. flags: the header's, as below.
GPGP_FN vec4 blended(vec3 color, float alpha, uint flags) {
  return vec4(((flags & kBlendSrgb) != 0u ? encodeSrgb(color) : color) * alpha, alpha);
}
// What the view and the target receive of colours that have been mixed.
GPGP_FN vec4 linearColor(vec4 color, uint flags) {
  return (flags & (kBlendSrgb | kKeepEncoding)) == kBlendSrgb ? convert(color, false) : color;
}
GPGP_FN vec4 targetColor(vec4 color, uint flags) {
  const bool encoded = (flags & kBlendSrgb) != 0u, wanted = (flags & kEncodeSrgb) != 0u;
  return encoded == wanted ? color : convert(color, wanted);
}

GPGP_SHADER_END
#endif
