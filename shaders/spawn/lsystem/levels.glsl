/// The levels of the pyramid over `valid` nodes of a workgroup, a power of two, from `base` on: an invocation each.
void joinLevels(uint base, uint valid, uvec4 node) {
  const uint lane = gl_LocalInvocationIndex;
  barrier();
  scanned[lane] = node;
  for (uint width = valid / 2u; width > 0u; width /= 2u) {
    barrier();
    if (lane < width) node = lsysJoin(scanned[2u * lane], scanned[2u * lane + 1u]);
    barrier();
    base /= 2u;
    if (lane < width) {
      scanned[lane] = node;
      nodes[base + lane] = node;
    }
  }
}
