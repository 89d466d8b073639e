// The machine of CGA programs on a device and on the CPU: values of expressions, bit for bit.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wrestrict" // gcc 12 sees overlaps in sums of strings where there are none
#endif
#include "host/device.h"
#include "host/kernel.h"
#include "host/memory.h"
#include "shaders/cga_on_gpu.spv.h"
#include "spawn/cga/compile.h"
#include "spawn/cga/functions.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

namespace gpgp::spawn::cga {
namespace {

using namespace shader;

/// As tests/spawn/cga_on_gpu.comp.
struct Host {
  const std::vector<uint32_t>& words;
  std::array<CgaValue, 96> stack{};
  std::array<uint32_t, 32> calls{};
  uvec2 key{0, 0};
  uint32_t draws = 0;

  uint32_t cgaWord(uint32_t at) const { return words[at]; }
  CgaValue cgaStack(uint32_t at) const { return stack[at]; }
  void cgaSetStack(uint32_t at, CgaValue v) { stack[at] = v; }
  static uint32_t cgaStackSize() { return 96; }
  uint32_t cgaFrame(uint32_t at) const { return calls[at]; }
  void cgaSetFrame(uint32_t at, uint32_t v) { calls[at] = v; }
  static uint32_t cgaMostFrames() { return 16; }
  static uint32_t cgaMostTurns() { return 4096; }
  static CgaValue cgaAttribute(uint32_t) { return cgaFloatValue(0); }
  void cgaSetAttribute(uint32_t, CgaValue) {}
  float cgaRandom() { return drawnNumber(key, draws++); }
  static CgaValue cgaAddOther(CgaValue, CgaValue) { return cgaFloatValue(0); }
  static CgaValue cgaCompareOther(uint32_t, CgaValue a, CgaValue b) { return cgaBoolValue(a.bits == b.bits); }
  static CgaValue cgaEach(uint32_t, CgaValue, CgaValue) { return cgaFloatValue(0); }
  static CgaValue cgaFunction(uint32_t, uint32_t, uint32_t) { return cgaFloatValue(0); }
  static CgaValue cgaArray(uint32_t, uint32_t) { return cgaFloatValue(0); }
  static CgaValue cgaIndex(uint32_t, uint32_t) { return cgaFloatValue(0); }
  static CgaValue cgaRange(CgaValue, CgaValue) { return cgaFloatValue(0); }
  static bool cgaOperation(uint32_t, uint32_t, uint32_t) { return false; }
  static bool cgaBlock(uint32_t, uint32_t, uint32_t, uint32_t, uint32_t) { return false; }
  static bool cgaInvoke(uint32_t, uint32_t, uint32_t) { return false; }
  static bool cgaGoOn(uint32_t) { return false; }
  static bool cgaLeaf(uint32_t) { return false; }
  static void cgaNil() {}
  static bool cgaPushShape() { return false; }
  static bool cgaPopShape() { return false; }
  static bool cgaEnd() { return true; }
  static void cgaAt(uint32_t) {}
#include "spawn/cga/machine.h"
};

std::string randomExpression(std::mt19937& random, int depth) {
  const auto inner = [&] { return randomExpression(random, depth - 1); };
  if (depth == 0) return std::to_string(static_cast<float>(random() % 2000) / 100.0f - 8.0f);
  switch (random() % 12) {
  case 0: return "(" + inner() + " + " + inner() + ")";
  case 1: return "(" + inner() + " - " + inner() + ")";
  case 2: return "(" + inner() + " * " + inner() + ")";
  case 3: return "(" + inner() + " / " + inner() + ")";
  case 4: return "(" + inner() + " % " + inner() + ")";
  case 5:
    return "(case " + inner() + " < " + inner() + " || " + inner() + " > 3: " + inner() + " else: " + inner() + ")";
  case 6: return "(30%: " + inner() + " else: " + inner() + ")";
  case 7: return "rand(" + inner() + ", " + inner() + ")";
  case 8: return "f(" + inner() + ", " + inner() + ")";
  case 9: return "atan2(" + inner() + ", " + inner() + ")";
  default: {
    constexpr const char* kNames[] = {"abs", "sin", "cos",   "tan",  "asin",  "acos", "atan",
                                      "exp", "ln",  "log10", "sqrt", "floor", "ceil", "rint"};
    return std::string(kNames[random() % std::size(kNames)]) + "(" + inner() + ")";
  }
  }
}

TEST(CgaMachine, DeviceAndCpuAgreeBitForBit) {
  std::mt19937 random(3);
  std::string text =
      "f(a, b) with (c := a * 0.5) = case c > b: pow(abs(c), 1.3) else: max(a, min(b, 4))\nLot --> NIL\n";
  constexpr uint32_t kCount = 600;
  for (uint32_t i = 0; i < kCount; ++i)
    text += "attr a" + std::to_string(i) + " = " + randomExpression(random, 4) + "\n";
  CompileOptions options;
  options.path = "random.cga";
  options.read = [](const std::string&, std::string&) { return false; };
  Messages messages;
  const auto program = compile(text, options, messages);
  ASSERT_TRUE(program) << (messages.sorted().empty() ? std::string() : messages.sorted()[0].diagnostic.text);
  std::vector<uint32_t> chunks;
  for (const AttributeInfo& a : program->attributes) chunks.push_back(a.chunk);
  ASSERT_EQ(chunks.size(), kCount);

  host::HeadlessDevice device{host::DeviceOptions{.validation = true}};
  const auto words = host::makeBuffer(device, program->words, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const auto starts = host::makeBuffer(device, chunks, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const host::Buffer output(device, kCount * 8, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  host::ComputeKernel kernel(device, cga_on_gpu, 3, sizeof kCount);
  kernel.run({&words, &starts, &output}, &kCount, (kCount + 63) / 64);
  const auto results = host::download<uint32_t>(device, output, 2 * kCount);
  uint32_t different = 0; // values, so that the test is seen to compute something
  for (uint32_t i = 0; i < kCount; ++i) {
    Host host{program->words};
    host.key = uvec2(i, 7 * i);
    const uint32_t how = host.cgaRun(chunks[i], 0);
    ASSERT_EQ(how, kCgaDone) << i;
    ASSERT_EQ(results[2 * i], how) << i;
    ASSERT_EQ(results[2 * i + 1], host.stack[0].bits) << "attr a" << i << ": " << uintBitsToFloat(results[2 * i + 1])
                                                      << ", not " << uintBitsToFloat(host.stack[0].bits);
    different += i && results[2 * i + 1] != results[2 * i - 1];
  }
  EXPECT_GT(different, 500u);
  for (const std::string& message : device.validationMessages()) ADD_FAILURE() << message;
}

} // namespace
} // namespace gpgp::spawn::cga
