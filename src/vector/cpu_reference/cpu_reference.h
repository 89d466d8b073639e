// The CPU reference of the canvas: the same functions as the shaders (shaders/vector/*.h), run in plain loops.
//
// What it paints knows neither bins nor lists nor entries: every flattened segment turns over all samples right of it
// on the canvas, and every pixel asks all paths. Guarantees: boxes of tiles, tile words, masks, areas and lists equal
// the GPU's bit for bit; colours within bounds that it works out itself, as roots, powers and filters are only as exact
// as the device's. For tests and tools; never part of the library.
#pragma once
#include "vector/cpu_reference/asset_table.h"
#include "vector/shared/tiles.h"

#include <vulkan/vulkan_core.h>

#include <array>
#include <span>
#include <vector>

namespace gpgp::vector {

/// An image of one level that items paint with, and its sampler; what it holds the header says.
struct CpuImage {
  uint32_t width = 0, height = 0;
  std::span<const uint32_t> texels; ///< 8-bit RGBA, rows from the top
  VkFilter filter = VK_FILTER_NEAREST;
  VkSamplerAddressMode mode = VK_SAMPLER_ADDRESS_MODE_REPEAT; ///< along both axes
};

/// What the GPU finds in its buffers, word for word.
struct CpuInput {
  shader::CanvasHeader header{};
  std::vector<AssetTable> assets; ///< the recording's shapes; drawings and glyph sets
  std::span<const shader::PlacementRecord> placements;
  std::span<const shader::ItemRecord> sources;
  std::span<const CpuImage> images;
  float subTexel = 1.0f / 256; ///< how exactly the device places a sample between texels

  const shader::vec4& fetch(uint32_t slot, size_t i) const { return tableOf(assets, slot)[i]; }
  uint32_t word(uint32_t slot, size_t i, int component) const {
    return shader::floatBitsToUint(fetch(slot, i)[component]);
  }
  const shader::SlotRecord& slots(uint32_t slot) const { return tableOf(assets, slot).slots; }
};

/// What a path covers of a pixel: samples, and by how much its area differs from them (1/256 of a sample).
struct CpuCoverage {
  uint32_t mask = 0;
  int difference = 0;
  bool operator==(const CpuCoverage&) const = default;
};

/// Turns over what a segment's flattened segments have right of them, and after all of them (`closed`) sums that up:
/// what remains are masks. `path`: rows of pixels.
void coverSegment(const shader::Grid& grid, const shader::ItemRecord& item, const shader::SegmentRecord& segment,
                  std::span<CpuCoverage> path);
void closeCoverage(const shader::Grid& grid, std::span<CpuCoverage> path);

/// What the passes up to fill find: as their buffers hold it, but for the order in which room was taken.
struct CpuPlaces {
  std::vector<shader::ItemRecord> items;
  std::vector<shader::PlacedPath> paths; ///< firstWord: as if room were taken in painting order
  std::vector<shader::TileWord> words;   ///< firstEntry: the same
  std::vector<CpuCoverage> coverage;     ///< of each path, rows of pixels
  uint32_t entries = 0, smallGlyphEntries = 0;

  const CpuCoverage& at(const shader::CanvasHeader& header, size_t path, uint32_t x, uint32_t y) const {
    return coverage[(path * header.height + y) * header.width + x];
  }
};
CpuPlaces placeOnCpu(const CpuInput& input);
/// Of an item that is one.
shader::ShapeRecord shapeOf(const CpuInput& input, const shader::ItemRecord& item);

/// A tile's list of paths, front to back, up to the first that hides the rest, and which shader takes it.
struct CpuList {
  struct Listed {
    uint32_t path;
    bool edges, inside;
  };
  std::vector<Listed> paths;
  enum Kind { solid, rows, pixels, rich, crowded } kind = solid; ///< crowded: there are more paths than room
};
/// As software devices have them, with room for as many paths in each.
std::vector<CpuList> listOnCpu(const CpuInput& input, const CpuPlaces& places, uint32_t room);
/// Which tiles take the general shader where devices have barriers.
std::vector<bool> splitOnCpu(const CpuInput& input, const CpuPlaces& places);
/// The paths in each bin, front to back.
std::vector<std::vector<uint32_t>> binOnCpu(const CpuInput& input, const CpuPlaces& places);

/// A colour and how far from it the GPU's may be, by channel.
struct CpuColor {
  shader::vec4 color{}, doubt{};
};
/// What paints in a pixel, premultiplied: a path's colour, times its gradient's or image's, or a triangle's. `mask`:
/// the samples that the path covers.
CpuColor paintAt(const CpuInput& input, const CpuPlaces& places, const shader::PlacedPath& path, uint32_t x, uint32_t y,
                 uint32_t mask);
/// The whole picture, as the target receives it: before it is rounded to the format.
std::vector<CpuColor> paintOnCpu(const CpuInput& input, const CpuPlaces& places);

} // namespace gpgp::vector
