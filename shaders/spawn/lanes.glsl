// What invocations of a workgroup say to each other: sums and ranks, by subgroups where the device has them. Needs the
// workgroup's size as groupSize, a power of two.
#ifdef GPGP_SUBGROUPS
shared uint subgroupSums[groupSize];
uint laneIndex() { return gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID; }
/// Sums of value over the invocations before this one, and over all. A barrier for shared memory.
uint sumBefore(uint value, out uint total) {
  const uint own = subgroupExclusiveAdd(value);
  if (gl_NumSubgroups == 1) {
    total = subgroupAdd(value);
    barrier();
    return own;
  }
  if (gl_SubgroupInvocationID == gl_SubgroupSize - 1) subgroupSums[gl_SubgroupID] = own + value;
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
  if (gl_NumSubgroups > 1) return sumBefore((a ? 1 : 0) | (b ? 0x10000u : 0), counts);
  const uvec4 as = subgroupBallot(a);
  const uvec4 bs = subgroupBallot(b);
  counts = subgroupBallotBitCount(as) | (subgroupBallotBitCount(bs) << 16);
  barrier();
  return subgroupBallotExclusiveBitCount(as) | (subgroupBallotExclusiveBitCount(bs) << 16);
}
#else
shared uint sums[groupSize];
uint laneIndex() { return gl_LocalInvocationIndex; }
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
