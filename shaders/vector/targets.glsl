// What a pixel's colour becomes in the view and in the target. What both hold alike is rounded alike first.
vec4 linearColor(vec4 color) { return (header.flags & kBlendSrgb) != 0 ? convert(color, false) : color; }
vec4 targetColor(vec4 color) {
  if ((header.flags & kEncodeSrgb) != 0) return (header.flags & kBlendSrgb) != 0 ? color : convert(color, true);
  const vec4 linear = linearColor(color);
  return vec4(unpackHalf2x16(packHalf2x16(linear.rg)), unpackHalf2x16(packHalf2x16(linear.ba)));
}
