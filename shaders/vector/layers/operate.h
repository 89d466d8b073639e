// What operations on pictures do to a pixel: one text for the shaders and their CPU reference.
//
// It is included where these are known: texelAt(PictureRecord, int x, int y), a picture's colour (transparent outside
// of its box), and tableAt(uint slot, uint entry), a vec4 of a drawing's tables. In C++ these are members of the class
// that includes this. Loops turn as often as the host says.

GPGP_FN vec4 recoded(vec4 color, bool encodes, bool decodes) {
  return encodes || decodes ? convert(color, encodes) : color;
}

GPGP_FN vec4 readA(OperationRecord o, int x, int y) {
  vec4 color = recoded(texelAt(o.a, x, y), (o.flags & kEncodeA) != 0u, (o.flags & kDecodeA) != 0u);
  if ((o.flags & kAlphaOnly) != 0u) color = vec4(0.0f, 0.0f, 0.0f, color.w);
  return color;
}
GPGP_FN vec4 readB(OperationRecord o, int x, int y) {
  return recoded(texelAt(o.b, x, y), (o.flags & kEncodeB) != 0u, (o.flags & kDecodeB) != 0u);
}
// Between pixels; (x, y) in pixels, whose middles lie at halves.
GPGP_FN vec4 readBetween(PictureRecord p, float x, float y) {
  const float u = floor(x - 0.5f), v = floor(y - 0.5f);
  const int i = int(u), k = int(v);
  const float s = x - 0.5f - u, t = y - 0.5f - v;
  return mix(mix(texelAt(p, i, k), texelAt(p, i + 1, k), s), mix(texelAt(p, i, k + 1), texelAt(p, i + 1, k + 1), s), t);
}
GPGP_FN vec2 pixelOf(OperationRecord o, float x, float y) {
  return vec2(o.toPixel.x * x + o.toPixel.z * y + o.offsets.x, o.toPixel.y * x + o.toPixel.w * y + o.offsets.y);
}
GPGP_FN vec2 pointOf(OperationRecord o, float x, float y) {
  return vec2(o.toSpace.x * x + o.toSpace.z * y + o.offsets.z, o.toSpace.y * x + o.toSpace.w * y + o.offsets.w);
}

// How much of a pixel lies inside the region.
GPGP_FN float inRegion(OperationRecord o, int x, int y) {
  if ((o.flags & kHasRegion) == 0u) return 1.0f;
  const vec2 p = pointOf(o, float(x) + 0.5f, float(y) + 0.5f);
  // How far the sides lie away, in pixels.
  const float acrossX = 1.0f / max(sqrt(o.toSpace.x * o.toSpace.x + o.toSpace.z * o.toSpace.z), 1e-20f);
  const float acrossY = 1.0f / max(sqrt(o.toSpace.y * o.toSpace.y + o.toSpace.w * o.toSpace.w), 1e-20f);
  const float left = clamp((p.x - o.region.x) * acrossX + 0.5f, 0.0f, 1.0f);
  const float right = clamp((o.region.z - p.x) * acrossX + 0.5f, 0.0f, 1.0f);
  const float top = clamp((p.y - o.region.y) * acrossY + 0.5f, 0.0f, 1.0f);
  const float bottom = clamp((o.region.w - p.y) * acrossY + 0.5f, 0.0f, 1.0f);
  return max(left + right - 1.0f, 0.0f) * max(top + bottom - 1.0f, 0.0f);
}

#if OPERATIONS == 0 || defined(__cplusplus)
// A layer's picture onto its parent's, or onto what a filter takes of it.
GPGP_FN vec4 compositeAt(OperationRecord o, int x, int y) {
  float shown = o.values[0].x;
  if ((o.flags & kHasB) != 0u) shown *= texelAt(o.b, x, y).w;
  if ((o.flags & kHasC) != 0u) {
    const vec4 mask = recoded(texelAt(o.c, x, y), (o.flags & kEncodeC) != 0u, (o.flags & kDecodeC) != 0u);
    shown *= (o.flags & kAlphaMask) != 0u ? mask.w
                                          : clamp(0.2126f * mask.x + 0.7152f * mask.y + 0.0722f * mask.z, 0.0f, 1.0f);
  }
  shown *= inRegion(o, x, y);
  return blendOver(o.mode, texelAt(o.result, x, y), readA(o, x, y) * shown);
}
#endif

