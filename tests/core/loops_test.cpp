// Turns of loops that a device gives a shader (shaders/core/turns.h): below the bound all are made, and where they are
// not, the shader knows.
#include "core/turns.h"
#include "host/kernel.h"
#include "shaders/loops.spv.h"
#ifdef GPGP_TEST_OPTIMIZED
#include "spawn/codegen/compile_kernel.h"
#endif

#include <gtest/gtest.h>

#include <vector>

namespace {
using namespace gpgp;

constexpr uint32_t kInvocations = 128; // two workgroups

struct Loops {
  uint32_t first, outer, inner, innerLanes, last;
};
struct Made {
  uint32_t first, outer, inner, last, ended, unused;
};

std::vector<Made> run(host::HeadlessDevice& device, std::span<const uint32_t> shader, const Loops& loops) {
  const auto input = host::makeBuffer(
      device, std::vector<uint32_t>{1, loops.first, loops.outer, loops.inner, loops.innerLanes, loops.last},
      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const host::Buffer output(device, kInvocations * sizeof(Made), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  host::ComputeKernel kernel(device, shader, 2);
  kernel.run({&input, &output}, nullptr, kInvocations / 64);
  return host::download<Made>(device, output, kInvocations);
}

/// How many turns the device counts: one more for each time that a loop is run.
uint64_t countOf(const Loops& loops) {
  const uint64_t inner = uint64_t(loops.outer) * ((loops.innerLanes ? loops.inner : 0) + 1) + 1;
  return uint64_t(loops.first) + 1 + loops.outer + 1 + inner + loops.last + 1 + 3;
}

void expectWholeOrKnown(std::span<const uint32_t> shader) {
  host::HeadlessDevice device(host::DeviceOptions{.validation = true});
  const Loops cases[] = {
      {10, 10, 10, 64, 10},   {65000, 0, 0, 0, 100},  {65534, 0, 0, 0, 10},    {65535, 0, 0, 0, 10},
      {65536, 0, 0, 0, 10},   {70000, 0, 0, 0, 10},   {30000, 17000, 0, 0, 1}, {30000, 30000, 0, 0, 10},
      {10, 21000, 1, 64, 10}, {10, 22000, 1, 64, 10}, {10, 30000, 2, 1, 10},   {10, 30000, 1, 0, 10},
      {10, 40000, 1, 0, 10},  {100, 300, 300, 1, 10}, {100, 200, 300, 8, 10},  {0, 1, 70000, 3, 0},
      {1000000, 0, 0, 0, 1},  {0, 0, 0, 0, 1000000},
  };
  for (const Loops& loops : cases) {
    SCOPED_TRACE(testing::Message() << loops.first << ' ' << loops.outer << ' ' << loops.inner << " for "
                                    << loops.innerLanes << ' ' << loops.last);
    const std::vector<Made> made = run(device, shader, loops);
    uint32_t cut = 0;
    for (uint32_t i = 0; i < kInvocations; ++i) {
      const uint32_t inner = i % 64 < loops.innerLanes ? loops.outer * loops.inner : 0;
      const Made& m = made[i];
      const bool whole = m.first == loops.first && m.outer == loops.outer && m.inner == inner && m.last == loops.last;
      ASSERT_TRUE(whole || m.ended) << "invocation " << i << " made fewer turns and does not know";
      cut += m.ended;
      if (!device.isSoftware()) {
        ASSERT_TRUE(whole) << "invocation " << i;
        ASSERT_FALSE(m.ended) << "invocation " << i;
      }
    }
    if (countOf(loops) <= shader::kDeviceTurns) {
      EXPECT_EQ(cut, 0u);
    }
  }
  for (const std::string& message : device.validationMessages()) ADD_FAILURE() << message;
}

TEST(Loops, AreWholeBelowTheBoundAndElseKnownToHaveEnded) { expectWholeOrKnown(loops); }

#ifdef GPGP_TEST_OPTIMIZED
TEST(Loops, AreSoInShadersThatTheKernelCompilerOptimised) {
  for (const auto target : {spawn::KernelTarget::software, spawn::KernelTarget::any}) {
    const std::vector<uint32_t> optimized = spawn::optimize(loops, target);
    ASSERT_FALSE(optimized.empty());
    expectWholeOrKnown(optimized);
  }
}
#endif

} // namespace
