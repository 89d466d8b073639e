#version 460
// Which samples of a tile each listed patch covers: the implicit forms themselves are asked, at every sample that a
// curve may pass.
//
// A workgroup takes several patches in tiles, each with 32 invocations of two pixels. Pixels that no curve passes are
// decided by themselves; the points of the others are dealt out evenly over the workgroup. Patches of a path are
// disjoint, so their masks are joined in the path's entry before the path is composited. Entries hold changes from
// pixel to pixel, as fill's (layout.h). With exact areas, a pixel that a curve passes is asked at 16 x 16 points.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
const uint kTasks = kFillPatches, kLanes = kTasks * 32, kCurveWords = 4, kNumberWords = kMaxTileCurves / 4;
const uint kTaskWords = kNumberWords + kMaxTileCurves * kCurveWords;
shared uvec4 taskCurves[kTasks * kTaskWords]; // of each task, the numbers of its curves, then these
#define GPGP_PATCH_LOAD(slot, index) taskCurves[index]
#include "vector/patches/items.glsl"
layout(local_size_x = kLanes) in;
layout(set = 0, binding = kBindEntries, std430) buffer Entries { uint entries[]; };
shared uint masks[kTasks * 64], counts[kTasks * 64]; // of each pixel
shared uint open_[kTasks * 64], openWhat[kTasks * 64], openCount;

uint numberOf(uvec4 four, uint k) {
  return (k & 2) == 0 ? ((k & 1) == 0 ? four.x : four.y) : ((k & 1) == 0 ? four.z : four.w);
}

void main() {
  const uint lane = gl_LocalInvocationID.x, task = lane / 32, own = lane % 32;
  const uint i = groupIndex() * kTasks + task;
  const uint total = min(counters.tilePatches, patchTable().limit);
  const bool area = (header.flags & kExactArea) != 0;
  PatchPlaceRecord record = PatchPlaceRecord(~0u, 0, 0, 0);
  if (i < total) record = tilePatches[i];
  const bool drawn = record.path < counters.cutPath;
  uint entry = 0, pixelX = 0, pixelY = 0;
  if (lane == 0) openCount = 0;
  if (drawn) {
    const uint itemIndex = record.what >> kPatchItemBit;
    const uint owner = floatBitsToUint(shapes[patchItemAt(itemIndex) + 6].x);
    const uint curves = floatBitsToUint(shapes[patchItemAt(itemIndex) + 6].w);
    const uint slot = items[owner].slot;
    const PlacedPath p = paths[record.path];
    const uint x = record.place & 0xffff, y = record.place >> 16, bit = x - p.left;
    const TileWord w = words[p.firstWord + (y - p.top) * wordsInRow(p) + bit / 32];
    entry = (w.firstEntry + bitCount(w.edges & ((1u << (bit & 31)) - 1))) * kEntryWords;
    pixelX = x * kTileSize;
    pixelY = y * kTileSize;
    const uint k = own / kCurveWords, word = own % kCurveWords;
    const uint base = task * kTaskWords;
    const uvec4 numbers = floatBitsToUint(fetch(slot, record.record + 1 + k / 4));
    if (own % 16 == 0) taskCurves[base + k / 4] = (numbers & ~kPatchCurvePlace) | (k + uvec4(0, 1, 2, 3)) * kCurveWords;
    if ((record.what & (1u << k)) != 0) {
      const uint number = numberOf(numbers, k), kind = number >> kPatchCurveKind;
      if (word < (kind == kPatchCubic ? 4 : kind + 1))
        taskCurves[base + kNumberWords + own] =
          floatBitsToUint(fetch(slot, curves + (number & kPatchCurvePlace) + word));
    }
  }
  masks[lane * 2] = masks[lane * 2 + 1] = counts[lane * 2] = counts[lane * 2 + 1] = 0;
  barrier();
  PatchItemRecord m;
  TilePatch patch_;
  vec4 scissor = vec4(0);
  const uint all = (1u << SAMPLES) - 1;
  if (drawn) {
    m = patchItem(record.what >> kPatchItemBit);
    const uint slot = items[m.item].slot;
    patch_ = fetchTilePatch(slot, record.record);
    scissor = items[m.item].scissor;
    patch_.place = task * kTaskWords - 1;
    for (uint k = 0; k < 2; ++k) {
      const uint pixel = own * 2 + k;
      const uint what = passesThrough(slot, task * kTaskWords + kNumberWords, patch_, m, scissor,
                                      record.what & kPatchAllPass, float(pixelX + pixel % kTileSize),
                                      float(pixelY + pixel / kTileSize), 1.0);
      if (what == kPatchOutside) continue;
      if (what == 0) {
        masks[task * 64 + pixel] = all;
        counts[task * 64 + pixel] = 256;
      } else {
        const uint at = atomicAdd(openCount, 1);
        open_[at] = task * 64 + pixel;
        openWhat[at] = what;
      }
    }
  }
  barrier();
  const uint points = area ? SAMPLES + 256 : SAMPLES;
  const uint work = openCount * points;
  uint loaded = kTasks;
  for (uint k = lane; k < work; k += kLanes) {
    const uint at = k / points, point = k - at * points, pixel = open_[at], of = pixel / 64;
    if (of != loaded) { // another task's patch
      loaded = of;
      const PatchPlaceRecord other = tilePatches[groupIndex() * kTasks + of];
      m = patchItem(other.what >> kPatchItemBit);
      patch_ = fetchTilePatch(items[m.item].slot, other.record);
      scissor = items[m.item].scissor;
      patch_.place = of * kTaskWords - 1;
      record.place = other.place;
    }
    const uint inTile = pixel % 64;
    const bool isSample = point < SAMPLES;
    const vec2 offset = isSample ? pointOf(SAMPLES, point) : pointOf(256, point - SAMPLES);
    const float x = float((record.place & 0xffff) * kTileSize + inTile % kTileSize) + offset.x;
    const float y = float((record.place >> 16) * kTileSize + inTile / kTileSize) + offset.y;
    if (!patchHolds(0, of * kTaskWords + kNumberWords, patch_, m, scissor, openWhat[at], x, y)) continue;
    if (isSample) atomicOr(masks[pixel], 1u << point);
    else atomicAdd(counts[pixel], 1);
  }
  barrier();
  if (!drawn) return;
  const uint first = masks[lane * 2], second = masks[lane * 2 + 1];
  const uint before = own % 4 == 0 ? 0 : masks[lane * 2 - 1];
  const uint change = (before ^ first) | (first ^ second) << 16;
  if (change != 0) atomicXor(entries[entry + own], change);
  if (!area) return;
  // In 1/256 of a sample: what 256 points say, less what the samples do.
  const int low = int(counts[lane * 2] * SAMPLES) - int(bitCount(first) * 256);
  const int high = int(counts[lane * 2 + 1] * SAMPLES) - int(bitCount(second) * 256);
  if ((low | high) != 0) atomicAdd(entries[entry + kEntryWords / 2 + own], uint(low) + (uint(high) << 16));
}
