// A million events at random: whatever happens, weights are weights, the eye is in the room, and everything returns to
// attract.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <random>

#include "input/source.hpp"
#include "tests/unit/kiosk_visitor.hpp"

namespace lackwerk::kiosk {
namespace {

using input::Control;
using input::ControlKind;

constexpr int events_a_walk = 200'000;

/// What shakes the kiosk: a crowd of children with thirty-odd fingers, three knobs and a script.
class Chaos {
 public:
  Chaos(unsigned seed, std::size_t paints) : random_(seed), paints_(paints) {}

  double unit() { return static_cast<double>(random_() >> 11) * 0x1.0p-53; }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(unit() * static_cast<double>(n)); }

  Control event(const Experience& experience, double now_ms) {
    Control event = any(experience);
    switch (below(3)) {
      case 0:
        break;  // of unknown time
      case 1:
        event.time_us = static_cast<std::uint64_t>(now_ms * 1e3);
        break;
      default:
        event.time_us = static_cast<std::uint64_t>((now_ms - 500.0 * unit()) * 1e3);
        break;
    }
    if (unit() < 0.01) event.values = {std::numeric_limits<double>::quiet_NaN(), unit()};
    if (unit() < 0.005) event.values.clear();
    if (unit() < 0.005) event.values.push_back(std::numeric_limits<double>::infinity());
    return event;
  }

 private:
  Control any(const Experience& experience) {
    const double kind = unit();
    const int contact = static_cast<int>(unit() < 0.9 ? below(4) : below(60));
    if (kind < 0.30) return {ControlKind::touch_down, target(experience), {}, contact, 0};
    if (kind < 0.62) return {ControlKind::touch_move, near(experience), {}, contact, 0};
    if (kind < 0.86) return {ControlKind::touch_up, {}, {}, contact, 0};
    if (kind < 0.88) return {ControlKind::touch_cancel, {}, {}, contact, 0};
    if (kind < 0.92) return {ControlKind::turn, {20.0 * unit() - 10.0}, knob(), 0, 0};
    if (kind < 0.95) return {ControlKind::press, {static_cast<double>(below(2))}, knob(), 0, 0};
    if (kind < 0.98) return {ControlKind::release, {static_cast<double>(below(2))}, knob(), 0, 0};
    return script();
  }
  std::string knob() { return std::array<const char*, 3>{"", "dial", "other"}[below(3)]; }
  std::vector<double> anywhere() {
    const double x = 1.1 * unit() - 0.05;
    return {x, 1.1 * unit() - 0.05};
  }
  /// Half of the time what is there to touch.
  std::vector<double> target(const Experience& experience) {
    if (unit() < 0.5) return last_ = anywhere();
    // The layout costs more than the behaviour: it is asked anew now and then.
    if (items_.empty() || unit() < 0.05)
      items_ = ui::layout(experience.surface(), experience.content(), experience.model());
    if (items_.empty()) return last_ = anywhere();
    const ui::Place at = items_[below(items_.size())].touch.centre();
    return last_ = {at[0] / experience.surface().size_px[0], at[1] / experience.surface().size_px[1]};
  }
  std::vector<double> near(const Experience&) {
    if (last_.size() != 2 || unit() < 0.3) return last_ = anywhere();
    return last_ = {last_[0] + 0.04 * (unit() - 0.5), last_[1] + 0.04 * (unit() - 0.5)};
  }
  std::vector<double> shares() {
    std::vector<double> weights(paints_);
    double sum = 0.0;
    for (double& weight : weights) sum += weight = unit() + 1e-6;
    for (double& weight : weights) weight /= sum;
    // The last one makes it exact enough for a script.
    weights.back() = 1.0 - std::accumulate(weights.begin(), weights.end() - 1, 0.0);
    return weights;
  }
  Control script() {
    switch (below(9)) {
      case 0:
        return {ControlKind::weights, shares(), {}, 0, 0};
      case 1:
        return {ControlKind::base, shares(), {}, 0, 0};
      case 2:
        return {ControlKind::flake_lightness, shares(), {}, 0, 0};
      case 3:
        return {ControlKind::flake_colour, shares(), {}, 0, 0};
      case 4:
        return {ControlKind::flake_white, {1.2 * unit() - 0.1}, {}, 0, 0};
      case 5:
        return {ControlKind::camera, {}, std::array<const char*, 4>{"hero", "rear", "macro", "none"}[below(4)], 0, 0};
      case 6:
        return {ControlKind::orbit, {720.0 * unit() - 360.0, 100.0 * unit() - 50.0}, {}, 0, 0};
      case 7:
        return {ControlKind::zoom, {0.2 + 2.0 * unit()}, {}, 0, 0};
      default:
        return unit() < 0.5 ? Control{ControlKind::light, {5.0 * unit() - 1.0}, {}, 0, 0}
                            : Control{ControlKind::dimmer, {1.2 * unit() - 0.1}, {}, 0, 0};
    }
  }

