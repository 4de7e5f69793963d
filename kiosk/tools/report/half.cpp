#include "kiosk/tools/report/half.hpp"

#include <bit>

namespace lackwerk::report {

std::uint16_t half_bits(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = (bits >> 16U) & 0x8000U;
  const std::uint32_t magnitude = bits & 0x7fffffffU;
  std::uint32_t result = 0;
  if (magnitude > 0x7f800000U) {
    result = 0x7e00U | ((magnitude >> 13U) & 0x3ffU);  // the payload's upper digits stay, as F16C keeps them
  } else if (magnitude >= 0x477ff000U) {
    result = 0x7c00U;  // 65520 and above: half way to 2^16 rounds up, to infinity
  } else if (magnitude >= 0x38800000U) {
    // 2^-14 and above: normal. The exponent's bias falls by 112; 13 digits go, ties to even.
    const std::uint32_t shifted = magnitude - (112U << 23U);
    result = (shifted + 0xfffU + ((shifted >> 13U) & 1U)) >> 13U;
  } else {
    // Subnormal: in units of 2^-24; the default rounding of nearbyint is to nearest even, and 2^24 scales exactly.
    result = static_cast<std::uint32_t>(std::nearbyint(std::bit_cast<float>(magnitude) * 16777216.0F));
  }
  return static_cast<std::uint16_t>(sign | result);
}

float half_value(std::uint16_t bits) {
  const std::uint32_t sign = (bits & 0x8000U) << 16U;
  const std::uint32_t exponent = (bits >> 10U) & 0x1fU;
  const std::uint32_t digits = bits & 0x3ffU;
  if (exponent == 0) {
    const auto magnitude = std::bit_cast<std::uint32_t>(static_cast<float>(digits) / 16777216.0F);
    return std::bit_cast<float>(sign | magnitude);
  }
  if (exponent == 31) {
    const std::uint32_t quiet = digits != 0 ? 0x400000U : 0U;  // hardware quiets a signalling NaN
    return std::bit_cast<float>(sign | 0x7f800000U | quiet | (digits << 13U));
  }
  return std::bit_cast<float>(sign | ((exponent + 112U) << 23U) | (digits << 13U));
}

}  // namespace lackwerk::report
