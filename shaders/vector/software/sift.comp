#version 460
// For software devices, which pay dearly for barriers: the paths that touch each tile, front to back, as lists.
//
// An invocation owns a row of tiles of a bin. A tile's list ends at the first path that is opaque and covers all of it.
// Tiles without edges, gradients, images and groups get their colour here; the others are listed for the passes that
// paint pixels, those of opaque colours alone for one of their own, and those whose list is full are crowded: they are
// painted from the bins. A clip counts only in tiles where it has an edge. SPLIT: those with the general shader.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
layout(local_size_x = 64) in;
#include "vector/shared/loops_ended.glsl"
#include "vector/shared/lists.glsl"
#include "vector/shared/color.h"
// Tiles of rows that would take more are crowded. Invocations that run together, up to 16, take as many turns as all of
// them where they differ (core/turns.h).
const uint kMaxSteps = 3900;
const uint kMaxWords = 16384; // of the bin, that are looked through

uint bitsFrom(int bit) { return bit <= 0 ? ~0u : (bit >= 32 ? 0u : ~0u << uint(bit)); }

uint byRows(uint count) { // as many tiles that are painted by rows: the first one
  uint place = 0;
  if (count != 0) {
    place = atomicAdd(counters.listed, count);
    const uint groups = (place + count + 7) / 8;
    atomicMax(counters.tilesX, min(groups, 32768));
    atomicMax(counters.tilesY, (groups - 1) / 32768 + 1);
    counters.tilesZ = 1;
  }
  return place;
}

