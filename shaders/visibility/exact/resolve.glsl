// Decides a part of a pixel's list, front to back: a workgroup of 32 invocations, each of which holds two of the
// pixel's 64 rows of 64 samples. A triangle with a sample that nothing before it covers is visible.
layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/exact/lists.glsl"
#include "visibility/nearby/nearby.h"
#include "visibility/exact/team.glsl"
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kBindOpen) readonly buffer OpenBuffer { uint open[]; };
#include "visibility/exact/candidates.glsl"
#include "visibility/shared/alpha.glsl"
layout(constant_id = 3) const bool kNonOpaque = false; // some recordings have triangles that are not opaque
layout(std430, set = 0, binding = kBindEntries) readonly buffer EntryBuffer { uint entries[]; };

shared uint items[kBatch]; // candidates of a batch
shared uvec4 keys[kBatch / 4u];
shared vec4 edges[kBatch]; // their outlines, in order: left, right
shared uvec2 thirds[kBatch]; // as bits; the last one says whether it is a left one
shared uint rows[kBatch];    // first and last; parallax
/// With kNonOpaque: pixel, candidate, its draw's flags; 0: it is opaque. One more than there are: glslang would make it
/// of the type of a uniform array as long, whose layout shared memory must not have.
shared uvec4 opens[kBatch + 1u];

/// Bits: which of 32 columns lie before one, for those from 32 before the first to 64 behind it. Two reads of it are
/// faster than what makes a mask.
shared uint columnsBefore[97];

/// Once by each workgroup; sync() follows before it is used.
void makeColumns() {
  for (uint i = laneOf(); i < 97u; i += kBatch) columnsBefore[i] = bitsFrom(0, clamp(int(i) - 32, 0, 32));
}
/// What bitRange says.
uvec2 samplesOf(ivec2 span) {
  return uvec2(columnsBefore[span.y + 32] & ~columnsBefore[span.x + 32],
               columnsBefore[span.y] & ~columnsBefore[span.x]);
}

bool isShown(uint id) { return (bits[id >> 5u] & (1u << (id & 31u))) != 0u; }
void show(uint id) {
  if (!isShown(id)) atomicOr(bits[id >> 5u], 1u << (id & 31u));
}

Outline outlineIn(Candidate c, ivec2 pixel) { return outlineOf(c, pixel, float(max(params.width, params.height))); }

/// Where entries have the same depth: by number, then place; the last only tells CPU references apart.
bool precedes(uint first, uint second, bool otherwise) {
  Candidate a = readCandidate(first);
  Candidate b = readCandidate(second);
  if (a.id != b.id) return a.id < b.id;
  if (a.p1.x != b.p1.x) return a.p1.x < b.p1.x;
  if (a.p1.y != b.p1.y) return a.p1.y < b.p1.y;
  return otherwise;
}

void setKey(uint i, uint key) { keys[i >> 2u][i & 3u] = key; }
uint keyAt(uint i) { return keys[i >> 2u][i & 3u]; }

/// How many of `n` entries from `first` on, whose keys are there, are nearer than one of them; first: a multiple of 4.
/// Keys up to the next multiple are kFarthest.
uint rankOf(uint i, uint first, uint n) {
  uint key = keyAt(i);
  uint before = 0u;
  for (uint j = first; j < first + n; j += 4u) {
    uvec4 other = keys[j / 4u];
    before += uint(other.x < key) + uint(other.y < key) + uint(other.z < key) + uint(other.w < key);
  }
  return before;
}

/// How many of those of the same depth come before it.
uint rankAmongSame(uint i, uint first, uint n) {
  uint key = keyAt(i);
  uint before = 0u;
  for (uint j = first; j < first + n; ++j)
    if (keyAt(j) == key && j != i && precedes(items[j], items[i], j < i)) ++before;
  return before;
}

/// The place of this invocation's entry in the order of `n` from `first` on, whose items and keys are there.
uint placeAmong(bool isThere, uint first, uint n) {
  uint lane = laneOf();
  sync();
  uint place = isThere ? first + rankOf(lane, first, n) : 0u;
  uint taken = orAll(isThere ? 1u << place : 0u);
  if (bitCount(taken) != bitCount(lanesWith(isThere))) { // some have the same
    if (isThere) place += rankAmongSame(lane, first, n);
  }
  sync();
  return place;
}

/// Whether the recording asks, too, what a move would uncover; by how many samples it moves an entry of a pixel's list
/// against what is nearest there.
vec4 depthScaleIn(ivec2 pixel) {
  return params.depthScales[params.cameraCount == 1u ? 0u : uint(pixel.y) / params.height];
}
bool movesIn(ivec2 pixel) { return depthScaleIn(pixel).z != 0.0; }
int parallaxIn(ivec2 pixel, uint nearest, uint own, uint place) {
  return parallaxOf(depthScaleIn(pixel), nearest, own, place, params.reversedDepth != 0u);
}

