#version 460
// The fine level: the paths of four tiles, front to back, over the samples of their pixels.
//
// A workgroup owns a square of 16 pixels, four tiles, a thread a pixel. The bin's paths are sifted, 256 at a time, for
// those that touch the square; they wait in shared memory in painting order. Squares that need
// the general shader are left to it, in a list (kSplitRich).
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
#include "composite.glsl"
#include "lists.glsl"
layout(local_size_x = 256) in;
const uint kRoom = 256;
shared uint counts[kRoom], groupCounts[16], candidates[kRoom];
shared uvec4 coverage[kRoom]; // of each tile: 0 none, 1 all, 2: entry * 4 + 2 + inside
shared vec4 colors[kRoom];
#if PAINTS
#if RICH
shared uvec3 paints[kRoom]; // item, paint, group
#else
shared uvec2 paints[kRoom]; // item, paint
#endif
#endif
shared uint touching[2][kRoom / 32]; // of the 256 paths at hand, in turn
shared uint open[2];
#define SPLIT (PAINTS && !RICH) // records that need the general shader as well take the one for gradients
#if SPLIT
shared bool rich; // this square is not for this shader
#endif

void main() {
  const uint lane = gl_LocalInvocationIndex, quarter = lane / 64;
  const uvec2 inTile = uvec2(lane % 8, lane / 8 % 8);
#if RICH && !IMAGES
  if (groupIndex() >= bins[kRichArguments + 3]) return;
  const uint square = bins[richSquares() + groupIndex()];
  const uint squaresX = (header.tilesX + 1) / 2;
  const uvec2 firstTile = uvec2(square % squaresX, square / squaresX) * 2;
#else
  const uvec2 firstTile = gl_WorkGroupID.xy * 2;
#if SPLIT
  if (lane == 0) rich = false;
#endif
#endif
  const uvec2 pixel = (firstTile + uvec2(quarter & 1, quarter >> 1)) * kTileSize + inTile;
  const uint bin = binOf(firstTile), cutPath = counters.cutPath;

  beginPixel();
  if (lane < kRoom / 32) touching[0][lane] = 0;
  if (lane == kRoom / 32) open[0] = 0;
  bool done = false;
  uint turn = 0;
  const uint listed = bins[bin - 1]; // 1 + paths
  for (uint wordEnd = listed != 0 ? 1 : header.pathWords; wordEnd > 0 && !done; wordEnd -= min(wordEnd, 256)) {
    uint word = 0, found = 0, before = 0, total = listed - 1;
    if (listed == 0) {
      // Each lane has one word of the bin, the foremost paths first, and learns how many paths lie before its own.
      word = wordEnd - 1 - min(lane, wordEnd - 1);
      found = lane < wordEnd ? bins[bin + word] : 0;
      counts[lane] = bitCount(found);
      barrier();
      if (lane < 16) {
        uint group = 0;
        for (uint k = 0; k < 16; ++k) group += counts[lane * 16 + k];
        groupCounts[lane] = group;
      }
      for (uint k = lane & ~15u; k < lane; ++k) before += counts[k];
      barrier();
      total = 0;
      for (uint k = 0; k < 16; ++k) {
        if (k < lane / 16) before += groupCounts[k];
        total += groupCounts[k];
      }
    }
    for (uint base = 0; base < total && !done; base += kRoom) {
      if (before < base + kRoom && before + bitCount(found) > base) {
        uint place = before;
        for (uint bits = found; bits != 0; ++place) {
          const uint bit = findMSB(bits);
          bits ^= 1u << bit;
          if (place >= base && place < base + kRoom) candidates[place - base] = word * 32 + bit;
        }
      }
      barrier();
      uint path = ~0u;
      if (lane < total - base) path = listed != 0 ? bins[bin + header.binWords - 2 - base - lane] : candidates[lane];
      uvec4 own = uvec4(0);
      PlacedPath p;
      if (path < cutPath) {
        p = paths[path];
        if (p.left < firstTile.x + 2 && p.right > firstTile.x && p.top < firstTile.y + 2 && p.bottom > firstTile.y)
          for (uint q = 0; q < 4; ++q) {
            const uvec2 tile = firstTile + uvec2(q & 1, q >> 1);
            own[q] = coverageOf(p, tile);
#if SPLIT
            if (own[q] == 0 || (p.group | p.paint) == 0 || (header.flags & kSplitRich) == 0) continue;
            uint steps = 0;
            const uint what = groupIn(p, tile, steps);
            if (what == kHidden) own[q] = 0;
            if (what == kRich) rich = true;
#endif
          }
      }
      const bool touches = (own.x | own.y | own.z | own.w) != 0;
      if (touches) atomicOr(touching[turn][lane / 32], 1u << (lane & 31));
#if SPLIT
      barrier();
      if (rich) {
        if (lane == 0)
          bins[richSquares() + another(kRichArguments)] = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
        return;
      }
#else
      barrier();
#endif
      uint count = 0, place = 0;
      for (uint k = 0; k < kRoom / 32; ++k) {
        if (k == lane / 32) place = count + bitCount(touching[turn][k] & ((1u << (lane & 31)) - 1));
        count += bitCount(touching[turn][k]);
      }
      if (touches) {
        coverage[place] = own;
        colors[place] = p.color;
#if PAINTS
#if RICH
        paints[place] = uvec3(p.item, p.paint, p.group);
#else
        paints[place] = uvec2(p.item, p.paint);
#endif
#endif
      }
      if (lane < kRoom / 32) touching[turn ^ 1][lane] = 0;
      if (lane == kRoom / 32) open[turn ^ 1] = 0;
      barrier();
      for (uint e = 0; e < count && pixelOpen(); ++e) {
        const uint code = coverage[e][quarter];
        if (code == 0) continue;
        const Edge edge = fetchEdge(code, inTile.y, countsArea());
#if RICH
        paintOver(code, edge, inTile, pixel, colors[e], paints[e]);
#elif PAINTS
        paintOver(code, edge, inTile, pixel, colors[e], uvec3(paints[e], 0));
#else
        paintOver(code, edge, inTile, pixel, colors[e], uvec3(0));
#endif
      }
      if (base + kRoom >= total && wordEnd <= 256) break;
      if (pixelOpen()) open[turn] = 1;
      barrier();
      done = open[turn] == 0;
      turn ^= 1;
    }
  }
  writePixel(pixel);
}
