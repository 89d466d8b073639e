// How long a pixel's list may take to decide. Counted in turns of loops, the same on every device, so that what is
// shown undecided is the same as well.
#ifndef GPGP_SHADERS_VISIBILITY_TURNS_H
#define GPGP_SHADERS_VISIBILITY_TURNS_H
#include "visibility/candidate.h"

GPGP_SHADER_BEGIN

/// After so many, what is left of a list is shown. Lavapipe ends a shader's loops silently after 65 535.
GPGP_CONST uint kMostTurns = 60000u;

/// To go once through a list, an invocation an entry.
GPGP_FN uint turnsThrough(uint size) { return (size + kBatch - 1u) / kBatch; }

/// Entries of a list whose samples are drawn before it is asked whether those that follow are hidden: going through the
/// list for so few that this takes longer than drawing saves nothing.
GPGP_FN uint drawnAtOnce(uint size) { return max(size / 8u, kBatch); }

/// At most, to draw a triangle into half a row of 64 samples.
GPGP_FN uint turnsOfDrawing(ScreenTriangle t) {
  ivec4 samples = samplesAbout(t);
  return 2u + uint(min(samples.z - samples.x + 1, 32));
}

/// At most, to decide a batch: each entry may be doubtful, and all others may hide it.
GPGP_FN uint turnsOfBatch(uint n) { return n * (n + 3u) + 64u; }

GPGP_SHADER_END
#endif
