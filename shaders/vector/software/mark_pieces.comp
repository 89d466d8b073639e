#version 460
// For software devices, as mark.comp: which tiles a path's boundary passes through, and for the others whether they lie
// inside.
//
// Invocations of a subgroup take a segment each, and then an equal share of all their flatSegments. What follows each
// other in one word of tiles is marked and listed at once. Atomics are dear, also for the other invocations, so they
// wait until as many as possible have something for them.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#include "vector/shared/loops_ended.glsl"
#include "vector/shared/lanes.glsl"
#include "vector/software/pieces.glsl"
#define SEGMENTS_ONLY 1
#include "vector/shared/segments.glsl"

uint bitsFrom(int bit) { return bit <= 0 ? ~0u : (bit >= 32 ? 0u : ~0u << uint(bit)); }

// What follows each other in a word of tiles.
struct Part {
  uint path, word, rowWord; // the word, and the first one of its row
  uint begin, end, edges;   // as a Piece's
};
const Part kNoPart = Part(0, ~0u, 0, 0, 0, 0);

// Tiles right of a crossing into a row of tiles.
struct Turn {
  int from, inRow; // bit and words
  uint rowWord;
};

bool omitted; // of the lists

void put(Part p) {
  if (p.word == ~0u) return;
  words[p.rowWord].firstEntry = kOwned | p.path;
  const uint place = atomicAdd(counters.allocated, 1);
  if (place < header.rowLimit) {
    const uint next = atomicExchange(words[p.word].smallGlyph, place + 1);
    putPiece(place, Piece(p.begin, p.end, next, p.edges));
  } else {
    atomicOr(words[p.word].edges, p.edges);
    omitted = true;
  }
}

