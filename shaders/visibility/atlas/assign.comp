// One invocation a triangle: the n-th request of a class takes the n-th free place, in the order of superblocks, then
// of the new ones. Writes the engine's blocks and lists, and counts what is to be shaded.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/atlas/buffers.glsl"
layout(local_size_x = 256) in;

layout(std430, set = 0, binding = kAtlasBuckets) readonly buffer BucketBuffer { uint buckets[]; };
layout(std430, set = 0, binding = kAtlasShade) readonly buffer ShadeBuffer { uint shade[]; };
layout(std430, set = 0, binding = kAtlasBlocks) writeonly buffer BlockBuffer { uint blocks[]; };
layout(std430, set = 0, binding = kAtlasNew) writeonly buffer NewBuffer { uint newList[]; };
layout(std430, set = 0, binding = kAtlasChanged) writeonly buffer ChangedBuffer { uint changedList[]; };
layout(std430, set = 0, binding = kAtlasGone) writeonly buffer GoneBuffer { uint goneList[]; };

#define RANKED_ROWS 26u // kRowTiles
#include "visibility/atlas/ranks.glsl"
#include "visibility/atlas/buckets.glsl"

shared uint counts[kMaxBuckets * kClasses];
shared bool changes[4]; // whether a round has any to rank

/// The superblock and place of a request that takes free place number n of those before new superblocks.
uvec2 freePlace(uint class_, uint n) {
  uint list = (class_ - kMinClass + 1u) * kMaxSupers;
  uint low = 0u;
  uint high = counters.classSupers[class_ - kMinClass + 1u] - 1u;
  for (uint i = 0u; i < 13u; ++i) { // the last one with so few free places before it has some
    if (low >= high) break;
    uint middle = low + (high - low + 1u) / 2u;
    if (lists[list + middle].y <= n) low = middle;
    else high = middle - 1u;
  }
  uint super = lists[list + low].x;
  n -= lists[list + low].y;
  uint words = (placesIn(class_) + 31u) / 32u;
  uint mask = placeBits(class_);
  for (uint word = 0u; word < words; ++word) {
    uint used = supers[superAt(super) + 2u + word] | ~mask;
    uint free = 32u - uint(bitCount(used));
    if (n < free) return uvec2(super, word * 32u + freeBit(used, n));
    n -= free;
  }
  return uvec2(super, 0u);
}

uint newState(uint plan, uint request) {
  uint class_ = planClass(plan);
  uint i = class_ - kMinClass;
  uint places = placesIn(class_);
  uvec2 at;
  if (counters.repacked != 0u) {
    at = uvec2(counters.firstNew[i] + request / places, request % places);
  } else if (request < counters.classFree[i + 1u]) {
    at = freePlace(class_, request);
  } else {
    request -= counters.classFree[i + 1u];
    at = uvec2(lists[counters.firstNew[i] + request / places].x, request % places);
  }
  return makeState(at.x, at.y, class_, plan & kPlanDesired);
}

bool isWanted(uint triangle) {
  return triangle < params.triangleCount && (shade[triangle >> 5u] & (1u << (triangle & 31u))) != 0u;
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  bool repacked = counters.repacked != 0u;
  for (uint i = lane; i < kMaxBuckets * kClasses; i += 256u) counts[i] = 0u;
  if (lane < 4u) changes[lane] = false;
  if (lane < kRowTiles) rowStart[lane] = rows[rowAt(lane, gl_WorkGroupID.x)];
  barrier();
  for (uint round = 0u; round < 4u; ++round) {
    uint triangle = gl_WorkGroupID.x * kAtlasGroup + round * 256u + lane;
    bool there = triangle < params.maxTriangles;
    uint plan = there ? plans[triangle] : 0u;
    uint class_ = planClass(plan);
    bool moves = class_ != 0u && (repacked || (plan & kPlanKeeps) == 0u);
    uint list = there ? listOf(plan) : kMaxRows;
    if (repacked && list == kRowKept) list = kRowChanged;
    uint row = (repacked ? kRowAll : kRowRequests) + class_ - kMinClass;
    clearRanks(kRowTiles, lane);
    if (moves || list != kMaxRows) changes[round] = true;
    barrier();
    bool ranked = changes[round];
    if (ranked) {
      if (moves) enterRank(row, lane);
      if (list != kMaxRows) enterRank(list, lane);
      barrier();
    }
    if (there) {
      uint state = history[stateAt(triangle)];
      uint next = state;
      if (moves) next = newState(plan, rowStart[row] + rankOf(row, lane));
      else if (class_ != 0u) next = makeState(superOf(state), placeOf(state), class_, plan & kPlanDesired);
      else if ((plan & kPlanVisible) != 0u) next = makeState(0u, 0u, 0u, plan & kPlanDesired);
      else next = 0u;
      if (next != state) history[stateAt(triangle)] = next;
      uint code = codeIn(history[codeAt(triangle)], triangle);
      if (triangle < params.triangleCount && (code == 0u || triangle % 2u == 0u)) {
        blocks[triangle] = blockWord(next, params.superColumns, firstCorner(code), 0u);
        if (code != 0u && triangle + 1u < params.triangleCount)
          blocks[triangle + 1u] = blockWord(next, params.superColumns, secondCorner(code), 1u);
      }
      uint at = list != kMaxRows ? rowStart[list] + rankOf(list, lane) : 0u;
      if (repacked && list == kRowChanged) at += rows[rowAt(kRowKept, gl_WorkGroupID.x)];
      if (list == kRowNew && at < params.newCapacity) newList[at] = triangle;
      if (list == kRowChanged && at < params.changedCapacity) changedList[at] = triangle;
      if (list == kRowGone && at < params.goneCapacity) goneList[at] = triangle;
      if (class_ != 0u) {
        bool again = list != kRowKept || params.hasShade == 0u || isWanted(triangle) ||
                     ((plan & kPlanPaired) != 0u && isWanted(triangle + 1u));
        if (again) {
          plans[triangle] = plan | kPlanShade;
          atomicAdd(counts[bucketOf(triangle) * kClasses + class_ - kMinClass], 1u);
        }
      }
    }
    if (ranked) {
      barrier();
      advanceRanks(kRowTiles, lane);
      barrier();
    }
  }
  for (uint i = lane; i < params.bucketCount * kClasses; i += 256u)
    rows[rowAt(kRowTiles + i, gl_WorkGroupID.x)] = counts[i];
}
