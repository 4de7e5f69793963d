// What fuzz targets share: a claim that must hold, and taking an input apart.
//
// Why it exists: assert() is compiled out of release builds, and a finding must stop the target. Values; one thread.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <span>

namespace lackwerk::fuzz {

/// A claim about whatever input; libFuzzer reports the abort with the input.
inline void require(bool holds) {
  if (!holds) std::abort();
}

/// Takes numbers off the front of an input; zeros after its end.
class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : rest_(bytes) {}
  [[nodiscard]] bool empty() const { return rest_.empty(); }
  [[nodiscard]] std::span<const std::uint8_t> rest() const { return rest_; }
  std::uint8_t byte() {
    if (rest_.empty()) return 0;
    const std::uint8_t value = rest_.front();
    rest_ = rest_.subspan(1);
    return value;
  }
  /// Three bytes, little-endian: the places of a file of up to 16 MiB.
  std::uint32_t place() {
    std::uint32_t value = byte();
    value |= std::uint32_t{byte()} << 8u;
    return value | (std::uint32_t{byte()} << 16u);
  }

 private:
  std::span<const std::uint8_t> rest_;
};

}  // namespace lackwerk::fuzz
