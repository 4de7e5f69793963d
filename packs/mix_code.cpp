#include "packs/mix_code.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/character.hpp"
#include "core/check.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::string_view prefix = "LW1";
/// Crockford's base 32: without I, L, O, U, which are misread.
constexpr std::string_view alphabet = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
constexpr unsigned symbol_bits = 5;
constexpr std::size_t tag_symbols = 6, checksum_symbols = 5;
constexpr unsigned count_bits = 3, weight_bits = 12, white_bits = 10;

/// Weights and flake_white in thousandths.
constexpr int whole = 1000;
constexpr int least = static_cast<int>(least_mix_weight) * whole, most = static_cast<int>(most_mix_weight) * whole;

using Symbols = std::vector<std::uint8_t>;
using Thousandths = std::vector<int>;

/// CRC-24 of OpenPGP (RFC 4880, 6.1) over the symbols' bits: finds every burst of up to 24 bits.
std::uint32_t checksum_of(const std::uint8_t* symbols, std::size_t count) {
  constexpr std::uint32_t start = 0xB704CE, polynomial = 0x1864CFB, top = 0x1000000;
  std::uint32_t crc = start;
  for (std::size_t k = 0; k < count; ++k)
    for (unsigned bit = symbol_bits; bit-- > 0;) {
      crc ^= ((symbols[k] >> bit) & 1u) << 23u;
      crc <<= 1u;
      if ((crc & top) != 0) crc ^= polynomial;
    }
  return crc;
}

/// Numbers bit by bit into symbols, the most significant bit first.
class BitWriter {
 public:
  void put(unsigned value, unsigned bits) {
    while (bits-- > 0) {
      if (used_ == 0) symbols.push_back(0);
      const unsigned bit = (value >> bits) & 1u;
      symbols.back() = static_cast<std::uint8_t>(symbols.back() | bit << (symbol_bits - 1 - used_));
      used_ = (used_ + 1) % symbol_bits;
    }
  }
  /// Goes on with a fresh symbol.
  void align() { used_ = 0; }
  Symbols symbols;

 private:
  unsigned used_ = 0;
};

/// And back. Past the end it gives 0 and remembers.
class BitReader {
 public:
  explicit BitReader(const Symbols& symbols) : symbols_(symbols) {}
  unsigned get(unsigned bits) {
    unsigned value = 0;
    while (bits-- > 0) {
      unsigned bit = 0;
      if (at_ / symbol_bits < symbols_.size())
        bit = (static_cast<unsigned>(symbols_[at_ / symbol_bits]) >> (symbol_bits - 1 - at_ % symbol_bits)) & 1u;
      else
        short_ = true;
      value = value << 1u | bit;
      ++at_;
    }
    return value;
  }
  /// Passes over what fills the symbol; false: it was not 0.
  bool align() {
    while (at_ % symbol_bits != 0)
      if (get(1) != 0) return false;
    return true;
  }
  [[nodiscard]] bool ended_exactly() const { return !short_ && at_ == symbols_.size() * symbol_bits; }
  [[nodiscard]] bool is_short() const { return short_; }

 private:
  const Symbols& symbols_;
  std::size_t at_ = 0;
  bool short_ = false;
};

/// Four bits a symbol, the fifth says that more follow; no zeros in front.
constexpr unsigned digit_bits = 4;
void put_serial(BitWriter& out, std::uint64_t serial) {
  unsigned digits = 1;
  while (digits < 64 / digit_bits && serial >> (digit_bits * digits) != 0) ++digits;
  while (digits-- > 0) {
    out.put(digits > 0 ? 1 : 0, 1);
    out.put(static_cast<unsigned>(serial >> (digit_bits * digits)) & 15u, digit_bits);
  }
}
std::optional<std::uint64_t> get_serial(BitReader& in) {
  std::uint64_t serial = 0;
  for (unsigned digit = 0; digit < 64 / digit_bits; ++digit) {
    const bool more = in.get(1) != 0;
    const unsigned value = in.get(digit_bits);
    if (digit == 0 && more && value == 0) return std::nullopt;
    serial = serial << digit_bits | value;
    if (!more) return serial;
  }
  return std::nullopt;
}

