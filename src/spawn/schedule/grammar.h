// A grammar as an asset: the checked graph for questions of the CPU, its words on the device for the interpreter.
#pragma once
#include "core/resident.h"
#include "spawn/graph/blob.h"

namespace gpgp::spawn {

class Grammar final : public core::Resident {
public:
  /// Checks baked bytes and queues them for upload.
  static core::Result<core::Unique<Grammar>> create(core::Context& context, const char* label,
                                                    std::span<const std::byte> bytes) {
    auto graph = load(bytes, &context.host());
    if (!graph) return graph.error();
    auto grammar = core::makeUnique<Grammar>(context.host(), context, label, std::move(*graph));
    std::pmr::vector<std::byte> words(bytes.begin(), bytes.end(), &context.host());
    if (auto ok = grammar->makeResident(GPGP_SERVICE_SPAWN, std::move(words)); !ok) return ok.error();
    return grammar;
  }
  Grammar(core::Context& owner, const char* name, Graph&& checked)
      : Resident(owner, core::Kind::grammar, name), graph(std::move(checked)) {}

  const Graph graph;
};

} // namespace gpgp::spawn
