// How far two pictures are apart where they are furthest apart: a tile of 8 x 8 pixels that is wrong is a hundredth of
// a percent of a picture, which no mean shows.
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>

namespace gpgp::test {

struct TileDifference {
  uint32_t x = 0, y = 0; ///< the pixel at its upper left
  double mean = 0;       ///< of its pixels
  std::string where() const { return "the tile at " + std::to_string(x) + " " + std::to_string(y); }
};

constexpr uint32_t kTileSide = 8;

/// Calls call(tile) for each tile; differs(x, y): how far a pixel does.
template <class Differs, class Call>
void forTiles(uint32_t width, uint32_t height, const Differs& differs, const Call& call) {
  for (uint32_t top = 0; top < height; top += kTileSide)
    for (uint32_t left = 0; left < width; left += kTileSide) {
      const uint32_t right = std::min(left + kTileSide, width), bottom = std::min(top + kTileSide, height);
      double sum = 0;
      for (uint32_t y = top; y < bottom; ++y)
        for (uint32_t x = left; x < right; ++x) sum += static_cast<double>(differs(x, y));
      call(TileDifference{left, top, sum / (double(right - left) * double(bottom - top))});
    }
}

/// The tile whose pixels differ most on average.
template <class Differs> TileDifference worstTile(uint32_t width, uint32_t height, const Differs& differs) {
  TileDifference worst;
  forTiles(width, height, differs, [&worst](const TileDifference& tile) {
    if (tile.mean > worst.mean) worst = tile;
  });
  return worst;
}

} // namespace gpgp::test
