#version 460
// The upper level: which paths that paint may touch each bin of tiles, as bits.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
layout(local_size_x = 64) in;

void main() {
  const uint i = groupIndex() * 64 + gl_LocalInvocationID.x;
  if (i < kFirstBin) bins[i] = i % 4 == 2 ? 1 : 0;
  if (i >= header.binCount * header.pathWords) return;
  const uint perBin = kBinSize / kTileSize;
  const uint word = i / header.binCount, bin = i % header.binCount;
  const uint left = bin % header.binsX * perBin, top = bin / header.binsX * perBin;
  uint mask = 0;
  const uint end = min(counters.cutPath - min(counters.cutPath, word * 32), 32);
  for (uint bit = 0; bit < end; ++bit) {
    const PlacedPath p = paths[word * 32 + bit];
    const bool touches = p.left < left + perBin && p.right > left && p.top < top + perBin && p.bottom > top;
    if (touches && p.color.a > 0) mask |= 1u << bit;
  }
  bins[kFirstBin + bin * header.pathWords + word] = mask;
}
