// Any bytes as the kernels behind a baked grammar: as they come, with each header's size, sums and graph made right so
// that the checks behind them are reached, and as changes to good kernels. What loads bakes to the same bytes again.
#include "spawn/graph/blob.h"
#include "spawn/graph/kernel.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace {
using namespace gpgp::spawn;

constexpr uint32_t kGraph = 0x1234567;
constexpr size_t kSize = 2, kSum = 3, kSummedFrom = 4, kInfo = 5; // words in a kernel's header

void check(const std::vector<uint32_t>& words) {
  const auto memory = std::pmr::get_default_resource();
  const auto kernels = loadKernels(std::as_bytes(std::span(words)), kGraph, memory);
  if (!kernels) return;
  std::vector<uint32_t> again;
  for (const Kernel& kernel : *kernels) {
    const auto baked = serialize(kernel.info, kernel.code, kGraph, memory);
    again.insert(again.end(), baked.begin(), baked.end());
    if (std::memchr(kernel.info.schedule, 0, sizeof kernel.info.schedule) == nullptr) std::abort();
  }
  if (again != words) std::abort();
}

void sum(std::span<uint32_t> kernel) {
  if (kernel.size() > kSummedFrom) kernel[kSum] = gpgp::spawn::checksum(kernel.subspan(kSummedFrom));
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto memory = std::pmr::get_default_resource();
  (void)loadKernels(std::as_bytes(std::span(data, size)), kGraph, memory);

  const uint32_t code[] = {4, 1, 2, 3, 4, 0x07230203, 0x10500, 0, 1, 0}; // a table of four words, SPIR-V
  KernelInfo info{.fit = {64, 128, 1024, 0, 8}, .axioms = 5, .schedule = "tuned"};
  const auto first = serialize(info, code, kGraph, memory), second = serialize({}, code, kGraph, memory);
  std::vector<uint32_t> good(first.begin(), first.end());
  good.insert(good.end(), second.begin(), second.end());
  if (!loadKernels(std::as_bytes(std::span(good)), kGraph, memory)) std::abort();
  check(good);

  std::vector<uint32_t> own(size / 4); // two kernels of the input's own words behind good magic and version
  if (!own.empty()) std::memcpy(own.data(), data, own.size() * 4);
  for (const auto half : {std::span(own).first(own.size() / 2), std::span(own).subspan(own.size() / 2)}) {
    if (half.size() <= kInfo) continue;
    std::copy_n(first.begin(), kInfo, half.begin());
    half[kSize] = static_cast<uint32_t>(half.size());
    sum(half);
  }
  check(own);

  for (size_t i = 0; i + 4 <= size; i += 4) { // changes: place, place, how, value
    const size_t at = (data[i] | size_t(data[i + 1]) << 8) % (good.size() * 4);
    uint8_t bytes[4];
    std::memcpy(bytes, &good[at / 4], 4);
    bytes[at % 4] = static_cast<uint8_t>(data[i + 2] % 2 ? data[i + 3] : bytes[at % 4] ^ 1u << data[i + 3] % 8);
    std::memcpy(&good[at / 4], bytes, 4);
    if (i % 32) continue;
    sum(std::span(good).first(first.size()));
    sum(std::span(good).subspan(first.size()));
    check(good);
  }
  return 0;
}
