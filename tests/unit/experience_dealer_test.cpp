// The dealer's way in and what can be done there: gesture, PIN and its locks, choices, test pattern, calibration.
#include "kiosk/display/experience.hpp"

#include <gtest/gtest.h>

#include "kiosk/display/dealer_desk.hpp"
#include "kiosk/display/pin_pad.hpp"
#include "tests/unit/kiosk_visitor.hpp"

namespace lackwerk::kiosk {
namespace {

using input::ControlKind;
using ui::Screen;
using ui::Widget;

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

}  // namespace
}  // namespace lackwerk::kiosk
