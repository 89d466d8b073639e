// One invocation a triangle on the screen: enters those that are not seen at any pixel's centre, in the pixels in which
// they may be seen. Those that are seen are queued for hide.comp; in the same buffer, from its end, those that are
// clipped or reach over more than 8 x 8 pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/fetch.glsl"
#include "visibility/lists.glsl"
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/enter.glsl"
#include "visibility/small_pairs.glsl"
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = kBindQueue) buffer QueueBuffer { uint queue[]; };

shared uint groupSeen;
shared uint groupBig;
shared uint firstSeen;
shared uint firstBig;

void main() {
  uint count = counters.onScreenCount;
  for (uint first = gl_WorkGroupID.x * 64u; first < count; first += gl_NumWorkGroups.x * 64u) {
    if (gl_LocalInvocationIndex == 0u) {
      groupSeen = 0u;
      groupBig = 0u;
    }
    barrier();
    uint number = 0u;
    const uint kNone = 0xffffffffu;
    uint big = kNone;
    uint seen = kNone;
    uvec2 mask = uvec2(0u);
    ScreenTriangle t;
    uint id = 0u;
    ivec4 bounds = ivec4(0);
    if (first + gl_LocalInvocationIndex < count) {
      number = queue[params.maxItems + first + gl_LocalInvocationIndex];
      uint item;
      Fetched f = fetchNumber(number, item);
      id = f.id;
      uint fate = classifyFetched(f, t);
      if (fate == kClipped) big = atomicAdd(groupBig, 1u);
      if (fate == kWhole) {
        bounds = pixelBounds(t.p0, t.p1, t.p2, gridOf(f.camera));
        if (bounds.x < bounds.z && bounds.y < bounds.w) {
          if (bounds.z - bounds.x > 8 || bounds.w - bounds.y > 8) big = atomicAdd(groupBig, 1u);
          else if (isSeen(id)) seen = atomicAdd(groupSeen, 1u);
          else mask = wantedPixels(t, bounds, false);
        }
      }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
      if (groupSeen != 0u) {
        firstSeen = atomicAdd(counters.seenCount, groupSeen);
        atomicMax(counters.seenArgs[0], min((firstSeen + groupSeen + 63u) / 64u, kMaxGroups));
      }
      if (groupBig != 0u) {
        firstBig = atomicAdd(counters.bigQueueCount, groupBig);
        atomicMax(counters.bigUnfoldArgs[0], min((firstBig + groupBig + 63u) / 64u, kMaxGroups));
      }
    }
    barrier();
    if (seen != kNone) queue[firstSeen + seen] = number;
    if (big != kNone) queue[params.maxItems - 1u - firstBig - big] = number;
    enterSmall(t, id, bounds.xy, mask);
  }
}
