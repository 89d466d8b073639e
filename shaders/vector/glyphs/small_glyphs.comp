#version 460
// Small glyphs: what a path's boundary does to the tiles and pixels that it passes through, all of it in shared memory.
//
// A workgroup takes an item that has one path: its invocations take a segment each, then a flattened segment, then a
// row of pixels of one. Samples and areas change as fill has them (fill_row.glsl), but in rows of all of the path's
// pixels; what lies left of a tile is summed up in the end, when it shows which tiles have edges. Their entries lie
// behind those of all other paths, and are written whole. ALONE: a recording has nothing else, so they are placed here,
// and their tiles' lists name them, which need no other path to be known.
#extension GL_GOOGLE_include_directive : require
#if SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#endif
#define SCISSORS 0 // what one may cut is not small (Gather)
#include "vector/shared/canvas.glsl"
#include "vector/shared/run.glsl"
#if ALONE
#include "vector/shared/color.h"
#include "vector/shared/constants.glsl"
#include "vector/shared/lists.glsl"
#include "vector/place/placement.h"
#endif
const uint kLanes = 32;
layout(local_size_x = kLanes) in;
layout(set = 0, binding = kBindEntries, std430) writeonly buffer Entries { uint entries[]; };
shared uint pixels[kSmallGlyphPairs * 2];                      // the samples of pairs, row by row, then their areas
// x, y to x, y: down where the region begins right of it
shared vec4 flatSegments[kLanes];
shared uint firstFlatSegment[kLanes + 1], firstRow[kLanes + 1]; // of each segment; of each flattened segment
shared uint edges[kSmallGlyphTiles], inside[kSmallGlyphTiles];      // of each row of tiles, as TileWord has them
shared uint firstEntry;
#if SUBGROUPS // of at least as many invocations
uint upTo(uint count) { return subgroupInclusiveAdd(count); }
#else
#define SCAN_LANES 32
#include "vector/shared/scan.glsl"
uint upTo(uint count) { return scan(gl_LocalInvocationIndex, count); }
#endif

// The path's pixels: the first pair, how many there are in a row, the first row; and tiles that it may touch.
struct Place {
  uint left, pairs, top;
  uvec4 tiles; // left, top, right, bottom
};

Place placeOf(Grid g, ItemRecord item) {
  const vec4 box = fetch(item.slot, item.paths);
  const vec2 a = toPixel(item, box.x, box.y), b = toPixel(item, box.z, box.y), c = toPixel(item, box.z, box.w),
             d = toPixel(item, box.x, box.w);
  const vec2 low = min(min(a, b), min(c, d)), high = max(max(a, b), max(c, d));
  const vec2 rounding = 1e-5 * max(abs(low), abs(high)), margin = 0.25 + rounding; // far more than rounding
  const uint left = uint(max(low.x - margin.x, 0.0)) / 2;
  const uint last = (uint(clamp(high.x + margin.x, 0.0, float(g.columns))) + 1) / 2; // it has the pixel right of all
  const uvec4 tiles = box.x <= box.z ? tilesIn(low - 1.0 - rounding, high + 1.0 + rounding, canvasTiles()) : uvec4(0);
  return Place(left, max(last, left) + 1 - left, uint(max(low.y - margin.y, 0.0)), tiles);
}

// A flattened segment in one row of pixels.
void smallGlyphRow(Grid g, Place place, FlatSegment c, int pixel) {
  const int shift = findMSB(g.samples), top = pixel << shift;
  const int begin = max(c.first, top) - top, end = min(c.last - top, int(g.samples));
  const Line line = lineOf(g, c);
  const float firstRow = middleOf(g, top), step = sampleStep(g.samples);
  const Crossings crossings = crossingsOf(g, line, top);
  uint first = (crossings.first | 1u << begin) & ((1u << end) - (1u << begin));
  const uint row = (uint(pixel) - place.top) * place.pairs - place.left;
  while (first != 0) {
    const int from = findLSB(first);
    first &= first - 1;
    const int to = first != 0 ? findLSB(first) : end;
    const int x = crossingAt(line, firstRow + float(from) * step);
    const int last = crossingAt(line, firstRow + float(to - 1) * step), column = x >> 8;
    if (column >= g.columns) continue;
    Run run = runOf((1u << to) - (1u << from), crossings.covered, x, last);
    if (column < 0) run = Run(run.here | run.next, 0, 0);
    const uint at = uint(max(column, 0)), shifted = (at & 1) * 16, word = row + at / 2;
    atomicXor(pixels[word], shifted == 0 ? run.here | run.next << 16 : run.here << 16);
    if (shifted != 0 && run.next != 0) atomicXor(pixels[word + 1], run.next);
    if ((header.flags & kExactArea) != 0 && run.difference != 0)
      atomicAdd(pixels[word + kSmallGlyphPairs], uint(c.side > 0 ? run.difference : -run.difference) << shifted);
  }
}

