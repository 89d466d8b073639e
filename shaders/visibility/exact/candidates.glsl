// Candidates as they lie in their buffer: four vectors each, so that one takes four loads. Needs candidate.h.
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
  r.id = d.w;
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

uint candidateId(uint i) { return candidates[i * 4u + 3u].w; }
