// One pixel painted front to back, and what is written of it.
//
// A pixel keeps which of its samples are still open, and how much light each still lets through where something
// translucent lies in front, and stops when none is left. Every sample is thus composited by itself: neither cuts
// inside a path nor edges shared by two paths let anything through. The first edge that a pixel meets counts by its
// area; what lies behind is scaled to what that leaves.
// PAINTS: whether there are gradients. RICH: whether there are groups and projective items. IMAGES: whether there are
// images. COLORS_ALONE: images.comp, which writes no pixels. TARGET: 0 the view alone, 1 an rgba8 image, 2 an rgba16f
// image (and the view, if one is given).
#include "vector/shared/color.h"
#include "vector/raster/composite.h"
#include "vector/shared/entry.h"
#if PAINTS
#include "vector/raster/paint.glsl"
#endif
#define TRIANGLES (PAINTS && !ONE_DRAWING) // those of lists
#if IMAGES
#include "vector/raster/image_colors.glsl"
#endif
layout(set = 0, binding = kBindEntries, std430) readonly buffer Entries { uvec4 entries[]; };
#if !COLORS_ALONE // what writes pixels of the canvas
layout(set = 0, binding = kBindHistory, std430) writeonly buffer View { uvec2 view[]; };
#endif
#if TARGET == 1
layout(set = 0, binding = kBindImage8, rgba8) uniform writeonly image2D image;
#elif TARGET == 2
layout(set = 0, binding = kBindImage16, rgba16f) uniform writeonly image2D image;
#endif

uint all;        // samples
float share;     // of one sample
bool first;      // no edge so far, and area counts
bool soft;       // something translucent so far
uint alive;
float scale;
float gap; // light past the first edge where its samples say that none is left: the next path's that is there
float through[16]; // where soft, or EARLY, as software devices make no branch of what would spare it
vec4 sum;
#define EARLY (RICH || SOFTWARE)

#if RICH
// A group less than opaque has light of its own: what reached it times its opacity. Behind its last path that is joined
// again with what passed the group by.
uint depth, chainItem, chainLayer; // the last path's, of its drawing
uvec2 chain[kMaxLayerDepth]; // the groups that paths at hand belong to, the outermost first: slot, and layer
float opacities[kMaxLayerDepth], outerScale[kMaxLayerDepth], outerGap[kMaxLayerDepth];
uint outerAlive[kMaxLayerDepth];
float outer[kMaxLayerDepth * 16];

// What the clips of the last clipped path leave of the pixel: paths that follow each other often share them.
uvec2 clipped; // its item, and its clip as paintOver takes it
bool clippedArea;
uint clipMask;
int clipDifference;
#endif

void beginPixel() {
  all = (1u << header.samples) - 1;
  share = 1.0 / float(header.samples);
  first = (header.flags & kExactArea) != 0;
  soft = false;
  alive = all;
  scale = 1.0;
  gap = 0;
#if RICH
  depth = 0;
  chainItem = ~0u;
  chainLayer = 0;
  clipped = uvec2(~0u);
#endif
#if EARLY
  for (uint k = 0; k < 16; ++k) through[k] = 1.0;
#endif
  sum = vec4(0);
}

#if RICH
bool pixelOpen() { return depth > 0 || alive != 0 || gap > 0; }

void leaveLayer() {
  --depth;
  const float past = 1.0 - opacities[depth];
  float sumPast = 0, sumLight = 0;
  for (uint k = 0; k < header.samples; ++k) {
    const float passed = (outerAlive[depth] >> k & 1) != 0 ? outer[depth * 16 + k] * past : 0.0;
    const float light = (alive >> k & 1) != 0 ? through[k] : 0.0;
    through[k] = passed + light;
    sumPast += passed;
    sumLight += light;
  }
  alive = outerAlive[depth];
  soft = true;
  if ((header.flags & kExactArea) == 0) return;
  joinLight(sumPast, outerScale[depth], outerGap[depth], past, sumLight, share, scale, gap);
}

