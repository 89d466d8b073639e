// Decides a pixel's list of more than kBatch by the depths of its 64 x 64 samples, as brute force would: 16 rows at a
// time, of which each of 32 invocations holds half a row. The nearest triangles come first, and those that begin behind
// all that is there are left out. Needs resolve.glsl, lastKey() and what it divides.
const int kRowsAtATime = 16;
const int kHalfRow = 32;

/// Each invocation's samples, which no other one reads: kHalfRow columns, of all invocations beside each other.
shared uint nearestKeys[kHalfRow * kBatch];
shared uint nearestIds[kHalfRow * kBatch];

uint placeOf(int column) { return uint(column) * kBatch + laneOf(); }

/// Of two triangles at the same depth the lower number is nearer.
void putSample(int column, uint key, uint id) {
  uint at = placeOf(column);
  if (key > nearestKeys[at] || (key == nearestKeys[at] && id >= nearestIds[at])) return;
  nearestKeys[at] = key;
  nearestIds[at] = id;
}

/// Draws a triangle into the invocation's half row, of 16 from firstRow on. No depth is nearer than its list's order
/// says.
void drawHalfRow(Candidate c, uint nearest, ivec2 pixel, int firstRow) {
  ScreenTriangle t = triangleOf(c);
  ivec2 corner = ivec2(pixel.x * 64 + int(laneOf() & 1u) * kHalfRow, pixel.y * 64 + firstRow + int(laneOf() >> 1u));
  ivec4 box = samplesAbout(t);
  if (corner.y < box.y || corner.y > box.w) return;
  int first = max(box.x - corner.x, 0);
  int last = min(box.z - corner.x, kHalfRow - 1);
  bool reversed = params.reversedDepth != 0u;
  int margin = marginOf(t, kMargin);
  ivec2 s0 = edgeSlope(t.p1, t.p2);
  ivec2 s1 = edgeSlope(t.p2, t.p0);
  ivec2 s2 = edgeSlope(t.p0, t.p1);
  ivec2 sample_ = corner + ivec2(first, 0);
  if (isCompact(t)) {
    ivec3 least = ivec3(edgeLeast(s0, margin), edgeLeast(s1, margin), edgeLeast(s2, margin));
    ivec3 step = ivec3(s0.x, s1.x, s2.x) * 4;
    ivec2 point = sampleIn(sample_);
    ivec3 edges = ivec3(edgeCompact(t.p1, s0, point), edgeCompact(t.p2, s1, point), edgeCompact(t.p0, s2, point));
    for (int column = first; column <= last; ++column) {
      ivec3 over = edges - least;
      if ((over.x | over.y | over.z) >= 0) {
        float z = depthOf(t, compactToFloat(edges.y), compactToFloat(edges.z));
        putSample(column, max(depthKey(z, reversed), nearest), c.id);
      }
      edges += step;
    }
  } else {
    Grid grid = middleGrid(ivec2(0, 0), 2);
    ivec3 edges = ivec3(edgeBlock(t.p1, s0, sample_, grid, margin), edgeBlock(t.p2, s1, sample_, grid, margin),
                        edgeBlock(t.p0, s2, sample_, grid, margin));
    for (int column = first; column <= last; ++column) {
      if ((edges.x | edges.y | edges.z) >= 0) {
        float z = depthWide(t, sampleIn(corner + ivec2(column, 0)));
        putSample(column, max(depthKey(z, reversed), nearest), c.id);
      }
      edges += ivec3(s0.x, s1.x, s2.x);
    }
  }
}

/// A pixel that would take too long shows all of its list.
void showAll(Rest rest) {
  for (uint i = rest.begin + laneOf(); i < rest.end; i += kBatch) {
    atomicAdd(counters.unresolved, 1u); // whoever else shows it, in whatever order
    show(candidateId(entries[i]));
  }
}

/// Draws the entries up to a key; false where that takes too long.
bool drawUpTo(inout Rest rest, uint high, ivec2 pixel, int firstRow) {
  rest.turns += turnsOfDraws(sizeOf(rest));
  if (tookTooLong(rest.turns, sizeOf(rest))) return false;
  for (uint begin = rest.begin; begin < rest.end; begin += kBatch) {
    uint i = begin + laneOf();
    uvec2 own = uvec2(0u);
    bool isDrawn = i < rest.end && isWithin(rest, i, rest.low, high);
    if (isDrawn) {
      own = uvec2(entries[i], depths[i]);
      isDrawn = reachesRows(triangleOf(readCandidate(own.x)), pixel.y * 64 + firstRow, kRowsAtATime);
    }
    for (uint left = lanesWith(isDrawn); left != 0u; left &= left - 1u) {
      uvec2 entry = fromLane(own, uint(findLSB(left)));
      Candidate c = readCandidate(entry.x);
      rest.turns += turnsOfDrawing(triangleOf(c));
      if (tookTooLong(rest.turns, sizeOf(rest))) return false;
      drawHalfRow(c, entry.y, pixel, firstRow);
    }
  }
  return true;
}

/// Decides 16 rows; false where that takes too long.
bool resolveRows(inout Rest rest, ivec2 pixel, int firstRow) {
  for (int column = 0; column < kHalfRow; ++column) {
    nearestKeys[placeOf(column)] = kFarthest;
    nearestIds[placeOf(column)] = kNoTriangle;
  }
  rest.turns += kTurnsOfRows;
  rest.low = rest.nearest;
  while (true) {
    if (takesTooLong(rest.turns, sizeOf(rest))) return false;
    uint high = lastKey(rest);
    sync();
    if (!drawUpTo(rest, high, pixel, firstRow)) return false;
    uint farthest = 0u;
    for (int column = 0; column < kHalfRow; ++column) farthest = max(farthest, nearestKeys[placeOf(column)]);
    if (high == rest.farthest || high >= maxAll(farthest)) break;
    rest.low = high + 1u;
  }
  uint last = kNoTriangle;
  for (int column = 0; column < kHalfRow; ++column) {
    uint id = nearestIds[placeOf(column)];
    if (id != last && id != kNoTriangle) show(id);
    last = id;
  }
  return true;
}

void resolveByDepth(uint begin, uint end, ivec2 pixel) {
  uint least = kFarthest;
  uint most = 0u;
  for (uint i = begin + laneOf(); i < end; i += kBatch) {
    ScreenTriangle t = triangleOf(readCandidate(entries[i]));
    uint key = nearestWithMargin(t, isCompact(t), pixel, params.reversedDepth != 0u);
    depths[i] = key;
    least = min(least, key);
    most = max(most, key);
  }
  Rest rest;
  rest.begin = begin;
  rest.end = end;
  rest.before = 0u;
  rest.nearest = minAll(least);
  rest.farthest = maxAll(most);
  rest.turns = turnsThrough(end - begin);
  rest.atOnce = drawnAtOnce(end - begin);
  rest.byNumber = false;
  rest.depth = 0u;
  for (int row = 0; row < 64; row += kRowsAtATime)
    if (!resolveRows(rest, pixel, row)) {
      showAll(rest);
      return;
    }
}
