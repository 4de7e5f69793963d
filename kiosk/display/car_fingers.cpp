#include "kiosk/display/car_fingers.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace lackwerk::kiosk {
namespace {

using input::ControlKind;

/// A flick's speed is that of the last of this time: a finger that rests before it leaves turns nothing.
constexpr std::uint64_t flick_us = 80'000;
/// Three reports of a panel at 100 Hz: less is noise.
constexpr std::uint64_t least_flick_us = 8'000;

double distance(Point a, Point b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

}  // namespace

std::array<double, 2> Coasting::turn(double now_ms) {
  // The integral of exp(-t / tau): the same way whatever the frames are.
  const double whole = inertia_ms / 1e3 * (1.0 - std::exp(-std::max(now_ms - since_ms_, 0.0) / inertia_ms));
  const double step = std::max(whole - done_, 0.0);
  done_ += step;
  return {flick_.azimuth_deg_s * step, flick_.elevation_deg_s * step};
}

bool Coasting::ended(double now_ms) const {
  const double speed = std::hypot(flick_.azimuth_deg_s, flick_.elevation_deg_s);
  return !(speed * std::exp(-(now_ms - since_ms_) / inertia_ms) > least_turn_deg_s);
}

void CarFingers::set_picture(std::array<int, 2> picture_px) {
  check_at_most(1, std::min(picture_px[0], picture_px[1]), "pixels of a picture");
  if (picture_px == picture_px_) return;
  picture_px_ = picture_px;
  clear();
}

void CarFingers::clear() {
  fingers_.clear();
  tap_.reset();
  turns_.clear();
}

double CarFingers::shorter_edge() const { return std::min(picture_px_[0], picture_px_[1]); }

CarFingers::Finger* CarFingers::find(int contact) {
  const auto found =
      std::find_if(fingers_.begin(), fingers_.end(), [&](const Finger& f) { return f.contact == contact; });
  return found == fingers_.end() ? nullptr : &*found;
}

bool CarFingers::down(int contact, Point px, std::uint64_t time_us) {
  cancel(contact);
  if (fingers_.size() >= 2) return false;
  Finger finger{contact, px, px, time_us};
  for (Finger& other : fingers_) {
    // From here on two fingers move the view, even if neither has left its place.
    finger.alone = other.alone = false;
    finger.resting = other.resting = false;
  }
  turns_.clear();
  fingers_.push_back(finger);
  return true;
}

CarFingers::Controls CarFingers::move(int contact, Point to, std::uint64_t time_us) {
  Finger* finger = find(contact);
  if (finger == nullptr) return {};
  Point from = finger->at;
  if (finger->resting) {
    const double way = distance(finger->start, to), still = rest_share * shorter_edge();
    if (way <= still) return {};
    // The view moves from where the finger left its place: neither a jump nor a lost flick.
    finger->resting = false;
    for (std::size_t k = 0; k < 2; ++k) from[k] = finger->start[k] + (to[k] - finger->start[k]) * still / way;
  }
  finger->at = to;
  Controls meant;
  double share = 1.0;
  if (fingers_.size() == 2) {
    share = 0.5;  // the mean moves half as far as one of two
    const Point other = (&fingers_[0] == finger ? fingers_[1] : fingers_[0]).at;
    const double least = rest_share * shorter_edge();
    const double was = std::max(distance(from, other), least);
    const double is = std::max(distance(to, other), least);
    if (is != was) meant.push_back({ControlKind::zoom, {was / is}, {}, 0, time_us});
  }
  // The near side of the car follows the finger: the eye goes the other way round, and up when the finger goes down.
  const double degrees_a_pixel = share * orbit_degrees_a_width / picture_px_[0];
  const double azimuth = (from[0] - to[0]) * degrees_a_pixel;
  const double elevation = (to[1] - from[1]) * degrees_a_pixel;
  if (azimuth != 0.0 || elevation != 0.0) meant.push_back({ControlKind::orbit, {azimuth, elevation}, {}, 0, time_us});
  if (finger->alone) {
    turns_.push_back({azimuth, elevation, time_us});
    while (turns_.size() > 1 && turns_.front().time_us + flick_us < time_us) turns_.pop_front();
  }
  return meant;
}

std::optional<Flick> CarFingers::flick(std::uint64_t up_us) const {
  if (turns_.size() < 2 || up_us == 0) return std::nullopt;
  Flick flick;
  std::uint64_t from = up_us;
  for (const Turn& turn : turns_) {
    if (turn.time_us == 0 || turn.time_us > up_us || turn.time_us + flick_us < up_us) continue;
    // The first one's way was made before it was reported.
    if (from == up_us) {
      from = turn.time_us;
      continue;
    }
    flick.azimuth_deg_s += turn.azimuth_deg;
    flick.elevation_deg_s += turn.elevation_deg;
  }
  if (up_us - from < least_flick_us) return std::nullopt;
  const double seconds = static_cast<double>(up_us - from) / 1e6;
  flick.azimuth_deg_s /= seconds;
  flick.elevation_deg_s /= seconds;
  const double speed = std::hypot(flick.azimuth_deg_s, flick.elevation_deg_s);
  if (!(speed > least_turn_deg_s)) return std::nullopt;
  const double kept = std::min(1.0, most_turn_deg_s / speed);
  return Flick{flick.azimuth_deg_s * kept, flick.elevation_deg_s * kept};
}

CarFingers::Left CarFingers::up(int contact, std::uint64_t time_us) {
  const Finger* found = find(contact);
  if (found == nullptr) return {};
  const Finger finger = *found;
  cancel(contact);
  Left left;
  if (finger.alone && !finger.resting) left.flick = flick(time_us);
  turns_.clear();
  const bool is_tap = finger.resting && finger.alone && finger.down_us != 0 && time_us >= finger.down_us &&
                      time_us - finger.down_us <= tap_us;
  left.frame = is_tap && tap_ && finger.down_us >= tap_->up_us && finger.down_us - tap_->up_us <= double_tap_us &&
               distance(tap_->at, finger.start) <= double_tap_share * shorter_edge();
  tap_.reset();
  if (is_tap && !left.frame) tap_ = Tap{finger.start, time_us};
  return left;
}

void CarFingers::cancel(int contact) {
  std::erase_if(fingers_, [&](const Finger& f) { return f.contact == contact; });
}

}  // namespace lackwerk::kiosk
