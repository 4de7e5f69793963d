#include "kiosk/display/latency.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/check.hpp"

namespace lackwerk::kiosk {
namespace {

/// The value below which `share` of them lie (nearest rank).
double quantile(std::span<const double> values, double share) {
  std::vector<double> sorted(values.begin(), values.end());
  const auto rank = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(sorted.size() - 1)));
  std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
  return sorted[static_cast<std::size_t>(rank)];
}

}  // namespace

void Latency::input(std::uint64_t event_us) {
  if (event_us == 0) return;
  if (waiting_us_ == 0 || event_us < waiting_us_) waiting_us_ = event_us;
}

void Latency::handed_over() {
  if (waiting_us_ == 0) return;
  // A picture that never flipped (unplugged) hands its events on to the next.
  if (on_way_us_ == 0 || waiting_us_ < on_way_us_) on_way_us_ = waiting_us_;
  waiting_us_ = 0;
}

void Latency::flipped(std::uint64_t flip_us, double frame_period_ms) {
  if (on_way_us_ == 0 || flip_us < on_way_us_) return;
  check_at_most(0.0, frame_period_ms, "frame period");
  const double ms = static_cast<double>(flip_us - on_way_us_) * 1e-3;
  on_way_us_ = 0;
  ms_[count_ % kept] = ms;
  frames_[count_ % kept] = frame_period_ms > 0.0 ? ms / frame_period_ms : 0.0;
  ++count_;
}

LatencySummary Latency::summary() const {
  if (count_ == 0) return {};
  const std::size_t held = std::min(count_, kept);
  const std::span<const double> ms(ms_.data(), held), frames(frames_.data(), held);
  return {count_, quantile(ms, 0.5), quantile(ms, 0.95), quantile(frames, 0.95)};
}

}  // namespace lackwerk::kiosk
