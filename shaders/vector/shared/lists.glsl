// Where the lists of tiles lie behind the bins: a tile's list is how many paths there are and, for each, what it does
// to the tile and which one it is; or else the tile's colour. With barriers bins have lists instead: there lies which
// tiles take the general shader, whether each tile does (split.comp), and then the bins' lists of paths, the last one
// in painting order first.
#if SOFTWARE
const uint kSolidTile = ~0u; // in place of a count: the tile's colours, of the view and the target, lie in
                                // the list's second and third four words
// A list's first two words are how many paths there are and nothing, the others pairs.
uint listRoom() { return (header.listWords - 2) / 2; }
uint listOf(uint tile) { // a multiple of 4
  return (kFirstBin + header.binCount * header.binWords + 3 & ~3u) + tile * header.listWords;
}
#else
uint listRoom() { return (header.listWords - 1) / 2; }
uint listOf(uint tile) { return kFirstBin + header.binCount * header.binWords + tile * header.listWords; }
#endif
uint paintedTiles() { return listOf(header.tilesX * header.tilesY); }
// Those that take the general shader are listed from the other end.
uint crowdedTiles() { return paintedTiles() + header.tilesX * header.tilesY; }
#if SOFTWARE
uint rowTiles() { return crowdedTiles() + header.tilesX * header.tilesY; } // painted by rows (raster_rows.comp)
#endif
uint richTile(uint list, uint i) { return list + header.tilesX * header.tilesY - 1 - i; }
uint richTiles() { return kFirstBin + header.binCount * header.binWords; }
uint tileKinds() { return richTiles() + header.tilesX * header.tilesY; }
uint fullTiles() { return kFirstBin + header.tilesX * header.tilesY * kTileListWords; } // what their lists leave over
uint binLists() { return tileKinds() + header.tilesX * header.tilesY; }

uint another(uint arguments) { // workgroup for the passes behind: in rows (canvas.glsl, groupIndex)
  const uint place = atomicAdd(bins[arguments + 3], 1);
  atomicMax(bins[arguments], min(place + 1, 32768));
  atomicMax(bins[arguments + 1], place / 32768 + 1);
  return place;
}

#if SOFTWARE
uint several(uint arguments, uint count) { // `count` of them: the first one
  uint place = 0;
  if (count != 0) {
    place = atomicAdd(bins[arguments + 3], count);
    atomicMax(bins[arguments], min(place + count, 32768));
    atomicMax(bins[arguments + 1], (place + count - 1) / 32768 + 1);
  }
  return place;
}
#endif

const uint kHidden = 0, kEven = 1, kRich = 2;
const uint kManyClipPaths = 64;
// What the clips of an item leave of a tile: kHidden: nothing, kEven: all of it, kRich: a part.
uint itemClipsIn(uint item, uvec2 tile, inout uint steps) {
  uint found = kEven;
  for (uint clip = items[item].clip; clip != 0; ++steps) {
    const uvec2 record = floatBitsToUint(fetch(kShapeSlot, clipRecord(clip)).xy);
    const uint code = coverageOf(paths[record.x], tile);
    if (code == 0) return kHidden;
    if (code != 1) found = kRich;
    clip = record.y;
  }
  return found;
}
// The same of a drawing's clip and those that hold it.
uint clipsIn(uint item, uint clip, uvec2 tile, inout uint steps) {
  const uint slot = items[item].slot;
  uint found = kEven;
  while (clip != 0) {
    const uvec4 record = floatBitsToUint(fetch(slot, tablesOf(slot).clips + clip - 1));
    if (record.y > kManyClipPaths) return kRich;
    uint shown = kHidden;
    for (uint k = 0; k < record.y && shown != kEven; ++k, ++steps) {
      const uint code = coverageOf(paths[items[item].firstPath + record.x + k], tile);
      if (code != 0) shown = code == 1 ? kEven : kRich;
    }
    if (shown == kHidden) return kHidden;
    found = max(found, shown);
    clip = record.z;
    ++steps;
  }
  return found;
}

uvec2 groupOf(PlacedPath p) { // the path's clip and its layer, of its drawing
  const uint group = p.group & ~kItemGrouped;
  return group == 0 ? uvec2(0) : floatBitsToUint(fetch(items[p.item].slot, group - 1)).yz;
}
// What a path's group and paint ask for in a tile: kHidden: a clip leaves nothing, kEven: nothing that the recording's
// other shaders do not know, kRich: the general shader.
uint groupIn(PlacedPath p, uvec2 tile, inout uint steps) {
  if (p.paint != 0 && items[p.item].perspective.w > 0) return kRich;
  if (p.group == 0) return kEven;
  const uvec2 group = groupOf(p);
  if (group.y != 0) return kRich;
  uint found = clipsIn(p.item, group.x, tile, steps);
  if ((p.group & kItemGrouped) == 0 || found == kHidden) return found;
  if (items[p.item].layer != 0) found = kRich;
  const uint shown = itemClipsIn(p.item, tile, steps);
  return shown == kHidden ? kHidden : max(found, shown);
}
