// 64-bit integers in two words, saturation, and which floats are told apart, against the processor's own.
#include "core/math.h"
#include "visibility/shared/integers.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace gpgp::shader {
namespace {

std::int64_t value(Wide w) { return (std::int64_t(w.high) << 32) | w.low; }
Wide wide(std::int64_t v) { return {static_cast<int>(v >> 32), static_cast<uint>(v)}; }

TEST(Exact, ProductsSumsAndSignsMatch64BitIntegers) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const int a = static_cast<int>(random()) >> (random() % 31), b = static_cast<int>(random()) >> (random() % 31);
    ASSERT_EQ(value(wideProduct(a, b)), std::int64_t(a) * b);
    const std::int64_t x = static_cast<std::int64_t>(random()) >> (2 + random() % 60);
    const std::int64_t y = static_cast<std::int64_t>(random()) >> (2 + random() % 60);
    ASSERT_EQ(value(wideSum(wide(x), wide(y))), x + y);
    ASSERT_EQ(wideSign(wide(x)), x < 0 ? -1 : x > 0);
    for (int shift = 0; shift <= 8; ++shift)
      ASSERT_EQ(wideShifted(wide(x), shift), std::clamp<std::int64_t>(x >> shift, -kSaturated, kSaturated)) << x;
  }
  EXPECT_EQ(wideSign(wide(0)), 0);
  EXPECT_EQ(wideShifted(wide(-1), 8), -1);
  EXPECT_EQ(wideShifted(wide(255), 8), 0);
}

TEST(Exact, FloatsOfWideNumbersAreTheNearest) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 100000; ++i) {
    const std::int64_t x = static_cast<std::int64_t>(random() << 15) >> (16 + random() % 47);
    ASSERT_EQ(wideToFloat(wide(x)), static_cast<float>(x)) << x;
  }
}

TEST(Exact, ToldApartByBits) {
  EXPECT_TRUE(isModerate(0.0f));
  EXPECT_TRUE(isModerate(-1e30f));
  EXPECT_FALSE(isModerate(1.3e30f));
  EXPECT_FALSE(isModerate(uintBitsToFloat(0x7f800000u)));
  EXPECT_FALSE(isModerate(uintBitsToFloat(0xff800000u)));
  EXPECT_FALSE(isModerate(uintBitsToFloat(0x7fc00000u)));
  EXPECT_FALSE(isDivisor(0.0f));
  EXPECT_FALSE(isDivisor(-1.0f));
  EXPECT_FALSE(isDivisor(uintBitsToFloat(0x7fc00000u)));
}

TEST(Exact, ReciprocalsAreCorrectlyRounded) {
  for (uint digits = 0; digits < 0x800000u; digits += digits < 4096 || digits > 0x7ff000u ? 1 : 13) {
    const float v = uintBitsToFloat((127u << 23) | digits);
    ASSERT_EQ(floatBitsToUint(reciprocal(v)), floatBitsToUint(static_cast<float>(1.0 / v))) << digits;
  }
  for (uint exponent = 27; exponent < 227; ++exponent)
    for (const uint digits : {0u, 1u, 0x123456u, 0x7fffffu}) {
      const float v = uintBitsToFloat((exponent << 23) | digits);
      ASSERT_TRUE(isDivisor(v));
      ASSERT_EQ(floatBitsToUint(reciprocal(v)), floatBitsToUint(divide(1.0f, v))) << v;
    }
}

TEST(Exact, TinyNumbersBecomeZero) {
  EXPECT_EQ(floatBitsToUint(withoutTiny(1e-40f)), 0u);
  EXPECT_EQ(floatBitsToUint(withoutTiny(-1e-31f)), 0u);
  EXPECT_EQ(withoutTiny(1e-30f), 1e-30f);
  EXPECT_EQ(withoutTiny(-1e-30f), -1e-30f);
}

} // namespace
} // namespace gpgp::shader
