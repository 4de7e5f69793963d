#include "kiosk/display/status.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace lackwerk::kiosk {
namespace {

Status sample() {
  Status status;
  status.state = "running";
  status.platform = "kms";
  status.renderer = "llvmpipe";
  status.refused = {{"kms", "no card"}};
  status.mode = {"HDMI-A-1", {1280, 720}, 59.94, Rotation::quarter};
  status.packs = {{"demo.lwp", "demo", 3, true, {"Silver", "Pearl"}}};
  status.weights = core::Weights::uniform({0.25, 0.75});
  status.quality = "soft (chosen)";
  status.drawn = 12;
  status.presented = 11;
  status.screen = "show";
  status.language = "de";
  status.controls = {{"swatch", 1, 0.25, 0.75}};
  status.weights.flake_white = 0.5;
  status.devices = {{"dial \xff\"\n", "knob", "ready", "/dev/hidraw0", 7}};
  status.problems = {{500.0, Priority::warning, "late", 2}};
  status.started_ms = 1000.0;
  return status;
}

std::string read(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(Status, SaysWhatIsShownAndWhy) {
  const auto json = nlohmann::json::parse(status_json(sample(), 3500.0));
  EXPECT_EQ(json["state"], "running");
  EXPECT_EQ(json["backend"], "kms");
  EXPECT_DOUBLE_EQ(json["up_s"], 2.5);
  EXPECT_EQ(json["refused"][0]["why"], "no card");
  EXPECT_EQ(json["mode"]["rotation"], 90);
  EXPECT_DOUBLE_EQ(json["weights"]["base"][1], 0.75);
  EXPECT_DOUBLE_EQ(json["weights"]["flake_white"], 0.5);
  EXPECT_EQ(json["screen"], "show");
  EXPECT_EQ(json["language"], "de");
  EXPECT_EQ(json["controls"][0]["widget"], "swatch");
  EXPECT_EQ(json["controls"][0]["index"], 1);
  EXPECT_DOUBLE_EQ(json["controls"][0]["y"], 0.75);
  EXPECT_EQ(json["packs"][0]["paints"][1], "Pearl");
  EXPECT_EQ(json["frames"]["presented"], 11);
  EXPECT_EQ(json["errors"][0]["times"], 2);
  EXPECT_DOUBLE_EQ(json["errors"][0]["age_s"], 3.0);
  EXPECT_EQ(json["devices"][0]["heard"], 7);
  // A device's name is not UTF-8: it is replaced, not passed on and not the end of the kiosk.
  EXPECT_NE(json["devices"][0]["name"].get<std::string>().find("dial"), std::string::npos);
}

TEST(Status, IsReplacedInOneStepAndReadableByAll) {
  const auto folder = std::filesystem::temp_directory_path() / ("lackwerk_status_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  ASSERT_TRUE(write_status(folder.string(), "one\n"));
  std::ifstream old(folder / status_file_name);  // a reader in the middle of it
  ASSERT_TRUE(write_status(folder.string(), "two\n"));
  std::string word;
  old >> word;
  EXPECT_EQ(word, "one");
  EXPECT_EQ(read(folder / status_file_name), "two\n");
  struct stat about {};
  ASSERT_EQ(stat((folder / status_file_name).c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777u, 0644u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1) << "nothing is left behind";
  std::filesystem::remove_all(folder);
}

TEST(Status, AFolderThatIsNotThereIsAnErrorWithAName) {
  const auto written = write_status("/no/such/folder", "x");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().line().find("/no/such/folder/status.json"), std::string::npos);
}

}  // namespace
}  // namespace lackwerk::kiosk
