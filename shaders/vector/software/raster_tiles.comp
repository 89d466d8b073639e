#version 460
// The fine level for software devices: the pixels of tiles from their lists, without barriers.
//
// TILES: 0 the tiles of one colour, an invocation a column of eight pixels; 1 those with edges or gradients that are
// not painted by rows (raster_rows.comp), a workgroup each. The crowded ones, whose lists are full, take raster.comp.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#include "vector/raster/composite.glsl"
#include "vector/shared/lists.glsl"
layout(local_size_x = 64) in;

void paintPath(uint code, uint path, uvec2 at, uvec2 pixel) {
  const PlacedPath p = fetchPath(path);
  const uvec2 group = groupOf(p);
  paintOver(code, fetchEdge(code, at.y, countsArea()), at, pixel, p.color,
            uvec4(p.item, p.paint, group.y, group.x | p.group & kItemGrouped));
}

#if TILES == 0
void main() { // a workgroup has eight tiles of a row
  const uvec2 tile = uvec2(gl_WorkGroupID.x * 8 + gl_LocalInvocationIndex / 8,
                           gl_WorkGroupID.y * gl_NumWorkGroups.z + gl_WorkGroupID.z);
  const uvec2 pixel = tile * kTileSize + uvec2(gl_LocalInvocationIndex % 8, 0);
  const uint list = listOf(tile.y * header.tilesX + tile.x);
  if (tile.x >= header.tilesX || tile.y >= header.tilesY || bins[list] != kSolidTile) return;
  const vec4 color = uintBitsToFloat(binVectors[list / 4 + (TARGET == 0 ? 1 : 2)]);
  for (uint y = 0; y < kTileSize; ++y) storeColor(pixel + uvec2(0, y), color);
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
  for (uint k = 0; k < count && pixelOpen(); ++k) {
    const uvec2 item = binPairs[own / 2 + 1 + k];
    paintPath(item.x, item.y, at, pixel);
  }
  finishPixel();
  storeColor(pixel, storedColor(sum));
}
#endif
