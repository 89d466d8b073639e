// One workgroup a triangle of up to 64 pixels' extent: its pixels are shared out.
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

layout(std430, set = 0, binding = kBindCounters) readonly buffer CounterBuffer { Counters counters; };

void main() {
  uint count = min(counters.mediumCount, params.mediumRecords);
  for (uint entry = gl_WorkGroupID.x; entry < count; entry += gl_NumWorkGroups.x) {
    ScreenTriangle t = records[entry].triangle;
    uint id = records[entry].id;
    int margin = marginOf(t, grid().margin);
    int width = t.bounds.z - t.bounds.x;
    int pixels = width * (t.bounds.w - t.bounds.y);
    for (int i = int(gl_LocalInvocationIndex); i < pixels; i += 64) {
      ivec2 pixel = t.bounds.xy + ivec2(i % width, i / width);
      float z;
      if (coversCompact(t, margin, samplePoint(pixel, grid()), z)) coverPixel(t, true, pixel, z, id);
    }
  }
}
