// Sums over the invocations of a workgroup of kLsysTile.
shared uvec4 scanned[kLsysTile];

/// What joins sums: numbers add up, or the greatest counts (of paths' last beginnings, in y).
uvec4 joined(uvec4 a, uvec4 b, bool paths) {
  return paths ? uvec4(a.x + b.x, max(a.y, b.y), 0u, 0u) : a + b;
}

/// The sum of values of invocations up to this one; that of all is then scanned[kLsysTile - 1]. Barriers are inside.
uvec4 sumUpTo(uvec4 value, bool paths) {
  const uint lane = gl_LocalInvocationIndex;
  barrier();
  scanned[lane] = value;
  barrier();
  for (uint step = 1u; step < kLsysTile; step *= 2u) {
    const uvec4 before = lane >= step ? scanned[lane - step] : uvec4(0u);
    barrier();
    if (lane >= step) scanned[lane] = joined(before, scanned[lane], paths);
    barrier();
  }
  return scanned[lane];
}
