#include "kiosk/tools/report/half.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

namespace lackwerk::report {
namespace {

TEST(Half, RoundsTiesToEvenAndKeepsSubnormals) {
  EXPECT_EQ(half_bits(1.0F), 0x3c00);
  EXPECT_EQ(half_bits(2049.0F), half_bits(2048.0F));
  EXPECT_EQ(half_bits(2051.0F), half_bits(2052.0F));
  EXPECT_EQ(half_bits(65519.0F), 0x7bff);
  EXPECT_EQ(half_bits(65520.0F), 0x7c00);
  EXPECT_EQ(half_bits(0x1p-24F), 1);
  EXPECT_EQ(half_bits(-0x1p-25F), 0x8000);
}

TEST(Half, EveryValueComesBack) {
  for (std::uint32_t bits = 0; bits < 65536; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    const bool is_nan = (bits & 0x7c00U) == 0x7c00U && (bits & 0x3ffU) != 0;
    if (!is_nan) {
      ASSERT_EQ(half_bits(half_value(half)), half);
    } else {
      ASSERT_TRUE(std::isnan(half_value(half)));
    }
  }
}

#if defined(__x86_64__)
__attribute__((target("f16c"))) std::uint16_t hardware_bits(float value) {
  const __m128i halves = _mm_cvtps_ph(_mm_set_ss(value), _MM_FROUND_TO_NEAREST_INT);
  return static_cast<std::uint16_t>(_mm_extract_epi16(halves, 0));
}

__attribute__((target("f16c"))) std::uint32_t hardware_value(std::uint16_t bits) {
  return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_castps_si128(_mm_cvtph_ps(_mm_cvtsi32_si128(bits)))));
}

/// By CPUID itself: clang 14 does not know the name for __builtin_cpu_supports. (Every CPU that has it has the
/// registers it needs, and no kernel of today leaves them switched off.)
bool has_f16c() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  constexpr unsigned f16c_bit = 1U << 29U;
  return __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & f16c_bit) != 0;
}

TEST(Half, ConvertsAsF16cDoesBitForBit) {
  if (!has_f16c()) {
    GTEST_SKIP() << "this CPU has no F16C";
  }
  for (std::uint32_t bits = 0; bits < 65536; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    ASSERT_EQ(std::bit_cast<std::uint32_t>(half_value(half)), hardware_value(half)) << bits;
  }
  std::mt19937 random(1);
  for (int i = 0; i < 500000; ++i) {
    // Every second one within binary16's exponents (2^-27 to 2^17), where rounding happens.
    std::uint32_t bits = random();
    if (i % 2 == 0) {
      bits = (bits & 0x807fffffU) | ((100U + random() % 45U) << 23U);
    }
    const auto value = std::bit_cast<float>(bits);
    ASSERT_EQ(half_bits(value), hardware_bits(value)) << bits;
  }
}
#endif

}  // namespace
}  // namespace lackwerk::report
