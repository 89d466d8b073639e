// Sample programs in the stack language on the device against the CPU evaluator: counts, buckets and keys bit for bit,
// transforms by tolerance.
#include "grammars.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn_device.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace {
using namespace gpgp;
using namespace gpgp::test;

TEST(StackLanguageOnGpu, SamplesEqualTheEvaluator) {
  SpawnDevice device;
  for (const auto& entry : std::filesystem::directory_iterator(GPGP_SAMPLE_PROGRAMS)) {
    const GrammarFile file =
        bakedFile({entry.path().string(), textOf(entry.path().string())}, GPGP_COMPILE_STACK_LANGUAGE);
    std::vector<uint32_t> words(file.text.size() / 4);
    std::memcpy(words.data(), file.text.data(), file.text.size());
    std::vector<GpgpAxiom> axioms;
    const bool isSponge = entry.path().stem() == "sponge";
    for (uint32_t i = 0; i < 3; ++i)
      axioms.push_back(isSponge ? spawn::makeAxiom(3, 3, 3, i, i)
                                : spawn::makeAxiom(20 + 7.3f * static_cast<float>(i), 12, 24, i, i));
    const auto expected = spawn::derive(words, axioms);
    ASSERT_GT(expected.terminals, 0u) << entry.path();
    std::vector<GpgpInstance> written;
    const auto report = device.derive(words, axioms, static_cast<uint32_t>(expected.terminals), &written);
    EXPECT_EQ(report.terminals, expected.terminals) << entry.path();
    EXPECT_EQ(report.keyHash[0], expected.keyHash[0]) << entry.path();
    EXPECT_EQ(report.keyHash[1], expected.keyHash[1]) << entry.path();
    ASSERT_EQ(written.size(), expected.instances.size()) << entry.path();
    auto sorted = expected.instances;
    const auto before = [](const GpgpInstance& a, const GpgpInstance& b) {
      return std::tie(a.axiomId, a.key[0], a.key[1]) < std::tie(b.axiomId, b.key[0], b.key[1]);
    };
    std::sort(sorted.begin(), sorted.end(), before);
    std::sort(written.begin(), written.end(), before);
    for (size_t i = 0; i < sorted.size(); ++i) {
      ASSERT_EQ(written[i].key[0], sorted[i].key[0]) << entry.path();
      ASSERT_EQ(written[i].terminal, sorted[i].terminal) << entry.path();
      for (int t = 0; t < 12; ++t) ASSERT_NEAR(written[i].transform[t], sorted[i].transform[t], 1e-3) << entry.path();
    }
  }
}
} // namespace