void main() {
  const uint i = spreadIndex() * 64 + gl_LocalInvocationID.x;
  const Grid g = canvasGrid();
  const int tileRows = int(kTileSize * g.samples), shift = findMSB(tileRows);
  const bool exists = i < header.segmentCount;
  const uint own = min(i, header.segmentCount - 1), itemIndex = itemOf(own);
  const ItemRecord ownItem = items[itemIndex];
  const SegmentRecord ownSegment = fetchSegment(ownItem, own);
  const uint ownPath = ownItem.firstPath + ownSegment.path;
  const PlacedPath ownPlaced = fetchPath(ownPath);
  const bool counts = exists && matters(g, ownPath, ownItem, ownSegment);
  const uint ownCount = counts ? flatSegmentCount(g, ownItem, ownSegment) : 0;
  const uint ownEnd = sumOver(ownCount), total = lastOf(ownEnd), parts = gl_NumWorkGroups.z;
#if PROJECTIVE // flattened segments may be long and very unlike each other, so parts share their rows, by rows of tiles
  const uint begin = 0, end = total;
  const int perPart = ((g.rows + tileRows - 1 >> shift) + int(parts) - 1) / int(parts);
  const int partBegin = int(gl_WorkGroupID.z) * perPart, partEnd = partBegin + perPart;
#else
  const uint perPart = (total + parts - 1) / parts;
  const uint begin = gl_WorkGroupID.z * perPart, end = min(begin + perPart, total);
  const int partBegin = 0, partEnd = 0x7fffffff;
#endif
  if (begin >= end) return;
  const uint first = firstOf(isFirst() ? atomicAdd(counters.rows, end - begin) : 0);
  omitted = end - begin > header.rowLimit || first > header.rowLimit - (end - begin);
  const uint share = (end - begin + kLanes - 1) / kLanes;
  uint flatSegment = min(begin + lane() * share, end);
  const uint flatSegmentEnd = min(flatSegment + share, end);
  uint place = 0; // of the flattened segment at hand
  Part part = kNoPart, done = kNoPart;
  Turn turn = Turn(0, 0, 0);
  Line line = Line(0, 0, 0, 0, 0);
  int flatSegmentFirst = 0, flatSegmentLast = 0, topTile = 0, lastTile = 0;
  int row = 0, lastRow = 0, w = 0, wEnd = 0, low = 0, high = 0;
  int left = 0, right = 0, top = 0, inRow = 0;
  uint path = 0, firstWord = 0, rowWord = 0;
  vec4 ends = vec4(0);
  uint stored = header.rowLimit; // behind all flattened segments, for those that have none
  for (;;) {
    if (turn.inRow > 0)
      for (int k = max(turn.from, 0) / 32; k < turn.inRow; ++k)
        atomicXor(words[turn.rowWord + k].inside, bitsFrom(turn.from - k * 32));
    turn.inRow = 0;
    put(done);
    done.word = ~0u;
    const bool over = flatSegment == flatSegmentEnd && row >= lastRow && w >= wEnd;
    if (over) {
      done = part;
      part.word = ~0u;
    }
    const bool last = !anyOf(!over);
    if (last && !anyOf(done.word != ~0u)) break;
    bool stops = false; // as one more invocation is done, or has to put something
    do {
      // What other invocations tell is asked for by all, whether they take a flattened segment or not.
      const uint owner = ownerOf(ownEnd, flatSegment);
      SegmentRecord s = ownSegment;
      ItemRecord item = ownItem;
      s.first = of(ownSegment.first, owner);
      s.second = of(ownSegment.second, owner);
      s.ends = of(ownSegment.ends, owner);
      s.side = of(ownSegment.side, owner);
      s.line = of(ownSegment.line, owner);
      item.transform = of(ownItem.transform, owner);
      item.offsets = of(ownItem.offsets, owner);
      item.side = of(ownItem.side, owner);
#if SCISSORS
      item.scissor = of(ownItem.scissor, owner);
#endif
#if PROJECTIVE
      item.perspective = of(ownItem.perspective, owner);
      item.eye = of(ownItem.eye, owner);
#endif
      const uint count = of(ownCount, owner), k = flatSegment - (of(ownEnd, owner) - count);
      const uint itsPath = of(ownPath, owner), itsWord = of(ownPlaced.firstWord, owner);
      const uvec4 box = uvec4(of(ownPlaced.left, owner), of(ownPlaced.top, owner), of(ownPlaced.right, owner),
                              of(ownPlaced.bottom, owner));
      if (w >= wEnd && row >= lastRow && flatSegment < flatSegmentEnd) {
        place = first + flatSegment - begin;
        path = itsPath;
        left = int(box.x);
        top = int(box.y);
        right = int(box.z);
        firstWord = itsWord;
        inRow = (right - left + 31) / 32;
        ++flatSegment;
        FlatSegment c;
        const bool found = flatSegmentOf(g, item, s, k, count, flatSegmentStep(count), c);
        ends = !found ? vec4(0) : c.side > 0 ? vec4(c.top, c.bottom) : vec4(c.bottom, c.top);
        if (!omitted) stored = place;
        line = lineOf(g, c);
        flatSegmentFirst = c.first;
        flatSegmentLast = c.last;
        topTile = tileOf(columnOf(g, topEnd(c)));
        lastTile = tileOf(columnOf(g, lastEnd(c)));
        row = max(c.first >> shift, max(top, partBegin));
        lastRow = found ? min((c.last >> shift) + 1, min(int(box.w), partEnd)) : row;
      }
      flatSegmentList[stored] = ends; // once more where there is no new one
      if (w >= wEnd && row < lastRow && turn.inRow == 0) {
        const int rowTop = row << shift, rowBottom = rowTop + tileRows;
        const int from = max(flatSegmentFirst, rowTop), to = min(flatSegmentLast, rowBottom);
        const bool meets = from < to;
        rowWord = firstWord + uint((row - top) * inRow);
        ++row;
        if (meets || !(flatSegmentFirst == rowTop || flatSegmentLast <= rowTop)) {
          int a = topTile, b = lastTile; // tiles at either end of the rows
          low = right;                   // tiles met
          high = -1;
          if (meets) {
            const int x = tileOf(crossingAt(line, middleOf(g, from)) >> 8);
            const int y = tileOf(crossingAt(line, middleOf(g, to - 1)) >> 8);
            low = min(x, y);
            high = max(x, y);
            if (from == rowTop) turn = Turn(x + 1 - left, inRow, rowWord);
            if (flatSegmentFirst <= rowTop) a = x;
            if (flatSegmentLast >= rowBottom) b = y;
          } else {
            if (flatSegmentFirst <= rowTop) a = 0;
            if (flatSegmentLast >= rowBottom) b = 0;
          }
          low = min(low, min(a, b) + 1) - left;
          high = min(max(high, max(a, b)), right - 1) - left;
          if (low <= max(high, 0)) { // else right of the canvas
            w = max(low, 0) / 32;
            wEnd = max(high, 0) / 32 + 1;
          }
        }
      }
      if (w < wEnd) {
        const bool other = rowWord + uint(w) != part.word;
        if (!other || done.word == ~0u) {
          if (other) {
            done = part;
            part = Part(path, rowWord + uint(w), rowWord, place, 0, 0);
          }
          part.end = place + 1;
          part.edges |= bitsFrom(low - w * 32) & ~bitsFrom(high + 1 - w * 32);
          ++w;
        }
      }
      stops = w < wEnd ? done.word != ~0u && rowWord + uint(w) != part.word
                       : row < lastRow ? turn.inRow != 0 : flatSegment == flatSegmentEnd && !over;
    } while (!last && !anyOf(stops));
  }
  if (omitted) {
    atomicMax(counters.rows, header.rowLimit + 1);
    fillWithoutLists();
  }
  sayIfEnded();
}
