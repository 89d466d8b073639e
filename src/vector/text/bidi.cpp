// The bidirectional algorithm, UAX #9: levels by FriBidi, and the order of a line's pieces.
#include "vector/text/unicode.h"

#include <algorithm>

#include <fribidi.h>

namespace gpgp::text {

static_assert(sizeof(FriBidiChar) == sizeof(char32_t));

Result<uint8_t> bidiLevels(std::span<const char32_t> paragraph, int direction, uint8_t* levels) {
  const auto size = static_cast<FriBidiStrIndex>(paragraph.size());
  // Below the first letter of a script from right to left and its marks everything is at level 0.
  if (direction != 1 && std::all_of(paragraph.begin(), paragraph.end(), [](char32_t c) { return c < 0x590; })) {
    std::fill_n(levels, paragraph.size(), uint8_t(0));
    return uint8_t(0);
  }
  const auto* characters = reinterpret_cast<const FriBidiChar*>(paragraph.data());
  std::vector<FriBidiCharType> types(paragraph.size());
  std::vector<FriBidiBracketType> brackets(paragraph.size());
  std::vector<FriBidiLevel> found(paragraph.size());
  fribidi_get_bidi_types(characters, size, types.data());
  fribidi_get_bracket_types(characters, size, types.data(), brackets.data());
  FriBidiParType base = direction < 0 ? FRIBIDI_PAR_LTR : direction > 0 ? FRIBIDI_PAR_RTL : FRIBIDI_PAR_ON;
  if (size && !fribidi_get_par_embedding_levels_ex(types.data(), brackets.data(), size, &base, found.data()))
    return makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "FriBidi cannot get its memory");
  std::transform(found.begin(), found.end(), levels, [](FriBidiLevel level) { return static_cast<uint8_t>(level); });
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
