// What the passes over segments share: a workgroup takes header.groupSegments of them and deals their flattened
// segments out evenly. SOFTWARE: without barriers; an invocation takes a segment, or a share of its flatSegments.
// SEGMENTS_ONLY: the pass itself does.
#ifndef LANES
#define LANES 64
#endif
#ifndef SEGMENT_GROUP
#define SEGMENT_GROUP groupIndex()
#endif
layout(local_size_x = LANES) in;
uint itemOf(uint segment) { // the last one that begins at or before it
  uint low = 0, high = header.itemCount;
  if (high > kManyItems) {
    const uint step = firstItemsStep(header.segmentCount), k = segment / step;
    low = firstItems[k];
    if ((k + 1) * step < header.segmentCount) high = firstItems[k + 1] + 1;
  }
  while (low + 1 < high) {
    const uint middle = (low + high) / 2;
    if (items[middle].firstSegment <= segment) low = middle;
    else high = middle;
  }
  return low;
}
bool matters(Grid g, uint path, ItemRecord item, SegmentRecord s) {
  return path < counters.cutPath && paths[path].left < paths[path].right && mayMatter(g, item, s);
}
#if SEGMENTS_ONLY
#elif SOFTWARE
void takeFlatSegment(Grid g, PlacedPath p, FlatSegment c); // the pass's work
void takeSegment() {
  const uint i = groupIndex() * 64 + gl_LocalInvocationID.x;
  if (i >= header.segmentCount) return;
  const ItemRecord item = items[itemOf(i)];
  const SegmentRecord s = fetchSegment(item, i);
  const uint path = item.firstPath + s.path;
  const Grid g = canvasGrid();
  if (!matters(g, path, item, s)) return;
  const PlacedPath p = fetchPath(path);
  const uint count = flatSegmentCount(g, item, s);
  const float step = flatSegmentStep(count);
#if PROJECTIVE
  // Flattened segments may be long and very unlike each other, so invocations share their rows, by rows of tiles.
  const int tileRows = int(kTileSize * g.samples), parts = int(gl_NumWorkGroups.z);
  const int perPart = ((g.rows + tileRows - 1) / tileRows + parts - 1) / parts * tileRows;
  const int begin = int(gl_WorkGroupID.z) * perPart, end = begin + perPart;
  for (uint k = 0; k < count; ++k) {
    FlatSegment c;
    if (!flatSegmentOf(g, item, s, k, count, step, c) || c.last < begin || c.first >= end) continue;
    c.first = max(c.first, begin);
    c.last = min(c.last, end);
    takeFlatSegment(g, p, c);
  }
  return;
#endif
  for (uint k = gl_WorkGroupID.z; k < count; k += gl_NumWorkGroups.z) {
    FlatSegment c;
    if (flatSegmentOf(g, item, s, k, count, step, c)) takeFlatSegment(g, p, c);
  }
}
#else
shared SegmentRecord segment[kMostSegments];
shared uint segmentItem[kMostSegments];
shared uint segmentPath[kMostSegments]; // in the recording
shared float segmentStep[kMostSegments];
shared uint firstFlatSegment[kMostSegments + 1];

// Loads the workgroup's segments and counts their flattened segments; none for those that cannot matter.
void loadSegments() {
  const uint lane = gl_LocalInvocationID.x;
  if (lane < header.groupSegments) {
    const uint i = SEGMENT_GROUP * header.groupSegments + lane;
    uint count = 0;
    if (i < header.segmentCount) {
      const uint low = itemOf(i);
      const ItemRecord item = items[low];
      const SegmentRecord s = fetchSegment(item, i);
      const uint path = item.firstPath + s.path;
      segment[lane] = s;
      segmentItem[lane] = low;
      segmentPath[lane] = path;
      if (matters(canvasGrid(), path, item, s)) {
        count = flatSegmentCount(canvasGrid(), item, s);
        segmentStep[lane] = flatSegmentStep(count);
      }
    }
    firstFlatSegment[lane + 1] = count;
  }
  if (lane == 0) firstFlatSegment[0] = 0;
  barrier();
  for (uint step = 1; step < header.groupSegments; step *= 2) {
    const bool adds = lane >= step && lane < header.groupSegments;
    const uint other = adds ? firstFlatSegment[lane + 1 - step] : 0;
    barrier();
    if (adds) firstFlatSegment[lane + 1] += other;
    barrier();
  }
}

uint flatSegmentTotal() { return firstFlatSegment[header.groupSegments]; }

// Flattened segment i of the workgroup's: its segment's place in the tables above.
uint segmentOf(uint i) {
  uint low = 0, high = header.groupSegments;
  while (low + 1 < high) {
    const uint middle = (low + high) / 2;
    if (firstFlatSegment[middle] <= i) low = middle;
    else high = middle;
  }
  return low;
}

bool fetchFlatSegment(Grid g, uint s, uint i, out FlatSegment flatSegment) {
  const uint first = firstFlatSegment[s];
  return flatSegmentOf(g, items[segmentItem[s]], segment[s], i - first, firstFlatSegment[s + 1] - first, segmentStep[s],
                       flatSegment);
}
#endif
