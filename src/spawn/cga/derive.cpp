// Axioms to threads in blocks of fixed size, and their results together in order.
#include "spawn/cga/derive.h"

#include "spawn/cga/deriver.h"

#include <algorithm>
#include <atomic>
#include <thread>

namespace gpgp::spawn::cga {

namespace {

struct AxiomBlock {
  Derivation derivation;
  Messages messages;
};

constexpr size_t kBlock = 32;      ///< axioms; of fixed size, so that sums are added in the same order by any threads
constexpr uint32_t kMostJobs = 64; ///< each has a machine of its own, some MiB

size_t threadsOf(const DeriveOptions& options) {
  return options.threads ? options.threads : std::max(1u, std::thread::hardware_concurrency());
}

void runOnThreads(size_t count, const std::function<void()>& work) {
  std::vector<std::thread> threads;
  for (size_t i = 1; i < count; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
}

void inParallel(size_t blocks, const DeriveOptions& options, const std::function<void()>& work) {
  if (options.parallelFor)
    options.parallelFor(static_cast<uint32_t>(std::min<size_t>(blocks, kMostJobs)), work);
  else
    runOnThreads(std::min(threadsOf(options), blocks), work);
}

/// Where a part's strings stand in all: the program's as they are, others once.
std::vector<uint32_t> takeNames(Derivation& all, const Derivation& part, size_t programStrings) {
  std::vector<uint32_t> places;
  for (size_t i = 0; i < part.names.size(); ++i) {
    size_t at = i;
    if (i >= programStrings) {
      const auto begin = all.names.begin() + static_cast<ptrdiff_t>(programStrings);
      at = static_cast<size_t>(std::find(begin, all.names.end(), part.names[i]) - all.names.begin());
      if (at == all.names.size()) all.names.push_back(part.names[i]);
    }
    places.push_back(static_cast<uint32_t>(at));
  }
  return places;
}

} // namespace

void append(Derivation& all, Derivation&& part, const std::vector<uint32_t>& places) {
  const uint32_t firstVertex = static_cast<uint32_t>(all.vertices.size());
  const uint32_t firstIndex = static_cast<uint32_t>(all.indices.size());
  for (Leaf leaf : part.leaves) {
    leaf.name = places[leaf.name];
    leaf.texture = places[leaf.texture];
    leaf.firstIndex += firstIndex;
    all.leaves.push_back(leaf);
  }
  all.scopes.insert(all.scopes.end(), part.scopes.begin(), part.scopes.end());
  all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const uint32_t i : part.indices) all.indices.push_back(firstVertex + i);
  for (const auto& [name, report] : part.reports) {
    Report& to = all.reports[name];
    to.least = to.count ? std::min(to.least, report.least) : report.least;
    to.most = to.count ? std::max(to.most, report.most) : report.most;
    to.count += report.count;
    to.sum += report.sum;
  }
  for (std::string& print : part.prints)
    if (all.prints.size() < Derivation::kMostPrints) all.prints.push_back(std::move(print));
  all.printed += part.printed;
  all.shapes += part.shapes;
  all.triangles += part.triangles;
  all.depth = std::max(all.depth, part.depth);
  all.work = std::max(all.work, part.work);
}

void addSurroundings(const Program& program, const std::vector<Axiom>& axioms, const DeriveOptions& options,
                     Surroundings& surroundings) {
  std::vector<std::vector<Occluder>> shapes(axioms.size());
  std::atomic<size_t> next{0};
  inParallel((axioms.size() + kBlock - 1) / kBlock, options, [&] {
    std::unique_ptr<Deriver> deriver; // large
    Messages same;                    // as those that the derivation itself gives
    for (size_t first = kBlock * next++; first < axioms.size(); first = kBlock * next++) {
      if (!deriver) deriver = std::make_unique<Deriver>(program, options);
      for (size_t i = first; i < std::min(axioms.size(), first + kBlock); ++i)
        shapes[i] = deriver->seen(axioms[i], static_cast<uint32_t>(i), same);
    }
  });
  for (size_t i = 0; i < axioms.size(); ++i)
    surroundings.add(options.firstAxiom + static_cast<uint32_t>(i), std::move(shapes[i]));
}

Derivation derive(const Program& program, const std::vector<Axiom>& axioms, const DeriveOptions& given,
                  Messages& messages) {
  DeriveOptions options = given;
  Surroundings surroundings;
  if (program.asksAround && !options.surroundings && axioms.size() > 1) {
    addSurroundings(program, axioms, options, surroundings);
    surroundings.build();
    options.surroundings = &surroundings;
  }
  std::vector<AxiomBlock> blocks((axioms.size() + kBlock - 1) / kBlock);
  std::atomic<size_t> next{0};
  const auto work = [&] {
    std::unique_ptr<Deriver> deriver; // large
    for (size_t b = next++; b < blocks.size(); b = next++) {
      if (!deriver) deriver = std::make_unique<Deriver>(program, options);
      blocks[b].derivation.names = program.strings;
      for (size_t i = b * kBlock; i < std::min(axioms.size(), (b + 1) * kBlock); ++i)
        deriver->run(axioms[i], static_cast<uint32_t>(i), blocks[b].derivation, blocks[b].messages);
    }
  };
  inParallel(blocks.size(), options, work);
  Derivation result;
  for (AxiomBlock& block : blocks) {
    if (result.names.empty())
      result = std::move(block.derivation);
    else
      append(result, std::move(block.derivation), takeNames(result, block.derivation, program.strings.size()));
    messages.merge(block.messages);
  }
  if (result.names.empty()) result.names = program.strings;
  return result;
}

std::vector<FirstValue> firstValues(const Program& program, const DeriveOptions& options, Messages& messages) {
  return std::make_unique<Deriver>(program, options)->firstValues({}, messages);
}

} // namespace gpgp::spawn::cga
