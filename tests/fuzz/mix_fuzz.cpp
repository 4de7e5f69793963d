// Fuzz target: any text as the code of a mix.
//
// Input: the text. A random text never meets the checksum, so every input is tried twice: as it is, and as the number
// symbols of a code whose checksum is right. Whatever comes: no sanitizer finding, and what is taken is weights that
// realise() may have, and the one text for them.
// Build and run: see docs of the fuzz label in CMakeLists.txt; it needs clang's libFuzzer.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "packs/mix_code.hpp"

namespace {

using namespace lackwerk;

void require(bool holds) {
  if (!holds) std::abort();
}

void check_group(const std::vector<double>& group, std::size_t paints) {
  require(group.size() == paints);
  double sum = 0.0;
  for (const double weight : group) {
    require(weight >= packs::least_mix_weight && weight <= packs::most_mix_weight);
    sum += weight;
  }
  require(std::abs(sum - 1.0) < 1e-9);
}

void decode(std::string_view code) {
  const auto mix = packs::decode_mix(code);
  if (!mix) return require(!mix.error().what.empty() && !mix.error().remedy.empty());
  const std::size_t paints = mix->weights.base.size();
  require(paints >= 1 && paints <= core::max_paints);
  check_group(mix->weights.base, paints);
  check_group(mix->weights.flake_lightness, paints);
  check_group(mix->weights.flake_colour, paints);
  require(mix->weights.flake_white >= 0.0 && mix->weights.flake_white <= 1.0);
  // The tag is a hash: encode for another id, and compare what follows it, but for the checksum.
  packs::PackInfo pack;
  pack.id = "a";
  pack.serial = mix->serial;
  const std::string again = packs::encode_mix(pack, mix->weights);
  constexpr std::size_t head = 9, checksum = 5;
  require(again.size() == code.size());
  require(again.substr(head, again.size() - head - checksum) == code.substr(head, code.size() - head - checksum));
}

/// The checksum in a form of its own (docs/pack-format.md), so that the two are tested against each other.
std::string sealed(const std::uint8_t* data, std::size_t size) {
  constexpr std::string_view alphabet = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
  std::string out = "LW1";
  unsigned crc = 0xB704CE;
  for (std::size_t k = 0; k < size; ++k) {
    const unsigned symbol = data[k] % 32u;
    out += alphabet[symbol];
    for (int bit = 4; bit >= 0; --bit) {
      const bool feed = (((crc >> 23u) ^ (symbol >> static_cast<unsigned>(bit))) & 1u) != 0;
      crc = ((crc << 1u) ^ (feed ? 0x864CFBu : 0u)) & 0xFFFFFFu;
    }
  }
  for (int place = 4; place >= 0; --place) out += alphabet[(crc >> static_cast<unsigned>(5 * place)) % 32u];
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  decode({reinterpret_cast<const char*>(data), size});
  decode(sealed(data, size));
  return 0;
}
