// Between mark, allocate and fill on software devices: the flattened segments of a path that meet each word of its
// tiles.
//
// Each word has a list of pieces, in any order: flattened segments of one segment, one after another.
// TileWord::smallGlyph is 1 + the number of the first piece. Until allocate gives entries, the firstEntry of a row's
// first word tells whose row it is. What fill then takes is a list of rows.
struct Piece {
  uint begin, end; // flattened segments
  uint next;       // 1 + the number of the next one; 0: none
  uint edges;      // which of the word's tiles they pass through
};
const vec4 kNoScissor = vec4(-kUnbounded, -kUnbounded, kUnbounded, kUnbounded);
const uint kOwned = 0x80000000u; // beside a path's number
// From x, y to x, y: down where the region begins right of the flatSegment.
layout(set = 0, binding = kBindFlatSegments, std430) buffer FlatSegments { vec4 flatSegmentList[]; };
// Rows: the first word, the path, the row of tiles. Behind as many as there may be words: pieces.
layout(set = 0, binding = kBindRows, std430) buffer PathRows { uvec4 pathRows[]; };
uint firstPiece() { return header.wordLimit; }

void putPiece(uint i, Piece p) { pathRows[firstPiece() + i] = uvec4(p.begin, p.end, p.next, p.edges); }
Piece fetchPiece(uint i) {
  const uvec4 p = pathRows[firstPiece() + i];
  return Piece(p.x, p.y, p.z, p.w);
}
// Whether lists hold all; if not, fill finds the flattened segments again by itself.
bool listed(uint flatSegmentCount) { return flatSegmentCount <= header.rowLimit; }
void fillWithoutLists() {
  const uint groups = (header.segmentCount + 63) / 64; // all that mark had (canvas.cpp)
  counters.fillX = min(groups, 32768);
  counters.fillY = (groups + 32767) / 32768;
  counters.fillZ = (header.height + 1023) / 1024;
}
