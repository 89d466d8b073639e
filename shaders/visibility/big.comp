// Candidates of many pixels, in slices: a workgroup looks at 64 blocks of 8 x 8 pixels at a time, and at those that the
// candidate may touch pixel by pixel. Phase 0 enters those that are not seen at any pixel's centre, phase 1 the others.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kPhase = 0u;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/lists.glsl"
#include "visibility/grid.glsl"
#include "visibility/enter.glsl"

shared uint blockCount;
shared ivec2 blockCorner[64];
shared ivec3 blockEdges[64];
shared uint groupPairs;
shared uint firstPair;
shared bool groupSeen;

void main() {
  uint count = min(counters.bigCount, params.maxBig);
  for (uint entry = gl_WorkGroupID.x; entry < count; entry += gl_NumWorkGroups.x) {
    uint index = slots[bigAt(entry)];
    uint place = slots[bigAt(entry) + 1u];
    uint slice = place & 0xfffu;
    uint slices = (place >> 12u) & 0xfffu;
    Candidate c = readCandidate(index);
    if (gl_LocalInvocationIndex == 0u) groupSeen = isSeen(c.id); // one answer for all, should another pass' bit arrive
    barrier();
    bool seen = groupSeen;
    barrier();
    if (seen != (kPhase == 1u)) continue;
    ScreenTriangle t = triangleOf(c);
    bool compact = isCompact(t);
    ivec2 s0 = edgeSlope(t.p1, t.p2);
    ivec2 s1 = edgeSlope(t.p2, t.p0);
    ivec2 s2 = edgeSlope(t.p0, t.p1);
    ivec4 bounds = pixelBounds(t.p0, t.p1, t.p2, gridOf(place >> 24u));
    ivec2 inBlock = ivec2(int(gl_LocalInvocationIndex & 7u), int(gl_LocalInvocationIndex >> 3u));
    uint columns = uint(bounds.z - bounds.x + 7) / 8u;
    uint blocks = columns * (uint(bounds.w - bounds.y + 7) / 8u);
    for (uint first = slice * 64u; first < blocks; first += slices * 64u) {
      if (gl_LocalInvocationIndex == 0u) {
        blockCount = 0u;
        groupPairs = 0u;
      }
      barrier();
      uint block = first + gl_LocalInvocationIndex;
      if (block < blocks) {
        ivec2 corner = bounds.xy + 8 * ivec2(int(block % columns), int(block / columns));
        ivec3 edges = ivec3(innermostBlock(t.p1, s0, corner), innermostBlock(t.p2, s1, corner),
                            innermostBlock(t.p0, s2, corner));
        if (!blockOutside(edges.x, s0, 8) && !blockOutside(edges.y, s1, 8) && !blockOutside(edges.z, s2, 8)) {
          uint place = atomicAdd(blockCount, 1u);
          blockCorner[place] = corner;
          blockEdges[place] = edges;
        }
      }
      barrier();
      uint touched = blockCount;
      ivec3 toPixel = ivec3(s0.x, s1.x, s2.x) * inBlock.x + ivec3(s0.y, s1.y, s2.y) * inBlock.y;
      uvec2 mask = uvec2(0u); // of the blocks in which this invocation's pixel is entered
      for (uint i = 0u; i < touched; ++i) {
        ivec3 edges = blockEdges[i] + toPixel;
        if ((edges.x | edges.y | edges.z) < 0) continue;
        ivec2 pixel = blockCorner[i] + inBlock;
        if (pixel.x >= bounds.z || pixel.y >= bounds.w || !isWanted(t, compact, true, pixel, seen)) continue;
        if (i < 32u) mask.x |= 1u << i;
        else mask.y |= 1u << (i - 32u);
      }
      uint wanted = uint(bitCount(mask.x) + bitCount(mask.y));
      uint pair = wanted != 0u ? atomicAdd(groupPairs, wanted) : 0u;
      barrier();
      if (gl_LocalInvocationIndex == 0u && groupPairs != 0u) firstPair = atomicAdd(counters.pairs, groupPairs);
      barrier();
      pair += firstPair;
      while ((mask.x | mask.y) != 0u) {
        int bit = lowestBit(mask);
        if (bit < 32) mask.x &= mask.x - 1u;
        else mask.y &= mask.y - 1u;
        if (pair < params.maxPairs) enter(index, blockCorner[bit] + inBlock, pair);
        else show(c.id);
        ++pair;
      }
      barrier();
    }
  }
}
