// The glyphs of a page, each once, as a glyph set takes them.
#pragma once
#include "cli/shared/session.h"
#include "cli/text/page.h"
#include "host/picture.h"

namespace gpgp::cli {

/// A copy of a path.
class KeptPath {
public:
  explicit KeptPath(const GpgpPath& path);
  KeptPath(KeptPath&&) = default; // stops stay where they are
  KeptPath& operator=(KeptPath&&) = default;
  /// Valid as long as this lies where it lies.
  GpgpPath view() const;

private:
  std::vector<GpgpPathVerb> verbs_;
  std::vector<float> points_;
  std::vector<GpgpGradientStop> stops_;
  std::optional<GpgpGradient> gradient_;
  GpgpPath path_;
};

struct PageGlyph {
  uint64_t key = 0;            ///< number of the font, and glyph; 2^63 more: its outline
  std::vector<KeptPath> paths; ///< in em
  std::vector<VkBool32> foreground;
  host::Picture picture;                               ///< of a bitmap glyph; 0 x 0: none
  float box[4] = {};                                   ///< em: left, top, right, bottom
  bool isPicture() const { return picture.width > 0; } ///< a glyph set does not take it
};

struct PageGlyphs {
  std::vector<PageGlyph> glyphs;
  std::vector<uint32_t> which;    ///< of these, for each glyph of the page
  std::vector<uint32_t> outlines; ///< likewise, what is painted below it; empty: the page has no outlines
  struct Broken {
    uint32_t font, glyph; ///< the font's number
  };
  std::vector<Broken> broken; ///< drawn as missing characters, each once
};
PageGlyphs collectGlyphs(TextPage& page);

/// A glyph set of those that are no pictures, as large as they need, and the indices of all; pictures are blank.
std::pair<GlyphSet, std::vector<uint32_t>> makeGlyphSet(Session& session, const PageGlyphs& glyphs);

} // namespace gpgp::cli
