// Visits and time: what a visitor does and what comes of it, transition by transition. Controls and the dealer have
// files of their own.
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

#include <limits>
#include <optional>
#include <vector>

#include "input/source.hpp"
#include "kiosk/display/ui/paint_pad.hpp"
#include "tests/unit/kiosk_visitor.hpp"

namespace lackwerk::kiosk {
namespace {

using input::ControlKind;
using ui::Screen;
using ui::Widget;
using Numbers = std::vector<double>;

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

// ---- the house around it

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