void main() {
  const uint perBin = 1u << header.binShift; // at most 32
  const uint i = spreadIndex() * 64 + gl_LocalInvocationID.x, bin = i / perBin, row = i % perBin;
  if (bin >= header.binCount) return;
  const uint tileY = bin / header.binsX * perBin + row, left = bin % header.binsX * perBin;
  if (tileY >= header.tilesY) return;
  const uint width = min(perBin, header.tilesX - left), firstTile = tileY * header.tilesX + left;
  const uint lists = listOf(firstTile), listWords = header.listWords, bits = bitsOf(bin);
  for (uint t = 0; t < width; ++t) bins[lists + t * listWords] = 0;
  const uint cutPath = counters.cutPath, room = listRoom();
  uint drawn = 0;
  for (uint t = 0; t < width; ++t) drawn |= damaged(uvec2(left + t, tileY)) ? 1u << t : 0;
  uint open = drawn, full = 0, painted = 0, soft = 0, rich = 0, steps = 0;
  for (uint word = header.pathWords; word > 0 && open != 0; --word) {
    ++steps;
    if (header.pathWords - word >= kMaxWords) {
      full |= open;
      break;
    }
    for (uint rest = bins[bits + word - 1]; rest != 0 && open != 0;) {
      if (++steps > kMaxSteps) {
        full |= open;
        open = 0;
      }
      const uint bit = findMSB(rest), path = (word - 1) * 32 + bit;
      rest ^= 1u << bit;
      if (path >= cutPath) continue;
      const PlacedPath p = fetchPath(path);
      if (tileY < p.top || tileY >= p.bottom) continue;
      const int begin = int(left) - int(p.left), inRow = int(p.right - p.left + 31) / 32;
      const uint firstWord = p.firstWord + (tileY - p.top) * uint(inRow);
      const int at = begin >> 5;
      const uint shift = uint(begin) & 31;
      const uint box = bitsFrom(-begin) & ~bitsFrom(int(p.right) - int(left)) & open;
      TileWord a = TileWord(0, 0, 0, 0), b = a;
      if (at >= 0 && at < inRow) a = fetchTileWord(firstWord + uint(at));
      if (shift != 0 && at + 1 >= 0 && at + 1 < inRow) b = fetchTileWord(firstWord + uint(at + 1));
      uint edges = a.edges >> shift, inside = a.inside >> shift;
      if (shift != 0) {
        edges |= b.edges << (32 - shift);
        inside |= b.inside << (32 - shift);
      }
      edges &= box;
      inside &= box;
      // Pixel by pixel; in recordings that are not split, the one shader knows groups, too.
#if SPLIT
      const bool painting = p.paint != 0;
      uint special = 0; // for the general shader
      if ((p.paint | p.group) != 0) {
        for (uint touched = edges | inside; touched != 0; ++steps) {
          const uint t = findLSB(touched), mask = 1u << t;
          touched ^= mask;
          const uint what = groupIn(p, uvec2(left + t, tileY), steps);
          if (what == kRich) special |= mask;
          if (what == kHidden) {
            edges &= ~mask;
            inside &= ~mask;
          }
        }
      }
#else
      const bool painting = (p.paint | p.group) != 0;
      const uint special = 0;
#endif
      for (uint touched = edges | inside; touched != 0; ++steps) {
        const uint t = findLSB(touched), mask = 1u << t;
        touched ^= mask;
        uint code = 1;
        if ((edges & mask) != 0) {
          const uint place = t + shift; // from the first word on
          const uint before = (1u << (place & 31)) - 1;
          const uint entry = place < 32 ? a.firstEntry + bitCount(a.edges & before)
                                        : b.firstEntry + bitCount(b.edges & before);
          code = entry * 4 + 2 + ((inside & mask) != 0 ? 1 : 0);
        }
        const uint list = lists + t * listWords, count = bins[list];
        if (count < room) {
          bins[list] = count + 1;
          binPairs[list / 2 + 1 + count] = uvec2(code, path);
        } else {
          full |= mask;
          open &= ~mask;
        }
      }
      painted |= painting ? edges | inside : edges;
      if (painting || p.color.a != 1.0) soft |= edges | inside;
      rich |= special;
      if (!painting && p.color.a >= 1.0) open &= ~(inside & ~edges & ~special);
    }
  }
  rich &= ~full;
  painted &= ~(full | rich);
  const uint opaque = painted & ~soft, pixels = painted & soft;
  // The paths that did not fit may be of any kind.
#if SPLIT
  uint nextFull = several(kRichCrowdedArguments, bitCount(full)), nextRich = several(kRichArguments, bitCount(rich));
#else
  uint nextFull = several(kCrowdedArguments, bitCount(full));
#endif
  uint nextPixels = several(kPaintedArguments, bitCount(pixels)), nextOpaque = byRows(bitCount(opaque));
  const uint paintedList = paintedTiles(), crowdedList = crowdedTiles(), rowList = rowTiles();
  for (uint t = 0; t < width; ++t) {
    const uint tile = firstTile + t, list = lists + t * listWords, mask = 1u << t;
    if ((drawn & mask) == 0) continue;
    if ((full & mask) != 0) {
#if SPLIT
      bins[richTile(crowdedList, nextFull++)] = tile;
    } else if ((rich & mask) != 0) {
      bins[richTile(paintedList, nextRich++)] = tile;
#else
      bins[crowdedList + nextFull++] = tile;
#endif
    } else if ((pixels & mask) != 0) {
      bins[paintedList + nextPixels++] = tile;
    } else if ((opaque & mask) != 0) {
      bins[rowList + nextOpaque++] = tile;
    } else {
      vec4 sum = vec4(0);
      float through = 1.0;
      const uint count = bins[list];
      for (uint k = 0; k < count; ++k) {
        const vec4 color = uintBitsToFloat(pathVectors[binPairs[list / 2 + 1 + k].y * 3 + 2]);
        sum += color * through;
        through *= 1.0 - color.a;
      }
      bins[list] = kSolidTile;
      sum += header.background * through;
      binVectors[list / 4 + 1] = floatBitsToUint(linearColor(sum, header.flags));
      binVectors[list / 4 + 2] = floatBitsToUint(targetColor(sum, header.flags));
    }
  }
  sayIfEnded();
}
