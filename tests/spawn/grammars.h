// Compiling grammars in tests, and where grammar files are.
#pragma once
#include "spawn/graph/blob.h"
#include "spawn/language/build_graph.h"

#include <optional>
#include <string>
#include <vector>

namespace gpgp::test {

/// Published grammars outside the project; empty where they are absent.
std::optional<std::string> sharedGrammar(const std::string& name);
/// The project's own: tests/data/grammars. Throws where it is absent.
std::string ownGrammar(const std::string& name);
/// Names of all own grammars.
std::vector<std::string> ownGrammarNames();

/// Two buckets, numbers that differ from axiom to axiom.
inline constexpr const char* kTown = R"(axiom Box Lot;
terminal Wall Floor (1, 0);
terminal Roof (0, 3);
Lot = RandomRule(Rand(0, 1)) { 0.7: House | 0.3: Tower };
House = SubDiv(Y) { -1: Storey | 1: Roof };
Tower = Repeat(Y, 1, ADJUST_TO_FILL) Storey;
Storey = Repeat(X, Rand(1, 3), ADJUST_TO_FILL) SubDiv(Z) { -1: Wall | -2: Floor };
)";

/// Compiles text to words; throws with all messages where it has errors.
std::vector<uint32_t> bake(const std::string& text, const std::vector<GpgpVariable>& variables = {});
struct GrammarFile {
  std::string name, text; ///< or the bytes of a baked grammar
  std::vector<GpgpVariable> variables = {};
  const char* alias = nullptr;
};
/// Links files to words, by the C function; throws with all messages where it fails.
std::vector<uint32_t> linked(const std::vector<GrammarFile>& files, GpgpCompileFlags flags = 0);
/// The messages of linking, as "file:line:column: error: text".
std::vector<std::string> linkMessages(const std::vector<GrammarFile>& files);
/// The file baked, kernels included where the flags say so, with its variables set.
GrammarFile bakedFile(const GrammarFile& file, GpgpCompileFlags flags = 0);
/// A file. Throws where it is absent.
std::string textOf(const std::string& path);

/// The messages of compiling, as "line:column: error: text".
/// line:column: error: text, or error: text
std::string messageOf(const spawn::Diagnostic& diagnostic);
std::vector<std::string> messagesOf(const std::string& text, const std::vector<GpgpVariable>& variables = {});

/// In text, the first `from` becomes `to`; throws where there is none.
std::string replaced(std::string text, const std::string& from, const std::string& to);

} // namespace gpgp::test
