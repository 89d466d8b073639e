// Style sheets: simple selectors (type, .class, #id, * and compounds of them, comma lists) with their declarations.
#pragma once
#include "vector/import/svg/reporter.h"

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace gpgp::vector::svg {

struct Declaration {
  std::string name, value;
  bool important = false;
};
/// "name: value; name: value !important".
std::vector<Declaration> parseDeclarations(std::string_view text);

class StyleSheet {
public:
  static constexpr size_t kMaxRules = 65536;

  /// Appends the rules of a <style> element whose text begins in `line`. What is not supported is reported.
  void parse(std::string_view text, size_t line, Reporter& reporter);

  /// What applies to an element, weakest first. `work` grows by the selectors compared.
  std::vector<const Declaration*> match(std::string_view type, std::string_view id, std::string_view classes,
                                        size_t& work) const;
  bool empty() const { return rules_.empty(); }

private:
  struct Rule {
    std::string type, id;
    std::vector<std::string> classes;
    uint32_t specificity = 0;
    size_t block = 0;
  };
  bool addSelector(std::string_view selector, size_t block);

  std::vector<Rule> rules_;
  std::vector<std::vector<Declaration>> blocks_;
  std::unordered_map<std::string, std::vector<size_t>> byKey_; // "#id", ".class", "type" or "*"
};

} // namespace gpgp::vector::svg