uvec4 fetchLayer(uint slot, uint layer) { return floatBitsToUint(fetch(slot, tablesOf(slot).layers + layer - 1)); }
uint layerDepth(uint slot, uint layer) { return layer == 0 ? 0 : fetchLayer(slot, layer).z; }
// Of the groups that hold a path, the one at a depth: those of its item, `outside` of them, hold those of its drawing.
uvec2 layerAt(ItemRecord item, uint layer, uint outside, uint wanted) { // slot, and layer
  const bool own = wanted > outside;
  const uint slot = own ? item.slot : kShapeSlot;
  uint found = own ? layer : item.layer;
  const uint local = own ? wanted - outside : wanted;
  for (uvec4 record = fetchLayer(slot, found); record.z > local; record = fetchLayer(slot, found)) found = record.y;
  return uvec2(slot, found);
}

// From the groups of the last path to those of the next one. `layer`: of its drawing; 0 none.
void toLayer(uint index, uint layer) {
  if (index == chainItem && layer == chainLayer) return;
  const ItemRecord item = items[index];
  const uint outside = layerDepth(kShapeSlot, item.layer), wanted = outside + layerDepth(item.slot, layer);
  while (depth > 0 && (depth > wanted || (depth > outside && chainItem != index) ||
                       layerAt(item, layer, outside, depth) != chain[depth - 1]))
    leaveLayer();
  chainItem = index;
  chainLayer = layer;
  while (depth < wanted) {
    chain[depth] = layerAt(item, layer, outside, depth + 1);
    const float opacity = uintBitsToFloat(fetchLayer(chain[depth].x, chain[depth].y).x);
    opacities[depth] = opacity;
    outerScale[depth] = scale;
    outerGap[depth] = gap;
    outerAlive[depth] = alive;
    gap *= opacity;
    for (uint k = 0; k < 16; ++k) {
      outer[depth * 16 + k] = through[k];
      through[k] *= opacity;
    }
    soft = true;
    ++depth;
  }
}
#else
bool pixelOpen() { return alive != 0 || gap > 0; }
#endif

#if SOFTWARE
// A row of pixels of an entry, a word each: samples that change sides, and the area in the upper half.
struct Edge {
  uvec4 left, right;
};
Edge fetchEdge(uint code, uint y, bool area) {
  Edge edge = Edge(uvec4(0), uvec4(0));
  const uint row = (code >> 2) * (kEntryWords / 4) + y * 2;
  if (code > 1) {
    edge.left = entries[row];
    edge.right = entries[row + 1];
  }
  return edge;
}
// What a path does to pixel x of the row: samples, and by how much its area differs from them.
uint maskOf(uint code, Edge edge, uint x, bool area, out int difference) {
  uint sum = (code & 1) != 0 ? all : 0, own = 0;
  for (uint k = 0; k < 8; ++k) {
    const uint word = k < 4 ? edge.left[k] : edge.right[k - 4];
    sum ^= k <= x ? word & 0xffffu : 0;
    own = k == x ? word : own;
  }
  difference = area ? int(own) >> 16 : 0;
  return sum;
}
#else
// Paths are looked at one after another, and each would wait for its entry. Where there are more than a few, all
// entries are fetched first, into the caches, each by one invocation. Nothing comes of what they hold.
const uint kFewEntries = 4;
uint fetchAhead(uint code) {
  uint any = 0;
  for (uint k = 0; k < kEntryWords / 4; k += 2) any |= entries[(code >> 2) * (kEntryWords / 4) + k].x; // each 32 bytes
  return any & header.zero;
}

// A row of pixels of an entry: samples that change sides, and areas.
struct Edge {
  uvec4 samples, areas;
};
Edge fetchEdge(uint code, uint y, bool area) {
  Edge edge = Edge(uvec4(0), uvec4(0));
  const uint row = (code >> 2) * (kEntryWords / 4) + y;
  if (code > 1) edge.samples = entries[row];
  if (code > 1 && area) edge.areas = entries[row + kEntryWords / 8];
  return edge;
}
// What a path does to pixel x of the row: samples, and by how much its area differs from them.
uint maskOf(uint code, Edge edge, uint x, bool area, out int difference) {
  difference = 0;
  if (code == 1) return all;
  if (area) difference = differenceAt(edge.areas, x);
  return foldRow(edge.samples, x) ^ ((code & 1) != 0 ? all : 0);
}
#endif

