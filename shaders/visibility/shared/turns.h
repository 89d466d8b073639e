// How long a pixel's list may take to decide. Counted in turns of loops, the same on every device, so that what is
// shown undecided is the same as well.
#ifndef GPGP_SHADERS_VISIBILITY_TURNS_H
#define GPGP_SHADERS_VISIBILITY_TURNS_H
#include "core/turns.h"
#include "visibility/shared/layout.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kMostCarried = 28u; ///< entries, from one batch of a long list to the next
GPGP_CONST uint kKeptCarried = 22u; ///< where there would be more

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

/// At most, to decide a batch: each entry may be doubtful, and all others may hide it.
GPGP_FN uint turnsOfBatch(uint n) { return n * (n + 8u) + 96u; }

GPGP_SHADER_END
#endif