void put(uint place, Outline o, int parallax) {
  edges[place] = vec4(o.left, o.right);
  thirds[place] = floatBitsToUint(o.third) | uvec2(0u, o.isThirdLeft ? 1u : 0u); // a step's last bits are zero
  rows[place] = uint(o.rowBegin) | uint(o.rowEnd) << 8u | uint(parallax) << 16u;
}
int parallaxAt(uint place) { return int(rows[place] >> 16u); }

Outline outlineAt(uint place) {
  Outline o;
  o.left = edges[place].xy;
  o.right = edges[place].zw;
  uvec2 third = thirds[place];
  o.third = uintBitsToFloat(third & uvec2(0xffffffffu, ~1u));
  o.isThirdLeft = (third.y & 1u) != 0u;
  o.rowBegin = int(rows[place] & 255u);
  o.rowEnd = int(rows[place] >> 8u & 255u);
  return o;
}

void putOpen(uint place, uint item, ivec2 pixel) {
  if (kNonOpaque)
    opens[place] = uvec4(uvec2(pixel), item, isNonOpaqueCandidate(item) ? nonOpaqueFlags(item) : 0u);
}
bool hidesNothing(uint place) { return kNonOpaque && isSeeThrough(opens[place].w); }

bool isNone(uvec4 v) { return (v.x | v.y | v.z | v.w) == 0u; }

#ifdef GPGP_ALPHA_TESTS
uint testedRow(uint asked, NonOpaque cut, ivec2 first) {
  uint test = alphaTestOf(cut.flags);
  uint passed = 0u;
  for (; asked != 0u; asked &= asked - 1u) {
    int column = findLSB(asked);
    if (passesAlpha(test, cut.plane, first + ivec2(column * 4, 0))) passed |= 1u << uint(column);
  }
  return passed;
}
#endif

/// Of samples in the rows of this invocation, those at which the texture of a triangle lets it be.
uvec4 tested(uint place, uvec4 asked) {
#ifdef GPGP_ALPHA_TESTS
  uvec4 own = opens[place];
  if (alphaTestOf(own.w) == 0u || isNone(asked)) return asked;
  NonOpaque cut = readNonOpaque(own.z);
  ivec2 first = ivec2(own.xy) * 256 + ivec2(2, 2 + int(laneOf()) * 4);
  return uvec4(testedRow(asked.x, cut, first), testedRow(asked.y, cut, first + ivec2(128, 0)),
               testedRow(asked.z, cut, first + ivec2(0, 128)), testedRow(asked.w, cut, first + ivec2(128, 128)));
#else
  return asked;
#endif
}

/// What a batch shows.
struct Looked {
  uint seen;  // bits: places
  bool holes; // samples that nothing covers yet
};

/// The samples of an outline in the rows of this invocation.
uvec4 samplesOf(Outline o) {
  int row = int(laneOf());
  return uvec4(samplesOf(spanIn(o, row)), samplesOf(spanIn(o, row + 32)));
}

/// Of samples in the rows of this invocation, those that an entry covers.
uvec4 ownAmong(uint place, uvec4 asked) { return tested(place, samplesOf(outlineAt(place)) & asked); }
/// And those that it leaves open.
uvec4 openBehind(uint place, uvec4 asked) { return hidesNothing(place) ? asked : asked & ~ownAmong(place, asked); }

/// Bits: places of entries that move and have a sample near that none before them covers.
uint lookAround(uint first, uint n, uvec4 uncovered) {
  int row = int(laneOf());
  uint found = 0u;
  for (uint k = first; k < first + n && !isNone(uncovered); ++k) {
    Outline o = outlineAt(k);
    int parallax = parallaxAt(k);
    if (parallax != 0) {
      uvec4 shown = uvec4(samplesAround(o, parallax, row), samplesAround(o, parallax, row + 32)) & uncovered;
      if (!isNone(tested(k, shown))) found |= 1u << k;
    }
    uncovered = openBehind(k, uncovered);
  }
  return found;
}

/// Goes through `n` entries from `first` on, whose outlines are there; `moves`: some have a parallax.
Looked lookAtBatch(uint first, uint n, bool moves, inout uvec4 uncovered) {
  sync();
  uint found = moves ? lookAround(first, n, uncovered) : 0u;
  for (uint k = first; k < first + n && !isNone(uncovered); ++k) {
    uvec4 own = ownAmong(k, uncovered);
    if (!isNone(own)) found |= 1u << k;
    if (!hidesNothing(k)) uncovered &= ~own;
  }
  Looked looked;
  looked.seen = orAll(found);
  looked.holes = lanesWith(!isNone(uncovered)) != 0u;
  return looked;
}
