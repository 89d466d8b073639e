#version 460
// For software devices, which pay dearly for barriers: the paths that touch each tile, front to back, as lists.
//
// An invocation owns a row of tiles of a bin. A tile's list ends at the first path that is opaque and covers all of it.
// Tiles without edges, gradients, images and groups get their colour here; the others are listed for the passes that
// paint pixels, and those whose list is full are crowded: they are painted from the bins. A clip counts only in tiles
// where it has an edge.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
layout(local_size_x = 64) in;
#include "lists.glsl"
// lavapipe ends all loops of a shader after 65 535 turns, of which invocations that run together (8) take as many as
// all of them where they differ. Tiles of rows that would take more are crowded.
const uint kMaxSteps = 6000;

uint bitsFrom(int bit) { return bit <= 0 ? ~0u : (bit >= 32 ? 0u : ~0u << uint(bit)); }

void main() {
  const uint perBin = 1u << header.binShift; // at most 32
  const uint bin = gl_GlobalInvocationID.x / perBin, row = gl_GlobalInvocationID.x % perBin;
  if (bin >= header.binCount) return;
  const uint tileY = bin / header.binsX * perBin + row, left = bin % header.binsX * perBin;
  if (tileY >= header.tilesY) return;
  const uint width = min(perBin, header.tilesX - left), firstTile = tileY * header.tilesX + left;
  for (uint t = 0; t < width; ++t) bins[listOf(firstTile + t)] = 0;
  const uint cutPath = counters.cutPath, room = listRoom();
  const bool split = (header.flags & kSplitRich) != 0;
  uint open = (1u << width) - 1, full = 0, painted = 0, rich = 0, steps = 0;
  for (uint word = header.pathWords; word > 0 && open != 0; --word) {
    ++steps;
    for (uint bits = bins[bitsOf(bin) + word - 1]; bits != 0 && open != 0;) {
      if (++steps > kMaxSteps) {
        full |= open;
        open = 0;
      }
      const uint bit = findMSB(bits), path = (word - 1) * 32 + bit;
      bits ^= 1u << bit;
      if (path >= cutPath) continue;
      const uint pathLeft = paths[path].left, pathTop = paths[path].top, pathRight = paths[path].right;
      if (tileY < pathTop || tileY >= paths[path].bottom) continue;
      const int begin = int(left) - int(pathLeft), inRow = int(pathRight - pathLeft + 31) / 32;
      const uint firstWord = paths[path].firstWord + (tileY - pathTop) * uint(inRow);
      const int at = begin >> 5;
      const uint shift = uint(begin) & 31;
      const uint box = bitsFrom(-begin) & ~bitsFrom(int(pathRight) - int(left)) & open;
      TileWord a, b;
      a.edges = a.inside = a.firstEntry = b.edges = b.inside = b.firstEntry = 0;
      if (at >= 0 && at < inRow) a = words[firstWord + uint(at)];
      if (shift != 0 && at + 1 >= 0 && at + 1 < inRow) b = words[firstWord + uint(at + 1)];
      uint edges = a.edges >> shift, inside = a.inside >> shift;
      if (shift != 0) {
        edges |= b.edges << (32 - shift);
        inside |= b.inside << (32 - shift);
      }
      edges &= box;
      inside &= box;
      // Pixel by pixel; in records that are not split, the one shader knows groups, too.
      const bool painting = paths[path].paint != 0 || (!split && paths[path].group != 0);
      uint special = 0; // for the general shader
      if (split && (painting || paths[path].group != 0)) {
        for (uint touched = edges | inside; touched != 0; ++steps) {
          const uint t = findLSB(touched), mask = 1u << t;
          touched ^= mask;
          const uint what = groupIn(paths[path], uvec2(left + t, tileY), steps);
          if (what == kRich) special |= mask;
          if (what == kHidden) {
            edges &= ~mask;
            inside &= ~mask;
          }
        }
      }
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
        const uint list = listOf(firstTile + t), count = bins[list];
        if (count < room) {
          bins[list] = count + 1;
          bins[list + 1 + count * 2] = code;
          bins[list + 2 + count * 2] = path;
        } else {
          full |= mask;
          open &= ~mask;
        }
      }
      painted |= painting ? edges | inside : edges;
      rich |= special;
      if (!painting && paths[path].color.a >= 1.0) open &= ~(inside & ~edges & ~special);
    }
  }
  for (uint t = 0; t < width; ++t) {
    const uint tile = firstTile + t, list = listOf(tile), mask = 1u << t;
    if ((full & mask) != 0) {
      // The paths that did not fit may be of any kind.
      if (split) bins[richTile(crowdedTiles(), another(kRichCrowdedArguments))] = tile;
      else bins[crowdedTiles() + another(kCrowdedArguments)] = tile;
    } else if ((rich & mask) != 0) {
      bins[richTile(paintedTiles(), another(kRichArguments))] = tile;
    } else if ((painted & mask) != 0) {
      bins[paintedTiles() + another(kPaintedArguments)] = tile;
    } else {
      vec4 sum = vec4(0);
      float through = 1.0;
      const uint count = bins[list];
      for (uint k = 0; k < count; ++k) {
        const vec4 color = paths[bins[list + 2 + k * 2]].color;
        sum += color * through;
        through *= 1.0 - color.a;
      }
      sum += header.background * through;
      bins[list] = floatBitsToUint(sum.x);
      bins[list + 1] = floatBitsToUint(sum.y);
      bins[list + 2] = floatBitsToUint(sum.z);
      bins[list + 3] = floatBitsToUint(sum.w);
    }
  }
}
