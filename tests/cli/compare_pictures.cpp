// compare_pictures A.png B.png [TOLERANCE [SHARE]]: how two pictures of one size differ.
//
// Passes where at most SHARE (default 0.002) of the pixels differ by more than TOLERANCE (default 8 of 255) in a
// channel: devices round edges differently, but on few pixels. Exit codes: 0 alike, 1 not alike, 2 wrong usage.
#include "host/picture.h"

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv) {
  if (argc < 3 || argc > 5) {
    std::fprintf(stderr, "usage: compare_pictures A.png B.png [TOLERANCE [SHARE]]\n");
    return 2;
  }
  const int tolerance = argc > 3 ? std::atoi(argv[3]) : 8;
  const double share = argc > 4 ? std::atof(argv[4]) : 0.002;
  try {
    const gpgp::host::Picture a = gpgp::host::readPng(argv[1]), b = gpgp::host::readPng(argv[2]);
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
