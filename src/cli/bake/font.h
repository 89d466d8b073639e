// A font's glyphs, or those that chosen characters need, to their baked form.
#pragma once
#include "cli/shared/command.h"

#include <gpgp/gpgp.hpp>

#include <string>
#include <vector>

namespace gpgp::cli {

struct BakeFontOptions {
  std::vector<std::string> characters, characterFiles, ranges; ///< of each any number; none at all: all glyphs
  std::string axes;
  uint32_t face = 0;
  float outline = 0; ///< em; 0: none
  bool chosen() const { return !characters.empty() || !characterFiles.empty() || !ranges.empty(); }
};

/// Adds the options of a font.
void addBakeFontOptions(CLI::App& command, BakeFontOptions& options);

struct BakedFont {
  Blob blob;
  Json json;         ///< what is told of it beside its size
  std::string words; ///< the same for people
};
/// Throws Failure, which names the file, or Usage. Says on standard error which characters the font has not, and which
/// glyphs are pictures or broken.
BakedFont bakeFont(const std::string& bytes, const std::string& name, const BakeFontOptions& options);

} // namespace gpgp::cli
