#version 460
// The fine level of recordings of small glyphs alone: tiles have lists (small_glyphs.comp), in any order.
//
// A workgroup owns a tile, an invocation a pixel. What a list holds is put into painting order, the foremost path
// first. A tile that found no room for all in its list takes them one after another from what all of those left over.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#include "vector/raster/composite.glsl"
#include "vector/shared/lists.glsl"
const uint kLanes = kTileSize * kTileSize;
layout(local_size_x = kLanes) in;
layout(set = 0, binding = kBindBins, std430) readonly buffer BinPairs { uvec2 binPairs[]; };
shared uint found[kTileListPaths];    // paths
shared uint coverage[kTileListPaths]; // foremost first, as are the colours: 1 all, 2: entry * 4 + 2 + inside
shared vec4 colors[kTileListPaths];
shared uint foremost[2], open[2]; // of the path at hand and the next one, in turn; foremost: 1 + path

void main() {
  const uint lane = gl_LocalInvocationIndex;
  const uvec2 inTile = uvec2(lane % kTileSize, lane / kTileSize), tile = gl_WorkGroupID.xy;
  if (!damaged(tile)) return;
  const uvec2 pixel = tile * kTileSize + inTile;
  const uint which = tile.y * header.tilesX + tile.x, list = (kFirstBin + which * kTileListWords) / 2;
  const uint total = binPairs[list].x;
  const bool whole = total <= kTileListPaths;
  beginPixel();
  if (total != 0) {
    if (lane == 0) foremost[0] = open[0] = 0;
    barrier();
    const uvec2 own = lane < kTileListPaths ? binPairs[list + 1 + lane] : uvec2(0); // code, path
    const uint left = whole ? 0 : counters.listed;
    uint count = 1, last = ~0u;
    for (uint turn = 0;; turn ^= 1) {
      if (whole) {
        count = total;
        if (lane < count) found[lane] = own.y;
        barrier();
        if (lane < count) {
          uint place = 0;
          for (uint k = 0; k < count; ++k) place += found[k] > own.y ? 1 : 0;
          coverage[place] = own.x;
          if (own.x > 1 && count > kFewEntries) coverage[place] |= fetchAhead(own.x);
          colors[place] = paths[own.y].color;
        }
      } else {
        uint best = 0, code = 0; // 1 + the foremost path behind the last one
        if (lane < kTileListPaths && own.y < last) {
          best = own.y + 1;
          code = own.x;
        }
        for (uint at = fullTiles() + lane * 3; at < fullTiles() + left * 3; at += kLanes * 3) {
          if (bins[at] != which || bins[at + 2] >= last || bins[at + 2] < best) continue;
          best = bins[at + 2] + 1;
          code = bins[at + 1];
        }
        if (best != 0) atomicMax(foremost[turn], best);
        barrier();
        if (lane == 0) foremost[turn ^ 1] = open[turn ^ 1] = 0;
        if (foremost[turn] == 0) break;
        last = foremost[turn] - 1;
        if (best == last + 1) {
          coverage[0] = code;
          colors[0] = paths[last].color;
        }
      }
      barrier();
      for (uint e = 0; e < count && pixelOpen(); ++e) {
        const uint code = coverage[e];
        paintOver(code, fetchEdge(code, inTile.y, countsArea()), inTile, pixel, colors[e], uvec4(0));
      }
      if (whole) break;
      if (pixelOpen()) open[turn] = 1;
      barrier();
      if (open[turn] == 0) break;
    }
  }
  finishPixel();
  storePixel(pixel, sum);
}