  std::mt19937_64 random_;
  std::size_t paints_;
  std::vector<double> last_;
  std::vector<ui::Item> items_;
};

void expect_weights(const std::vector<double>& weights, std::size_t paints) {
  ASSERT_EQ(weights.size(), paints);
  double sum = 0.0;
  for (const double weight : weights) {
    ASSERT_TRUE(std::isfinite(weight));
    sum += weight;
  }
  ASSERT_NEAR(sum, 1.0, 1e-9);
}

void expect_promises(const Experience& experience, std::size_t paints) {
  const State& state = experience.state();
  ASSERT_NO_FATAL_FAILURE(expect_weights(state.weights().base, paints));
  ASSERT_NO_FATAL_FAILURE(expect_weights(state.weights().flake_lightness, paints));
  ASSERT_NO_FATAL_FAILURE(expect_weights(state.weights().flake_colour, paints));
  ASSERT_TRUE(state.weights().flake_white >= 0.0 && state.weights().flake_white <= 1.0);
  const packs::Camera& camera = state.camera();
  const float distance = glm::length(camera.eye_mm - camera.target_mm);
  ASSERT_TRUE(std::isfinite(distance) && distance > 50.0f && distance < 20000.0f) << distance;
  ASSERT_GE(camera.eye_mm.z, 59.9f);
  ASSERT_TRUE(state.light() >= 0 && state.light() < light_moods);
  ASSERT_TRUE(state.dimmer() >= 0.0 && state.dimmer() <= 1.0);
  const ui::Model& model = experience.model();
  for (const double x : model.puck) ASSERT_TRUE(x >= 0.0 && x <= 1.0);
  for (const double part : {model.sparkle, model.hue, model.beyond}) ASSERT_TRUE(part >= 0.0 && part <= 1.0) << part;
  ASSERT_TRUE(model.about_paint >= 0 && model.about_paint < static_cast<int>(paints));
}

class ExperienceWalk : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Paints, ExperienceWalk, testing::Values(1u, 2u, 3u, 4u, 5u));

TEST_P(ExperienceWalk, ComesBackFromEverything) {
  const std::size_t paints = GetParam();
  ExperienceSettings settings = some_settings();
  settings.beyond_allowed = true;
  settings.night = {23 * 60, 5 * 60};
  settings.tour = paints % 2 == 0;
  Visitor visitor(paints, settings);
  Chaos chaos(static_cast<unsigned>(paints) * 17u, paints);
  std::array<int, 6> seen{};
  double minutes = 12.0 * 60.0;
  for (int k = 0; k < events_a_walk; ++k) {
    visitor.experience.take(chaos.event(visitor.experience, visitor.now_ms), visitor.now_ms);
    // Mostly hurried, at times nobody for a while.
    const double pause = chaos.unit();
    const double ms = pause < 0.7     ? 12.0 * chaos.unit()
                      : pause < 0.995 ? 300.0 * chaos.unit()
                                      : 40'000.0 * chaos.unit();
    visitor.now_ms += ms;
    minutes += ms / 6e4;
    if (chaos.unit() < 0.001) minutes += 200.0;  // the clock is set
    if (chaos.unit() < 0.3) visitor.experience.advance(visitor.now_ms, static_cast<int>(minutes) % 1440);
    if (chaos.unit() < 0.0005)
      visitor.experience.set_surface(static_cast<Rotation>(chaos.below(4)), {1280, 720}, 60.0 + 100.0 * chaos.unit());
    if (chaos.unit() < 0.0002) visitor.experience.set_content(some_content(paints), some_cameras());
    // Somebody who knows the PIN helps now and then, or nobody would see the dealer's pages.
    if (visitor.model().screen == ui::Screen::pin && chaos.unit() < 0.02) visitor.type("2580");
    if (visitor.model().screen == ui::Screen::show && chaos.unit() < 0.0002) {
      for (int contact = 0; contact < 60; ++contact) visitor.cancel(contact);
      visitor.open_pin();
    }
    ++seen[static_cast<std::size_t>(visitor.model().screen)];
    if (k % 10'000 == 9'999) {
      // No dead end: from right here, time alone leads back.
      Visitor left_alone = visitor;
      left_alone.wait(1e3 * (settings.idle_s + settings.countdown_s) + long_press_ms + 50.0);
      ASSERT_EQ(left_alone.model().screen, ui::Screen::attract) << "event " << k;
    }
    if (k % 7 == 0) {
      ASSERT_NO_FATAL_FAILURE(expect_promises(visitor.experience, paints)) << "event " << k;
    }
  }
  for (std::size_t screen = 0; screen < seen.size(); ++screen) EXPECT_GT(seen[screen], 0) << "screen " << screen;

  // Everybody goes. Fingers that never left are nobody; what is left is what a fresh kiosk shows.
  visitor.minute = 12 * 60;
  const double gone_ms = visitor.now_ms;
  while (visitor.model().screen != ui::Screen::attract && visitor.now_ms < gone_ms + 60'000.0) visitor.wait(10.0);
  EXPECT_LE(visitor.now_ms, gone_ms + 1e3 * (settings.idle_s + settings.countdown_s) + long_press_ms + 100.0);
  ASSERT_EQ(visitor.model().screen, ui::Screen::attract);
  EXPECT_EQ(visitor.model().pressed, ui::Widget::none);
  EXPECT_EQ(visitor.model().focus, ui::Widget::none);
  EXPECT_FALSE(visitor.model().nearest || visitor.model().countdown_s);
  if (settings.tour) return;  // it plays already
  EXPECT_EQ(visitor.weights(), first_paint(static_cast<int>(paints)));
  EXPECT_EQ(visitor.camera().eye_mm, some_cameras()[0].eye_mm);
  EXPECT_EQ(visitor.camera().target_mm, some_cameras()[0].target_mm);
  EXPECT_EQ(visitor.experience.state().light(), 0);
  EXPECT_EQ(visitor.experience.state().dimmer(), 0.0);
  EXPECT_EQ(visitor.experience.wake_at_ms(visitor.now_ms), visitor.now_ms + 60'000.0) << "the night schedule alone";
}

}  // namespace
}  // namespace lackwerk::kiosk