#if OPERATIONS == 1 || defined(__cplusplus)
GPGP_FN float gaussian(float x, float deviation) {
  const float t = x / deviation;
  return exp(-0.5f * t * t);
}
// Along a line through the pixel: `count` samples on each side.
GPGP_FN vec4 blurAt(OperationRecord o, int x, int y) {
  const vec2 way = vec2(o.values[0].x, o.values[0].y);
  const bool level = way.y == 0.0f, upright = way.x == 0.0f;
  vec4 sum = texelAt(o.a, x, y);
  float weights = 1.0f;
  for (int k = 1; k <= int(o.count); ++k) {
    const float weight = gaussian(float(k), o.values[0].z);
    vec4 both;
    if (level || upright) {
      const int i = level ? k : 0, j = level ? 0 : k;
      both = texelAt(o.a, x - i, y - j) + texelAt(o.a, x + i, y + j);
    } else {
      const float u = float(x) + 0.5f, v = float(y) + 0.5f, s = float(k);
      both = readBetween(o.a, u - s * way.x, v - s * way.y) + readBetween(o.a, u + s * way.x, v + s * way.y);
    }
    sum += both * weight;
    weights += 2.0f * weight;
  }
  return sum / weights * inRegion(o, x, y);
}
GPGP_FN vec4 shrinkAt(OperationRecord o, int x, int y) {
  const int across = int(o.values[0].x), down = int(o.values[0].y);
  vec4 sum = vec4(0.0f);
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i) sum += readA(o, x * across + i, y * down + j);
  return sum / float(across * down);
}
GPGP_FN vec4 growAt(OperationRecord o, int x, int y) {
  return readBetween(o.a, (float(x) + 0.5f) / o.values[0].x, (float(y) + 0.5f) / o.values[0].y) * inRegion(o, x, y);
}
#endif

#if OPERATIONS == 2 || defined(__cplusplus)
// What needs one pixel of its inputs, or one place between them.
GPGP_FN vec4 colorAt(OperationRecord o, int x, int y) {
  if (o.kind == kOperationFlood) return o.values[0];
  if (o.kind == kOperationCopy) return readA(o, x, y);
  if (o.kind == kOperationOffset) {
    const float u = float(x) + 0.5f - o.values[0].x, v = float(y) + 0.5f - o.values[0].y;
    return readBetween(o.a, u, v);
  }
  if (o.kind == kOperationShadow) {
    const vec4 own = readA(o, x, y);
    const float dark = readBetween(o.b, float(x) + 0.5f - o.values[0].x, float(y) + 0.5f - o.values[0].y).w;
    return own + o.values[1] * dark * (1.0f - own.w);
  }
  const vec4 a = readA(o, x, y);
  if (o.kind == kOperationBlend) return blendOver(o.mode, readB(o, x, y), a);
  if (o.kind == kOperationOperator) return operate(o.mode, a, readB(o, x, y), o.values[0]);
  const vec3 straight = straightOf(a);
  vec4 c = vec4(straight, a.w);
  if (o.kind == kOperationColorMatrix) {
    const vec4 offset = o.values[4];
    c = clamp(vec4(dot(o.values[0], c), dot(o.values[1], c), dot(o.values[2], c), dot(o.values[3], c)) + offset,
              vec4(0.0f), vec4(1.0f));
  } else { // kOperationTransfer: tables of 256 numbers, four in each vec4
    c = clamp(c, vec4(0.0f), vec4(1.0f));
    for (int k = 0; k < 4; ++k) {
      const float place = c[k] * 255.0f;
      const uint low = min(uint(place), 254u), at = uint(k) * 256u + low;
      const uint slot = floatBitsToUint(o.values[0].x), first = floatBitsToUint(o.values[0].y);
      const float from = tableAt(slot, first + at / 4u)[int(at % 4u)];
      const float to = tableAt(slot, first + (at + 1u) / 4u)[int((at + 1u) % 4u)];
      c[k] = clamp(mix(from, to, place - float(low)), 0.0f, 1.0f);
    }
  }
  return vec4(vec3(c) * c.w, c.w);
}
#endif
