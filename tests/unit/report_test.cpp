// What a report's pages say: the front, the curves, the verdicts.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "kiosk/tools/report/curve_svg.hpp"
#include "kiosk/tools/report/pages.hpp"
#include "kiosk/tools/report/pareto.hpp"
#include "kiosk/tools/report/parts.hpp"
#include "kiosk/tools/report/summary.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {
namespace {

Setting setting(const std::string& label, double ms, double error) {
  Setting out;
  out.label = label;
  out.time = {ms, 0.9 * ms, 1.1 * ms, 5};
  out.error = error;
  return out;
}

Knob knob() {
  Knob out;
  out.id = "steps";
  out.title = "Steps <of> \"something\"";
  out.what = "How many.";
  out.error_unit = "CIEDE2000";
  out.time_of = "one & only";
  out.chosen = "64";
  out.why = "half the time of 128 at 1.1 times its error";
  out.settings.push_back(setting("16", 1.0, 3.0));
  out.settings.push_back(setting("32", 2.0, 3.5));
  out.settings.push_back(setting("64", 4.0, 0.5));
  out.settings.push_back(setting("128", 8.0, 0.45));
  out.settings.push_back(setting("reference", 0.5, 0.0));
  out.settings.back().eligible = false;
  out.settings.push_back(setting("no time", 0.0, 1.0));
  out.settings.back().time = {};
  return out;
}

Findings findings() {
  Findings out;
  out.knobs.push_back(knob());
  StiffCase one;
  one.kernel = "transport";
  one.name = "identical";
  one.measure = "gap";
  one.worst = 1e-12;
  one.bound = 1e-9;
  out.stiff.push_back(one);
  one.name = "a <bad> one";
  one.worst = none;
  one.where = "row 3 | column 4";
  out.stiff.push_back(one);
  Speed speed;
  speed.id = "octree";
  speed.what = "clustering";
  speed.value = 19.0;
  speed.unit = "million texels/s";
  speed.aim = 20.0;
  speed.at_least = true;
  speed.count = 7;
  out.speeds.push_back(speed);
  return out;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Report, TheFrontIsWhatNothingBeats) {
  const Knob steps = knob();
  std::vector<std::string> labels;
  for (const std::size_t k : pareto_front(steps.settings)) labels.push_back(steps.settings[k].label);
  EXPECT_EQ(labels, (std::vector<std::string>{"16", "64", "128"}))
      << "32 is beaten by 16; the reference cannot be chosen; what has no time is on no front";
  // Twins: one of them is enough.
  std::vector<Setting> twins{setting("a", 1.0, 1.0), setting("b", 1.0, 1.0)};
  ASSERT_EQ(pareto_front(twins).size(), 1u);
  EXPECT_EQ(twins[pareto_front(twins)[0]].label, "a");
  twins[0].bytes = 20.0;
  twins[1].bytes = 10.0;
  ASSERT_EQ(pareto_front_of_bytes(twins).size(), 1u);
  EXPECT_EQ(twins[pareto_front_of_bytes(twins)[0]].label, "b");
  EXPECT_TRUE(pareto_front({}).empty());
}

TEST(Report, MedianAndQuartilesOfTimes) {
  const Timing timing = timing_of({5.0, 1.0, 3.0, 2.0, 4.0});
  EXPECT_EQ(timing.median_ms, 3.0);
  EXPECT_EQ(timing.low_ms, 2.0);
  EXPECT_EQ(timing.high_ms, 4.0);
  EXPECT_EQ(timing.count, 5);
  EXPECT_EQ(timing_of({}).count, 0);
}

TEST(Report, TimingCountsWhatItSays) {
  const Workbench bench(true);
  int runs = 0;
  const Timing timing = bench.time([&] { ++runs; }, 1e9, 3, 9);
  EXPECT_EQ(timing.count, 9) << "no more than the most, however much patience is left";
  EXPECT_EQ(runs, 10) << "and one that does not count";
  EXPECT_EQ(bench.time([] {}, 0.0, 4).count, 4) << "at least so many, without any patience";
}

TEST(Report, NumbersKeepThreeDigits) {
  EXPECT_EQ(digits(0.0), "0");
  EXPECT_EQ(digits(0.01234), "0.0123");
  EXPECT_EQ(digits(1.2345), "1.23");
  EXPECT_EQ(digits(12.345), "12.3");
  EXPECT_EQ(digits(9.996), "10.0");
  EXPECT_EQ(digits(1234.5), "1234");
  EXPECT_EQ(digits(3.2e-7), "3.20e-07");
  EXPECT_EQ(digits(none), "-");
  EXPECT_EQ(digits(std::numeric_limits<double>::infinity()), "inf");
}

TEST(Report, CurvesShowEveryMeasuredSettingAndRingTheDefault) {
  const std::string svg = curve_svg(knob(), Price::time);
  EXPECT_EQ(occurrences(svg, "<circle"), 6u) << "five settings with a time, and the ring";
  EXPECT_EQ(occurrences(svg, "r=\"9\""), 1u);
  EXPECT_NE(svg.find("one &amp; only"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_TRUE(curve_svg(knob(), Price::bytes).empty()) << "nothing has bytes";
  Knob alone = knob();
  alone.settings.resize(1);
  EXPECT_TRUE(curve_svg(alone, Price::time).empty()) << "one point is no curve";
}

TEST(Report, ZerosAndEqualFiguresStillMakeACurve) {
  Knob flat = knob();
  for (Setting& one : flat.settings) one.error = 0.0;
  EXPECT_EQ(curve_svg(flat, Price::time).find("nan"), std::string::npos);
  flat.settings[0].error = 1e-9;
  flat.settings[2].error = 1e9;
  EXPECT_EQ(curve_svg(flat, Price::time).find("nan"), std::string::npos);
  for (Setting& one : flat.settings) one.time = {2.0, 2.0, 2.0, 3};
  EXPECT_EQ(curve_svg(flat, Price::time).find("nan"), std::string::npos);
}

TEST(Report, JsonHoldsWhatWasFoundAndNullForWhatWasNot) {
  report::Run run;
  run.left_out = {"pictures: no GL"};
  const auto json = nlohmann::json::parse(report_json(findings(), run));
  ASSERT_EQ(json["knobs"].size(), 1u);
  EXPECT_EQ(json["knobs"][0]["default"], "64");
  EXPECT_EQ(json["knobs"][0]["pareto_front"], (nlohmann::json{"16", "64", "128"}));
  EXPECT_EQ(json["knobs"][0]["settings"][2]["time_ms"]["median"], 4.0);
  EXPECT_TRUE(json["knobs"][0]["settings"][5]["time_ms"].is_null());
  EXPECT_TRUE(json["stiff"][1]["worst"].is_null());
  EXPECT_EQ(json["stiff"][1]["passed"], false);
  EXPECT_EQ(json["stiff_failed"], 1);
  EXPECT_EQ(json["speeds_missed"], 1);
  EXPECT_EQ(json["left_out"][0], "pictures: no GL");
}

TEST(Report, PagesSayWhatFailedAndEscapeWhatTheyShow) {
  report::Run run;
  run.left_out = {"pictures: <no> GL"};
  const std::string page = report_page(findings(), run);
  EXPECT_NE(page.find("a &lt;bad&gt; one"), std::string::npos);
  EXPECT_EQ(page.find("a <bad> one"), std::string::npos);
  EXPECT_NE(page.find("pictures: &lt;no&gt; GL"), std::string::npos);
  EXPECT_NE(page.find("64 (default)"), std::string::npos);
  EXPECT_NE(page.find("missed"), std::string::npos);
  EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org/2000/svg")) << "self-contained: only the name of SVG";
  EXPECT_EQ(page.find("https://"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);

  const std::string text = report_markdown(findings(), run, "plots");
  EXPECT_NE(text.find("(plots/steps.svg)"), std::string::npos);
  EXPECT_NE(text.find("row 3 \\| column 4"), std::string::npos) << "a bar would end the cell";
  EXPECT_NE(text.find("**failed**"), std::string::npos);
  EXPECT_NE(text.find("**missed**"), std::string::npos);
  const auto plots = plot_files(findings());
  ASSERT_EQ(plots.size(), 1u);
  EXPECT_EQ(plots[0].first, "steps.svg");
}

TEST(Report, StiffCasesAreGroupedByKernelAndMeasure) {
  const Findings found = findings();
  const auto groups = stiff_groups(found);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].cases.size(), 2u);
  EXPECT_EQ(groups[0].failed, 1);
  EXPECT_EQ(groups[0].worst->name, "a <bad> one") << "what is no number is worse than any";
  EXPECT_EQ(failed_cases(found), 1);
}

TEST(Report, PartsHaveNamesOfTheirOwnAndSayHowLongTheyTake) {
  std::set<std::string_view> names;
  double quick_s = 0.0, full_s = 0.0;
  for (const Part& part : parts()) {
    EXPECT_TRUE(names.insert(part.name).second) << part.name;
    EXPECT_GT(part.quick_s, 0.0) << part.name;
    EXPECT_GE(part.full_s, part.quick_s) << part.name;
    quick_s += part.quick_s;
    full_s += part.full_s;
  }
  EXPECT_LE(quick_s, 60.0) << "what the quick report promises";
  EXPECT_LE(full_s, 900.0);
}

}  // namespace
}  // namespace lackwerk::report
