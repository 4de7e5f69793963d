#include "kiosk/display/growth_loop.hpp"

#include <algorithm>
#include <cmath>

#include "kiosk/display/mix_desk.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr double ms_a_s = 1e3;
/// After a long sleep the legs in between are skipped: nobody has seen them.
constexpr double loop_ms = ms_a_s * (growing_s + grown_s + shrinking_s + small_s);

}  // namespace

void GrowthLoop::start(double position, double now_ms) {
  const double from = std::clamp(std::isfinite(position) ? position : 1.0, 0.0, 1.0);
  leg_ = {from, 1.0, now_ms, ms_a_s * growing_s * (1.0 - from)};
  started_ = true;
}

GrowthLoop::Leg GrowthLoop::after(const Leg& leg) const {
  const double begin_ms = leg.begin_ms + leg.length_ms;
  if (leg.from != leg.to) return {leg.to, leg.to, begin_ms, ms_a_s * (leg.to > 0.5 ? grown_s : small_s)};
  const bool grows = leg.to < 0.5;
  return {leg.to, grows ? 1.0 : 0.0, begin_ms, ms_a_s * (grows ? growing_s : shrinking_s)};
}

double GrowthLoop::at(double now_ms) {
  if (!started_) return 1.0;
  const double late_ms = now_ms - (leg_.begin_ms + leg_.length_ms);
  if (late_ms > loop_ms) leg_.begin_ms += loop_ms * std::floor(late_ms / loop_ms);
  // A leg of no length (it was started at its end) ends at once.
  while (now_ms >= leg_.begin_ms + leg_.length_ms) leg_ = after(leg_);
  return std::lerp(leg_.from, leg_.to, eased((now_ms - leg_.begin_ms) / leg_.length_ms));
}

}  // namespace lackwerk::kiosk
