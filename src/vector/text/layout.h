// A text laid out: runs, lines, and where everything is. The stages:
//
//   analyse     characters, styles, levels, boundaries, runs          layout.cpp
//   shapeRuns   glyphs of each run, a width for each character        layout.cpp
//   breakLines  lines within the width, cut off where asked for       lines.cpp
//   place       pieces of lines to places, glyphs, decorations        place.cpp
//   carets, selections and hit tests ask the pieces                   query.cpp
//
// A character's width is its cluster's, shared by the graphemes in it and held by the first character of each.
#pragma once
#include "vector/text/itemize.h"

namespace gpgp::text {

class Layout {
public:
  static constexpr uint32_t kMagic = 0x6c61796f; // "layo"
  uint32_t magic = kMagic;
  const Messages messages;

  explicit Layout(std::weak_ptr<Shaper> shaper, Messages to) : messages(std::move(to)), shaper_(std::move(shaper)) {
    clear();
  }
  Result<void> set(const GpgpTextInfo& info);
  void clear();

  void info(GpgpLayoutInfo& info) const;
  void selection(uint32_t begin, uint32_t end, std::vector<GpgpTextRect>& rects) const;
  GpgpCaret caret(uint32_t offset, bool trailing) const;
  GpgpTextHit hit(float x, float y) const;
  struct Moved {
    uint32_t offset;
    bool trailing;
  };
  Result<Moved> move(uint32_t offset, bool trailing, GpgpCaretMove move);

private:
  struct Paragraph {
    uint32_t begin, end;
    uint8_t level;
  };
  /// Neighbouring characters of one run in one line.
  struct Piece {
    uint32_t begin, end;
    uint8_t level;
    uint32_t run;
    uint32_t firstGlyph, glyphCount;
    float x, width;
    bool rightToLeft() const { return level & 1; }
  };
  struct Line {
    uint32_t begin, end, inkEnd; // inkEnd: where the white space at its end begins
    bool hard;
    uint8_t level;                                        // of the paragraph
    uint32_t firstPiece = 0, pieceCount = 0;              // as they are seen, left to right
    double ink = 0, hang = 0;                             // widths before and after inkEnd
    float ascent = 0, descent = 0, height = 0, above = 0; // above: from the top to the baseline
  };

  /// The largest of the fonts of a line, pixels.
  struct Metrics {
    float ascent = 0, descent = 0, gap = 0;
    bool any = false;
    void use(const Run& run, const Style& style);
    float height(const GpgpTextInfo& info) const;
  };

  Result<void> analyse();
  void shapeRuns();
  void breakLines();
  void place();

  uint32_t addGlyphs(const Text& text, const Run& run, uint32_t begin, uint32_t end); // how many
  bool paintedApart(uint32_t character) const;
  void share(const Run& run, std::span<const ShapedGlyph> glyphs, uint32_t begin, uint32_t end);
  void measure(const Run& run, uint32_t begin, uint32_t end, uint32_t firstGlyph, uint32_t glyphCount);
  Piece slice(uint32_t run, uint32_t begin, uint32_t end);
  float tabAdvance(const Run& run, double x) const;
  Line breakLine(uint32_t begin, uint8_t level);
  uint32_t insert(const char* text, const char* otherwise, uint32_t style, uint8_t level, uint32_t at);
  float insertedWidth(const Run& run) const;
  void build(Line& line, uint32_t inserted = ~0u);
  Metrics metricsOf(const Line& line) const;
  void setHeight(Line& line) const;
  void cutOff(Line& line, double room);
  double inkWidth(uint32_t begin, uint32_t end);
  uint32_t runAt(uint32_t character) const;
  uint32_t inkEndOf(uint32_t begin, uint32_t end) const;
  void justify(Line& line, double room);
  void emit(const Line& line, const Piece& piece, float baseline);
  void decorate(const Line& line, float baseline);

  uint32_t graphemeAt(uint32_t character) const;
  uint32_t nextGrapheme(uint32_t character) const;
  uint32_t lineAt(uint32_t character, bool trailing) const;
  float leadingEdge(const Piece& piece, uint32_t character) const;
  const Piece* pieceAt(const Line& line, uint32_t character) const;

  std::weak_ptr<Shaper> shaper_;
  // during set() only
  Shaper* shaping_ = nullptr;
  const GpgpTextInfo* info_ = nullptr;
  std::vector<Style> styles_;
  struct { // an ellipsis or a hyphen
    Text text;
    std::vector<uint32_t> styleOf;
    std::vector<uint8_t> flags, levels;
  } inserted_;
  std::vector<UScriptCode> scripts_;
  std::vector<uint32_t> apart_;

  Text text_;
  std::vector<uint32_t> styleOf_; // by character, as all of these
  std::vector<uint8_t> flags_, levels_;
  std::vector<float> width_, extra_; // extra: the part of the width that no glyph has, behind its cluster
  bool wordsKnown_ = false;
  std::vector<Paragraph> paragraphs_;
  std::vector<Run> runs_; // of the text, then what was inserted
  size_t textRuns_ = 0;
  std::vector<ShapedGlyph> shaped_; // clusters counted from the text's beginning
  std::vector<Line> cut_;
  std::vector<Piece> pieces_, ordered_;
  std::vector<uint8_t> pieceLevels_;
  std::vector<uint32_t> order_;

  std::vector<GpgpTextGlyph> glyphs_;
  std::vector<GpgpTextLine> lines_;
  std::vector<GpgpTextDecoration> decorations_;
  std::vector<GpgpMissingCharacter> missing_;
  float layoutWidth_ = 0, layoutHeight_ = 0;
  bool truncated_ = false;
};

} // namespace gpgp::text
