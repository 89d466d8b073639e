// Where the lists of tiles lie behind the bins: a tile's list is how many paths there are and, for each, what it does
// to the tile and which one it is; or else the tile's colour. With barriers bins have lists instead: there lies which
// tiles take the general shader, and then the bins' lists of paths, the last one in painting order first.
uint listRoom() { return (header.listWords - 1) / 2; }
uint listOf(uint tile) { return kFirstBin + header.binCount * header.binWords + tile * header.listWords; }
uint paintedTiles() { return listOf(header.tilesX * header.tilesY); }
// Those that take the general shader are listed from the other end.
uint crowdedTiles() { return paintedTiles() + header.tilesX * header.tilesY; }
uint richTile(uint list, uint i) { return list + header.tilesX * header.tilesY - 1 - i; }
uint richTiles() { return kFirstBin + header.binCount * header.binWords; }
uint binLists() { return richTiles() + header.tilesX * header.tilesY; }

uint another(uint arguments) { // workgroup for the passes behind: in rows (canvas.glsl, groupIndex)
  const uint place = atomicAdd(bins[arguments + 3], 1);
  atomicMax(bins[arguments], min(place + 1, 32768));
  atomicMax(bins[arguments + 1], place / 32768 + 1);
  return place;
}

const uint kHidden = 0, kEven = 1, kRich = 2;
const uint kManyClipPaths = 64;
// What a path's group and paint ask for in a tile: kHidden: a clip leaves nothing, kEven: nothing that the record's
// other shaders do not know, kRich: the general shader.
uint groupIn(PlacedPath p, uvec2 tile, inout uint steps) {
  if (p.paint != 0 && items[p.item].perspective.w > 0) return kRich;
  if (p.group == 0) return kEven;
  const uint slot = items[p.item].slot;
  uint found = kEven;
  if ((p.group & kItemGrouped) != 0) {
    if (items[p.item].layer != 0) found = kRich;
    for (uint clip = items[p.item].clip; clip != 0; ++steps) {
      const uvec2 record = floatBitsToUint(fetch(kShapeSlot, clipRecord(clip)).xy);
      const uint code = coverageOf(paths[record.x], tile);
      if (code == 0) return kHidden;
      if (code != 1) found = kRich;
      clip = record.y;
    }
    if ((p.group & ~kItemGrouped) == 0) return found;
  }
  const uvec4 group = floatBitsToUint(fetch(slot, (p.group & ~kItemGrouped) - 1));
  if (group.z != 0) return kRich;
  for (uint clip = group.y; clip != 0;) {
    const uvec4 record = floatBitsToUint(fetch(slot, slots[slot].clips + clip - 1));
    if (record.y > kManyClipPaths) return kRich;
    uint shown = kHidden;
    for (uint k = 0; k < record.y && shown != kEven; ++k, ++steps) {
      const uint code = coverageOf(paths[items[p.item].firstPath + record.x + k], tile);
      if (code != 0) shown = code == 1 ? kEven : kRich;
    }
    if (shown == kHidden) return kHidden;
    found = max(found, shown);
    clip = record.z;
    ++steps;
  }
  return found;
}
