// Scripted input: what a tour file says is what the kiosk hears.
#include "input/script.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

namespace lackwerk::input {
namespace {

std::vector<ScriptStep> parse(const char* text) {
  auto steps = parse_script(text, "test.tour");
  EXPECT_TRUE(steps) << (steps ? "" : steps.error().line());
  return steps.value_or(std::vector<ScriptStep>{});
}

TEST(Script, ReadsEveryCommand) {
  const auto steps = parse(
      "# a comment\n0 camera hero\n\n10 weights 0.25 0.75 over 500 # tail\n20 orbit 30 -5\n"
      "30 zoom 0.5\n40 lightness 0 1\n50 colour 1 0\n60 base 0 1\n");
  ASSERT_EQ(steps.size(), 7u);
  EXPECT_EQ(steps[0].control.name, "hero");
  EXPECT_EQ(steps[1].control.values, (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(steps[1].over_ms, 500.0);
  EXPECT_EQ(steps[6].control.kind, ControlKind::base);
}

TEST(Script, NamesTheBadLine) {
  for (const char* text : {"x weights 1",
                           "0 fly 3",
                           "0 weights",
                           "0 weights one",
                           "10 zoom 1\n5 zoom 1",
                           "0 zoom -1",
                           "0 orbit 1",
                           "0 camera",
                           "0 weights nan",
                           "-1 zoom 1",
                           "0 weights 1 over x",
                           "0 light 3",
                           "0 light 0.5",
                           "0 dimmer 2",
                           "0 white -1",
                           "0 turn",
                           "0 press 1",
                           "0 tap",
                           "0 tap 0.5",
                           "0 tap 2 0.5",
                           "0 tap @",
                           "0 tap @Swatch:1",
                           "0 tap @swatch:1,2,3",
                           "0 tap @swatch:x",
                           "0 tap 0.5 0.5 finger 99",
                           "0 tap 0.5 0.5 over 10",
                           "0 drag @puck over 10",
                           "0 drag @puck @swatch:1",
                           "0 hold @compare",
                           "0 hold @compare -1",
                           "0 up 1",
                           "0 move 0.5 0.5 over",
                           "0 camera a b",
                           "0 zoom 1 2"}) {
    const auto steps = parse_script(text, "bad.tour");
    ASSERT_FALSE(steps) << text;
    EXPECT_EQ(steps.error().file, "bad.tour");
    EXPECT_NE(steps.error().field.find("line "), std::string::npos) << text;
  }
}

TEST(Script, FingersAndKnobs) {
  const auto steps = parse(
      "0 tap @swatch:1\n10 hold @compare 500 finger 2\n20 drag @puck 0.25 0.75 over 300\n30 turn -3 over 100\n"
      "40 click\n50 light 2\n60 dimmer 0.5 over 10\n70 white 1\n");
  ASSERT_EQ(steps.size(), 13u);
  EXPECT_EQ(steps[0].control.kind, ControlKind::touch_down);
  EXPECT_EQ(steps[0].control.name, "@swatch:1");
  EXPECT_EQ(steps[1].control.contact, 2);
  EXPECT_EQ(steps[3].control.kind, ControlKind::touch_move);
  EXPECT_EQ(steps[3].control.name, "@picture:0.25,0.75");
  EXPECT_EQ(steps[3].over_ms, 300.0);
  // A finger that stays longer goes up after what begins later.
  EXPECT_EQ(steps.back().control.kind, ControlKind::touch_up);
  EXPECT_EQ(steps.back().control.contact, 2);
  EXPECT_EQ(steps.back().at_ms, 510.0);
  for (std::size_t k = 1; k < steps.size(); ++k) EXPECT_LE(steps[k - 1].at_ms, steps[k].at_ms);
}

TEST(Script, TargetsHaveANameAndUpToTwoNumbers) {
  EXPECT_EQ(parse_target("@puck")->name, "puck");
  EXPECT_EQ(parse_target("@pad:0.25,-1e3")->values, (std::vector<double>{0.25, -1e3}));
  for (const char* text : {"", "@", "puck", "@a b", "@a:", "@a:1,", "@a:,1", "@a:1,2,3", "@a:nan", "@A", "@a1",
                           "@aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"})
    EXPECT_FALSE(parse_target(text)) << text;
}

TEST(Script, EveryTourCanBeRead) {
  int tours = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(LACKWERK_SOURCE_DIR) + "/tests/tours")) {
    if (entry.path().extension() != ".tour") continue;
    ++tours;
    const auto steps = read_script(entry.path());
    EXPECT_TRUE(steps) << steps.error().line();
  }
  EXPECT_GE(tours, 12);
}

TEST(Script, MissingFileIsAnError) { EXPECT_FALSE(read_script("no/such.tour")); }

TEST(ScriptPlayer, MorphsKeepTheSumAndEndExactly) {
  ScriptPlayer player(parse("0 weights 0 1 0 over 1000\n"), {1, 0, 0});
  std::vector<double> last{1, 0, 0};
  for (int ms = 0; ms <= 1000; ms += 50) {
    const auto events = player.advance(ms);
    ASSERT_EQ(events.size(), 1u);
    const auto& w = events[0].values;
    EXPECT_NEAR(w[0] + w[1] + w[2], 1.0, 1e-12);
    EXPECT_LE(w[0], last[0] + 1e-12);
    last = w;
  }
  EXPECT_EQ(last, (std::vector<double>{0, 1, 0}));
  EXPECT_TRUE(player.finished());
  EXPECT_TRUE(player.advance(2000).empty());
}

TEST(ScriptPlayer, OrbitAndZoomAddUpWhateverTheFrameTimes) {
  for (const double frame_ms : {7.0, 33.0, 400.0}) {
    ScriptPlayer player(parse("0 orbit 90 10 over 1000\n0 zoom 0.25 over 500\n"), {1});
    double azimuth = 0.0, zoom = 1.0;
    for (double t = 0.0; !player.finished(); t += frame_ms)
      for (const auto& event : player.advance(t)) {
        if (event.kind == ControlKind::orbit) azimuth += event.values[0];
        if (event.kind == ControlKind::zoom) zoom *= event.values[0];
      }
    EXPECT_NEAR(azimuth, 90.0, 1e-9) << frame_ms;
    EXPECT_NEAR(zoom, 0.25, 1e-9) << frame_ms;
  }
}

TEST(ScriptPlayer, ADragComesDownGoesOnAndLeavesAtItsEnd) {
  ScriptPlayer player(parse("100 drag @puck @swatch:1 over 200\n"), {1});
  EXPECT_TRUE(player.advance(50).empty());
  std::vector<Control> heard;
  for (double t = 100.0; !player.finished(); t += 33.0)
    for (Control& event : player.advance(t)) heard.push_back(std::move(event));
  ASSERT_GE(heard.size(), 4u);
  EXPECT_EQ(heard.front().kind, ControlKind::touch_down);
  EXPECT_EQ(heard.front().time_us, 100'000u);
  EXPECT_EQ(heard.back().kind, ControlKind::touch_up);
  EXPECT_EQ(heard.back().time_us, 300'000u);
  double way = -1.0;
  for (std::size_t k = 1; k + 1 < heard.size(); ++k) {
    EXPECT_EQ(heard[k].kind, ControlKind::touch_move);
    EXPECT_GE(heard[k].values[0], way);
    way = heard[k].values[0];
  }
  EXPECT_EQ(way, 1.0);
}

TEST(ScriptPlayer, TurnsAddUpAndTheDimmerGoesOnFromWhereItWas) {
  ScriptPlayer player(parse("0 turn 12 over 500\n0 dimmer 0.8 over 200\n400 dimmer 0.4 over 200\n"), {1});
  double turned = 0.0, dimmer = 0.0, least_late = 1.0;
  for (double t = 0.0; !player.finished(); t += 20.0)
    for (const Control& event : player.advance(t)) {
      if (event.kind == ControlKind::turn) turned += event.values[0];
      if (event.kind != ControlKind::dimmer) continue;
      if (t < 100.0) {
        EXPECT_LT(event.values[0], 0.6);
      }
      if (t >= 400.0) least_late = std::min(least_late, event.values[0]);
      dimmer = event.values[0];
    }
  EXPECT_NEAR(turned, 12.0, 1e-9);
  EXPECT_EQ(dimmer, 0.4);
  EXPECT_EQ(least_late, 0.4) << "it left from 0.8, not from 0";
}

}  // namespace
}  // namespace lackwerk::input
