// Style sheets: @import, @media, and rules' selectors with their declarations.
#pragma once
#include "vector/import/svg/document.h"
#include "vector/import/svg/reporter.h"
#include "vector/import/svg/selector.h"

#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace gpgp::vector::svg {

struct Declaration {
  std::string name, value;
  bool important = false;
};
/// "name: value; name: value !important". What is no declaration has no name.
std::vector<Declaration> parseDeclarations(std::string_view text);

class StyleSheet {
public:
  static constexpr size_t kMaxRules = 65536;

  /// Reads what an @import at this place refers to.
  using ImportFn = std::function<void(std::string_view uri, const Place& place)>;

  /// Appends the rules of a style sheet whose text begins at `place`. What is not supported is reported.
  void parse(std::string_view text, const Place& place, Reporter& reporter, const ImportFn& import = {});

  /// What applies to an element, weakest first. `work` grows by what is compared; beyond `most` nothing matches.
  std::vector<const Declaration*> match(const Document& document, pugi::xml_node node, size_t& work, size_t most) const;
  bool empty() const { return rules_.empty(); }

private:
  struct Rule {
    Selector selector;
    size_t block = 0;
  };
  struct Reading {
    Reporter& reporter;
    const ImportFn& import;
    bool importsCount = true; ///< until the first rule of another kind
    size_t depth = 0;         ///< of blocks around
  };
  void readRules(std::string_view text, Place place, Reading& reading);
  void readAtRule(std::string_view name, std::string_view prelude, std::string_view block, const Place& place,
                  const Place& blockPlace, Reading& reading);
  void readRule(std::string_view selectors, std::string_view block, const Place& place, Reading& reading);
  void add(Rule rule);

  std::vector<Rule> rules_;
  std::vector<std::vector<Declaration>> blocks_;
  std::unordered_map<std::string, std::vector<size_t>> byKey_; // "#id", ".class", "type" or "*"
};

} // namespace gpgp::vector::svg
