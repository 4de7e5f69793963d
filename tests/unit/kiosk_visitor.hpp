// Somebody before the kiosk, for tests: fingers by what they touch, knobs, and time.
//
// Why it exists: tests of the behaviour read as what a visitor does. The clock is the test's own. One thread.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/display/experience.hpp"

namespace lackwerk::kiosk {

inline ui::Content some_content(std::size_t paints, double beyond_limit = 0.4) {
  ui::Content content;
  content.pack_id = "test";
  content.serial = 1;
  // Not in order of liveliness.
  constexpr std::array<double, 5> lively{6.0, 2.0, 9.0, 4.0, 1.0};
  for (std::size_t k = 0; k < paints; ++k) {
    ui::PaintFacts facts;
    facts.identity.name = "Paint " + std::to_string(k);
    facts.lively = lively[k % lively.size()];
    content.paints.push_back(facts);
  }
  content.beyond_limit = beyond_limit;
  return content;
}

inline std::vector<packs::Camera> some_cameras() {
  return {{"hero", {4620.0f, 3120.0f, 1020.0f}, {330.0f, -60.0f, 640.0f}, 28.0f},
          {"rear", {-4650.0f, 3150.0f, 1200.0f}, {-380.0f, -60.0f, 640.0f}, 28.0f},
          {"macro", {1648.0f, 255.0f, 1004.0f}, {1560.0f, 210.0f, 890.0f}, 13.0f}};
}

inline ExperienceSettings some_settings() {
  ExperienceSettings settings;
  settings.idle_s = 20.0;
  settings.countdown_s = 5.0;
  settings.has_pin = true;
  return settings;
}

/// What the test's links were asked.
struct Asked {
  int nearest = 0, pins = 0, names = 0;
};

inline ExperienceLinks some_links(Asked* asked = nullptr) {
  ExperienceLinks links;
  links.nearest = [asked](const core::Weights& weights) {
    if (asked != nullptr) ++asked->nearest;
    ui::Nearest nearest;
    for (std::size_t k = 0; k < weights.base.size(); ++k)
      if (weights.base[k] > weights.base[static_cast<std::size_t>(nearest.paint)]) nearest.paint = static_cast<int>(k);
    return nearest;
  };
  links.check_pin = [asked](const std::string& pin) {
    if (asked != nullptr) ++asked->pins;
    return pin == "2580";
  };
  links.mix_name = [asked](const core::Weights&, ui::Language language) {
    if (asked != nullptr) ++asked->names;
    return "name in language " + std::to_string(static_cast<int>(language));
  };
  links.mix_code = [](const core::Weights&) { return std::string("LW1CODE"); };
  return links;
}

class Visitor {
 public:
  explicit Visitor(std::size_t paints = 3, ExperienceSettings settings = some_settings(),
                   std::optional<ExperienceLinks> links = std::nullopt)
      : experience(some_content(paints), some_cameras(), settings, links ? *links : some_links(&asked)) {
    experience.set_surface(rotation, panel_px, dpi);
    wait(0.0);
  }

  static constexpr std::array<int, 2> panel_px{1920, 1080};
  static constexpr double dpi = 96.0;

