// A text as a QR code.
//
// Why it exists: one place that knows libqrencode. Pure; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lackwerk::kiosk::ui {

/// Light modules a reader needs around the code (ISO/IEC 18004).
inline constexpr int quiet_zone = 4;

struct QrCode {
  int side = 0;                    ///< modules, without quiet zone
  std::vector<std::uint8_t> dark;  ///< row by row, 1: dark
  [[nodiscard]] bool is_dark(int x, int y) const {
    return dark[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)] != 0;
  }
};

/// Level M (15 % may be lost), smallest version that holds it, alphanumeric where the text allows. None: the text is
/// empty, holds a zero byte, or is too long.
[[nodiscard]] std::optional<QrCode> qr_of(const std::string& text);

}  // namespace lackwerk::kiosk::ui
