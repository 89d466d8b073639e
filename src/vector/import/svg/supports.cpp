#include "vector/import/svg/supports.h"

#include "vector/import/svg/selector.h"
#include "vector/import/svg/style.h"

#include <algorithm>

namespace gpgp::vector::svg {
namespace {

constexpr size_t kMaxDepth = 32;

/// A declaration without its brackets: nothing where it is none.
std::optional<bool> declaration(std::string_view text) {
  const size_t colon = text.find(':');
  if (colon == text.npos) return std::nullopt;
  const std::string name = lowered(trim(text.substr(0, colon)));
  std::string_view value = trim(text.substr(colon + 1));
  Scanner s(name);
  s.name();
  if (name.empty() || !s.done()) return std::nullopt;
  if (const size_t mark = value.rfind('!'); mark != value.npos && isWord(trim(value.substr(mark + 1)), "important"))
    value = trim(value.substr(0, mark));
  if (value.empty()) return name.starts_with("--");
  if (name.starts_with("--") || lowered(value).find("var(") != std::string::npos) return true; // told when it is used
  if (isUnsupported(name, value)) return false;
  const bool isWhole = isWord(value, "none") || isWord(value, "inherit") || isWord(value, "initial") ||
                       isWord(value, "unset") || isWord(value, "revert");
  Affine transform;
  if (name == "transform" && !isWhole) return parseTransform(value, {}, transform);
  if ((name == "clip-path" || name == "mask") && !isWhole) return isWord(value.substr(0, 4), "url(");
  Style style;
  const Applied applied = applyProperty(style, {}, name, value, {});
  if (std::find(style.text.undrawn.begin(), style.text.undrawn.end(), true) != style.text.undrawn.end()) return false;
  if (applied != Applied::Unknown) return applied == Applied::Yes;
  if (!isGeometry(name)) return false;
  double length = 0;
  return name == "d" || parseLength(value, {}, LengthAxis::X, length) || isWord(value, "auto");
}

class Condition {
public:
  explicit Condition(std::string_view text) : text_(text), s_(text) {}

  /// All of the text.
  std::optional<bool> read(size_t depth) {
    if (depth > kMaxDepth) return std::nullopt;
    const bool isNegated = takeWord("not");
    std::optional<bool> all = operand(depth);
    if (!all || (isNegated && !s_.done())) return std::nullopt;
    if (isNegated) return !*all;
    std::string_view between; // and, or: one of them between brackets
    while (!s_.done()) {
      const std::string_view word = takeWord("and") ? "and" : takeWord("or") ? "or" : "";
      if (word.empty() || (!between.empty() && word != between)) return std::nullopt;
      between = word;
      const std::optional<bool> next = operand(depth);
      if (!next) return std::nullopt;
      all = word == "and" ? *all && *next : *all || *next;
    }
    return all;
  }

private:
  bool takeWord(std::string_view word) {
    s_.skipSpace();
    const std::string_view rest = text_.substr(s_.offset());
    const std::string_view found = Scanner(rest).name();
    if (!isWord(found, word) || rest.substr(found.size(), 1) == "(") return false; // "not(" is a function
    s_.take(found);
    s_.skipSpace();
    return true;
  }

  /// What stands in brackets, or a function.
  std::optional<bool> operand(size_t depth) {
    s_.skipSpace();
    const std::string name = lowered(s_.name());
    if (!s_.take("(")) return std::nullopt;
    const size_t begin = s_.offset(), end = findOutside(text_, begin, ")");
    if (end >= text_.size()) return std::nullopt;
    const std::string_view inside = trim(text_.substr(begin, end - begin));
    while (s_.offset() <= end) s_.advance();
    s_.skipSpace();
    if (name == "selector") {
      Selector selector;
      return selector.parse(inside) == Selector::Read::Yes;
    }
    if (!name.empty()) return false; // of a later specification
    const bool isNested = inside.substr(0, 1) == "(" || isWord(Scanner(inside).name(), "not") ||
                          inside.substr(Scanner(inside).name().size(), 1) == "(";
    if (isNested) return Condition(inside).read(depth + 1);
    const std::optional<bool> is = declaration(inside);
    return is ? is : std::optional(false); // general, enclosed: not known to hold
  }

  std::string_view text_;
  Scanner s_;
};

} // namespace

std::optional<bool> evaluateSupports(std::string_view condition) { return Condition(trim(condition)).read(0); }

std::optional<bool> evaluateSupportsOfImport(std::string_view inside) {
  const std::optional<bool> is = evaluateSupports(inside);
  return is ? is : declaration(trim(inside));
}

} // namespace gpgp::vector::svg
