// From "a card" to an output: finds the cards, opens the right one, and makes the surface on it.
//
// Why it exists: card numbers move, so all cards are looked at. The only file that knows /dev/dri. The kiosk's thread.
#pragma once

#include <memory>

#include "kiosk/display/output.hpp"
#include "kiosk/display/output/seat.hpp"

namespace lackwerk::kiosk {

/// `platform`: kms or dumb. A card without a monitor is taken and waits. Error: no card, none that may be opened, or
/// the platform does not work on it.
[[nodiscard]] Result<std::unique_ptr<Output>> open_kms(Platform platform, const OutputSettings& settings, Seat& seat,
                                                       Log& log);

/// A graphics driver may be loaded later than the kiosk starts: a card is waited for this long.
inline constexpr int card_wait_ms = 3000;
/// Waits until there is a card, or card_wait_ms.
void wait_for_card(Log& log);

}  // namespace lackwerk::kiosk
