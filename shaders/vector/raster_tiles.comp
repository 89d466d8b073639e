#version 460
// The fine level for software devices: the pixels of tiles from their lists, without barriers.
//
// TILES: 0 every tile's colour, as if it had no edges, an invocation a row of eight pixels; 1 the tiles with edges or
// gradients, a workgroup each. The crowded ones, whose lists are full, take raster.comp.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
#include "composite.glsl"
#include "lists.glsl"
layout(local_size_x = 64) in;

void paintPath(uint code, uint path, uvec2 at, uvec2 pixel) {
  const PlacedPath p = paths[path];
  const uvec2 group = groupOf(p);
  paintOver(code, fetchEdge(code, at.y, countsArea()), at, pixel, p.color,
            uvec4(p.item, p.paint, group.y, group.x | p.group & kItemGrouped));
}

#if TILES == 0
void main() {
  const uint tile = groupIndex() * 8 + gl_LocalInvocationIndex / 8, row = gl_LocalInvocationIndex % 8;
  if (tile >= header.tilesX * header.tilesY) return;
  const uint list = listOf(tile);
  sum = vec4(uintBitsToFloat(bins[list]), uintBitsToFloat(bins[list + 1]), uintBitsToFloat(bins[list + 2]),
             uintBitsToFloat(bins[list + 3]));
  const uvec2 pixel = uvec2(tile % header.tilesX, tile / header.tilesX) * kTileSize + uvec2(0, row);
  const vec4 linear = linearColor(sum), target = targetColor(sum);
  for (uint x = 0; x < kTileSize; ++x) storePixel(pixel + uvec2(x, 0), linear, target);
}
#else
void main() {
  const uint lane = gl_LocalInvocationIndex;
#if RICH
  if (groupIndex() >= bins[kRichArguments + 3]) return;
  const uint tile = bins[richTile(paintedTiles(), groupIndex())];
#else
  if (groupIndex() >= bins[kPaintedArguments + 3]) return;
  const uint tile = bins[paintedTiles() + groupIndex()];
#endif
  const uvec2 at = uvec2(lane % 8, lane / 8), place = uvec2(tile % header.tilesX, tile / header.tilesX);
  const uvec2 pixel = place * kTileSize + at;
  beginPixel();
  const uint own = listOf(tile);
  const uint count = bins[own];
  for (uint k = 0; k < count && pixelOpen(); ++k) paintPath(bins[own + 1 + k * 2], bins[own + 2 + k * 2], at, pixel);
  finishPixel();
  storePixel(pixel, sum);
}
#endif
