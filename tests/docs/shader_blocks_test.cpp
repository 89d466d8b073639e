// What the largest shaders ask of a driver's compiler. Compilers inline all functions, and some take the square of a
// shader's blocks or more: SwiftShader was not ready after minutes with the interpreter of grammars at 10 720 blocks,
// and takes seconds at half of that.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <numeric>
#include <vector>

namespace gpgp {
namespace {
constexpr uint32_t kMostBlocks = 6500; // of the library's shaders
constexpr uint32_t kOpEntryPoint = 15, kOpFunction = 54, kOpFunctionCall = 57, kOpLabel = 248;

/// Blocks of a module's entry point once each call is replaced by what it calls.
uint32_t inlinedBlocks(const std::vector<uint32_t>& words) {
  struct Function {
    uint32_t blocks = 0, whole = 0; // whole: with what it calls; 0: not yet known
    std::vector<uint32_t> calls;
  };
  std::map<uint32_t, Function> functions;
  uint32_t entry = 0;
  Function* current = nullptr;
  for (size_t at = 5; at < words.size(); at += std::max(words[at] >> 16, 1u)) {
    const uint32_t op = words[at] & 0xffff;
    if (op == kOpEntryPoint && !entry) entry = words[at + 2];
    if (op == kOpFunction) current = &functions[words[at + 2]];
    if (op == kOpLabel) ++current->blocks;
    if (op == kOpFunctionCall) current->calls.push_back(words[at + 3]);
  }
  const auto whole = [&](const auto& self, uint32_t id) -> uint32_t {
    Function& f = functions.at(id);
    if (!f.whole)
      f.whole = std::accumulate(f.calls.begin(), f.calls.end(), f.blocks,
                                [&](uint32_t sum, uint32_t callee) { return sum + self(self, callee); });
    return f.whole;
  };
  return whole(whole, entry);
}

TEST(ShaderBlocks, AreFewEnoughForAnyCompiler) {
  std::ifstream list(GPGP_SHADER_FILES);
  uint32_t checked = 0, most = 0;
  std::string largest;
  for (std::string name, file; list >> name >> file;) {
    if (file.starts_with('/')) continue; // a test's own
    std::ifstream code(std::string(GPGP_SHADER_FOLDER "/") + name + ".spv", std::ios::binary);
    std::vector<uint32_t> words;
    for (uint32_t word; code.read(reinterpret_cast<char*>(&word), sizeof word);) words.push_back(word);
    ASSERT_GT(words.size(), 5u) << name;
    const uint32_t blocks = inlinedBlocks(words);
    EXPECT_LE(blocks, kMostBlocks) << name << " (" << file << ")";
    ++checked;
    if (blocks > most) most = blocks, largest = name;
  }
  EXPECT_GT(checked, 100u);
  std::printf("%s has %u blocks, the most of %u shaders\n", largest.c_str(), most, checked);
}
} // namespace
} // namespace gpgp
