// core/math.h and core/random.h: against the processor's own arithmetic, and bit for bit against the GPU.
#include "core/math.h"
#include "core/random.h"
#include "host/kernel.h"
#include "shaders/math_on_gpu.spv.h"
#include "shaders/spawn_derive_checked.spv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>
#include <span>

namespace {
using namespace gpgp;
using namespace gpgp::shader;

/// Bit patterns of all kinds, many of them special.
std::vector<uvec2> inputs() {
  std::mt19937 random(7);
  std::vector<uvec2> result;
  const uint32_t special[] = {0u,          0x80000000u, 1u,          0x7fffffu,   0x800000u,   0x3f800000u,
                              0xbf800000u, 0x7f800000u, 0xff800000u, 0x7fc00000u, 0xffffffffu, 0x7f7fffffu,
                              0x0d800000u, 0x71800000u, 0x40400000u, 0x41d80000u, 0x42b40000u, 0x43340000u};
  for (const uint32_t a : special)
    for (const uint32_t b : special) result.push_back({a, b});
  for (int i = 0; i < 200000; ++i) result.push_back({uint32_t(random()), uint32_t(random())});
  std::uniform_real_distribution<float> usual(-1000, 1000);
  for (int i = 0; i < 200000; ++i) result.push_back({floatBitsToUint(usual(random)), floatBitsToUint(usual(random))});
  for (int i = 1; i <= 300; ++i)
    for (int j = 1; j <= 300; ++j) result.push_back({floatBitsToUint(float(i)), floatBitsToUint(float(j))});
  return result;
}

TEST(Math, DivisionAndSquareRootAreCorrectlyRounded) {
  for (const uvec2& in : inputs()) {
    const float a = settle(uintBitsToFloat(in.x)), b = settle(uintBitsToFloat(in.y));
    if (b != 0) {
      ASSERT_EQ(floatBitsToUint(divide(a, b)), floatBitsToUint(settle(a / b))) << a << " / " << b;
    }
    if (a > 0) {
      ASSERT_EQ(floatBitsToUint(squareRoot(a)), floatBitsToUint(settle(std::sqrt(a)))) << a;
    }
  }
  EXPECT_EQ(divide(0, 0), 0);
  EXPECT_EQ(divide(-1, 0), -std::pow(2.0f, 100.0f));
  EXPECT_EQ(squareRoot(-4), 0);
}

TEST(Math, SettlesEverything) {
  for (const uvec2& in : inputs()) {
    const float a = settle(uintBitsToFloat(in.x));
    ASSERT_TRUE(a == 0 || (std::fabs(a) >= std::pow(2.0f, -100.0f) && std::fabs(a) <= std::pow(2.0f, 100.0f)));
    ASSERT_FALSE(a == 0 && std::signbit(a));
  }
}

TEST(Math, SinesAreAccurate) {
  for (int step = -2700; step <= 2700; ++step) {
    const double degrees = step * 0.37;
    const vec2 d = sineCosineDegrees(float(degrees));
    const double x = double(float(degrees)) * M_PI / 180;
    ASSERT_NEAR(d.x, std::sin(x), 2e-7) << degrees;
    ASSERT_NEAR(d.y, std::cos(x), 2e-7) << degrees;
    const vec2 r = sineCosine(float(degrees));
    ASSERT_NEAR(r.x, std::sin(double(float(degrees))), 2e-7) << degrees;
    ASSERT_NEAR(r.y, std::cos(double(float(degrees))), 2e-7) << degrees;
  }
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const vec2 d = sineCosineDegrees(90.0f * float(quarter));
    EXPECT_EQ(d.x, std::round(std::sin(quarter * M_PI / 2)));
    EXPECT_EQ(d.y, std::round(std::cos(quarter * M_PI / 2)));
  }
}

TEST(Random, SeedsAndKeysSpread) {
  // each output bit flips for about half of the changed inputs
  int flips[32] = {};
  for (uint32_t i = 0; i < 20000; ++i) {
    const uint32_t changed = childSeed(i, 3) ^ childSeed(i ^ (1u << (i % 32)), 3);
    for (int b = 0; b < 32; ++b) flips[b] += changed >> b & 1;
  }
  for (const int f : flips) EXPECT_NEAR(f, 10000, 500);
  EXPECT_LT(unitFloat(0xffffffffu), 1.0f);
  EXPECT_EQ(unitFloat(0), 0.0f);
}

/// Sums of products that a driver may contract: they would round differently on the GPU.
size_t contractible(std::span<const uint32_t> spirv) {
  enum { kFAdd = 129, kFSub = 131, kFMul = 133, kVectorTimesScalar = 142, kDot = 148, kDecorate = 71 };
  constexpr uint32_t kNoContraction = 42;
  std::set<uint32_t> precise, products;
  size_t found = 0;
  const auto each = [&](auto&& visit) {
    for (size_t at = 5; at < spirv.size(); at += spirv[at] >> 16) visit(spirv[at] & 0xffff, &spirv[at]);
  };
  each([&](uint32_t op, const uint32_t* w) {
    if (op == kDecorate && w[2] == kNoContraction) precise.insert(w[1]);
    if (op == kFMul || op == kVectorTimesScalar) products.insert(w[2]);
  });
  each([&](uint32_t op, const uint32_t* w) {
    if (op == kDot && !precise.count(w[2])) ++found;
    if ((op == kFAdd || op == kFSub) && !precise.count(w[2])) found += products.count(w[3]) + products.count(w[4]);
  });
  EXPECT_FALSE(products.empty());
  return found;
}

TEST(Math, NothingThatDecidesCanBeContracted) {
  EXPECT_EQ(contractible(spawn_derive_checked), 0u);
  EXPECT_EQ(contractible(math_on_gpu), 0u);
}

TEST(Math, GpuAndCpuAgreeBitForBit) {
  host::HeadlessDevice device{host::DeviceOptions{.validation = true}};
  const auto in = inputs();
  const auto input = host::makeBuffer(device, in, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const host::Buffer output(device, in.size() * 48, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  host::ComputeKernel kernel(device, math_on_gpu, 2);
  kernel.run({&input, &output}, nullptr, uint32_t((in.size() + 63) / 64));
  const auto results = host::download<uint32_t>(device, output, in.size() * 12);
  for (size_t i = 0; i < in.size(); ++i) {
    const float a = uintBitsToFloat(in[i].x), b = uintBitsToFloat(in[i].y);
    const vec2 degrees = sineCosineDegrees(a), radians = sineCosine(b);
    const uvec2 key = childKey(in[i], in[i].x ^ 5u);
    const uint32_t expected[12] = {floatBitsToUint(settle(a)),
                                   floatBitsToUint(divide(a, b)),
                                   floatBitsToUint(squareRoot(a)),
                                   floatBitsToUint(degrees.x),
                                   floatBitsToUint(degrees.y),
                                   floatBitsToUint(radians.x),
                                   floatBitsToUint(radians.y),
                                   floatBitsToUint(multiply(settle(a), settle(b))),
                                   floatBitsToUint(subtract(settle(a), settle(b))),
                                   floatBitsToUint(dot3(settle3(vec3(a, b, a)), settle3(vec3(b, b, a)))),
                                   key.x ^ childSeed(in[i].x, in[i].y),
                                   key.y ^ floatBitsToUint(unitFloat(in[i].x))};
    for (int r = 0; r < 12; ++r)
      ASSERT_EQ(results[i * 12 + r], expected[r]) << "result " << r << " of " << std::hex << in[i].x << ", " << in[i].y;
  }
  for (const std::string& message : device.validationMessages()) ADD_FAILURE() << message;
}

} // namespace
