// The picture's slow wandering against burn-in.
//
// Why it exists: what stands on a panel for months stays on it. One pixel at a time, rarely, and only while nobody is
// there, so that nobody sees it and it costs a picture now and then. Pure; any thread.
#pragma once

#include <array>

namespace lackwerk::kiosk {

/// From one pixel to the next: 6 px a minute, a quarter of what would be seen.
inline constexpr double drift_step_ms = 10'000.0;
/// Nobody has touched anything for so long.
inline constexpr double drift_rest_ms = 10'000.0;

class Drift {
 public:
  /// `reach_px`: how far either way, [0, 24]; 0: it stays.
  explicit Drift(int reach_px) : reach_px_(reach_px) {}

  /// Goes on if it is time. True: it has moved.
  bool advance(double now_ms, double input_ms);
  /// When advance() wants to be called; input::never_ms if never.
  [[nodiscard]] double wake_at_ms(double input_ms) const;
  /// Pixels to the right and down.
  [[nodiscard]] std::array<int, 2> at() const;

 private:
  int reach_px_;
  long long steps_ = 0;
  double moved_ms_ = -1e300;
};

}  // namespace lackwerk::kiosk
