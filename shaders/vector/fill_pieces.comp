#version 460
// For software devices, as fill.comp: what each path's boundary does to the pixels of the tiles it passes through,
// without atomics.
//
// An invocation has whole rows of tiles of paths, several of them, as some have much more to do than others. Chords'
// rows of pixels come one after another, whichever row of tiles and chord they are of, so that invocations that run
// together rarely wait for each other.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
#include "run.glsl"
#include "pieces.glsl"
layout(local_size_x = 8) in;
layout(set = 0, binding = 15, std430) buffer Entries { uint entries[]; };
const uint kMostTurns = 8000; // an eighth of those after which lavapipe ends a shader's loops

const TileWord kNoTiles = TileWord(0, 0, 0, 0);

void main() {
  const Grid g = canvasGrid();
  const uint cutPath = counters.cutPath, rowCount = counters.cleared, lanes = gl_NumWorkGroups.x * 8;
  const bool area = (header.flags & kExactArea) != 0;
  const int shift = findMSB(g.samples), tileRows = int(kTileSize) << shift;
  if (!listed(counters.rows)) return;
  uint turns = 0; // of this invocation's loop
  uint i = gl_GlobalInvocationID.x, w = 0, wEnd = 0, next = 0, k = 0, kEnd = 0; // rows, words, pieces, chords
  int left = 0, top = 0, from = 0, to = 0; // tile and sample row; sample rows that are left of the chord
  TileWord word = kNoTiles, after = kNoTiles;
  Line line = Line(0, 0, 0, 0, 0);
  bool right = false;
#if SCISSORS
  vec4 scissor = kNoScissor;
#endif
  while (i < rowCount || w < wEnd || next != 0 || k < kEnd || from < to) {
    if (turns > kMostTurns) {
      atomicMax(counters.rows, header.rowLimit + 1);
      fillWithoutLists();
      return;
    }
    if (from >= to) {
      if (k == kEnd && next == 0) {
        if (w == wEnd) {
          const uvec4 row = pathRows[i];
          const uvec4 box = pathVectors[row.y * 3];
          i += lanes;
          w = row.x;
          wEnd = w + (row.y < cutPath ? (box.z - box.x + 31) / 32 : 0);
          left = int(box.x) - 32;
          top = int(row.z) * tileRows;
#if SCISSORS
          const ItemRecord item = items[pathVectors[row.y * 3 + 1].y];
          scissor = hasScissor(item) ? item.scissor : kNoScissor;
#endif
        }
        if (w < wEnd) {
          word = fetchTileWord(w++);
          if (w < wEnd) after = fetchTileWord(w);
          left += 32;
          next = word.stamped;
        }
      }
      if (k == kEnd && next != 0) {
        const Piece piece = fetchPiece(next - 1);
        next = piece.next;
        k = piece.begin;
        kEnd = piece.end;
      }
      if (k < kEnd) {
        const vec4 ends = chordList[k++];
        right = ends.y < ends.w;
        Chord c;
        c.top = right ? ends.xy : ends.zw;
        c.bottom = right ? ends.zw : ends.xy;
        c.first = rowOf(g, c.top.y);
        c.last = rowOf(g, c.bottom.y);
        precise float width = c.bottom.x - c.top.x;
        precise float height = c.bottom.y - c.top.y;
        c.slope = slopeOf(width, height);
#if SCISSORS
        if (!cutChord(g, scissor, c)) c.last = c.first;
#endif
        from = max(c.first, top);
        to = min(c.last, top + tileRows);
        line = lineOf(g, c);
      }
      if (from >= to) {
        ++turns;
        continue;
      }
    }
    const int pixelTop = from >> shift << shift, begin = from - pixelTop, end = min(to - pixelTop, int(g.samples));
    from = pixelTop + int(g.samples);
    const Crossings crossings = crossingsOf(g, line, pixelTop);
    const uint firstOfRow = word.firstEntry * kEntryWords + (uint(pixelTop >> shift) & (kTileSize - 1)) * kTileSize;
    uint starts = (crossings.first | 1u << begin) & ((1u << end) - (1u << begin));
    turns += 1 + bitCount(starts);
    while (starts != 0) {
      const int runBegin = findLSB(starts);
      starts &= starts - 1;
      const int runEnd = starts != 0 ? findLSB(starts) : end;
      const int x = crossingAt(line, middleOf(g, pixelTop + runBegin)), column = max(x >> 8, 0);
      Run run = runOf((1u << runEnd) - (1u << runBegin), crossings.covered, x,
                      crossingAt(line, middleOf(g, pixelTop + runEnd - 1)));
      if (x < 0) run = Run(run.here | run.next, 0, 0);
      const int tile = (column >> 3) - left; // in the word
      const uint inTile = uint(column) & 7, mask = 1u << (tile & 31);
      if (tile < 0 || tile >= 32 || column >= g.columns || (word.edges & mask) == 0) continue;
      const uint at = firstOfRow + bitCount(word.edges & (mask - 1)) * kEntryWords + inTile;
      entries[at] = (entries[at] ^ run.here) + (uint(!area ? 0 : right ? run.difference : -run.difference) << 16);
      // The pixel right of it may be another tile's; where that has no edges, its own rows agree.
      const bool crosses = inTile == 7, marked = tile < 31 ? (word.edges & mask << 1) != 0 : (after.edges & 1) != 0;
      if (run.next != 0 && (!crosses || marked)) entries[at + (crosses ? kEntryWords - 7 : 1)] ^= run.next;
    }
  }
}
