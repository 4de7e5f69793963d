// Scans on the kiosk: time by finger, knob and by itself; what is about paints is left out.
#include <gtest/gtest.h>

#include <set>

#include "kiosk/display/growth_loop.hpp"
#include "kiosk/display/scan_picture.hpp"
#include "tests/unit/kiosk_visitor.hpp"
#include "tests/unit/scan_samples.hpp"

namespace lackwerk::kiosk {
namespace {

using input::ControlKind;
using ui::Screen;
using ui::Widget;

ui::Content scans() { return ui::ui_content(lackwerk::testing::SampleScans().pack()); }

/// Somebody before scans.
struct ScanVisitor : Visitor {
  explicit ScanVisitor(ExperienceSettings settings = some_settings()) : Visitor(1, settings, bare()) {
    experience.set_content(scans(), {some_cameras()[0]});
  }
  static ExperienceLinks bare() {
    ExperienceLinks links;
    links.check_pin = [](const std::string& pin) { return pin == "2580"; };
    return links;
  }
  [[nodiscard]] double time() const { return experience.state().time(); }
};

TEST(ScanContent, SaysWhatGrowsAndWhen) {
  const ui::Content content = scans();
  ASSERT_TRUE(content.scans);
  EXPECT_EQ(content.scans->name, "Tomato");
  EXPECT_EQ(content.scans->times, (std::vector<double>{5.0, 6.0, 8.0}));
  EXPECT_DOUBLE_EQ(content.scans->time_at(0.5), 6.5);
  EXPECT_EQ(content.paints.size(), 1u);
  EXPECT_FALSE(content.has_flakes);
}

TEST(ExperienceScans, NothingAboutPaintsIsThere) {
  ScanVisitor visitor;
  visitor.begin();
  std::set<Widget> there;
  for (const ui::Item& item : visitor.items()) there.insert(item.widget);
  EXPECT_EQ(there, (std::set<Widget>{Widget::time}));
  for (int k = 0; k < 12; ++k) {
    visitor.turn(1.0);
    EXPECT_TRUE(visitor.model().focus == Widget::time || visitor.model().focus == Widget::car);
    visitor.press();
  }
  EXPECT_EQ(visitor.model().screen, Screen::show);
}

TEST(ExperienceScans, TheSliderIsTime) {
  ScanVisitor visitor;
  visitor.begin();
  visitor.down(visitor.on_slider(Widget::time, 0.25));
  EXPECT_NEAR(visitor.time(), 0.25, 1e-9);
  EXPECT_NEAR(visitor.model().time, 0.25, 1e-9);
  visitor.move(visitor.on_slider(Widget::time, 0.75));
  EXPECT_NEAR(visitor.time(), 0.75, 1e-9);
  visitor.up();
  visitor.wait(3000.0);
  EXPECT_NEAR(visitor.time(), 0.75, 1e-9) << "it stays where it was put";
  EXPECT_GT(visitor.experience.wake_at_ms(visitor.now_ms), visitor.now_ms + 1000.0) << "and nothing is drawn";
  EXPECT_FALSE(visitor.model().hint) << "whoever drags needs no hint";
}

TEST(ExperienceScans, TheKnobTurnsTimeFirst) {
  ScanVisitor visitor;
  visitor.press();
  ASSERT_EQ(visitor.model().focus, Widget::time);
  const double before = visitor.time();
  visitor.turn(-12.0);
  EXPECT_NEAR(visitor.time(), before - 12.0 / detents_a_series, 1e-9);
  visitor.turn(-1000.0);
  EXPECT_EQ(visitor.time(), 0.0);
  visitor.turn(1000.0);
  EXPECT_EQ(visitor.time(), 1.0);
  // Held: back to the newest, without a jump.
  visitor.turn(-24.0);
  const double held = visitor.time();
  visitor.send(ControlKind::press, {0.0}, 0, "dial");
  double last = held, largest = 0.0;
  for (int k = 0; k < 200; ++k) {
    visitor.wait(16.0);
    largest = std::max(largest, std::abs(visitor.time() - last));
    last = visitor.time();
  }
  EXPECT_EQ(last, 1.0);
  EXPECT_LT(largest, 0.05);
}

TEST(ExperienceScans, AttractGrowsAndVisitorsBeginWhereItIs) {
  ScanVisitor visitor;
  double least = 1.0, most = 0.0, last = visitor.time(), jump = 0.0;
  for (int k = 0; k < 2400; ++k) {
    visitor.wait(16.0);
    least = std::min(least, visitor.time());
    most = std::max(most, visitor.time());
    jump = std::max(jump, std::abs(visitor.time() - last));
    last = visitor.time();
  }
  EXPECT_EQ(least, 0.0);
  EXPECT_EQ(most, 1.0);
  // The fastest of all: back in 6 s, one and a half times as fast in the middle.
  EXPECT_LT(jump, 1.5 * 0.033 / shrinking_s);
  visitor.wait(3210.0);
  const double now = visitor.time();
  visitor.down(visitor.middle());
  EXPECT_EQ(visitor.model().screen, Screen::show);
  EXPECT_NEAR(visitor.time(), now, 1e-12);
  EXPECT_NEAR(visitor.model().time, now, 1e-12) << "the slider shows it";
}

TEST(ExperienceScans, NobodyForAWhileGoesOnGrowingWithoutAJump) {
  ScanVisitor visitor;
  visitor.begin();
  visitor.tap(visitor.on_slider(Widget::time, 0.4));
  double last = visitor.time(), jump = 0.0;
  for (int k = 0; k < 30'000 && visitor.model().screen == Screen::show; ++k) visitor.wait(16.0);
  EXPECT_EQ(visitor.model().screen, Screen::attract);
  for (int k = 0; k < 300; ++k) {
    visitor.wait(16.0);
    jump = std::max(jump, std::abs(visitor.time() - last));
    last = visitor.time();
  }
  EXPECT_LT(jump, 0.02);
  EXPECT_GT(last, 0.4);
}

TEST(ExperienceScans, ScriptsAndSwapsOfPacks) {
  ScanVisitor visitor;
  visitor.begin();
  visitor.send(ControlKind::time, {0.3});
  EXPECT_EQ(visitor.time(), 0.3);
  for (const double wrong : {-0.1, 1.1, std::nan("")}) visitor.send(ControlKind::time, {wrong});
  visitor.send(ControlKind::time, {});
  EXPECT_EQ(visitor.time(), 0.3);
  // Paints come, and all that is about them; then scans again, at their newest.
  visitor.experience.set_links(some_links(&visitor.asked));
  visitor.experience.set_content(some_content(3), some_cameras());
  EXPECT_TRUE(ui::find_item(visitor.items(), Widget::pad));
  EXPECT_FALSE(ui::find_item(visitor.items(), Widget::time));
  visitor.experience.set_links(ScanVisitor::bare());
  visitor.experience.set_content(scans(), {some_cameras()[0]});
  EXPECT_FALSE(ui::find_item(visitor.items(), Widget::pad));
  EXPECT_EQ(visitor.time(), 1.0);
  visitor.open_dealer();
  EXPECT_EQ(visitor.model().screen, Screen::dealer);
}

TEST(GrowthLoop, IsSmoothFromAnywhereAndAfterALongSleep) {
  for (const double from : {0.0, 0.3, 1.0}) {
    GrowthLoop loop;
    loop.start(from, 1000.0);
    EXPECT_DOUBLE_EQ(loop.at(1000.0), from == 1.0 ? 1.0 : from);
    double last = from, speed = 0.0;
    for (int k = 1; k <= 6000; ++k) {
      const double now = loop.at(1000.0 + 10.0 * k);
      ASSERT_GE(now, 0.0);
      ASSERT_LE(now, 1.0);
      const double next_speed = now - last;
      ASSERT_LT(std::abs(next_speed - speed), 1e-4) << "no kink at " << k;
      speed = next_speed;
      last = now;
    }
  }
  GrowthLoop slept;
  slept.start(0.5, 0.0);
  const double later = slept.at(1e12);
  EXPECT_GE(later, 0.0);
  EXPECT_LE(later, 1.0);
}

TEST(PointBudget, HoldsAFrameTimeAndDoesNotSwing) {
  // Frames of 4 ms and 0.3 us a point: 400,000 points take 124 ms, 62 ms are 193,000.
  PointBudget budget(62.0, 400'000);
  std::size_t changes_late = 0;
  for (int k = 0; k < 3000; ++k) {
    if (k == 600) changes_late = static_cast<std::size_t>(budget.changes());
    budget.measured(4.0 + 0.3e-3 * static_cast<double>(budget.points()), budget.points());
  }
  const double ms = 4.0 + 0.3e-3 * static_cast<double>(budget.points());
  EXPECT_LT(ms, 62.0 * 1.1);
  EXPECT_GT(ms, 62.0 * 0.55);
  EXPECT_LE(static_cast<std::size_t>(budget.changes()), changes_late + 2) << "it has settled";
  // A machine that is much too slow still shows something; one that recovers gets its points back.
  for (int k = 0; k < 400; ++k) budget.measured(500.0, budget.points());
  EXPECT_EQ(budget.points(), 4000u);
  for (int k = 0; k < 20'000; ++k) budget.measured(5.0, budget.points());
  EXPECT_EQ(budget.points(), 400'000u);
  // What no clock says changes nothing.
  budget.measured(std::nan(""), 100);
  budget.measured(1e9, 0);
  EXPECT_EQ(budget.points(), 400'000u);
}

}  // namespace
}  // namespace lackwerk::kiosk
