#version 460
// Which tiles the curves of each patch pass, and which lie in it as a whole.
//
// A patch enters the hierarchy at the level that its size asks for. One that may touch up to 64 tiles is asked tile by
// tile. A larger one is asked by squares of 8 x 8 tiles: those that lie in it are marked at once, those that a curve
// passes are listed, with these curves alone. BLOCKS: asks the tiles of the squares that are listed.
//
// A workgroup takes several patches or squares, and deals their tiles out evenly. Where the list of squares is full, an
// invocation asks all tiles of a square by itself. Patches in tiles that a curve passes are listed for fill.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#include "vector/patches/items.glsl"
layout(local_size_x = 64) in;
shared uint taskItem[64], taskPatch[64], taskPath[64], taskWhat[64]; // PatchItemRecord; vec4; of the recording; passes
shared uvec4 taskTiles[64];
shared bool taskSquares[64];
shared uint firstPart[65];
shared uint taken, firstTaken;

const uint kNothing = ~0u;

void mark(PlacedPath p, uint x, uint y, bool whole) {
  const uint bit = x - p.left, word = p.firstWord + (y - p.top) * wordsInRow(p) + bit / 32;
  if (whole) atomicOr(words[word].inside, 1u << (bit & 31));
  else atomicOr(words[word].edges, 1u << (bit & 31));
}

// What a task's patch does in a square of `tiles` tiles along a side.
uint passes(uint task, PatchItemRecord m, TilePatch patch_, uint slot, uint x, uint y, uint tiles, uint what) {
  const float size = float(tiles * kTileSize);
  return passesThrough(slot, m.curves, patch_, m, items[m.item].scissor, what, float(x * kTileSize),
                       float(y * kTileSize), size);
}
void list(uint limit, uint place, uint task, uint x, uint y, uint what) {
  if (place >= limit) return;
  tilePatches[place] = PatchPlaceRecord(taskPath[task], x | y << 16, taskPatch[task],
                                        what | taskItem[task] << kPatchItemBit);
}

