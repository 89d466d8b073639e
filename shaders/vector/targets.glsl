// What a pixel's colour becomes in the view and in the target.
vec4 linearColor(vec4 color) { return (header.flags & kBlendSrgb) != 0 ? convert(color, false) : color; }
vec4 targetColor(vec4 color) {
  const bool encoded = (header.flags & kBlendSrgb) != 0, wanted = (header.flags & kEncodeSrgb) != 0;
  return encoded == wanted ? color : convert(color, wanted);
}