/// Rounds to thousandths whose sum is whole: those that rounding has moved furthest give way.
Thousandths thousandths_of(const std::vector<double>& weights) {
  Thousandths out(weights.size());
  std::vector<double> error(weights.size());
  int missing = whole;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double exact = std::clamp(weights[k] * whole, double{least}, double{most});
    out[k] = static_cast<int>(std::lround(exact));
    error[k] = exact - out[k];
    missing -= out[k];
  }
  // Weights that sum to 1 miss at most half a thousandth each; the bound ends it for any others.
  for (std::size_t round = 0; missing != 0 && round < weights.size(); ++round) {
    const int step = missing > 0 ? 1 : -1;
    const auto further = [&](double a, double b) { return step * a < step * b; };
    const auto furthest = std::max_element(error.begin(), error.end(), further);
    const auto at = static_cast<std::size_t>(furthest - error.begin());
    out[at] += step;
    error[at] -= step;
    missing -= step;
  }
  return out;
}

std::vector<double> weights_of(const Thousandths& values) {
  std::vector<double> out;
  out.reserve(values.size());
  for (const int value : values) out.push_back(static_cast<double>(value) / whole);
  return out;
}

/// All but the last, which follows from the sum.
void put_group(BitWriter& out, const Thousandths& group) {
  for (std::size_t k = 0; k + 1 < group.size(); ++k) out.put(static_cast<unsigned>(group[k] - least), weight_bits);
}
std::optional<Thousandths> get_group(BitReader& in, std::size_t paints) {
  Thousandths out;
  int last = whole;
  for (std::size_t k = 0; k + 1 < paints; ++k) {
    out.push_back(static_cast<int>(in.get(weight_bits)) + least);
    last -= out.back();
  }
  out.push_back(last);
  const auto inside = [](int value) { return value >= least && value <= most; };
  return std::all_of(out.begin(), out.end(), inside) ? std::optional(out) : std::nullopt;
}

/// What follows tag and serial. Groups that are as the base weights, and no white, are left out: nothing has two texts.
void put_weights(BitWriter& out, const core::Weights& weights) {
  const Thousandths base = thousandths_of(weights.base);
  const Thousandths lightness = thousandths_of(weights.flake_lightness);
  const Thousandths colour = thousandths_of(weights.flake_colour);
  const long white = std::lround(std::clamp(weights.flake_white, 0.0, 1.0) * whole);
  out.put(static_cast<unsigned>(base.size()) - 1, count_bits);
  out.put(lightness != base ? 1 : 0, 1);
  out.put(colour != base ? 1 : 0, 1);
  out.put(white != 0 ? 1 : 0, 1);
  put_group(out, base);
  if (lightness != base) put_group(out, lightness);
  if (colour != base) put_group(out, colour);
  if (white != 0) out.put(static_cast<unsigned>(white), white_bits);
}
std::optional<core::Weights> get_weights(BitReader& in) {
  const std::size_t paints = in.get(count_bits) + 1;
  const bool own_lightness = in.get(1) != 0, own_colour = in.get(1) != 0, own_white = in.get(1) != 0;
  if (paints > core::max_paints) return std::nullopt;
  const auto base = get_group(in, paints);
  const auto lightness = own_lightness ? get_group(in, paints) : base;
  const auto colour = own_colour ? get_group(in, paints) : base;
  const unsigned white = own_white ? in.get(white_bits) : 0;
  if (!base || !lightness || !colour || white > whole) return std::nullopt;
  if ((own_lightness && lightness == base) || (own_colour && colour == base) || (own_white && white == 0))
    return std::nullopt;
  return core::Weights{weights_of(*base), weights_of(*lightness), weights_of(*colour),
                       static_cast<double>(white) / whole};
}

std::string text_of(const Symbols& symbols) {
  std::string out;
  for (const std::uint8_t symbol : symbols) out += alphabet[symbol];
  return out;
}

tl::unexpected<Error> refuse(std::string what, std::string remedy) {
  return fail({}, "mix code", std::move(what), std::move(remedy), ErrorKind::usage);
}
tl::unexpected<Error> damaged() { return refuse("is damaged", "scan it again, or type it as it is printed"); }

}  // namespace

std::string pack_tag_of(std::string_view id) {
  // As for the digest of a pack: the hash needs no random numbers, so that a failing start does not matter.
  [[maybe_unused]] const int ready = sodium_init();
  std::array<unsigned char, crypto_generichash_BYTES_MIN> hash{};
  crypto_generichash(hash.data(), hash.size(), reinterpret_cast<const unsigned char*>(id.data()), id.size(), nullptr,
                     0);
  BitWriter out;
  constexpr unsigned byte_bits = 8;
  for (std::size_t k = 0; out.symbols.size() <= tag_symbols; ++k) out.put(hash[k], byte_bits);
  out.symbols.resize(tag_symbols);
  return text_of(out.symbols);
}

