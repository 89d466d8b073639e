#version 460
// As fill.comp, from the lists of flattened segments and their rows of pixels that mark has written: a lane a row.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
layout(local_size_x = 64) in;
#include "vector/fill/fill_row.glsl"
#include "vector/shared/flat_segments.glsl"

void main() {
  const uint i = groupIndex() * 64 + gl_LocalInvocationID.x;
  if (i >= counters.rows) return;
  const uint row = rows[i];
  const FlatSegmentRecord r = flatSegmentList[i - row];
  const uint path = r.path & ~(kRightSide | kCut);
  if (path >= counters.cutPath) return;
  const Grid g = canvasGrid();
  FlatSegment c;
  c.top = r.top;
  c.bottom = r.bottom;
  c.slope = r.slope;
  c.first = rowOf(g, c.top.y);
  c.last = rowOf(g, c.bottom.y);
  c.side = (r.path & kRightSide) != 0 ? 1.0 : -1.0;
  const PlacedPath p = paths[path];
#if SCISSORS
  if (!cutFlatSegment(g, (r.path & kCut) != 0 ? items[p.item].scissor : kNoScissor, c)) return;
#endif
  fillRow(g, p, c, (c.first >> findMSB(g.samples)) + int(row));
}
