// What invocations of a workgroup say to each other: sums and ranks, by subgroups where the device has them. Needs the
// workgroup's size as groupSize, a power of two, and oneSubgroup: whether it is known to be one subgroup, whose
// invocations need not wait for each other.
#ifdef GPGP_SUBGROUPS
shared uint subgroupSums[oneSubgroup ? 1 : groupSize];
uint laneIndex() {
  return (oneSubgroup ? 0 : gl_SubgroupID * gl_SubgroupSize) + gl_SubgroupInvocationID;
}
/// A barrier for shared memory.
void groupBarrier() {
  if (oneSubgroup)
    subgroupBarrier();
  else
    barrier();
}
/// Sums of value over the invocations before this one, and over all. A barrier for shared memory.
uint sumBefore(uint value, out uint total) {
  const uint own = subgroupExclusiveAdd(value);
  if (oneSubgroup) {
    total = subgroupAdd(value);
    subgroupBarrier();
    return own;
  }
  // A workgroup may be a part of a subgroup.
  if (gl_SubgroupInvocationID == min(gl_SubgroupSize, groupSize) - 1) subgroupSums[gl_SubgroupID] = own + value;
  barrier();
  uint before = 0;
  total = 0;
  for (uint i = 0; i < gl_NumSubgroups; ++i) {
    if (i == gl_SubgroupID) before = total;
    total += subgroupSums[i];
  }
  barrier();
  return before + own;
}
/// How many invocations before this one have a, in the low half, and b, in the high half; counts: of all. No invocation
/// has both. A barrier for shared memory.
uint ranksOf(bool a, bool b, out uint counts) {
  if (!oneSubgroup) return sumBefore((a ? 1 : 0) | (b ? 0x10000u : 0), counts);
  const uvec4 as = subgroupBallot(a);
  const uvec4 bs = subgroupBallot(b);
  counts = subgroupBallotBitCount(as) | (subgroupBallotBitCount(bs) << 16);
  subgroupBarrier();
  return subgroupBallotExclusiveBitCount(as) | (subgroupBallotExclusiveBitCount(bs) << 16);
}
#else
shared uint sums[groupSize];
uint laneIndex() { return gl_LocalInvocationIndex; }
void groupBarrier() { barrier(); }
uint sumBefore(uint value, out uint total) {
  const uint lane = laneIndex();
  uint sum = value;
  for (uint stride = 1; stride < groupSize; stride *= 2) {
    sums[lane] = sum;
    barrier();
    if (lane >= stride) sum += sums[lane - stride];
    barrier();
  }
  sums[lane] = sum;
  barrier();
  total = sums[groupSize - 1];
  barrier();
  return sum - value;
}
uint ranksOf(bool a, bool b, out uint counts) { return sumBefore((a ? 1 : 0) | (b ? 0x10000u : 0), counts); }
#endif
shared uint saidByFirst;
/// What the first invocation has, for all. A barrier for shared memory.
uint fromFirst(uint value) {
#ifdef GPGP_SUBGROUPS
  if (oneSubgroup) return subgroupBroadcastFirst(value);
#endif
  if (laneIndex() == 0) saidByFirst = value;
  barrier();
  value = saidByFirst;
  barrier();
  return value;
}
