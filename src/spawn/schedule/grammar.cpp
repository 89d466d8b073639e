#include "spawn/schedule/grammar.h"

#include <bit>
#include <cstdlib>

namespace gpgp::spawn {

core::Result<core::Unique<Grammar>> Grammar::create(core::Context& context, const char* label,
                                                    std::span<const std::byte> bytes) {
  auto baked = loadBaked(bytes, &context.host());
  if (!baked) return baked.error();
  auto grammar =
      core::makeUnique<Grammar>(context.host(), context, label, std::move(baked->graph), std::move(baked->kernels));
  // Kernels read their tables four words at a time.
  const auto graphBytes = static_cast<std::ptrdiff_t>(sizeOfGraph(bytes));
  std::pmr::vector<std::byte> words(bytes.begin(), bytes.begin() + graphBytes, &context.host());
  for (const Kernel& kernel : grammar->kernels) {
    words.resize((words.size() + 15) / 16 * 16);
    grammar->tables_.push_back(static_cast<uint32_t>(words.size() / 16));
    const auto table = std::as_bytes(kernel.table());
    words.insert(words.end(), table.begin(), table.end());
  }
  if (auto ok = grammar->makeResident(GPGP_SERVICE_SPAWN, std::move(words)); !ok) return ok.error();
  return grammar;
}

Grammar::~Grammar() {
  const core::Device& device = context.device;
  for (const Ready& ready : ready_) device.vk.DestroyPipeline(device.device, ready.pipeline, nullptr);
}

const Grammar::Ready* Grammar::kernelFor(uint32_t axioms) const {
  const auto distance = [axioms](const Ready& ready) { // in powers of two; a kernel for any number is the last choice
    return ready.info.axioms ? std::abs(static_cast<int>(std::bit_width(ready.info.axioms)) -
                                        static_cast<int>(std::bit_width(axioms)))
                             : 64;
  };
  const Ready* best = nullptr;
  for (uint32_t i = 0; i < readyCount(); ++i)
    if (!best || distance(ready_[i]) < distance(*best)) best = &ready_[i];
  return best;
}

void Grammar::add(const Ready& ready) {
  const uint32_t count = readyCount();
  ready_[count] = ready;
  readyCount_.store(count + 1, std::memory_order_release);
}

} // namespace gpgp::spawn
