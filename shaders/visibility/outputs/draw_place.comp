// Gives each draw its place in the lists by draw, and writes its indirect command. One workgroup: each invocation sums
// a run of draws, the sums are scanned, and the runs are written.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindDrawCommands) writeonly buffer DrawCommandBuffer { uint drawCommands[]; };
#define TABLE_ACCESS
#include "visibility/shared/table.glsl"
#include "visibility/shared/table_write.glsl"

shared uint sums[256];

uint countOf(uint entry) { return table[params.maxEntries * kTableCounts + entry]; }

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint entries = counters.drawsGiven;
  uint run = (entries + 255u) / 256u;
  uint first = min(lane * run, entries);
  uint end = min(first + run, entries);
  uint own = 0u;
  for (uint i = first; i < end; ++i) own = saturatedSum(own, countOf(i));
  sums[lane] = own;
  barrier();
  for (uint step = 1u; step < 256u; step *= 2u) {
    uint before = lane >= step ? sums[lane - step] : 0u;
    barrier();
    sums[lane] = saturatedSum(sums[lane], before);
    barrier();
  }
  uint start = lane == 0u ? 0u : sums[lane - 1u];
  for (uint i = first; i < end; ++i) {
    uint needed = countOf(i);
    uint place = min(start, params.drawListCapacity);
    uint given = min(needed, params.drawListCapacity - place);
    table[params.maxEntries * kTablePlaces + i] = start;
    if (i < params.drawCommandCapacity) {
      DrawEntry e = entryOf(i);
      drawCommands[i * 5u] = given * 3u;
      drawCommands[i * 5u + 1u] = given != 0u ? 1u : 0u;
      drawCommands[i * 5u + 2u] = place * 3u;
      drawCommands[i * 5u + 3u] = e.vertexOffset;
      drawCommands[i * 5u + 4u] = e.draw;
    }
    start = saturatedSum(start, needed);
  }
  barrier();
  if (lane == 255u) {
    counters.drawTriangles = sums[255];
    counters.drawListed = min(sums[255], params.drawListCapacity);
    counters.drawsGiven = min(entries, params.drawCommandCapacity);
  }
}
