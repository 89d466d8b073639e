// Depth, one invocation a triangle: rejects, draws small ones at once and queues the others. Small ones that were the
// nearest in a pixel when they were drawn are queued for ids.comp from the queue's other end: each item takes one place
// at most, so they never meet. Exact sampling also wants lists of those that are on the screen; they follow the queue:
// those of at most 8 x 8 pixels from its front, the others and those that are clipped from its end. What is not opaque
// is drawn by non_opaque.comp; its queue follows both. Where that is full, it counts as visible and hides nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_INT64_ATOMICS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#endif
#include "visibility/shared/fetch.glsl"
#include "visibility/shared/chunks.glsl"
#include "visibility/standard/pixels.glsl"
#include "visibility/standard/draw_small.glsl"
#include "visibility/reuse/reuse.h"
layout(local_size_x = 64) in; // kChunk

layout(std430, set = 0, binding = kBindQueue) writeonly buffer QueueBuffer { uint queue[]; };
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };

shared uint groupTriangles;
shared uint groupSkipped;
shared uvec2 groupChecksum;
shared uint groupWinners;
shared uint groupOnScreen;
shared uint groupLarge;
shared uint firstWinner;
shared uint firstOnScreen;
shared uint firstLarge;
shared uint groupNonOpaque;
shared uint firstNonOpaque;

void main() {
  if (gl_LocalInvocationIndex == 0u) {
    groupTriangles = 0u;
    groupSkipped = 0u;
    groupChecksum = uvec2(0u);
  }
  uint kept = keptCount();
  uint triangles = 0u;
  uint skipped = 0u;
  uvec2 checksum = uvec2(0u);
  for (uint i = gl_WorkGroupID.x; i < kept; i += gl_NumWorkGroups.x) {
    uint chunk = keptChunk(i);
    uint drawIndex = findChunk(chunk);
    uvec2 start = startOf(drawIndex);
    if (start.x >= params.maxItems) continue;
    if (gl_LocalInvocationIndex == 0u) {
      groupWinners = 0u;
      groupOnScreen = 0u;
      groupLarge = 0u;
      groupNonOpaque = 0u;
    }
    barrier();
    uint end = min(entryOf(drawIndex).indexCount / 3u, params.maxItems - start.x);
    uint local = (chunk - start.y) * kChunk + gl_LocalInvocationIndex;
    const uint kNone = 0xffffffffu;
    uint winner = kNone;
    uint onScreen = kNone;
    uint large = kNone;
    uint nonOpaque = kNone;
    uint id = 0u;
    if (local < end) {
      Fetched f = fetchTriangle(drawIndex, local);
      id = f.id;
      ScreenTriangle t;
      uint fate = classifyFetched(f, t);
      if (fate == kSkipped) ++skipped;
      if (fate == kWhole) ++triangles;
      bool empty = fate == kWhole && isEmpty(t);
      bool open = isNonOpaque(f.flags);
      bool onSamples = fate == kWhole && !empty;
      bool drawn = onSamples && !open;
      if (drawn && isSmall(t)) {
        if (drawSmall(t, drawnId(f.id, start.x + local))) winner = atomicAdd(groupWinners, 1u);
      } else if (fate == kClipped || drawn) {
        uint entry = atomicAdd(counters.queueCount, 1u);
        queue[entry] = start.x + local;
        atomicMax(counters.unfoldArgs[0], min(entry / 64u + 1u, kMaxGroups));
      }
      if (params.method == kExact) {
        ivec4 bounds = ivec4(0);
        if (fate == kBackFacing && !open) { // exact sampling has finer corners
          Corners fine;
          bool swaps;
          if (facesFinely(f.a, f.b, f.c, gridOf(f.camera), f.mirrored, f.twoSided, fine, swaps))
            bounds = pixelBounds(nearestUnit(fine.p0), nearestUnit(fine.p1), nearestUnit(fine.p2), gridOf(f.camera));
        }
        if (fate == kWhole) bounds = pixelBounds(t.p0, t.p1, t.p2, gridOf(f.camera));
        bool reaches = bounds.x < bounds.z && bounds.y < bounds.w;
        onSamples = onSamples || reaches;
        bool isLargeCandidate = fate == kClipped || (reaches && (bounds.z - bounds.x > 8 || bounds.w - bounds.y > 8));
        bool listed = !open || params.maxNonOpaque != 0u;
        if (isLargeCandidate && listed) large = atomicAdd(groupLarge, 1u);
        else if (reaches && listed) onScreen = atomicAdd(groupOnScreen, 1u);
        if (params.reuse != 0u && (onSamples || fate == kClipped))
          checksum += checksumOf(f.id, f.flags, f.mirrored, f.a, f.b, f.c);
      }
      if (open && (onSamples || fate == kClipped)) nonOpaque = atomicAdd(groupNonOpaque, 1u);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
      if (groupWinners != 0u) {
        firstWinner = atomicAdd(counters.winnerCount, groupWinners);
        atomicMax(counters.winnerArgs[0], min((firstWinner + groupWinners + 63u) / 64u, kMaxGroups));
      }
      if (groupOnScreen != 0u) {
        firstOnScreen = atomicAdd(counters.onScreenCount, groupOnScreen);
        atomicMax(counters.onScreenArgs[0], min((firstOnScreen + groupOnScreen + 63u) / 64u, kMaxGroups));
      }
      if (groupLarge != 0u) {
        firstLarge = atomicAdd(counters.largeQueueCount, groupLarge);
        atomicMax(counters.selectLargeArgs[0], min((firstLarge + groupLarge + 63u) / 64u, kMaxGroups));
      }
      if (groupNonOpaque != 0u) {
        firstNonOpaque = atomicAdd(counters.nonOpaque, groupNonOpaque);
        uint needed = firstNonOpaque + groupNonOpaque;
        atomicMax(counters.nonOpaqueArgs[0], min(min(needed, params.maxNonOpaque), kMaxGroups));
      }
    }
    barrier();
    uint number = chunk * kChunk + gl_LocalInvocationIndex;
    if (winner != kNone) queue[params.maxItems - 1u - firstWinner - winner] = number;
    if (onScreen != kNone) queue[params.maxItems + firstOnScreen + onScreen] = number;
    if (large != kNone) queue[params.maxItems * 2u - 1u - firstLarge - large] = number;
    if (nonOpaque != kNone) {
      nonOpaque += firstNonOpaque;
      if (nonOpaque < params.maxNonOpaque) queue[params.nonOpaqueAt + nonOpaque] = number;
      else atomicOr(bits[id >> 5u], 1u << (id & 31u));
    }
  }
  barrier();
  if (triangles != 0u) atomicAdd(groupTriangles, triangles);
  if (skipped != 0u) atomicAdd(groupSkipped, skipped);
  if ((checksum.x | checksum.y) != 0u) {
    atomicAdd(groupChecksum.x, checksum.x);
    atomicAdd(groupChecksum.y, checksum.y);
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    if (groupTriangles != 0u) atomicAdd(counters.triangles, groupTriangles);
    if (groupSkipped != 0u) atomicAdd(counters.skippedTriangles, groupSkipped);
    if (params.reuse != 0u) {
      atomicAdd(counters.checksum[0], groupChecksum.x);
      atomicAdd(counters.checksum[1], groupChecksum.y);
    }
  }
}
