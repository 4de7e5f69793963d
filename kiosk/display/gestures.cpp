#include "kiosk/display/gestures.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "input/source.hpp"
#include "kiosk/display/morph_path.hpp"

namespace lackwerk::kiosk {
namespace {

using input::Control;
using input::ControlKind;

/// More than touch sources hand out; a bound, not a rule.
constexpr std::size_t max_fingers = 32;
constexpr std::size_t max_pressed = 16;

bool is_main_button(const Control& event) { return event.values.size() == 1 && event.values[0] == 0.0; }

/// When a press that began then becomes a long one; one of unknown age never does.
double long_at_ms(std::uint64_t since_us) {
  return since_us == 0 ? input::never_ms : static_cast<double>(since_us + long_press_us) / 1e3;
}

double distance(Point a, Point b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

}  // namespace

const char* focus_name(Focus focus) {
  switch (focus) {
    case Focus::orbit:
      return "orbit";
    case Focus::zoom:
      return "zoom";
    case Focus::morph:
      break;
  }
  return "morph";
}

Gestures::Gestures(std::size_t paints, std::string home) { set_paints(paints, std::move(home)); }

void Gestures::set_paints(std::size_t paints, std::string home) {
  check_at_most(std::size_t{1}, paints, "paints of a pack");
  paints_ = static_cast<int>(paints);
  home_ = std::move(home);
  position_ = 0.0;
}

void Gestures::set_rotation(Rotation rotation, std::array<int, 2> panel_px) {
  check_at_most(1, std::min(panel_px[0], panel_px[1]), "pixels of a panel");
  const auto size = picture_size(rotation, panel_px);
  if (rotation == rotation_ && size == picture_px_) return;
  rotation_ = rotation;
  picture_px_ = size;
  fingers_.clear();
  tap_.reset();
}

void Gestures::follow(const std::vector<double>& weights) {
  position_ = nearest_position(weights, paints_, PathEnds::closed);
}

std::vector<Control> Gestures::take(const Control& event) {
  switch (event.kind) {
    case ControlKind::touch_down:
      return down(event);
    case ControlKind::touch_move:
      return move(event);
    case ControlKind::touch_up:
      return up(event);
    case ControlKind::touch_cancel:
      std::erase_if(fingers_, [&](const Finger& f) { return f.contact == event.contact; });
      return {};
    case ControlKind::turn:
      return turn(event);
    case ControlKind::press:
      if (is_main_button(event) && pressed_.size() < max_pressed) pressed_[event.name] = event.time_us;
      return {};
    case ControlKind::release:
      return release(event);
    case ControlKind::weights:
      follow(event.values);
      break;
    default:
      break;
  }
  return {event};
}

std::vector<Control> Gestures::advance(double now_ms) {
  std::vector<Control> meant;
  for (auto held = pressed_.begin(); held != pressed_.end();) {
    if (now_ms < long_at_ms(held->second)) {
      ++held;
      continue;
    }
    meant.push_back(home(static_cast<std::uint64_t>(now_ms * 1e3)));
    held = pressed_.erase(held);  // its release means nothing more
  }
  return meant;
}

double Gestures::wake_at_ms() const {
  double wake = input::never_ms;
  for (const auto& [knob, since] : pressed_) wake = std::min(wake, long_at_ms(since));
  return wake;
}

int Gestures::fingers() const {
  return static_cast<int>(
      std::count_if(fingers_.begin(), fingers_.end(), [](const Finger& f) { return f.role != Role::ignored; }));
}

std::optional<Point> Gestures::pixel_of(const Control& event) const {
  if (event.values.size() != 2 || !std::isfinite(event.values[0]) || !std::isfinite(event.values[1]))
    return std::nullopt;
  const Point seen = picture_point(rotation_, {event.values[0], event.values[1]});
  return Point{seen[0] * picture_px_[0], seen[1] * picture_px_[1]};
}

double Gestures::shorter_edge() const { return std::min(picture_px_[0], picture_px_[1]); }

std::vector<Gestures::Finger*> Gestures::on_car() {
  std::vector<Finger*> found;
  for (Finger& finger : fingers_)
    if (finger.role == Role::car) found.push_back(&finger);
  return found;
}

std::vector<Control> Gestures::down(const Control& event) {
  const auto at = pixel_of(event);
  std::erase_if(fingers_, [&](const Finger& f) { return f.contact == event.contact; });
  if (!at || fingers_.size() >= max_fingers) return {};
  Finger finger{event.contact, Role::ignored, *at, *at, true, true, event.time_us};
  if ((*at)[1] >= slider_top * picture_px_[1]) {
    const bool taken =
        std::any_of(fingers_.begin(), fingers_.end(), [](const Finger& f) { return f.role == Role::slider; });
    if (!taken) finger.role = Role::slider;
  } else if (const auto others = on_car(); others.size() < 2) {
    finger.role = Role::car;
    for (Finger* other : others) {
      // From here on two fingers move the view, even if neither has left its place.
      finger.alone = other->alone = false;
      finger.resting = other->resting = false;
    }
  }
  fingers_.push_back(finger);
  return finger.role == Role::slider ? slide(*at, event.time_us) : Controls{};
}

std::vector<Control> Gestures::slide(Point pixel, std::uint64_t time_us) {
  const double along = std::clamp((pixel[0] / picture_px_[0] - slider_margin) / (1.0 - 2.0 * slider_margin), 0.0, 1.0);
  position_ = along * (paints_ - 1);
  return {{ControlKind::weights, weights_at(position_, paints_, PathEnds::open), {}, 0, time_us}};
}

std::vector<Control> Gestures::move(const Control& event) {
  const auto finger =
      std::find_if(fingers_.begin(), fingers_.end(), [&](const Finger& f) { return f.contact == event.contact; });
  const auto to = pixel_of(event);
  if (finger == fingers_.end() || !to || finger->role == Role::ignored) return {};
  if (finger->role == Role::slider) {
    finger->at = *to;
    return slide(*to, event.time_us);
  }
  return move_on_car(*finger, *to, event.time_us);
}

std::vector<Control> Gestures::move_on_car(Finger& finger, Point to, std::uint64_t time_us) {
  Point from = finger.at;
  if (finger.resting) {
    const double way = distance(finger.start, to), still = rest_share * shorter_edge();
    if (way <= still) return {};
    // The view moves from where the finger left its place: neither a jump nor a lost flick.
    finger.resting = false;
    for (std::size_t k = 0; k < 2; ++k) from[k] = finger.start[k] + (to[k] - finger.start[k]) * still / way;
  }
  finger.at = to;
  Controls meant;
  const auto pair = on_car();
  double share = 1.0;
  if (pair.size() == 2) {
    share = 0.5;  // the mean moves half as far as one of two
    const Point other = (pair[0] == &finger ? pair[1] : pair[0])->at;
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
  return meant;
}

std::vector<Control> Gestures::up(const Control& event) {
  const auto found =
      std::find_if(fingers_.begin(), fingers_.end(), [&](const Finger& f) { return f.contact == event.contact; });
  if (found == fingers_.end()) return {};
  const Finger finger = *found;
  fingers_.erase(found);
  if (finger.role != Role::car) return {};
  const bool is_tap = finger.resting && finger.alone && finger.down_us != 0 && event.time_us >= finger.down_us &&
                      event.time_us - finger.down_us <= tap_us;
  const bool is_second = is_tap && tap_ && finger.down_us >= tap_->up_us &&
                         finger.down_us - tap_->up_us <= double_tap_us &&
                         distance(tap_->at, finger.start) <= double_tap_share * shorter_edge();
  tap_.reset();
  if (is_second) return {home(event.time_us)};
  if (is_tap) tap_ = Tap{finger.start, event.time_us};
  return {};
}

std::vector<Control> Gestures::turn(const Control& event) {
  if (event.values.size() != 1 || !std::isfinite(event.values[0]) || event.values[0] == 0.0) return {};
  const double detents = event.values[0];
  switch (focus_) {
    case Focus::orbit:
      // The car turns as the knob does, seen from above; the eye goes the other way round.
      return {{ControlKind::orbit, {detents * orbit_degrees_a_detent, 0.0}, {}, 0, event.time_us}};
    case Focus::zoom:
      return {{ControlKind::zoom, {std::exp2(-detents / zoom_detents_a_halving)}, {}, 0, event.time_us}};
    case Focus::morph:
      break;
  }
  position_ = on_path(position_ + detents / detents_a_paint, paints_, PathEnds::closed);
  return {{ControlKind::weights, weights_at(position_, paints_, PathEnds::closed), {}, 0, event.time_us}};
}

std::vector<Control> Gestures::release(const Control& event) {
  const auto held = pressed_.find(event.name);
  if (held == pressed_.end() || !is_main_button(event)) return {};
  const double long_at = long_at_ms(held->second);
  pressed_.erase(held);
  if (static_cast<double>(event.time_us) / 1e3 >= long_at) return {home(event.time_us)};
  focus_ = focus_ == Focus::morph ? Focus::orbit : focus_ == Focus::orbit ? Focus::zoom : Focus::morph;
  return {};
}

Control Gestures::home(std::uint64_t time_us) const { return {ControlKind::camera, {}, home_, 0, time_us}; }

}  // namespace lackwerk::kiosk
