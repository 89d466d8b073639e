// What a run of sample rows that meet one pixel does: samples that change sides there and at the pixel right of it, and
// by how much its area differs from what they say.
struct Run {
  uint here, next;
  int difference;
};
Run runOf(uint rows, uint covered, int firstCrossing, int lastCrossing) {
  Run run;
  run.here = rows & covered;
  run.next = rows & ~covered;
  run.difference = areaOf(uint(bitCount(rows)), uint(bitCount(run.next)), firstCrossing, lastCrossing);
  return run;
}

// Where a line meets the sample rows of a row of pixels, which begins at row `top`: rows whose sample in the crossing's
// pixel lies right of it, and those whose crossing is in another pixel than the row's before, as bits.
struct Crossings {
  uint covered, first;
};
Crossings crossingsOf(Grid g, Line line, int top) {
  const uvec4 columns = sampleColumns(g.samples);
  const float firstRow = middleOf(g, top), step = sampleStep(g.samples);
  Crossings c = Crossings(0, 0);
  int before = -2; // no column
  for (int k = 0; k < 16; ++k) {
    const int x = crossingAt(line, firstRow + float(k) * step), column = x >> 8; // both exact
    c.covered |= (x & 255) <= int(byteOf(columns, k)) ? 1u << k : 0u;
    c.first |= column != before ? 1u << k : 0u;
    before = column;
  }
  return c;
}
