// An engine's vertex shader, in HLSL: unit meshes placed by compact instances.
#define GPGP_HLSL 1
StructuredBuffer<uint4> instances : register(t0);
#define GPGP_COMPACT_LOAD(index) instances[index]
#include "gpgp/shaders/compact_instance.h"
cbuffer Camera : register(b1) { float4x4 viewProjection; }
struct Out {
  float4 position : SV_Position;
  float3 normal : NORMAL;
};

Out main(float3 position : POSITION, float3 normal : NORMAL, uint number : SV_InstanceID) {
  const GpgpCompact instance = gpgpCompactInstance(number);
  Out made;
  made.normal = normalize(gpgpCompactNormal(instance, normal));
  made.position = mul(viewProjection, float4(gpgpCompactPoint(instance, position), 1));
  return made;
}
