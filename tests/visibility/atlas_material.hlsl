// An engine's shading and display of an atlas, in HLSL.
#define GPGP_HLSL 1
#include "gpgp/shaders/atlas.h"
StructuredBuffer<uint> blocks : register(t0);
StructuredBuffer<uint2> tiles : register(t1);
RWTexture2D<float4> atlas : register(u0);

[numthreads(64, 1, 1)] void main(uint3 group : SV_GroupID, uint lane : SV_GroupIndex) {
  const uint2 tile = tiles[group.x * 4u + lane / 16u];
  const GpgpAtlasTexel texel = gpgpAtlasTexel(blocks[tile.x], blocks[tile.x + 1u], tile.y, lane % 16u, 1u);
  if (!texel.shown) return;
  const float2 at = gpgpAtlasPoint(blocks[tile.x + texel.second], texel.weights, 1u);
  atlas[texel.place] = float4(texel.weights, at.x);
}
