#include "spawn/graph/kernel.h"

#include "spawn/graph/blob.h"

#include <cstring>

namespace gpgp::spawn {
namespace {
using core::makeError;

constexpr uint32_t kKernelMagic = 0x6b677067u; // "gpgk"
constexpr uint32_t kKernelVersion = 17;
constexpr uint32_t kMostPlaces = 4096; ///< of a stack with queues: their list lies in shared memory
constexpr uint32_t kSpirvMagic = 0x07230203u;
/// Words before the code: magic, version, words of everything, checksum of what follows it, graph, info.
constexpr uint32_t kChecked = 4, kInfo = 5, kInfoWords = sizeof(KernelInfo) / 4, kHeader = kInfo + kInfoWords;
static_assert(sizeof(KernelInfo) == 80);

bool isUsable(const KernelInfo& info) {
  const Fit& fit = info.fit;
  if (info.schedule[31] != 0 || info.target > KernelTarget::software || info.queues > Queues::groups) return false;
  if (info.queues == Queues::groups && (info.target == KernelTarget::software || fit.stackShapes > kMostPlaces))
    return false;
  if (fit == Fit{.rounds = fit.rounds}) return true; // as the device's kind suggests
  const bool power = (fit.groupSize & (fit.groupSize - 1)) == 0;
  return power && fit.groupSize >= 8 && fit.groupSize <= 1024 && fit.maxGroups >= 1 && fit.maxGroups <= 65535 &&
         fit.stackShapes >= 2 * fit.groupSize && fit.stackShapes <= (1u << 20) && fit.balances <= 1;
}
} // namespace

std::pmr::vector<uint32_t> serialize(const KernelInfo& info, std::span<const uint32_t> code, uint32_t graphChecksum,
                                     std::pmr::memory_resource* memory) {
  std::pmr::vector<uint32_t> words(kHeader, 0u, memory);
  words[0] = kKernelMagic;
  words[1] = kKernelVersion;
  words[2] = static_cast<uint32_t>(kHeader + code.size());
  words[kChecked] = graphChecksum;
  std::memcpy(words.data() + kInfo, &info, sizeof info);
  words.insert(words.end(), code.begin(), code.end());
  words[3] = checksum(std::span(words).subspan(kChecked));
  return words;
}

core::Result<std::pmr::vector<Kernel>> loadKernels(std::span<const std::byte> bytes, uint32_t graphChecksum,
                                                   std::pmr::memory_resource* memory) {
  const auto bad = [](size_t kernel, const char* what) {
    return makeError(GPGP_ERROR_INVALID_DATA, "kernel %zu of the baked grammar: %s", kernel, what);
  };
  if (bytes.size() % 4) return bad(0, "its size is not a number of words");
  std::pmr::vector<uint32_t> words(bytes.size() / 4, memory);
  if (!words.empty()) std::memcpy(words.data(), bytes.data(), bytes.size());
  std::pmr::vector<Kernel> kernels(memory);
  for (std::span<const uint32_t> rest = words; !rest.empty();) {
    const size_t number = kernels.size();
    if (rest.size() < kHeader || rest[0] != kKernelMagic) return bad(number, "the data that follows is not a kernel");
    if (rest[1] != kKernelVersion)
      return makeError(
          GPGP_ERROR_INVALID_DATA,
          "kernel %zu of the baked grammar: it was made in format %u; this library reads format %u: bake the "
          "grammar again",
          number, rest[1], kKernelVersion);
    if (rest[2] <= kHeader || rest[2] > rest.size()) return bad(number, "it was cut");
    const auto own = rest.first(rest[2]);
    if (own[3] != checksum(own.subspan(kChecked))) return bad(number, "its checksum is wrong");
    if (own[kChecked] != graphChecksum) return bad(number, "it was made for another graph");
    Kernel kernel{{}, std::pmr::vector<uint32_t>(own.begin() + kHeader, own.end(), memory)};
    std::memcpy(static_cast<void*>(&kernel.info), own.data() + kInfo, sizeof kernel.info);
    if (!isUsable(kernel.info)) return bad(number, "its schedule has numbers that cannot run");
    const size_t words4 = kernel.code[0];
    if (words4 % 4 || words4 + 2 > kernel.code.size()) return bad(number, "its table was cut");
    if (kernel.spirv()[0] != kSpirvMagic) return bad(number, "it holds no SPIR-V");
    kernels.push_back(std::move(kernel));
    rest = rest.subspan(own.size());
  }
  return kernels;
}

core::Result<Baked> loadBaked(std::span<const std::byte> bytes, std::pmr::memory_resource* memory) {
  const size_t graphBytes = sizeOfGraph(bytes);
  auto graph = load(bytes.first(graphBytes), memory);
  if (!graph) return graph.error();
  uint32_t graphChecksum = 0;
  std::memcpy(&graphChecksum, bytes.data() + 4 * shader::kHeaderChecksum, 4);
  auto kernels = loadKernels(bytes.subspan(graphBytes), graphChecksum, memory);
  if (!kernels) return kernels.error();
  return Baked{std::move(*graph), std::move(*kernels)};
}

} // namespace gpgp::spawn
