#version 460
// One operation, an invocation a pixel of its result. OPERATIONS: which kinds the shader knows: 0 composite, 1 blur,
// 2 colours, 3 neighbourhoods, 4 noise, 5 light.
#extension GL_GOOGLE_include_directive : require
#include "vector/layers/layers.glsl"
#include "vector/layers/operate.h"
layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  const OperationRecord o = operations[operationIndex];
  const int x = o.result.left + int(gl_GlobalInvocationID.x), y = o.result.top + int(gl_GlobalInvocationID.y);
  if (x >= o.result.right || y >= o.result.bottom) return;
#if OPERATIONS == 0
  const vec4 color = compositeAt(o, x, y);
#elif OPERATIONS == 1
  vec4 color;
  if (o.kind == kOperationBlur) color = blurAt(o, x, y);
  else if (o.kind == kOperationShrink) color = shrinkAt(o, x, y);
  else color = growAt(o, x, y);
#elif OPERATIONS == 2
  const vec4 color = colorAt(o, x, y) * inRegion(o, x, y);
#elif OPERATIONS == 3
  const vec4 color = neighbourhoodAt(o, x, y) * inRegion(o, x, y);
#elif OPERATIONS == 4
  const vec4 color = noiseAt(o, x, y) * inRegion(o, x, y);
#else
  const vec4 color = lightAt(o, x, y) * inRegion(o, x, y);
#endif
  storeTexel(o.result, x, y, color);
}