#if RICH
void clipBy(ItemRecord item, uint clip, uvec2 tile, uvec2 at, bool area, inout uint mask, inout int difference) {
  while (clip != 0) {
    const uvec4 record = floatBitsToUint(fetch(item.slot, tablesOf(item.slot).clips + clip - 1));
    uint shown = 0;
    int shownDifference = 0;
    for (uint k = 0; k < record.y; ++k) {
      const uint code = coverageOf(paths[item.firstPath + record.x + k], tile);
      if (code == 0) continue;
      int otherDifference;
      const uint other = maskOf(code, fetchEdge(code, at.y, area), at.x, area, otherDifference);
      combine(shown, shownDifference, other, otherDifference, true, all);
    }
    combine(mask, difference, shown, shownDifference, false, all);
    clip = record.z;
  }
}

// The clips of an item.
void clipItem(uint clip, uvec2 tile, uvec2 at, bool area, inout uint mask, inout int difference) {
  while (clip != 0) {
    const uvec2 record = floatBitsToUint(fetch(kShapeSlot, clipRecord(clip)).xy);
    const uint code = coverageOf(paths[record.x], tile);
    int otherDifference = 0;
    const uint other =
        code == 0 ? 0 : maskOf(code, fetchEdge(code, at.y, area), at.x, area, otherDifference);
    combine(mask, difference, other, otherDifference, false, all);
    clip = record.y;
  }
}

// All clips of a path.
void applyClips(uint index, uint clip, uvec2 tile, uvec2 at, bool area, inout uint mask, inout int difference) {
  if (clipped != uvec2(index, clip) || area && !clippedArea) {
    clipped = uvec2(index, clip);
    clippedArea = area;
    clipMask = all;
    clipDifference = 0;
    const ItemRecord item = items[index];
    clipBy(item, clip & ~kItemGrouped, tile, at, area, clipMask, clipDifference);
    if ((clip & kItemGrouped) != 0) clipItem(item.clip, tile, at, area, clipMask, clipDifference);
  }
  combine(mask, difference, clipMask, area ? clipDifference : 0, false, all);
}
#endif

#if PAINTS
// Where in the drawing the middle of a pixel's samples in a mask lies, and 1 / w there.
struct Spot {
  vec2 at;
  float near;
};
Spot spotOf(ItemRecord item, uvec2 pixel, uint mask) {
#if TRIANGLES
  const vec2 middle = vec2(pixel) + middleOf(mask, header.samples);
#else
  const vec2 middle = vec2(pixel) + 0.5;
#endif
  Spot spot = Spot(item.inverse.xy * middle.x + item.inverse.zw * middle.y + item.offsets.xy, 1.0);
#if PROJECTIVE
  if (projects(item)) {
    spot.near = 1.0 / (item.eye.x * middle.x + item.eye.y * middle.y + item.eye.z);
    spot.at *= spot.near;
  }
#endif
  return spot;
}
#if IMAGES
Texture textureOf(ItemRecord item, uint paint, Spot spot) {
  vec2 dx = item.inverse.xy, dy = item.inverse.zw;
#if PROJECTIVE
  if (projects(item)) {
    dx = (dx - spot.at * item.eye.x) * spot.near;
    dy = (dy - spot.at * item.eye.y) * spot.near;
  }
#endif
  const uint record = (paint & ~kPaintsTriangle) - 1;
#if TRIANGLES
  if ((paint & kPaintsTriangle) != 0)
    return textureAt(item, record, triangleWeights(shapeOf(item), spot.at), dx, dy);
#endif
  return textureAt(item, record, spot.at, dx, dy);
}
vec4 storedColor(uint paint, uvec2 pixel) {
  const StoredImage image = storedImage(paint);
  const uvec2 color = imageColors[colorPlace(image, paths[image.path], pixel)];
  return vec4(unpackHalf2x16(color.x), unpackHalf2x16(color.y));
}
#endif
#endif

// Whether what is painted next counts by its area.
bool countsArea() { return first || gap > 0; }

