// Which decisions of a camera's previous recording an exact recording takes over
// (GpgpCameraHistoryCreateInfo::maxLate).
//
// Triangles form groups of consecutive numbers, and each group has a place on a circle of 2^32 units. A recording
// decides the groups in one arc again, and the next recording's arc begins where this one ends. So every group is
// decided once in each turn, whatever the lengths of the arcs. The length follows from how many triangles of the arc
// changed since they were last decided: half as many are late on the average, because they wait half a turn.
//
// Guarantees: the same arcs on every device. An arc is at least an eighth of the circle, so that no triangle waits
// longer than eight recordings. Where nothing that is sampled differs from the previous recording, either all triangles
// are decided or all decisions of that recording are those of a whole one.
#ifndef GPGP_SHADERS_VISIBILITY_REUSE_H
#define GPGP_SHADERS_VISIBILITY_REUSE_H
#include "visibility/shared/integers.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kReuseGroupWords = 16u;  ///< of 32 triangles each; a group lies together in most meshes
GPGP_CONST uint kReuseAll = 0xffffffffu; ///< an arc's length: all of the circle
GPGP_CONST float kLeastShare = 0.125f;   ///< of the circle
GPGP_CONST float kMostShare = 0.6f;      ///< beyond it an arc saves too little: all is decided
GPGP_CONST float kNotMeasured = -1.0f;   ///< instead of a rate

/// Words of a history behind its arrays of bits (reuse.glsl).
GPGP_CONST uint kReuseArrays = 4u;
GPGP_CONST uint kStateIsValid = 0u;    ///< 0: the previous recording left nothing that can be taken over
GPGP_CONST uint kStateKey = 1u;        ///< Params::reuseKey of the previous recording
GPGP_CONST uint kStateChecksum = 2u;   ///< two words: of all triangles on the screen
GPGP_CONST uint kStateIsSettled = 4u;  ///< 1: its decisions are those of a recording without reuse
GPGP_CONST uint kStateFirst = 5u;      ///< where the next arc begins
GPGP_CONST uint kStateRate = 6u;       ///< float: share of the visible triangles that change in a recording
GPGP_CONST uint kStateTriangles = 7u;  ///< decided or taken over
GPGP_CONST uint kStateUnresolved = 8u; ///< Counters::unresolved
GPGP_CONST uint kStateWords = 12u;

/// Whether the triangles of a word of bits are decided again; share: an arc's length, 0 or kReuseAll.
GPGP_FN bool isDue(uint word, uint first, uint share) {
  return share == kReuseAll || word / kReuseGroupWords * 0x9e3779b9u - first < share;
}

/// Where the arc of the next recording begins.
GPGP_FN uint endOfArc(uint first, uint share) { return share == kReuseAll ? first : first + share; }

GPGP_FN float partOf(uint part, uint whole) {
  if (whole == 0u) return 0.0f;
  GPGP_PRECISE float share = float(part) * reciprocal(float(whole));
  return share;
}

/// The length of an arc after which `maxLate` of the visible triangles are late on the average, where `rate` of them
/// change in each recording: rate * (turn - 1) / 2, with a turn of 1 / share recordings.
GPGP_FN uint shareFor(float rate, float maxLate) {
  if (rate < 0.0f) return kReuseAll;
  GPGP_PRECISE float sum = rate + 2.0f * maxLate;
  GPGP_PRECISE float share = rate * reciprocal(sum);
  return share > kMostShare ? kReuseAll : uint(max(share, kLeastShare) * 4294967296.0f);
}

/// What a recording compares with the previous one.
struct ReuseEvidence {
  bool isValid;   ///< there is one, with the same viewport and numbers
  bool isSame;    ///< what is on the screen is exactly what was
  bool isSettled; ///< kStateIsSettled
  bool mayDiffer; ///< there are textures, whose contents may have changed
  float rate;     ///< kStateRate
  uint seen;      ///< triangles at pixel centres
  uint fresh;     ///< of these, not visible in the previous recording
};

/// The length of a recording's arc; 0: its result is that of the previous recording, all of it. Twice the share of
/// fresh triangles at pixel centres is a rate that is known before anything is decided, so that a jump of the camera
/// is noticed at once; smaller triangles change faster.
GPGP_FN uint shareOf(ReuseEvidence e, float maxLate) {
  if (!e.isValid || (e.isSame && !e.isSettled)) return kReuseAll;
  if (e.isSame && !e.mayDiffer) return 0u;
  return e.rate < 0.0f ? kReuseAll : shareFor(max(e.rate, 2.0f * partOf(e.fresh, e.seen)), maxLate);
}

/// The rate that follows from what an arc has found. changed: its triangles that were late or kept too long, the larger
/// number; visible: its visible triangles. A rate falls by half at most, because small arcs differ by chance.
GPGP_FN float rateAfter(float rate, uint share, uint changed, uint visible, bool isMeasured) {
  if (!isMeasured || share == 0u) return kNotMeasured;
  if (visible == 0u) return rate;
  float turn = share == kReuseAll ? 1.0f : float(share) * (1.0f / 4294967296.0f);
  GPGP_PRECISE float measured = min(partOf(changed, visible), 1.0f) * turn;
  return max(measured, rate * 0.5f);
}

/// Adds a word to two checksums of a triangle.
GPGP_FN uvec2 withWord(uvec2 sum, uint word) {
  uvec2 next = uvec2((sum.x ^ word) * 0x9e3779b1u, (sum.y + word) * 0x85ebca6bu);
  return uvec2(next.x ^ (next.x >> 15u), next.y ^ (next.y >> 13u));
}
GPGP_FN uvec2 withCorner(uvec2 sum, vec4 v) {
  sum = withWord(withWord(sum, floatBitsToUint(v.x)), floatBitsToUint(v.y));
  return withWord(withWord(sum, floatBitsToUint(v.z)), floatBitsToUint(v.w));
}
/// Of one that is on the screen: its number, what it is (a draw's flags, mirrored or not), its corners in clip space.
/// The sums over all of them do not depend on their order.
GPGP_FN uvec2 checksumOf(uint id, uint flags, bool mirrored, vec4 a, vec4 b, vec4 c) {
  uvec2 sum = withWord(withWord(uvec2(0x2545f491u, 0x9e3779b9u), id), flags * 2u + (mirrored ? 1u : 0u));
  return withWord(withCorner(withCorner(withCorner(sum, a), b), c), id);
}

GPGP_SHADER_END
#endif
