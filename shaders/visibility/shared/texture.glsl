// From triangles of alpha-tested draws to their places on the texture. Needs fetch.glsl.
#include "visibility/shared/texture.h"
layout(std430, set = 0, binding = kBindTextureCoordinates) readonly buffer CoordinateBuffer { uint coordinates[]; };

float coordinateAt(uint byte_) {
  uint word = coordinates[byte_ >> 2u];
  if (params.textureFormat == kFloats) return uintBitsToFloat(word);
  uint number = (word >> ((byte_ & 2u) * 8u)) & 0xffffu;
  return params.textureFormat == kHalves ? halfToFloat(number) : unormToFloat(number);
}

/// 0 where there are none, or none to compute with.
vec2 fetchCoordinates(DrawEntry e, uint index) {
  uint vertex;
  if (!fetchPlace(e, index, vertex) || vertex >= params.textureCount) return vec2(0.0);
  uint at = vertex * params.textureStride + params.textureOffset;
  vec2 place = vec2(coordinateAt(at), coordinateAt(at + (params.textureFormat == kFloats ? 4u : 2u)));
  return isModerate(place.x) && isModerate(place.y) ? place : vec2(0.0);
}

/// Of a triangle of the draw table. origin: a point near it on the screen.
TexturePlane fetchTexturePlane(Fetched f, uint entry, uint local, ivec2 origin) {
  DrawEntry e = entryOf(entry);
  uint index = e.firstIndex + local * 3u;
  return texturePlaneOf(f.a, f.b, f.c, fetchCoordinates(e, index), fetchCoordinates(e, index + 1u),
                        fetchCoordinates(e, index + 2u), origin, gridOf(f.camera));
}

/// Near a triangle that is whole, or else the middle of the viewport.
ivec2 textureOrigin(ScreenTriangle t, uint fate, uint camera) {
  Grid g = gridOf(camera);
  return fate == kWhole ? t.p0 : ivec2(g.pixels.x * 128, g.pixels.y * 128 + g.top * 256);
}
