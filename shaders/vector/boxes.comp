#version 460
// The box, in pixels, of each group of consecutive patches.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
layout(local_size_x = 64) in;
shared vec4 boxes[kPatchGroup];

void main() {
  const uint lane = gl_LocalInvocationID.x;
  const uint i = gl_WorkGroupID.x * kPatchGroup + lane;
  vec4 box = vec4(3e38, 3e38, -3e38, -3e38);
  if (i < header.patchCount) {
    const PatchRecord p = patches[i];
    const ItemRecord item = items[p.item];
    for (uint corner = 0; corner < 4; ++corner) {
      const vec2 at = vec2((corner & 1) != 0 ? p.x1 : p.x0, (corner & 2) != 0 ? p.bottom : p.top);
      const vec2 pixel = item.transform.xy * at.x + item.transform.zw * at.y + item.offsets.zw;
      box = vec4(min(box.xy, pixel), max(box.zw, pixel));
    }
    box += vec4(-1, -1, 1, 1); // far more than rounding
  }
  boxes[lane] = box;
  barrier();
  for (uint step = kPatchGroup / 2; step > 0; step /= 2) {
    if (lane < step)
      boxes[lane] = vec4(min(boxes[lane].xy, boxes[lane + step].xy), max(boxes[lane].zw, boxes[lane + step].zw));
    barrier();
  }
  if (lane == 0) groupBoxes[gl_WorkGroupID.x] = boxes[0];
}
