// What a visitor does and what comes of it, transition by transition.
//
//   from        what                               to
//   attract     touch, turn, press, script         show (where the tour is)
//   show        tap on a swatch's i                about
//   show        take home                          take_home
//   about, take_home   close, beside the card, press of a knob   show
//   show        two fingers in the corners         pin
//   pin         the right digits                   dealer
//   pin, dealer close, press of a knob             show
//   all but attract    nobody for a while          countdown, then attract
//   countdown   touch, turn                        as before, and nothing else
//   attract     the night                          asleep; touch, turn: show
#include "kiosk/display/experience.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "input/source.hpp"
#include "kiosk/display/ui/paint_pad.hpp"
#include "tests/unit/kiosk_visitor.hpp"

namespace lackwerk::kiosk {
namespace {

using input::ControlKind;
using ui::Screen;
using ui::Widget;
using Numbers = std::vector<double>;

double apart(const Numbers& a, const Numbers& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

/// A visitor who has come to the show, with the puck and the view as they are at first.
Visitor in_show(std::size_t paints = 3, ExperienceSettings settings = some_settings()) {
  settings.tour = false;
  Visitor visitor(paints, settings);
  visitor.begin();
  EXPECT_EQ(visitor.model().screen, Screen::show);
  return visitor;
}

// ---- visits

TEST(Experience, StartsOnTheAttractScreenWithTheFirstPaint) {
  const Visitor visitor;
  EXPECT_EQ(visitor.model().screen, Screen::attract);
  EXPECT_EQ(visitor.weights(), first_paint(3));
  EXPECT_EQ(visitor.camera().name, "hero");
  EXPECT_FALSE(visitor.model().asleep);
}

TEST(Experience, EverythingBeginsAVisit) {
  {
    Visitor visitor;
    visitor.down(visitor.middle());
    EXPECT_EQ(visitor.model().screen, Screen::show);
    EXPECT_EQ(visitor.model().pressed, Widget::car);
    EXPECT_TRUE(visitor.model().hint);
  }
  {
    Visitor visitor;
    visitor.turn(1.0);
    EXPECT_EQ(visitor.model().screen, Screen::show);
    EXPECT_EQ(visitor.model().focus, Widget::pad);
    EXPECT_NE(visitor.weights(), first_paint(3)) << "the first turn turns";
  }
  {
    Visitor visitor;
    visitor.press();
    EXPECT_EQ(visitor.model().screen, Screen::show);
    EXPECT_EQ(visitor.model().focus, Widget::pad) << "and does not go to the next one";
  }
  {
    Visitor visitor;
    visitor.send(ControlKind::weights, {0, 1, 0});
    EXPECT_EQ(visitor.model().screen, Screen::show);
    EXPECT_EQ(visitor.weights().base, (Numbers{0, 1, 0}));
  }
}

TEST(Experience, TheTourGoesOverIntoTheVisitWithoutAJump) {
  Visitor visitor;
  visitor.wait(47'000.0);
  const core::Weights mix = visitor.weights();
  const glm::vec3 eye = visitor.camera().eye_mm;
  const int light = visitor.experience.state().light();
  EXPECT_NE(mix, first_paint(3)) << "it plays";
  visitor.down(visitor.middle());
  EXPECT_EQ(visitor.model().screen, Screen::show);
  EXPECT_LE(apart(visitor.weights().base, mix.base), 1e-12);
  EXPECT_EQ(visitor.camera().eye_mm, eye);
  EXPECT_EQ(visitor.experience.state().light(), light);
  EXPECT_LE(apart(ui::pad_weights(visitor.model().swatches, visitor.model().puck), mix.base), 1e-12)
      << "the puck shows the mix";
  visitor.wait(3000.0);
  EXPECT_EQ(visitor.camera().eye_mm, eye) << "it has stopped";
}

TEST(Experience, TheTourNeedsEveryFrameAndAStillScreenNone) {
  Visitor visitor;
  EXPECT_EQ(visitor.experience.wake_at_ms(visitor.now_ms), visitor.now_ms);
  Visitor still = in_show();
  still.wait(2000.0);
  EXPECT_GT(still.experience.wake_at_ms(still.now_ms), still.now_ms + 5000.0);
  ExperienceSettings settings = some_settings();
  settings.tour = false;
  Visitor nobody(3, settings);
  EXPECT_EQ(nobody.experience.wake_at_ms(nobody.now_ms), input::never_ms);
  EXPECT_FALSE(nobody.experience.advance(nobody.now_ms + 1e6, 12 * 60).any());
}

TEST(Experience, ReducedMotionMovesMixesOnly) {
  ExperienceSettings settings = some_settings();
  settings.reduced_motion = true;
  Visitor visitor(3, settings);
  visitor.wait(60'000.0);
  EXPECT_EQ(visitor.camera().eye_mm, some_cameras()[0].eye_mm);
  EXPECT_NE(visitor.weights(), first_paint(3));
}

// ---- idle, countdown, reset

TEST(Experience, NobodyForAWhileResetsEverything) {
  Visitor visitor = in_show();
  visitor.drag(visitor.on_pad({0.5, 0.5}), visitor.on_pad({0.4, 0.6}));
  visitor.up();
  visitor.tap(visitor.on_slider(Widget::sparkle, 0.3));
  visitor.tap(visitor.on_slider(Widget::hue, 0.05));
  visitor.tap(visitor.on_slider(Widget::dimmer, 0.7));
  visitor.tap(Widget::light, 2);
  visitor.drag(visitor.middle(), {visitor.middle()[0] + 200.0, visitor.middle()[1]});
  visitor.up();
  const double last_ms = visitor.now_ms;
  visitor.wait(1e3 * some_settings().idle_s - 10.0);
  EXPECT_FALSE(visitor.model().countdown_s);
  visitor.wait(20.0);
  EXPECT_EQ(visitor.model().countdown_s, std::optional<double>(5.0));
  visitor.wait(1000.0);
  EXPECT_EQ(visitor.model().countdown_s, std::optional<double>(4.0));
  EXPECT_LE(visitor.experience.wake_at_ms(visitor.now_ms), visitor.now_ms + 1000.0) << "the next second shows";
  EXPECT_EQ(visitor.model().screen, Screen::show);
  visitor.wait(last_ms + 25'000.0 - visitor.now_ms + 1.0);
  EXPECT_EQ(visitor.model().screen, Screen::attract);
  EXPECT_FALSE(visitor.model().countdown_s);
  EXPECT_EQ(visitor.weights(), first_paint(3));
  EXPECT_EQ(visitor.camera().eye_mm, some_cameras()[0].eye_mm);
  EXPECT_EQ(visitor.experience.state().light(), 0);
  EXPECT_EQ(visitor.experience.state().dimmer(), 0.0);
  EXPECT_FALSE(visitor.model().sparkle_free || visitor.model().hue_free);
  EXPECT_EQ(visitor.model().swatches, ui::first_places(3));
}

TEST(Experience, ATouchOrTurnEndsTheCountdownAndDoesNothingElse) {
  for (const bool by_knob : {false, true}) {
    Visitor visitor = in_show();
    const ui::Place swatch = visitor.place_of(Widget::swatch, 1);
    visitor.wait(21'000.0);
    ASSERT_TRUE(visitor.model().countdown_s);
    const core::Weights mix = visitor.weights();
    if (by_knob)
      visitor.turn(5.0);
    else
      visitor.tap(swatch);
    visitor.wait(500.0);
    EXPECT_FALSE(visitor.model().countdown_s);
    EXPECT_EQ(visitor.model().screen, Screen::show);
    EXPECT_EQ(visitor.weights(), mix);
    visitor.wait(15'000.0);
    EXPECT_FALSE(visitor.model().countdown_s) << "a whole while again";
  }
}

TEST(Experience, AFingerThatNeverLeavesIsNobody) {
  Visitor visitor = in_show();
  visitor.down(visitor.place_of(Widget::compare));
  EXPECT_TRUE(visitor.model().nearest);
  visitor.wait(26'000.0);
  EXPECT_EQ(visitor.model().screen, Screen::attract);
  EXPECT_FALSE(visitor.model().nearest);
  visitor.move({500.0, 500.0});
  EXPECT_EQ(visitor.model().screen, Screen::attract) << "its movement is nobody's";
  visitor.up();
  EXPECT_EQ(visitor.model().screen, Screen::attract);
}

// ---- night

TEST(Experience, TheNightTurnsThePanelOffButForVisitors) {
  ExperienceSettings settings = some_settings();
  settings.night = {22 * 60, 6 * 60};
  Visitor visitor(3, settings);
  visitor.minute = 21 * 60 + 59;
  visitor.wait(100.0);
  EXPECT_FALSE(visitor.model().asleep);
  visitor.minute = 22 * 60;
  visitor.wait(100.0);
  EXPECT_TRUE(visitor.model().asleep);
  EXPECT_EQ(visitor.experience.wake_at_ms(visitor.now_ms), visitor.now_ms + 60'000.0) << "once a minute";
  // One visit.
  visitor.tap(visitor.middle());
  EXPECT_FALSE(visitor.model().asleep);
  EXPECT_EQ(visitor.model().screen, Screen::show);
  visitor.wait(10'000.0);
  EXPECT_FALSE(visitor.model().asleep);
  visitor.wait(20'000.0);
  EXPECT_EQ(visitor.model().screen, Screen::attract);
  EXPECT_TRUE(visitor.model().asleep);
  visitor.minute = 6 * 60;
  visitor.wait(100.0);
  EXPECT_FALSE(visitor.model().asleep);
}

TEST(Experience, NightHoursGoOverMidnight) {
  EXPECT_FALSE((NightHours{0, 0}.covers(0)));
  EXPECT_FALSE((NightHours{600, 600}.covers(600)));
  const NightHours late{22 * 60, 6 * 60}, noon{12 * 60, 13 * 60};
  for (const int minute : {22 * 60, 1439, 0, 6 * 60 - 1}) EXPECT_TRUE(late.covers(minute));
  for (const int minute : {6 * 60, 12 * 60, 22 * 60 - 1}) EXPECT_FALSE(late.covers(minute));
  EXPECT_TRUE(noon.covers(12 * 60));
  EXPECT_FALSE(noon.covers(13 * 60));
}

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

// ---- the dealer

TEST(Experience, TheDealersGestureNeedsBothCornersAndPatience) {
  Visitor visitor = in_show();
  visitor.hold_corners(corners_ms - 100.0);
  EXPECT_EQ(visitor.model().screen, Screen::show);
  visitor.wait(200.0);
  EXPECT_EQ(visitor.model().screen, Screen::pin);
  visitor.up(7);
  visitor.up(8);
  EXPECT_EQ(visitor.model().screen, Screen::pin);
  visitor.tap(Widget::close);
  EXPECT_EQ(visitor.model().screen, Screen::show);

  visitor.down({5.0, 5.0}, 7);
  visitor.wait(4000.0);
  visitor.up(7);
  EXPECT_EQ(visitor.model().screen, Screen::show) << "one corner";
  visitor.hold_corners(1500.0);
  visitor.move({300.0, 300.0}, 7);
  visitor.wait(4000.0);
  EXPECT_EQ(visitor.model().screen, Screen::show) << "left too early";

  ExperienceSettings settings = some_settings();
  settings.has_pin = false;
  Visitor nobody = in_show(3, settings);
  nobody.hold_corners(5000.0);
  EXPECT_EQ(nobody.model().screen, Screen::show) << "no PIN, no dealer's screen";
}

TEST(Experience, ThePinOpensTheDealersScreen) {
  Visitor visitor = in_show();
  visitor.open_pin();
  visitor.tap(Widget::pin_key, 2);
  visitor.tap(Widget::pin_key, 5);
  EXPECT_EQ(visitor.model().pin.digits, 2);
  visitor.tap(Widget::pin_key, PinPad::delete_key);
  EXPECT_EQ(visitor.model().pin.digits, 1);
  visitor.type("580");
  EXPECT_EQ(visitor.model().screen, Screen::dealer);
  EXPECT_EQ(visitor.model().dealer.page, ui::DealerPage::packs);
  visitor.tap(Widget::page, static_cast<int>(ui::DealerPage::options));
  EXPECT_EQ(visitor.model().dealer.page, ui::DealerPage::options);
  visitor.tap(Widget::close);
  EXPECT_EQ(visitor.model().screen, Screen::show);
}

TEST(Experience, AttemptsOutliveTheScreen) {
  Visitor visitor = in_show();
  for (int k = 0; k < pin_attempts; ++k) {
    visitor.open_pin();
    visitor.type("1234");
    ASSERT_EQ(visitor.model().screen, Screen::pin);
    EXPECT_TRUE(visitor.model().pin.refused);
    if (k + 1 == pin_attempts) break;
    EXPECT_EQ(visitor.model().pin.attempts_left, pin_attempts - 1 - k);
    visitor.tap(Widget::close);
  }
  EXPECT_EQ(visitor.model().pin.locked_s, first_lock_s);
  visitor.type("2580");
  EXPECT_EQ(visitor.model().screen, Screen::pin) << "locked even for the right one";
  visitor.tap(Widget::close);
  for (int k = 0; k < 7; ++k) {
    visitor.wait(9000.0);
    visitor.tap(visitor.middle());
  }
  visitor.open_pin();
  EXPECT_EQ(visitor.model().pin.locked_s, 0.0);
  visitor.type("2580");
  EXPECT_EQ(visitor.model().screen, Screen::dealer);
}

TEST(Experience, DealersChoicesComeOnce) {
  Visitor visitor = in_show();
  visitor.open_dealer();
  ASSERT_EQ(visitor.model().screen, Screen::dealer);
  EXPECT_FALSE(visitor.experience.take_choices());
  visitor.tap(Widget::page, static_cast<int>(ui::DealerPage::options));
  visitor.tap(Widget::action, static_cast<int>(ui::OptionAction::beyond));
  visitor.tap(Widget::action, static_cast<int>(ui::OptionAction::language));
  visitor.tap(Widget::action, static_cast<int>(ui::OptionAction::reduced_motion));
  EXPECT_EQ(visitor.model().language, ui::Language::german);
  visitor.tap(Widget::page, static_cast<int>(ui::DealerPage::screen));
  visitor.tap(Widget::step_down, static_cast<int>(ui::ScreenValue::brightness));
  visitor.tap(Widget::step_down, static_cast<int>(ui::ScreenValue::brightness));
  const auto choices = visitor.experience.take_choices();
  ASSERT_TRUE(choices);
  EXPECT_TRUE(choices->beyond_allowed);
  EXPECT_TRUE(choices->reduced_motion);
  EXPECT_EQ(choices->language, ui::Language::german);
  EXPECT_NEAR(choices->brightness, 0.9, 1e-12);
  EXPECT_FALSE(choices->calibration);
  EXPECT_FALSE(visitor.experience.take_choices());
  for (int k = 0; k < 30; ++k) visitor.tap(Widget::step_down, 0);
  EXPECT_NEAR(visitor.model().dealer.brightness, least_brightness, 1e-12);
  visitor.tap(Widget::close);
  EXPECT_TRUE(visitor.model().beyond_shown);
}

TEST(Experience, AnyTouchEndsTheTestPattern) {
  Visitor visitor = in_show();
  visitor.open_dealer();
  visitor.tap(Widget::page, static_cast<int>(ui::DealerPage::screen));
  visitor.tap(Widget::action, static_cast<int>(ui::ScreenAction::test_pattern));
  EXPECT_TRUE(visitor.model().dealer.test_pattern);
  visitor.tap({10.0, 700.0});
  EXPECT_FALSE(visitor.model().dealer.test_pattern);
  EXPECT_EQ(visitor.model().screen, Screen::dealer);
}

TEST(Experience, CalibrationMendsAPanel) {
  for (const Rotation rotation : {Rotation::none, Rotation::quarter}) {
    Visitor visitor = in_show();
    visitor.rotation = rotation;
    visitor.experience.set_surface(rotation, Visitor::panel_px, Visitor::dpi);
    visitor.open_dealer();
    ASSERT_EQ(visitor.model().screen, Screen::dealer);
    visitor.tap(Widget::page, static_cast<int>(ui::DealerPage::screen));
    visitor.tap(Widget::action, static_cast<int>(ui::ScreenAction::calibrate));
    // Touches are reported scaled and shifted: panel = (reported - shift) / scale.
    for (int step = 0; step < ui::calibration_steps; ++step) {
      EXPECT_EQ(visitor.model().dealer.calibration_step, step);
      const ui::Place cross = ui::calibration_cross(visitor.experience.surface(), step);
      const Point meant = panel_point(rotation, {cross[0] / visitor.size()[0], cross[1] / visitor.size()[1]});
      visitor.send(ControlKind::touch_down, {0.9 * meant[0] + 0.04, 1.05 * meant[1] - 0.02});
      visitor.wait(80.0);
      visitor.up();
    }
    EXPECT_EQ(visitor.model().dealer.calibration_step, -1);
    EXPECT_FALSE(visitor.model().dealer.calibration_failed);
    const auto choices = visitor.experience.take_choices();
    ASSERT_TRUE(choices && choices->calibration);
    const Point mended = calibrated(*choices->calibration, {0.9 * 0.3 + 0.04, 1.05 * 0.8 - 0.02});
    EXPECT_NEAR(mended[0], 0.3, 1e-9);
    EXPECT_NEAR(mended[1], 0.8, 1e-9);
  }
}

TEST(Experience, ACalibrationThatMissesIsRefused) {
  Visitor visitor = in_show();
  visitor.open_dealer();
  visitor.tap(Widget::page, static_cast<int>(ui::DealerPage::screen));
  visitor.tap(Widget::action, static_cast<int>(ui::ScreenAction::calibrate));
  for (int step = 0; step < ui::calibration_steps; ++step)
    visitor.tap({0.5 * visitor.size()[0], 0.5 * visitor.size()[1]});
  EXPECT_TRUE(visitor.model().dealer.calibration_failed);
  EXPECT_FALSE(visitor.experience.take_choices());
}

TEST(Experience, TheDealersScreenClosesByItselfToo) {
  Visitor visitor = in_show();
  visitor.open_dealer();
  visitor.tap(Widget::page, static_cast<int>(ui::DealerPage::screen));
  visitor.tap(Widget::action, static_cast<int>(ui::ScreenAction::test_pattern));
  visitor.wait(26'000.0);
  EXPECT_EQ(visitor.model().screen, Screen::attract);
  EXPECT_FALSE(visitor.model().dealer.test_pattern);
}

// ---- the house around it

TEST(Experience, ALockOutlivesARestart) {
  double wall_s = 1.7e9;
  ExperienceLinks links = some_links();
  links.wall_s = [&] { return wall_s; };
  ExperienceSettings settings = some_settings();
  settings.idle_s = 3600.0;
  Visitor first(3, settings, links);
  first.begin();
  first.open_pin();
  EXPECT_FALSE(first.experience.take_choices());
  for (int k = 0; k < pin_attempts; ++k) {
    first.type("0000");
    const auto kept = first.experience.take_choices();
    ASSERT_TRUE(kept) << "each attempt is kept";
    EXPECT_EQ(kept->pin.wrong, (k + 1) % pin_attempts);
    settings.pin = kept->pin;
  }
  EXPECT_EQ(settings.pin.locked_until_s, wall_s + first_lock_s);
  wall_s += 20.0;
  Visitor second(3, settings, links);
  second.begin();
  second.open_pin();
  EXPECT_NEAR(second.model().pin.locked_s, first_lock_s - 20.0, 6.0) << "less the dealer's gesture";
  EXPECT_GT(second.model().pin.locked_s, 0.0);
  second.type("2580");
  EXPECT_EQ(second.model().screen, ui::Screen::pin);
  second.wait(1e3 * first_lock_s);
  second.type("2580");
  EXPECT_EQ(second.model().screen, ui::Screen::dealer);
  const auto kept = second.experience.take_choices();
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->pin, PinRecord{});
}

TEST(Experience, MoodsFadeAndThenNothingMoves) {
  ExperienceSettings settings = some_settings();
  settings.tour = false;
  settings.idle_s = 3600.0;
  Visitor visitor(3, settings);
  visitor.begin();
  visitor.wait(2000.0);
  const auto share = [&](std::size_t mood) { return visitor.experience.state().light_shares()[mood]; };
  ASSERT_EQ(share(0), 1.0);
  visitor.tap(ui::Widget::light, 1);
  EXPECT_EQ(visitor.experience.state().light(), 1) << "chosen at once";
  double before = share(1);
  EXPECT_LT(before, 0.1) << "shown little by little";
  for (double ms = 0.0; ms < light_fade_ms / 2.0; ms += 50.0) {
    visitor.all = {};
    visitor.wait(50.0);
    EXPECT_TRUE(visitor.all.view);
    EXPECT_GT(share(1), before);
    EXPECT_NEAR(share(0) + share(1) + share(2), 1.0, 1e-12);
    before = share(1);
  }
  // Another one on the way: on from what is shown.
  visitor.tap(ui::Widget::light, 2);
  EXPECT_GT(share(1), 0.3);
  visitor.wait(light_fade_ms);
  EXPECT_EQ(share(2), 1.0);
  visitor.wait(1000.0);
  visitor.all = {};
  visitor.wait(1000.0);
  EXPECT_FALSE(visitor.all.view);
  EXPECT_GT(visitor.experience.wake_at_ms(visitor.now_ms), visitor.now_ms + 1000.0) << "nothing moves any more";

  settings.reduced_motion = true;
  Visitor still(3, settings);
  still.begin();
  still.tap(ui::Widget::light, 1);
  EXPECT_EQ(still.experience.state().light_shares()[1], 1.0);
}

TEST(Experience, TheCountdownSaysWhatItCountsFrom) {
  Visitor visitor;
  visitor.begin();
  visitor.wait(1e3 * some_settings().idle_s);
  ASSERT_TRUE(visitor.model().countdown_s);
  EXPECT_EQ(visitor.model().countdown_whole_s, some_settings().countdown_s);
  EXPECT_LE(*visitor.model().countdown_s, visitor.model().countdown_whole_s);
}

ui::Toast some_toast() {
  ui::Toast toast;
  toast.stored = {"demo.spring"};
  return toast;
}

TEST(Experience, ANoticeGoesByItselfAndIsNoInput) {
  ExperienceSettings settings = some_settings();
  settings.tour = false;
  Visitor visitor(3, settings);
  EXPECT_TRUE(visitor.experience.tell(some_toast(), visitor.now_ms).interface);
  EXPECT_EQ(visitor.model().screen, ui::Screen::attract);
  EXPECT_NEAR(visitor.experience.wake_at_ms(visitor.now_ms), visitor.now_ms + toast_ms, 1e-6) << "sleeps until then";
  visitor.wait(toast_ms - 50.0);
  EXPECT_EQ(visitor.model().toast, some_toast());
  visitor.wait(100.0);
  EXPECT_FALSE(visitor.model().toast);
  EXPECT_EQ(visitor.experience.wake_at_ms(visitor.now_ms), input::never_ms);

  // A newer one takes its place and has its own time.
  visitor.experience.tell(some_toast(), visitor.now_ms);
  visitor.wait(toast_ms / 2.0);
  ui::Toast refused;
  refused.refused = 1;
  visitor.experience.tell(refused, visitor.now_ms);
  visitor.wait(toast_ms - 50.0);
  EXPECT_EQ(visitor.model().toast, refused);
}

TEST(Experience, ANoticeOutlivesAResetAndWaitsForTheMorning) {
  Visitor visitor;
  visitor.begin();
  const double ends_ms = 1e3 * (some_settings().idle_s + some_settings().countdown_s);
  visitor.wait(ends_ms - 2000.0);
  visitor.experience.tell(some_toast(), visitor.now_ms);
  visitor.wait(3000.0);
  EXPECT_EQ(visitor.model().screen, ui::Screen::attract);
  EXPECT_TRUE(visitor.model().toast);

  ExperienceSettings settings = some_settings();
  settings.night = {22 * 60, 6 * 60};
  Visitor late(3, settings);
  late.minute = 23 * 60;
  late.wait(120e3);
  ASSERT_TRUE(late.model().asleep);
  late.experience.tell(some_toast(), late.now_ms);
  late.wait(1e6);
  EXPECT_TRUE(late.model().asleep) << "nobody is woken";
  EXPECT_TRUE(late.model().toast);
  late.minute = 7 * 60;
  late.wait(61e3 - toast_ms);
  late.wait(10.0 * toast_ms);
  EXPECT_FALSE(late.model().asleep);
  EXPECT_FALSE(late.model().toast);
}

TEST(Experience, AnotherPackGoesOnWithItsFirstPaint) {
  Visitor visitor = in_show();
  visitor.tap(Widget::swatch, 2);
  visitor.wait(400.0);
  visitor.tap(Widget::swatch_about, 2);
  visitor.experience.set_content(some_content(2), some_cameras());
  EXPECT_EQ(visitor.model().screen, Screen::show);
  EXPECT_EQ(visitor.weights(), first_paint(2));
  EXPECT_EQ(visitor.model().swatches.size(), 2u);
  visitor.tap(Widget::swatch, 1);
  visitor.wait(400.0);
  EXPECT_EQ(visitor.weights().base, (Numbers{0, 1}));
}

TEST(Experience, AnotherMountingForgetsFingers) {
  Visitor visitor = in_show();
  visitor.down(visitor.on_pad({0.5, 0.5}));
  visitor.experience.set_surface(Rotation::none, Visitor::panel_px, Visitor::dpi);
  EXPECT_TRUE(visitor.model().puck_held) << "the same again";
  visitor.experience.set_surface(Rotation::half, Visitor::panel_px, Visitor::dpi);
  EXPECT_FALSE(visitor.model().puck_held);
  const core::Weights mix = visitor.weights();
  visitor.move({10.0, 10.0});
  EXPECT_EQ(visitor.weights(), mix);
}

TEST(Experience, NonsenseIsIgnored) {
  Visitor visitor = in_show();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const core::Weights mix = visitor.weights();
  const glm::vec3 eye = visitor.camera().eye_mm;
  for (const input::Control& event :
       {input::Control{ControlKind::touch_down, {nan, 0.5}, {}, 0, 1},
        input::Control{ControlKind::touch_down, {}, {}, 0, 1},
        input::Control{ControlKind::touch_move, {0.1, 0.1}, {}, 9, 1},
        input::Control{ControlKind::touch_up, {}, {}, 9, 1}, input::Control{ControlKind::turn, {nan}, {}, 0, 1},
        input::Control{ControlKind::turn, {}, {}, 0, 1}, input::Control{ControlKind::press, {}, {}, 0, 1},
        input::Control{ControlKind::release, {0.0}, "who", 0, 1},
        input::Control{ControlKind::weights, {0.5, 0.5}, {}, 0, 1}, input::Control{ControlKind::light, {7.0}, {}, 0, 1},
        input::Control{ControlKind::dimmer, {nan}, {}, 0, 1}, input::Control{ControlKind::camera, {}, "nowhere", 0, 1}})
    visitor.experience.take(event, visitor.now_ms);
  visitor.experience.take({ControlKind::touch_up, {}, {}, 0, 0}, nan);
  visitor.experience.advance(nan, 12 * 60);
  visitor.experience.advance(visitor.now_ms - 1e9, -5);
  EXPECT_EQ(visitor.weights(), mix);
  EXPECT_EQ(visitor.camera().eye_mm, eye);
  // More fingers than a panel has.
  for (int contact = 0; contact < 200; ++contact) visitor.down(visitor.on_pad({0.5, 0.55}), contact);
  for (int contact = 0; contact < 200; ++contact) visitor.up(contact);
  EXPECT_EQ(visitor.model().pressed, Widget::none);
  EXPECT_EQ(visitor.model().screen, Screen::show);
  EXPECT_FALSE(visitor.model().countdown_s);
  visitor.tap(Widget::swatch, 1);
  visitor.wait(400.0);
  EXPECT_EQ(visitor.weights().base, (Numbers{0, 1, 0})) << "and it goes on";
}

TEST(Experience, OnePaintHasAKioskToo) {
  Visitor visitor = in_show(1);
  visitor.turn(5.0);
  visitor.wait(400.0);
  EXPECT_EQ(visitor.weights().base, (Numbers{1}));
  visitor.tap(visitor.middle());
  EXPECT_EQ(visitor.model().screen, Screen::show);
}

}  // namespace
}  // namespace lackwerk::kiosk
