#version 460
// For software devices, as allocate.comp: entries for the tiles of each row of a path, one after another, and a list of
// the rows that have any.
//
// An invocation has a row's first word, and finds which tiles have edges from what the row's pieces say. Where entries
// do not suffice, allocate.comp deals them out again.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#include "vector/shared/loops_ended.glsl"
#include "vector/software/pieces.glsl"
layout(local_size_x = 64) in;
// Of all rows of an invocation: invocations that run together, up to 16, take as many turns as all of them where they
// differ (core/turns.h). That is three quarters of the device's, a quarter for whatever else there is.
const uint kMostPieces = 3000;

void main() {
  const uint total = min(counters.words, header.wordLimit);
  const uint lanes = gl_NumWorkGroups.x * gl_NumWorkGroups.y * 64;
  uint turns = 0;
  for (uint i = spreadIndex() * 64 + gl_LocalInvocationID.x; i < total; i += lanes) {
    const TileWord head = fetchTileWord(i);
    if ((head.firstEntry & kOwned) == 0) continue;
    const uint path = head.firstEntry ^ kOwned;
    const PlacedPath p = fetchPath(path);
    const uint end = i + wordsInRow(p);
    uint count = 0;
    for (uint w = i; w < end; ++w) {
      const TileWord word = fetchTileWord(w);
      uint edges = word.edges;
      for (uint next = word.smallGlyph; next != 0 && turns < kMostPieces; ++turns) {
        const Piece piece = fetchPiece(next - 1);
        edges |= piece.edges;
        next = piece.next;
      }
      if (turns == kMostPieces) { // that all have edges is not wrong
        const uint across = p.right - p.left - (w - i) * 32;
        edges = across < 32 ? (1u << across) - 1 : ~0u;
      }
      words[w].edges = edges;
      count += bitCount(edges);
    }
    uint next = 0;
    if (count != 0) {
      next = atomicAdd(counters.entries, count);
      pathRows[atomicAdd(counters.cleared, 1)] = uvec4(i, path, p.top + (i - p.firstWord) / wordsInRow(p), 0);
    }
    for (uint w = i; w < end; ++w) {
      words[w].firstEntry = next;
      next += bitCount(words[w].edges);
    }
  }
  sayIfEnded();
}
