// A grammar made in code (gpgp/spawn_builder.h): what was added, and the syntax tree that text would have given.
#pragma once
#include "spawn/language/syntax.h"

#include <gpgp/spawn_builder.h>

namespace gpgp::spawn {

/// The builder's syntax tree. What is wrong with the builder itself is reported; the rest is buildGraph's to check.
/// Every place of the tree gets a name, as "rule 'A', SubDiv, successor 2".
SyntaxTree treeOf(const GpgpGrammarBuilder_T& builder, Diagnostics& diagnostics);

} // namespace gpgp::spawn
