// One selector of a style sheet (Selectors 4): compounds with their combinators, attributes and pseudo-classes.
#pragma once
#include "vector/import/svg/document.h"
#include "vector/import/svg/scanner.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gpgp::vector::svg {

/// What was compared, and how much may be; beyond that nothing fits.
struct MatchBudget {
  size_t& work;
  size_t most;
  bool spend(size_t more) { return (work += more) < most; }
};

class Selector {
public:
  enum class Read { Yes, Unsupported, Invalid };

  /// Namespaces other than "*|", pseudo-elements and some pseudo-classes are valid but not supported.
  Read parse(std::string_view text) { return parse(text, 0); }
  bool fits(const Document& document, pugi::xml_node node, MatchBudget& budget) const;
  /// Of ids, of classes with what counts as one, and of types, eight bits each.
  uint32_t specificity() const { return ids_ << 16 | classes_ << 8 | types_; }
  /// "#id", ".class", "type" or "*": what an element must have to be fit.
  std::string key() const;

private:
  /// [name], or with a value compared by =, ~ (one of the words), | (it, or it and a hyphen), ^ (begins), $ (ends), *.
  struct AttributeTest {
    std::string name, value;
    char how = 0;
    bool anyCase = false;
    bool parse(Scanner& s);
    bool fits(std::string_view is) const;
  };
  struct Pseudo {
    enum class Kind {
      Root,
      Empty,
      Link,
      Lang, ///< the language is `value`
      Nth,  ///< its number among its siblings is a n + b for some n that is not negative
      Is,   ///< one of the selectors fits; without any: nothing does
      Not   ///< none does
    };
    Kind kind = Kind::Root;
    int a = 0, b = 1;
    bool fromEnd = false, ofType = false;
    std::string value;
    std::vector<Selector> selectors;
  };
  /// What one element has to be, and where it stands: below that of the compound before (a space), its child (>), after
  /// it (~) or next to it (+); 0: there is none before.
  struct Compound {
    char combinator = 0;
    std::string type, id;
    std::vector<std::string> classes;
    std::vector<AttributeTest> attributes;
    std::vector<Pseudo> pseudos;
  };
  Read parse(std::string_view text, size_t depth);
  Read parseCompound(std::string_view text, Scanner& s, Compound& compound, size_t depth);
  Read parsePseudo(std::string_view text, Scanner& s, Compound& compound, size_t depth);
  bool fits(const Document& document, const Compound& compound, pugi::xml_node node, MatchBudget& budget) const;
  bool fits(const Document& document, const Pseudo& pseudo, pugi::xml_node node, MatchBudget& budget) const;
  bool fits(const Document& document, size_t last, pugi::xml_node node, MatchBudget& budget) const;

  std::vector<Compound> compounds_; ///< the last is of the element itself
  uint32_t ids_ = 0, classes_ = 0, types_ = 0;
};

/// At most 64 of them, between spaces.
std::vector<std::string_view> wordsOf(std::string_view text);
/// The first of `marks` from `at` on that is in no comment, string or brackets; the text's size where there is none.
size_t findOutside(std::string_view text, size_t at, std::string_view marks);

} // namespace gpgp::vector::svg
