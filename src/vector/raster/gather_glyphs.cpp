// Glyphs of a text as placements, and which of them are for small_glyphs.comp.
#include "vector/place/placement.h"
#include "vector/raster/gather.h"
#include "vector/shared/edge.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace gpgp::vector {
using core::Result;
using shader::ItemRecord;
namespace {
/// Four numbers that are worked on together (vectors of GCC and Clang).
using Floats = float __attribute__((vector_size(16)));
using Wholes = int32_t __attribute__((vector_size(16)));
using Words = uint32_t __attribute__((vector_size(16)));

template <class Vector> Vector load(const void* from) {
  Vector vector;
  std::memcpy(&vector, from, sizeof vector);
  return vector;
}
Floats atMost(Floats v, float limit) { // also where it is not a number
  const Floats high = Floats{} + limit;
  return v < high ? v : high;
}
Floats atLeast(Floats v, float limit) {
  const Floats low = Floats{} + limit;
  return v > low ? v : low;
}
Wholes wholeOf(Floats v) { return __builtin_convertvector(v, Wholes); }

/// Notes, without a branch, whether a number of an instance is doubtful: as bits, numbers from 0 on are in order.
class Doubt {
public:
  void see(const GpgpGlyphInstance& instance) {
    static_assert(sizeof instance == 2 * sizeof(Words) && offsetof(GpgpGlyphInstance, color) == sizeof(Words));
    see(load<Words>(&instance) & Words{0, 0x7fffffffu, 0x7fffffffu, 0xffffffffu},
        Floats{0, kMaxCoordinate, kMaxCoordinate, kMaxCoordinate});
    see(load<Words>(instance.color), Floats{kMaxColor, kMaxColor, kMaxColor, 1});
  }
  bool any() const { return (bits_[0] | bits_[1] | bits_[2] | bits_[3]) >> 31 != 0; }

private:
  void see(Words numbers, Floats most) { bits_ |= numbers | (std::bit_cast<Words>(most) - numbers); }
  Words bits_ = {};
};
} // namespace

/// Some glyphs of a text, by numbers, so that four are asked about at a time.
struct Gather::Block {
  static constexpr size_t kMost = 64;
  uint32_t firstRecord = 0; ///< of the set
  uint64_t set = 0;         ///< which it is
  const GpgpGlyphInstance* from[kMost];
  const GlyphSet::Glyph* glyph[kMost];
  float x[kMost], y[kMost], reachX[kMost], reachY[kMost]; ///< boxes: middles, and from there to the sides
  uint32_t tiles[kMost];                                  ///< see SmallGlyph
  struct Sums {
    size_t glyphs = 0;
    uint64_t paths = 0;
    bool gradients = false;
  } sums;

  void put(size_t k, const GpgpGlyphInstance& instance, const GlyphSet::Glyph& which) {
    from[k] = &instance;
    glyph[k] = &which;
    x[k] = instance.x + instance.size * which.middle.x;
    y[k] = instance.y + instance.size * which.middle.y;
    reachX[k] = instance.size * which.reach.x;
    reachY[k] = instance.size * which.reach.y;
  }
};

/// Finds which glyphs are for small_glyphs.comp: small ones that no scissor cuts.
class Gather::SmallGlyph {
public:
  SmallGlyph(const ItemRecord& source, const GpgpCanvasInfo& info)
      : map_(source.transform), at_(source.offsets), scissor_(source.scissor), cut_(shader::hasScissor(source)),
        width_(static_cast<float>(info.width)), height_(static_cast<float>(info.height)) {}

