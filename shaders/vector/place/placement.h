// How an item gets its place: a source's map after a move and a scale of its own.
//
// A glyph is placed in the units of its text, whose transform and perspective then apply; a drawing at 0, 0 in its own
// size, which changes no bit of its map and, but for the sign of 0, none of its inverse.
#ifndef GPGP_SHADERS_VECTOR_PLACEMENT_H
#define GPGP_SHADERS_VECTOR_PLACEMENT_H
#include "vector/shared/layout.h"

GPGP_SHADER_BEGIN

GPGP_FN ItemRecord placed(ItemRecord source, PlacementRecord p) {
  ItemRecord item = source;
  const vec4 t = source.transform;
  GPGP_PRECISE float a = t.x * p.size;
  GPGP_PRECISE float b = t.y * p.size;
  GPGP_PRECISE float c = t.z * p.size;
  GPGP_PRECISE float d = t.w * p.size;
  GPGP_PRECISE float e = source.offsets.z + (t.x * p.x + t.z * p.y);
  GPGP_PRECISE float f = source.offsets.w + (t.y * p.x + t.w * p.y);
  item.transform = vec4(a, b, c, d);
  const vec4 w = source.perspective, i = source.inverse, eye = source.eye;
  const float nearest = w.w > 0.0f ? eye.z : 1.0f, unit = p.size > 0.0f ? 1.0f / p.size : 0.0f;
  item.inverse = vec4((i.x - p.x * eye.x) * unit, (i.y - p.y * eye.x) * unit, (i.z - p.x * eye.y) * unit,
                      (i.w - p.y * eye.y) * unit);
  item.offsets = vec4((source.offsets.x - p.x * nearest) * unit, (source.offsets.y - p.y * nearest) * unit, e, f);
  GPGP_PRECISE float wx = w.x * p.size;
  GPGP_PRECISE float wy = w.y * p.size;
  GPGP_PRECISE float wz = w.z + (w.x * p.x + w.y * p.y);
  item.perspective = vec4(wx, wy, wz, w.w);
  item.color = vec4(p.color.x, p.color.y, p.color.z, p.color.w * source.color.w);
  item.slot = (p.source >> kSlotBit) & ((1u << (kSmallGlyphBit - kSlotBit)) - 1u);
  item.smallGlyph = p.source >> kSmallGlyphBit;
  item.firstSegment = p.firstSegment;
  item.firstPath = p.firstPath;
  item.segments = p.segments;
  item.paths = p.paths;
  return item;
}

GPGP_SHADER_END
#endif
