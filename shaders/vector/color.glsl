// sRGB and linear light, straight colours.
vec3 encodeSrgb(vec3 v) {
  return mix(1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, v * 12.92, lessThanEqual(v, vec3(0.0031308)));
}
vec4 blended(vec3 color, float alpha) { // premultiplied, as colours mix
  return vec4(((header.flags & kBlendSrgb) != 0 ? encodeSrgb(color) : color) * alpha, alpha);
}
vec3 decodeSrgb(vec3 v) {
  return mix(pow((v + 0.055) / 1.055, vec3(2.4)), v / 12.92, lessThanEqual(v, vec3(0.04045)));
}
#if SOFTWARE // which takes both where only one is wanted
vec3 convertSrgb(vec3 v, bool encode) {
  const vec3 power = pow(encode ? v : (v + 0.055) / 1.055, vec3(encode ? 1.0 / 2.4 : 2.4));
  return mix(encode ? 1.055 * power - 0.055 : power, encode ? v * 12.92 : v / 12.92,
             lessThanEqual(v, vec3(encode ? 0.0031308 : 0.04045)));
}
#else
vec3 convertSrgb(vec3 v, bool encode) { return encode ? encodeSrgb(v) : decodeSrgb(v); }
#endif
