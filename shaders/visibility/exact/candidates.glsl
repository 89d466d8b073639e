// Candidates as they lie in their buffer: four vectors each, so that one takes four loads. What is not opaque takes the
// room of two: behind it lies where it is. Needs candidate.h.
#include "visibility/shared/texture.h"
layout(std430, set = 0, binding = kBindCandidates) buffer CandidateBuffer { uvec4 candidates[]; };

Candidate readCandidate(uint i) {
  uvec4 a = candidates[i * 4u];
  uvec4 b = candidates[i * 4u + 1u];
  uvec4 c = candidates[i * 4u + 2u];
  uvec4 d = candidates[i * 4u + 3u];
  Candidate r;
  r.p0 = ivec2(a.xy);
  r.p1 = ivec2(a.zw);
  r.p2 = ivec2(b.xy);
  r.z0 = uintBitsToFloat(b.z);
  r.dz1 = uintBitsToFloat(b.w);
  r.dz2 = uintBitsToFloat(c.x);
  r.zMin = uintBitsToFloat(c.y);
  r.zMax = uintBitsToFloat(c.z);
  r.inverseArea = uintBitsToFloat(c.w);
  r.slope0 = uintBitsToFloat(d.x);
  r.slope1 = uintBitsToFloat(d.y);
  r.slope2 = uintBitsToFloat(d.z);
  r.id = d.w & ~kIsNonOpaque;
  return r;
}

void writeCandidate(uint i, Candidate r) {
  candidates[i * 4u] = uvec4(uvec2(r.p0), uvec2(r.p1));
  candidates[i * 4u + 1u] = uvec4(uvec2(r.p2), floatBitsToUint(r.z0), floatBitsToUint(r.dz1));
  candidates[i * 4u + 2u] = uvec4(floatBitsToUint(r.dz2), floatBitsToUint(r.zMin), floatBitsToUint(r.zMax),
                                  floatBitsToUint(r.inverseArea));
  candidates[i * 4u + 3u] =
      uvec4(floatBitsToUint(r.slope0), floatBitsToUint(r.slope1), floatBitsToUint(r.slope2), r.id);
}

uint candidateId(uint i) { return candidates[i * 4u + 3u].w & ~kIsNonOpaque; }

/// Of a candidate that is not opaque: its draw's flags, and where it is on the texture.
struct NonOpaque {
  uint flags;
  TexturePlane plane;
};

bool isNonOpaqueCandidate(uint i) { return (candidates[i * 4u + 3u].w & kIsNonOpaque) != 0u; }
uint nonOpaqueFlags(uint i) { return candidates[i * 4u + 6u].w; }

NonOpaque readNonOpaque(uint i) {
  uvec4 a = candidates[i * 4u + 4u];
  uvec4 b = candidates[i * 4u + 5u];
  uvec4 c = candidates[i * 4u + 6u];
  NonOpaque r;
  r.plane.origin = ivec2(a.w, b.w);
  r.plane.u = uintBitsToFloat(a.xyz);
  r.plane.v = uintBitsToFloat(b.xyz);
  r.plane.w = uintBitsToFloat(c.xyz);
  r.flags = c.w;
  return r;
}

void writeNonOpaque(uint i, NonOpaque r) {
  candidates[i * 4u + 3u].w |= kIsNonOpaque;
  candidates[i * 4u + 4u] = uvec4(floatBitsToUint(r.plane.u), uint(r.plane.origin.x));
  candidates[i * 4u + 5u] = uvec4(floatBitsToUint(r.plane.v), uint(r.plane.origin.y));
  candidates[i * 4u + 6u] = uvec4(floatBitsToUint(r.plane.w), r.flags);
}
