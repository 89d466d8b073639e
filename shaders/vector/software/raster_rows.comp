#version 460
// The fine level for software devices, for tiles of opaque colours alone (sift.comp): an invocation has a row of eight
// pixels, so that a path is looked up once for all of them, and open samples are all there is to keep of the light.
// Paints as paintOver does (composite.glsl).
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#include "vector/raster/composite.glsl"
#include "vector/shared/lists.glsl"
layout(local_size_x = 64) in;

struct Pixel {
  uint alive; // samples that nothing covers yet
  bool first; // no edge so far, and area counts
  float scale, gap;
  vec4 sum;
};

// Without branches, as both sides would be taken: where paintOver does nothing, nothing is added here.
void paint(inout Pixel p, uint mask, int difference, vec4 source) {
  const bool even = (mask == all || mask == 0) && difference == 0, edge = p.first && p.alive != 0 && !even;
  const float hit = float(bitCount(mask & p.alive)) * share; // of an edge, before which nothing is covered, all
  const float area = clamp(hit + float(difference) * share * (1.0 / 256.0), 0.0, 1.0), left = 1.0 - hit;
  const bool fills = mask != 0 || difference > 0; // what is left of the light
  const float weight = edge ? area : hit * p.scale + (fills ? p.gap : 0.0);
  if (edge && left > 0) p.scale = (1.0 - area) / left;
  p.gap = edge ? (left > 0 ? 0.0 : 1.0 - weight) : fills ? 0.0 : p.gap;
  p.first = p.first && !edge;
  p.sum += source * weight;
  p.alive &= ~mask;
}

void main() {
  const uint place = groupIndex() * 8 + gl_LocalInvocationIndex / 8, row = gl_LocalInvocationIndex % 8;
  if (place >= counters.listed) return;
  const uint tile = bins[rowTiles() + place], list = listOf(tile), count = bins[list];
  all = (1u << header.samples) - 1;
  share = 1.0 / float(header.samples);
  Pixel pixels[8];
  for (int x = 0; x < 8; ++x) pixels[x] = Pixel(all, (header.flags & kExactArea) != 0, 1.0, 0.0, vec4(0));
  bool open = true;
  for (uint k = 0; k < count && open; ++k) {
    const uvec2 item = binPairs[list / 2 + 1 + k];
    const Edge edge = fetchEdge(item.x, row, true); // areas are 0 where they do not count
    const vec4 color = uintBitsToFloat(pathVectors[item.y * 3 + 2]);
    uint inside = (item.x & 1) != 0 ? all : 0;
    open = false;
#define PAINT(x, word)                                                                                                 \
  inside ^= word & 0xffffu;                                                                                            \
  paint(pixels[x], inside, int(word) >> 16, color);                                                                    \
  open = open || pixels[x].alive != 0 || pixels[x].gap > 0;
    PAINT(0, edge.left.x)
    PAINT(1, edge.left.y)
    PAINT(2, edge.left.z)
    PAINT(3, edge.left.w)
    PAINT(4, edge.right.x)
    PAINT(5, edge.right.y)
    PAINT(6, edge.right.z)
    PAINT(7, edge.right.w)
  }
  const uvec2 pixel = uvec2(tile % header.tilesX, tile / header.tilesX) * kTileSize + uvec2(0, row);
  for (int x = 0; x < 8; ++x) {
    const float light = float(bitCount(pixels[x].alive)) * share * pixels[x].scale + pixels[x].gap;
    storeColor(pixel + uvec2(x, 0), storedColor(pixels[x].sum + header.background * light));
  }
}
