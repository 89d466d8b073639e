#version 460
// Colours of images for a page of them: what each path that paints with one of the page finds in its pixels. The raster
// then reads them (image_colors.glsl), as it can name no more than a page itself.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
layout(push_constant) uniform Page { uint page, holds; }; // holds: as header.images, of the page's
#define IMAGES_HOLD holds
#include "vector/raster/composite.glsl"
layout(local_size_x = kTileSize * kTileSize) in;

void main() {
  beginPixel();
  const uint lane = gl_LocalInvocationIndex;
  const uvec2 inTile = uvec2(lane % kTileSize, lane / kTileSize);
  const uint count = min(counters.storedImages, header.imageTiles);
  for (uint i = gl_WorkGroupID.y; i < count; i += gl_NumWorkGroups.y) {
    const StoredImage image = storedImage(i);
    if (image.path >= counters.cutPath) continue;
    const PlacedPath p = paths[image.path];
    const ItemRecord item = items[p.item];
    const bool triangle = (image.paint & kPaintsTriangle) != 0;
    const uint which = item.firstImage + paintOf(item.slot, (image.paint & ~kPaintsTriangle) - 1).firstStop;
    if (which / kPageImages != page) continue;
    const uint across = p.right - p.left, tiles = across * (p.bottom - p.top);
    for (uint t = gl_WorkGroupID.x; t < tiles; t += gl_NumWorkGroups.x) {
      const uvec2 tile = uvec2(p.left + t % across, p.top + t / across);
      const uint code = coverageOf(p, tile);
      if (code == 0) continue;
      int difference;
      const uint mask = maskOf(code, fetchEdge(code, inTile.y, false), inTile.x, false, difference);
      if (triangle && mask == 0) continue;
      const uvec2 pixel = tile * kTileSize + inTile;
      Texture there = textureOf(item, image.paint, spotOf(item, pixel, triangle ? mask : all));
      there.image -= page * kPageImages;
      const vec4 color = imageAt(there);
      imageColors[colorPlace(image, p, pixel)] = uvec2(packHalf2x16(color.rg), packHalf2x16(color.ba));
    }
  }
}
