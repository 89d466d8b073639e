// The CPU reference of begin, place, mark, small glyphs and fill: items, boxes of tiles, tile words, masks and areas.
#include "vector/cpu_reference/cpu_reference.h"
#include "vector/cpu_reference/patches.h"
#include "vector/place/placement.h"
#include "vector/shared/color.h"
#include "vector/shared/shape.h"

namespace gpgp::vector {
using shader::FlatSegment;
using shader::Grid;
using shader::ItemRecord;
using shader::kItemGrouped;
using shader::kShapeSlot;
using shader::kTileSize;
using shader::PlacedPath;
using shader::SegmentRecord;
using shader::ShapeRecord;
using shader::TileWord;
using shader::vec3;
using shader::vec4;

ShapeRecord shapeOf(const CpuInput& input, const ItemRecord& item) {
  const auto at = [&](uint32_t i) { return input.fetch(kShapeSlot, item.paths + i); };
  const vec4 rest = at(3);
  return {at(0), at(1), at(2), rest.x, rest.y, shader::floatBitsToUint(rest.z), shader::floatBitsToUint(rest.w)};
}

namespace {

/// Segment i of an item.
SegmentRecord segmentOf(const CpuInput& input, const ItemRecord& item, uint32_t i) {
  if (item.slot == kShapeSlot) return shader::shapeSegment(shapeOf(input, item), i);
  const uint32_t at = item.segments + i * 4;
  return {input.fetch(item.slot, at),
          input.fetch(item.slot, at + 1),
          input.fetch(item.slot, at + 2),
          input.word(item.slot, at + 3, 0),
          input.fetch(item.slot, at + 3).y,
          input.word(item.slot, at + 3, 2),
          0};
}

/// Path i of an item, which is its item-th.
PlacedPath placePath(const CpuInput& input, const ItemRecord& item, uint32_t itemIndex, uint32_t i) {
  const uint32_t path = item.paths + i * 3;
  const bool shaped = item.slot == kShapeSlot;
  vec4 box, frame(0, 0, 1, 0), color;
  uint32_t paint = 0, clip = 0, layer = 0;
  bool triangle = false;
  if (shaped) {
    const ShapeRecord shape = shapeOf(input, item);
    triangle = shader::isTriangle(shape);
    box = triangle ? shader::triangleBox(shape) : shape.box;
    if (!triangle) frame = shape.frame;
    color = vec4(vec3(item.color), 1);
    paint = shape.paint;
  } else {
    box = input.fetch(item.slot, path);
    color = input.fetch(item.slot, path + 1);
    paint = input.word(item.slot, path + 2, 0);
    clip = input.word(item.slot, path + 2, 1);
    layer = input.word(item.slot, path + 2, 2);
    if (input.word(item.slot, path + 2, 3) & shader::kForeground) color = vec4(vec3(item.color), color.w);
  }
  const shader::vec2 tiles(input.header.tilesX, input.header.tilesY);
  const shader::uvec4 where = shader::tileBox(item, box, frame, tiles);
  PlacedPath p{where.x, where.y, where.z, where.w, 0, itemIndex, 0, 0, {}};
  const float alpha = color.w * item.color.w;
  p.paint = paint ? input.slots(item.slot).paints + (paint - 1) * 4 + 1 : 0;
  if (triangle) p.paint |= shader::kPaintsTriangle;
  p.group = (clip | layer ? path + 2 + 1 : 0) | (item.clip | item.layer ? kItemGrouped : 0);
  p.color = p.paint && !shaped ? vec4(alpha) : shader::blended(vec3(color), alpha, input.header.flags);
  return p;
}

uint32_t wordsInRow(const PlacedPath& p) { return (p.right - p.left + 31) / 32; }

/// Sets bits from `low` to `high` of a row of tiles.
template <class Change> void eachTile(std::span<TileWord> row, int low, int high, Change&& change) {
  for (int tile = low; tile <= high; ++tile) change(row[static_cast<size_t>(tile) / 32], 1u << (tile & 31));
}

/// As mark does with a flatSegment.
void markFlatSegment(const Grid& grid, const PlacedPath& p, const FlatSegment& flatSegment, std::span<TileWord> words) {
  const int across = static_cast<int>(p.right - p.left), left = static_cast<int>(p.left);
  for (uint32_t y = p.top; y < p.bottom; ++y) {
    const int tileRows = static_cast<int>(kTileSize * grid.samples), row = static_cast<int>(y);
    if (row < flatSegment.first / tileRows || row > flatSegment.last / tileRows) continue;
    const shader::TileSpan span = shader::tilesMet(grid, flatSegment, row);
    const auto tiles = words.subspan((y - p.top) * wordsInRow(p), wordsInRow(p));
    if (span.turned != shader::kNoTile)
      eachTile(tiles, std::max(span.turned - left, 0), static_cast<int>(tiles.size()) * 32 - 1,
               [](TileWord& word, uint32_t bit) { word.inside ^= bit; });
    if (span.low > span.high) continue;
    eachTile(tiles, std::max(span.low - left, 0), std::min(span.high - left, across - 1),
             [](TileWord& word, uint32_t bit) { word.edges |= bit; });
  }
}

/// As the small glyphs pass finds a small glyph's tile words: from what changes in them.
void smallGlyphWords(const CpuInput& input, const PlacedPath& p, std::span<const CpuCoverage> coverage,
                     std::span<TileWord> words) {
  const uint32_t width = input.header.width, height = input.header.height;
  const bool areas = input.header.flags & shader::kExactArea;
  for (uint32_t y = p.top * kTileSize; y < std::min(p.bottom * kTileSize, height); ++y)
    for (uint32_t x = p.left * kTileSize; x < std::min(p.right * kTileSize, width); ++x) {
      const uint32_t bit = 1u << (x / kTileSize - p.left);
      const CpuCoverage& here = coverage[y * width + x];
      TileWord& word = words[y / kTileSize - p.top]; // such a path's rows have one
      if (x % kTileSize == 0 && y % kTileSize == 0 && (here.mask & 1)) word.inside |= bit;
      const uint32_t whole = word.inside & bit ? (1u << input.header.samples) - 1 : 0;
      if (here.mask != whole || (areas && here.difference)) word.edges |= bit;
    }
  for (uint32_t y = p.top; y < p.bottom; ++y) words[y - p.top].smallGlyph = 1;
}

} // namespace

void coverSegment(const Grid& grid, const ItemRecord& item, const SegmentRecord& segment, std::span<CpuCoverage> path) {
  const int n = static_cast<int>(grid.samples);
  const uint32_t flatSegments = shader::flatSegmentCount(grid, item, segment);
  const float step = shader::flatSegmentStep(flatSegments);
  for (uint32_t i = 0; i < flatSegments; ++i) {
    FlatSegment flatSegment;
    if (!shader::flatSegmentOf(grid, item, segment, i, flatSegments, step, flatSegment)) continue;
    for (int row = flatSegment.first; row < flatSegment.last;) { // the rows of one pixel
      const int first = shader::crossingOf(grid, flatSegment, row), column = first >> 8, rowOfPixels = row / n;
      CpuCoverage* pixel = &path[static_cast<size_t>(rowOfPixels) * static_cast<size_t>(grid.columns)];
      int last = first;
      uint32_t rows = 0, missed = 0;
      for (; row < flatSegment.last && row / n == rowOfPixels; ++row) {
        const int x = shader::crossingOf(grid, flatSegment, row);
        if (x >> 8 != column) break;
        last = x;
        ++rows;
        const uint32_t bit = static_cast<uint32_t>(row % n);
        const float sample =
            (static_cast<float>(shader::sampleColumn(bit, grid.samples)) + 0.5f) / static_cast<float>(n);
        const bool covered = static_cast<float>(x & 255) <= 256 * sample;
        missed += !covered;
        const int turned = column < 0 ? 0 : covered ? column : column + 1;
        if (turned < grid.columns) pixel[turned].mask ^= 1u << bit;
      }
      if (column >= 0 && column < grid.columns)
        pixel[column].difference += (flatSegment.side > 0 ? 1 : -1) * shader::areaOf(rows, missed, first, last);
    }
  }
}

void closeCoverage(const Grid& grid, std::span<CpuCoverage> path) {
  const size_t width = static_cast<size_t>(grid.columns);
  for (size_t i = 0; i < path.size(); ++i)
    if (i % width) path[i].mask ^= path[i - 1].mask;
}

CpuPlaces placeOnCpu(const CpuInput& input) {
  const shader::CanvasHeader& header = input.header;
  const Grid grid{header.samples, static_cast<int>(header.height * header.samples), static_cast<int>(header.width)};
  const size_t pixels = size_t(header.width) * header.height;
  CpuPlaces places;
  for (const shader::PlacementRecord& p : input.placements)
    places.items.push_back(shader::placed(input.sources[p.source & ((1u << shader::kSlotBit) - 1)], p));
  places.coverage.resize(header.pathCount * pixels);
  for (uint32_t k = 0; k < places.items.size(); ++k) {
    const ItemRecord& item = places.items[k];
    const bool last = k + 1 == places.items.size();
    const uint32_t pathEnd = last ? header.pathCount : places.items[k + 1].firstPath;
    for (uint32_t i = item.firstPath; i < pathEnd; ++i) {
      PlacedPath p = placePath(input, item, k, i - item.firstPath);
      p.firstWord = static_cast<uint32_t>(places.words.size());
      places.words.resize(places.words.size() + wordsInRow(p) * (p.bottom - p.top));
      places.paths.push_back(p);
    }
    const bool patches = coverByPatches(input, k, places); // then there are no segments
    const auto wordsOf = [&](uint32_t path) { return std::span(places.words).subspan(places.paths[path].firstWord); };
    const auto coverageOf = [&](uint32_t path) { return std::span(places.coverage).subspan(path * pixels, pixels); };
    // A small glyph's segments are not among the recording's.
    const uint32_t segments = item.smallGlyph ? (item.paths - item.segments) / 4
                              : last          ? header.segmentCount - item.firstSegment
                                              : places.items[k + 1].firstSegment - item.firstSegment;
    for (uint32_t i = 0; i < segments; ++i) {
      const SegmentRecord segment = segmentOf(input, item, i);
      const uint32_t path = item.firstPath + segment.path;
      coverSegment(grid, item, segment, coverageOf(path));
      if (item.smallGlyph || !shader::mayMatter(grid, item, segment)) continue;
      const uint32_t flatSegments = shader::flatSegmentCount(grid, item, segment);
      for (uint32_t c = 0; c < flatSegments; ++c) {
        FlatSegment flatSegment;
        if (shader::flatSegmentOf(grid, item, segment, c, flatSegments, shader::flatSegmentStep(flatSegments),
                                  flatSegment))
          markFlatSegment(grid, places.paths[path], flatSegment, wordsOf(path));
      }
    }
    for (uint32_t i = item.firstPath; i < pathEnd; ++i) {
      if (!patches) closeCoverage(grid, coverageOf(i));
      if (item.smallGlyph) smallGlyphWords(input, places.paths[i], coverageOf(i), wordsOf(i));
      const uint32_t end =
          places.paths[i].firstWord + wordsInRow(places.paths[i]) * (places.paths[i].bottom - places.paths[i].top);
      for (uint32_t w = places.paths[i].firstWord; w < end; ++w) {
        uint32_t& entries = item.smallGlyph ? places.smallGlyphEntries : places.entries;
        places.words[w].firstEntry = entries;
        entries += static_cast<uint32_t>(shader::bitCount(places.words[w].edges));
      }
    }
  }
  return places;
}

} // namespace gpgp::vector
