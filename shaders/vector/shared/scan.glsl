// Sums over a workgroup of SCAN_LANES; all its invocations must call them together.
#ifndef SCAN_LANES
#define SCAN_LANES 64
#endif
shared uint sums[SCAN_LANES];

uint add(uint a, uint b) { // stays at the largest number instead of wrapping
  uint carry;
  const uint sum = uaddCarry(a, b, carry);
  return carry != 0 ? ~0u : sum;
}

// The sum of the values of lanes up to this one.
uint scan(uint lane, uint value) {
  barrier();
  sums[lane] = value;
  barrier();
  for (uint step = 1; step < SCAN_LANES; step *= 2) {
    const uint other = lane >= step ? sums[lane - step] : 0;
    barrier();
    sums[lane] = add(sums[lane], other);
    barrier();
  }
  return sums[lane];
}
uint scanTotal() { return sums[SCAN_LANES - 1]; } // of the last scan

// The same, with the sum of all, for values whose sum does not wrap. A barrier must lie between one call and the next.
uint sumUpTo(uint lane, uint value, out uint total) {
#if SUBGROUPS
  const uint upTo = sumOver(value);
  // A workgroup may be a part of a subgroup.
  if (gl_SubgroupInvocationID == min(gl_SubgroupSize, SCAN_LANES) - 1) sums[gl_SubgroupID] = upTo;
  barrier();
  uint before = 0;
  total = 0;
  for (uint i = 0; i < gl_NumSubgroups; ++i) {
    if (i == gl_SubgroupID) before = total;
    total += sums[i];
  }
  return before + upTo;
#else
  const uint upTo = scan(lane, value);
  total = scanTotal();
  return upTo;
#endif
}

// In how many of the first lanes a condition holds that, once false, stays false.
uint countLanes(uint lane, bool condition) {
  const uint own = sums[lane], total = sums[SCAN_LANES - 1];
  barrier();
  sums[lane] = condition ? 1 : 0;
  barrier();
  uint count = 0;
  for (uint i = 0; i < SCAN_LANES; ++i) count += sums[i];
  barrier();
  sums[lane] = own;
  if (lane == SCAN_LANES - 1) sums[SCAN_LANES - 1] = total;
  barrier();
  return count;
}
