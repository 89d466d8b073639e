// The small languages inside SVG attributes: numbers, lists, lengths, transforms, path data.
//
// Any bytes are fine as input; what does not follow the grammar stops the scan and is reported by its offset.
#pragma once
#include "vector/geometry/shape.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace gpgp::vector::svg {

/// Reads from the front of a text.
class Scanner {
public:
  explicit Scanner(std::string_view text) : text_(text) {}
  bool done() const { return at_ >= text_.size(); }
  char peek() const { return done() ? '\0' : text_[at_]; }
  size_t offset() const { return at_; }
  void advance() { ++at_; }
  void skipSpace();
  void skipCommaSpace();
  /// SVG's number: sign, digits, fraction, exponent; "1.5.5-3e2" holds three. Not consumed where there is none, or one
  /// that a double cannot hold.
  bool number(double& value);
  bool flag(bool& value);
  /// Consumes `word` if it is next.
  bool take(std::string_view word);
  /// Letters, digits, -, _ and all that is not ASCII.
  std::string_view name();

private:
  std::string_view text_;
  size_t at_ = 0;
};

std::string_view trim(std::string_view text);
template <size_t N> bool oneOf(std::string_view name, const std::string_view (&names)[N]) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}
/// With small letters for ASCII's capitals.
std::string lowered(std::string_view text);
/// Equal but for the case of ASCII letters, as CSS compares its words. `word` is in small letters.
bool isWord(std::string_view text, std::string_view word);

/// What percentages and font units refer to.
struct LengthContext {
  double width = 100, height = 100, fontSize = 12, rootFontSize = 12;
  double pageWidth = 100, pageHeight = 100; ///< what vw and vh are parts of
};
enum class LengthAxis { X, Y, Diagonal };
/// A length with unit in user units; false where it is none.
bool parseLength(std::string_view text, const LengthContext& context, LengthAxis axis, double& value);

/// A transform list, e.g. "translate(3 4) rotate(30)", as attributes or style sheets write it; false where it is
/// malformed.
bool parseTransform(std::string_view text, const LengthContext& context, Affine& transform);
/// Whether it is written as in an attribute: with SVG 1.1's functions, and numbers without units (CSS Transforms
/// 1, 8.2).
bool isPlainTransform(std::string_view text);

/// A number of degrees, or an angle with its unit; in radians.
bool parseAngle(std::string_view text, double& radians);

/// The point around which a transform-origin turns things; false where it is malformed.
bool parseOrigin(std::string_view text, const LengthContext& context, Point& origin);

/// Appends path data. On an error, what came before it stays and the offset of the error is returned, otherwise npos.
/// `silent` receives the indices of verbs that end where the path has no vertex: inside an arc, or after a Z.
size_t parsePathData(std::string_view text, Shape& shape, double tolerance, std::vector<size_t>* silent = nullptr);

/// Appends the points of a polyline or polygon; false where the list is malformed or odd (the good part stays).
bool parsePoints(std::string_view text, bool close, Shape& shape);

} // namespace gpgp::vector::svg
