// gpgpCompileGrammar, gpgpLinkGrammars: text, what builders hold, or baked grammars to a baked grammar.
#include "core/blob.h"
#include "spawn/codegen/compile_kernel.h"
#include "spawn/codegen/generate.h"
#include "spawn/codegen/schedules.h"
#include "spawn/graph/blob.h"
#include "spawn/graph/kernel.h"
#include "spawn/language/builder.h"
#include "spawn/language/compile_grammar.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

using namespace gpgp;

namespace {
using spawn::fail;
using spawn::report;

/// A graph with a kernel behind it, where one is wanted.
GpgpResult bake(const GpgpGrammarSource& first, const spawn::Graph& graph, bool kernel, GpgpBlob* blob) {
  std::pmr::memory_resource* memory = graph.nodes.get_allocator().resource();
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
  const GpgpBlob made = core::copyToBlob(std::as_bytes(std::span(words)));
  if (!made.data) return fail(first, GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
  *blob = made;
  return GPGP_SUCCESS;
}

GpgpResult compile(std::span<const GpgpGrammarSource> sources, bool linked, GpgpBlob* blob) {
  try {
    spawn::Graph graph(std::pmr::new_delete_resource());
    if (const GpgpResult result = spawn::graphOf(sources, linked, spawn::treeOf, graph); result != GPGP_SUCCESS)
      return result;
    const bool kernel = std::any_of(sources.begin(), sources.end(), [](const GpgpGrammarSource& source) {
      return (source.flags & GPGP_COMPILE_KERNEL) != 0;
    });
    return bake(sources[0], graph, kernel, blob);
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
