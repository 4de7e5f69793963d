// The quality table: what is written is read again, and what is no table is refused with the field that is wrong.
#include "kiosk/display/quality_table.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "kiosk/tools/report/picture_knobs.hpp"

namespace lackwerk::kiosk {
namespace {

class QualityTableTest : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() / ("lackwerk_quality_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    path = folder / "quality.json";
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  static QualityTable good() {
    QualityTable table;
    table.renderer = "llvmpipe (LLVM 15.0.6, 256 bits)";
    double cost = 1.0;
    for (const gles::Rung& rung : gles::quality_ladder()) {
      table.rungs.push_back({std::string(rung.name), cost, 2.0 / cost, 6.0 / cost});
      cost *= 0.75;
    }
    return table;
  }
  /// The good file with a piece replaced, and what reading says.
  Error error_with(const std::string& from, const std::string& to) {
    EXPECT_TRUE(write_quality_table(path, good()));
    std::ifstream in(path);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
    return error_of(text);
  }
  Error error_of(const std::string& text) {
    std::ofstream(path) << text;
    const auto read = read_quality_table(path);
    EXPECT_FALSE(read) << text.substr(0, 200);
    return read ? Error{} : read.error();
  }
  std::filesystem::path folder, path;
};

TEST_F(QualityTableTest, WhatIsWrittenIsRead) {
  const QualityTable table = good();
  ASSERT_TRUE(write_quality_table(path, table));
  const auto read = read_quality_table(path);
  ASSERT_TRUE(read) << read.error().line();
  EXPECT_EQ(read->renderer, table.renderer);
  ASSERT_EQ(read->rungs.size(), table.rungs.size());
  for (std::size_t k = 0; k < table.rungs.size(); ++k) {
    EXPECT_EQ(read->rungs[k].name, table.rungs[k].name);
    EXPECT_EQ(read->rungs[k].cost, table.rungs[k].cost);
    EXPECT_EQ(read->rungs[k].error_mean, table.rungs[k].error_mean);
    EXPECT_EQ(read->rungs[k].error_p95, table.rungs[k].error_p95);
  }
  const gles::RungCosts costs = read->costs();
  for (std::size_t k = 0; k < gles::rung_count; ++k) {
    EXPECT_EQ(costs.cost[k], table.rungs[k].cost);
    EXPECT_EQ(costs.error[k], table.rungs[k].error_mean);
  }
}

TEST_F(QualityTableTest, TheOrderInTheFileDoesNotMatterAndUnknownKeysArePassedOver) {
  std::string text = R"({"made": 1, "rungs": [)";
  const auto ladder = gles::quality_ladder();
  for (std::size_t k = ladder.size(); k-- > 0;)
    text += R"({"name": ")" + std::string(ladder[k].name) + R"(", "more": [], "cost": )" +
            (k == 0 ? "1" : "0." + std::to_string(9 - k)) + R"(, "error_mean": 2, "error_p95": 6.5})" +
            (k == 0 ? "" : ",");
  std::ofstream(path) << text << "]}";
  const auto read = read_quality_table(path);
  ASSERT_TRUE(read) << read.error().line();
  EXPECT_EQ(read->rungs.front().name, ladder.front().name);
  EXPECT_EQ(read->costs().cost[2], 0.7);
}

TEST_F(QualityTableTest, WhatIsNoTableIsRefusedByItsField) {
  const std::vector<std::pair<std::pair<const char*, const char*>, const char*>> cases = {
      {{R"("cost": 0.75,)", R"("cost": 0.0,)"}, "rungs[1].cost"},
      {{R"("cost": 0.75,)", R"("cost": -1,)"}, "rungs[1].cost"},
      {{R"("cost": 0.75,)", R"("cost": 1e9,)"}, "rungs[1].cost"},
      {{R"("cost": 0.75,)", R"("cost": "half",)"}, "rungs[1].cost"},
      {{R"("cost": 0.75,)", R"("cost": null,)"}, "rungs[1].cost"},
      {{R"("cost": 0.75,)", ""}, "rungs[1].cost"},
      {{R"("cost": 1.0,)", R"("cost": 0.9,)"}, "rungs[0].cost"},
      {{R"("error_mean": 2.0,)", R"("error_mean": -2.0,)"}, "rungs[0].error_mean"},
      {{R"("error_p95": 6.0)", R"("error_p95": [6.0])"}, "rungs[0].error_p95"},
      {{R"("name": "fine")", R"("name": "finest")"}, "rungs[1].name"},
      {{R"("name": "fine")", R"("name": 2)"}, "rungs[1].name"},
      {{R"("name": "fine")", R"("name": "best")"}, "rungs"},
      {{R"("renderer": ")", R"("renderer": 3, "r": ")"}, "renderer"},
      {{R"("rungs": [)", R"("rungs": [[],)"}, "rungs"},
      {{R"("rungs")", R"("rangs")"}, "rungs"},
  };
  for (const auto& [change, field] : cases) {
    const Error error = error_with(change.first, change.second);
    EXPECT_EQ(error.field, field) << change.second << ": " << error.line();
    EXPECT_EQ(error.file, path.string());
    EXPECT_NE(error.remedy.find("lackwerk report"), std::string::npos) << error.line();
  }
}

TEST_F(QualityTableTest, FilesThatAreNoneAreRefused) {
  for (const std::string text : {"", "[]", "{}", "{\"rungs\": {}}", "{\"rungs\": []}", "{\"rungs\": [", "\xff\xfe"}) {
    const Error error = error_of(text);
    EXPECT_EQ(error.file, path.string()) << text;
    EXPECT_FALSE(error.remedy.empty()) << text;
  }
  error_of("{\"rungs\": [" + std::string(max_quality_table_bytes, ' ') + "]}");
  std::filesystem::remove(path);
  EXPECT_FALSE(read_quality_table(path));
  EXPECT_FALSE(read_quality_table(folder));
}

TEST(QualityTableOfFindings, TakesTheLadderOfTheQualityKnobAlone) {
  report::Findings findings;
  EXPECT_EQ(report::quality_table_of(findings).error().field, "quality");
  report::Knob knob;
  knob.id = "quality";
  double ms = 80.0;
  for (const gles::Rung& rung : gles::quality_ladder()) {
    report::Setting setting;
    setting.label = rung.name;
    setting.line = "ladder";
    setting.time.median_ms = ms;
    setting.error = 160.0 / ms;
    setting.p95 = 3.0 * setting.error;
    setting.note = knob.settings.empty() ? "a card" : "";
    knob.settings.push_back(setting);
    setting.label = std::string("variant of ") + std::string(rung.name);
    setting.line = "other";
    knob.settings.push_back(setting);
    ms *= 0.5;
  }
  findings.knobs.push_back(knob);
  const auto table = report::quality_table_of(findings);
  ASSERT_TRUE(table) << table.error().line();
  EXPECT_EQ(table->renderer, "a card");
  ASSERT_EQ(table->rungs.size(), gles::rung_count);
  EXPECT_EQ(table->rungs[2].cost, 0.25);
  EXPECT_EQ(table->rungs[2].error_mean, 8.0);
  EXPECT_EQ(table->rungs[2].error_p95, 24.0);
  findings.knobs.front().settings.pop_back();
  findings.knobs.front().settings.pop_back();
  EXPECT_FALSE(report::quality_table_of(findings)) << "a rung is missing";
}

TEST_F(QualityTableTest, NothingWrongIsWritten) {
  QualityTable table = good();
  table.rungs[3].cost = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(write_quality_table(path, table));
  table = good();
  table.rungs.pop_back();
  EXPECT_FALSE(write_quality_table(path, table));
  table = good();
  table.rungs.front().cost = 1.5;
  EXPECT_FALSE(write_quality_table(path, table));
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_FALSE(write_quality_table(folder / "none" / "quality.json", good()));
}

}  // namespace
}  // namespace lackwerk::kiosk