  Experience::Changes send(input::ControlKind kind, std::vector<double> values, int contact = 0,
                           std::string name = {}) {
    input::Control event{kind, std::move(values), std::move(name), contact, static_cast<std::uint64_t>(now_ms * 1e3)};
    return experience.take(event, now_ms);
  }
  Experience::Changes finger(input::ControlKind kind, ui::Place px, int contact = 0) {
    const Point panel = panel_point(rotation, {px[0] / size()[0], px[1] / size()[1]});
    return send(kind, {panel[0], panel[1]}, contact);
  }
  void down(ui::Place px, int contact = 0) { finger(input::ControlKind::touch_down, px, contact); }
  void move(ui::Place px, int contact = 0) { finger(input::ControlKind::touch_move, px, contact); }
  void up(int contact = 0) { send(input::ControlKind::touch_up, {}, contact); }
  void cancel(int contact = 0) { send(input::ControlKind::touch_cancel, {}, contact); }
  void tap(ui::Place px, double held_ms = 80.0) {
    down(px);
    wait(held_ms);
    up();
  }
  void tap(ui::Widget widget, int index = 0) { tap(place_of(widget, index)); }
  /// From one place to another in steps, as a panel reports them.
  void drag(ui::Place from, ui::Place to, double over_ms = 300.0, int contact = 0) {
    down(from, contact);
    constexpr int steps = 20;
    for (int k = 1; k <= steps; ++k) {
      wait(over_ms / steps);
      move({from[0] + (to[0] - from[0]) * k / steps, from[1] + (to[1] - from[1]) * k / steps}, contact);
    }
  }
  void turn(double detents) { send(input::ControlKind::turn, {detents}, 0, "dial"); }
  void press(double held_ms = 100.0) {
    send(input::ControlKind::press, {0.0}, 0, "dial");
    wait(held_ms);
    send(input::ControlKind::release, {0.0}, 0, "dial");
  }
  /// Time goes by, in steps as the kiosk takes them.
  void wait(double ms) {
    const double end = now_ms + ms;
    do {
      const double wake = experience.wake_at_ms(now_ms);
      now_ms = std::min(end, std::max(wake, now_ms + frame_ms));
      all |= experience.advance(now_ms, minute);
    } while (now_ms < end);
  }
  void begin() {
    // A short press on the car; the tour may have turned it.
    if (model().screen == ui::Screen::attract) tap(middle());
    wait(500.0);
  }
  /// Through the dealer's gesture and the PIN.
  void type(const std::string& pin) {
    for (const char digit : pin) type_key(digit - '0');
    type_key(PinPad::confirm_key);
  }
  void type_key(int key) {
    // Somebody else may have closed it.
    if (model().screen == ui::Screen::pin) tap(ui::Widget::pin_key, key);
  }
  void hold_corners(double ms) {
    down({5.0, 5.0}, 7);
    down({size()[0] - 5.0, 5.0}, 8);
    wait(ms);
  }
  void open_pin() {
    hold_corners(corners_ms + 1.0);
    up(7);
    up(8);
  }
  void open_dealer() {
    open_pin();
    type("2580");
  }

  [[nodiscard]] std::array<double, 2> size() const {
    const auto px = experience.surface().size_px;
    return {static_cast<double>(px[0]), static_cast<double>(px[1])};
  }
  [[nodiscard]] ui::Place middle() const { return {0.35 * size()[0], 0.4 * size()[1]}; }
  [[nodiscard]] std::vector<ui::Item> items() const {
    return ui::layout(experience.surface(), experience.content(), model());
  }
  [[nodiscard]] ui::Place place_of(ui::Widget widget, int index = 0) const {
    const auto item = ui::find_item(items(), widget, index);
    EXPECT_TRUE(item.has_value()) << "no widget " << static_cast<int>(widget) << ", " << index;
    if (!item) return {0.0, 0.0};
    return item->rect.centre();
  }
  /// A pixel of the pad.
  [[nodiscard]] ui::Place on_pad(ui::Place place) const {
    const auto pad = ui::find_item(items(), ui::Widget::pad);
    EXPECT_TRUE(pad.has_value());
    if (!pad) return {0.0, 0.0};
    const ui::Rect field = ui::pad_field(experience.surface(), pad->rect);
    return {field.x + place[0] * field.width, field.y + place[1] * field.height};
  }
  [[nodiscard]] ui::Place on_slider(ui::Widget widget, double position) const {
    const auto item = ui::find_item(items(), widget);
    EXPECT_TRUE(item.has_value());
    if (!item) return {0.0, 0.0};
    return ui::slider_track(experience.surface(), *item, model().language).at(position);
  }
  [[nodiscard]] const ui::Model& model() const { return experience.model(); }
  [[nodiscard]] const core::Weights& weights() const { return experience.state().weights(); }
  [[nodiscard]] const packs::Camera& camera() const { return experience.state().camera(); }

  Asked asked;
  Rotation rotation = Rotation::none;
  int minute = 12 * 60;
  double now_ms = 1e6;
  static constexpr double frame_ms = 1000.0 / 60.0;
  Experience experience;
  Experience::Changes all;  ///< of advance(), since the test last cleared it
};

/// A visitor who has come to the show, with the puck and the view as they are at first.
inline Visitor in_show(std::size_t paints = 3, ExperienceSettings settings = some_settings()) {
  settings.tour = false;
  Visitor visitor(paints, settings);
  visitor.begin();
  EXPECT_EQ(visitor.model().screen, ui::Screen::show);
  return visitor;
}

/// The most that two mixes of as many paints differ in.
inline double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

}  // namespace lackwerk::kiosk