// Pixel pairs of a row of tiles begin with what is inside in the first pixel of each tile, instead of with what changes
// there.
void sumRows(Place place, uint rows, uint lane) {
  for (uint row = lane; row < rows; row += kLanes) {
    uint both = 0;
    for (uint k = 0; k < place.pairs; ++k) {
      const uint word = pixels[row * place.pairs + k];
      if ((place.left + k) % 4 == 0)
        pixels[row * place.pairs + k] = word & 0xffff0000u | (both ^ both >> 16 ^ word) & 0xffffu;
      both ^= word;
    }
  }
}

uint edgesBefore(uint row) { // of the path's tiles
  uint count = 0;
  for (uint k = 0; k < row; ++k) count += bitCount(edges[k]);
  return count;
}

#if ALONE
// Into the tile's list, or behind all lists.
void name(uvec2 tile, uint code, uint path) {
  const uint which = tile.y * header.tilesX + tile.x, list = kFirstBin + which * kTileListWords;
  const uint place = atomicAdd(bins[list], 1);
  uint at = list + 2 + place * 2;
  if (place >= kTileListPaths) {
    at = fullTiles() + atomicAdd(counters.listed, 1) * 3;
    bins[at++] = which;
  }
  bins[at] = code;
  bins[at + 1] = path;
}
#endif

