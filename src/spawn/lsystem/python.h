// Python as files of L-Py have it: logical lines, and expressions, which become those of L+C.
#pragma once
#include "spawn/lsystem/scanner.h"

#include <algorithm>

namespace gpgp::spawn::lsystem {

/// A logical line: text without its comment and indentation, and where it stands. A text in quotes is a '"'.
struct PyLine {
  uint32_t indent = 0;
  std::string text;
  std::vector<Place> places; ///< one more than characters
};
std::vector<PyLine> pythonLines(std::string_view text);

inline bool isPyBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
inline bool isPyDigit(char c) { return c >= '0' && c <= '9'; }
inline bool isPyLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// Reads a line from a cursor on. What is not supported is an error with its place.
class PyReader {
public:
  explicit PyReader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

protected:
  void refuse(Place place, const std::string& what) { diagnostics_.error(place, what + " is not supported"); }
  char peek(const PyLine& line);
  bool take(const PyLine& line, char c);
  bool takeWord(const PyLine& line, std::string_view wanted);
  std::string word(const PyLine& line);
  Place placeOf(const PyLine& line) const { return line.places[std::min(cursor_, line.places.size() - 1)]; }
  /// An expression of numbers in L+C, with its places.
  Line expressionOf(const PyLine& line);

  Diagnostics& diagnostics_;
  size_t cursor_ = 0;

private:
  bool enters(const PyLine& line);
  bool isTooLong(const PyLine& line, uint32_t operators);
  Line logical(const PyLine& line, int level);
  Line comparison(const PyLine& line);
  Line sum(const PyLine& line);
  Line product(const PyLine& line);
  Line unary(const PyLine& line);
  Line primary(const PyLine& line);
  Line call(const PyLine& line, std::string name, Place place);

  uint32_t depth_ = 0;
};

} // namespace gpgp::spawn::lsystem
