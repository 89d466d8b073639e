// Enters triangles of at most 8 x 8 pixels, an invocation each. All invocations of a workgroup must call it. Needs
// enter.glsl.
shared uint groupCandidates;
shared uint groupPairs;
shared uint firstCandidate;
shared uint firstPair;

/// Which of the 8 x 8 pixels from its bounds' corner on a triangle is to be entered in.
uvec2 wantedPixels(ScreenTriangle t, ivec4 bounds, bool seen) {
  uvec2 mask = uvec2(0u);
  for (int y = bounds.y; y < bounds.w; ++y)
    for (int x = bounds.x; x < bounds.z; ++x) {
      if (!isWanted(t, true, false, ivec2(x, y), seen)) continue;
      uint bit = uint((y - bounds.y) * 8 + x - bounds.x);
      if (bit < 32u) mask.x |= 1u << bit;
      else mask.y |= 1u << (bit - 32u);
    }
  return mask;
}

void enterSmall(ScreenTriangle t, uint id, ivec2 corner, uvec2 mask) {
  if (gl_LocalInvocationIndex == 0u) {
    groupCandidates = 0u;
    groupPairs = 0u;
  }
  barrier();
  uint wanted = uint(bitCount(mask.x) + bitCount(mask.y));
  uint candidate = 0u;
  uint pair = 0u;
  if (wanted != 0u) {
    candidate = atomicAdd(groupCandidates, 1u);
    pair = atomicAdd(groupPairs, wanted);
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u && groupPairs != 0u) {
    firstCandidate = atomicAdd(counters.candidates, groupCandidates);
    firstPair = atomicAdd(counters.pairs, groupPairs);
  }
  barrier();
  if (wanted != 0u) {
    candidate += firstCandidate;
    pair += firstPair;
    if (candidate < params.maxCandidates && pair <= params.maxPairs && wanted <= params.maxPairs - pair) {
      writeCandidate(candidate, makeCandidate(t, id));
      while ((mask.x | mask.y) != 0u) {
        int bit = lowestBit(mask);
        if (bit < 32) mask.x &= mask.x - 1u;
        else mask.y &= mask.y - 1u;
        enter(candidate, corner + ivec2(bit & 7, bit >> 3), pair++);
      }
    } else {
      show(id);
    }
  }
  barrier();
}
