// Knobs: turn what is focused, press for the next, hold for the beginning.
#include <algorithm>
#include <cmath>

#include "kiosk/display/experience.hpp"

namespace lackwerk::kiosk {
namespace {

using input::Control;
using input::ControlKind;
using ui::Widget;

constexpr std::size_t max_presses = 16;
/// No knob turns further between two events; whatever says so is broken.
constexpr double most_detents = 1000.0;
/// Of Widget::car: what a turn does.
constexpr int orbit_index = 0, zoom_index = 1;

bool is_main_button(const Control& event) { return event.values.size() == 1 && event.values[0] == 0.0; }

}  // namespace

std::vector<Experience::Focus> Experience::focuses() const {
  if (content_.scans) return {{Widget::time, 0}, {Widget::car, orbit_index}, {Widget::car, zoom_index}};
  const bool several = content_.paints.size() > 1;
  std::vector<Focus> found;
  if (several) found.emplace_back(Widget::pad, 0);
  if (content_.has_flakes && several) found.emplace_back(Widget::sparkle, 0);
  if (content_.has_flakes) found.emplace_back(Widget::hue, 0);
  if (beyond_shown()) found.emplace_back(Widget::beyond, 0);
  found.emplace_back(Widget::light, 0);
  found.emplace_back(Widget::dimmer, 0);
  found.emplace_back(Widget::car, orbit_index);
  found.emplace_back(Widget::car, zoom_index);
  if (links_.nearest && several) found.emplace_back(Widget::compare, 0);
  if (links_.mix_code) found.emplace_back(Widget::take_home, 0);
  return found;
}

void Experience::show_focus() {
  const bool shown = focus_seen_ && model_.screen == ui::Screen::show;
  model_.focus = shown ? focus_.first : Widget::none;
  model_.focus_index = shown ? focus_.second : 0;
  // The mood that is chosen, not the row of them.
  if (shown && focus_.first == Widget::light) model_.focus_index = state_.light();
}

void Experience::hide_focus() {
  focus_seen_ = false;
  if (compare_by_knob_) model_.nearest.reset();
  compare_by_knob_ = false;
}

void Experience::next_focus() {
  const std::vector<Focus> all = focuses();
  const auto at = std::find(all.begin(), all.end(), focus_);
  // What is focused may be gone, as "beyond" is when a dealer forbids it.
  const bool last = at == all.end() || at + 1 == all.end();
  if (compare_by_knob_) model_.nearest.reset();
  compare_by_knob_ = false;
  mood_detents_ = 0.0;
  focus_ = last ? all.front() : *(at + 1);
}

void Experience::turn(const Control& event, double now_ms) {
  if (event.values.size() != 1 || !std::isfinite(event.values[0]) || event.values[0] == 0.0) return;
  coasting_.reset();
  if (swallows(now_ms)) return;
  begin_visit(now_ms);
  if (model_.screen != ui::Screen::show) return;
  const std::vector<Focus> all = focuses();
  if (std::find(all.begin(), all.end(), focus_) == all.end()) focus_ = all.front();
  focus_seen_ = true;
  model_.hint = false;
  turn_focus(std::clamp(event.values[0], -most_detents, most_detents), now_ms);
}

void Experience::turn_focus(double detents, double now_ms) {
  const double way = detents / detents_a_slider;
  switch (focus_.first) {
    case Widget::pad:
      desk_.turn_puck(detents, now_ms);
      break;
    case Widget::sparkle:
      desk_.set_sparkle(desk_.sparkle(now_ms) + way, now_ms);
      break;
    case Widget::hue:
      desk_.set_hue(desk_.hue(now_ms) + way, now_ms);
      break;
    case Widget::beyond:
      desk_.set_beyond(desk_.beyond() + way, now_ms);
      break;
    case Widget::dimmer:
      state_.apply({ControlKind::dimmer, {std::clamp(state_.dimmer() + way, 0.0, 1.0)}, {}, 0, 0});
      break;
    case Widget::time:
      time_ease_.reset();
      state_.set_time(state_.time() + detents / detents_a_series);
      break;
    case Widget::light: {
      mood_detents_ += detents;
      const double moods = std::trunc(mood_detents_ / detents_a_mood);
      mood_detents_ -= moods * detents_a_mood;
      const int light = (state_.light() + static_cast<int>(moods) % light_moods + light_moods) % light_moods;
      state_.apply({ControlKind::light, {static_cast<double>(light)}, {}, 0, 0});
      break;
    }
    case Widget::car:
      ease_.reset();
      // The car turns as the knob does, seen from above; the eye goes the other way round.
      if (focus_.second == orbit_index)
        state_.apply({ControlKind::orbit, {detents * orbit_degrees_a_detent, 0.0}, {}, 0, 0});
      else
        state_.apply({ControlKind::zoom, {std::exp2(-detents / zoom_detents_a_halving)}, {}, 0, 0});
      break;
    case Widget::compare:
      compare_by_knob_ = detents > 0.0;
      if (compare_by_knob_)
        model_.nearest = links_.nearest(state_.weights());
      else
        model_.nearest.reset();
      break;
    case Widget::take_home:
      take_home();
      break;
    default:
      break;
  }
}

void Experience::press(const Control& event, double now_ms) {
  if (!is_main_button(event)) return;
  coasting_.reset();
  Press press{now_ms, false};
  press.spent = swallows(now_ms);
  if (model_.screen == ui::Screen::attract) {
    begin_visit(now_ms);
    focus_ = focuses().front();
    focus_seen_ = true;
    press.begins = true;
  }
  if (presses_.size() < max_presses || presses_.count(event.name) != 0) presses_[event.name] = press;
}

void Experience::release(const Control& event, double now_ms) {
  const auto held = presses_.find(event.name);
  if (held == presses_.end() || !is_main_button(event)) return;
  const Press press = held->second;
  presses_.erase(held);
  note_input(now_ms);
  if (press.spent) return;
  if (now_ms >= press.since_ms + long_press_ms) return reset_visit(now_ms);
  if (press.begins) return;
  if (model_.screen != ui::Screen::show) return leave_card();
  // Whoever cannot see what is focused is shown that first.
  if (focus_seen_) next_focus();
  const std::vector<Focus> all = focuses();
  if (std::find(all.begin(), all.end(), focus_) == all.end()) focus_ = all.front();
  focus_seen_ = true;
}

void Experience::advance_knobs(double now_ms) {
  bool resets = false;
  for (auto& [knob, press] : presses_) {
    if (press.spent || now_ms < press.since_ms + long_press_ms) continue;
    press.spent = resets = true;
  }
  if (!resets) return;
  note_input(now_ms);
  reset_visit(now_ms);
}

}  // namespace lackwerk::kiosk