// A path over pixel `at` of the tile and `pixel` of the canvas; `edge` is its row there, with areas where countsArea();
// `paint` is its item, its paint, its layer and its clip, with kItemGrouped where clips of its item count.
void paintOver(uint code, Edge edge, uvec2 at, uvec2 pixel, vec4 source, uvec4 paint) {
  const bool area = countsArea();
  int difference;
  uint mask = maskOf(code, edge, at.x, area, difference);
#if TRIANGLES
  const bool triangle = (paint.y & kPaintsTriangle) != 0;
  if (triangle) difference = 0; // what abuts shares pixels sample by sample
  const uint own = mask;
#endif
#if RICH
  toLayer(paint.x, paint.z);
  if (alive == 0 && gap <= 0) return; // the group is hidden, not what lies behind it
  if (paint.w != 0 && (mask != 0 || difference != 0))
    applyClips(paint.x, paint.w, pixel / kTileSize, at, area, mask, difference);
#endif
  if (mask == 0 && (first ? difference == 0 : gap * float(difference) <= 0)) return;
#if PAINTS
  if (paint.y != 0) {
    const ItemRecord item = items[paint.x];
#if TRIANGLES
    const Spot spot = spotOf(item, pixel, triangle ? own : all);
#else
    const Spot spot = spotOf(item, pixel, all);
#endif
#if IMAGES
    bool imaged = true;
#endif
#if TRIANGLES
    if (triangle) {
      const ShapeRecord shape = shapeOf(item);
      source *= triangleColor(shape, triangleWeights(shape, spot.at).at);
#if IMAGES
      imaged = paint.y != kPaintsTriangle;
#endif
    } else
#endif
#if IMAGES
    if ((paint.y & kPaintsStored) == 0 && floatBitsToUint(fetch(item.slot, paint.y + 1)).y < kPaintImage) {
      imaged = false;
      source *= gradientAt(item.slot, paint.y - 1, spot.at);
    }
    if (imaged) {
      if ((paint.y & kPaintsStored) != 0) source *= storedColor(paint.y, pixel);
      else source *= imageAt(textureOf(item, paint.y, spot));
    }
#else
    source *= gradientAt(item.slot, paint.y - 1, spot.at);
#endif
  }
#endif
  float weight;
  if (first && (mask != all || difference != 0)) {
    first = false;
    // All before covered the pixel evenly, so one sample speaks for all.
    const float covered = float(bitCount(mask)) * share;
#if EARLY
    const float light = through[0];
#else
    const float light = soft ? through[0] : 1.0;
#endif
    weight = firstEdge(covered, difference, share, light, source.a, scale, gap);
  } else {
    const uint hit = mask & alive;
    weight = float(bitCount(hit));
    if (soft) {
      weight = 0;
      for (uint k = 0; k < 16; ++k) weight += (hit >> k & 1) != 0 ? through[k] : 0.0;
    }
    weight = weight * share * scale + gap;
    gap *= 1.0 - source.a;
  }
  sum += source * weight;
  if (source.a >= 1.0) {
    alive &= ~mask;
  } else {
#if !EARLY
    if (!soft)
      for (uint k = 0; k < 16; ++k) through[k] = 1.0;
#endif
    soft = true;
    const float keep = 1.0 - source.a;
    for (uint k = 0; k < 16; ++k)
      if ((mask >> k & 1) != 0) through[k] *= keep;
  }
}

#if COLORS_ALONE
#elif SOFTWARE // writes the view or the image, as both would convert for both
vec4 storedColor(vec4 color) {
#if TARGET
  return targetColor(color, header.flags);
#else
  return linearColor(color, header.flags);
#endif
}
void storeColor(uvec2 pixel, vec4 stored) {
  if (pixel.x >= header.width || pixel.y >= header.height) return;
#if TARGET
  imageStore(image, ivec2(pixel), stored);
#else
  view[pixel.y * header.width + pixel.x] = uvec2(packHalf2x16(stored.rg), packHalf2x16(stored.ba));
#endif
}
void storePixel(uvec2 pixel, vec4 color) { storeColor(pixel, storedColor(color)); }
#else
void storePixel(uvec2 pixel, vec4 linear, vec4 target) {
  if (pixel.x >= header.width || pixel.y >= header.height) return;
  if ((header.flags & kWriteView) != 0)
    view[pixel.y * header.width + pixel.x] = uvec2(packHalf2x16(linear.rg), packHalf2x16(linear.ba));
#if TARGET
  imageStore(image, ivec2(pixel), target);
#endif
}
void storePixel(uvec2 pixel, vec4 color) {
  storePixel(pixel, linearColor(color, header.flags), targetColor(color, header.flags));
}
#endif

// What is left of the light reaches the background.
void finishPixel() {
#if RICH
  while (depth > 0) leaveLayer();
#endif
#if EARLY
  float light = 0;
#else
  float light = soft ? 0.0 : float(bitCount(alive));
  if (soft)
#endif
    for (uint k = 0; k < 16; ++k) light += (alive >> k & 1) != 0 ? through[k] : 0.0;
  sum += header.background * (light * share * scale + gap);
}
