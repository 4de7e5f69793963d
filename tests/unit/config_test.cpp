// kiosk.toml: every key is read, every mistake is named with its line, and the shipped sample is what the program says.
#include "kiosk/display/config.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "kiosk/display/config_keys.hpp"
#include "kiosk/display/config_text.hpp"
#include "packs/toml_gate.hpp"

namespace lackwerk::kiosk {
namespace {

ConfigReading parse(const std::string& text) { return parse_config(text, "kiosk.toml"); }

/// One line per error.
std::string lines(const ConfigReading& reading) {
  std::string out;
  for (const Error& error : reading.errors) out += error.line() + "\n";
  return out;
}

template <class Owner>
std::string values(const Section<Owner>& section, Owner owner) {
  std::string out;
  for (const Key<Owner>& key : section.keys) out += std::string(key.name) + " = " + text_of(key.slot(owner)) + "\n";
  return out;
}

/// All values of a configuration as text: equal texts, equal configurations.
std::string all_values(const Config& config) {
  std::string out;
  for (const auto& section : config_sections()) out += values(section, config);
  for (const auto& knob : config.knobs.devices) out += values(knob_section(), knob);
  for (const auto& touch : config.touch) out += values(touch_section(), touch);
  return out;
}

/// The sample with its settings switched on, and the required key of a knob given.
std::string switched_on(std::string sample) {
  std::istringstream in(sample);
  std::string out;
  for (std::string line; std::getline(in, line);) {
    const bool setting = line.size() > 1 && line[0] == '#' && line[1] != ' ';
    out += (setting ? line.substr(1) : line) + "\n";
    if (line == "#[[knob]]") out += "match = \"x\"\n";
  }
  // The sample has the key of its own too.
  const auto own = out.find("match = \"\"\n");
  return out.erase(own, std::string("match = \"\"\n").size());
}

TEST(Config, TheShippedFileIsWhatTheProgramSays) {
  std::ifstream in(std::string(LACKWERK_SOURCE_DIR) + "/systemd/kiosk.toml", std::ios::binary);
  ASSERT_TRUE(in);
  const std::string shipped{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  EXPECT_EQ(shipped, config_text()) << "write config_text() into systemd/kiosk.toml";
}

TEST(Config, TheSampleSetsNothingAndItsSettingsAreTheDefaults) {
  const auto sample = parse(config_text());
  EXPECT_TRUE(sample.errors.empty()) << lines(sample);
  Config expected;
  EXPECT_EQ(all_values(sample.config), all_values(expected));
  const auto on = parse(switched_on(config_text()));
  EXPECT_TRUE(on.errors.empty()) << lines(on);
  expected.knobs.devices.push_back({"x", {}});
  expected.touch.emplace_back();
  EXPECT_EQ(all_values(on.config), all_values(expected));
}

TEST(Config, TheSampleNamesEveryKeyOnce) {
  const std::string text = config_text();
  for (const auto& section : config_sections())
    for (const auto& key : section.keys)
      EXPECT_NE(text.find("\n#" + std::string(key.name) + " = "), std::string::npos) << key.name;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) EXPECT_LE(line.size(), 120u) << line;
}

TEST(Config, ReadsEverything) {
  const auto reading = parse(R"(
packs = ["a.lwp", "b.lwp"]
scene = "car.lws"
[display]
platform = "kms"
card = "/dev/dri/by-path/pci-0000:00:02.0-card"
connector = "HDMI-A-2"
mode = "1920x1080"
refresh_hz = 60
rotation = 270
seat = "direct"
[picture]
quality = "lean"
quality_table = "/etc/lackwerk/quality.json"
frame_ms = 33
still_frames = 0
[interface]
shown = false
language = "ar"
dpi = 163
idle_s = 30
countdown_s = 7.5
night = "20:00-08:30"
beyond = true
reduced_motion = true
tour = false
brightness = 0.8
pin = "$argon2id$v=19$m=8192,t=4,p=1$AAAAAAAAAAAAAAAAAAAAAA$AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"
drift_px = 12
attract_brightness = 0.5
[panel]
white = [0.3457, 0.3585]
red = [0.68, 0.32]
green = [0.265, 0.69]
blue = [0.15, 0.06]
curve = [0, 0.2, 1]
gamut_warning = true
[input]
udev_seat = "seat1"
[knobs]
usb = false
detents_per_turn = 48
invert = true
[[touch]]
match = "ILITEK"
output = "HDMI-A-2"
calibration = [0, -1, 1, 1, 0, 0]
[[touch]]
[[knob]]
match = "045e:091b"
profile = "surface-dial"
acceleration = 0
axis = "rz"
[[knob]]
match = "mouse"
ignore = true
)");
  ASSERT_TRUE(reading.errors.empty()) << lines(reading);
  const Config& c = reading.config;
  EXPECT_EQ(c.packs.files, (std::vector<std::string>{"a.lwp", "b.lwp"}));
  EXPECT_EQ(c.scene, "car.lws");
  EXPECT_EQ(c.output.platform, Platform::kms);
  EXPECT_EQ(c.output.card, "/dev/dri/by-path/pci-0000:00:02.0-card");
  EXPECT_EQ(c.output.connector, "HDMI-A-2");
  EXPECT_EQ(c.output.mode_px, (std::array<int, 2>{1920, 1080}));
  EXPECT_EQ(c.output.refresh_hz, 60);
  EXPECT_EQ(c.output.rotation, Rotation::three_quarters);
  EXPECT_EQ(c.seat, "direct");
  EXPECT_EQ(c.picture.quality, "lean");
  EXPECT_EQ(c.picture.quality_table, "/etc/lackwerk/quality.json");
  EXPECT_EQ(c.picture.frame_ms, 33);
  EXPECT_EQ(c.picture.still_frames, 0);
  EXPECT_EQ(c.output.profile.white, (Chromaticity{0.3457, 0.3585}));
  EXPECT_EQ(c.output.profile.curves[2], (std::vector<double>{0, 0.2, 1}));
  EXPECT_EQ(c.output.profile.source, "kiosk.toml");
  EXPECT_TRUE(c.output.gamut_warning);
  EXPECT_FALSE(c.interface.shown);
  EXPECT_EQ(c.interface.dpi, 163.0);
  EXPECT_EQ(c.interface.drift_px, 12);
  EXPECT_EQ(c.interface.attract_brightness, 0.5);
  EXPECT_TRUE(c.interface.pin.starts_with("$argon2id$"));
  const ExperienceSettings& experience = c.interface.experience;
  EXPECT_EQ(experience.language, ui::Language::arabic);
  EXPECT_EQ(experience.idle_s, 30.0);
  EXPECT_EQ(experience.countdown_s, 7.5);
  EXPECT_EQ(experience.night, (NightHours{20 * 60, 8 * 60 + 30}));
  EXPECT_TRUE(experience.beyond_allowed);
  EXPECT_TRUE(experience.reduced_motion);
  EXPECT_FALSE(experience.tour);
  EXPECT_EQ(experience.brightness, 0.8);
  EXPECT_TRUE(experience.has_pin);
  EXPECT_EQ(c.input_seat, "seat1");
  EXPECT_FALSE(c.knobs.usb);
  EXPECT_TRUE(c.knobs.hidraw);
  ASSERT_EQ(c.touch.size(), 2u);
  EXPECT_EQ(c.touch[0].output, "HDMI-A-2");
  EXPECT_EQ(c.touch[0].calibration, (input::CalibrationMatrix{0, -1, 1, 1, 0, 0}));
  EXPECT_EQ(c.touch[1], input::TouchSettings{});
  ASSERT_EQ(c.knobs.devices.size(), 2u);
  EXPECT_EQ(c.knobs.devices[0].tuning.profile, input::KnobProfile::surface_dial);
  EXPECT_EQ(c.knobs.devices[0].tuning.acceleration, 0.0);
  EXPECT_EQ(c.knobs.devices[0].tuning.detents_per_turn, 48.0) << "what is not said is as in [knobs]";
  EXPECT_TRUE(c.knobs.devices[1].tuning.invert);
  EXPECT_TRUE(c.knobs.devices[1].tuning.ignore);
}

TEST(Config, CurvesAreWordsExponentsOrLists) {
  EXPECT_EQ(parse("[panel]\ncurve = 2.2").config.output.profile.curves[0], power_curve(2.2));
  EXPECT_TRUE(parse("[panel]\ncurve = \"srgb\"").config.output.profile.curves[0].empty());
  EXPECT_EQ(parse("[panel]\nicc = \"p.icc\"").config.icc, "p.icc");
  EXPECT_TRUE(parse("[panel]\nicc = \"p.icc\"").errors.empty());
}

TEST(Config, NightHoursReadBackAsTheyAreWritten) {
  for (const char* text : {"", "20:00-08:00", "00:00-23:59", "12:01-12:02"}) {
    const auto reading = parse("[interface]\nnight = \"" + std::string(text) + "\"");
    EXPECT_TRUE(reading.errors.empty()) << lines(reading);
    NightHours night = reading.config.interface.experience.night;
    EXPECT_EQ(text_of(Slot{&night}), "\"" + std::string(text) + "\"");
  }
}

TEST(Config, APlainPinIsRefusedAndNotRepeated) {
  const auto reading = parse("\n[interface]\npin = \"4711\"");
  ASSERT_EQ(reading.errors.size(), 1u);
  EXPECT_EQ(reading.errors[0].field, "line 3, interface.pin");
  EXPECT_EQ(reading.errors[0].line().find("4711"), std::string::npos);
  EXPECT_NE(reading.errors[0].remedy.find("--hash-pin"), std::string::npos);
  EXPECT_FALSE(reading.config.interface.experience.has_pin);
  EXPECT_TRUE(reading.config.interface.pin.empty());
}

TEST(Config, AllMistakesAtOnceEachWithItsLine) {
  const auto reading = parse(
      "scene = 3\n"             // 1
      "[display]\n"             // 2
      "rotaton = 90\n"          // 3
      "mode = \"big\"\n"        // 4
      "quality = \"best\"\n"    // 5
      "[picture]\n"             // 6
      "frame_ms = 0\n"          // 7
      "[disply]\n"              // 8
      "[[touch]]\n"             // 9
      "calibration = [1, 2]\n"  // 10
      "[[knob]]\n");            // 11
  ASSERT_EQ(reading.errors.size(), 8u) << lines(reading);
  const auto expect = [&](std::size_t k, const std::string& field, const std::string& said) {
    EXPECT_EQ(reading.errors[k].file, "kiosk.toml");
    EXPECT_EQ(reading.errors[k].field, field);
    EXPECT_NE(reading.errors[k].line().find(said), std::string::npos) << reading.errors[k].line();
  };
  expect(0, "line 1, scene", "must be a text of at most 4096 characters");
  expect(1, "line 3, display.rotaton", "did you mean rotation?");
  expect(2, "line 4, display.mode", "\"preferred\" or a size");
  expect(3, "line 5, display.quality", "it belongs below [picture]");
  expect(4, "line 7, picture.frame_ms", "a whole number, 1 to 1000");
  expect(5, "line 8, disply", "did you mean display?");
  expect(6, "line 10, touch.calibration", "six numbers");
  expect(7, "line 11, knob.match", "is missing");
}

TEST(Config, WrongValuesAreRefusedAndLeaveTheDefault) {
  for (const char* text : {"packs = \"a.lwp\"",
                           "packs = [1]",
                           "packs = [\"\"]",
                           "scene = \"a\\u0001b\"",
                           "[display]\nplatform = \"x11\"",
                           "[display]\nrotation = 45",
                           "[display]\nrotation = 90.0",
                           "[display]\nrotation = -90",
                           "[display]\nmode = \"0x0\"",
                           "[display]\nmode = \"99999x99999\"",
                           "[display]\nrefresh_hz = -1",
                           "[display]\nrefresh_hz = 9223372036854775807",
                           "[display]\nseat = \"mine\"",
                           "[picture]\nquality = \"ultra\"",
                           "[picture]\nstill_frames = 257",
                           "[picture]\nframe_ms = 16.6",
                           "[panel]\nwhite = [0.3]",
                           "[panel]\nwhite = [nan, 0.3]",
                           "[panel]\nwhite = [0.9, 0.9]",
                           "[panel]\nred = [0.2, 0.2]",
                           "[panel]\ncurve = 0.5",
                           "[panel]\ncurve = [1, 0]",
                           "[panel]\ncurve = []",
                           "[panel]\ncurve = \"gamma\"",
                           "[panel]\ngamut_warning = 1",
                           "[panel]\nicc = \"a\"\nwhite = [0.3127, 0.329]",
                           "[interface]\nlanguage = \"fr\"",
                           "[interface]\nlanguage = 1",
                           "[interface]\ndpi = 29.9",
                           "[interface]\ndpi = -1",
                           "[interface]\nidle_s = 4",
                           "[interface]\ncountdown_s = 61",
                           "[interface]\nnight = \"20:00\"",
                           "[interface]\nnight = \"20:00-24:00\"",
                           "[interface]\nnight = \"20:60-08:00\"",
                           "[interface]\nnight = \"08:00-08:00\"",
                           "[interface]\nnight = \"8:00-9:00\"",
                           "[interface]\nnight = 20:00:00",
                           "[interface]\nbrightness = 0.1",
                           "[interface]\npin = \"1234\"",
                           "[interface]\npin = 1234",
                           "[interface]\ndrift_px = 25",
                           "[interface]\nattract_brightness = 1.1",
                           "[interface]\nreduced_motion = 1",
                           "[input]\nudev_seat = \"\"",
                           "[knobs]\nacceleration = inf",
                           "[knobs]\nacceleration = -1e-5",
                           "[knobs]\naxis = \"w\"",
                           "[knobs]\ndetents_per_turn = 0",
                           "[[knob]]\nmatch = \"\"",
                           "[[knob]]\nmatch = \"a\"\nprofile = \"dial\"",
                           "[touch]\nmatch = \"a\"",
                           "touch = 1",
                           "knob = [1]",
                           "display = 3",
                           "[[display]]",
                           "[[touch]]\ncalibration = [0, 0, 0, 0, 0, 0]",
                           "[[touch]]\ncalibration = [1, 0, inf, 0, 1, 0]",
                           "[[touch]]\ndevice = \"a\"",
                           "x = 1",
                           "\"\" = 1",
                           "a.b.c = 1"}) {
    const auto reading = parse(text);
    EXPECT_EQ(reading.errors.size(), 1u) << text << "\n" << lines(reading);
    for (const Error& error : reading.errors) {
      EXPECT_NE(error.field.find("line "), std::string::npos) << text;
      EXPECT_FALSE(error.remedy.empty()) << text;
    }
  }
  EXPECT_EQ(parse("[display]\nrotation = 45").config.output.rotation, Rotation::none);
}

TEST(Config, SyntaxErrorsNameTheirLine) {
  const auto reading = parse("scene = \"a\"\npacks = [\n");
  ASSERT_EQ(reading.errors.size(), 1u);
  EXPECT_EQ(reading.errors[0].field.substr(0, 5), "line ");
  EXPECT_EQ(parse("scene = \"a\"\nscene = \"b\"\n").errors.size(), 1u) << "said twice";
  EXPECT_EQ(parse(std::string("\xff\xfe")).errors.size(), 1u);
  // toml++ 3.3 asserts on these.
  for (const char* header : {"[=]", "[[ %x]]", "[", "[ \nx = 1]", "packs = [}0", "packs = 1979-05-27true",
                             "x = 07:32:00", "x = 8'9-\xc9\xbd", "touch = [{match = 1}]", "\xef\xbb\xbf[.a]",
                             "[\xc3\xa4]", "scene = \xc3\xa4", "scene = \"a\" \xc3\xa4", "scene = \"\"\"a\"\"\""}) {
    const auto odd = parse("\n" + std::string(header));
    ASSERT_EQ(odd.errors.size(), 1u) << header;
    EXPECT_EQ(odd.errors[0].field, "line 2") << header;
    EXPECT_EQ(parse(header).errors.size(), 1u) << header;
  }
}

TEST(Config, TextsAndCommentsMayHoldAnyLetters) {
  const auto reading = parse(
      "# gr\xc3\xbcn\nscene = \"L\xc3\xa4"
      "cke/\\\"blau\\\".lws\" # \"\"\" \xc3\xa4\n");
  EXPECT_TRUE(reading.errors.empty()) << lines(reading);
  EXPECT_EQ(reading.config.scene,
            "L\xc3\xa4"
            "cke/\"blau\".lws");
}

// toml++ looks ahead to the next blank or comma for a number, into a text that has no blank before it.
TEST(Config, TextsWithLettersBeyondAsciiStandByThemselves) {
  for (const char* text : {"name=\"ä\"", "name='ä'", "x=[\"ä\"]", "x = [\"a\",\"ö\"]\ny=\"aä\"", "a.\"ä\" = 1"}) {
    const auto refused = packs::refused_by_gate("# ok\n" + std::string(text));
    ASSERT_TRUE(refused) << text;
    EXPECT_EQ(refused->line, std::string_view(text).find('\n') == std::string_view::npos ? 2u : 3u) << text;
    EXPECT_NE(std::string_view(refused->what).find("beyond ASCII"), std::string_view::npos) << text;
  }
  for (const char* text : {"name = \"ä\"", "name =\t'ä'", "x = [\"ä\", \"ö\"]", "x = [[\"ä\"],[\"ö\"]]",
                           "x = [\n\"ä\",\"ö\"]", "\"ä\" = 1", "name=\"a\" # ä", "name=\"\\u00e4\""})
    EXPECT_FALSE(packs::refused_by_gate(text)) << text;
  EXPECT_EQ(parse("scene=\"ä\"").errors.size(), 1u);
  EXPECT_EQ(parse("scene = \"ä\"").config.scene, "ä");
}

TEST(Config, SizesAreBounded) {
  EXPECT_EQ(parse("# " + std::string(max_config_bytes, 'x')).errors.size(), 1u);
  EXPECT_EQ(parse("scene = \"" + std::string(4097, 'x') + "\"").errors.size(), 1u);
  EXPECT_TRUE(parse("scene = \"" + std::string(4096, 'x') + "\"").errors.empty());
  std::string many;
  for (std::size_t k = 0; k <= input::max_touch_settings; ++k) many += "[[touch]]\n";
  EXPECT_EQ(parse(many).errors.size(), 1u);
  EXPECT_EQ(parse("packs = " + std::string(20'000, '[')).errors.size(), 1u) << "deep, not dead";
}

// The ranges in the table and those of the knobs' own check stand in two rooms: here they meet.
TEST(Config, KnobRangesAreThoseOfTheKnobs) {
  for (const auto& key : knob_section().keys) {
    input::KnobMatch knob;
    const Slot slot = key.slot(knob);
    if (!std::holds_alternative<double*>(slot)) continue;
    double& value = *std::get<double*>(slot);
    for (const double inside : {key.least, key.most}) {
      value = inside;
      EXPECT_FALSE(input::complaint(knob.tuning)) << key.name;
    }
    for (const double outside : {key.least - 0.01, key.most + 0.01}) {
      value = outside;
      EXPECT_TRUE(input::complaint(knob.tuning)) << key.name;
    }
  }
  const auto axis = std::find_if(knob_section().keys.begin(), knob_section().keys.end(),
                                 [](const auto& key) { return key.name == "axis"; });
  ASSERT_NE(axis, knob_section().keys.end());
  for (const std::string& word : axis->words()) {
    input::KnobTuning tuning;
    tuning.axis = word;
    EXPECT_FALSE(input::complaint(tuning)) << word;
  }
}

TEST(Config, FilesAreReadOrSaidWhyNot) {
  const auto folder = std::filesystem::temp_directory_path() / "lackwerk_config_test";
  std::filesystem::create_directories(folder);
  EXPECT_FALSE(read_config(folder / "none.toml"));
  EXPECT_FALSE(read_config(folder)) << "a folder";
  const auto path = folder / "kiosk.toml";
  std::ofstream(path) << "scene = \"car.lws\"\n";
  const auto good = read_config(path);
  ASSERT_TRUE(good);
  EXPECT_EQ(good->scene, "car.lws");
  std::ofstream(path) << "scen = \"car.lws\"\n";
  const auto one = read_config(path);
  ASSERT_FALSE(one);
  EXPECT_EQ(one.error().field, "line 1, scen");
  std::ofstream(path) << "scen = \"car.lws\"\n[display]\nrotation = 1\n";
  const auto two = read_config(path);
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().what.substr(0, 10), "2 mistakes");
  EXPECT_NE(two.error().what.find("\n  line 1, scen: "), std::string::npos) << two.error().what;
  EXPECT_NE(two.error().what.find("\n  line 3, display.rotation: "), std::string::npos) << two.error().what;
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace lackwerk::kiosk
