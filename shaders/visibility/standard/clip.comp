// One invocation a queued triangle: makes its records, clipping where needed. A triangle for which there are not enough
// records stays in the queue with a flag, and overflow.comp draws it: records bound time, not output.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/fetch.glsl"
#include "visibility/standard/records.glsl"
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = kBindQueue) buffer QueueBuffer { uint queue[]; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };

bool addMedium(ScreenTriangle t, uint id) {
  uint place = atomicAdd(counters.mediumCount, 1u);
  if (place >= params.mediumRecords) return false;
  records[place].triangle = t;
  records[place].id = id;
  atomicMax(counters.mediumArgs[0], min(place + 1u, kMaxGroups));
  return true;
}

bool addLarge(ScreenTriangle t, uint id) {
  uint slices = clamp(blocksOf(t) / kSliceBlocks, 1u, kMaxSlices);
  uint place = atomicAdd(counters.largeCount, slices);
  // What is counted below the capacity is written, so that no record lies unwritten among the others.
  uint end = min(place + slices, params.largeRecords);
  for (uint i = place; i < end; ++i) {
    records[params.mediumRecords + i].triangle = t;
    records[params.mediumRecords + i].id = id;
    records[params.mediumRecords + i].slice = i - place;
    records[params.mediumRecords + i].slices = slices;
  }
  if (place < end) atomicMax(counters.largeArgs[0], min(end, kMaxGroups));
  return place + slices <= params.largeRecords;
}

bool add(ScreenTriangle t, uint id) {
  if (isEmpty(t)) return true;
  if (isCompact(t)) return addMedium(t, id);
  return addLarge(t, id);
}

void main() {
  uint count = counters.queueCount;
  for (uint entry = gl_GlobalInvocationID.x; entry < count; entry += gl_NumWorkGroups.x * 64u) {
    uint item = queue[entry];
    Fetched f = fetchItem(item);
    uint id = drawnId(f.id, item);
    ScreenTriangle t;
    uint fate = classifyFetched(f, t);
    bool placed = true;
    bool drawn = !isNonOpaque(f.flags); // others are drawn by another pass
    if (fate == kWhole) placed = add(t, id);
    if (fate == kClipped) {
      ScreenPolygon polygon;
      fate = clipTriangle(f.a, f.b, f.c, gridOf(f.camera), f.mirrored, f.twoSided, polygon);
      if (fate == kSkipped) atomicAdd(counters.skippedTriangles, 1u);
      if (fate == kClipped) {
        atomicAdd(counters.triangles, 1u);
        for (int k = 0; k + 2 < polygon.count; ++k)
          if (drawn && fanPiece(polygon, k, gridOf(f.camera), t) && !add(t, id)) placed = false;
      }
    }
    if (!placed) {
      queue[entry] |= kNoRecord;
      atomicMax(counters.leftArgs[0], min(entry + 1u, kMaxGroups));
    }
  }
}
