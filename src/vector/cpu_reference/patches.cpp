// The CPU reference of patch tiles, patch blocks and patch fill: every patch asks every tile of its box, then every
// pixel, then every point.
//
// It knows no squares of tiles: that a curve has all of one on one side must say the same as its tiles do.
#include "vector/cpu_reference/patches.h"

#include "vector/patch/patch_reader.h"

#include <cstring>

namespace gpgp::vector {
using shader::kTileSize;
using shader::PatchItemRecord;
using shader::PatchReader;
using shader::PatchTableRecord;
using shader::PlacedPath;
using shader::uvec4;
using shader::vec4;

namespace {

template <class T> T recordAt(const CpuInput& input, size_t place) {
  T record;
  std::memcpy(&record, &input.fetch(shader::kShapeSlot, place), sizeof record);
  return record;
}

/// A patch of a path, in the rows and columns of pixels of one tile.
void coverTile(const CpuInput& input, PatchReader& reader, uint32_t curves, const PatchReader::TilePatch& patch,
               const PatchItemRecord& m, const vec4& scissor, uint32_t what, uint32_t x, uint32_t y,
               std::span<CpuCoverage> path) {
  const uint32_t samples = input.header.samples, all = (1u << samples) - 1;
  for (uint32_t py = y * kTileSize; py < std::min((y + 1) * kTileSize, input.header.height); ++py)
    for (uint32_t px = x * kTileSize; px < std::min((x + 1) * kTileSize, input.header.width); ++px) {
      const auto fx = static_cast<float>(px), fy = static_cast<float>(py);
      CpuCoverage& coverage = path[size_t(py) * input.header.width + px];
      const uint32_t passes = what ? reader.passesThrough(0, curves, patch, m, scissor, what, fx, fy, 1) : 0;
      if (passes == PatchReader::kPatchOutside) continue;
      if (!passes) {
        coverage.mask ^= all;
        continue;
      }
      const auto holds = [&](uint32_t points, uint32_t i) {
        const shader::vec2 at = reader.pointOf(points, i);
        return reader.patchHolds(0, curves, patch, m, scissor, passes, fx + at.x, fy + at.y);
      };
      uint32_t mask = 0;
      for (uint32_t i = 0; i < samples; ++i) mask |= holds(samples, i) ? 1u << i : 0;
      coverage.mask ^= mask;
      if ((input.header.flags & shader::kExactArea) == 0) continue;
      uint32_t count = 0;
      for (uint32_t i = 0; i < 256; ++i) count += holds(256, i);
      coverage.difference += static_cast<int>(count * samples) - shader::bitCount(mask) * 256;
    }
}

} // namespace

bool coverByPatches(const CpuInput& input, uint32_t itemIndex, CpuPlaces& places) {
  if (!input.header.patchTable) return false;
  const auto table = recordAt<PatchTableRecord>(input, input.header.patchTable);
  const auto itemAt = [&](uint32_t i) {
    return recordAt<PatchItemRecord>(input, input.header.patchTable + sizeof(PatchTableRecord) / 16 +
                                                i * sizeof(PatchItemRecord) / 16);
  };
  bool found = false;
  for (uint32_t k = 0; k < table.items; ++k) {
    const PatchItemRecord m = itemAt(k);
    if (m.item != itemIndex) continue;
    found = true;
    const uint32_t end = k + 1 < table.items ? itemAt(k + 1).firstPatch : table.patches;
    const shader::ItemRecord& item = places.items[itemIndex];
    const AssetTable& asset = tableOf(input.assets, item.slot);
    PatchReader reader({reinterpret_cast<const uvec4*>(asset.records.data()), asset.records.size()});
    const auto first = static_cast<uint32_t>(asset.first);
    for (uint32_t i = m.firstPatch; i < end; ++i) {
      const PatchReader::TilePatch patch =
          reader.loadTilePatch(0, m.patches - first + (i - m.firstPatch) * shader::kTilePatchSize);
      const uint32_t path = item.firstPath + patch.path;
      const PlacedPath& p = places.paths[path];
      if (p.left >= p.right) continue;
      const uvec4 tiles = reader.patchTiles(patch, m, item.perspective.w, {p.left, p.top, p.right, p.bottom});
      const size_t pixels = size_t(input.header.width) * input.header.height;
      const auto coverage = std::span(places.coverage).subspan(path * pixels, pixels);
      for (uint32_t y = tiles.y; y < tiles.w; ++y)
        for (uint32_t x = tiles.x; x < tiles.z; ++x) {
          const uint32_t what = reader.passesThrough(0, m.curves - first, patch, m, item.scissor,
                                                     PatchReader::kPatchAllPass, static_cast<float>(x * kTileSize),
                                                     static_cast<float>(y * kTileSize), static_cast<float>(kTileSize));
          if (what == PatchReader::kPatchOutside) continue;
          const uint32_t column = x - p.left;
          shader::TileWord& word =
              places.words[p.firstWord + (y - p.top) * ((p.right - p.left + 31) / 32) + column / 32];
          (what ? word.edges : word.inside) |= 1u << (column & 31);
          coverTile(input, reader, m.curves - first, patch, m, item.scissor, what, x, y, coverage);
        }
    }
  }
  return found;
}

} // namespace gpgp::vector
