#version 460
// For software devices, after fill_pieces.comp: what lies left of each tile changes sides in its first pixels.
//
// Eight invocations have a row of a path's tiles, each of them a row of pixels. What lies left follows from what lies
// in the tiles before; left of a tile whose neighbour has no edges all rows agree with what the tile's word says.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#include "vector/software/pieces.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = kBindEntries, std430) buffer Entries { uint entries[]; };
layout(set = 0, binding = kBindEntries, std430) buffer EntryVectors { uvec4 entryVectors[]; };

void main() {
  const uint y = gl_LocalInvocationIndex % 8, all = (1u << header.samples) - 1, cutPath = counters.cutPath;
  const uint rowCount = listed(counters.rows) ? counters.cleared : 0;
  for (uint i = gl_WorkGroupID.x * 8 + gl_LocalInvocationIndex / 8; i < rowCount; i += gl_NumWorkGroups.x * 8) {
    const uvec4 row = pathRows[i];
    if (row.y >= cutPath) continue;
    const uvec4 box = pathVectors[row.y * 3];
    const uint inRow = (box.z - box.x + 31) / 32;
    bool joined = box.x == 0; // the tile before has edges, or lies left of the canvas
    uint carry = 0;           // what is inside there
    for (uint w = 0; w < inRow; ++w) {
      const TileWord word = fetchTileWord(row.x + w);
      uint at = word.firstEntry * (kEntryWords / 4) + y * 2;
      for (uint rest = word.edges; rest != 0; at += kEntryWords / 4) {
        const uint tile = findLSB(rest), mask = 1u << tile;
        rest ^= mask;
        const uint inside = (word.inside & mask) != 0 ? all : 0;
        const bool known = tile == 0 ? joined : (word.edges & mask >> 1) != 0;
        const uint turned = known ? carry ^ inside : 0;
        const uvec4 a = entryVectors[at], b = entryVectors[at + 1], both = a ^ b;
        if (turned != 0) entries[at * 4] = a.x ^ turned;
        carry = ((both.x ^ both.y ^ both.z ^ both.w) & 0xffffu) ^ turned ^ inside;
      }
      joined = word.edges >> 31 != 0;
    }
  }
}
