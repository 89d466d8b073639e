// One workgroup a class, the first one for superblocks without blocks that stay: lists its superblocks in order, with
// the free places before each, and finds the one with the fewest blocks.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/atlas/buffers.glsl"
layout(local_size_x = 256) in;

shared uvec2 sums[256];
shared uint emptiest;

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint which = gl_WorkGroupID.x; // 0: none
  uint class_ = which == 0u ? 0u : which - 1u + kMinClass;
  uint each = (params.superCount + 255u) / 256u;
  uint begin = min(lane * each, params.superCount);
  uint end = min(begin + each, params.superCount);
  if (lane == 0u) emptiest = 0xffffffffu;
  barrier();
  uvec2 sum = uvec2(0u);
  for (uint i = begin; i < end; ++i) {
    if (supers[superAt(i) + 1u] != class_) continue;
    uint kept = supers[superAt(i)];
    sum += uvec2(1u, class_ == 0u ? 0u : placesIn(class_) - kept);
    if (class_ != 0u) atomicMin(emptiest, kept << 12u | (4095u - i));
  }
  sums[lane] = sum;
  barrier();
  for (uint step_ = 1u; step_ < 256u; step_ *= 2u) {
    uvec2 before = lane >= step_ ? sums[lane - step_] : uvec2(0u);
    barrier();
    sums[lane] += before;
    barrier();
  }
  uvec2 start = sums[lane] - sum;
  for (uint i = begin; i < end; ++i) {
    if (supers[superAt(i) + 1u] != class_) continue;
    lists[which * kMaxSupers + start.x] = uvec2(i, start.y);
    start += uvec2(1u, class_ == 0u ? 0u : placesIn(class_) - supers[superAt(i)]);
  }
  if (lane == 255u) {
    counters.classSupers[which] = sums[255].x;
    counters.classFree[which] = sums[255].y;
    counters.emptiest[which] = emptiest;
  }
}
