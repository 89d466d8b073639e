// The matrices of a recording's cameras, and draws as they are relative to them. Needs `params`.
#include "visibility/shared/triangle.h"

mat4 viewProjection(uint camera) {
  return mat4(params.viewProjection[camera * 4u], params.viewProjection[camera * 4u + 1u],
              params.viewProjection[camera * 4u + 2u], params.viewProjection[camera * 4u + 3u]);
}

/// 0: all.
uint layersOf(uint camera) { return params.cameraLayers[camera / 4u][camera % 4u]; }

/// Makes a draw's transform relative to a camera's origin; false where the draw names none that is there.
bool seeFrom(inout Draw draw, uint camera) {
  if (params.hasOrigins == 0u) return true;
  bool any = params.originCount != 0u;
  if (any && draw.origin >= params.originCount) return false;
  uint at = draw.origin * 2u;
  vec3 high = any ? params.origins[at].xyz : vec3(0.0);
  vec3 low = any ? params.origins[at + 1u].xyz : vec3(0.0);
  moveDraw(draw,
           originFrom(high, low, params.cameraOrigins[camera * 2u].xyz, params.cameraOrigins[camera * 2u + 1u].xyz));
  return true;
}
