// An engine's material, in HLSL: a drawing on a surface, lit.
#define GPGP_HLSL 1
StructuredBuffer<uint4> patches : register(t0);
#define GPGP_PATCH_LOAD(slot, index) patches[index]
#include "gpgp/shaders/patches.h"

float4 main(float2 at : TEXCOORD0, float3 normal : NORMAL) : SV_Target {
  const float4 paint = gpgpPaintDrawing(0u, 0u, at, ddx(at), ddy(at));
  const float light = max(dot(normalize(normal), float3(0.6, 0.8, 0)), 0.0);
  return float4(lerp(float3(0.3, 0.3, 0.3), float3(0, 0, 0), paint.a) + paint.rgb, 1) * light;
}
