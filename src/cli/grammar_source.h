// Grammar text to a baked grammar, for the subcommands: every message goes to standard error, the first error is
// thrown.
#pragma once
#include <gpgp/gpgp.hpp>

#include <span>
#include <string>
#include <vector>

namespace gpgp::cli {

struct GrammarText {
  std::string name; ///< of its file, for messages
  std::string text;
};

/// set holds NAME=VALUE, as --set takes them. Throws Usage and Failure.
Blob compileGrammar(const GrammarText& grammar, const std::vector<std::string>& set, bool kernel);
/// Several to one. set holds GRAMMAR.NAME=VALUE.
Blob linkGrammars(std::span<const GrammarText> grammars, const std::vector<std::string>& set, bool kernel);

} // namespace gpgp::cli
