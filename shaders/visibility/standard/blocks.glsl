// Draws one slice of a large triangle with a workgroup of 64: tests 64 blocks of 8 x 8 samples at a time, a block an
// invocation, and then draws the blocks that the triangle may touch, a sample an invocation. All invocations of the
// workgroup must call it, with the same arguments.
shared uint blockCount;
shared ivec2 blockCorner[64];
shared ivec3 blockEdges[64];

void drawLarge(ScreenTriangle t, uint id, uint slice, uint slices) {
  if (isEmpty(t)) return;
  ivec2 s0 = edgeSlope(t.p1, t.p2);
  ivec2 s1 = edgeSlope(t.p2, t.p0);
  ivec2 s2 = edgeSlope(t.p0, t.p1);
  int margin = marginOf(t, grid().margin);
  uint columns = uint(t.bounds.z - t.bounds.x + 7) / 8u;
  uint blocks = blocksOf(t);
  ivec2 inBlock = ivec2(int(gl_LocalInvocationIndex) & 7, int(gl_LocalInvocationIndex) >> 3);
  for (uint first = slice * 64u; first < blocks; first += slices * 64u) {
    if (gl_LocalInvocationIndex == 0u) blockCount = 0u;
    barrier();
    uint block = first + gl_LocalInvocationIndex;
    if (block < blocks) {
      ivec2 corner = t.bounds.xy + 8 * ivec2(int(block % columns), int(block / columns));
      ivec3 edges = ivec3(edgeBlock(t.p1, s0, corner, grid(), margin), edgeBlock(t.p2, s1, corner, grid(), margin),
                          edgeBlock(t.p0, s2, corner, grid(), margin));
      if (!blockOutside(edges.x, s0, 8) && !blockOutside(edges.y, s1, 8) && !blockOutside(edges.z, s2, 8)) {
        uint place = atomicAdd(blockCount, 1u);
        blockCorner[place] = corner;
        blockEdges[place] = edges;
      }
    }
    barrier();
    uint touched = blockCount;
    for (uint i = 0u; i < touched; ++i) {
      ivec2 pixel = blockCorner[i] + inBlock;
      ivec3 edges = blockEdges[i] + ivec3(s0.x, s1.x, s2.x) * inBlock.x + ivec3(s0.y, s1.y, s2.y) * inBlock.y;
      bool inside = edges.x >= 0 && edges.y >= 0 && edges.z >= 0;
      if (inside && pixel.x < t.bounds.z && pixel.y < t.bounds.w)
        coverPixel(t, false, pixel, depthWide(t, samplePoint(pixel, grid())), id);
    }
    barrier();
  }
}
