// What all shaders have to keep to, by their code. What the largest ones ask of a driver's compiler: Compilers inline
// all functions, and some take the square of a shader's blocks or more: SwiftShader was not ready after minutes with
// the interpreter of grammars at 10 720 blocks, and takes seconds at half of that.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <numeric>
#include <set>
#include <vector>

namespace gpgp {
namespace {
constexpr uint32_t kMostBlocks = 6500; // of the library's shaders
constexpr uint32_t kOpEntryPoint = 15, kOpTypeArray = 28, kOpTypeStruct = 30, kOpTypePointer = 32, kOpFunction = 54,
                   kOpFunctionCall = 57, kOpVariable = 59, kOpDecorate = 71, kOpMemberDecorate = 72, kOpLabel = 248;
constexpr uint32_t kWorkgroup = 4, kArrayStride = 6, kMatrixStride = 7, kOffset = 35;

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

/// Names of variables in shared memory whose types have offsets or strides. Newer validation layers refuse them.
uint32_t sharedWithLayout(const std::vector<uint32_t>& words) {
  std::set<uint32_t> laidOut;
  std::map<uint32_t, std::vector<uint32_t>> parts; // of arrays and structs
  std::map<uint32_t, uint32_t> pointers;           // to shared memory: what to
  std::vector<uint32_t> variables;                 // their pointer types
  for (size_t at = 5; at < words.size(); at += std::max(words[at] >> 16, 1u)) {
    const uint32_t op = words[at] & 0xffff;
    const uint32_t* const operands = &words[at + 1];
    if (op == kOpDecorate && operands[1] == kArrayStride) laidOut.insert(operands[0]);
    if (op == kOpMemberDecorate && (operands[2] == kOffset || operands[2] == kMatrixStride))
      laidOut.insert(operands[0]);
    if (op == kOpTypeArray) parts[operands[0]] = {operands[1]};
    if (op == kOpTypeStruct) parts[operands[0]].assign(operands + 1, &words[at] + (words[at] >> 16));
    if (op == kOpTypePointer && operands[1] == kWorkgroup) pointers[operands[0]] = operands[2];
    if (op == kOpVariable && operands[2] == kWorkgroup) variables.push_back(operands[0]);
  }
  const auto isLaidOut = [&](const auto& self, uint32_t type) -> bool {
    const auto found = parts.find(type);
    return laidOut.contains(type) ||
           (found != parts.end() &&
            std::any_of(found->second.begin(), found->second.end(), [&](uint32_t part) { return self(self, part); }));
  };
  return static_cast<uint32_t>(std::count_if(variables.begin(), variables.end(), [&](uint32_t pointer) {
    return isLaidOut(isLaidOut, pointers.at(pointer));
  }));
}

template <class Check> void forEachShader(const Check& check) {
  std::ifstream list(GPGP_SHADER_FILES);
  uint32_t checked = 0;
  for (std::string name, file; list >> name >> file;) {
    if (file.starts_with('/')) continue; // a test's own
    std::ifstream code(std::string(GPGP_SHADER_FOLDER "/") + name + ".spv", std::ios::binary);
    std::vector<uint32_t> words;
    for (uint32_t word; code.read(reinterpret_cast<char*>(&word), sizeof word);) words.push_back(word);
    ASSERT_GT(words.size(), 5u) << name;
    check(name, file, words);
    ++checked;
  }
  EXPECT_GT(checked, 100u);
}

TEST(ShaderBlocks, AreFewEnoughForAnyCompiler) {
  uint32_t most = 0;
  std::string largest;
  forEachShader([&](const std::string& name, const std::string& file, const std::vector<uint32_t>& words) {
    const uint32_t blocks = inlinedBlocks(words);
    EXPECT_LE(blocks, kMostBlocks) << name << " (" << file << ")";
    if (blocks > most) most = blocks, largest = name;
  });
  std::printf("%s has %u blocks, the most of all shaders\n", largest.c_str(), most);
}

TEST(SharedMemory, HasNoLayout) {
  forEachShader([](const std::string& name, const std::string& file, const std::vector<uint32_t>& words) {
    EXPECT_EQ(sharedWithLayout(words), 0u) << name << " (" << file << ")";
  });
}
} // namespace
} // namespace gpgp
