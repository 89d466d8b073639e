#version 460
// Which tiles take the general shader: those where what it alone knows (lists.glsl) shows in front of all that is
// opaque.
//
// Beside fill, as tile words say enough, so that the passes that paint tiles of either kind run beside each other. A
// workgroup has 4 x 4 tiles, which are of one bin, and each of them 16 invocations. Which paths are in front is what
// their numbers say, so they are looked at in any order.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#include "vector/shared/lists.glsl"
const uint kSide = 1u << kMinBinShift, kEach = 16;
layout(local_size_x = kSide * kSide * kEach) in;
// Of each tile, 1 + the number of a path: the foremost one for the general shader; the foremost one that is opaque and
// everywhere in the tile.
shared uint rich[kSide * kSide], opaque[kSide * kSide];
shared uint decided; // tiles

void look(uint path, uvec2 tile, uint k) {
  if (path >= counters.cutPath) return;
  const PlacedPath p = paths[path];
  uint steps = 0;
  if ((p.group | p.paint) == 0) {
    if (p.color.a >= 1.0 && coverageOf(p, tile) == 1) atomicMax(opaque[k], path + 1);
  } else if (coverageOf(p, tile) != 0 && groupIn(p, tile, steps) == kRich) {
    atomicMax(rich[k], path + 1);
  }
}

void main() {
  const uint lane = gl_LocalInvocationIndex, k = lane / kEach, own = lane % kEach;
  const uvec2 tile = gl_WorkGroupID.xy * kSide + uvec2(k % kSide, k / kSide);
  const bool inside = tile.x < header.tilesX && tile.y < header.tilesY;
  const uint place = tileKinds() + tile.y * header.tilesX + tile.x;
  const uint bits = bitsOf(binOf(gl_WorkGroupID.xy * kSide));
  if (bins[bits - kBinHead + kBinGrouped] == 0) {
    if (own == 0 && inside) bins[place] = kEven;
    return;
  }
  if (own == 0) rich[k] = opaque[k] = 0;
  if (lane == 0) decided = 0;
  barrier();
  const uint listed = bins[bits - kBinHead], list = bins[bits - kBinHead + 1];
  bool found = false;
  for (uint base = 0; base + 1 < listed && decided < kSide * kSide; base += kEach) { // the foremost first
    if (!found && own < listed - 1 - base) look(bins[list + base + own], tile, k);
    barrier();
    if (!found && (rich[k] | opaque[k]) != 0) {
      found = true;
      if (own == 0) atomicAdd(decided, 1);
    }
    barrier();
  }
  for (uint word = own; listed == 0 && word < header.pathWords; word += kEach)
    for (uint rest = bins[bits + word]; rest != 0; rest &= rest - 1) look(word * 32 + findLSB(rest), tile, k);
  barrier();
  if (own != 0 || !inside) return;
  const bool general = rich[k] > opaque[k] && damaged(tile);
  bins[place] = general ? kRich : kEven;
  if (general) bins[richTiles() + another(kRichArguments)] = tile.y * header.tilesX + tile.x;
}
