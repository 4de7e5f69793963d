#include "kiosk/display/log.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>

namespace lackwerk::kiosk {
namespace {

TEST(Log, KeepsProblemsAndCountsRepeats) {
  Log log(nullptr);
  log.info("started");
  log.warning("no knob");
  log.warning("no knob");
  log.error(Error{"/dev/x", "", "gone", "plug it in"});
  const auto problems = log.problems();
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0].text, "no knob");
  EXPECT_EQ(problems[0].times, 2);
  EXPECT_EQ(problems[1].text, "/dev/x: gone (plug it in)");
  EXPECT_EQ(problems[1].priority, Priority::error);
  EXPECT_EQ(log.lines().size(), 3u) << "a repeated line is counted, not written again";
}

TEST(Log, AFloodNeitherGrowsTheListNorBreaksLines) {
  Log log(nullptr);
  for (int k = 0; k < 1000; ++k) log.warning("device " + std::to_string(k) + " says\n<0>root\x1b[2J");
  EXPECT_EQ(log.problems().size(), Log::kept);
  EXPECT_EQ(log.problems().back().text, "device 999 says <0>root [2J");
}

TEST(Log, TheJournalGetsPriorities) {
  std::FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  {
    Log log(file, true);
    log.warning("w");
    log.info("i");
  }
  std::rewind(file);
  std::array<char, 64> text{};
  const std::size_t read = std::fread(text.data(), 1, text.size() - 1, file);
  std::fclose(file);
  EXPECT_EQ(std::string(text.data(), read), "<4>w\n<6>i\n");
}

}  // namespace
}  // namespace lackwerk::kiosk
