// Grammars to a baked grammar, for the subcommands: every message goes to standard error, the first error is thrown.
#pragma once
#include "cli/shared/common.h"
#include "spawn/language/diagnostics.h"

#include <gpgp/gpgp.hpp>

#include <span>
#include <string>
#include <vector>

namespace gpgp::cli {

/// A grammar as the command line names it: FILE, or NAME=FILE, which calls it NAME where it is linked. What exists as
/// a file is one, whatever its name.
struct GrammarFile {
  explicit GrammarFile(const std::string& argument);
  std::string alias, path; ///< alias: empty where there is none
};
/// The option GRAMMAR of the subcommands that link several.
void addGrammars(CLI::App& command, std::vector<std::string>& arguments);
/// And its --set.
void addVariables(CLI::App& command, std::vector<std::string>& set);

/// Throws Usage where a file is of a language that derives without an operator graph: what does it, and how.
void expectGraphLanguage(const std::string& file);

struct GrammarText {
  GrammarFile file;
  std::string text; ///< or the bytes of a baked grammar
};

/// Prints all messages about a file; throws Failure with the first error, where there were any.
void report(const spawn::Diagnostics& diagnostics, const std::string& file);

/// set holds NAME=VALUE, as --set takes them. Throws Usage and Failure.
Blob compileGrammar(const GrammarText& grammar, const std::vector<std::string>& set, bool kernel);
/// Several to one. set holds GRAMMAR.NAME=VALUE.
Blob linkGrammars(std::span<const GrammarText> grammars, const std::vector<std::string>& set, bool kernel);

} // namespace gpgp::cli
