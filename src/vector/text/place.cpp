// Places: lines aligned and under each other, their pieces side by side, glyphs on the baseline, decorations.
#include "vector/text/layout.h"

#include <algorithm>

namespace gpgp::text {

namespace {
/// Scripts that are set without spaces and may be stretched between any two characters.
bool isIdeographic(char32_t c) {
  return (c >= 0x2e80 && c <= 0xa4cf && c != 0x3000) || (c >= 0xf900 && c <= 0xfaff) || (c >= 0xff01 && c <= 0xff9f) ||
         (c >= 0x20000 && c <= 0x3ffff);
}
/// All 0: opaque black.
void setColor(const GpgpTextStyle& style, float color[4]) {
  std::copy_n(style.color, 4, color);
  if (std::all_of(color, color + 4, [](float v) { return v == 0; })) color[3] = 1;
}
} // namespace

/// Shares `room` among the gaps of a line, behind its last tab.
void Layout::justify(Line& line, double room) {
  uint32_t begin = line.begin;
  for (uint32_t c = line.begin; c < line.inkEnd; ++c)
    if (text_.characters[c] == '\t') begin = c + 1;
  const auto isGap = [&](uint32_t c) { // behind the grapheme at c
    if (!(flags_[c] & kGrapheme)) return false;
    const uint32_t next = nextGrapheme(c);
    if (next >= line.inkEnd) return false;
    const char32_t here = text_.characters[c];
    return here == ' ' || here == 0xa0 || here == 0x3000 ||
           (isIdeographic(here) && isIdeographic(text_.characters[next]) && (flags_[next] & kSoftBreak));
  };
  uint32_t gaps = 0;
  for (uint32_t c = begin; c < line.inkEnd; ++c) gaps += isGap(c);
  if (gaps == 0) return;
  const float part = static_cast<float>(room / gaps);
  for (uint32_t c = begin; c < line.inkEnd; ++c) {
    if (!isGap(c)) continue;
    extra_[c] += part;
    width_[c] += part;
  }
  line.ink += static_cast<double>(part) * gaps;
}

void Layout::emit(const Line& line, const Piece& piece, float baseline) {
  const Run& run = runs_[piece.run];
  const float size = styles_[run.style].source->size;
  const auto glyphs = std::span(shaped_).subspan(piece.firstGlyph, piece.glyphCount);
  const bool backwards = run.level & 1, isInserted = run.kind == Run::Kind::inserted;
  double pen = static_cast<double>(piece.x);
  uint32_t seen = backwards ? piece.end : piece.begin; // where clusters to come meet those that were
  const auto extraOf = [&](uint32_t begin, uint32_t end) {
    double sum = 0;
    for (uint32_t c = begin; c < end; ++c) sum += static_cast<double>(extra_[c]);
    return sum;
  };
  const auto lineIndex = static_cast<uint32_t>(&line - cut_.data());
  for (size_t i = 0; i < glyphs.size(); ++i) {
    const ShapedGlyph& glyph = glyphs[i];
    if (!isInserted && glyph.cluster != seen) { // a new cluster: what is extra lies behind each in the text's order
      pen += backwards ? extraOf(glyph.cluster, seen) : extraOf(seen, glyph.cluster);
      seen = glyph.cluster;
    }
    const uint32_t style = isInserted ? run.style : styleOf_[glyph.cluster];
    GpgpTextGlyph placed{reinterpret_cast<GpgpFont>(run.font),
                         glyph.glyph,
                         static_cast<float>(pen + static_cast<double>(glyph.x * size)),
                         baseline - glyph.y * size,
                         size,
                         {},
                         text_.byteOf[glyph.cluster],
                         lineIndex,
                         style};
    setColor(*styles_[style].source, placed.color);
    glyphs_.push_back(placed);
    pen += static_cast<double>(glyph.advance * size);
  }
}

/// Lines under and through neighbours of one style, at the height and as thick as the style's first font has them.
void Layout::decorate(const Line& line, float baseline) {
  for (const bool strike : {false, true}) {
    const size_t before = decorations_.size();
    const auto add = [&](uint32_t index, float x, float width) {
      const GpgpTextStyle& style = *styles_[index].source;
      if (!(strike ? style.strike : style.underline) || !(width > 0)) return;
      if (decorations_.size() > before) {
        GpgpTextDecoration& last = decorations_.back();
        if (last.span == index && std::abs(last.rect.x + last.rect.width - x) < 0.01f) {
          last.rect.width = x + width - last.rect.x;
          return;
        }
      }
      const GpgpFontInfo& font = styles_[index].font(0)->info();
      const float thickness = (strike ? font.strikeThickness : font.underlineThickness) * style.size;
      const float middle = (strike ? font.strikePosition : font.underlinePosition) * style.size;
      GpgpTextDecoration decoration{{x, baseline + middle - thickness / 2, width, thickness},
                                    {},
                                    static_cast<uint32_t>(&line - cut_.data()),
                                    index,
                                    strike};
      setColor(style, decoration.color);
      decorations_.push_back(decoration);
    };
    for (uint32_t i = 0; i < line.pieceCount; ++i) {
      const Piece& piece = pieces_[line.firstPiece + i];
      if (runs_[piece.run].kind == Run::Kind::inserted) {
        add(runs_[piece.run].style, piece.x, piece.width);
        continue;
      }
      const uint32_t end = std::min(piece.end, line.inkEnd);
      // Parts of one style, from left to right.
      float x = piece.x;
      if (piece.rightToLeft())
        for (uint32_t c = end; c < piece.end; ++c) x += width_[c];
      const bool backwards = piece.rightToLeft();
      uint32_t left = end > piece.begin ? end - piece.begin : 0;
      uint32_t at = backwards ? end : piece.begin;
      while (left > 0) {
        const uint32_t style = styleOf_[backwards ? at - 1 : at];
        float width = 0;
        while (left > 0 && styleOf_[backwards ? at - 1 : at] == style) {
          width += width_[backwards ? at - 1 : at];
          backwards ? --at : ++at;
          --left;
        }
        add(style, x, width);
        x += width;
      }
    }
  }
}

void Layout::place() {
  double widest = 0;
  for (const Line& line : cut_) widest = std::max(widest, line.ink);
  const double box = info_->width > 0 ? static_cast<double>(info_->width) : widest;
  float top = 0;
  layoutWidth_ = 0;
  for (Line& line : cut_) {
    const bool backwards = line.level & 1;
    if (info_->align == GPGP_TEXT_ALIGN_JUSTIFY && !line.hard && box > line.ink) {
      justify(line, box - line.ink);
      for (uint32_t i = 0; i < line.pieceCount; ++i) {
        Piece& piece = pieces_[line.firstPiece + i];
        if (runs_[piece.run].kind == Run::Kind::inserted) continue;
        piece.width = 0;
        for (uint32_t c = piece.begin; c < piece.end; ++c) piece.width += width_[c];
      }
    }
    const bool right =
        info_->align == GPGP_TEXT_ALIGN_RIGHT || (info_->align == GPGP_TEXT_ALIGN_END && !backwards) ||
        ((info_->align == GPGP_TEXT_ALIGN_START || info_->align == GPGP_TEXT_ALIGN_JUSTIFY) && backwards);
    const double left = info_->align == GPGP_TEXT_ALIGN_CENTER ? (box - line.ink) / 2 : right ? box - line.ink : 0;
    double x = left - (backwards ? line.hang : 0);
    const float baseline = top + line.above;
    const auto firstGlyph = static_cast<uint32_t>(glyphs_.size());
    for (uint32_t i = 0; i < line.pieceCount; ++i) {
      Piece& piece = pieces_[line.firstPiece + i];
      piece.x = static_cast<float>(x);
      x += static_cast<double>(piece.width);
      emit(line, piece, baseline);
    }
    decorate(line, baseline);
    lines_.push_back({text_.byteOf[line.begin], text_.byteOf[line.end], static_cast<float>(left),
                      static_cast<float>(line.ink), top, line.height, baseline, line.ascent, line.descent, firstGlyph,
                      static_cast<uint32_t>(glyphs_.size()) - firstGlyph, backwards, line.hard});
    layoutWidth_ = std::max(layoutWidth_, static_cast<float>(line.ink));
    top += line.height;
  }
  layoutHeight_ = top;
}

} // namespace gpgp::text
