// The dealer's choices: kept as they are, and a damaged file is said and harms nothing.
#include "kiosk/display/choices.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>

#include "tests/unit/pack_samples.hpp"

namespace lackwerk::kiosk {
namespace {

DealerChoices odd_choices() {
  return {ui::Language::arabic,
          true,
          true,
          0.35,
          input::CalibrationMatrix{0.0, -1.0, 1.0, 1.01, 0.0, 1.0 / 3.0},
          PinRecord{3, 240.0, 1'762'000'000.25}};
}

void expect_equal(const DealerChoices& one, const DealerChoices& two) {
  EXPECT_EQ(one.language, two.language);
  EXPECT_EQ(one.beyond_allowed, two.beyond_allowed);
  EXPECT_EQ(one.reduced_motion, two.reduced_motion);
  EXPECT_EQ(one.brightness, two.brightness);
  EXPECT_EQ(one.calibration, two.calibration);
  EXPECT_EQ(one.pin, two.pin);
}

TEST(Choices, AreReadBackAsTheyWereWritten) {
  const lackwerk::testing::TemporaryFolder folder;
  const auto none = read_choices(folder.path(), {});
  ASSERT_TRUE(none) << none.error().line();
  EXPECT_FALSE(*none) << "no file yet";
  for (const DealerChoices& choices : {odd_choices(), DealerChoices{}}) {
    const auto written = write_choices(folder.path(), choices);
    ASSERT_TRUE(written) << written.error().line();
    const auto read = read_choices(folder.path(), odd_choices());
    ASSERT_TRUE(read && *read);
    expect_equal(**read, choices);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "dealer.json.new"));
}

TEST(Choices, StandOverTheConfiguration) {
  ExperienceSettings settings;
  settings.idle_s = 33.0;
  settings.brightness = 0.5;
  expect_equal(choices_of(settings), {ui::Language::english, false, false, 0.5, {}});
  const ExperienceSettings both = with_choices(settings, odd_choices());
  EXPECT_EQ(both.language, ui::Language::arabic);
  EXPECT_TRUE(both.beyond_allowed);
  EXPECT_TRUE(both.reduced_motion);
  EXPECT_EQ(both.brightness, 0.35);
  EXPECT_EQ(both.idle_s, 33.0);
}

TEST(Choices, WhatIsAbsentIsAsConfiguredAndWhatIsUnknownIsPassedOver) {
  const auto read = parse_choices(R"({"language": "de", "of_a_newer_kiosk": [1]})", "dealer.json", odd_choices());
  ASSERT_TRUE(read) << read.error().line();
  DealerChoices expected = odd_choices();
  expected.language = ui::Language::german;
  expect_equal(*read, expected);
}

TEST(Choices, DamageIsSaidAndNothingOfItIsUsed) {
  for (const char* text : {"",
                           "{",
                           "[]",
                           "null",
                           "3",
                           "\xff",
                           R"({"language": "fr"})",
                           R"({"language": 1})",
                           R"({"beyond": 1})",
                           R"({"reduced_motion": "true"})",
                           R"({"brightness": 0.1})",
                           R"({"brightness": 1e999})",
                           R"({"brightness": null})",
                           R"({"calibration": []})",
                           R"({"calibration": [0, 0, 0, 0, 0, 0]})",
                           R"({"calibration": [1, 0, 0, 0, 1, "0"]})",
                           R"({"calibration": [1, 0, 0, 0, 1, 1e999]})",
                           "{} {}",
                           R"({"pin_wrong": 5})",
                           R"({"pin_wrong": -1})",
                           R"({"pin_wrong": "0"})",
                           R"({"pin_lock_s": 1e6})",
                           R"({"pin_locked_until_s": -1})",
                           R"({"pin_locked_until_s": 1e300})"}) {
    const auto read = parse_choices(text, "dealer.json", {});
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().file, "dealer.json");
    EXPECT_EQ(read.error().line().find('\n'), std::string::npos);
  }
  EXPECT_FALSE(parse_choices(std::string(max_choices_bytes + 1, ' '), "dealer.json", {}));
  EXPECT_FALSE(parse_choices(std::string(max_choices_bytes, '['), "dealer.json", {})) << "deep, not dead";
  const std::string whole = text_of(odd_choices());
  for (std::size_t cut = 0; cut + 2 < whole.size(); ++cut)
    EXPECT_FALSE(parse_choices(whole.substr(0, cut), "dealer.json", {})) << cut;
}

TEST(Choices, FilesThatCannotBeReadOrWrittenAreSaid) {
  const lackwerk::testing::TemporaryFolder folder;
  EXPECT_FALSE(write_choices(folder / "none", {}));
  const auto absent = read_choices(folder / "none", {});
  EXPECT_TRUE(absent && !*absent);
  std::filesystem::create_directory(folder / "dealer.json");
  EXPECT_FALSE(read_choices(folder.path(), {})) << "a folder";
  EXPECT_FALSE(write_choices(folder.path(), {}));
  EXPECT_FALSE(std::filesystem::exists(folder / "dealer.json.new"));
  std::filesystem::remove(folder / "dealer.json");
  ASSERT_EQ(::mkfifo((folder / "dealer.json").c_str(), 0600), 0);
  EXPECT_FALSE(read_choices(folder.path(), {})) << "returns, and does not wait for a writer";
}

TEST(Choices, LieInTheFolderOfTheService) {
  const char* before = std::getenv("STATE_DIRECTORY");
  const std::string kept = before != nullptr ? before : "";
  ::unsetenv("STATE_DIRECTORY");
  EXPECT_TRUE(choices_folder().empty());
  ::setenv("STATE_DIRECTORY", "/var/lib/lackwerk", 1);
  EXPECT_EQ(choices_folder(), "/var/lib/lackwerk");
  ::setenv("STATE_DIRECTORY", "/var/lib/lackwerk:/var/lib/other", 1);
  EXPECT_EQ(choices_folder(), "/var/lib/lackwerk");
  before != nullptr ? ::setenv("STATE_DIRECTORY", kept.c_str(), 1) : ::unsetenv("STATE_DIRECTORY");
}

}  // namespace
}  // namespace lackwerk::kiosk