void main() {
  const PatchTableRecord table = patchTable();
  const uint lane = gl_LocalInvocationID.x;
#if BLOCKS
  const uint count = min(counters.patchBlocks, kPatchBlocks);
  const uint group = clamp((count + gl_NumWorkGroups.x - 1) / gl_NumWorkGroups.x, 1, 16);
#else
  const uint count = table.patches, group = table.groupPatches;
#endif
  const uint stride = gl_NumWorkGroups.x * gl_NumWorkGroups.y * group;
  for (uint base = groupIndex() * group; base < count; base += stride) {
    uint parts = 0;
    if (lane < group && base + lane < count) {
      uvec4 tiles = uvec4(0);
#if BLOCKS
      const PatchPlaceRecord block = patchBlocks[base + lane];
      taskItem[lane] = block.what >> kPatchItemBit;
      taskPatch[lane] = block.record;
      taskPath[lane] = block.path;
      taskWhat[lane] = block.what & kPatchAllPass;
      const PlacedPath p = paths[block.path];
      const PatchItemRecord m = patchItem(taskItem[lane]);
      const uvec4 all = patchTiles(fetchTilePatch(items[m.item].slot, block.record), m,
                                   items[m.item].perspective.w, uvec4(p.left, p.top, p.right, p.bottom));
      const uvec2 from = uvec2(block.place & 0xffff, block.place >> 16);
      tiles = uvec4(max(from, all.xy), min(from + kPatchBlockTiles, all.zw));
      taskSquares[lane] = false;
      parts = (tiles.z - tiles.x) * (tiles.w - tiles.y);
#else
      const uint i = base + lane, item = patchItemOf(i, table.items);
      const PatchItemRecord m = patchItem(item);
      const uint slot = items[m.item].slot, place = m.patches + (i - m.firstPatch) * kTilePatchSize;
      const TilePatch patch_ = fetchTilePatch(slot, place);
      const uint path = items[m.item].firstPath + patch_.path;
      taskItem[lane] = item;
      taskPatch[lane] = place;
      taskPath[lane] = path;
      taskWhat[lane] = kPatchAllPass;
      if (path < counters.cutPath) {
        const PlacedPath p = paths[path];
        if (p.left < p.right)
          tiles = patchTiles(patch_, m, items[m.item].perspective.w, uvec4(p.left, p.top, p.right, p.bottom));
      }
      parts = (tiles.z - tiles.x) * (tiles.w - tiles.y);
      taskSquares[lane] = parts > kPatchBlockTiles * kPatchBlockTiles;
      if (parts > kPatchBlockTiles * kPatchBlockTiles) {
        const uvec2 across = (tiles.zw - tiles.xy + kPatchBlockTiles - 1) / kPatchBlockTiles;
        parts = across.x * across.y;
      }
#endif
      taskTiles[lane] = tiles;
    }
    if (lane == 0) firstPart[0] = 0;
    firstPart[lane + 1] = parts;
    barrier();
    for (uint step = 1; step < 64; step *= 2) {
      const uint other = lane >= step ? firstPart[lane + 1 - step] : 0;
      barrier();
      firstPart[lane + 1] += other;
      barrier();
    }
    const uint total = firstPart[64];
    for (uint batch = 0; batch < total; batch += 64) {
      if (lane == 0) taken = 0;
      barrier();
      uint task = kNothing, what = kPatchOutside, own = 0, x = 0, y = 0;
      const uint part = batch + lane;
      if (part < total) {
        uint low = 0, high = 64;
        while (low + 1 < high) {
          const uint middle = (low + high) / 2;
          if (firstPart[middle] <= part) low = middle;
          else high = middle;
        }
        task = low;
        const uvec4 tiles = taskTiles[task];
        const PatchItemRecord m = patchItem(taskItem[task]);
        const uint slot = items[m.item].slot, k = part - firstPart[task];
        const TilePatch patch_ = fetchTilePatch(slot, taskPatch[task]);
        const PlacedPath p = paths[taskPath[task]];
        if (!taskSquares[task]) {
          const uint across = tiles.z - tiles.x;
          x = tiles.x + k % across;
          y = tiles.y + k / across;
          what = passes(task, m, patch_, slot, x, y, 1, taskWhat[task]);
          if (what != kPatchOutside) mark(p, x, y, what == 0);
          if (what != kPatchOutside && what != 0) own = atomicAdd(taken, 1);
        } else {
          const uint across = (tiles.z - tiles.x + kPatchBlockTiles - 1) / kPatchBlockTiles;
          x = tiles.x + k % across * kPatchBlockTiles;
          y = tiles.y + k / across * kPatchBlockTiles;
          const uint passing = passes(task, m, patch_, slot, x, y, kPatchBlockTiles, kPatchAllPass);
          const uvec2 end = min(uvec2(x, y) + kPatchBlockTiles, tiles.zw);
          uint place = kPatchBlocks;
          if (passing != kPatchOutside && passing != 0) place = atomicAdd(counters.patchBlocks, 1);
          if (place < kPatchBlocks) {
            patchBlocks[place] = PatchPlaceRecord(taskPath[task], x | y << 16, taskPatch[task],
                                                  passing | taskItem[task] << kPatchItemBit);
          } else if (passing != kPatchOutside) {
            for (uint row = y; row < end.y; ++row)
              for (uint column = x; column < end.x; ++column) {
                const uint tile = passing == 0 ? 0 : passes(task, m, patch_, slot, column, row, 1, passing);
                if (tile == kPatchOutside) continue;
                mark(p, column, row, tile == 0);
                if (tile != 0) list(table.limit, atomicAdd(counters.tilePatches, 1), task, column, row, tile);
              }
          }
        }
      }
      barrier();
      if (lane == 0 && taken != 0) firstTaken = atomicAdd(counters.tilePatches, taken);
      barrier();
      if (task != kNothing && !taskSquares[task] && what != kPatchOutside && what != 0)
        list(table.limit, firstTaken + own, task, x, y, what);
    }
    barrier(); // the tasks have been read
  }
}
