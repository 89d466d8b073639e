#include "spawn/language/compile_grammar.h"

#include "spawn/gml/machine.h"
#include "spawn/graph/kernel.h"
#include "spawn/language/build_graph.h"
#include "spawn/language/print.h"

#include <optional>

namespace gpgp::spawn {
namespace {
void reportAll(const GpgpGrammarSource& source, const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics.sorted()) {
    if (!source.builder) {
      report(source, d.place, d.severity, d.text.c_str(), d.omitted);
    } else { // places have names instead
      const std::string place = diagnostics.isNamed(d.place) ? diagnostics.where(d.place) + ": " : std::string();
      report(source, {}, d.severity, (place + d.text).c_str(), d.omitted);
    }
  }
}

constexpr size_t kMostText = size_t(1) << 28;

GpgpResult check(const GpgpGrammarSource& source) {
  if ((source.builder != nullptr) + (source.text != nullptr) + (source.baked != nullptr) > 1)
    return fail(source, GPGP_ERROR_INVALID_ARGUMENT, "more than one of text, builder and baked is set");
  if (!source.text && !source.baked && source.size)
    return fail(source, GPGP_ERROR_INVALID_ARGUMENT, "text is NULL, size is not 0");
  if (!source.variables && source.variableCount)
    return fail(source, GPGP_ERROR_INVALID_ARGUMENT, "variables is NULL, variableCount is not 0");
  for (uint32_t i = 0; i < source.variableCount; ++i)
    if (!source.variables[i].name) return fail(source, GPGP_ERROR_INVALID_ARGUMENT, "a variable's name is NULL");
  if (source.flags & ~(GPGP_COMPILE_KERNEL | GPGP_COMPILE_STACK_LANGUAGE))
    return fail(source, GPGP_ERROR_INVALID_ARGUMENT, "flags has unknown bits");
  if (source.size > kMostText) return fail(source, GPGP_ERROR_INVALID_ARGUMENT, "the text is over 256 MiB");
  return GPGP_SUCCESS;
}

struct Input {
  Diagnostics diagnostics;
  SyntaxTree tree;
  std::optional<Graph> baked;
  std::vector<Place> places{}; ///< of its nodes, where it was made of the text
};

/// The graph of a baked grammar; kernels behind it serve this graph alone, but must be whole, as all of the file must.
std::optional<Graph> load(const GpgpGrammarSource& source, Diagnostics& diagnostics) {
  const std::span bytes(static_cast<const std::byte*>(source.baked), source.size);
  auto graph = loadBaked(bytes, std::pmr::new_delete_resource());
  if (!graph) {
    diagnostics.error({}, graph.error().text);
    return std::nullopt;
  }
  if (source.variableCount)
    diagnostics.error({}, std::string("a baked grammar has no var '") + source.variables[0].name +
                              "' that could be set; they were set when it was baked");
  diagnostics.name({}, "the baked grammar"); // in messages of others
  return std::move(graph->graph);
}

/// The graph of a printed form; groups in it are no part of a grammar.
std::optional<Graph> read(const GpgpGrammarSource& source, std::string_view text, Diagnostics& diagnostics) {
  auto printed = parseGraph(text, diagnostics, std::pmr::new_delete_resource());
  if (source.variableCount)
    diagnostics.error({},
                      std::string("a printed graph has no var '") + source.variables[0].name + "' that could be set");
  if (!printed) return std::nullopt;
  diagnostics.name({}, "the printed graph");
  return std::move(printed->graph);
}

/// The graph of a program in the stack language.
std::optional<Graph> runProgram(const GpgpGrammarSource& source, std::string_view text, Diagnostics& diagnostics,
                                std::vector<Place>& places) {
  gml::PlacedGraph made =
      gml::compile(text, {source.variables, source.variableCount}, diagnostics, std::pmr::new_delete_resource());
  if (diagnostics.hasErrors()) return std::nullopt;
  places = std::move(made.places);
  return std::move(made.graph);
}
} // namespace

void report(const GpgpGrammarSource& source, Place place, GpgpSeverity severity, const char* text, uint32_t omitted) {
  if (!source.messageFn) return;
  const GpgpCompileMessage message{source.name ? source.name : "", place.line, place.column, severity, text, omitted};
  source.messageFn(source.messageUserData, &message);
}

GpgpResult fail(const GpgpGrammarSource& source, GpgpResult result, const char* text) {
  report(source, {}, GPGP_SEVERITY_ERROR, text);
  return result;
}

GpgpResult graphOf(std::span<const GpgpGrammarSource> sources, bool linked, TreeOfBuilder treeOf, Graph& graph) {
  for (const GpgpGrammarSource& source : sources)
    if (source.sType != GPGP_STRUCTURE_GRAMMAR_SOURCE || source.pNext) return GPGP_ERROR_INVALID_STRUCT;
  for (const GpgpGrammarSource& source : sources)
    if (const GpgpResult result = check(source); result != GPGP_SUCCESS) return result;
  std::vector<Input> inputs(sources.size());
  std::vector<GrammarPart> parts;
  std::map<std::string, std::string> files; // by the name of the grammar
  for (size_t i = 0; i < sources.size(); ++i) {
    const GpgpGrammarSource& source = sources[i];
    auto& [diagnostics, tree, baked, places] = inputs[i];
    const std::string file = source.name ? source.name : "", alias = source.alias ? source.alias : "";
    const std::string name = linked ? linkedName(alias.empty() ? file : alias) : std::string();
    const std::string_view text(source.text ? source.text : "", source.text ? source.size : 0);
    if (source.baked)
      tree.brokenAxiom = !(baked = load(source, diagnostics)); // was reported
    else if ((source.flags & GPGP_COMPILE_STACK_LANGUAGE) && !source.builder)
      tree.brokenAxiom = !(baked = runProgram(source, text, diagnostics, places));
    else if (isPrinted(text))
      tree.brokenAxiom = !(baked = read(source, text, diagnostics));
    else
      tree = source.builder ? treeOf(*source.builder, diagnostics) : parse(text, diagnostics);
    if (linked && !alias.empty() && alias != name)
      diagnostics.error({}, "the alias '" + alias + "' is not a name; expected letters, digits and _, not only digits");
    const auto [other, isNew] = files.try_emplace(name, file);
    if (linked && name.empty())
      diagnostics.error({}, "this grammar has no name; expected one, such as a file name: linked grammars refer to it");
    else if (!isNew)
      diagnostics.error({}, "'" + name + "' is also the name of " + other->second +
                                "; expected another file name, or an alias: linked grammars are told apart by them");
    parts.push_back({&tree,
                     baked ? &*baked : nullptr,
                     {source.variables, source.variableCount},
                     &diagnostics,
                     name,
                     file,
                     places.empty() ? nullptr : &places});
  }
  graph = buildGraph(parts, std::pmr::new_delete_resource());
  bool failed = false;
  for (size_t i = 0; i < sources.size(); ++i) {
    reportAll(sources[i], inputs[i].diagnostics);
    failed = failed || inputs[i].diagnostics.hasErrors();
  }
  if (failed) return GPGP_ERROR_INVALID_DATA;
  if (auto ok = validate(graph); !ok) return fail(sources[0], GPGP_ERROR_UNSUPPORTED, ok.error().text);
  return GPGP_SUCCESS;
}

} // namespace gpgp::spawn