void main() {
  const uint i = groupIndex(), lane = gl_LocalInvocationIndex;
  if (i >= header.itemCount) return;
  const Grid g = canvasGrid();
#if ALONE
  const PlacementRecord placement = placementOf(i);
  const ItemRecord item = placed(items[sourceIndex(placement)], placement);
  const Place place = placeOf(g, item);
  const uvec4 box = place.tiles;
  if (box.x >= box.z || !damagedBox(box)) return;
  const vec4 ink = fetch(item.slot, item.paths + 1);
  const bool foreground = (floatBitsToUint(fetch(item.slot, item.paths + 2)).w & kForeground) != 0;
  const float alpha = ink.a * item.color.a;
  if (alpha <= 0) return;
  if (lane == 0) paths[item.firstPath].color = blended(foreground ? item.color.rgb : ink.rgb, alpha, header.flags);
#else
  const ItemRecord item = items[i];
  if (item.smallGlyph == 0) return;
  const PlacedPath p = paths[item.firstPath];
  const Place place = placeOf(g, item);
  const uvec4 box = uvec4(p.left, p.top, p.right, p.bottom);
  if (item.firstPath >= counters.cutPath || box.x >= box.z) return;
#endif
  for (uint k = lane; k < kSmallGlyphPairs * 2; k += kLanes) pixels[k] = 0;
  if (lane < kSmallGlyphTiles) edges[lane] = inside[lane] = 0;
  barrier();
  const uint end = (item.paths - item.segments) / 4; // a glyph's path lies behind its segments
  for (uint first = 0; first < end; first += kLanes) {
    uint count = 0;
    if (first + lane < end) {
      const SegmentRecord s = fetchSegment(item, item.firstSegment + first + lane);
      if (mayMatter(g, item, s)) count = flatSegmentCount(g, item, s);
    }
    const uint flatSegmentEnd = upTo(count);
    firstFlatSegment[lane + 1] = flatSegmentEnd;
    if (lane == 0) firstFlatSegment[0] = 0;
    barrier();
    const uint total = firstFlatSegment[kLanes];
    for (uint batch = 0; batch < total; batch += kLanes) {
      uint rowCount = 0;
      if (batch + lane < total) {
        uint low = 0;
        for (uint step = kLanes / 2; step > 0; step /= 2)
          if (firstFlatSegment[low + step] <= batch + lane) low += step;
        const uint begin = firstFlatSegment[low], n = firstFlatSegment[low + 1] - begin;
        const SegmentRecord s = fetchSegment(item, item.firstSegment + first + low);
        FlatSegment c;
        if (flatSegmentOf(g, item, s, batch + lane - begin, n, flatSegmentStep(n), c) &&
            c.first < c.last && min(c.top.x, c.bottom.x) < float(g.columns)) {
          const int shift = findMSB(g.samples);
          rowCount = uint(((c.last - 1) >> shift) - (c.first >> shift) + 1);
          flatSegments[lane] = c.side > 0 ? vec4(c.top, c.bottom) : vec4(c.bottom, c.top);
        }
      }
      const uint rowEnd = upTo(rowCount);
      firstRow[lane + 1] = rowEnd;
      if (lane == 0) firstRow[0] = 0;
      barrier();
      const uint rowTotal = firstRow[kLanes];
      for (uint r = lane; r < rowTotal; r += kLanes) {
        uint low = 0;
        for (uint step = kLanes / 2; step > 0; step /= 2)
          if (firstRow[low + step] <= r) low += step;
        const vec4 from = flatSegments[low];
        FlatSegment c;
        c.side = from.y < from.w ? 1.0 : -1.0;
        c.top = c.side > 0 ? from.xy : from.zw;
        c.bottom = c.side > 0 ? from.zw : from.xy;
        c.first = rowOf(g, c.top.y);
        c.last = rowOf(g, c.bottom.y);
        precise float width = c.bottom.x - c.top.x;
        precise float height = c.bottom.y - c.top.y;
        c.slope = slopeOf(width, height);
        smallGlyphRow(g, place, c, (c.first >> findMSB(g.samples)) + int(r - firstRow[low]));
      }
      barrier();
    }
  }
  // Which tiles have edges, and which lie inside.
  const uint across = box.z - box.x, down = box.w - box.y, rows = kSmallGlyphPairs / place.pairs;
  sumRows(place, rows, lane);
  barrier();
  const uvec2 own = uvec2(lane % 4, lane / 4); // this invocation's pair in each tile
  const uint all = (1u << g.samples) - 1;
  const uvec2 first = box.xy * uvec2(4, kTileSize) - uvec2(place.left, place.top); // of the path's pairs
  for (uint row = 0; row < down; ++row) {
    const uint y = first.y + row * kTileSize + own.y, begin = first.y + row * kTileSize;
    for (uint column = 0; column < across; ++column) {
      const uint corner = first.x + column * 4, x = corner + own.x;
      const bool there = corner < place.pairs && begin < rows;
      const uint whole = there && (pixels[begin * place.pairs + corner] & 1) != 0 ? all : 0;
      if (lane == 0 && whole != 0) inside[row] |= 1u << column;
      uint changes = own.x == 0 ? whole : 0;
      if (x < place.pairs && y < rows) {
        const uint word = y * place.pairs + x;
        changes = changes ^ pixels[word] | pixels[word + kSmallGlyphPairs];
      }
      if (changes != 0) atomicOr(edges[row], 1u << column);
    }
  }
  barrier();
  if (lane == 0) firstEntry = header.entryLimit + atomicAdd(counters.smallGlyph, edgesBefore(down));
  barrier();
#if ALONE
  if (lane < across * down) {
    const uint row = lane / across, column = lane % across, bit = 1u << column;
    const uint within = inside[row] >> column & 1;
    const uint entry = firstEntry + edgesBefore(row) + bitCount(edges[row] & (bit - 1));
    if ((edges[row] & bit) != 0) name(box.xy + uvec2(column, row), entry * 4 + 2 + within, item.firstPath);
    else if (within != 0) name(box.xy + uvec2(column, row), 1, item.firstPath);
  }
#else
  if (lane < down)
    words[p.firstWord + lane] = TileWord(edges[lane], inside[lane], firstEntry + edgesBefore(lane), 1);
#endif
  uint entry = firstEntry * kEntryWords + lane;
  for (uint row = 0; row < down; ++row) {
    const uint y = first.y + row * kTileSize + own.y;
    for (uint left = edges[row]; left != 0; left &= left - 1) {
      const uint column = uint(findLSB(left)), x = first.x + column * 4 + own.x;
      uint samples = own.x == 0 && (inside[row] >> column & 1) != 0 ? all : 0, areas = 0;
      if (x < place.pairs && y < rows) {
        const uint word = y * place.pairs + x;
        samples ^= pixels[word];
        areas = pixels[word + kSmallGlyphPairs];
      }
      entries[entry] = samples;
      entries[entry + kEntryWords / 2] = areas;
      entry += kEntryWords;
    }
  }
}
