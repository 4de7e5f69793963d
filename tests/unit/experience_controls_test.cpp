// What each control of the show does: pad, sliders and locks, the car, the cards, and the knob alone.
#include "kiosk/display/experience.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "kiosk/display/ui/paint_pad.hpp"
#include "tests/unit/kiosk_visitor.hpp"

namespace lackwerk::kiosk {
namespace {

using input::ControlKind;
using ui::Screen;
using ui::Widget;
using Numbers = std::vector<double>;

// ---- the pad

TEST(Experience, ThePuckFollowsTheFinger) {
  Visitor visitor = in_show();
  visitor.down(visitor.on_pad({0.5, 0.55}));
  EXPECT_TRUE(visitor.model().puck_held);
  EXPECT_NEAR(visitor.model().puck[0], 0.5, 1e-9);
  EXPECT_NEAR(visitor.model().puck[1], 0.55, 1e-9);
  EXPECT_TRUE(visitor.model().hint);
  visitor.move(visitor.on_pad({0.3, 0.6}));
  EXPECT_NEAR(visitor.model().puck[0], 0.3, 1e-9);
  EXPECT_EQ(visitor.weights().base, ui::pad_weights(visitor.model().swatches, visitor.model().puck));
  EXPECT_EQ(visitor.weights().base, visitor.weights().flake_lightness);
  EXPECT_EQ(visitor.weights().base, visitor.weights().flake_colour);
  EXPECT_FALSE(visitor.model().hint) << "whoever drags has understood";
  visitor.move({-500.0, 5000.0});
  EXPECT_EQ(visitor.model().puck, (ui::Place{0.0, 1.0})) << "a finger beyond the pad stays on its rim";
  visitor.up();
  EXPECT_FALSE(visitor.model().puck_held);
}

TEST(Experience, ATapOnASwatchTakesThatPaint) {
  for (std::size_t paints = 2; paints <= 5; ++paints) {
    Visitor visitor = in_show(paints);
    for (std::size_t k = 0; k < paints; ++k) {
      const core::Weights before = visitor.weights();
      visitor.tap(Widget::swatch, static_cast<int>(k));
      EXPECT_LT(apart(visitor.weights().base, before.base), 0.9 + 1e-9) << "it glides";
      visitor.wait(glide_ms + 20.0);
      EXPECT_EQ(visitor.weights().base[k], 1.0);
      EXPECT_EQ(visitor.model().puck, visitor.model().swatches[k]);
    }
  }
}

TEST(Experience, ReducedMotionGlidesNothing) {
  ExperienceSettings settings = some_settings();
  settings.reduced_motion = true;
  Visitor visitor = in_show(3, settings);
  visitor.tap(Widget::swatch, 2);
  EXPECT_EQ(visitor.weights().base, (Numbers{0, 0, 1}));
}

TEST(Experience, AHeldSwatchIsMovedAndAQuickDragIsThePucks) {
  Visitor visitor = in_show();
  const ui::Place at = visitor.place_of(Widget::swatch, 1);
  visitor.down(at);
  visitor.wait(100.0);
  visitor.move({at[0] - 60.0, at[1] - 60.0});
  EXPECT_TRUE(visitor.model().puck_held);
  EXPECT_EQ(visitor.model().swatch_held, -1);
  EXPECT_EQ(visitor.model().swatches, ui::first_places(3));
  visitor.up();
  // The same from a label.
  visitor.down(visitor.place_of(Widget::swatch_about, 0));
  visitor.move(visitor.on_pad({0.5, 0.6}));
  EXPECT_TRUE(visitor.model().puck_held);
  EXPECT_EQ(visitor.model().screen, Screen::show);
  visitor.up();
  EXPECT_EQ(visitor.model().screen, Screen::show);

  visitor.down(at);
  visitor.wait(hold_ms + 20.0);
  EXPECT_EQ(visitor.model().swatch_held, 1);
  const ui::Place puck = visitor.model().puck;
  const ui::Place to{0.55, 0.5};
  for (int k = 1; k <= 10; ++k) {
    visitor.move(
        {at[0] + (visitor.on_pad(to)[0] - at[0]) * k / 10.0, at[1] + (visitor.on_pad(to)[1] - at[1]) * k / 10.0});
    visitor.wait(10.0);
  }
  EXPECT_NEAR(visitor.model().swatches[1][0], to[0], 1e-6);
  EXPECT_NEAR(visitor.model().swatches[1][1], to[1], 1e-6);
  EXPECT_EQ(visitor.model().puck, puck) << "the puck stays";
  EXPECT_EQ(visitor.weights().base, ui::pad_weights(visitor.model().swatches, puck)) << "and its mix is another";
  visitor.up();
  EXPECT_EQ(visitor.model().swatch_held, -1);
  EXPECT_GT(visitor.experience.wake_at_ms(visitor.now_ms), visitor.now_ms + 1000.0);
}

TEST(Experience, ScriptedWeightsAreExact) {
  Visitor visitor = in_show();
  const Numbers far{0.1, 0.2, 0.7};
  visitor.send(ControlKind::weights, far);
  EXPECT_EQ(visitor.weights(), core::Weights::uniform(far));
  visitor.wait(1000.0);
  EXPECT_EQ(visitor.weights(), core::Weights::uniform(far));
  EXPECT_GT(ui::pad_weights(visitor.model().swatches, visitor.model().puck)[2], 0.5) << "the puck is near it";
  visitor.send(ControlKind::flake_lightness, {1, 0, 0});
  EXPECT_TRUE(visitor.model().sparkle_free);
  visitor.send(ControlKind::flake_white, {0.25});
  EXPECT_TRUE(visitor.model().hue_free);
  EXPECT_NEAR(visitor.model().hue, 0.75 / 3.0, 1e-12);
  EXPECT_EQ(visitor.weights().flake_white, 0.25);
  EXPECT_EQ(visitor.weights().base, far);
  // A visitor's hand takes over without a jump.
  const core::Weights before = visitor.weights();
  visitor.turn(0.01);
  EXPECT_LT(apart(visitor.weights().base, before.base), 0.05);
}

// ---- sliders and locks

TEST(Experience, TheSparkleSliderOpensItsLock) {
  Visitor visitor = in_show();
  visitor.down(visitor.on_slider(Widget::sparkle, 1.0));
  EXPECT_TRUE(visitor.model().sparkle_free);
  EXPECT_NEAR(visitor.model().sparkle, 1.0, 1e-9);
  visitor.wait(blend_ms + 20.0);
  // Paint 2 is the liveliest, 1 the calmest.
  EXPECT_EQ(visitor.weights().flake_lightness, (Numbers{0, 0, 1}));
  visitor.move(visitor.on_slider(Widget::sparkle, 0.0));
  EXPECT_EQ(visitor.weights().flake_lightness, (Numbers{0, 1, 0}));
  EXPECT_EQ(visitor.weights().base, (Numbers{1, 0, 0}));
  EXPECT_EQ(visitor.weights().flake_colour, (Numbers{1, 0, 0}));
  visitor.up();
  // Closed again it follows the pad, and nothing jumps.
  core::Weights last = visitor.weights();
  visitor.tap(Widget::sparkle_lock);
  EXPECT_FALSE(visitor.model().sparkle_free);
  for (int k = 0; k < 30; ++k) {
    EXPECT_LT(apart(visitor.weights().flake_lightness, last.flake_lightness), 0.2);
    last = visitor.weights();
    visitor.wait(Visitor::frame_ms);
  }
  EXPECT_EQ(visitor.weights().flake_lightness, (Numbers{1, 0, 0}));
}

TEST(Experience, TheHueSliderBeginsWithWhiteFlakes) {
  Visitor visitor = in_show();
  const auto at = [&](double position) {
    visitor.tap(visitor.on_slider(Widget::hue, position));
    visitor.wait(blend_ms + 20.0);
    return visitor.weights();
  };
  EXPECT_EQ(at(0.0).flake_white, 1.0);
  EXPECT_NEAR(at(1.0 / 6.0).flake_white, 0.5, 1e-9);
  EXPECT_EQ(visitor.weights().flake_colour, (Numbers{1, 0, 0}));
  EXPECT_NEAR(at(0.5).flake_white, 0.0, 1e-9);
  EXPECT_NEAR(visitor.weights().flake_colour[1], 0.5, 1e-9);
  EXPECT_NEAR(at(1.0).flake_colour[2], 1.0, 1e-9);
  EXPECT_EQ(visitor.weights().base, (Numbers{1, 0, 0}));
  visitor.tap(Widget::hue_lock);
  visitor.wait(blend_ms + 20.0);
  EXPECT_EQ(visitor.weights(), first_paint(3));
  EXPECT_NEAR(visitor.model().hue, 1.0 / 3.0, 1e-9) << "its knob shows where the pad is";
}

TEST(Experience, AnOpenLockHoldsItsGroupWhileThePuckMoves) {
  Visitor visitor = in_show();
  visitor.tap(Widget::sparkle_lock);
  EXPECT_TRUE(visitor.model().sparkle_free);
  visitor.wait(blend_ms + 20.0);
  EXPECT_EQ(visitor.weights().flake_lightness, (Numbers{1, 0, 0})) << "as it was";
  visitor.tap(Widget::swatch, 2);
  visitor.wait(glide_ms + 20.0);
  EXPECT_EQ(visitor.weights().base, (Numbers{0, 0, 1}));
  EXPECT_EQ(visitor.weights().flake_lightness, (Numbers{1, 0, 0}));
  EXPECT_EQ(visitor.weights().flake_colour, (Numbers{0, 0, 1}));
}

TEST(Experience, BeyondIsTheDealersToAllow) {
  EXPECT_FALSE(in_show().model().beyond_shown);
  ExperienceSettings settings = some_settings();
  settings.beyond_allowed = true;
  Visitor visitor = in_show(3, settings);
  ASSERT_TRUE(visitor.model().beyond_shown);
  visitor.tap(visitor.on_slider(Widget::beyond, 1.0));
  EXPECT_NEAR(visitor.weights().base[0], 1.4 - 0.4 / 3.0, 1e-9) << "the pack's limit, no more";
  EXPECT_NEAR(visitor.weights().flake_colour[1], -0.4 / 3.0, 1e-9);
  visitor.tap(visitor.on_slider(Widget::sparkle, 0.0));
  visitor.wait(blend_ms + 20.0);
  EXPECT_EQ(visitor.weights().flake_lightness, (Numbers{0, 1, 0})) << "a slider of its own knows no beyond";
  Visitor single = in_show(1, settings);
  EXPECT_FALSE(single.model().beyond_shown);
}

TEST(Experience, LightAndDimmer) {
  Visitor visitor = in_show();
  visitor.tap(Widget::light, 1);
  EXPECT_EQ(visitor.experience.state().light(), 1);
  EXPECT_EQ(visitor.model().light, 1);
  visitor.tap(visitor.on_slider(Widget::dimmer, 0.6));
  EXPECT_NEAR(visitor.experience.state().dimmer(), 0.6, 1e-9);
  // A finger that leaves a button elsewhere did not mean it.
  visitor.down(visitor.place_of(Widget::light, 2));
  EXPECT_EQ(visitor.model().pressed, Widget::light);
  visitor.move(visitor.middle());
  visitor.up();
  EXPECT_EQ(visitor.experience.state().light(), 1);
}

// ---- the car

TEST(Experience, TheCarTurnsOnAfterAFlickAndStopsUnderAFinger) {
  Visitor visitor = in_show();
  const ui::Place at = visitor.middle();
  visitor.drag(at, {at[0] + 300.0, at[1]}, 200.0);
  const glm::vec3 released = visitor.camera().eye_mm;
  visitor.up();
  visitor.wait(100.0);
  const glm::vec3 later = visitor.camera().eye_mm;
  EXPECT_GT(glm::length(later - released), 50.0f);
  visitor.wait(100.0);
  const glm::vec3 latest = visitor.camera().eye_mm;
  EXPECT_LT(glm::length(latest - later), glm::length(later - released)) << "slower and slower";
  visitor.down(at);
  const glm::vec3 caught = visitor.camera().eye_mm;
  visitor.wait(200.0);
  EXPECT_EQ(visitor.camera().eye_mm, caught);
  visitor.up();
  visitor.wait(5000.0);
  EXPECT_GT(visitor.experience.wake_at_ms(visitor.now_ms), visitor.now_ms + 1000.0) << "it ends";

  ExperienceSettings settings = some_settings();
  settings.reduced_motion = true;
  Visitor calm = in_show(3, settings);
  calm.drag(at, {at[0] + 300.0, at[1]}, 200.0);
  const glm::vec3 eye = calm.camera().eye_mm;
  calm.up();
  calm.wait(200.0);
  EXPECT_EQ(calm.camera().eye_mm, eye);
}

TEST(Experience, InertiaIsTheSameAtEveryFrameRate) {
  std::vector<glm::vec3> ends;
  for (const int frames : {3, 200}) {
    Visitor visitor = in_show();
    const ui::Place at = visitor.middle();
    visitor.drag(at, {at[0] + 300.0, at[1]}, 200.0);
    visitor.up();
    const double from = visitor.now_ms;
    for (int k = 1; k <= frames; ++k) visitor.experience.advance(from + 900.0 * k / frames, visitor.minute);
    ends.push_back(visitor.camera().eye_mm);
  }
  EXPECT_LT(glm::length(ends[0] - ends[1]), 0.1f);
}

TEST(Experience, TwoFingersGoDownToTheFlakesAndTwoTapsComeHome) {
  Visitor visitor = in_show();
  const auto pinch = [&](double from, double to) {
    const ui::Place at = visitor.middle();
    visitor.down({at[0] - from, at[1]}, 0);
    visitor.down({at[0] + from, at[1]}, 1);
    for (int k = 1; k <= 20; ++k) {
      visitor.wait(10.0);
      const double half = from + (to - from) * k / 20.0;
      visitor.move({at[0] - half, at[1]}, 0);
      visitor.move({at[0] + half, at[1]}, 1);
    }
    visitor.up(0);
    visitor.up(1);
  };
  for (int k = 0; k < 5; ++k) pinch(80.0, 320.0);
  EXPECT_LT(glm::length(visitor.camera().eye_mm - visitor.camera().target_mm), 160.0f);
  EXPECT_EQ(visitor.camera().target_mm, some_cameras()[2].target_mm);
  visitor.tap(visitor.middle());
  visitor.wait(100.0);
  visitor.tap(visitor.middle());
  visitor.wait(home_ms / 2.0);
  EXPECT_GT(glm::length(visitor.camera().eye_mm - some_cameras()[0].eye_mm), 10.0f) << "it eases";
  visitor.wait(home_ms);
  EXPECT_EQ(visitor.camera().eye_mm, some_cameras()[0].eye_mm);
  EXPECT_EQ(visitor.camera().vertical_fov_deg, some_cameras()[0].vertical_fov_deg);
}

// ---- cards

TEST(Experience, CompareIsHeld) {
  Visitor visitor = in_show();
  visitor.down(visitor.place_of(Widget::compare));
  ASSERT_TRUE(visitor.model().nearest);
  EXPECT_EQ(visitor.model().nearest->paint, 0);
  visitor.up();
  EXPECT_FALSE(visitor.model().nearest);
  visitor.down(visitor.place_of(Widget::compare));
  visitor.cancel();
  EXPECT_FALSE(visitor.model().nearest);
}

TEST(Experience, TakeHomeShowsACodeAndCloses) {
  for (int way = 0; way < 3; ++way) {
    Visitor visitor = in_show();
    visitor.tap(Widget::take_home);
    ASSERT_EQ(visitor.model().screen, Screen::take_home);
    EXPECT_EQ(visitor.model().mix_code, "LW1CODE");
    EXPECT_EQ(visitor.model().mix_name, "name in language 0");
    if (way == 0) visitor.tap(Widget::close);
    if (way == 1) visitor.tap({3.0, visitor.size()[1] / 2.0});
    if (way == 2) visitor.press();
    EXPECT_EQ(visitor.model().screen, Screen::show) << "way " << way;
    EXPECT_TRUE(visitor.model().mix_code.empty());
  }
}

TEST(Experience, ProvenanceIsOneTapAway) {
  Visitor visitor = in_show();
  visitor.tap(Widget::swatch_about, 2);
  EXPECT_EQ(visitor.model().screen, Screen::about);
  EXPECT_EQ(visitor.model().about_paint, 2);
  visitor.tap(Widget::close);
  EXPECT_EQ(visitor.model().screen, Screen::show);
}

TEST(Experience, NamesAreWorkedOutAtMostTenTimesASecond) {
  Visitor visitor = in_show();
  visitor.asked.names = 0;
  // The links of a moved visitor ask into the old one; a fresh one is asked here.
  ExperienceSettings settings = some_settings();
  settings.tour = false;
  Visitor fresh(3, settings);
  fresh.begin();
  fresh.asked.names = 0;
  fresh.drag(fresh.on_pad({0.2, 0.5}), fresh.on_pad({0.8, 0.5}), 1000.0);
  fresh.wait(300.0);
  EXPECT_GE(fresh.asked.names, 5);
  EXPECT_LE(fresh.asked.names, 13);
}

// ---- the knob alone

TEST(Experience, AKnobReachesEverything) {
  ExperienceSettings settings = some_settings();
  settings.beyond_allowed = true;
  settings.tour = false;
  Visitor visitor(3, settings);
  visitor.turn(12.0);
  visitor.wait(400.0);
  EXPECT_NEAR(visitor.model().puck[0], (visitor.model().swatches[0][0] + visitor.model().swatches[1][0]) / 2.0, 1e-9);
  visitor.turn(12.0);
  visitor.wait(400.0);
  EXPECT_EQ(visitor.weights().base, (Numbers{0, 1, 0}));
  visitor.turn(2.0 * detents_a_paint);
  visitor.wait(400.0);
  EXPECT_NEAR(visitor.weights().base[0], 1.0, 1e-12) << "round to the first";

  const std::vector<std::pair<Widget, int>> order{{Widget::sparkle, 0}, {Widget::hue, 0},     {Widget::beyond, 0},
                                                  {Widget::light, 0},   {Widget::dimmer, 0},  {Widget::car, 0},
                                                  {Widget::car, 1},     {Widget::compare, 0}, {Widget::take_home, 0}};
  for (const auto& [widget, index] : order) {
    visitor.press();
    EXPECT_EQ(visitor.model().focus, widget);
    EXPECT_EQ(visitor.model().focus_index, index);
    const core::Weights weights = visitor.weights();
    const packs::Camera camera = visitor.camera();
    const int light = visitor.experience.state().light();
    const double dimmer = visitor.experience.state().dimmer();
    visitor.turn(6.0);
    visitor.wait(400.0);
    const bool changed = weights != visitor.weights() || camera.eye_mm != visitor.camera().eye_mm ||
                         light != visitor.experience.state().light() || dimmer != visitor.experience.state().dimmer() ||
                         visitor.model().nearest || visitor.model().screen != Screen::show;
    // Three moods of two detents: six come round, so one step less.
    if (widget == Widget::light) visitor.turn(-2.0);
    EXPECT_TRUE(changed || widget == Widget::light) << static_cast<int>(widget);
  }
  EXPECT_EQ(visitor.experience.state().light(), 2);
  EXPECT_EQ(visitor.model().screen, Screen::take_home);
  visitor.press();
  EXPECT_EQ(visitor.model().screen, Screen::show);
  visitor.press();
  EXPECT_EQ(visitor.model().focus, Widget::pad) << "round to the first";
  // Held: the first paint and view, still in the visit.
  visitor.send(ControlKind::press, {0.0}, 0, "dial");
  visitor.wait(long_press_ms - 50.0);
  EXPECT_NE(visitor.experience.state().light(), 0);
  visitor.wait(1000.0);
  EXPECT_EQ(visitor.weights(), first_paint(3));
  EXPECT_EQ(visitor.camera().eye_mm, some_cameras()[0].eye_mm);
  EXPECT_EQ(visitor.experience.state().light(), 0);
  EXPECT_EQ(visitor.model().screen, Screen::show);
  visitor.send(ControlKind::release, {0.0}, 0, "dial");
  EXPECT_EQ(visitor.model().focus, Widget::pad) << "the release means nothing more";
}

TEST(Experience, ATouchHidesTheFocus) {
  Visitor visitor = in_show();
  visitor.turn(1.0);
  EXPECT_EQ(visitor.model().focus, Widget::pad);
  visitor.tap(visitor.middle());
  EXPECT_EQ(visitor.model().focus, Widget::none);
  visitor.press();
  EXPECT_EQ(visitor.model().focus, Widget::pad) << "shown first";
  visitor.press();
  EXPECT_EQ(visitor.model().focus, Widget::sparkle);
}

}  // namespace
}  // namespace lackwerk::kiosk
