// What an editor asks of a layout: carets, selections, hit tests, and where a caret moves.
#include "vector/text/layout.h"

#include <algorithm>

namespace gpgp::text {

/// trailing: where a line wraps, the one that ends.
uint32_t Layout::lineAt(uint32_t character, bool trailing) const {
  const auto after = std::upper_bound(cut_.begin(), cut_.end(), character,
                                      [](uint32_t c, const Line& line) { return c < line.begin; });
  const uint32_t index = after == cut_.begin() ? 0 : static_cast<uint32_t>(after - cut_.begin()) - 1;
  const bool wraps = index > 0 && character == cut_[index].begin && !cut_[index - 1].hard;
  return trailing && wraps ? index - 1 : index;
}

const Layout::Piece* Layout::pieceAt(const Line& line, uint32_t character) const {
  for (uint32_t i = 0; i < line.pieceCount; ++i) {
    const Piece& piece = pieces_[line.firstPiece + i];
    if (character >= piece.begin && character < piece.end) return &piece;
  }
  return nullptr;
}

/// Where a character begins, for the piece's end: where the last one ends.
float Layout::leadingEdge(const Piece& piece, uint32_t character) const {
  float along = 0;
  for (uint32_t c = piece.begin; c < character; ++c) along += width_[c];
  return piece.rightToLeft() ? piece.x + piece.width - along : piece.x + along;
}

GpgpCaret Layout::caret(uint32_t offset, bool trailing) const {
  if (cut_.empty()) return {};
  const uint32_t character = std::min(graphemeAt(text_.characterAt(offset)), cut_.back().end);
  const uint32_t index = lineAt(character, trailing);
  const Line& line = cut_[index];
  const GpgpTextLine& placed = lines_[index];
  const bool backwards = line.level & 1;

  GpgpCaret caret{};
  caret.top = placed.baseline - line.ascent;
  caret.height = line.ascent + line.descent;
  caret.line = index;
  const bool ends = character == line.end || isNewline(text_.characters[character]);
  const Piece* here = ends ? nullptr : pieceAt(line, character);
  if (here) {
    caret.x = leadingEdge(*here, character);
    caret.rightToLeft = here->rightToLeft();
  } else { // behind all that is in the line
    float left = placed.left, right = placed.left + placed.width;
    if (line.pieceCount) {
      left = pieces_[line.firstPiece].x;
      const Piece& last = pieces_[line.firstPiece + line.pieceCount - 1];
      right = last.x + last.width;
    }
    caret.x = backwards ? left : right;
    caret.rightToLeft = backwards;
  }
  caret.splitX = caret.x;
  caret.splitRightToLeft = caret.rightToLeft;
  if (character > line.begin) {
    const uint32_t before = graphemeAt(character - 1);
    if (const Piece* piece = pieceAt(line, before)) {
      caret.splitX = leadingEdge(*piece, std::min(character, piece->end));
      caret.splitRightToLeft = piece->rightToLeft();
      caret.split = std::abs(caret.splitX - caret.x) > 0.01f;
    }
  }
  return caret;
}

GpgpTextHit Layout::hit(float x, float y) const {
  if (cut_.empty()) return {};
  GpgpTextHit hit{};
  while (hit.line + 1 < lines_.size() && y >= lines_[hit.line].top + lines_[hit.line].height) ++hit.line;
  const Line& line = cut_[hit.line];
  const bool backwards = line.level & 1;
  const bool inLine = y >= lines_[hit.line].top && y < lines_[hit.line].top + lines_[hit.line].height;
  const auto finish = [&](uint32_t character, bool trailing, bool inside) {
    const uint32_t after = nextGrapheme(character);
    hit.offset = text_.byteOf[character];
    hit.insertion = text_.byteOf[trailing ? std::min(after, std::max(line.end, character)) : character];
    hit.trailing = trailing;
    hit.inside = inside && inLine;
    return hit;
  };
  const auto atBegin = [&] { return finish(line.begin, false, false); };
  const auto atEnd = [&] { // before its line break, if it has one
    uint32_t end = line.end;
    if (end > line.begin && isNewline(text_.characters[graphemeAt(end - 1)])) end = graphemeAt(end - 1);
    return end > line.begin ? finish(graphemeAt(end - 1), true, false) : finish(end, false, false);
  };
  if (line.pieceCount == 0) return atEnd();
  const Piece* pieces = pieces_.data() + line.firstPiece;
  const Piece& last = pieces[line.pieceCount - 1];
  if (x < pieces[0].x || (backwards && x == pieces[0].x)) return backwards ? atEnd() : atBegin();
  if (x >= last.x + last.width) return backwards ? atBegin() : atEnd();
  for (uint32_t i = 0; i < line.pieceCount; ++i) {
    const Piece& piece = pieces[i];
    if (x >= piece.x + piece.width) continue;
    if (piece.begin == piece.end) return atEnd(); // an ellipsis or a hyphen
    float begin = piece.rightToLeft() ? piece.x + piece.width : piece.x;
    for (uint32_t c = piece.begin; c < piece.end;) {
      const uint32_t next = std::min(nextGrapheme(c), piece.end);
      float width = 0;
      for (uint32_t each = c; each < next; ++each) width += width_[each];
      const float end = piece.rightToLeft() ? begin - width : begin + width;
      const float along = piece.rightToLeft() ? begin - x : x - begin;
      if (width > 0 && (along < width || next == piece.end)) return finish(c, along >= width / 2, true);
      begin = end;
      c = next;
    }
  }
  return atEnd();
}

void Layout::selection(uint32_t begin, uint32_t end, std::vector<GpgpTextRect>& rects) const {
  const uint32_t from = graphemeAt(text_.characterAt(begin)), to = graphemeAt(text_.characterAt(end));
  for (uint32_t index = 0; index < cut_.size(); ++index) {
    const Line& line = cut_[index];
    const size_t before = rects.size();
    for (uint32_t i = 0; i < line.pieceCount; ++i) {
      const Piece& piece = pieces_[line.firstPiece + i];
      const uint32_t first = std::max(from, piece.begin), last = std::min(to, piece.end);
      if (first >= last) continue;
      const float a = leadingEdge(piece, first), b = leadingEdge(piece, last);
      const float left = std::min(a, b), right = std::max(a, b);
      if (!(right > left)) continue;
      if (rects.size() > before && std::abs(rects.back().x + rects.back().width - left) < 0.01f)
        rects.back().width = right - rects.back().x;
      else
        rects.push_back({left, lines_[index].top, right - left, line.height});
    }
  }
}

Result<Layout::Moved> Layout::move(uint32_t offset, bool trailing, GpgpCaretMove move) {
  const uint32_t size = text_.size();
  uint32_t at = graphemeAt(text_.characterAt(offset));
  bool ends = false; // the line there wraps, and the caret stays on it
  if (move >= GPGP_CARET_NEXT_WORD && move <= GPGP_CARET_WORD_END && !wordsKnown_) {
    const auto shaper = shaper_.lock();
    if (!shaper) return makeError(GPGP_ERROR_INVALID_HANDLE, "the layout's shaper is destroyed");
    shaper->breaks.words(text_, flags_);
    wordsKnown_ = true;
  }
  switch (move) {
  case GPGP_CARET_NEXT: at = nextGrapheme(at); break;
  case GPGP_CARET_PREVIOUS: at = at > 0 ? graphemeAt(at - 1) : 0; break;
  case GPGP_CARET_NEXT_WORD:
    if (at < size) ++at;
    while (at < size && !(flags_[at] & kWordLike)) ++at;
    break;
  case GPGP_CARET_PREVIOUS_WORD:
    if (at > 0) --at;
    while (at > 0 && !(flags_[at] & kWordLike)) --at;
    break;
  case GPGP_CARET_WORD_BEGIN:
    while (at > 0 && !(flags_[at] & kWord)) --at;
    break;
  case GPGP_CARET_WORD_END:
    if (at < size) ++at;
    while (at < size && !(flags_[at] & kWord)) ++at;
    break;
  case GPGP_CARET_LINE_BEGIN:
    if (!cut_.empty()) at = cut_[lineAt(at, trailing)].begin;
    break;
  case GPGP_CARET_LINE_END:
    if (!cut_.empty()) {
      const Line& line = cut_[lineAt(at, trailing)];
      at = line.end;
      if (!line.hard) {
        const uint32_t ink = graphemeAt(line.inkEnd);
        ends = ink == at || ink <= line.begin;
        if (!ends) at = ink;
      } else if (at > line.begin && isNewline(text_.characters[graphemeAt(at - 1)])) {
        at = graphemeAt(at - 1);
      }
    }
    break;
  default: return makeError(GPGP_ERROR_INVALID_ARGUMENT, "move is %d, which is not a GpgpCaretMove", move);
  }
  return Moved{text_.byteOf[at], ends};
}

} // namespace gpgp::text
