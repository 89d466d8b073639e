#include "cli/spawn/grammar_source.h"

#include "cli/shared/command.h"
#include "cli/shared/messages.h"
#include "cli/spawn/cga_source.h"
#include "spawn/language/build_graph.h"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace gpgp::cli {
namespace {

struct Assignment {
  std::string grammar; ///< empty: the only one
  std::string name;
  float value = 0;
  std::string text; ///< all of it
};

Assignment parseAssignment(const std::string& text, bool linked) {
  const size_t equals = text.find('=');
  char* end = nullptr;
  Assignment result;
  result.text = text;
  result.value = equals == std::string::npos ? 0.0f : std::strtof(text.c_str() + equals + 1, &end);
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size() || *end != 0 ||
      !std::isfinite(result.value))
    throw Usage("--set takes NAME=VALUE with a number, for example --set floors=12; got \"" + text + "\"");
  result.name = text.substr(0, equals);
  if (!linked) return result;
  const size_t point = result.name.find('.');
  if (point == std::string::npos)
    throw Usage("of linked grammars, --set takes GRAMMAR.NAME=VALUE, for example --set tower.floors=12; got \"" + text +
                "\"");
  result.grammar = result.name.substr(0, point);
  result.name.erase(0, point + 1);
  return result;
}

std::string nameOf(const GrammarFile& file) { return file.alias.empty() ? spawn::linkedName(file.path) : file.alias; }

/// Further errors are counted.
constexpr uint32_t kMostPrinted = 20;

struct Errors {
  std::span<const Assignment> assignments;
  std::string first;
  uint32_t count = 0;

  static void GPGP_CALL print(void* userData, const GpgpCompileMessage* message) {
    auto* all = static_cast<Errors*>(userData);
    const bool isError = message->severity == GPGP_SEVERITY_ERROR;
    if (isError && all->count >= kMostPrinted) {
      all->count += message->omitted ? message->omitted : 1;
      return;
    }
    std::ostringstream line;
    line << message->file << ':';
    if (message->line) line << message->line << ':' << message->column << ':';
    line << ' '
         << (isError                                      ? "error: "
             : message->severity == GPGP_SEVERITY_WARNING ? "warning: "
                                                          : "note: ")
         << message->text;
    for (const Assignment& a : all->assignments) // the place of what the command line says
      if (!message->line && std::string_view(message->text).find("var '" + a.name + "'") != std::string_view::npos)
        line << " (--set " << a.text << ')';
    std::fprintf(stderr, "%s\n", printable(line.str()).c_str());
    if (!isError) return;
    if (all->count == 0) all->first = line.str();
    all->count += message->omitted ? message->omitted : 1;
  }
};

} // namespace

void expectGraphLanguage(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".lsys")
    throw Usage(file + ": an L-system has no operator graph, so it cannot be baked, tuned or printed; `gpgp spawn " +
                file + "` derives it, and gpgpCompileLsystem() makes the data that an engine loads");
}

