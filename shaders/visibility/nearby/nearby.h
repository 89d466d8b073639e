// What a viewer may see who is up to some distance away from the camera: a superset to sample further views of.
//
// The picture is cut into at most 16 x 16 tiles, each of those into 4 x 4, and each of these again. All hold how near
// and how far what their pixels' centres show is; a triangle that the large ones let pass is asked about with smaller
// ones. By moving, what hides a triangle moves against it by as many pixels as the difference of their inverse
// distances says. A triangle may be seen where, within so many pixels, something shows that is farther than a share of
// its own distance. The share stands for gaps that no pixel shows as yet: a guess, which the results measure, not a
// bound.
#ifndef GPGP_SHADERS_VISIBILITY_NEARBY_H
#define GPGP_SHADERS_VISIBILITY_NEARBY_H
#include "visibility/shared/candidate.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kTileLevels = 3u; ///< of tiles, the largest first
GPGP_CONST uint kMaxTiles = 16u;  ///< in each direction, of the largest
/// Tiles of a camera, of all levels.
GPGP_CONST uint kCameraTiles = kMaxTiles * kMaxTiles * (1u + 16u + 256u);
/// The share of a triangle's distance.
GPGP_CONST float kNearbyShare = 0.5f;

/// Inverse distances along the view: of the nearest and of the farthest that a tile shows; 0 where that is nothing.
struct Tile {
  float nearest;
  float farthest;
};

/// Pixels of a level's tiles in each direction.
GPGP_FN uint tileSide(uint width, uint height, uint level) {
  uint smallest = (max(width, height) + kMaxTiles * 32u - 1u) / (kMaxTiles * 32u) * 2u;
  return smallest << (4u - level * 2u);
}

/// Where a camera's tile lies.
GPGP_FN uint tileAt(uint camera, uint level, uint x, uint y) {
  uint before = level == 0u ? 0u : level == 1u ? 1u : 17u; // times the largest
  return camera * kCameraTiles + before * (kMaxTiles * kMaxTiles) + y * (kMaxTiles << (level * 2u)) + x;
}

/// The inverse distance of a depth; scale: a camera's. x: depth of what is infinitely far, y: distance times
/// (depth - x), inverse. z: pixels that a thing at distance 1 moves by.
GPGP_FN float inverseDistance(vec4 scale, float depth) {
  GPGP_PRECISE float inverse = (depth - scale.x) * scale.y;
  return max(inverse, 0.0f);
}

/// Of what a pixel's centre shows.
GPGP_FN float inverseOfKey(vec4 scale, uint key, bool reversed) {
  if (key == kFarthest) return 0.0f;
  return inverseDistance(scale, uintBitsToFloat(reversed ? ~key : key));
}

/// Of the nearest corner.
GPGP_FN float nearestInverse(vec4 scale, ScreenTriangle t, bool reversed) {
  return inverseDistance(scale, reversed ? t.zMax : t.zMin);
}

/// First and last tile, whose side is given, that pixels up to `reach` away from bounds lie in; both corners inclusive.
GPGP_FN ivec4 tilesAround(ivec4 bounds, int reach, Grid grid, uint side) {
  int size = int(side);
  ivec4 r;
  r.x = max(bounds.x - reach, 0) / size;
  r.y = max(bounds.y - grid.top - reach, 0) / size;
  r.z = min(bounds.z - 1 + reach, grid.pixels.x - 1) / size;
  r.w = min(bounds.w - 1 - grid.top + reach, grid.pixels.y - 1) / size;
  return r;
}

/// By how many pixels the nearest of what may hide a triangle moves against it.
GPGP_FN int reachOf(vec4 scale, float occluder, float own) {
  GPGP_PRECISE float pixels = (occluder - own) * scale.z + 1.0f;
  return int(clamp(pixels, 0.0f, 8192.0f));
}

GPGP_CONST int kMostParallax = 16;   ///< samples: a quarter of a pixel
GPGP_CONST uint kMovedEntries = 16u; ///< of a pixel's list

/// By how many samples a triangle moves against what is nearest in its pixel, kMostParallax at most; both by their
/// keys. place: in the pixel's order. What lies behind many others, behind leaves for example, hardly ever comes out
/// between all of them: it does not move.
GPGP_FN int parallaxOf(vec4 scale, uint nearest, uint own, uint place, bool reversed) {
  if (scale.z == 0.0f || place >= kMovedEntries) return 0;
  GPGP_PRECISE float samples =
      (inverseOfKey(scale, nearest, reversed) - inverseOfKey(scale, own, reversed)) * scale.z * 64.0f;
  return int(clamp(samples, 0.0f, float(kMostParallax)));
}

/// Whether a triangle may be seen where that far shows.
GPGP_FN bool mayShow(float own, float farthest) {
  GPGP_PRECISE float least = farthest * kNearbyShare;
  return own >= least;
}

GPGP_SHADER_END
#endif
