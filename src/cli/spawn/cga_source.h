// What commands read of .cga files: their attributes, their messages, and the operator graph that they have or have
// not.
#pragma once
#include "cli/shared/common.h"
#include "spawn/cga/compile.h"

#include <optional>
#include <string>
#include <vector>

namespace gpgp::cli {

bool isCga(const std::string& file);
/// The operator graph of a .cga file as PGA-shape, from its start rule. attributes: NAME=VALUE. Throws Usage, and
/// Failure where it has none.
std::string cgaGraph(const std::string& file, const std::string& text, const std::vector<std::string>& attributes);

/// Prints them, and gives the errors, if there are any.
std::optional<ErrorsShown> print(const spawn::cga::Messages& messages);
/// Why a program has no operator graph, in one line.
std::string misfit(const spawn::cga::GraphText& graph);
/// Of NAME=VALUE. Throws Usage.
std::vector<spawn::cga::AttributeValue> attributeValues(const std::vector<std::string>& texts);
/// Throws Usage where a program has no such attribute.
void checkAttributes(const std::vector<spawn::cga::AttributeValue>& values, const spawn::cga::Program& program);

} // namespace gpgp::cli
