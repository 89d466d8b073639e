// A canvas beside cairo: what both paint, as premultiplied sRGB-encoded colours.
#pragma once
#include "../cairo_draw.h"
#include "canvas_fixture.h"
#include "tile_difference.h"

namespace gpgp::test {

struct CairoTest : CanvasTest {
  CairoTest() { blendSrgb = encodeSrgb = true; }
  /// What cairo paints, premultiplied.
  static std::vector<Rgba> cairoPicture(std::span<const GpgpPath> paths, std::span<const GpgpPathGroup> groups,
                                        double scale, uint32_t size) {
    return cairoPicture(paths, groups, scale, scale, size, size);
  }
  static std::vector<Rgba> cairoPicture(std::span<const GpgpPath> paths, std::span<const GpgpPathGroup> groups,
                                        double scaleX, double scaleY, uint32_t width, uint32_t height) {
    return cairoPicture(width, height, [&](cairo_t* c) {
      cairo_scale(c, scaleX, scaleY);
      drawWithCairo(c, paths, groups);
    });
  }
  template <class Draw> static std::vector<Rgba> cairoPicture(uint32_t width, uint32_t height, const Draw& draw) {
    cairo_surface_t* surface =
        cairo_image_surface_create(CAIRO_FORMAT_ARGB32, static_cast<int>(width), static_cast<int>(height));
    cairo_t* c = cairo_create(surface);
    cairo_set_antialias(c, CAIRO_ANTIALIAS_BEST);
    draw(c);
    cairo_destroy(c);
    cairo_surface_flush(surface);
    std::vector<Rgba> pixels;
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t x = 0; x < width; ++x) {
        uint32_t word;
        std::memcpy(&word,
                    cairo_image_surface_get_data(surface) + y * size_t(cairo_image_surface_get_stride(surface)) + x * 4,
                    4);
        const auto channel = [word](int shift) { return static_cast<float>(word >> shift & 255) / 255; };
        pixels.push_back({channel(16), channel(8), channel(0), channel(24)});
      }
    cairo_surface_destroy(surface);
    return pixels;
  }
  static float differenceOf(const Rgba& a, const Rgba& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b), std::abs(a.a - b.a)});
  }
  struct Difference {
    double mean = 0, far = 0; ///< of all pixels; how many are off by more than 16/255, as a share
    TileDifference worst;     ///< the tile that is furthest off
  };
  static Difference compare(const std::vector<Rgba>& a, const std::vector<Rgba>& b, uint32_t width) {
    Difference d;
    for (size_t i = 0; i < a.size(); ++i) {
      const float off = differenceOf(a[i], b[i]);
      d.mean += static_cast<double>(off);
      d.far += off > 16.0f / 255;
    }
    d.mean /= static_cast<double>(a.size());
    d.far /= static_cast<double>(a.size());
    d.worst = worstTile(width, static_cast<uint32_t>(a.size() / width), [&](uint32_t x, uint32_t y) {
      return differenceOf(a[size_t{y} * width + x], b[size_t{y} * width + x]);
    });
    return d;
  }
};

} // namespace gpgp::test
