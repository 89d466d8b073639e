// A .cga file and what it imports to a program.
#pragma once
#include "spawn/cga/modules.h"
#include "spawn/cga/program.h"

namespace gpgp::spawn::cga {

struct CompileOptions {
  std::string path;   ///< of the main file, for messages and for what it imports
  std::string start;  ///< a rule without parameters; empty: what @StartRule marks, else the first
  std::string style;  ///< of the main file; empty: none
  ReadFile read;      ///< files that are imported
  bool graph = false; ///< Program::graph is made, with these values of attributes
  std::vector<AttributeValue> attributes;
};

/// None where there are errors; messages then holds at least one. Warnings leave a program that derives.
std::optional<Program> compile(const std::string& text, const CompileOptions& options, Messages& messages);

/// Reads files from disk.
ReadFile filesOnDisk();

} // namespace gpgp::spawn::cga
