// The code a customer takes home: pack and weights as a short text, for a QR code and back.
//
// Why it exists: the same pack on another kiosk, or `lackwerk render --mix`, must show the same paint again. Weights
// are rounded to 1/1000 of the simplex (sums kept), so that the code is stable: encode(decode(code)) == code. Pure; any
// thread.
#pragma once

#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/interpolatable_paint.hpp"
#include "packs/paint_pack.hpp"

namespace lackwerk::packs {

/// What each weight of a code can be: as far as core::most_beyond leads.
inline constexpr double least_mix_weight = -1.0, most_mix_weight = 2.0;
/// Longer texts are refused before anything is made of them.
inline constexpr std::size_t max_mix_code = 160;

/// "LW1..." in digits and capitals alone, which QR codes hold in their alphanumeric mode and which need no quotes on a
/// command line. At most 63 characters; a plain mix of three paints of a low serial has 21. `weights` as
/// core::check_weights takes them, each within these bounds. docs/pack-format.md has the fields.
[[nodiscard]] std::string encode_mix(const PackInfo& pack, const core::Weights& weights);

struct Mix {
  core::Weights weights;     ///< multiples of 1/1000
  std::string pack_tag;      ///< of the pack it was made with: pack_tag_of
  std::uint64_t serial = 0;  ///< that pack's
};
/// Six characters, from a hash of the id: 30 bits, so that two of a thousand packs share one with a chance of 1 in
/// 2000.
[[nodiscard]] std::string pack_tag_of(std::string_view id);

/// Error (usage): not a code, damaged (checksum: every change of one character, or of two neighbours, is found; of
/// other changes 1 in 16 million passes), or numbers out of range. Says what to do. Each mix has one code:
/// encode_mix gives the very text that was taken.
[[nodiscard]] Result<Mix> decode_mix(std::string_view code);
/// The mix for this pack. Error: that of decode_mix; made with another pack, with a newer serial of this one (whose
/// paints may be others), or for another number of paints. A code of an older serial of the same pack is taken.
[[nodiscard]] Result<core::Weights> mix_for(const PackInfo& pack, std::size_t paints, std::string_view code);

/// The words of a name in one language.
struct MixWords {
  std::string_view calm, gentle, lively;  ///< how the flakes sparkle
  std::string_view white_flakes;          ///< where the flakes' hue is taken out
  std::string_view list_separator = ", ";
  /// How a paint's name is put; null: whole.
  std::string_view (*name)(std::string_view whole) = nullptr;
};
/// Spreads of lightness (core::liveliness) below which flakes are called calm, and from which lively. The demo's dark
/// metallic has 10, its silver 47.
inline constexpr double calm_below_lab = 15.0, lively_from_lab = 40.0;

/// "72 % Polaris, 28 % Opel Titan, lively": shares of the base weights that round to 1 % or more, largest first, at
/// most three; then the sparkle in words, unless the pack has no flakes; then white_flakes where more than half of
/// their colour is taken out.
[[nodiscard]] std::string mix_name(const core::InterpolatablePaint& paint, const core::Weights& weights,
                                   const MixWords& words);

}  // namespace lackwerk::packs
