// Large triangles and pieces of clipped ones: a workgroup a slice.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_INT64_ATOMICS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#endif
#include "visibility/shared/triangle.h"

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
#include "visibility/standard/pixels.glsl"
#include "visibility/standard/records.glsl"
layout(local_size_x = 64) in;
#include "visibility/standard/blocks.glsl"

layout(std430, set = 0, binding = kBindCounters) readonly buffer CounterBuffer { Counters counters; };

void main() {
  uint count = min(counters.largeCount, params.largeRecords);
  for (uint entry = gl_WorkGroupID.x; entry < count; entry += gl_NumWorkGroups.x)
    drawLarge(records[params.mediumRecords + entry].triangle, records[params.mediumRecords + entry].id,
              records[params.mediumRecords + entry].slice, records[params.mediumRecords + entry].slices);
}
