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

// How much of a pixel lies inside a region of the operation's space.
GPGP_FN float coverageOf(OperationRecord o, vec4 region, int x, int y) {
  const vec2 p = pointOf(o, float(x) + 0.5f, float(y) + 0.5f);
  // How far the sides lie away, in pixels.
  const float acrossX = 1.0f / max(sqrt(o.toSpace.x * o.toSpace.x + o.toSpace.z * o.toSpace.z), 1e-20f);
  const float acrossY = 1.0f / max(sqrt(o.toSpace.y * o.toSpace.y + o.toSpace.w * o.toSpace.w), 1e-20f);
  const float left = clamp((p.x - region.x) * acrossX + 0.5f, 0.0f, 1.0f);
  const float right = clamp((region.z - p.x) * acrossX + 0.5f, 0.0f, 1.0f);
  const float top = clamp((p.y - region.y) * acrossY + 0.5f, 0.0f, 1.0f);
  const float bottom = clamp((region.w - p.y) * acrossY + 0.5f, 0.0f, 1.0f);
  return max(left + right - 1.0f, 0.0f) * max(top + bottom - 1.0f, 0.0f);
}
GPGP_FN float inRegion(OperationRecord o, int x, int y) {
  return (o.flags & kHasRegion) != 0u ? coverageOf(o, o.region, x, y) : 1.0f;
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
// Along a line through the pixel: `count` samples on each side, values[0].w pixels apart.
GPGP_FN vec4 blurAt(OperationRecord o, int x, int y) {
  const vec2 way = vec2(o.values[0].x, o.values[0].y);
  const bool level = way.y == 0.0f, upright = way.x == 0.0f;
  vec4 sum = texelAt(o.a, x, y);
  float weights = 1.0f;
  for (int k = 1; k <= int(o.count); ++k) {
    const float weight = gaussian(float(k), o.values[0].z);
    vec4 both;
    const int apart = k * int(o.values[0].w);
    if (level || upright) {
      const int i = level ? apart : 0, j = level ? 0 : apart;
      both = texelAt(o.a, x - i, y - j) + texelAt(o.a, x + i, y + j);
    } else {
      const float u = float(x) + 0.5f, v = float(y) + 0.5f, s = float(apart);
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

#if OPERATIONS == 3 || defined(__cplusplus)
GPGP_FN float wrapped(float v, float low, float high) {
  const float size = max(high - low, 1e-6f);
  return v - floor((v - low) / size) * size;
}
// Where the operation's input is read for a point of its space: inside the input's region, as the edges say.
GPGP_FN vec2 edgePoint(vec2 p, vec4 region, uint edges) {
  if (edges == 1u)
    return vec2(clamp(p.x, min(region.x + 0.5f, region.z), max(region.z - 0.5f, region.x)),
                clamp(p.y, min(region.y + 0.5f, region.w), max(region.w - 0.5f, region.y)));
  if (edges == 2u) return vec2(wrapped(p.x, region.x, region.z), wrapped(p.y, region.y, region.w));
  return p;
}
GPGP_FN vec4 convolveAt(OperationRecord o, int x, int y) {
  const int across = int(o.values[0].x), down = int(o.values[0].y);
  const bool keepsAlpha = o.values[1].z != 0.0f;
  const uint slot = floatBitsToUint(o.values[3].x), first = floatBitsToUint(o.values[3].y);
  const vec2 middle = pointOf(o, float(x) + 0.5f, float(y) + 0.5f);
  vec4 sum = vec4(0.0f);
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i) {
      const uint entry = uint((down - 1 - j) * across + across - 1 - i);
      const float weight = tableAt(slot, first + entry / 4u)[int(entry % 4u)];
      const vec2 p = edgePoint(vec2(middle.x + (float(i) - o.values[0].z) * o.values[4].x,
                                    middle.y + (float(j) - o.values[0].w) * o.values[4].y),
                               o.values[2], o.mode);
      const vec2 q = pixelOf(o, p.x, p.y);
      vec4 color = readBetween(o.a, q.x, q.y);
      if (keepsAlpha) color = vec4(straightOf(color), color.w);
      sum += color * weight;
    }
  const float bias = o.values[1].y;
  sum = sum / o.values[1].x;
  const float alpha = keepsAlpha ? texelAt(o.a, x, y).w : sum.w + bias;
  const vec3 color = clamp(vec3(sum) + vec3(bias * (keepsAlpha ? 1.0f : alpha)), vec3(0.0f), vec3(1.0f));
  if (keepsAlpha) return vec4(color * alpha, alpha);
  const float shown = clamp(alpha, 0.0f, 1.0f);
  return vec4(min(color, vec3(shown)), shown);
}
// A tile's pixels along its border are in it only in part. What is read between pixels is divided by how much of them
// is, so that neighbouring tiles show no seam.
GPGP_FN vec4 tileAt(OperationRecord o, int x, int y) {
  const vec2 p = edgePoint(pointOf(o, float(x) + 0.5f, float(y) + 0.5f), o.values[2], 2u);
  const vec2 q = pixelOf(o, p.x, p.y);
  const float u = floor(q.x - 0.5f), v = floor(q.y - 0.5f), s = q.x - 0.5f - u, t = q.y - 0.5f - v;
  vec4 sum = vec4(0.0f);
  float inside = 0.0f;
  for (int k = 0; k < 4; ++k) {
    const int i = int(u) + k % 2, j = int(v) + k / 2;
    const float weight = (k % 2 == 0 ? 1.0f - s : s) * (k / 2 == 0 ? 1.0f - t : t);
    sum += texelAt(o.a, i, j) * weight;
    inside += coverageOf(o, o.values[2], i, j) * weight;
  }
  sum = sum / max(inside, 0.125f);
  const float alpha = min(sum.w, 1.0f);
  return vec4(min(vec3(sum), vec3(alpha)), alpha);
}
GPGP_FN vec4 neighbourhoodAt(OperationRecord o, int x, int y) {
  if (o.kind == kOperationMorphology) {
    const bool axisY = (o.flags & kAxisY) != 0u, most = o.mode != 0u;
    vec4 found = texelAt(o.a, x, y);
    for (int k = 1; k <= int(o.count); ++k) {
      const int i = axisY ? 0 : k, j = axisY ? k : 0;
      const vec4 before = texelAt(o.a, x - i, y - j), behind = texelAt(o.a, x + i, y + j);
      found = most ? max(found, max(before, behind)) : min(found, min(before, behind));
    }
    return found;
  }
  if (o.kind == kOperationConvolve) return convolveAt(o, x, y);
  if (o.kind == kOperationTile) return tileAt(o, x, y);
  const vec4 map = readB(o, x, y); // kOperationDisplace
  const vec4 straight = vec4(straightOf(map), map.w);
  const float u = o.values[0].x * (straight[int(o.mode % 4u)] - 0.5f);
  const float v = o.values[0].x * (straight[int(o.mode / 4u)] - 0.5f);
  return readBetween(o.a, float(x) + 0.5f + o.toPixel.x * u + o.toPixel.z * v,
                     float(y) + 0.5f + o.toPixel.y * u + o.toPixel.w * v);
}
#endif

#if OPERATIONS == 4 || defined(__cplusplus)
GPGP_FN float easeCurve(float t) { return t * t * (3.0f - 2.0f * t); }
// The four channels' gradients at a point of the lattice, times the way there.
GPGP_FN vec4 latticeAt(uint slot, uint first, uint i, float x, float y) {
  const vec4 a = tableAt(slot, first + i * 3u), b = tableAt(slot, first + i * 3u + 1u);
  return vec4(a.x * x + a.y * y, a.z * x + a.w * y, b.x * x + b.y * y, b.z * x + b.w * y);
}
// The noise of the SVG specification's feTurbulence, of four channels at once. The point is that of the pixel whose
// corner lies there, as where the specification's pixels have whole coordinates.
GPGP_FN vec4 noiseAt(OperationRecord o, int px, int py) {
  const uint slot = floatBitsToUint(o.values[2].x), first = floatBitsToUint(o.values[2].y);
  const vec2 middle = pointOf(o, float(px) + 0.5f, float(py) + 0.5f);
  float x = (middle.x - 0.5f) * o.values[0].x, y = (middle.y - 0.5f) * o.values[0].y, ratio = 1.0f;
  const bool stitched = o.values[0].w != 0.0f;
  int width = int(o.values[1].x), height = int(o.values[1].y), wrapX = int(o.values[1].z), wrapY = int(o.values[1].w);
  vec4 sum = vec4(0.0f);
  for (int octave = 0; octave < int(o.values[0].z); ++octave) {
    const float cellX = floor(x), cellY = floor(y), rx = x - cellX, ry = y - cellY;
    int x0 = int(cellX) + 4096, y0 = int(cellY) + 4096, x1 = x0 + 1, y1 = y0 + 1;
    if (stitched) {
      if (x0 >= wrapX) x0 -= width;
      if (x1 >= wrapX) x1 -= width;
      if (y0 >= wrapY) y0 -= height;
      if (y1 >= wrapY) y1 -= height;
    }
    const uint i = uint(tableAt(slot, first + uint(x0 & 255) * 3u + 2u).x);
    const uint k = uint(tableAt(slot, first + uint(x1 & 255) * 3u + 2u).x);
    const uint b00 = uint(tableAt(slot, first + (i + uint(y0 & 255)) % 256u * 3u + 2u).x);
    const uint b10 = uint(tableAt(slot, first + (k + uint(y0 & 255)) % 256u * 3u + 2u).x);
    const uint b01 = uint(tableAt(slot, first + (i + uint(y1 & 255)) % 256u * 3u + 2u).x);
    const uint b11 = uint(tableAt(slot, first + (k + uint(y1 & 255)) % 256u * 3u + 2u).x);
    const float s = easeCurve(rx), t = easeCurve(ry);
    const vec4 above = mix(latticeAt(slot, first, b00, rx, ry), latticeAt(slot, first, b10, rx - 1.0f, ry), s);
    const vec4 below =
        mix(latticeAt(slot, first, b01, rx, ry - 1.0f), latticeAt(slot, first, b11, rx - 1.0f, ry - 1.0f), s);
    const vec4 noise = mix(above, below, t);
    sum += (o.mode == 0u ? noise : abs(noise)) / ratio;
    x *= 2.0f;
    y *= 2.0f;
    ratio *= 2.0f;
    width *= 2;
    height *= 2;
    wrapX = 2 * wrapX - 4096;
    wrapY = 2 * wrapY - 4096;
  }
  const vec4 color = clamp(o.mode == 0u ? (sum + vec4(1.0f)) * 0.5f : sum, vec4(0.0f), vec4(1.0f));
  return vec4(vec3(color) * color.w, color.w);
}
#endif

#if OPERATIONS == 5 || defined(__cplusplus)
GPGP_FN float heightAt(OperationRecord o, float x, float y) {
  const vec2 q = pixelOf(o, x, y);
  return readBetween(o.a, q.x, q.y).w;
}
// The surface's slope along an axis: differences of neighbours, of rows that lie in the region (the SVG specification's
// nine cases).
GPGP_FN vec4 lightAt(OperationRecord o, int px, int py) {
  const vec2 p = pointOf(o, float(px) + 0.5f, float(py) + 0.5f);
  const vec4 region = o.values[5];
  const float dx = o.values[4].x, dy = o.values[4].y;
  const float left = p.x - dx >= region.x ? 1.0f : 0.0f, right = p.x + dx <= region.z ? 1.0f : 0.0f;
  const float top = p.y - dy >= region.y ? 1.0f : 0.0f, bottom = p.y + dy <= region.w ? 1.0f : 0.0f;
  float slopeX = 0.0f, slopeY = 0.0f, weightsX = 0.0f, weightsY = 0.0f;
  for (int k = -1; k <= 1; ++k) {
    const float at = float(k), weight = k == 0 ? 2.0f : 1.0f;
    if (k == 0 || (k < 0 ? top : bottom) > 0.0f) {
      slopeX += weight * (heightAt(o, p.x + right * dx, p.y + at * dy) - heightAt(o, p.x - left * dx, p.y + at * dy));
      weightsX += weight;
    }
    if (k == 0 || (k < 0 ? left : right) > 0.0f) {
      slopeY += weight * (heightAt(o, p.x + at * dx, p.y + bottom * dy) - heightAt(o, p.x + at * dx, p.y - top * dy));
      weightsY += weight;
    }
  }
  const float scale = o.values[0].x;
  const float height = scale * sqrt(dx * dy) * heightAt(o, p.x, p.y);
  const vec3 normal = normalize(vec3(-scale * 2.0f * slopeX / (weightsX * max(left + right, 1.0f)),
                                     -scale * 2.0f * slopeY / (weightsY * max(top + bottom, 1.0f)), 1.0f));
  vec3 toLight = vec3(o.values[2]);
  vec3 color = vec3(o.values[1]);
  if (o.mode != 0u) {
    toLight = toLight - vec3(p.x, p.y, height);
    toLight = toLight / max(sqrt(dot(toLight, toLight)), 1e-20f);
  }
  if (o.mode == 2u) {
    vec3 axis = vec3(o.values[3]) - vec3(o.values[2]);
    axis = axis / max(sqrt(dot(axis, axis)), 1e-20f);
    const float along = -dot(toLight, axis);
    color = along <= 0.0f || along < o.values[3].w ? vec3(0.0f) : color * pow(along, o.values[2].w);
  }
  if (o.values[0].w == 0.0f) {
    const vec3 diffuse = clamp(color * (o.values[0].y * max(dot(normal, toLight), 0.0f)), vec3(0.0f), vec3(1.0f));
    return vec4(diffuse, 1.0f);
  }
  vec3 halfway = toLight + vec3(0.0f, 0.0f, 1.0f);
  halfway = halfway / max(sqrt(dot(halfway, halfway)), 1e-20f);
  const float shine = max(dot(normal, halfway), 0.0f);
  const vec3 specular =
      clamp(color * (o.values[0].y * (shine > 0.0f ? pow(shine, o.values[0].z) : 0.0f)), vec3(0.0f), vec3(1.0f));
  return vec4(specular, max(max(specular.x, specular.y), specular.z));
}
#endif
