// gpgpCompileGrammar: text, or what a builder holds, to a baked grammar.
#include "spawn/codegen/compile_kernel.h"
#include "spawn/codegen/generate.h"
#include "spawn/codegen/schedules.h"
#include "spawn/graph/blob.h"
#include "spawn/graph/kernel.h"
#include "spawn/language/build_graph.h"
#include "spawn/language/builder.h"

#include <cstdlib>
#include <cstring>

using namespace gpgp;

namespace {
void report(const GpgpGrammarSource& source, uint32_t line, uint32_t column, GpgpSeverity severity, const char* text) {
  if (!source.messageFn) return;
  const GpgpCompileMessage message{source.name ? source.name : "", line, column, severity, text};
  source.messageFn(source.messageUserData, &message);
}

GpgpResult fail(const GpgpGrammarSource& source, GpgpResult result, const char* text) {
  const uint32_t first = source.builder ? 0 : 1;
  report(source, first, first, GPGP_SEVERITY_ERROR, text);
  return result;
}

void report(const GpgpGrammarSource& source, const spawn::Diagnostics& diagnostics) {
  for (const spawn::Diagnostic& d : diagnostics.sorted()) {
    if (!source.builder) {
      report(source, d.place.line, d.place.column, d.severity, d.text.c_str());
    } else { // places have names instead
      const std::string place = diagnostics.isNamed(d.place) ? diagnostics.where(d.place) + ": " : std::string();
      report(source, 0, 0, d.severity, (place + d.text).c_str());
    }
  }
}
} // namespace

GpgpResult GPGP_CALL gpgpCompileGrammar(const GpgpGrammarSource* source, GpgpBlob* blob) {
  if (!source || !blob) return GPGP_ERROR_INVALID_ARGUMENT;
  if (source->sType != GPGP_STRUCTURE_GRAMMAR_SOURCE || source->pNext) return GPGP_ERROR_INVALID_STRUCT;
  try {
    if (source->builder && source->text)
      return fail(*source, GPGP_ERROR_INVALID_ARGUMENT, "both text and builder are set");
    if (!source->text && source->size) return fail(*source, GPGP_ERROR_INVALID_ARGUMENT, "text is NULL, size is not 0");
    if (!source->variables && source->variableCount)
      return fail(*source, GPGP_ERROR_INVALID_ARGUMENT, "variables is NULL, variableCount is not 0");
    for (uint32_t i = 0; i < source->variableCount; ++i)
      if (!source->variables[i].name) return fail(*source, GPGP_ERROR_INVALID_ARGUMENT, "a variable's name is NULL");
    if (source->flags & ~GPGP_COMPILE_KERNEL)
      return fail(*source, GPGP_ERROR_INVALID_ARGUMENT, "flags has unknown bits");
    if (source->size > (size_t(1) << 28)) return fail(*source, GPGP_ERROR_INVALID_ARGUMENT, "the text is over 256 MiB");
    std::pmr::memory_resource* memory = std::pmr::new_delete_resource();
    spawn::Diagnostics diagnostics;
    const std::string_view text(source->text ? source->text : "", source->size);
    const spawn::SyntaxTree tree =
        source->builder ? spawn::treeOf(*source->builder, diagnostics) : spawn::parse(text, diagnostics);
    const spawn::Graph graph = spawn::buildGraph(tree, {source->variables, source->variableCount}, diagnostics, memory);
    report(*source, diagnostics);
    if (diagnostics.hasErrors()) return GPGP_ERROR_INVALID_DATA;
    if (auto ok = spawn::validate(graph); !ok) return fail(*source, GPGP_ERROR_UNSUPPORTED, ok.error().text);
    auto words = spawn::serialize(graph, memory);
    if (source->flags & GPGP_COMPILE_KERNEL) {
      const spawn::Schedule schedule = *spawn::namedSchedule(graph, "default");
      const spawn::KernelSource kernelSource = spawn::generate(graph, schedule.waits);
      for (const bool subgroups : {true, false}) { // the first that a device can run is taken
        const auto code = spawn::compileKernel(kernelSource, subgroups);
        if (!code) return fail(*source, code.error().code, code.error().text);
        spawn::KernelInfo info;
        info.subgroups = subgroups;
        info.groups = static_cast<uint32_t>(schedule.groups);
        schedule.name.copy(info.schedule, sizeof info.schedule - 1);
        const auto kernel = spawn::serialize(info, *code, words[shader::kHeaderChecksum], memory);
        words.insert(words.end(), kernel.begin(), kernel.end());
      }
    }
    GpgpBlob made{std::malloc(words.size() * 4), words.size() * 4};
    if (!made.data) return fail(*source, GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
    std::memcpy(made.data, words.data(), made.size);
    *blob = made;
    return GPGP_SUCCESS;
  } catch (const std::bad_alloc&) {
    return fail(*source, GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
  } catch (...) {
    return fail(*source, GPGP_ERROR_OUT_OF_HOST_MEMORY, "the compiler failed");
  }
}