  /// How many tiles each may have edges in; 0 where it is none of them.
  void countTiles(Block& block) const {
    // With room for the margins that shaders take (placeOf in small_glyphs.comp, place.comp). Those grow with the
    // place, but what is small and reaches the canvas is near it.
    const float margin = 1.1f + 2e-5f * (std::max(width_, height_) + 4 * kFar);
    for (size_t k = block.sums.glyphs; k % 4 != 0; ++k) block.x[k] = block.y[k] = block.reachX[k] = block.reachY[k] = 0;
    for (size_t k = 0; k < block.sums.glyphs; k += 4) {
      const Floats x = load<Floats>(block.x + k), y = load<Floats>(block.y + k);
      const Floats reachX = load<Floats>(block.reachX + k), reachY = load<Floats>(block.reachY + k);
      const Floats px = map_.x * x + (map_.z * y + at_.z), py = map_.y * x + (map_.w * y + at_.w);
      const Floats farX = std::abs(map_.x) * reachX + std::abs(map_.z) * reachY,
                   farY = std::abs(map_.y) * reachX + std::abs(map_.w) * reachY;
      const Wholes pairs = wholeOf(atMost(farX, kFar) + 2.95f), rows = wholeOf(atMost(farY, kFar) * 2.0f + 2.5f);
      const Floats sideX = farX + margin, sideY = farY + margin;
      const Floats most = across(px - sideX, px + sideX, width_) * across(py - sideY, py + sideY, height_);
      Wholes small = (most <= float(shader::kSmallGlyphTiles)) & (pairs * rows <= int(shader::kSmallGlyphPairs));
      if (cut_)
        small &= (px - sideX > scissor_.x) & (px + sideX < scissor_.z) & (py - sideY > scissor_.y) &
                 (py + sideY < scissor_.w);
      const Wholes tiles = wholeOf(most) & small;
      std::memcpy(block.tiles + k, &tiles, sizeof tiles);
    }
  }

private:
  /// How many tiles lie there along an axis of the canvas, or the nearest one.
  static Floats across(Floats low, Floats high, float end) {
    const Words first = std::bit_cast<Words>(wholeOf(atMost(atLeast(low, 0), end))) / shader::kTileSize,
                last = std::bit_cast<Words>(wholeOf(atMost(atLeast(high, 0), end))) / shader::kTileSize;
    return __builtin_convertvector(std::bit_cast<Wholes>(last - first), Floats) + 1.0f;
  }
  static constexpr float kFar = 128; // has too many pairs of pixels, as have infinity and NaN
  const shader::vec4 map_, at_, scissor_;
  const bool cut_;
  const float width_, height_;
};

/// A placement for each glyph that has paths, as long as there is room. This is what changing text costs.
Result<void> Gather::addGlyphs(const GlyphSet& set, std::span<const GpgpGlyphInstance> glyphs, uint32_t source) {
  const bool hidden = source == kNone && !full_;
  ItemRecord map{};
  bool smallGlyph = false;
  if (source != kNone) {
    ItemRecord& item = tables_.sources[source];
    item.whole = 1;
    if (!placesGlyphs(item)) return {}; // covers nothing
    smallGlyph = smallGlyphRoom_ && item.perspective.w == 0;
    map = item;
    const uint32_t first = set.firstRecord();
    const auto slot = bind(set, {first, first, first, first}); // its glyphs count paints and stops from there
    if (!slot) return slot.error();
    full_ = full_ || *slot == kNone;
    source |= full_ ? 0 : *slot << shader::kSlotBit;
  }
  const SmallGlyph smallGlyphs(map, info_);
  const std::span<const GlyphSet::Glyph> table = set.table();
  const uint64_t frame = context_.current(), arrived = set.arrived();
  Block block;
  block.firstRecord = set.firstRecord();
  block.set = kept_ ? identityOf(set) : 0;
  for (size_t i = 0; i < glyphs.size();) {
    const size_t first = i;
    Doubt doubt;
    Block::Sums sums; // not in the block, where each of its glyphs would wait for the one before
    for (; i < glyphs.size() && sums.glyphs < Block::kMost; ++i) {
      const GpgpGlyphInstance& from = glyphs[i];
      const GlyphSet::Glyph* const glyph = GlyphSet::find(table, from.glyph);
      if (!glyph && from.glyph == GPGP_GLYPH_NONE) continue;
      if (!glyph)
        return wrong(GPGP_ERROR_INVALID_ARGUMENT, ".glyphs[%zu].glyph is not, or no longer, in the set: it was evicted",
                     i);
      if (glyph->upload > arrived) return core::makeError(GPGP_NOT_READY, "a glyph is not resident");
      doubt.see(from);
      glyph->use(frame);
      if (glyph->paths == 0 || hidden) continue;
      block.put(sums.glyphs++, from, *glyph);
      sums.paths += glyph->paths;
      sums.gradients |= glyph->gradients;
    }
    if (doubt.any())
      if (auto ok = checkInstances(glyphs, first, i); !ok) return ok;
    block.sums = sums;
    if (smallGlyph)
      smallGlyphs.countTiles(block);
    else
      std::fill_n(block.tiles, sums.glyphs, 0u);
    addBlock(block, source);
  }
  return {};
}

