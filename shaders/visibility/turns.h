// How long a pixel's list may take to decide. Counted in turns of loops, the same on every device, so that what is
// shown undecided is the same as well.
#ifndef GPGP_SHADERS_VISIBILITY_TURNS_H
#define GPGP_SHADERS_VISIBILITY_TURNS_H
#include "core/turns.h"
#include "visibility/candidate.h"
#include "visibility/layout.h"

GPGP_SHADER_BEGIN

/// To go once through a list, an invocation an entry; and once round the loop that does so.
GPGP_FN uint turnsThrough(uint size) { return size / kBatch + 3u; }
/// At most, as often as a list is gone through up to its next batch: keys of 32 bits are divided by 64 at a time, which
/// may have to begin again by number; entries are taken each time; and what is left is shown.
GPGP_CONST uint kMostPasses = 17u;
/// Whether a list could take more turns than there are before another batch is decided, so that what is left of it is
/// shown. turns: of it so far.
GPGP_FN bool takesTooLong(uint turns, uint size) {
  return turns + kMostPasses * turnsThrough(size) > kDeviceTurns - 512u - 2048u; // a batch, and what each list takes
}

/// Entries of a list whose samples are drawn before it is asked whether those that follow are hidden: going through the
/// list for so few that this takes longer than drawing saves nothing.
GPGP_FN uint drawnAtOnce(uint size) { return max(size / 8u, kBatch); }

/// At most, to draw a triangle into half a row of 64 samples: its own turn, its samples, and the ends of the loops over
/// these, of which there are two.
GPGP_FN uint turnsOfDrawing(ScreenTriangle t) {
  ivec4 samples = samplesAbout(t);
  return 3u + uint(min(samples.z - samples.x + 1, 32));
}
/// To find the triangles of a list that are drawn next, 32 at a time, and to see how far what there is reaches then.
GPGP_FN uint turnsOfDraws(uint size) { return 2u * turnsThrough(size) + 34u; }
/// To begin and to end 16 rows.
GPGP_CONST uint kTurnsOfRows = 68u;
/// Whether so many leave none to show the list.
GPGP_FN bool tookTooLong(uint turns, uint size) { return turns + turnsThrough(size) > kDeviceTurns - 2048u; }

/// At most, to decide a batch: each entry may be doubtful, and all others may hide it.
GPGP_FN uint turnsOfBatch(uint n) { return n * (n + 6u) + 64u; }

GPGP_SHADER_END
#endif
