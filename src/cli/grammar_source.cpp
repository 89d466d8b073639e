#include "cli/grammar_source.h"

#include "cli/command.h"
#include "host/files.h"

#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace gpgp::cli {
namespace {

std::vector<GpgpVariable> variables(const std::vector<std::string>& assignments) {
  std::vector<GpgpVariable> result;
  for (const std::string& assignment : assignments) {
    const size_t equals = assignment.find('=');
    char* end = nullptr;
    const float value = equals == std::string::npos ? 0.0f : std::strtof(assignment.c_str() + equals + 1, &end);
    if (equals == 0 || equals == std::string::npos || equals + 1 == assignment.size() || *end != 0)
      throw Usage("--set takes NAME=VALUE with a number, for example --set floors=12; got \"" + assignment + "\"");
    result.push_back({nullptr, value}); // the name follows once the strings lie still
  }
  return result;
}

} // namespace

Blob compileGrammarText(const std::string& text, const std::string& name, const std::vector<std::string>& set,
                        bool kernel) {
  std::vector<GpgpVariable> overrides = variables(set);
  std::vector<std::string> names;
  for (const std::string& assignment : set) names.push_back(assignment.substr(0, assignment.find('=')));
  for (size_t i = 0; i < names.size(); ++i) overrides[i].name = names[i].c_str();
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.name = name.c_str();
  source.text = text.data();
  source.size = text.size();
  source.variables = overrides.data();
  source.variableCount = static_cast<uint32_t>(overrides.size());
  struct Errors {
    std::string first;
    uint32_t count = 0;
  } errors;
  source.messageUserData = &errors;
  source.messageFn = [](void* userData, const GpgpCompileMessage* message) {
    auto* all = static_cast<Errors*>(userData);
    std::ostringstream line;
    line << message->file << ':' << message->line << ':' << message->column << ": "
         << (message->severity == GPGP_SEVERITY_ERROR     ? "error: "
             : message->severity == GPGP_SEVERITY_WARNING ? "warning: "
                                                          : "")
         << message->text;
    std::fprintf(stderr, "%s\n", line.str().c_str());
    if (message->severity != GPGP_SEVERITY_ERROR) return;
    if (all->count++ == 0) all->first = line.str();
  };
  if (kernel) source.flags = GPGP_COMPILE_KERNEL;
  Result<Blob> blob = compileGrammar(source);
  if (blob) return std::move(*blob);
  if (errors.count == 0) throw Failure(name + ": " + blob.name());
  throw Failure(errors.first + (errors.count > 1 ? " (and " + std::to_string(errors.count - 1) + " more)" : ""));
}

Blob compileGrammarFile(const std::string& file, const std::vector<std::string>& set, bool kernel) {
  return compileGrammarText(host::readText(file), file, set, kernel);
}

} // namespace gpgp::cli
