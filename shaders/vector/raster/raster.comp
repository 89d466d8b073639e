#version 460
// The fine level: the paths of a tile, front to back, over the samples of its pixels.
//
// A workgroup owns a tile, an invocation a pixel. The bin's paths are sifted, as many at a time, for those that touch
// the tile; they wait in shared memory in painting order. Tiles that need the general shader are left to it
// (split.comp). CROWDED: software devices' tiles whose own lists are full (sift.comp). ASIDE: other devices' general
// shader puts pixels aside, so that its tiles are painted beside the others; KEPT: it puts them where they belong, and
// paints tiles for which there was no room.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#include "vector/raster/composite.glsl"
#include "vector/shared/lists.glsl"
#if CROWDED
#include "vector/shared/loops_ended.glsl"
#endif
const uint kRoom = kTileSize * kTileSize;
layout(local_size_x = kRoom) in;
#include "vector/shared/scan.glsl"
shared uint candidates[kRoom];
shared uint coverage[kRoom]; // 1 all, 2: entry * 4 + 2 + inside
shared vec4 colors[kRoom];
#if PAINTS
#if RICH
shared uvec4 paints[kRoom]; // item, paint, layer, clip (paintOver)
#else
shared uvec2 paints[kRoom]; // item, paint
#endif
#endif
#if ASIDE || KEPT
layout(set = 0, binding = kBindAside, std430) buffer Aside { vec4 aside[]; };
#endif
shared uint touching[2][kRoom / 32]; // of the paths at hand, in turn
shared uint open[2];
#define SPLIT (PAINTS && !RICH && !CROWDED) // those with the general shader as well take the one for gradients

void main() {
  const uint lane = gl_LocalInvocationIndex;
  const uvec2 inTile = uvec2(lane % kTileSize, lane / kTileSize);
#if CROWDED
#if RICH
  if (groupIndex() >= bins[kRichCrowdedArguments + 3]) return;
  const uint place = bins[richTile(crowdedTiles(), groupIndex())];
#else
  if (groupIndex() >= bins[kCrowdedArguments + 3]) return;
  const uint place = bins[crowdedTiles() + groupIndex()];
#endif
  const uvec2 tile = uvec2(place % header.tilesX, place / header.tilesX);
#elif RICH
  if (groupIndex() >= bins[kRichArguments + 3]) return;
  const uint place = bins[richTiles() + groupIndex()];
  const uvec2 tile = uvec2(place % header.tilesX, place / header.tilesX);
#if ASIDE
  if (groupIndex() >= kTilesAside) return;
#elif KEPT
  if (groupIndex() < kTilesAside) {
    storePixel(tile * kTileSize + inTile, aside[groupIndex() * kRoom + lane]);
    return;
  }
#endif
#else
  const uvec2 tile = gl_WorkGroupID.xy;
  if (!damaged(tile)) return;
#if SPLIT
  const bool split = (header.flags & kSplitRich) != 0;
  if (split && bins[tileKinds() + tile.y * header.tilesX + tile.x] == kRich) return;
#endif
#endif
  const uvec2 pixel = tile * kTileSize + inTile;
  const uint bits = bitsOf(binOf(tile)), cutPath = counters.cutPath;

  beginPixel();
  if (lane < kRoom / 32) touching[0][lane] = 0;
  if (lane == kRoom / 32) open[0] = 0;
  bool done = false;
  uint turn = 0;
  const uint listed = bins[bits - kBinHead], list = bins[bits - kBinHead + 1];
  for (uint wordEnd = listed != 0 ? 1 : header.pathWords; wordEnd > 0 && !done; wordEnd -= min(wordEnd, kRoom)) {
    uint word = 0, found = 0, before = 0, total = listed - 1;
    if (listed == 0) {
      // Each lane has one word of the bin, the foremost paths first, and learns how many paths lie before its own.
      word = wordEnd - 1 - min(lane, wordEnd - 1);
      found = lane < wordEnd ? bins[bits + word] : 0;
      before = scan(lane, bitCount(found)) - bitCount(found);
      total = scanTotal();
    }
    for (uint base = 0; base < total && !done; base += kRoom) {
      if (before < base + kRoom && before + bitCount(found) > base) {
        uint place = before;
        for (uint rest = found; rest != 0; ++place) {
          const uint bit = findMSB(rest);
          rest ^= 1u << bit;
          if (place >= base && place < base + kRoom) candidates[place - base] = word * 32 + bit;
        }
      }
      barrier();
      uint path = ~0u, own = 0;
#if RICH
      uvec2 group = uvec2(0);
#endif
      if (lane < total - base) path = listed != 0 ? bins[list + base + lane] : candidates[lane];
      PlacedPath p;
      if (path < cutPath) {
        p = paths[path];
        own = coverageOf(p, tile);
#if RICH
        if (own != 0 && p.group != 0) { // clips that show all of the tile are none
          uint steps = 0;
          const uint shown = (p.group & kItemGrouped) != 0 ? itemClipsIn(p.item, tile, steps) : kEven;
          group = groupOf(p);
          const uint within = clipsIn(p.item, group.x, tile, steps);
          if (shown == kHidden || within == kHidden) own = 0;
          if (within == kEven) group.x = 0;
          if (shown == kRich) group.x |= kItemGrouped;
        }
#endif
#if SPLIT
        uint steps = 0; // what only the general shader knows lies behind something opaque here
        if (own != 0 && (p.group | p.paint) != 0 && split && groupIn(p, tile, steps) != kEven) own = 0;
#endif
      }
      if (own != 0) atomicOr(touching[turn][lane / 32], 1u << (lane & 31));
      barrier();
      uint count = 0, place = 0;
      for (uint k = 0; k < kRoom / 32; ++k) {
        if (k == lane / 32) place = count + bitCount(touching[turn][k] & ((1u << (lane & 31)) - 1));
        count += bitCount(touching[turn][k]);
      }
      if (own != 0) {
        coverage[place] = own;
#if !CROWDED
        if (own > 1 && count > kFewEntries) coverage[place] |= fetchAhead(own);
#endif
        colors[place] = p.color;
#if PAINTS
#if RICH
        paints[place] = uvec4(p.item, p.paint, group.y, group.x);
#else
        paints[place] = uvec2(p.item, p.paint);
#endif
#endif
      }
      if (lane < kRoom / 32) touching[turn ^ 1][lane] = 0;
      if (lane == kRoom / 32) open[turn ^ 1] = 0;
      barrier();
      for (uint e = 0; e < count && pixelOpen(); ++e) {
        const uint code = coverage[e];
        const Edge edge = fetchEdge(code, inTile.y, countsArea());
#if RICH
        paintOver(code, edge, inTile, pixel, colors[e], paints[e]);
#elif PAINTS
        paintOver(code, edge, inTile, pixel, colors[e], uvec4(paints[e], 0, 0));
#else
        paintOver(code, edge, inTile, pixel, colors[e], uvec4(0));
#endif
      }
      if (base + kRoom >= total && wordEnd <= kRoom) break;
      if (pixelOpen()) open[turn] = 1;
      barrier();
      done = open[turn] == 0;
      turn ^= 1;
    }
  }
  finishPixel();
#if CROWDED
  sayIfEnded();
#endif
#if ASIDE
  aside[groupIndex() * kRoom + lane] = sum;
#else
  storePixel(pixel, sum);
#endif
}
