// Scripted input: what a tour file says is what the kiosk hears.
#include "input/script.hpp"

#include <gtest/gtest.h>

#include <cmath>
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
  for (const char* text : {"x weights 1", "0 fly 3", "0 weights", "0 weights one", "10 zoom 1\n5 zoom 1", "0 zoom -1",
                           "0 orbit 1", "0 camera", "0 weights nan", "-1 zoom 1", "0 weights 1 over x"}) {
    const auto steps = parse_script(text, "bad.tour");
    ASSERT_FALSE(steps) << text;
    EXPECT_EQ(steps.error().file, "bad.tour");
    EXPECT_NE(steps.error().field.find("line "), std::string::npos) << text;
  }
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

}  // namespace
}  // namespace lackwerk::input
