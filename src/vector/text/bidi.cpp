// The bidirectional algorithm, UAX #9: levels by FriBidi, and the order of a line's pieces.
#include "vector/text/unicode.h"

#include <algorithm>

namespace gpgp::text {

static_assert(sizeof(FriBidiChar) == sizeof(char32_t));

namespace {
/// Of scripts from right to left, or a mark of direction: without such a character all of a paragraph is at level 0.
bool isDirectional(char32_t c) {
  constexpr FriBidiCharType kAny =
      FRIBIDI_MASK_RTL | FRIBIDI_MASK_ARABIC | FRIBIDI_MASK_EXPLICIT | FRIBIDI_MASK_ISOLATE;
  return c >= 0x590 && (fribidi_get_bidi_type(c) & kAny) != 0;
}
} // namespace

Result<uint8_t> Bidi::levels(std::span<const char32_t> paragraph, int direction, uint8_t* levels) {
  const auto size = static_cast<FriBidiStrIndex>(paragraph.size());
  if (direction != 1 && std::none_of(paragraph.begin(), paragraph.end(), isDirectional)) {
    std::fill_n(levels, paragraph.size(), uint8_t(0));
    return uint8_t(0);
  }
  const auto* characters = reinterpret_cast<const FriBidiChar*>(paragraph.data());
  types_.resize(paragraph.size());
  brackets_.resize(paragraph.size());
  levels_.resize(paragraph.size());
  fribidi_get_bidi_types(characters, size, types_.data());
  fribidi_get_bracket_types(characters, size, types_.data(), brackets_.data());
  FriBidiParType base = direction < 0 ? FRIBIDI_PAR_LTR : direction > 0 ? FRIBIDI_PAR_RTL : FRIBIDI_PAR_ON;
  if (size && !fribidi_get_par_embedding_levels_ex(types_.data(), brackets_.data(), size, &base, levels_.data()))
    return makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "FriBidi cannot get its memory");
  std::transform(levels_.begin(), levels_.end(), levels,
                 [](FriBidiLevel level) { return static_cast<uint8_t>(level); });
  return static_cast<uint8_t>(FRIBIDI_IS_RTL(base) ? 1 : 0);
}

void visualOrder(std::span<const uint8_t> levels, std::vector<uint32_t>& order) {
  order.resize(levels.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  if (levels.empty()) return;
  const uint8_t highest = *std::max_element(levels.begin(), levels.end());
  for (uint8_t level = highest; level > 0; --level)
    for (size_t begin = 0; begin < levels.size(); ++begin) {
      if (levels[begin] < level) continue;
      size_t end = begin;
      while (end < levels.size() && levels[end] >= level) ++end;
      std::reverse(order.begin() + static_cast<std::ptrdiff_t>(begin),
                   order.begin() + static_cast<std::ptrdiff_t>(end));
      begin = end;
    }
}

} // namespace gpgp::text
