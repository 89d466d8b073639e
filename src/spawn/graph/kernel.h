// Kernels baked behind a graph: SPIR-V that derives this one graph, and the schedule it stands for.
//
// A baked grammar is the graph's words (blob.h), then any number of kernels, each with a header, a checksum of its own
// and the checksum of the graph that it was made for. A grammar without kernels is complete: the interpreter runs it.
#pragma once
#include "spawn/graph/graph.h"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace gpgp::spawn {

/// How derivation fits a device and a grammar: the part of a schedule that is numbers.
struct Fit {
  uint32_t groupSize = 0;   ///< invocations of a workgroup, a power of two from 8; 0: all as the device's kind suggests
  uint32_t maxGroups = 0;   ///< workgroups of a round
  uint32_t stackShapes = 0; ///< of a workgroup: on its stack, and a batch of parents
  uint32_t spread = 0;      ///< shapes that a round should at least begin with
  uint32_t rounds = 0;   ///< that are recorded for the number of axioms it was tuned for; 0: all that the spawner may
  uint32_t balances = 0; ///< 1: work is given away as well where most workgroups have finished

  bool operator==(const Fit&) const = default;
};

/// The devices that a kernel is compiled for.
enum class KernelTarget : uint32_t {
  any,
  subgroups, ///< with subgroup arithmetic, ballots and shuffles in compute shaders
  software   ///< on the CPU, and with them (shaders/spawn/derive/derive_batches.glsl); workgroups are subgroups
};

/// Where shapes wait in a workgroup.
enum class Queues : uint32_t {
  mixed, ///< all on one stack: batches are of any execution groups
  groups ///< each execution group has a queue, and batches are of one (shaders/spawn/derive/queues.glsl)
};

/// The code that a kernel has room for, in operators. Each counts wherever it is inlined, with a share for its
/// expressions and edges, and more where it keeps one of several shapes. The sample grammars need 2 to 138.
constexpr uint32_t kRoom = 256;

/// What one kernel is for.
struct KernelInfo {
  Fit fit;
  uint32_t vendor = 0, device = 0; ///< VkPhysicalDeviceProperties; 0: any
  uint32_t axioms = 0;             ///< tuned for this many axioms; 0: any
  KernelTarget target = KernelTarget::any;
  uint32_t groups = 0; ///< execution groups of the schedule
  Queues queues = Queues::mixed;
  char schedule[32] = {}; ///< a name for people
};

struct Kernel {
  KernelInfo info;
  std::pmr::vector<uint32_t> code; ///< words of the table, the table (shaders/spawn/kernel/table_format.h), SPIR-V

  std::span<const uint32_t> table() const { return std::span(code).subspan(1, code[0]); }
  std::span<const uint32_t> spirv() const { return std::span(code).subspan(1 + code[0]); }
};

/// Words to append to a graph's words.
std::pmr::vector<uint32_t> serialize(const KernelInfo& info, std::span<const uint32_t> code, uint32_t graphChecksum,
                                     std::pmr::memory_resource* memory);

/// The kernels behind a graph. Damaged ones, and ones for another graph, are an error.
core::Result<std::pmr::vector<Kernel>> loadKernels(std::span<const std::byte> bytes, uint32_t graphChecksum,
                                                   std::pmr::memory_resource* memory);

/// A whole baked grammar.
struct Baked {
  Graph graph;
  std::pmr::vector<Kernel> kernels;
};
/// Checks every byte: the graph as load() does (blob.h), and that only whole kernels for it follow.
core::Result<Baked> loadBaked(std::span<const std::byte> bytes, std::pmr::memory_resource* memory);

} // namespace gpgp::spawn