std::string encode_mix(const PackInfo& pack, const core::Weights& weights) {
  check_at_most(std::size_t{1}, weights.base.size(), "weights of a mix");
  check_at_most(weights.base.size(), std::size_t{core::max_paints}, "weights of a mix");
  check_equal(weights.flake_lightness.size(), weights.base.size(), "weights of lightness");
  check_equal(weights.flake_colour.size(), weights.base.size(), "weights of colour");
  BitWriter out;
  for (const char c : pack_tag_of(pack.id)) out.put(static_cast<unsigned>(alphabet.find(c)), symbol_bits);
  put_serial(out, pack.serial);
  put_weights(out, weights);
  out.align();
  const std::uint32_t checksum = checksum_of(out.symbols.data(), out.symbols.size());
  out.put(checksum, symbol_bits * checksum_symbols);
  return std::string(prefix) + text_of(out.symbols);
}

Result<Mix> decode_mix(std::string_view code) {
  if (code.size() > max_mix_code) return refuse("is too long", "give the text of the QR code alone");
  if (!code.starts_with(prefix)) return refuse("does not begin with LW1", "give the text of the QR code alone");
  code.remove_prefix(prefix.size());
  Symbols symbols;
  for (const char c : code) {
    const std::size_t value = alphabet.find(c);
    if (value == std::string_view::npos)
      return refuse("has a character that no code has", "it is made of digits and capitals, without I, L, O and U");
    symbols.push_back(static_cast<std::uint8_t>(value));
  }
  // Tag, one digit of the serial, the count, the checksum.
  if (symbols.size() < tag_symbols + 1 + 1 + checksum_symbols) return refuse("is cut short", "give the whole text");
  std::uint32_t stated = 0;
  for (std::size_t k = symbols.size() - checksum_symbols; k < symbols.size(); ++k)
    stated = stated << symbol_bits | symbols[k];
  symbols.resize(symbols.size() - checksum_symbols);
  if (checksum_of(symbols.data(), symbols.size()) != stated) return damaged();

  // What the checksum lets through was made so, or forged: it is still not believed.
  Mix out;
  out.pack_tag = std::string(code.substr(0, tag_symbols));
  BitReader in(symbols);
  for (std::size_t k = 0; k < tag_symbols; ++k) in.get(symbol_bits);
  const auto serial = get_serial(in);
  if (!serial) return damaged();
  out.serial = *serial;
  auto weights = get_weights(in);
  if (!weights || in.is_short() || !in.align() || !in.ended_exactly()) return damaged();
  out.weights = std::move(*weights);
  return out;
}

Result<core::Weights> mix_for(const PackInfo& pack, std::size_t paints, std::string_view code) {
  auto mix = decode_mix(code);
  if (!mix) return tl::unexpected(std::move(mix.error()));
  if (mix->pack_tag != pack_tag_of(pack.id))
    return fail({}, "mix code", "was made with another pack than " + pack.id, "give the pack it was made with");
  if (mix->serial > pack.serial)
    return fail({}, "mix code",
                "was made with serial " + std::to_string(mix->serial) + " of " + pack.id + ", this is serial " +
                    std::to_string(pack.serial),
                "load the newer pack");
  if (mix->weights.base.size() != paints)
    return fail(
        {}, "mix code",
        "is for " + std::to_string(mix->weights.base.size()) + " paints; this pack has " + std::to_string(paints),
        "give the pack it was made with");
  return std::move(mix->weights);
}

std::string mix_name(const core::InterpolatablePaint& paint, const core::Weights& weights, const MixWords& words) {
  struct Share {
    long percent;
    std::size_t paint;
  };
  constexpr std::size_t most_named = 3;
  std::vector<Share> shares;
  for (std::size_t k = 0; k < weights.base.size() && k < paint.paints.size(); ++k)
    if (const long percent = std::lround(weights.base[k] * 100.0); percent >= 1) shares.push_back({percent, k});
  std::stable_sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) { return a.percent > b.percent; });
  if (shares.size() > most_named) shares.resize(most_named);
  std::string out;
  const auto add = [&](std::string_view part) {
    if (!out.empty()) out += words.list_separator;
    out += part;
  };
  for (const Share& share : shares) {
    const std::string_view whole = paint.paints[share.paint].identity.name;
    add(std::to_string(share.percent) + " % " + std::string(words.name != nullptr ? words.name(whole) : whole));
  }
  if (paint.row_count() == 0) return out;
  const double spread = core::liveliness(paint, weights);
  add(spread < calm_below_lab ? words.calm : spread < lively_from_lab ? words.gentle : words.lively);
  if (weights.flake_white > 0.5) add(words.white_flakes);
  return out;
}

}  // namespace lackwerk::packs
