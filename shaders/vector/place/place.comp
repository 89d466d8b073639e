#version 460
// Where each path lies on the canvas, its colour, room for the words of its tiles, and its bit in the bins that it may
// touch.
//
// Room is taken in any order. Where not all paths fit, the workgroup that finishes last deals it out again in painting
// order, and from the first path that does not fit on all are left out.
#extension GL_GOOGLE_include_directive : require
#define SHARING coherent
#include "vector/shared/canvas.glsl"
#include "vector/shared/color.h"
#include "vector/raster/image_colors.glsl"
layout(local_size_x = 64) in;
#include "vector/shared/scan.glsl"
shared bool last;
const uint kFewBins = 4; // more are dealt out to the workgroup
shared uint wide[64], wideCount;
shared uvec4 wideBins[64]; // left, top, right, bottom, exclusive

// A path that paints with an image gets a place for its colours. One without room paints nothing.
void storeImage(uint slot, uint path, inout PlacedPath p) {
  const uint record = p.paint & ~kPaintsTriangle;
  if (record == 0 || floatBitsToUint(fetch(slot, record + 1)).y < kPaintImage) return;
  const uint tiles = (p.right - p.left) * (p.bottom - p.top);
  const bool counted = counters.imageTiles < 1u << 30; // beyond, no sum is of use
  const uint first = counted ? atomicAdd(counters.imageTiles, tiles) : ~0u;
  if (first > header.imageTiles || tiles > header.imageTiles - first) {
    atomicAdd(counters.imagesDropped, 1);
    p.color = vec4(0);
    return;
  }
  const uint which = atomicAdd(counters.storedImages, 1);
  imageHeads[which] = uvec4(path, p.paint, first, 0);
  p.paint = (p.paint & kPaintsTriangle) | kPaintsStored | which;
}

const uint kGrouped = 0x80000000u; // beside a path's number: it may need the general shader (lists.glsl)

// Every step-th bin of a row from x on, of every step-th row from y on.
void setBins(uint which, uvec4 box, uint x, uint y, uint step) {
  const uint path = which & ~kGrouped;
  for (uint row = box.y + y; row < box.w; row += step)
    for (uint column = box.x + x; column < box.z; column += step) {
      const uint bits = bitsOf(row * header.binsX + column);
      atomicOr(bins[bits + path / 32], 1u << (path & 31));
      if (which != path) bins[bits - kBinHead + kBinGrouped] = 1;
    }
}

uint wordsOf(PlacedPath p) {
  return p.left < p.right && p.top < p.bottom ? wordsInRow(p) * (p.bottom - p.top) : 0;
}

void main() {
  const uint lane = gl_LocalInvocationID.x, i = groupIndex() * 64 + lane;
  if (lane == 0) wideCount = 0;
  barrier();
  if (i < header.pathCount) {
    const uint itemIndex = itemOfPath(i);
    const ItemRecord item = items[itemIndex];
    const uint path = item.paths + (i - item.firstPath) * 3;
#if !ONE_DRAWING
    const bool shaped = item.slot == kShapeSlot;
    bool triangle = false;
#else
    const bool shaped = false;
#endif
    vec4 box, frame = vec4(0, 0, 1, 0), color;
    uvec4 rest = uvec4(0);
    if (shaped) {
#if !ONE_DRAWING
      const ShapeRecord shape = shapeOf(item);
      triangle = isTriangle(shape);
      box = triangle ? triangleBox(shape) : shape.box;
      if (!triangle) frame = shape.frame;
      color = vec4(item.color.rgb, 1);
      rest.x = shape.paint;
#endif
    } else {
      box = fetch(item.slot, path);
      color = fetch(item.slot, path + 1);
      rest = floatBitsToUint(fetch(item.slot, path + 2));
      if ((rest.w & kForeground) != 0) color.rgb = item.color.rgb;
    }
    const uint paint = rest.x;
    PlacedPath p;
    uvec4 tiles = tileBox(item, box, frame, canvasTiles());
    if (!damagedBox(tiles)) tiles = uvec4(0);
    p.left = tiles.x;
    p.top = tiles.y;
    p.right = tiles.z;
    p.bottom = tiles.w;
    const float alpha = color.a * item.color.a;
    p.item = itemIndex;
    p.paint = paint == 0 ? 0 : tablesOf(item.slot).paints + (paint - 1) * 4 + 1;
    p.group = ((rest.y | rest.z) == 0 ? 0 : path + 2 + 1) | ((item.clip | item.layer) == 0 ? 0 : kItemGrouped);
#if !ONE_DRAWING
    if (triangle) p.paint |= kPaintsTriangle;
#endif
    p.color = blended(color.rgb, alpha, header.flags);
    if (p.paint != 0 && !shaped) p.color = vec4(alpha);
    const uint count = wordsOf(p);
    p.firstWord = count == 0 ? 0 : atomicAdd(counters.words, count);
    if (header.imageTiles > 0 && count != 0 && p.color.a > 0) storeImage(item.slot, i, p);
    paths[i] = p;
    if (count != 0 && p.color.a > 0) {
      const uint which = i | (p.group != 0 || (p.paint != 0 && item.perspective.w > 0) ? kGrouped : 0);
      const uint shift = header.binShift;
      const uvec4 box =
        uvec4(p.left >> shift, p.top >> shift, ((p.right - 1) >> shift) + 1, ((p.bottom - 1) >> shift) + 1);
      if ((box.z - box.x) * (box.w - box.y) <= kFewBins) {
        setBins(which, box, 0, 0, 1);
      } else {
        const uint at = atomicAdd(wideCount, 1);
        wide[at] = which;
        wideBins[at] = box;
      }
    }
  }
  barrier();
  for (uint w = 0; w < wideCount; ++w) setBins(wide[w], wideBins[w], lane % 8, lane / 8, 8);
  memoryBarrierBuffer();
  barrier();
  if (lane == 0) last = atomicAdd(counters.placed, 1) + 1 == gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  barrier();
  if (!last) return;
  memoryBarrierBuffer();
  uint cut = header.pathCount;
  if (counters.words > header.wordLimit) {
    uint total = 0;
    for (uint first = 0; first < header.pathCount && cut == header.pathCount; first += 64) {
      const uint path = first + lane;
      PlacedPath p;
      uint count = 0;
      if (path < header.pathCount) {
        p = paths[path];
        count = wordsOf(p);
      }
      const uint end = add(total, scan(lane, count));
      const uint fits = countLanes(lane, end <= header.wordLimit);
      if (lane < fits && path < header.pathCount) {
        paths[path].firstWord = end - count;
      }
      if (fits < 64) cut = min(cut, first + fits);
      total = add(total, scanTotal());
    }
  }
  if (lane == 0) {
    cut = wholeItems(cut);
    counters.paths = header.pathsNeeded;
    counters.glyphs = header.glyphs;
    counters.glyphsGiven = header.glyphLimit;
    counters.shapes = header.shapes;
    counters.shapesGiven = header.shapeLimit;
    counters.items = header.sources;
    counters.itemsGiven = header.sourceLimit;
    counters.layerPixels = header.layerPixels;
    counters.layerOperations = header.layerOperations;
    counters.wordsGiven = header.wordLimit;
    counters.entriesGiven = header.entryLimit;
    counters.cutPath = cut;
    counters.pathsDropped = header.pathsDropped + header.pathCount - cut + counters.imagesDropped;
  }
}
