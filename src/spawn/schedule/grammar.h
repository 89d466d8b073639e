// A grammar as an asset: the checked graph for questions of the CPU, its words on the device for the interpreter, and
// the kernels that it was baked with, which are pipelines once gpgpPrewarmGrammar has made them.
#pragma once
#include "core/resident.h"
#include "spawn/graph/blob.h"
#include "spawn/graph/kernel.h"
#include "spawn/schedule/turns.h"

#include <array>
#include <cstring>

namespace gpgp::spawn {

class Grammar final : public core::Resident {
public:
  /// Checks baked bytes and queues the graph for upload.
  static core::Result<core::Unique<Grammar>> create(core::Context& context, const char* label,
                                                    std::span<const std::byte> bytes);
  Grammar(core::Context& owner, const char* name, Graph&& checked, std::pmr::vector<Kernel>&& baked)
      : Resident(owner, core::Kind::grammar, name), graph(std::move(checked)), kernels(std::move(baked)),
        tables_(&owner.host()) {}
  ~Grammar() override;

  /// A kernel that can run.
  struct Ready {
    KernelInfo info;
    VkPipeline pipeline = VK_NULL_HANDLE;
  };
  /// The best one for a number of axioms: tuned for the nearest number, or for any. Null: the interpreter.
  const Ready* kernelFor(uint32_t axioms) const;
  bool isReady(const KernelInfo& info) const {
    for (uint32_t i = 0; i < readyCount(); ++i)
      if (std::memcmp(&ready_[i].info, &info, sizeof info) == 0) return true;
    return false;
  }
  /// Adds one. Calls for the same grammar come one after the other.
  void add(const Ready& ready);
  static constexpr uint32_t kMaxReady = 40; ///< more than axiomCount has classes, by bits, and one for any
  uint32_t readyCount() const { return readyCount_.load(std::memory_order_acquire); }
  /// Whether a spawner has made those of its kernels that it can run, even if there are none.
  bool prewarmed() const { return prewarmed_.load(std::memory_order_acquire); }
  void setPrewarmed() { prewarmed_.store(true, std::memory_order_release); }

  const Graph graph;
  const bool uneven = isUneven(graph); ///< asked for by each recording
  const Turns turns = turnsOf(graph);  ///< and by those of software devices
  const std::pmr::vector<Kernel> kernels;
  /// Where a kernel's table begins in the uploaded words, in units of 16 bytes.
  uint32_t tableOf(const Kernel& kernel) const { return tables_[static_cast<size_t>(&kernel - kernels.data())]; }

private:
  std::pmr::vector<uint32_t> tables_;
  std::array<Ready, kMaxReady> ready_{};
  std::atomic<uint32_t> readyCount_{0};
  std::atomic<bool> prewarmed_{false};
};

} // namespace gpgp::spawn
