// Sums over a workgroup of 64; all its invocations must call them together.
shared uint sums[64];

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
  for (uint step = 1; step < 64; step *= 2) {
    const uint other = lane >= step ? sums[lane - step] : 0;
    barrier();
    sums[lane] = add(sums[lane], other);
    barrier();
  }
  return sums[lane];
}
uint scanTotal() { return sums[63]; } // of the last scan

// In how many of the first lanes a condition holds that, once false, stays false.
uint countLanes(uint lane, bool condition) {
  const uint own = sums[lane], total = sums[63];
  barrier();
  sums[lane] = condition ? 1 : 0;
  barrier();
  uint count = 0;
  for (uint i = 0; i < 64; ++i) count += sums[i];
  barrier();
  sums[lane] = own;
  if (lane == 63) sums[63] = total;
  barrier();
  return count;
}
