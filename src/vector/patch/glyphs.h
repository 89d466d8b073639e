// Glyphs: many small drawings under keys of the engine's, converted together, and their baked form (.gpgpf).
#pragma once
#include "vector/patch/drawing.h"

namespace gpgp::vector {

struct Glyphs {
  struct Entry {
    uint64_t key;
    uint32_t paths; ///< how many of the drawing's; glyphs follow each other
    uint32_t reserved = 0;
  };
  explicit Glyphs(std::pmr::memory_resource* memory) : entries(memory), drawing(memory) {}
  std::pmr::vector<Entry> entries;
  Drawing drawing; ///< the paths of all, in em units, in colours and gradients; kForeground tells which take the text's
};

/// Checks and converts glyphs. Errors name the glyph and its path.
core::Result<Glyphs> makeGlyphs(std::span<const GpgpGlyph> glyphs, std::pmr::memory_resource* memory,
                                const GpgpJobSystem* jobs = nullptr);

/// Baked form: little-endian, versioned, checksummed; a key that comes again is an error when it is loaded.
std::pmr::vector<std::byte> bakeGlyphs(const Glyphs& glyphs, std::pmr::memory_resource* memory);
/// Checks everything, as loadBaked does for drawings. Errors: INVALID_DATA.
core::Result<Glyphs> loadBakedGlyphs(std::span<const std::byte> bytes, std::pmr::memory_resource* memory);

} // namespace gpgp::vector
