// Fingers: each belongs to what it went down on, until it leaves.
#include <algorithm>
#include <cmath>

#include "kiosk/display/experience.hpp"

namespace lackwerk::kiosk {
namespace {

using input::Control;
using input::ControlKind;
using ui::Widget;

/// More than touch sources hand out; a bound, not a rule.
constexpr std::size_t max_fingers = 32;
constexpr double mm_an_inch = 25.4;
/// A swatch that is behind its finger (it slid around another one) catches up at this, parts of the pad a second.
constexpr double catch_up_a_s = 3.0, longest_catch_up_ms = 50.0;

bool is_slider(Widget widget) {
  return widget == Widget::sparkle || widget == Widget::hue || widget == Widget::beyond || widget == Widget::dimmer ||
         widget == Widget::time;
}

/// A finger that goes down on these and moves on at once is the puck's.
bool stands_on_pad(Widget widget) { return widget == Widget::swatch || widget == Widget::swatch_about; }

bool is_card(ui::Screen screen) { return screen == ui::Screen::take_home || screen == ui::Screen::about; }

double distance(ui::Place a, ui::Place b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

ui::Place in_field(const ui::Rect& field, ui::Place px) {
  if (field.width <= 0.0 || field.height <= 0.0) return {0.5, 0.5};
  return {std::clamp((px[0] - field.x) / field.width, 0.0, 1.0),
          std::clamp((px[1] - field.y) / field.height, 0.0, 1.0)};
}

std::optional<Point> panel_of(const Control& event) {
  if (event.values.size() != 2 || !std::isfinite(event.values[0]) || !std::isfinite(event.values[1]))
    return std::nullopt;
  return Point{event.values[0], event.values[1]};
}

}  // namespace

std::uint64_t Experience::time_us(const Control& event, double now_ms) const {
  return event.time_us != 0 ? event.time_us : static_cast<std::uint64_t>(std::max(now_ms, 0.0) * 1e3);
}

ui::Place Experience::pixel_of(Point panel) const {
  const Point seen = picture_point(rotation_, panel);
  return {seen[0] * surface_.size_px[0], seen[1] * surface_.size_px[1]};
}

Experience::Finger* Experience::find_finger(int contact) {
  const auto found =
      std::find_if(fingers_.begin(), fingers_.end(), [&](const Finger& finger) { return finger.contact == contact; });
  return found == fingers_.end() ? nullptr : &*found;
}

bool Experience::is_taken(Widget widget, int index) const {
  return std::any_of(fingers_.begin(), fingers_.end(), [&](const Finger& finger) {
    return finger.item.widget == widget && (finger.item.index == index || widget == Widget::pad);
  });
}

int Experience::corner_of(ui::Place px) const {
  // On a small picture both corners stay apart.
  const double shorter = std::min(surface_.size_px[0], surface_.size_px[1]);
  const double edge = std::min(corner_mm * surface_.dpi / mm_an_inch, shorter / 4.0);
  if (!(px[1] < edge)) return -1;
  if (px[0] < edge) return 0;
  return px[0] >= surface_.size_px[0] - edge ? 1 : -1;
}

void Experience::watch_corners(double now_ms) {
  const auto is_held = [&](int corner) {
    return std::any_of(fingers_.begin(), fingers_.end(), [&](const Finger& finger) { return finger.corner == corner; });
  };
  const bool possible = settings_.has_pin && links_.check_pin && model_.screen != ui::Screen::attract &&
                        model_.screen != ui::Screen::pin && model_.screen != ui::Screen::dealer;
  const bool held = possible && is_held(0) && is_held(1);
  if (held && !corners_held_) corners_since_ms_ = now_ms;
  corners_held_ = held;
  if (!held || now_ms < corners_since_ms_ + corners_ms) return;
  corners_held_ = false;
  for (Finger& finger : fingers_) finger.corner = -1;
  stop_camera();
  model_.mix_code.clear();
  pin_.clear();
  go_to(ui::Screen::pin);
}

void Experience::show_pressed() {
  model_.pressed = Widget::none;
  model_.pressed_index = 0;
  model_.puck_held = false;
  model_.swatch_held = -1;
  for (const Finger& finger : fingers_) {
    if (finger.item.widget == Widget::none) continue;
    model_.pressed = finger.item.widget;
    model_.pressed_index = finger.item.index;
    model_.puck_held |= finger.item.widget == Widget::pad;
    if (finger.holds) model_.swatch_held = finger.item.index;
  }
}

void Experience::let_go() {
  for (Finger& finger : fingers_) {
    finger.item = {};
    finger.holds = finger.on_cross = finger.beside_card = false;
  }
  car_.clear();
  swatch_lags_ = false;
  compare_by_knob_ = false;
  model_.nearest.reset();
  show_pressed();
}

void Experience::touch_down(const Control& event, double now_ms) {
  const auto panel = panel_of(event);
  touch_cancel(event.contact);
  if (!panel) return;
  Finger finger;
  finger.contact = event.contact;
  finger.panel = *panel;
  finger.start_px = finger.at_px = pixel_of(*panel);
  finger.down_ms = now_ms;
  finger.corner = corner_of(finger.at_px);
  coasting_.reset();
  hide_focus();
  const bool swallowed = swallows(now_ms);
  if (fingers_.size() >= max_fingers) return;
  if (!swallowed) put_on(finger, event, now_ms);
  fingers_.push_back(finger);
  watch_corners(now_ms);
  show_pressed();
}

void Experience::put_on(Finger& finger, const Control& event, double now_ms) {
  if (dealer_.calibrates()) {
    finger.on_cross = !std::any_of(fingers_.begin(), fingers_.end(), [](const Finger& f) { return f.on_cross; });
    return;
  }
  const std::vector<ui::Item> items = ui::layout(surface_, content_, model_);
  finger.item = ui::item_at(items, model_.screen, finger.at_px);
  begin_visit(now_ms);
  finger.beside_card = is_card(model_.screen) && finger.item.widget == Widget::none;
  const Widget widget = finger.item.widget;
  // Two fingers on the car, one on everything else.
  if (widget == Widget::car) {
    ease_.reset();
    if (!car_.down(finger.contact, finger.at_px, time_us(event, now_ms))) finger.item = {};
    return;
  }
  if (is_taken(widget, finger.item.index)) {
    finger.item = {};
    return;
  }
  if (widget == Widget::pad || stands_on_pad(widget)) {
    const auto pad = ui::find_item(items, Widget::pad);
    finger.field = ui::pad_field(surface_, pad ? pad->rect : finger.item.rect);
  }
  if (is_slider(widget)) finger.track = ui::slider_track(surface_, finger.item, model_.language);
  if (widget == Widget::pad || is_slider(widget)) drag(finger, now_ms);
  if (widget == Widget::compare && links_.nearest) model_.nearest = links_.nearest(state_.weights());
}

void Experience::drag(Finger& finger, double now_ms) {
  const double along = finger.track.position(finger.at_px);
  switch (finger.item.widget) {
    case Widget::pad:
      desk_.put_puck(in_field(finger.field, finger.at_px), now_ms);
      break;
    case Widget::sparkle:
      desk_.set_sparkle(along, now_ms);
      break;
    case Widget::hue:
      desk_.set_hue(along, now_ms);
      break;
    case Widget::beyond:
      if (beyond_shown()) desk_.set_beyond(along, now_ms);
      break;
    case Widget::dimmer:
      state_.apply({ControlKind::dimmer, {along}, {}, 0, 0});
      break;
    case Widget::time:
      time_ease_.reset();
      state_.set_time(along);
      break;
    default:
      break;
  }
}

void Experience::drag_swatch(Finger& finger, ui::Place from_px, double now_ms) {
  const ui::Place to = in_field(finger.field, finger.at_px), from = in_field(finger.field, from_px);
  const double reach = distance(from, to) + catch_up_a_s * std::min(now_ms - dragged_ms_, longest_catch_up_ms) / 1e3;
  dragged_ms_ = now_ms;
  swatch_lags_ = desk_.drag_swatch(static_cast<std::size_t>(finger.item.index), to, reach, now_ms);
}

void Experience::touch_move(const Control& event, double now_ms) {
  Finger* finger = find_finger(event.contact);
  const auto panel = panel_of(event);
  // A finger nobody knows is no visitor: it was down before a reset.
  if (finger == nullptr || !panel) return;
  note_input(now_ms);
  const ui::Place from_px = finger->at_px;
  finger->panel = *panel;
  finger->at_px = pixel_of(*panel);
  if (corner_of(finger->at_px) != finger->corner) finger->corner = -1;
  watch_corners(now_ms);

  const double still = rest_share * std::min(surface_.size_px[0], surface_.size_px[1]);
  if (finger->item.widget == Widget::swatch && !finger->moved && now_ms >= finger->down_ms + hold_ms)
    finger->holds = true;
  const bool leaves = !finger->moved && distance(finger->start_px, finger->at_px) > still;
  if (leaves) {
    finger->moved = true;
    dragged_ms_ = now_ms;
  }
  if (finger->item.widget == Widget::car) {
    for (const Control& meant : car_.move(finger->contact, finger->at_px, time_us(event, now_ms))) {
      state_.apply(meant);
      model_.hint = false;
    }
  } else if (stands_on_pad(finger->item.widget)) {
    if (finger->moved) {
      model_.hint = false;
      if (finger->holds)
        drag_swatch(*finger, leaves ? finger->start_px : from_px, now_ms);
      else
        finger->item = is_taken(Widget::pad, 0) ? ui::Item{} : ui::Item{Widget::pad, 0, {}, {}};
    }
  } else if (finger->moved) {
    model_.hint &= finger->item.widget != Widget::pad && !is_slider(finger->item.widget);
  }
  drag(*finger, now_ms);
  show_pressed();
}

void Experience::touch_up(const Control& event, double now_ms) {
  const Finger* found = find_finger(event.contact);
  if (found == nullptr) return;
  note_input(now_ms);
  const Finger finger = *found;
  std::erase_if(fingers_, [&](const Finger& f) { return f.contact == event.contact; });
  watch_corners(now_ms);
  swatch_lags_ &= !finger.holds;
  if (finger.item.widget == Widget::car) {
    const CarFingers::Left left = car_.up(event.contact, time_us(event, now_ms));
    if (left.frame) move_home(now_ms);
    if (left.flick && !reduced_motion()) coasting_.emplace(*left.flick, now_ms);
  } else if (finger.on_cross) {
    dealer_.touch_cross(finger.panel, rotation_, surface_);
  } else {
    activate(finger, now_ms);
  }
  show_pressed();
}

void Experience::touch_cancel(int contact) {
  const Finger* found = find_finger(contact);
  if (found == nullptr) return;
  const Finger finger = *found;
  car_.cancel(contact);
  std::erase_if(fingers_, [&](const Finger& f) { return f.contact == contact; });
  swatch_lags_ &= !finger.holds;
  if (finger.item.widget == Widget::compare) model_.nearest.reset();
  watch_corners(now_ms_);
  show_pressed();
}

void Experience::advance_fingers(double now_ms) {
  watch_corners(now_ms);
  bool shown = false;
  for (Finger& finger : fingers_) {
    if (finger.item.widget != Widget::swatch) continue;
    if (!finger.moved && !finger.holds && now_ms >= finger.down_ms + hold_ms) finger.holds = shown = true;
    if (finger.holds && finger.moved && swatch_lags_) drag_swatch(finger, finger.at_px, now_ms);
  }
  if (shown) show_pressed();
}

void Experience::press_pin(int key, double now_ms) {
  if (!pin_.press(key, now_ms, links_.check_pin)) return;
  dealer_.open();
  go_to(ui::Screen::dealer);
}

void Experience::act_for_dealer(int action, double now_ms) {
  const bool had_reduced_motion = reduced_motion();
  dealer_.act(action);
  words_stale_ = true;  // perhaps in another language
  if (!beyond_shown()) desk_.set_beyond(0.0, now_ms);
  if (reduced_motion() == had_reduced_motion) return;
  desk_.set_reduced_motion(reduced_motion());
  make_tour();
}

void Experience::activate(const Finger& finger, double now_ms) {
  const Widget widget = finger.item.widget;
  const int index = finger.item.index;
  // A button means what it says if the finger leaves it where it is.
  const bool inside = finger.item.touch.contains(finger.at_px);
  switch (widget) {
    case Widget::swatch:
      if (!finger.moved) desk_.send_puck(static_cast<std::size_t>(index), now_ms);
      return;
    case Widget::compare:
      model_.nearest.reset();
      return;
    case Widget::none:
      // Outside of what lies on a card; a finger that something else has used up is down on no card.
      if (finger.beside_card && !finger.moved) leave_card();
      return;
    default:
      break;
  }
  if (!inside) return;
  switch (widget) {
    case Widget::swatch_about:
      model_.about_paint = std::clamp(index, 0, static_cast<int>(content_.paints.size()) - 1);
      go_to(ui::Screen::about);
      break;
    case Widget::sparkle_lock:
      desk_.toggle_sparkle_lock(now_ms);
      break;
    case Widget::hue_lock:
      desk_.toggle_hue_lock(now_ms);
      break;
    case Widget::light:
      state_.apply({ControlKind::light, {static_cast<double>(index)}, {}, 0, 0});
      break;
    case Widget::take_home:
      take_home();
      break;
    case Widget::close:
      leave_card();
      break;
    case Widget::pin_key:
      press_pin(index, now_ms);
      break;
    case Widget::page:
      dealer_.turn_to(index);
      break;
    case Widget::action:
      act_for_dealer(index, now_ms);
      break;
    case Widget::step_down:
      dealer_.step(index, -1);
      break;
    case Widget::step_up:
      dealer_.step(index, 1);
      break;
    default:
      break;
  }
}

void Experience::take_home() {
  if (!links_.mix_code) return;
  go_to(ui::Screen::take_home);
  model_.mix_code = links_.mix_code(state_.weights());
  if (links_.mix_name) model_.mix_name = links_.mix_name(state_.weights(), dealer_.language());
}

}  // namespace lackwerk::kiosk
