// Time, visits and resets.
#include "kiosk/display/experience.hpp"

#include <algorithm>
#include <cmath>

#include "input/source.hpp"
#include "kiosk/display/morph_path.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr double usual_dpi = 96.0;
constexpr double minute_ms = 60'000.0;
constexpr int minutes_a_day = 24 * 60;

bool is_weights(input::ControlKind kind) {
  using input::ControlKind;
  return kind == ControlKind::weights || kind == ControlKind::base || kind == ControlKind::flake_lightness ||
         kind == ControlKind::flake_colour || kind == ControlKind::flake_white;
}

bool same_view(const packs::Camera& a, const packs::Camera& b) {
  return a.eye_mm == b.eye_mm && a.target_mm == b.target_mm && a.vertical_fov_deg == b.vertical_fov_deg;
}

ExperienceSettings bounded(ExperienceSettings settings) {
  const auto within = [](double value, double lo, double hi) {
    return std::isfinite(value) ? std::clamp(value, lo, hi) : lo;
  };
  settings.idle_s = within(settings.idle_s, 5.0, 3600.0);
  settings.countdown_s = within(settings.countdown_s, 3.0, 60.0);
  return settings;
}

}  // namespace

std::optional<DealerChoices> Experience::take_choices() {
  auto choices = dealer_.take_choices();
  if (pin_.take_changed() && !choices) choices = dealer_.choices();
  if (choices) choices->pin = pin_.record(now_ms_, wall_s());
  return choices;
}

bool NightHours::covers(int minute) const {
  if (from == to) return false;
  return from < to ? minute >= from && minute < to : minute >= from || minute < to;
}

Experience::Experience(ui::Content content, std::vector<packs::Camera> cameras, ExperienceSettings settings,
                       ExperienceLinks links, Room room)
    : settings_(bounded(settings)),
      links_(std::move(links)),
      content_(std::move(content)),
      state_(static_cast<int>(content_.paints.size()), std::move(cameras), room),
      desk_(content_),
      dealer_(settings_),
      tour_(settings_.seed, {}) {
  model_.language = settings_.language;
  car_.set_picture(surface_.size_px);
  make_tour();
  desk_.set_reduced_motion(reduced_motion());
  desk_.show(model_, 0.0);
  show_model(0.0);
}

void Experience::make_tour() {
  TourBounds bounds;
  bounds.swatches = ui::first_places(content_.paints.size());
  const CameraRig& rig = state_.rig();
  bounds.nearest_closeness = rig.nearest_closeness() > rig.shell_closeness() ? rig.nearest_closeness() : 0.0;
  bounds.moves_camera = !reduced_motion();
  // Another one has other legs.
  tour_ = AttractTour(settings_.seed + tours_++, std::move(bounds));
  touring_ = false;
}

void Experience::set_surface(Rotation rotation, std::array<int, 2> panel_px, double dpi) {
  const std::array<int, 2> panel{std::max(panel_px[0], 1), std::max(panel_px[1], 1)};
  const ui::Surface surface{picture_size(rotation, panel), std::isfinite(dpi) && dpi > 0.0 ? dpi : usual_dpi};
  if (surface == surface_ && rotation == rotation_) return;
  surface_ = surface;
  rotation_ = rotation;
  let_go();
  fingers_.clear();
  corners_held_ = false;
  car_.set_picture(surface_.size_px);
  show_pressed();
}

void Experience::set_content(ui::Content content, std::vector<packs::Camera> cameras, Room room) {
  content_ = std::move(content);
  const int light = state_.light();
  const double dimmer = state_.dimmer();
  state_ = State(static_cast<int>(content_.paints.size()), std::move(cameras), room);
  state_.apply({input::ControlKind::light, {static_cast<double>(light)}, {}, 0, 0});
  state_.apply({input::ControlKind::dimmer, {dimmer}, {}, 0, 0});
  light_fade_.reset();
  desk_ = MixDesk(content_);
  desk_.set_reduced_motion(reduced_motion());
  let_go();
  stop_camera();
  if (model_.screen == ui::Screen::take_home || model_.screen == ui::Screen::about) model_.screen = ui::Screen::show;
  model_.about_paint = 0;
  model_.mix_code.clear();
  hide_focus();
  focus_ = {ui::Widget::none, 0};
  time_ease_.reset();
  words_stale_ = true;
  make_tour();
  desk_.show(model_, now_ms_);
  show_model(now_ms_);
}

