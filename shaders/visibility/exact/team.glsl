// A workgroup of 32 invocations that decide a list together, and what they say to each other: by subgroups where those
// are of 32 on the device, so that it is one.
layout(local_size_x = kBatch) in;

uint laneOf() { return gl_LocalInvocationIndex; }

#ifdef GPGP_SUBGROUPS
void sync() { subgroupBarrier(); }
uint lanesWith(bool v) { return subgroupBallot(v).x; } // bits
uint orAll(uint v) { return subgroupOr(v); }
uint minAll(uint v) { return subgroupMin(v); }
uint maxAll(uint v) { return subgroupMax(v); }
uint sumUpTo(uint v) { return subgroupInclusiveAdd(v); } // with the invocation's own
uvec2 fromLane(uvec2 v, uint lane) { return subgroupShuffle(v, lane); }
uvec4 fromLane(uvec4 v, uint lane) { return subgroupShuffle(v, lane); }
#else
shared uint joined;
shared uint sums[kBatch];
shared uvec4 told[kBatch + 1u]; // one more, as `opens` has

void sync() { barrier(); }

void beginJoin(uint neutral) {
  barrier();
  if (laneOf() == 0u) joined = neutral;
  barrier();
}
uint endJoin() {
  barrier();
  return joined;
}
uint orAll(uint v) {
  beginJoin(0u);
  if (v != 0u) atomicOr(joined, v);
  return endJoin();
}
uint lanesWith(bool v) { return orAll(v ? 1u << laneOf() : 0u); }
uint minAll(uint v) {
  beginJoin(0xffffffffu);
  atomicMin(joined, v);
  return endJoin();
}
uint maxAll(uint v) {
  beginJoin(0u);
  atomicMax(joined, v);
  return endJoin();
}
uvec4 fromLane(uvec4 v, uint lane) {
  barrier();
  told[laneOf()] = v;
  barrier();
  return told[lane];
}
uvec2 fromLane(uvec2 v, uint lane) { return fromLane(v.xyxy, lane).xy; }
uint sumUpTo(uint v) {
  sums[laneOf()] = v;
  barrier();
  for (uint step = 1u; step < kBatch; step *= 2u) {
    uint before = laneOf() >= step ? sums[laneOf() - step] : 0u;
    barrier();
    sums[laneOf()] += before;
    barrier();
  }
  return sums[laneOf()];
}
#endif
