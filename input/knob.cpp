#include "input/knob.hpp"

#include <algorithm>
#include <cmath>

namespace lackwerk::input {
namespace {

// ---- acceleration
// gain = (speed / slow)^acceleration, at least 1, at most max_gain.
// Speed is smoothed over 80 ms, a few clicks of a hand: r revolutions at once read as r / 0.08 s. A single click of a
// 24-detent knob alone reads as 0.52 revolutions/s, so `slow` lies above that: one click is always one detent. A brisk
// turn is 3 revolutions/s, so the default exponent of 0.5 gives a gain of 2 there. A flick reaches 10.
constexpr double smoothing_s = 0.08;
constexpr double slow_revolutions_per_s = 0.75;
constexpr double max_gain = 8.0;

constexpr double max_revolutions_at_once = 10.0;

// ---- sticks
/// A stick at its stop turns as fast as an unhurried hand: one revolution a second.
constexpr double full_revolutions_per_s = 1.0;
/// 3Dconnexion devices repeat a deflection every 8 to 16 ms; radio may lose some. Longer silence is no deflection.
constexpr std::uint64_t silence_us = 200'000;
/// How often a deflected stick is asked: once a frame of 60 Hz.
constexpr double stick_period_ms = 16.0;

/// Enough for the order of a hectic second; beyond it, order goes and sums stay (compact).
constexpr std::size_t max_pending = 192;
static_assert(max_knob_axes + 2 * max_knob_buttons < max_pending, "what compact() leaves must fit");

}  // namespace

Knob::Knob(std::string name, const KnobTuning& tuning) : name_(std::move(name)), tuning_(tuning) {}

double Knob::gain(Axis& axis, double revolutions, std::uint64_t time_us) const {
  const bool clockwise = revolutions > 0.0;
  // Turning back is a correction: it begins slowly.
  if (clockwise != axis.clockwise) axis.speed = 0.0;
  const double dt_s = time_us > axis.last_us ? static_cast<double>(time_us - axis.last_us) * 1e-6 : 0.0;
  axis.clockwise = clockwise;
  axis.last_us = std::max(axis.last_us, time_us);
  axis.speed = axis.speed * std::exp(-dt_s / smoothing_s) + std::abs(revolutions) / smoothing_s;
  return std::clamp(std::pow(axis.speed / slow_revolutions_per_s, tuning_.acceleration), 1.0, max_gain);
}

void Knob::turn(std::size_t axis, double revolutions, std::uint64_t time_us) {
  if (axis >= max_knob_axes || !std::isfinite(revolutions) || revolutions == 0.0) return;
  if (tuning_.invert) revolutions = -revolutions;
  revolutions = std::clamp(revolutions, -max_revolutions_at_once, max_revolutions_at_once);
  add_turn(axis, revolutions * tuning_.detents_per_turn * gain(axes_[axis], revolutions, time_us), time_us);
}

void Knob::step(std::size_t axis, double detents, std::uint64_t time_us) {
  turn(axis, detents / tuning_.detents_per_turn, time_us);
}

void Knob::deflect(std::size_t axis, double deflection, bool repeats, std::uint64_t time_us) {
  if (axis >= max_knob_axes || !std::isfinite(deflection)) return;
  integrate(axis, time_us);
  if (tuning_.invert) deflection = -deflection;
  const double size = std::min(std::abs(deflection), 1.0);
  const double beyond = size <= tuning_.dead_zone ? 0.0 : (size - tuning_.dead_zone) / (1.0 - tuning_.dead_zone);
  // The same exponent as the gain: finer near the middle, the same at the stop.
  const double rate = full_revolutions_per_s * tuning_.detents_per_turn * std::pow(beyond, 1.0 + tuning_.acceleration);
  Axis& state = axes_[axis];
  state.rate = deflection < 0.0 ? -rate : rate;
  state.repeats = repeats;
  state.integrated_us = std::max(state.integrated_us, time_us);
  state.told_us = state.integrated_us;
}

void Knob::integrate(std::size_t axis, std::uint64_t time_us) {
  Axis& state = axes_[axis];
  if (state.rate == 0.0) return;
  std::uint64_t until = time_us;
  const bool silent = state.repeats && time_us > state.told_us + silence_us;
  if (silent) until = state.told_us + silence_us;
  if (until > state.integrated_us) {
    const std::uint64_t since = state.integrated_us;
    state.integrated_us = until;
    add_turn(axis, state.rate * static_cast<double>(until - since) * 1e-6, since);
  }
  if (silent) state.rate = 0.0;
}

void Knob::button(std::size_t number, bool down, std::uint64_t time_us) {
  if (number >= max_knob_buttons || down_[number] == down) return;
  // What a stick has turned so far comes before the switch.
  for (std::size_t axis = 0; axis < max_knob_axes; ++axis) integrate(axis, time_us);
  down_[number] = down;
  add_switch(down ? ControlKind::press : ControlKind::release, number, time_us);
}

void Knob::let_go(std::uint64_t time_us) {
  for (std::size_t axis = 0; axis < max_knob_axes; ++axis) {
    integrate(axis, time_us);
    axes_[axis].rate = 0.0;
  }
  for (std::size_t number = 0; number < max_knob_buttons; ++number) button(number, false, time_us);
}

void Knob::add_turn(std::size_t axis, double detents, std::uint64_t time_us) {
  if (detents == 0.0) return;
  for (auto entry = pending_.rbegin(); entry != pending_.rend() && entry->kind == ControlKind::turn; ++entry) {
    if (entry->index != axis) continue;
    entry->detents += detents;
    return;
  }
  if (pending_.size() == max_pending) compact();
  pending_.push_back({ControlKind::turn, axis, detents, time_us});
}

void Knob::add_switch(ControlKind kind, std::size_t number, std::uint64_t time_us) {
  if (pending_.size() == max_pending) compact();
  pending_.push_back({kind, number, 0.0, time_us});
}

void Knob::compact() {
  std::vector<Pending> turns, switches;
  turns.reserve(max_knob_axes);
  switches.reserve(max_pending);
  for (const auto& entry : pending_) {
    if (entry.kind == ControlKind::turn) {
      const auto same =
          std::find_if(turns.begin(), turns.end(), [&](const Pending& e) { return e.index == entry.index; });
      if (same == turns.end())
        turns.push_back(entry);
      else
        same->detents += entry.detents;
      continue;
    }
    // A press and its release (or the reverse) that nobody has seen yet cancel out, so each button keeps at most one.
    const auto opposite =
        std::find_if(switches.begin(), switches.end(), [&](const Pending& e) { return e.index == entry.index; });
    if (opposite == switches.end())
      switches.push_back(entry);
    else
      switches.erase(opposite);
  }
  pending_ = std::move(turns);
  pending_.insert(pending_.end(), switches.begin(), switches.end());
}

void Knob::take(double now_ms, std::size_t limit, std::vector<Control>& out) {
  taken_ms_ = now_ms;
  const auto now_us = static_cast<std::uint64_t>(std::max(now_ms, 0.0) * 1000.0);
  for (std::size_t axis = 0; axis < max_knob_axes; ++axis) integrate(axis, now_us);
  const std::size_t count = std::min(limit, pending_.size());
  out.reserve(out.size() + count);
  for (std::size_t k = 0; k < count; ++k) {
    const Pending& entry = pending_[k];
    Control control;
    control.kind = entry.kind;
    control.time_us = entry.time_us;
    control.name = name_;
    if (entry.kind == ControlKind::turn) {
      control.values = {entry.detents};
      if (entry.index > 0) control.name += " " + std::to_string(entry.index + 1);
    } else {
      control.values = {static_cast<double>(entry.index)};
    }
    out.push_back(std::move(control));
  }
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(count));
}

double Knob::wake_at_ms() const {
  if (!pending_.empty()) return 0.0;
  const bool turning = std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.rate != 0.0; });
  return turning ? taken_ms_ + stick_period_ms : never_ms;
}

}  // namespace lackwerk::input
