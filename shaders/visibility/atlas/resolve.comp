// One workgroup: how far blocks have to be lowered so that all fit. Each invocation holds the counts of four keys.
//
// What is asked is whether whole superblocks suffice for the blocks of each class. Where pressure changes, it leaves
// some of them free, so that small changes do not change it again.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/atlas/buffers.glsl"
layout(local_size_x = 256) in;

shared uint counts[kClasses];

uint own[4u * kVariants];

bool fits(uint lane, uint pressure, uint supers_) {
  barrier();
  if (lane < kClasses) counts[lane] = 0u;
  barrier();
  for (uint i = 0u; i < 4u * kVariants; ++i) {
    if (own[i] == 0u) continue;
    uint key = lane * 4u + i / kVariants;
    uint class_ = classUnder(classOfKey(key) + i % kVariants - 1u, key, pressure);
    if (class_ != 0u) atomicAdd(counts[class_ - kMinClass], own[i]);
  }
  barrier();
  uint needed = 0u;
  for (uint i = 0u; i < kClasses; ++i) needed += supersFor(counts[i], kMinClass + i);
  return needed <= supers_;
}

/// The least pressure of a range that leaves so much, where the last one does.
uint search(uint lane, uint low, uint high, uint supers_) {
  for (uint i = 0u; i < 14u; ++i) {
    if (low >= high) break;
    uint middle = low + (high - low) / 2u;
    if (fits(lane, middle, supers_)) high = middle;
    else low = middle + 1u;
  }
  return high;
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  for (uint i = 0u; i < 4u * kVariants; ++i) own[i] = histogram[lane * 4u * kVariants + i];
  uint pressure = min(history[kHeadPressure], kMostPressure);
  uint all_ = params.superCount;
  if (!fits(lane, pressure, all_)) pressure = search(lane, pressure, kMostPressure, all_ - all_ / 16u);
  else if (pressure != 0u && fits(lane, pressure, all_ - all_ / 8u))
    pressure = search(lane, 0u, pressure, all_ - all_ / 8u);
  if (lane == 0u) {
    history[kHeadPressure] = pressure;
    counters.pressure = pressure;
  }
}
