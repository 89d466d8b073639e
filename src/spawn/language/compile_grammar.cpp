// gpgpCompileGrammar, gpgpLinkGrammars: text, what builders hold, or baked grammars to a baked grammar.
#include "spawn/codegen/compile_kernel.h"
#include "spawn/codegen/generate.h"
#include "spawn/codegen/schedules.h"
#include "spawn/gml/machine.h"
#include "spawn/graph/blob.h"
#include "spawn/graph/kernel.h"
#include "spawn/language/build_graph.h"
#include "spawn/language/builder.h"
#include "spawn/language/print.h"

#include <cstdlib>
#include <cstring>
#include <optional>

using namespace gpgp;

namespace {
void report(const GpgpGrammarSource& source, spawn::Place place, GpgpSeverity severity, const char* text,
            uint32_t omitted = 0) {
  if (!source.messageFn) return;
  const GpgpCompileMessage message{source.name ? source.name : "", place.line, place.column, severity, text, omitted};
  source.messageFn(source.messageUserData, &message);
}

GpgpResult fail(const GpgpGrammarSource& source, GpgpResult result, const char* text) {
  report(source, {}, GPGP_SEVERITY_ERROR, text);
  return result;
}

void report(const GpgpGrammarSource& source, const spawn::Diagnostics& diagnostics) {
  for (const spawn::Diagnostic& d : diagnostics.sorted()) {
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
  spawn::Diagnostics diagnostics;
  spawn::SyntaxTree tree;
  std::optional<spawn::Graph> baked;
  std::vector<spawn::Place> places{}; ///< of its nodes, where it was made of the text
};

/// The graph of a baked grammar; kernels behind it serve this graph alone, but must be whole, as all of the file must.
std::optional<spawn::Graph> load(const GpgpGrammarSource& source, spawn::Diagnostics& diagnostics) {
  const std::span bytes(static_cast<const std::byte*>(source.baked), source.size);
  auto graph = spawn::loadBaked(bytes, std::pmr::new_delete_resource());
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
std::optional<spawn::Graph> read(const GpgpGrammarSource& source, std::string_view text,
                                 spawn::Diagnostics& diagnostics) {
  auto printed = spawn::parseGraph(text, diagnostics, std::pmr::new_delete_resource());
  if (source.variableCount)
    diagnostics.error({},
                      std::string("a printed graph has no var '") + source.variables[0].name + "' that could be set");
  if (!printed) return std::nullopt;
  diagnostics.name({}, "the printed graph");
  return std::move(printed->graph);
}

/// The graph of a program in the stack language.
std::optional<spawn::Graph> runProgram(const GpgpGrammarSource& source, std::string_view text,
                                       spawn::Diagnostics& diagnostics, std::vector<spawn::Place>& places) {
  spawn::gml::PlacedGraph made =
      spawn::gml::compile(text, {source.variables, source.variableCount}, diagnostics, std::pmr::new_delete_resource());
  if (diagnostics.hasErrors()) return std::nullopt;
  places = std::move(made.places);
  return std::move(made.graph);
}

/// A graph with a kernel behind it, where one is wanted.
GpgpResult bake(const GpgpGrammarSource& first, const spawn::Graph& graph, bool kernel, GpgpBlob* blob) {
  std::pmr::memory_resource* memory = graph.nodes.get_allocator().resource();
  if (auto ok = spawn::validate(graph); !ok) return fail(first, GPGP_ERROR_UNSUPPORTED, ok.error().text);
  auto words = spawn::serialize(graph, memory);
  if (kernel) {
    const spawn::Schedule schedule = *spawn::namedSchedule(graph, "default");
    const spawn::KernelSource kernelSource = spawn::generate(graph, schedule.waits);
    if (const std::string remark = spawn::remarkOn(kernelSource); !remark.empty())
      report(first, {}, spawn::isWorthCompiling(kernelSource) ? GPGP_SEVERITY_INFO : GPGP_SEVERITY_WARNING,
             remark.c_str());
    for (const spawn::KernelTarget target : spawn::targetsOf(graph)) { // the first that a device can run is taken
      if (!spawn::isWorthCompiling(kernelSource)) break;
      const auto code = spawn::compileKernel(kernelSource, target);
      if (!code) { // without a kernel, the grammar is interpreted
        report(first, {}, GPGP_SEVERITY_WARNING, (std::string(spawn::kInterpreted) + code.error().text).c_str());
        continue;
      }
      spawn::KernelInfo info;
      info.target = target;
      info.groups = static_cast<uint32_t>(schedule.groups);
      schedule.name.copy(info.schedule, sizeof info.schedule - 1);
      const auto behind = spawn::serialize(info, *code, words[shader::kHeaderChecksum], memory);
      words.insert(words.end(), behind.begin(), behind.end());
    }
  }
  GpgpBlob made{std::malloc(words.size() * 4), words.size() * 4};
  if (!made.data) return fail(first, GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
  std::memcpy(made.data, words.data(), made.size);
  *blob = made;
  return GPGP_SUCCESS;
}

GpgpResult compile(std::span<const GpgpGrammarSource> sources, bool linked, GpgpBlob* blob) {
  for (const GpgpGrammarSource& source : sources)
    if (source.sType != GPGP_STRUCTURE_GRAMMAR_SOURCE || source.pNext) return GPGP_ERROR_INVALID_STRUCT;
  try {
    for (const GpgpGrammarSource& source : sources)
      if (const GpgpResult result = check(source); result != GPGP_SUCCESS) return result;
    std::vector<Input> inputs(sources.size());
    std::vector<spawn::GrammarPart> parts;
    std::map<std::string, std::string> files; // by the name of the grammar
    bool kernel = false;
    for (size_t i = 0; i < sources.size(); ++i) {
      const GpgpGrammarSource& source = sources[i];
      auto& [diagnostics, tree, baked, places] = inputs[i];
      const std::string file = source.name ? source.name : "", alias = source.alias ? source.alias : "";
      const std::string name = linked ? spawn::linkedName(alias.empty() ? file : alias) : std::string();
      const std::string_view text(source.text ? source.text : "", source.text ? source.size : 0);
      if (source.baked)
        tree.brokenAxiom = !(baked = load(source, diagnostics)); // was reported
      else if ((source.flags & GPGP_COMPILE_STACK_LANGUAGE) && !source.builder)
        tree.brokenAxiom = !(baked = runProgram(source, text, diagnostics, places));
      else if (spawn::isPrinted(text))
        tree.brokenAxiom = !(baked = read(source, text, diagnostics));
      else
        tree = source.builder ? spawn::treeOf(*source.builder, diagnostics) : spawn::parse(text, diagnostics);
      if (linked && !alias.empty() && alias != name)
        diagnostics.error({}, "the alias '" + alias + "' is no name; expected letters, digits and _, not digits alone");
      const auto [other, isNew] = files.try_emplace(name, file);
      if (linked && name.empty())
        diagnostics.error({},
                          "this grammar has no name; expected one, as of a file: what it is linked with calls it so");
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
      kernel = kernel || (source.flags & GPGP_COMPILE_KERNEL);
    }
    const spawn::Graph graph = spawn::buildGraph(parts, std::pmr::new_delete_resource());
    bool failed = false;
    for (size_t i = 0; i < sources.size(); ++i) {
      report(sources[i], inputs[i].diagnostics);
      failed = failed || inputs[i].diagnostics.hasErrors();
    }
    return failed ? GPGP_ERROR_INVALID_DATA : bake(sources[0], graph, kernel, blob);
  } catch (const std::bad_alloc&) {
    return fail(sources[0], GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
  } catch (...) {
    return fail(sources[0], GPGP_ERROR_OUT_OF_HOST_MEMORY, "the compiler failed");
  }
}
} // namespace

GpgpResult GPGP_CALL gpgpCompileGrammar(const GpgpGrammarSource* source, GpgpBlob* blob) {
  if (!source || !blob) return GPGP_ERROR_INVALID_ARGUMENT;
  return compile({source, 1}, false, blob);
}

GpgpResult GPGP_CALL gpgpLinkGrammars(const GpgpGrammarSource* sources, uint32_t sourceCount, GpgpBlob* blob) {
  if (!sources || !sourceCount || !blob) return GPGP_ERROR_INVALID_ARGUMENT;
  return compile({sources, sourceCount}, true, blob);
}
