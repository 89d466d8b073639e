// UTF-8 to characters, and ICU's boundaries of graphemes (UAX #29), words and lines (UAX #14).
#include "vector/text/unicode.h"

#include <algorithm>

#include <unicode/uloc.h>
#include <unicode/utf8.h>

namespace gpgp::text {

void Text::assign(std::string_view utf8) {
  characters.clear();
  byteOf.clear();
  invalid.clear();
  utf16.clear();
  indexOf.clear();
  const int32_t size = static_cast<int32_t>(utf8.size());
  for (int32_t at = 0; at < size;) {
    const uint32_t begin = static_cast<uint32_t>(at);
    UChar32 c = 0;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion" // within ICU's macro
    U8_NEXT(utf8.data(), at, size, c);
#pragma GCC diagnostic pop
    if (c < 0) {
      invalid.push_back(begin);
      c = 0xfffd;
    }
    const uint32_t index = this->size();
    characters.push_back(static_cast<char32_t>(c));
    byteOf.push_back(begin);
    if (c > 0xffff) {
      utf16.push_back(static_cast<char16_t>(0xd7c0 + (c >> 10)));
      indexOf.push_back(index);
      c = 0xdc00 + (c & 0x3ff);
    }
    utf16.push_back(static_cast<char16_t>(c));
    indexOf.push_back(index);
  }
  byteOf.push_back(static_cast<uint32_t>(size));
  indexOf.push_back(this->size());
}

uint32_t Text::characterAt(uint32_t byte) const {
  if (byte >= byteOf.back()) return size();
  return static_cast<uint32_t>(std::upper_bound(byteOf.begin(), byteOf.end(), byte) - byteOf.begin() - 1);
}

Breaks::Iterator Breaks::open(UBreakIteratorType type, const std::string& language) {
  UErrorCode error = U_ZERO_ERROR;
  char locale[ULOC_FULLNAME_CAPACITY] = "";
  int32_t parsed = 0;
  if (!language.empty()) uloc_forLanguageTag(language.c_str(), locale, sizeof locale, &parsed, &error);
  if (U_FAILURE(error) || error == U_STRING_NOT_TERMINATED_WARNING) locale[0] = 0;
  error = U_ZERO_ERROR;
  // The root's rules, not those of whatever locale the process has.
  Iterator iterator(ubrk_open(type, locale[0] ? locale : "root", nullptr, 0, &error));
  return U_SUCCESS(error) ? std::move(iterator) : Iterator();
}

Result<Breaks> Breaks::create() {
  Breaks breaks;
  breaks.graphemes_ = open(UBRK_CHARACTER, "");
  breaks.words_ = open(UBRK_WORD, "");
  breaks.lines_.emplace_back("", open(UBRK_LINE, ""));
  if (!breaks.graphemes_ || !breaks.words_ || !breaks.lines_[0].second)
    return makeError(GPGP_ERROR_UNSUPPORTED, "ICU cannot open its rules for boundaries; is its data there?");
  return breaks;
}

namespace {
bool setText(UBreakIterator* iterator, const char16_t* text, size_t size) {
  UErrorCode error = U_ZERO_ERROR;
  ubrk_setText(iterator, text, static_cast<int32_t>(size), &error);
  return U_SUCCESS(error);
}
} // namespace

void Breaks::graphemes(const Text& text, std::vector<uint8_t>& flags) {
  if (!setText(graphemes_.get(), text.utf16.data(), text.utf16.size())) return;
  for (int32_t at = ubrk_first(graphemes_.get()); at != UBRK_DONE; at = ubrk_next(graphemes_.get()))
    if (static_cast<size_t>(at) < text.utf16.size()) flags[text.indexOf[static_cast<size_t>(at)]] |= kGrapheme;
}

void Breaks::words(const Text& text, std::vector<uint8_t>& flags) {
  if (!setText(words_.get(), text.utf16.data(), text.utf16.size())) return;
  for (int32_t begin = ubrk_first(words_.get()), end = 0; (end = ubrk_next(words_.get())) != UBRK_DONE; begin = end) {
    uint8_t& mark = flags[text.indexOf[static_cast<size_t>(begin)]];
    mark |= kWord;
    if (ubrk_getRuleStatus(words_.get()) >= UBRK_WORD_NONE_LIMIT) mark |= kWordLike;
  }
}

void Breaks::lines(const Text& text, uint32_t begin, uint32_t end, const std::string& language,
                   std::vector<uint8_t>& flags) {
  auto found = std::find_if(lines_.begin(), lines_.end(), [&](auto& each) { return each.first == language; });
  if (found == lines_.end()) {
    Iterator iterator = open(UBRK_LINE, language);
    if (iterator && lines_.size() < 32)
      found = lines_.emplace(lines_.end(), language, std::move(iterator));
    else
      found = lines_.begin();
  }
  UBreakIterator* iterator = found->second.get();
  const auto unit = [&](uint32_t character) { // where a character begins in utf16
    return static_cast<size_t>(std::lower_bound(text.indexOf.begin(), text.indexOf.end(), character) -
                               text.indexOf.begin());
  };
  const size_t first = unit(begin);
  if (!setText(iterator, text.utf16.data() + first, unit(end) - first)) return;
  ubrk_first(iterator);
  for (int32_t at = ubrk_next(iterator); at != UBRK_DONE; at = ubrk_next(iterator)) {
    const uint32_t index = text.indexOf[first + static_cast<size_t>(at)];
    if (index >= end || !(flags[index] & kGrapheme)) continue; // UAX #14 allows some that would cut a grapheme
    // Not by ICU's rule status: of boundaries from a dictionary (Thai) that is the rule at the end of their stretch.
    flags[index] |= isNewline(text.characters[index - 1]) ? kHardBreak : kSoftBreak;
  }
}

} // namespace gpgp::text
