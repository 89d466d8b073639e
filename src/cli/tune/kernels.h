// Kernels of a grammar by schedule, and the baked files that keep tuned ones.
#pragma once
#include "cli/shared/common.h"
#include "cli/spawn/axioms.h"
#include "cli/spawn/grammar_source.h"
#include "host/device.h"
#include "spawn/codegen/schedules.h"
#include "spawn/graph/kernel.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpgp::cli {

/// A grammar's graph, and the same baked.
struct BakedGraph {
  std::pmr::vector<uint32_t> words;
  spawn::Graph graph;

  /// Names of all starts, as GpgpAxiom::start counts them.
  std::vector<NamedStart> namedStarts() const;
  /// Where axioms start in turn that nobody says more of: each linked grammar, or the only one.
  std::vector<uint32_t> starts() const;
};
/// Of files as addGrammars takes them, with variables set as --set takes them. Several, or one with an alias, are
/// linked. Throws Usage and Failure.
BakedGraph bakeGraph(const std::vector<std::string>& files, const std::vector<std::string>& set);
/// The same of what was read.
BakedGraph bakeGraph(std::span<const GrammarText> texts, bool linked, const std::vector<std::string>& set);
/// Of the text of a grammar that a file has in another form.
BakedGraph bakeText(const std::string& file, const std::string& text);
/// For messages: a.pga + b.pga; and for JSON: a string, of several files a list.
std::string joined(const std::vector<std::string>& files);
Json jsonOf(const std::vector<std::string>& files);

/// A named schedule, or the one of a file with groups as `gpgp graph` prints it; nothing where there is neither.
std::optional<spawn::Schedule> scheduleFor(const spawn::Graph& graph, const std::string& nameOrFile,
                                           const spawn::Heuristics& heuristics);
/// The option --queues: what --schedule names, with a queue for each execution group or without.
void addQueues(CLI::App& command, std::string& queues, const std::string& unless);
/// The option --group-size: t of the heuristics.
void addGroupSize(CLI::App& command, spawn::Heuristics& heuristics);

/// The best of what a graph's kernels can be compiled for that the library takes on this device.
spawn::KernelTarget targetFor(const host::HeadlessDevice& device, const spawn::Graph& graph,
                              spawn::Queues queues = spawn::Queues::mixed);

using KernelCode = std::vector<uint32_t>; ///< as spawn::Kernel::code
/// The kernel of each schedule, compiled on all processors, for what the device runs of it. matching: execution groups
/// that differ in parameters only share code.
std::vector<KernelCode> compileKernels(const spawn::Graph& graph, std::span<const spawn::Schedule> schedules,
                                       const host::HeadlessDevice& device, bool matching);

/// The kernels of a schedule for kinds of devices. Messages say what of them is interpreted, and where one cannot be
/// compiled, which is empty then. grammar: its name in messages.
std::vector<KernelCode> compileOrSay(const spawn::Graph& graph, const spawn::Schedule& schedule,
                                     std::span<const spawn::KernelTarget> targets, bool matching,
                                     const std::string& grammar);

/// What a kernel says of itself, for any device and number of axioms.
spawn::KernelInfo kernelInfo(const spawn::Schedule& schedule, spawn::KernelTarget target);
/// As it stands in a file behind the graph.
std::pmr::vector<uint32_t> kernelWords(const BakedGraph& grammar, const spawn::KernelInfo& info,
                                       std::span<const uint32_t> code);

/// A grammar's words with kernels behind them, for each of --schedule's values: of a named schedule or a file with
/// groups one for each kind of device; of a baked file, or of where tuned ones are kept, what is there. files: as
/// tunedFile. queues: of schedules that are compiled. Throws Usage and Failure.
std::pmr::vector<uint32_t> withKernels(const BakedGraph& grammar, const std::vector<std::string>& files,
                                       const std::vector<std::string>& schedules, const spawn::Heuristics& heuristics,
                                       spawn::Queues queues);

/// Whether a file begins as baked grammars do.
bool isBaked(const std::filesystem::path& file);
/// A baked file that is cut, damaged or of another version of the library: nobody can use it.
struct Unusable : Failure {
  using Failure::Failure;
};
/// The kernels of a baked file of this very graph. Throws where the file is something else; Unusable where nobody can
/// say any more what it was.
std::pmr::vector<spawn::Kernel> kernelsIn(const std::filesystem::path& file, const BakedGraph& grammar);
/// The kernels in a file that keeps tuned ones. None where it is not there, and where it cannot be used, which is said
/// on standard error: it is made anew then. Throws where it is something else, which only a cache's files cannot be.
std::pmr::vector<spawn::Kernel> storedKernels(const std::filesystem::path& file, const BakedGraph& grammar, bool cache);
/// Of those, the one that the library would take for this device and number of axioms; nothing where none fits.
std::optional<spawn::Kernel> kernelFor(std::span<const spawn::Kernel> kernels, const host::HeadlessDevice& device,
                                       uint32_t axioms);
/// Whether it was tuned for this device and for about as many axioms: the same power of two.
bool isTunedFor(const spawn::KernelInfo& info, const host::HeadlessDevice& device, uint32_t axioms);
/// Writes the graph with this kernel and others, but for one of them for the same device and about as many axioms.
void keepKernel(const std::filesystem::path& file, const BakedGraph& grammar, const spawn::KernelInfo& info,
                std::span<const uint32_t> code, std::span<const spawn::Kernel> others);
/// Throws where that would not be possible, as long as nothing was done for it yet.
void checkWritable(const std::filesystem::path& file);
/// Where tuned kernels are kept unless a file is named: in $XDG_CACHE_HOME/gpgp, or else in ~/.cache/gpgp, by the
/// grammars' names and the graph's checksum.
std::filesystem::path tunedFile(const std::vector<std::string>& files, const BakedGraph& grammar);

} // namespace gpgp::cli
