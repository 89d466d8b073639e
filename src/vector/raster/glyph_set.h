// A glyph set as the engine holds it: outlines in one device buffer within budgets, found by key and drawn by index.
//
// A glyph is a block of the buffer: its segments, its paths with their boxes, then their gradients; then its patches.
// An index is a place in a table with the generation of what lies there, so that an index of what was evicted is
// recognised. Evicted is what was used longest ago, and nothing that a frame not yet safe may read. Recording reads the
// table and notes the frame, no more.
#pragma once
#include "core/resident.h"
#include "vector/patch/glyphs.h"
#include "vector/patch/patches.h"

#include <atomic>

namespace gpgp::vector {

class GlyphSet final : public core::Resident {
public:
  struct Glyph {
    uint32_t first = 0, size = 0;     ///< its block, in vec4
    uint32_t segments = 0, paths = 0; ///< none where the set has no outlines
    uint32_t patches = 0;             ///< where they begin, in vec4
    PatchQuads quads;
    shader::vec2 middle = {}; ///< of the path that it is
    shader::vec2 reach = {};  ///< from there to the sides of its box; infinite where it is not one path
    shader::vec4 ink = {};    ///< the box of all boxes of its paths; turned over without any
    uint16_t generation = 0;  ///< of the glyph; of the next one where there is none
    bool living = false, gradients = false;
    mutable uint64_t lastUsed = 0; ///< frame
    uint64_t upload = 0;           ///< its range's number; 0: nothing to upload
    uint64_t key = 0;
    /// By any number of records side by side.
    void use(uint64_t frame) const { std::atomic_ref(lastUsed).store(frame, std::memory_order_relaxed); }
  };
  /// bytes: what info.data or info.filePath have, where one of them is set; their glyphs are there from the beginning.
  static core::Result<core::Unique<GlyphSet>> create(core::Context& context, const GpgpGlyphSetCreateInfo& info,
                                                     std::span<const std::byte> bytes);
  GlyphSet(core::Context& owner, const char* name);

  /// Adds those whose keys are new, as used in `frame`, as far as there is room; false where that did not suffice.
  bool add(const Glyphs& glyphs, uint64_t frame);
  uint32_t indexOf(uint64_t key); ///< GPGP_GLYPH_NONE where there is none; counts as a use
  void getInfo(GpgpGlyphSetInfo& info) const;

  GpgpDrawingMethods methods() const { return methods_; }
  std::span<const Glyph> table() const { return glyphs_; }
  /// Of a table. Null where the index is not, or no longer, one of the set's.
  static const Glyph* find(std::span<const Glyph> table, uint32_t index) {
    const uint32_t place = index & (kMaxGlyphs - 1);
    if (place >= table.size()) return nullptr;
    const Glyph& found = table[place];
    return found.living && found.generation == index >> kPlaceBits ? &found : nullptr;
  }
  const Glyph* glyph(uint32_t index) const { return find(glyphs_, index); }
  using Resident::arrived;
  /// Where the set begins in its buffer, in vec4; `first` and `patches` of glyphs count from there.
  uint32_t firstRecord() const { return static_cast<uint32_t>(offset() / 16); }
  /// Its segments, its BoxedPaths, and, at the next multiple of their size, its gradients' records and stops.
  std::span<const std::byte> block(const Glyph& glyph) const {
    return Resident::bytes().subspan(size_t(glyph.first) * 16, size_t(glyph.size) * 16);
  }

  static constexpr uint32_t kPlaceBits = 18, kMaxGlyphs = 1u << kPlaceBits;

private:
  struct Tables; ///< what glyphs are converted to
  bool add(const Glyphs& glyphs, const Tables& tables, uint64_t frame);
  struct Block { // of the buffer, in vec4
    uint32_t first, size;
  };
  static constexpr uint32_t kNone = UINT32_MAX;
  size_t cellOf(uint64_t key) const; ///< where the key is, or would be
  void remove(uint32_t place);
  uint32_t takeBlock(uint32_t size); ///< kNone where no free block is large enough
  void freeBlock(Block block);
  bool evictable(const Glyph& glyph) const;
  void queueBlocks(std::span<const uint32_t> places);

  GpgpDrawingMethods methods_ = GPGP_DRAWING_FLATTENED;
  std::pmr::vector<Glyph> glyphs_;     // by place
  std::pmr::vector<uint32_t> places_;  // free ones
  std::pmr::vector<uint32_t> cells_;   // hash table, open addresses: places, kNone where empty; at most half full
  std::pmr::vector<Block> freeBlocks_; // by where they lie; neighbours are one
  uint32_t capacity_ = 0, used_ = 0;   // vec4
  uint64_t evicted_ = 0, neededGlyphs_ = 0, needed_ = 0;
};

} // namespace gpgp::vector
