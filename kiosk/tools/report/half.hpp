// An emulated IEEE 754 binary16, so that the paint model can be run on a machine without 16-bit arithmetic and compared
// with wider ones. Values only: no state, any thread may call. Subnormals are kept (GPUs may flush them to zero).
//
// Arithmetic is done in binary32 and rounded once more to nearest even. For + - * / and sqrt this gives the correctly
// rounded binary16 result: a first rounding to q digits is harmless when q >= 2 p + 2 (Figueroa, "When is double
// rounding innocuous?", 1995); here p = 11 and q = 24 = 2 * 11 + 2. Other functions have no such guarantee.
#pragma once

#include <cmath>
#include <cstdint>

namespace lackwerk::report {

/// The bits of the binary16 nearest to `value`, ties to even; too large becomes infinity, NaN stays a quiet NaN.
[[nodiscard]] std::uint16_t half_bits(float value);
/// The value of a binary16; exact.
[[nodiscard]] float half_value(std::uint16_t bits);

class Half {
 public:
  Half() = default;
  explicit Half(float value) : bits_(half_bits(value)) {}
  [[nodiscard]] float value() const { return half_value(bits_); }
  [[nodiscard]] std::uint16_t bits() const { return bits_; }
  explicit operator float() const { return value(); }
  explicit operator double() const { return double{value()}; }
  explicit operator int() const { return static_cast<int>(value()); }
  explicit operator std::int64_t() const { return static_cast<std::int64_t>(value()); }

  friend Half operator+(Half a, Half b) { return Half(a.value() + b.value()); }
  friend Half operator-(Half a, Half b) { return Half(a.value() - b.value()); }
  friend Half operator*(Half a, Half b) { return Half(a.value() * b.value()); }
  friend Half operator/(Half a, Half b) { return Half(a.value() / b.value()); }
  friend Half operator-(Half a) { return Half(-a.value()); }
  Half& operator+=(Half b) { return *this = *this + b; }
  Half& operator*=(Half b) { return *this = *this * b; }
  friend bool operator<(Half a, Half b) { return a.value() < b.value(); }
  friend bool operator>(Half a, Half b) { return b < a; }
  friend bool operator<=(Half a, Half b) { return a.value() <= b.value(); }
  friend bool operator>=(Half a, Half b) { return b <= a; }

  friend Half sqrt(Half a) { return Half(std::sqrt(a.value())); }
  friend Half exp2(Half a) { return Half(std::exp2(a.value())); }
  friend Half log2(Half a) { return Half(std::log2(a.value())); }
  friend Half pow(Half a, Half b) { return Half(std::pow(a.value(), b.value())); }
  friend Half sin(Half a) { return Half(std::sin(a.value())); }
  friend Half cos(Half a) { return Half(std::cos(a.value())); }
  friend Half atan2(Half a, Half b) { return Half(std::atan2(a.value(), b.value())); }
  friend Half abs(Half a) { return Half(std::abs(a.value())); }
  friend Half floor(Half a) { return Half(std::floor(a.value())); }

 private:
  std::uint16_t bits_ = 0;
};

}  // namespace lackwerk::report
