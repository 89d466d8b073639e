// compare_pictures A.png B.png [TOLERANCE [SHARE [TILE]]]: how two pictures of one size differ.
//
// With TILE, the means of tiles of so many pixels a side are compared, which the engine's own edges hardly change.
// Passes where at most SHARE (default 0.002) of the pixels differ by more than TOLERANCE (default 8 of 255) in a
// channel: devices round edges differently, but on few pixels. Exit codes: 0 alike, 1 not alike, 2 wrong usage.
#include "host/picture.h"

#include <cstdio>
#include <cstdlib>
#include <exception>

namespace {
/// Each pixel of a tile becomes their mean. Rows and columns that fill no tile are left out.
gpgp::host::Picture tiled(const gpgp::host::Picture& from, uint32_t tile) {
  gpgp::host::Picture to{from.width / tile, from.height / tile, {}};
  for (uint32_t y = 0; y < to.height; ++y)
    for (uint32_t x = 0; x < to.width; ++x)
      for (uint32_t c = 0; c < 4; ++c) {
        uint32_t sum = 0;
        for (uint32_t i = 0; i < tile * tile; ++i)
          sum += from.rgba[(size_t{y * tile + i / tile} * from.width + x * tile + i % tile) * 4 + c];
        to.rgba.push_back(static_cast<uint8_t>(sum / (tile * tile)));
      }
  return to;
}
} // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 6) {
    std::fprintf(stderr, "usage: compare_pictures A.png B.png [TOLERANCE [SHARE [TILE]]]\n");
    return 2;
  }
  const int tolerance = argc > 3 ? std::atoi(argv[3]) : 8;
  const double share = argc > 4 ? std::atof(argv[4]) : 0.002;
  try {
    gpgp::host::Picture a = gpgp::host::readPng(argv[1]), b = gpgp::host::readPng(argv[2]);
    if (const int tile = argc > 5 ? std::atoi(argv[5]) : 1; tile > 1)
      for (gpgp::host::Picture* picture : {&a, &b}) *picture = tiled(*picture, static_cast<uint32_t>(tile));
    const gpgp::host::PictureDifference difference = gpgp::host::compare(a, b);
    const uint64_t pixels = uint64_t{a.width} * a.height;
    uint64_t beyond = 0;
    for (uint64_t i = 0; i < pixels; ++i) {
      bool differs = false;
      for (uint64_t c = 0; c < 4; ++c) differs |= std::abs(a.rgba[i * 4 + c] - b.rgba[i * 4 + c]) > tolerance;
      beyond += differs ? 1 : 0;
    }
    const double found = static_cast<double>(beyond) / static_cast<double>(pixels);
    std::printf("%u x %u: largest difference %u, mean %.4f; %llu pixels differ, %llu (%.4f %%) by more than %d\n",
                a.width, a.height, difference.largest, difference.mean,
                static_cast<unsigned long long>(difference.pixelsDifferent), static_cast<unsigned long long>(beyond),
                found * 100.0, tolerance);
    return found <= share ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compare_pictures: %s\n", error.what());
    return 1;
  }
}
