// Triangles that several invocations draw together, made once and drawn in both phases: medium ones (up to 64 pixels'
// extent) in the buffer's front, large ones and the pieces of clipped ones behind them, a record for each slice.
struct TriangleRecord {
  ScreenTriangle triangle;
  uint id;
  uint slice; // of `slices`: which part of a large triangle's blocks
  uint slices;
};
layout(std430, set = 0, binding = kBindRecords) buffer RecordBuffer { TriangleRecord records[]; };
