// Four numbers at a time, in the vector types that g++ and clang have on every architecture.
//
// Why it exists: realise() does the same to L, a and b of a hundred thousand boxes per drag. The compilers' own types
// need no library and no kind of processor, and compute lane by lane what scalars would: the same bytes everywhere.
// Values of 32 bytes stay inside functions: how they are handed over depends on the processor.
#pragma once

#include <cstdint>

namespace lackwerk::core {

using Four = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));
using FourWords = std::uint32_t __attribute__((vector_size(16)));
using FourDoubles = double __attribute__((vector_size(32)));

[[nodiscard]] inline Four all(float value) { return Four{value, value, value, value}; }
[[nodiscard]] inline Four least(Four one, Four two) { return one < two ? one : two; }
[[nodiscard]] inline Four most(Four one, Four two) { return one > two ? one : two; }
/// Words below 2^31.
[[nodiscard]] inline Four to_floats(FourWords words) {
  return __builtin_convertvector(__builtin_convertvector(words, FourInts), Four);
}

}  // namespace lackwerk::core
