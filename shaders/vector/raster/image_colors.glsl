// Colours of images that are found before the raster, in recordings with more images than a shader can name.
//
// Heads come first, one for each tile that there is room for: as many as there can be StoredImages. Behind them lie the
// colours, as half floats: of each tile of a path's box those of its pixels, in rows.
layout(set = 0, binding = kBindImageColors, std430) buffer ImageHeads { uvec4 imageHeads[]; };
layout(set = 0, binding = kBindImageColors, std430) buffer ImageColors { uvec2 imageColors[]; };

StoredImage storedImage(uint paint) {
  const uvec4 head = imageHeads[paint & ~(kPaintsTriangle | kPaintsStored)];
  return StoredImage(head.x, head.y, head.z, 0);
}
uint colorPlace(StoredImage image, PlacedPath p, uvec2 pixel) {
  const uvec2 tile = pixel / kTileSize, at = pixel % kTileSize;
  const uint place = image.firstTile + (tile.y - p.top) * (p.right - p.left) + tile.x - p.left;
  return header.imageTiles * 2 + (place * kTileSize + at.y) * kTileSize + at.x;
}
