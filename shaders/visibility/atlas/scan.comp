// One workgroup a row: from counts to how many lie before each workgroup's, and the sum.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/atlas/buffers.glsl"
layout(local_size_x = 256) in;

layout(push_constant) uniform Constants { uint firstRow; };

shared uint sums[256];

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint row = firstRow + gl_WorkGroupID.x;
  uint each = (params.groupCount + 255u) / 256u;
  uint begin = min(lane * each, params.groupCount);
  uint end = min(begin + each, params.groupCount);
  uint sum = 0u;
  for (uint i = begin; i < end; ++i) sum += rows[rowAt(row, i)];
  sums[lane] = sum;
  barrier();
  for (uint step_ = 1u; step_ < 256u; step_ *= 2u) {
    uint before = lane >= step_ ? sums[lane - step_] : 0u;
    barrier();
    sums[lane] += before;
    barrier();
  }
  uint start = sums[lane] - sum;
  for (uint i = begin; i < end; ++i) {
    uint count = rows[rowAt(row, i)];
    rows[rowAt(row, i)] = start;
    start += count;
  }
  if (lane == 255u) rows[row] = sums[255];
}
