// The random numbers of the reference integrator: 64 points at a time that spread evenly, and no state.
//
// Why it exists: a picture must be the same for any number of threads, so a number is a function of (seed, pixel,
// batch, sample, dimension) alone. The first 64 points of Sobol's first two dimensions hit every dyadic box of area
// 1/64 once; Owen's scrambling (1995) makes each point uniform and each batch independent of all others, so that
// the scatter of batch means is an honest error bar. Pairs of dimensions are scrambled and shuffled apart from each
// other (padding). Scrambling by hashing: Laine & Karras 2011; Burley 2020, "Practical hash-based Owen scrambling".
// Values; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>

namespace lackwerk::core {

inline constexpr int reference_batch_bits = 6;
inline constexpr int reference_batch = 1 << reference_batch_bits;  ///< samples of a pixel that are stratified together

/// A good hash of 64 bits (SplitMix64's finaliser: Steele, Lea & Flood 2014).
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

[[nodiscard]] constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00FF00FFu) << 8) | ((x & 0xFF00FF00u) >> 8);
  x = ((x & 0x0F0F0F0Fu) << 4) | ((x & 0xF0F0F0F0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xCCCCCCCCu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xAAAAAAAAu) >> 1);
}

/// A nested uniform (Owen) scramble of the bits of x, most significant first; constants: Vegdahl's, as in Burley 2020's
/// follow-ups.
[[nodiscard]] constexpr std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reverse_bits(x);
  x ^= x * 0x3D20ADEAu;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526C56u;
  x ^= x * 0x53A22864u;
  return reverse_bits(x);
}

/// The numbers of one sample, drawn pair after pair.
class ReferenceNumbers {
 public:
  /// `index` in [0, reference_batch).
  ReferenceNumbers(std::uint64_t seed, std::uint64_t pixel, std::uint64_t batch, std::uint32_t index)
      : key_(mix_bits(mix_bits(mix_bits(seed) ^ pixel) ^ batch)), index_(index) {}

  /// The next two numbers, each in (0, 1).
  [[nodiscard]] glm::dvec2 next() {
    const std::uint64_t a = mix_bits(key_ + ++pair_), b = mix_bits(a);
    // Shuffled by a scramble of its few bits, so that pairs do not go in step.
    constexpr int unused = 32 - reference_batch_bits;
    const std::uint32_t at = owen_scramble(index_ << unused, static_cast<std::uint32_t>(a)) >> unused;
    return {unit(owen_scramble(reverse_bits(at), static_cast<std::uint32_t>(b))),
            unit(owen_scramble(second_dimension[at], static_cast<std::uint32_t>(b >> 32)))};
  }

 private:
  [[nodiscard]] static constexpr double unit(std::uint32_t x) { return (static_cast<double>(x) + 0.5) * 0x1p-32; }

  /// Sobol's second dimension: direction numbers are the rows of Pascal's triangle modulo 2.
  static constexpr std::array<std::uint32_t, reference_batch> second_dimension = [] {
    std::array<std::uint32_t, reference_batch> out{};
    constexpr std::array<std::uint32_t, reference_batch_bits> direction = {0x80000000u, 0xC0000000u, 0xA0000000u,
                                                                           0xF0000000u, 0x88000000u, 0xCC000000u};
    for (std::uint32_t k = 0; k < out.size(); ++k)
      for (std::uint32_t bit = 0; bit < direction.size(); ++bit)
        if ((k >> bit) & 1u) out[k] ^= direction[bit];
    return out;
  }();

  std::uint64_t key_;
  std::uint64_t pair_ = 0;
  std::uint32_t index_;
};

}  // namespace lackwerk::core
