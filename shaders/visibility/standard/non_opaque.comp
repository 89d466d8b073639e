// Triangles of alpha-tested and of see-through draws: kNonOpaqueSplit workgroups each, which make them again.
//
// Those that hide what is behind them are drawn like others, where the texture lets them be. Those that hide nothing
// are not drawn: once all depths are there, they are visible at each sample that shows nothing nearer.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_INT64_ATOMICS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#endif
#include "visibility/shared/fetch.glsl"
#include "visibility/shared/texture.glsl"
#include "visibility/shared/alpha.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kPhase = 0u; // 0: depth, 1: ids, 2: what hides nothing

layout(std430, set = 0, binding = kBindQueue) readonly buffer QueueBuffer { uint queue[]; };
layout(std430, set = 0, binding = kBindCounters) readonly buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kBindSizes) buffer SizeBuffer { uint sizes[]; };
layout(std430, set = 0, binding = kBindSamples) buffer SampleBuffer { uint samples[]; };
#ifdef GPGP_INT64_ATOMICS
layout(std430, set = 0, binding = kBindSamples) buffer WholeSampleBuffer { uint64_t wholeSamples[]; };
#endif

// Of the triangle.
uint test;
TexturePlane plane;

void note(uint id) {
  if ((bits[id >> 5u] & (1u << (id & 31u))) == 0u) atomicOr(bits[id >> 5u], 1u << (id & 31u));
  if (params.hasSizes == 0u) return;
  if (atomicAdd(sizes[id], 1u) == 0xffffffffu) atomicMax(sizes[id], 0xffffffffu);
}

void coverPixel(ScreenTriangle t, bool compact, ivec2 pixel, float z, uint id) {
  uint at = uint(pixel.y) * (params.width << (8u - params.gridShift)) + uint(pixel.x);
  uint key = depthKey(z, params.reversedDepth != 0u);
  uint nearest = samples[depthAt(at)];
  if (kPhase == 1u ? nearest != key : nearest < key) return;
  if (!passesAlpha(test, plane, samplePoint(pixel, grid()))) return;
  if (kPhase == 2u) {
    note(id);
    return;
  }
#ifdef GPGP_INT64_ATOMICS
  atomicMin(wholeSamples[at], packUint2x32(uvec2(id, key)));
#else
  if (kPhase == 0u) atomicMin(samples[depthAt(at)], key);
  else atomicMin(samples[idAt(at)], id);
#endif
}
#include "visibility/standard/blocks.glsl"

void main() {
  uint count = min(counters.nonOpaque, params.maxNonOpaque);
  for (uint entry = gl_WorkGroupID.x; entry < count; entry += gl_NumWorkGroups.x) {
    uint number = queue[params.nonOpaqueAt + entry];
    uint item;
    Fetched f = fetchNumber(number, item);
    if (isSeeThrough(f.flags) != (kPhase == 2u)) continue;
    uint id = kPhase == 2u ? f.id : drawnId(f.id, item);
    ScreenTriangle t;
    uint fate = classifyFetched(f, t);
    test = alphaTestOf(f.flags);
    uvec2 place = placeOfNumber(number);
    if (test != 0u) plane = fetchTexturePlane(f, place.x, place.y, textureOrigin(t, fate, f.camera));
    if (fate == kWhole) drawLarge(t, id, gl_WorkGroupID.y, kNonOpaqueSplit);
    if (fate != kClipped) continue;
    ScreenPolygon polygon;
    if (clipTriangle(f.a, f.b, f.c, gridOf(f.camera), f.mirrored, f.twoSided, polygon) != kClipped) continue;
    for (int k = 0; k + 2 < polygon.count; ++k)
      if (fanPiece(polygon, k, gridOf(f.camera), t)) drawLarge(t, id, gl_WorkGroupID.y, kNonOpaqueSplit);
  }
}
