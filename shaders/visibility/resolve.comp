// A workgroup decides a pixel's list, front to back: its 32 invocations hold two of the pixel's 64 rows of 64 samples
// each. A triangle with a sample that nothing before it covers is visible.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 32) in; // kBatch

layout(std430, set = 0, binding = kBindParams) readonly buffer ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/lists.glsl"
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kBindOpen) readonly buffer OpenBuffer { uint open[]; };
layout(std430, set = 0, binding = kBindCandidates) readonly buffer CandidateBuffer { Candidate candidates[]; };
layout(std430, set = 0, binding = kBindEntries) readonly buffer EntryBuffer { Entry entries[]; };

shared uint count; // entries that are sorted
shared uint items[kSorted];
shared uint keys[kSorted];
shared uint order[kSorted]; // places in `items`, front to back
shared Outline outlines[kBatch];
shared uint undecided; // a bit for each of a batch's
shared uint seen;
shared uint holes; // 1: samples that nothing covers yet

bool isSeen(uint id) { return (bits[id >> 5u] & (1u << (id & 31u))) != 0u; }

/// Where entries have the same depth: by number, then place; the last only tells twins apart.
bool precedes(uint i, uint j) {
  uint a = entries[i].candidate;
  uint b = entries[j].candidate;
  if (candidates[a].id != candidates[b].id) return candidates[a].id < candidates[b].id;
  if (candidates[a].p1.x != candidates[b].p1.x) return candidates[a].p1.x < candidates[b].p1.x;
  if (candidates[a].p1.y != candidates[b].p1.y) return candidates[a].p1.y < candidates[b].p1.y;
  return i < j;
}

/// How many entries' keys lie in a range, both ends included.
uint countKeys(uint begin, uint end, uint low, uint high) {
  if (gl_LocalInvocationIndex == 0u) count = 0u;
  barrier();
  uint own = 0u;
  for (uint i = begin + gl_LocalInvocationIndex; i < end; i += kBatch) {
    uint key = entries[i].key;
    if (key >= low && key <= high) ++own;
  }
  if (own != 0u) atomicAdd(count, own);
  barrier();
  uint all_ = count;
  barrier();
  return all_;
}

/// The farthest key up to which there are at most kSorted entries from `low` on; false where its own are more.
bool lastKey(uint begin, uint end, uint low, out uint high) {
  high = kFarthest;
  if (end - begin <= kSorted) return true;
  high = 0u;
  for (int bit = 31; bit >= 0; --bit) {
    uint tried = high | (1u << uint(bit));
    if (tried < low || countKeys(begin, end, low, tried) <= kSorted) high = tried;
  }
  return high >= low && countKeys(begin, end, low, high) <= kSorted;
}

void sortEntries(uint begin, uint end, uint low, uint high) {
  uint lane = gl_LocalInvocationIndex;
  if (lane == 0u) count = 0u;
  barrier();
  for (uint i = begin + lane; i < end; i += kBatch) {
    uint key = entries[i].key;
    if (key < low || key > high) continue;
    uint place = atomicAdd(count, 1u);
    items[place] = i;
    keys[place] = key;
  }
  barrier();
  for (uint i = lane; i < count; i += kBatch) {
    uint key = keys[i];
    uint before = 0u;
    for (uint j = 0u; j < count; ++j) {
      uint other = keys[j];
      if (other < key || (other == key && j != i && precedes(items[j], items[i]))) ++before;
    }
    order[before] = i;
  }
  barrier();
}

/// Goes through the sorted entries; false once all samples are covered.
bool resolve(uint slot, inout uvec4 covered) {
  uint lane = gl_LocalInvocationIndex;
  ivec2 first = pixelOf(slot) * 256;
  int y0 = int(lane) * 4 + 2;
  int y1 = y0 + 128;
  uint sorted = count;
  for (uint base = 0u; base < sorted; base += kBatch) {
    uint batch = min(sorted - base, kBatch);
    if (lane == 0u) {
      undecided = 0u;
      seen = 0u;
      holes = 0u;
    }
    barrier();
    uint id = 0u;
    if (lane < batch) {
      Candidate c = candidates[entries[items[order[base + lane]]].candidate];
      id = c.id;
      outlines[lane] = outlineOf(c, first);
      if (!isSeen(id)) atomicOr(undecided, 1u << lane);
    }
    barrier();
    uint wanted = undecided;
    uint found = 0u;
    for (uint k = 0u; k < batch; ++k) {
      Outline c = outlines[k];
      bool asked = (wanted & (1u << k)) != 0u;
      if (reachesRow(c, y0)) {
        vec2 range = rowRange(c, y0);
        if (asked) {
          uvec2 own = samplesIn(range, 0.0f) & ~covered.xy;
          if ((own.x | own.y) != 0u) found |= 1u << k;
        }
        covered.xy |= samplesIn(range, kSeam);
      }
      if (reachesRow(c, y1)) {
        vec2 range = rowRange(c, y1);
        if (asked) {
          uvec2 own = samplesIn(range, 0.0f) & ~covered.zw;
          if ((own.x | own.y) != 0u) found |= 1u << k;
        }
        covered.zw |= samplesIn(range, kSeam);
      }
    }
    if (found != 0u) atomicOr(seen, found);
    if ((covered.x & covered.y & covered.z & covered.w) != 0xffffffffu) holes = 1u;
    barrier();
    if ((seen & (1u << lane)) != 0u) atomicOr(bits[id >> 5u], 1u << (id & 31u));
    bool done = holes == 0u;
    barrier();
    if (done) return false;
  }
  return true;
}

/// A pixel with more than kSorted entries of one and the same depth shows those that are left.
void showRest(uint begin, uint end, uint low) {
  for (uint i = begin + gl_LocalInvocationIndex; i < end; i += kBatch) {
    uint id = candidates[entries[i].candidate].id;
    if (entries[i].key < low || isSeen(id)) continue;
    atomicOr(bits[id >> 5u], 1u << (id & 31u));
    atomicAdd(counters.unresolved, 1u);
  }
}

void main() {
  uint pixels = counters.openCount;
  for (uint i = gl_WorkGroupID.x; i < pixels; i += gl_NumWorkGroups.x) {
    uint slot = open[i];
    uint begin = slots[slot];
    uint end = begin + slots[lengthAt(slot)];
    uvec4 covered = uvec4(0u);
    uint low = 0u;
    bool more = true;
    while (more) {
      uint high;
      if (!lastKey(begin, end, low, high)) {
        showRest(begin, end, low);
        break;
      }
      sortEntries(begin, end, low, high);
      more = resolve(slot, covered) && high != kFarthest;
      low = high + 1u;
      barrier();
    }
  }
}