namespace {

Blob compile(std::span<const GrammarText> grammars, bool linked, const std::vector<std::string>& set, bool kernel) {
  for (const GrammarText& grammar : grammars) expectGraphLanguage(grammar.file.path);
  std::vector<Assignment> assignments;
  assignments.reserve(set.size());
  for (const std::string& text : set) assignments.push_back(parseAssignment(text, linked));
  std::vector<std::vector<GpgpVariable>> variables(grammars.size());
  std::vector<std::string> graphs(grammars.size()); // of .cga files
  for (size_t i = 0; i < grammars.size(); ++i)
    if (isCga(grammars[i].file.path) && !grammars[i].text.starts_with("gppg")) {
      std::vector<std::string> attributes;
      for (const Assignment& a : assignments)
        if (!linked || nameOf(grammars[i].file) == a.grammar)
          attributes.push_back(a.name + a.text.substr(a.text.find('=')));
      graphs[i] = cgaGraph(grammars[i].file.path, grammars[i].text, attributes);
    }
  for (const Assignment& a : assignments) {
    bool found = false;
    for (size_t i = 0; i < grammars.size(); ++i) {
      if (linked && nameOf(grammars[i].file) != a.grammar) continue;
      if (graphs[i].empty()) variables[i].push_back({a.name.c_str(), a.value}); // else it is in the graph
      found = true;
    }
    if (found) continue;
    std::string names;
    for (const GrammarText& grammar : grammars) names += (names.empty() ? "" : ", ") + nameOf(grammar.file);
    throw Usage("--set " + a.grammar + "." + a.name + ": there is no grammar \"" + a.grammar + "\"; there are " +
                names);
  }
  Errors errors{assignments, {}, 0};
  std::vector<GpgpGrammarSource> sources;
  for (size_t i = 0; i < grammars.size(); ++i) {
    GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
    source.name = grammars[i].file.path.c_str();
    if (!grammars[i].file.alias.empty()) source.alias = grammars[i].file.alias.c_str();
    if (!graphs[i].empty())
      source.text = graphs[i].data();
    else if (grammars[i].text.starts_with("gppg"))
      source.baked = grammars[i].text.data();
    else
      source.text = grammars[i].text.data();
    source.size = graphs[i].empty() ? grammars[i].text.size() : graphs[i].size();
    source.variables = variables[i].data();
    source.variableCount = static_cast<uint32_t>(variables[i].size());
    source.messageUserData = &errors;
    source.messageFn = Errors::print;
    if (kernel) source.flags |= GPGP_COMPILE_KERNEL;
    if (std::filesystem::path(grammars[i].file.path).extension() == ".gml") source.flags |= GPGP_COMPILE_STACK_LANGUAGE;
    sources.push_back(source);
  }
  Result<Blob> blob = linked ? gpgp::linkGrammars(sources.data(), static_cast<uint32_t>(sources.size()))
                             : gpgp::compileGrammar(sources[0]);
  if (blob) return std::move(*blob);
  if (errors.count == 0) throw Failure(grammars[0].file.path + ": " + blob.name());
  throw ErrorsShown(errors.first, errors.count);
}

} // namespace

GrammarFile::GrammarFile(const std::string& argument) : path(argument) {
  const size_t equals = argument.find('=');
  if (equals == std::string::npos || std::filesystem::exists(argument)) return;
  alias = argument.substr(0, equals);
  path = argument.substr(equals + 1);
  if (alias.empty() || spawn::linkedName(alias) != alias)
    throw Usage(argument + ": \"" + alias + "\" is not a name for " + path +
                "; expected letters, digits and _, not digits alone");
}

void addGrammars(CLI::App& command, std::vector<std::string>& arguments) {
  const auto exists = [](const std::string& argument) -> std::string {
    try {
      return CLI::ExistingFile(GrammarFile(argument).path);
    } catch (const Usage& error) {
      return error.what();
    }
  };
  command
      .add_option("GRAMMAR", arguments,
                  "PGA-shape grammar text (.pga), a stack program (.gml), a baked grammar, or a .cga file; several are "
                  "linked to one grammar, named after their files or by NAME=FILE")
      ->required()
      ->check(CLI::Validator(exists, "[NAME=]FILE"));
}

void addVariables(CLI::App& command, std::vector<std::string>& set) {
  command.add_option("--set", set, "Override a `var` of the grammar; of linked grammars GRAMMAR.NAME; may be repeated")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

void report(const spawn::Diagnostics& diagnostics, const std::string& file) {
  std::string first;
  uint32_t errors = 0;
  for (const spawn::Diagnostic& d : diagnostics.sorted()) {
    if (d.severity == GPGP_SEVERITY_ERROR && errors++ >= kMostPrinted) continue;
    const std::string line = spawn::format(d, file);
    std::fprintf(stderr, "%s\n", printable(line).c_str());
    if (first.empty() && d.severity == GPGP_SEVERITY_ERROR) first = line;
  }
  if (!diagnostics.hasErrors()) return;
  throw ErrorsShown(first, diagnostics.errorCount());
}

Blob compileGrammar(const GrammarText& grammar, const std::vector<std::string>& set, bool kernel) {
  return compile({&grammar, 1}, false, set, kernel);
}

Blob linkGrammars(std::span<const GrammarText> grammars, const std::vector<std::string>& set, bool kernel) {
  return compile(grammars, true, set, kernel);
}

} // namespace gpgp::cli