double Experience::tick(double now_ms) {
  // A clock that stands or goes back is a fault outside; time here only goes on.
  if (std::isfinite(now_ms) && (!began_ || now_ms > now_ms_)) {
    if (!began_) {
      input_ms_ = dragged_ms_ = now_ms;
      pin_.restore(settings_.pin, now_ms, wall_s());
    }
    began_ = true;
    now_ms_ = now_ms;
  }
  return now_ms_;
}

Experience::Before Experience::before() const {
  return {state_.weights(), state_.camera(), state_.light(), state_.light_shares(),
          state_.dimmer(),  state_.time(),   model_};
}

Experience::Changes Experience::finish(const Before& before, double now_ms) {
  state_.set_weights(desk_.weights(now_ms));
  fade_light(before, now_ms);
  Changes changes;
  changes.weights = before.weights != state_.weights();
  changes.view = !same_view(before.camera, state_.camera()) || before.light != state_.light() ||
                 before.shares != state_.light_shares() || before.dimmer != state_.dimmer() ||
                 before.time != state_.time();
  words_stale_ |= changes.weights;
  find_words(now_ms);
  show_model(now_ms);
  changes.interface = before.model != model_;
  return changes;
}

/// A mood that has just been chosen comes in from whatever light there was.
void Experience::fade_light(const Before& before, double now_ms) {
  if (before.light != state_.light()) light_fade_ = LightFade{before.shares, now_ms};
  if (!light_fade_) return;
  const double part = reduced_motion() || model_.asleep ? 1.0 : eased((now_ms - light_fade_->since_ms) / light_fade_ms);
  const LightShares to = light_alone(state_.light());
  if (part >= 1.0) {
    state_.set_light_shares(to);
    light_fade_.reset();
    return;
  }
  LightShares shares{};
  for (std::size_t k = 0; k < shares.size(); ++k) shares[k] = std::lerp(light_fade_->from[k], to[k], part);
  state_.set_light_shares(shares);
}

bool Experience::beyond_shown() const {
  return dealer_.model().beyond_allowed && content_.beyond_limit > 0.0 && content_.paints.size() > 1;
}

void Experience::show_model(double now_ms) {
  model_.light = state_.light();
  model_.dimmer = state_.dimmer();
  model_.time = state_.time();
  model_.beyond_shown = beyond_shown();
  model_.language = dealer_.language();
  model_.dealer = dealer_.model();
  if (model_.screen != ui::Screen::attract) desk_.show(model_, now_ms);
  model_.pin = model_.screen == ui::Screen::pin ? pin_.model(now_ms) : ui::PinModel{};
  show_focus();
}

void Experience::find_words(double now_ms) {
  const bool shown = model_.screen == ui::Screen::show || model_.screen == ui::Screen::take_home;
  if (!words_stale_ || !shown || now_ms < words_ms_ + words_every_ms) return;
  words_stale_ = false;
  words_ms_ = now_ms;
  if (links_.mix_name) model_.mix_name = links_.mix_name(state_.weights(), dealer_.language());
  if (model_.nearest && links_.nearest) model_.nearest = links_.nearest(state_.weights());
}

void Experience::note_input(double now_ms) {
  input_ms_ = now_ms;
  model_.countdown_s.reset();
}

void Experience::begin_visit(double now_ms) {
  note_input(now_ms);
  if (model_.screen != ui::Screen::attract) return;
  // The tour stops where it is: mix and view are those that are shown.
  touring_ = false;
  model_.screen = ui::Screen::show;
  model_.asleep = false;
  model_.hint = true;
  words_stale_ = true;
  words_ms_ = now_ms - words_every_ms;
}

bool Experience::swallows(double now_ms) {
  const bool countdown = model_.countdown_s.has_value(), asleep = model_.asleep;
  const bool pattern = dealer_.model().test_pattern;
  if (asleep) begin_visit(now_ms);
  note_input(now_ms);
  dealer_.end_test_pattern();
  return countdown || asleep || pattern;
}

void Experience::stop_camera() {
  coasting_.reset();
  ease_.reset();
}

void Experience::move_home(double now_ms) {
  stop_camera();
  if (reduced_motion() || !state_.rig().is_usual()) {
    state_.go_home();
    return;
  }
  const RigPlace from = state_.rig().place();
  RigPlace to = state_.rig().home_place();
  // The shorter way round.
  to.azimuth_deg = from.azimuth_deg + std::remainder(to.azimuth_deg - from.azimuth_deg, 360.0);
  ease_ = Ease{from, to, now_ms};
}

