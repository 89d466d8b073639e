#include "cli/spawn/cga_source.h"

#include "cli/shared/command.h"
#include "cli/shared/messages.h"
#include "host/files.h"
#include "spawn/cga/attributes.h"

#include <algorithm>
#include <cstdio>

namespace gpgp::cli {
using namespace spawn::cga;

std::optional<ErrorsShown> print(const Messages& messages) {
  constexpr size_t kMostPrinted = 20;
  std::string first;
  size_t errors = 0, warnings = 0, omitted = 0;
  for (const Messages::Message& m : messages.sorted()) {
    const std::string line = spawn::format(m.diagnostic, m.file);
    const bool isError = m.diagnostic.severity == GPGP_SEVERITY_ERROR;
    if (isError && first.empty()) first = line;
    size_t& count = isError ? errors : warnings;
    if (++count > kMostPrinted) {
      omitted += !isError;
      continue;
    }
    std::fprintf(stderr, "%s\n", printable(line).c_str());
  }
  if (omitted) std::fprintf(stderr, "gpgp spawn: %zu more warnings are left out\n", omitted);
  if (errors == 0) return std::nullopt;
  return ErrorsShown(first, errors);
}

std::string misfit(const GraphText& graph) {
  std::string line = graph.file;
  if (graph.place.line) line += ":" + std::to_string(graph.place.line) + ":" + std::to_string(graph.place.column);
  return line + (line.empty() ? "" : ": ") + graph.why + " has no operator on the GPU";
}

std::vector<AttributeValue> attributeValues(const std::vector<std::string>& texts) {
  std::vector<AttributeValue> result;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw Usage("--attr takes NAME=VALUE, for example --attr height=12; got \"" + text + "\"");
    result.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  return result;
}

void checkAttributes(const std::vector<AttributeValue>& values, const Program& program) {
  for (const AttributeValue& value : values)
    if (const std::string why = whyNotSet(value, program); !why.empty()) throw Usage("--attr " + value.name + why);
}

bool isCga(const std::string& file) {
  if (file.size() < 4) return false;
  std::string end = file.substr(file.size() - 4);
  for (char& c : end) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return end == ".cga";
}

std::string cgaGraph(const std::string& file, const std::string& text, const std::vector<std::string>& attributes) {
  CompileOptions compile{file, {}, {}, filesOnDisk(), true, attributeValues(attributes)};
  Messages messages;
  const std::optional<Program> program = spawn::cga::compile(text, compile, messages);
  const std::optional<ErrorsShown> wrong = print(messages);
  if (!program) throw wrong.value();
  checkAttributes(compile.attributes, *program);
  if (program->graph.text.empty()) throw Failure(misfit(program->graph) + ", so that it has no operator graph");
  return program->graph.text;
}

} // namespace gpgp::cli
