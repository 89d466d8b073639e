// The lists between mark and fill: flattened segments' rows of pixels, and flattened segments, each at the place of its
// first row. Where they do not suffice, fill finds the flattened segments again by itself.
layout(set = 0, binding = kBindFlatSegments, std430) buffer FlatSegments { FlatSegmentRecord flatSegmentList[]; };
// by how much it comes after its flattened segment's first one
layout(set = 0, binding = kBindRows, std430) buffer Rows { uint rows[]; };
const uint kRightSide = 0x80000000u;
const uint kCut = 0x40000000u; // its item has a scissor
const vec4 kNoScissor = vec4(-kUnbounded, -kUnbounded, kUnbounded, kUnbounded);

bool listed(uint rowCount) { return rowCount <= header.rowLimit; }