void Experience::go_to(ui::Screen screen) {
  if (screen == model_.screen) return;
  let_go();
  model_.screen = screen;
}

void Experience::leave_card() {
  pin_.clear();
  dealer_.leave();
  model_.mix_code.clear();
  go_to(ui::Screen::show);
}

void Experience::reset_visit(double now_ms) {
  if (model_.screen != ui::Screen::attract) leave_card();
  desk_.reset(now_ms);
  state_.apply({input::ControlKind::light, {0.0}, {}, 0, 0});
  state_.apply({input::ControlKind::dimmer, {0.0}, {}, 0, 0});
  model_.nearest.reset();
  compare_by_knob_ = false;
  mood_detents_ = 0.0;
  if (reduced_motion())
    state_.set_time(1.0);
  else
    time_ease_ = TimeEase{state_.time(), now_ms};
  move_home(now_ms);
}

void Experience::reset_all(double now_ms) {
  let_go();
  fingers_.clear();
  corners_held_ = false;
  presses_.clear();
  pin_.clear();
  dealer_.leave();
  stop_camera();
  time_ease_.reset();  // the loop goes on from where the scans are
  desk_.reset();
  state_.go_home();
  state_.apply({input::ControlKind::light, {0.0}, {}, 0, 0});
  state_.apply({input::ControlKind::dimmer, {0.0}, {}, 0, 0});
  focus_ = {ui::Widget::none, 0};
  hide_focus();
  mood_detents_ = 0.0;
  ui::Model fresh;
  fresh.language = dealer_.language();
  fresh.toast = std::move(model_.toast);
  model_ = std::move(fresh);
  desk_.show(model_, now_ms);
  touring_ = false;
  words_stale_ = true;
}

void Experience::take_script(const input::Control& event, double now_ms) {
  begin_visit(now_ms);
  if (event.kind == input::ControlKind::orbit || event.kind == input::ControlKind::zoom ||
      event.kind == input::ControlKind::camera)
    stop_camera();
  if (event.kind == input::ControlKind::time) time_ease_.reset();
  const bool changed = state_.apply(event).weights;
  const bool same = event.kind == input::ControlKind::weights && state_.weights().base == event.values;
  if (is_weights(event.kind) && (changed || same)) desk_.script(event.kind, state_.weights(), now_ms);
}

Experience::Changes Experience::take(const input::Control& event, double now_ms) {
  using input::ControlKind;
  const double now = tick(now_ms);
  const Before was = before();
  switch (event.kind) {
    case ControlKind::touch_down:
      touch_down(event, now);
      break;
    case ControlKind::touch_move:
      touch_move(event, now);
      break;
    case ControlKind::touch_up:
      touch_up(event, now);
      break;
    case ControlKind::touch_cancel:
      touch_cancel(event.contact);
      break;
    case ControlKind::turn:
      turn(event, now);
      break;
    case ControlKind::press:
      press(event, now);
      break;
    case ControlKind::release:
      release(event, now);
      break;
    default:
      take_script(event, now);
      break;
  }
  return finish(was, now);
}

void Experience::advance_visit(double now_ms) {
  if (model_.screen == ui::Screen::attract) return;
  const double shows_ms = input_ms_ + 1e3 * settings_.idle_s, ends_ms = shows_ms + 1e3 * settings_.countdown_s;
  if (now_ms >= ends_ms) return reset_all(now_ms);
  if (now_ms < shows_ms) return;
  model_.countdown_s = std::ceil((ends_ms - now_ms) / 1e3);
  model_.countdown_whole_s = settings_.countdown_s;
}

void Experience::advance_tour(double now_ms) {
  const bool plays = model_.screen == ui::Screen::attract && !model_.asleep && settings_.tour;
  if (!plays) {
    touring_ = false;
    return;
  }
  if (!touring_) {
    const RigPlace place = state_.rig().place();
    tour_.start({desk_.puck(now_ms), place.azimuth_deg, place.elevation_deg, place.closeness, state_.light()}, now_ms);
    growth_.start(state_.time(), now_ms);
    touring_ = true;
  }
  if (content_.scans) state_.set_time(growth_.at(now_ms));
  const TourPose pose = tour_.at(now_ms);
  desk_.put_puck(pose.puck, now_ms);
  if (reduced_motion()) return;
  state_.set_place({pose.azimuth_deg, pose.elevation_deg, pose.closeness});
  state_.apply({input::ControlKind::light, {static_cast<double>(pose.light)}, {}, 0, 0});
}

