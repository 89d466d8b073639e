// An engine's draw of its own, in HLSL: the part of a pixel that a quad paints, and its samples.
#define GPGP_HLSL 1
StructuredBuffer<uint4> patches : register(t0);
#define GPGP_PATCH_LOAD(slot, index) patches[index]
#include "gpgp/shaders/patch_quads.h"

float4 main(float2 at : TEXCOORD0, nointerpolation uint number : QUAD, out uint mask : SV_Coverage) : SV_Target {
  const GpgpPatchQuad quad = gpgpUnpackQuad(patches[patches[1].x + number]);
  const GpgpPatchPath path = gpgpLoadPath(0u, 0u, quad.path);
  const float2 origin = float2(0, 0), dx = ddx(at), dy = ddy(at);
  mask = gpgpQuadMask(0u, path, quad, origin, at, dx, dy, 4u);
  return path.color * gpgpQuadCoverage(0u, path, quad, origin, at, dx, dy);
}