bool Gather::showsGlyph(const Block& block, size_t k, uint32_t source) {
  const GpgpGlyphInstance& from = *block.from[k];
  const GlyphSet::Glyph& glyph = *block.glyph[k];
  const uint32_t map = source & ((1u << shader::kSlotBit) - 1);
  const auto state = [&](StateHash& hash) { hash.add(block.set).add(from).add(glyph.key); };
  const auto tiles = [&] {
    shader::PlacementRecord placement{};
    placement.x = from.x;
    placement.y = from.y;
    placement.size = from.size;
    return planner_ ? TileBox{} : tilesOf(shader::placed(tables_.sources[map], placement), glyph.ink, kNoFrame);
  };
  return shows(map, state, tiles);
}

void Gather::addBlock(const Block& block, uint32_t source) {
  Used used = used_; // a copy, which what is placed cannot be part of
  const Block::Sums& sums = block.sums;
  gradients = gradients || sums.gradients;
  const bool roomy =
      !full_ && used.glyphs + sums.glyphs <= budgets_.glyphs && used.paths + sums.paths <= budgets_.paths;
  for (size_t k = 0; k < sums.glyphs; ++k) {
    const GpgpGlyphInstance& from = *block.from[k];
    const GlyphSet::Glyph& glyph = *block.glyph[k];
    if (!roomy && (used.glyphs >= budgets_.glyphs || glyph.paths > budgets_.paths - used.paths)) full_ = true;
    ++used.glyphs;
    if (!roomy && full_) {
      pathsDropped_ += glyph.paths;
      continue;
    }
    if (kept_ && !showsGlyph(block, k, source)) continue;
    const uint32_t tiles = block.tiles[k];
    const bool smallGlyph = tiles && tiles <= smallGlyphRoom_ - used.smallGlyphEntries;
    const float* c = from.color;
    placed_[used.placements++] = {from.x,
                                  from.y,
                                  from.size,
                                  source | uint32_t(smallGlyph) << shader::kSmallGlyphBit,
                                  {c[0], c[1], c[2], c[3]},
                                  used.segments,
                                  used.paths,
                                  block.firstRecord + glyph.first,
                                  block.firstRecord + glyph.first +
                                      glyph.segments * uint32_t(sizeof(shader::SegmentRecord) / 16)};
    if (smallGlyph) {
      used.smallGlyphEntries += tiles;
      ++used.smallGlyphs;
    } else {
      used.segments += glyph.segments;
    }
    used.paths += glyph.paths;
  }
  used_ = used;
}

/// Instances from `first` to `end`, one by one.
Result<void> Gather::checkInstances(std::span<const GpgpGlyphInstance> glyphs, size_t first, size_t end) const {
  constexpr float kMost = kMaxCoordinate;
  for (size_t i = first; i < end; ++i) {
    const GpgpGlyphInstance& g = glyphs[i];
    if (g.glyph == GPGP_GLYPH_NONE) continue;
    if (!(std::abs(g.x) <= kMost && std::abs(g.y) <= kMost && g.size >= 0 && g.size <= kMost))
      return wrong(GPGP_ERROR_INVALID_ARGUMENT, ".glyphs[%zu]: x, y or size is out of range", i);
    if (!inColorRange(g.color)) return wrong(GPGP_ERROR_INVALID_ARGUMENT, ".glyphs[%zu].color is out of range", i);
  }
  return {};
}

} // namespace gpgp::vector
