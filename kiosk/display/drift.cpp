#include "kiosk/display/drift.hpp"

#include <algorithm>

#include "input/source.hpp"

namespace lackwerk::kiosk {
namespace {

/// From 0 up to reach, down to -reach and back, one a step.
int swing(long long step, int reach) {
  const long long period = 4LL * reach, at = step % period;
  if (at <= reach) return static_cast<int>(at);
  if (at <= 3LL * reach) return static_cast<int>(2LL * reach - at);
  return static_cast<int>(at - period);
}

}  // namespace

double Drift::wake_at_ms(double input_ms) const {
  if (reach_px_ == 0) return input::never_ms;
  return std::max(moved_ms_ + drift_step_ms, input_ms + drift_rest_ms);
}

bool Drift::advance(double now_ms, double input_ms) {
  if (now_ms < wake_at_ms(input_ms)) return false;
  ++steps_;
  moved_ms_ = now_ms;
  return true;
}

std::array<int, 2> Drift::at() const {
  if (reach_px_ == 0) return {0, 0};
  // Rows of a field: from side to side, and one down at either side. Each step moves one of the two.
  const long long row_length = 2LL * reach_px_ + 1;
  // The first row begins in the middle.
  const long long shifted = steps_ + reach_px_;
  const long long row = shifted / row_length, along = shifted % row_length;
  const int x = static_cast<int>(row % 2 == 0 ? along - reach_px_ : reach_px_ - along);
  return {x, swing(row, reach_px_)};
}

}  // namespace lackwerk::kiosk