void Experience::advance_camera(double now_ms) {
  if (coasting_) {
    const auto turned = coasting_->turn(now_ms);
    state_.apply({input::ControlKind::orbit, {turned[0], turned[1]}, {}, 0, 0});
    if (coasting_->ended(now_ms)) coasting_.reset();
  }
  if (!ease_) return;
  const double part = eased((now_ms - ease_->since_ms) / home_ms);
  if (part >= 1.0) {
    ease_.reset();
    state_.go_home();
    return;
  }
  const auto between = [&](double a, double b) { return a + (b - a) * part; };
  state_.set_place({between(ease_->from.azimuth_deg, ease_->to.azimuth_deg),
                    between(ease_->from.elevation_deg, ease_->to.elevation_deg),
                    between(ease_->from.closeness, ease_->to.closeness)});
}

void Experience::advance_time(double now_ms) {
  if (!time_ease_) return;
  const double part = eased((now_ms - time_ease_->since_ms) / newest_ms);
  state_.set_time(std::lerp(time_ease_->from, 1.0, part));
  if (part >= 1.0) time_ease_.reset();
}

Experience::Changes Experience::tell(ui::Toast toast, double now_ms) {
  const double now = tick(now_ms);
  const Before was = before();
  model_.toast = std::move(toast);
  toast_since_ms_ = now;
  return finish(was, now);
}

void Experience::advance_toast(double now_ms) {
  if (!model_.toast) return;
  // What came by night is for whoever wakes the panel.
  if (model_.asleep) toast_since_ms_ = now_ms;
  if (now_ms >= toast_since_ms_ + toast_ms) model_.toast.reset();
}

Experience::Changes Experience::advance(double now_ms, int minute_of_day) {
  const double now = tick(now_ms);
  const Before was = before();
  minute_ = std::clamp(minute_of_day, 0, minutes_a_day - 1);
  minute_asked_ms_ = now;
  advance_knobs(now);
  advance_fingers(now);
  advance_camera(now);
  advance_time(now);
  advance_visit(now);
  // Whoever is here is not put to sleep.
  model_.asleep = model_.screen == ui::Screen::attract && settings_.night.covers(minute_);
  advance_tour(now);
  advance_toast(now);
  return finish(was, now);
}

double Experience::wake_at_ms(double now_ms) const {
  const double now = std::isfinite(now_ms) ? std::max(now_ms, now_ms_) : now_ms_;
  double wake = input::never_ms;
  const auto at = [&](double ms) { wake = std::min(wake, ms); };
  if (settings_.night.from != settings_.night.to) at(minute_ < 0 ? now : minute_asked_ms_ + minute_ms);
  if (model_.screen == ui::Screen::attract) {
    if (!model_.asleep && settings_.tour) return now;
  } else {
    const double shows_ms = input_ms_ + 1e3 * settings_.idle_s, ends_ms = shows_ms + 1e3 * settings_.countdown_s;
    // The next whole second of a countdown that shows.
    at(model_.countdown_s ? ends_ms - 1e3 * (*model_.countdown_s - 1.0) : shows_ms);
    const bool shown = model_.screen == ui::Screen::show || model_.screen == ui::Screen::take_home;
    if (words_stale_ && shown && (links_.mix_name || model_.nearest)) at(words_ms_ + words_every_ms);
  }
  if (model_.toast && !model_.asleep) at(toast_since_ms_ + toast_ms);
  // As of the last call: whoever asks late has not shown the end of a movement yet.
  if (coasting_ || ease_ || time_ease_ || light_fade_ || swatch_lags_ || desk_.moves(now_ms_)) return now;
  if (corners_held_) at(corners_since_ms_ + corners_ms);
  for (const auto& [knob, press] : presses_)
    if (!press.spent) at(press.since_ms + long_press_ms);
  for (const Finger& finger : fingers_)
    if (finger.item.widget == ui::Widget::swatch && !finger.moved && !finger.holds) at(finger.down_ms + hold_ms);
  if (model_.screen == ui::Screen::pin) at(pin_.wake_at_ms(now));
  return std::max(wake, now);
}

}  // namespace lackwerk::kiosk
