#version 460
// For software devices, as fill.comp: what each path's boundary does to the pixels of the tiles it passes through,
// without atomics.
//
// An invocation has whole rows of tiles of paths, one after another. In each turn it takes what a flattened segment
// does in one pixel of a row, whichever row of tiles and flattened segment that is of, so that invocations that run
// together rarely wait for each other. What is needed in every turn is read and written by all of them, as those that
// have nothing to do would cost more if they were left out; what is rare waits until several need it.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#include "vector/shared/loops_ended.glsl"
#include "vector/shared/lanes.glsl"
#include "vector/shared/run.glsl"
#include "vector/software/pieces.glsl"
layout(local_size_x = 8) in;
layout(set = 0, binding = kBindEntries, std430) buffer Entries { uint entries[]; };
const uint kIdle = 2; // invocations that wait for work before it is looked for
// Turns after which an invocation takes no more rows, or gives up. The device counts them in two loops (core/turns.h).
const uint kManyTurns = 20000, kMostTurns = 30000;

const uint kNone = ~0u; // no word of an entry

const TileWord kNoTiles = TileWord(0, 0, 0, 0);

void withoutLists() {
  atomicMax(counters.rows, header.rowLimit + 1);
  fillWithoutLists();
}

void main() {
  const Grid g = canvasGrid();
  const uint cutPath = counters.cutPath, rowCount = counters.cleared;
  const bool area = (header.flags & kExactArea) != 0;
  const int shift = findMSB(g.samples), tileRows = int(kTileSize) << shift;
  if (!listed(counters.rows)) return;
  uint turns = 0;
  bool more = true;                                // rows
  uint w = 0, wEnd = 0, next = 0, k = 0, kEnd = 0; // words, pieces, flattened segments
  int left = 0, top = 0, from = 0, to = 0; // tile and sample row; sample rows that are left of the flattened segment
  TileWord word = kNoTiles, after = kNoTiles;
  Line line = Line(0, 0, 0, 0, 0);
  bool right = false;
  uint starts = 0, covered = 0; // sample rows of a row of pixels: where runs begin, right of the flattened segment
  int pixelTop = 0, end = 0;
  // Of the entries: the row of pixels; the pixel of the run at hand, or none, and the one beside it; and what is stored
  // there in the next turn, so that no turn waits for what it reads.
  uint firstOfRow = 0, at = kNone, beside = kNone, here = 0, there = 0;
#if SCISSORS
  vec4 scissor = kNoScissor;
#endif
  for (;;) {
    if (starts == 0 && from >= to && k == kEnd) { // another piece
      if (next == 0) {
        if (w == wEnd && more) {
          const uint i = turns < kManyTurns ? atomicAdd(counters.rowsTaken, 1) : rowCount;
          more = i < rowCount;
          if (more) {
            const uvec4 row = pathRows[i];
            const uvec4 box = pathVectors[row.y * 3];
            w = row.x;
            wEnd = w + (row.y < cutPath ? (box.z - box.x + 31) / 32 : 0);
            left = int(box.x) - 32;
            top = int(row.z) * tileRows;
#if SCISSORS
            const ItemRecord item = items[pathVectors[row.y * 3 + 1].y];
            scissor = hasScissor(item) ? item.scissor : kNoScissor;
#endif
          }
        }
        if (w < wEnd) {
          word = fetchTileWord(w++);
          after = kNoTiles;
          if (w < wEnd) after = fetchTileWord(w);
          left += 32;
          next = word.smallGlyph;
        }
      }
      if (next != 0) {
        const Piece piece = fetchPiece(next - 1);
        next = piece.next;
        k = piece.begin;
        kEnd = piece.end;
      }
    }
    bool busy = from < to || k < kEnd;
    const bool over = !busy && !more && next == 0 && w == wEnd;
    const uint enough = min(countOf(over) + kIdle, kLanes);
    if (!anyOf(!over)) break;
    do {
      const vec4 ends = flatSegmentList[k];
      if (starts == 0) {
        if (from >= to && k < kEnd) {
          ++k;
          right = ends.y < ends.w;
          FlatSegment c;
          c.top = right ? ends.xy : ends.zw;
          c.bottom = right ? ends.zw : ends.xy;
          c.first = rowOf(g, c.top.y);
          c.last = rowOf(g, c.bottom.y);
          precise float width = c.bottom.x - c.top.x;
          precise float height = c.bottom.y - c.top.y;
          c.slope = slopeOf(width, height);
#if SCISSORS
          if (!cutFlatSegment(g, scissor, c)) c.last = c.first;
#endif
          from = max(c.first, top);
          to = min(c.last, top + tileRows);
          line = lineOf(g, c);
        }
        if (from < to) {
          pixelTop = from >> shift << shift;
          const int begin = from - pixelTop;
          end = min(to - pixelTop, int(g.samples));
          from = pixelTop + int(g.samples);
          const Crossings crossings = crossingsOf(g, line, pixelTop);
          firstOfRow = word.firstEntry * kEntryWords + (uint(pixelTop >> shift) & (kTileSize - 1)) * kTileSize;
          covered = crossings.covered;
          starts = (crossings.first | 1u << begin) & ((1u << end) - (1u << begin));
        }
      }
      const int runBegin = findLSB(starts);
      const bool runs = starts != 0;
      starts &= starts - 1;
      const int runEnd = starts != 0 ? findLSB(starts) : end;
      const int x = crossingAt(line, middleOf(g, pixelTop + runBegin)), column = max(x >> 8, 0);
      Run run = runOf((1u << runEnd) - (1u << runBegin), covered, x,
                      crossingAt(line, middleOf(g, pixelTop + runEnd - 1)));
      if (x < 0) run = Run(run.here | run.next, 0, 0);
      const int tile = (column >> 3) - left; // in the word
      const uint inTile = uint(column) & 7, mask = 1u << (tile & 31);
      const bool takes = runs && tile >= 0 && tile < 32 && column < g.columns && (word.edges & mask) != 0;
      // The pixel right of it may be another tile's; where that has no edges, its own rows agree.
      const bool crosses = inTile == 7, marked = tile < 31 ? (word.edges & mask << 1) != 0 : (after.edges & 1) != 0;
      const bool both = takes && (!crosses || marked);
      if (at != kNone) {
        entries[at] = here;
        entries[beside] = there;
      }
      if (takes) at = firstOfRow + bitCount(word.edges & (mask - 1)) * kEntryWords + inTile;
      else run = Run(0, 0, 0);
      beside = both ? at + (crosses ? kEntryWords - 7 : 1) : at;
      const uint change = uint(!area ? 0 : right ? run.difference : -run.difference) << 16;
      if (at != kNone) {
        here = (entries[at] ^ run.here) + change;
        const uint other = entries[beside] ^ run.next;
        there = both ? other : here;
      }
      ++turns;
      busy = starts != 0 || from < to || k < kEnd;
    } while (countOf(!busy) < enough && turns < kMostTurns);
    if (turns >= kMostTurns) {
      withoutLists();
      sayIfEnded();
      return;
    }
  }
  if (at != kNone) {
    entries[at] = here;
    entries[beside] = there;
  }
  if (turns >= kManyTurns && gl_WorkGroupID.x + 1 == gl_NumWorkGroups.x && counters.rowsTaken < rowCount)
    withoutLists();
  sayIfEnded();
}
