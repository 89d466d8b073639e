#version 460
// For software devices, as mark.comp: which tiles a path's boundary passes through, and for the others whether they lie
// inside.
//
// An invocation takes a segment, or a share of its chords. What follows each other in one word of tiles is marked and
// listed at once, as atomics are dear.
#extension GL_GOOGLE_include_directive : require
#define CHORDS_IN_TURN !PROJECTIVE
#include "canvas.glsl"
#include "pieces.glsl"
#define SEGMENTS_ONLY 1
#include "segments.glsl"

uint bitsFrom(int bit) { return bit <= 0 ? ~0u : (bit >= 32 ? 0u : ~0u << uint(bit)); }

uint path;
uint word, rowWord; // at hand: a word of tiles, and the first one of its row
Piece piece;

bool leftOut; // of the lists

void putWord() {
  if (word == ~0u) return;
  words[rowWord].firstEntry = kOwned | path;
  const uint place = atomicAdd(counters.allotted, 1);
  if (place < header.rowLimit) {
    piece.next = atomicExchange(words[word].stamped, place + 1);
    putPiece(place, piece);
  } else {
    atomicOr(words[word].edges, piece.edges);
    leftOut = true;
  }
}

void main() {
  const uint i = groupIndex() * 64 + gl_LocalInvocationID.x;
  if (i >= header.segmentCount) return;
  const ItemRecord item = items[itemOf(i)];
  const SegmentRecord s = fetchSegment(item, i);
  path = item.firstPath + s.path;
  const Grid g = canvasGrid();
  if (!matters(g, path, item, s)) return;
  const PlacedPath p = fetchPath(path);
  const uint count = chordCount(g, item, s), parts = gl_NumWorkGroups.z;
  const float step = chordStep(count);
  const int tileRows = int(kTileSize * g.samples), inRow = int(wordsInRow(p));
#if PROJECTIVE // chords may be long and very unlike each other, so invocations share their rows, by rows of tiles
  const uint begin = 0, end = count;
  const int perPart = ((g.rows + tileRows - 1) / tileRows + int(parts) - 1) / int(parts);
  const int firstRow = max(int(gl_WorkGroupID.z) * perPart, int(p.top)),
            rowEnd = min(int(gl_WorkGroupID.z + 1) * perPart, int(p.bottom));
#else
  const uint perPart = (count + parts - 1) / parts;
  const uint begin = gl_WorkGroupID.z * perPart, end = min(begin + perPart, count);
  const int firstRow = int(p.top), rowEnd = int(p.bottom);
#endif
  if (begin >= end) return;
  uint place = atomicAdd(counters.rows, end - begin);
  word = ~0u;
  leftOut = end - begin > header.rowLimit || place > header.rowLimit - (end - begin);
#if !PROJECTIVE
  vec2 point = curvePoint(s, begin, count, step);
#endif
  for (uint k = begin; k < end; ++k, ++place) {
    Chord c;
#if PROJECTIVE
    const bool found = chordOf(g, item, s, k, count, step, c);
#else
    const bool found = chordOf(g, item, s, k, count, step, point, c);
#endif
    if (!leftOut)
      chordList[place] = !found ? vec4(0) : c.side > 0 ? vec4(c.top, c.bottom) : vec4(c.bottom, c.top);
    if (!found) continue;
    const Line line = lineOf(g, c);
    const int lastRow = min(c.last / tileRows + 1, rowEnd);
    for (int row = max(c.first / tileRows, firstRow); row < lastRow; ++row) {
      const int top = row * tileRows, bottom = top + tileRows;
      const int first = max(c.first, top), last = min(c.last, bottom);
      const bool meets = first < last;
      if (!meets && (c.first == top || c.last <= top)) continue;
      int from = 0, to = 0, low = int(p.right), high = -1; // tiles at either end of the rows, tiles met
      if (meets) {
        from = tileOf(crossingAt(line, middleOf(g, first)) >> 8);
        to = tileOf(crossingAt(line, middleOf(g, last - 1)) >> 8);
        low = min(from, to);
        high = max(from, to);
      }
      const int firstWord = int(p.firstWord) + (row - int(p.top)) * inRow;
      if (meets && first == top)
        for (int w = max(from + 1 - int(p.left), 0) / 32; w < inRow; ++w)
          atomicXor(words[firstWord + w].inside, bitsFrom(from + 1 - int(p.left) - w * 32));
      if (c.first > top) from = tileOf(columnOf(g, topEnd(c)));
      if (c.last < bottom) to = tileOf(columnOf(g, lastEnd(c)));
      low = min(low, min(from, to) + 1) - int(p.left);
      high = min(max(high, max(from, to)), int(p.right) - 1) - int(p.left);
      if (low > max(high, 0)) continue; // right of the canvas
      for (int w = max(low, 0) / 32; w <= max(high, 0) / 32; ++w) {
        if (firstWord + w != word) {
          putWord();
          word = firstWord + w;
          rowWord = firstWord;
          piece.begin = place;
          piece.edges = 0;
        }
        piece.end = place + 1;
        piece.edges |= bitsFrom(low - w * 32) & ~bitsFrom(high + 1 - w * 32);
      }
    }
  }
  putWord();
  if (leftOut) {
    atomicMax(counters.rows, header.rowLimit + 1);
    fillWithoutLists();
  }
}
