// Baked grammars: an operator graph as checked, checksummed words (layout: shaders/spawn/shared/graph_format.h).
#pragma once
#include "spawn/graph/graph.h"

#include <span>

namespace gpgp::spawn {

/// The words of a valid graph. The same graph always gives the same words.
std::pmr::vector<uint32_t> serialize(const Graph& graph, std::pmr::memory_resource* memory);

/// The graph of baked bytes, after checking magic, version, size, checksum and every reference. Arbitrary bytes give an
/// error, never a graph that the interpreter cannot run. Everything is allocated from memory.
core::Result<Graph> load(std::span<const std::byte> bytes, std::pmr::memory_resource* memory);

/// How many of the bytes are the graph's, as its header says; all where that cannot be. Kernels may follow (kernel.h).
size_t sizeOfGraph(std::span<const std::byte> bytes);

/// Of words from kHeaderChecked on.
uint32_t checksum(std::span<const uint32_t> words);

} // namespace gpgp::spawn
