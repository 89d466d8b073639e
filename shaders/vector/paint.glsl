// A gradient's colour at a point of the drawing, premultiplied; `paint` is the vec4 of its record in the drawing.
vec4 stopColor(uint slot, uint first, uint count, float t) {
  uint low = 0, high = count; // how many stops lie at or before t
  while (low < high) {
    const uint middle = (low + high) / 2;
    if (fetch(slot, first + middle * 2 + 1).x <= t) low = middle + 1;
    else high = middle;
  }
  if (low == 0) return fetch(slot, first);
  const vec4 a = fetch(slot, first + (low - 1) * 2);
  if (low == count) return a;
  const float from = fetch(slot, first + (low - 1) * 2 + 1).x, to = fetch(slot, first + low * 2 + 1).x;
  return mix(a, fetch(slot, first + low * 2), (t - from) / (to - from));
}

vec4 gradientAt(uint slot, uint paint, vec2 at) {
  const vec4 matrix = fetch(slot, paint), origin = fetch(slot, paint + 1);
  const uvec4 kinds = floatBitsToUint(fetch(slot, paint + 2)), ramp = floatBitsToUint(fetch(slot, paint + 3));
  const vec2 p = matrix.xy * at.x + matrix.zw * at.y + origin.xy;
  float t = p.x;
  if (kinds.y == kPaintRadial) {
    // a t^2 - 2 b t + c = 0, whose discriminant b^2 - a c is taken so that nothing large cancels.
    const float radius = uintBitsToFloat(kinds.x), distance = origin.z, growth = origin.w;
    const float a = uintBitsToFloat(ramp.w), b = distance * p.x + radius * growth, c = dot(p, p) - radius * radius;
    const float k = growth * p.x + distance * radius, inner = k * k - a * p.y * p.y;
    if (inner < 0 || (a == 0 && b == 0)) return vec4(0);
    const float root = sqrt(inner), w = b < 0 ? b - root : b + root;
    const float u = w == 0 ? 0.0 : c / w, v = a == 0 ? u : w / a;
    t = max(u, v);
    if (radius + t * growth < 0) t = min(u, v);
    if (radius + t * growth < 0) return vec4(0);
  }
  if (kinds.z == kSpreadRepeat) t -= floor(t);
  else if (kinds.z == kSpreadReflect) t = abs(t - 2.0 * floor(t * 0.5 + 0.5));
  vec4 color = stopColor(slot, slots[slot].stops + ramp.x * 2, ramp.y, clamp(t, 0.0, 1.0));
  const bool encoded = (kinds.w & kInterpolateSrgb) != 0, wanted = (header.flags & kBlendSrgb) != 0;
  if (encoded != wanted) color.rgb = convertSrgb(color.rgb, wanted);
  return vec4(color.rgb * color.a, color.a);
}

#if IMAGES
#define IMAGE(n) layout(set = 1, binding = n) uniform sampler2D image##n;
IMAGE(0) IMAGE(1) IMAGE(2) IMAGE(3) IMAGE(4) IMAGE(5) IMAGE(6) IMAGE(7)

vec4 sampleImage(uint i, vec2 at, vec2 dx, vec2 dy) { // a sampler may only be chosen by a constant
  switch (i) {
  case 0: return textureGrad(image0, at, dx, dy);
  case 1: return textureGrad(image1, at, dx, dy);
  case 2: return textureGrad(image2, at, dx, dy);
  case 3: return textureGrad(image3, at, dx, dy);
  case 4: return textureGrad(image4, at, dx, dy);
  case 5: return textureGrad(image5, at, dx, dy);
  case 6: return textureGrad(image6, at, dx, dy);
  default: return textureGrad(image7, at, dx, dy);
  }
}

ivec2 sizeOfImage(uint i) {
  switch (i) {
  case 0: return textureSize(image0, 0);
  case 1: return textureSize(image1, 0);
  case 2: return textureSize(image2, 0);
  case 3: return textureSize(image3, 0);
  case 4: return textureSize(image4, 0);
  case 5: return textureSize(image5, 0);
  case 6: return textureSize(image6, 0);
  default: return textureSize(image7, 0);
  }
}

// Along an axis of a nine-slice: the texture coordinate at a place, and how fast it grows there. slopes: before, in and
// after the middle; w: the period of a middle that repeats. Filters reach half a texel: no further than the middle.
vec2 sliceAt(float place, vec2 places, vec2 there, vec4 slopes, float texels) {
  if (place < places.x) return vec2(there.x + (place - places.x) * slopes.x, slopes.x);
  if (place >= places.y) return vec2(there.y + (place - places.y) * slopes.z, slopes.z);
  float along = place - places.x;
  if (slopes.w == 0) return vec2(there.x + along * slopes.y, slopes.y);
  along -= floor(along / slopes.w) * slopes.w;
  const float middle = 0.5 * (there.x + there.y), reach = max(0.5 * abs(there.y - there.x) - 0.5 / texels, 0.0);
  return vec2(clamp(there.x + along * slopes.y, middle - reach, middle + reach), slopes.y);
}

// An image's colour at a point of the drawing, premultiplied; dx and dy: how far the point moves from pixel to pixel.
vec4 imageAt(ItemRecord item, uint paint, vec2 at, vec2 dx, vec2 dy) {
  const vec4 matrix = fetch(item.slot, paint);
  const vec2 origin = fetch(item.slot, paint + 1).xy;
  const uint image = item.firstImage + floatBitsToUint(fetch(item.slot, paint + 3)).x;
  vec2 u = matrix.xy * at.x + matrix.zw * at.y + origin;
  vec2 ux = matrix.xy * dx.x + matrix.zw * dx.y, uy = matrix.xy * dy.x + matrix.zw * dy.y;
  if (floatBitsToUint(fetch(item.slot, paint + 2)).y == kPaintSlices) {
    const uint slices = slots[item.slot].stops + floatBitsToUint(fetch(item.slot, paint + 3)).z * 2;
    const vec4 places = fetch(item.slot, slices), there = fetch(item.slot, slices + 1);
    const vec4 across = fetch(item.slot, slices + 2), down = fetch(item.slot, slices + 3);
    const vec2 texels = across.w + down.w > 0 ? vec2(sizeOfImage(image)) : vec2(1);
    const vec2 x = sliceAt(u.x, places.xy, there.xy, across, texels.x);
    const vec2 y = sliceAt(u.y, places.zw, there.zw, down, texels.y);
    u = vec2(x.x, y.x);
    const vec2 slope = vec2(x.y, y.y);
    ux *= slope;
    uy *= slope;
  }
  vec4 color = sampleImage(image, u, ux, uy);
  if ((header.premultiplied >> image & 1) == 0) color.rgb *= color.a;
  return (header.flags & kBlendSrgb) != 0 ? convert(color, true) : color;
}
#endif
