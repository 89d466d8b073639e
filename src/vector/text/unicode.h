// A text as characters, and what Unicode's rules say of them: where graphemes, words and lines may end (ICU), and in
// which direction they run (FriBidi).
#pragma once
#include "core/result.h"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fribidi.h>
#include <unicode/ubrk.h>

namespace gpgp::text {

using core::makeError;
using core::Result;

/// UTF-8 as code points. Memory is kept from text to text.
struct Text {
  std::vector<char32_t> characters;
  std::vector<uint32_t> byteOf;  // where each began, and one more: the size
  std::vector<uint32_t> invalid; // bytes that were replaced by U+FFFD
  std::u16string utf16;          // for ICU
  std::vector<uint32_t>
      indexOf; // of the character that each unit of utf16 belongs to, and one more: how many there are

  /// What is not UTF-8 becomes one U+FFFD for each part that can begin no character.
  void assign(std::string_view utf8);
  uint32_t size() const { return static_cast<uint32_t>(characters.size()); }
  /// The character that a byte belongs to; size() for what lies beyond.
  uint32_t characterAt(uint32_t byte) const;
};

/// Ends a line and its paragraph or part of one, whatever the width: LF, VT, FF, CR, NEL, LS, PS.
inline bool isNewline(char32_t c) { return (c >= 0xa && c <= 0xd) || c == 0x85 || c == 0x2028 || c == 0x2029; }

/// What may happen before a character.
enum Boundary : uint8_t {
  kGrapheme = 1,  // a grapheme begins
  kSoftBreak = 2, // a line may begin
  kHardBreak = 4, // a line begins
  kWord = 8,      // a word, or what is between words, begins
  kWordLike = 16, // and it is a word
  kSafe = 32      // shaping may be cut here (shape.h)
};

/// ICU's iterators, opened once each.
class Breaks {
public:
  static Result<Breaks> create();
  void graphemes(const Text& text, std::vector<uint8_t>& flags);
  void words(const Text& text, std::vector<uint8_t>& flags);
  /// Of characters [begin, end), by the rules of a language ("" for none); the first gets no mark.
  void lines(const Text& text, uint32_t begin, uint32_t end, const std::string& language, std::vector<uint8_t>& flags);

private:
  struct Close {
    void operator()(UBreakIterator* iterator) const { ubrk_close(iterator); }
  };
  using Iterator = std::unique_ptr<UBreakIterator, Close>;
  static Iterator open(UBreakIteratorType type, const std::string& language);

  Iterator graphemes_, words_;
  std::vector<std::pair<std::string, Iterator>> lines_; // by language
};

/// FriBidi, and the memory that it is given. It takes some of its own for each paragraph with characters from right to
/// left or marks of direction, and for none else.
class Bidi {
public:
  /// The embedding levels of a paragraph after UAX #9 (its line break included) and the level of the paragraph itself.
  /// direction: -1 left to right, 1 right to left, 0 by its first strong character.
  Result<uint8_t> levels(std::span<const char32_t> paragraph, int direction, uint8_t* levels);

private:
  std::vector<FriBidiCharType> types_;
  std::vector<FriBidiBracketType> brackets_;
  std::vector<FriBidiLevel> levels_;
};

/// Rule L2: from the levels of pieces in the order of the text to the order in which they are seen, left to right.
void visualOrder(std::span<const uint8_t> levels, std::vector<uint32_t>& order);

} // namespace gpgp::text
