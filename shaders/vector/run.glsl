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
