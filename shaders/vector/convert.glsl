// Between light and what sRGB encodes (color.glsl).
vec4 convert(vec4 color, bool encode) { // premultiplied, to sRGB or from it
  if (color.a <= 0) return color;
  const vec3 straight = max(color.rgb / color.a, 0.0);
  return vec4(convertSrgb(straight, encode) * color.a, color.a);
}
