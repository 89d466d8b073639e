// Grammar text to a baked grammar, for the subcommands: every message goes to standard error, the first error is
// thrown.
#pragma once
#include <gpgp/gpgp.hpp>

#include <string>
#include <vector>

namespace gpgp::cli {

/// set holds NAME=VALUE, as --set takes them. name is for messages. Throws Usage and Failure.
Blob compileGrammarText(const std::string& text, const std::string& name, const std::vector<std::string>& set,
                        bool kernel);
Blob compileGrammarFile(const std::string& file, const std::vector<std::string>& set, bool kernel);

} // namespace gpgp::cli
