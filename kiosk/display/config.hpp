// kiosk.toml: what an integrator sets once for a box, read as a whole or not at all.
//
// Why it exists: a kiosk in a showroom has no command line. Every key, its range, default and help stand once, in
// config_keys.cpp: the reader, its messages and the commented sample come from there. Values; any thread.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "input/knob_settings.hpp"
#include "input/touch_settings.hpp"
#include "kiosk/display/experience_settings.hpp"
#include "kiosk/display/output.hpp"
#include "kiosk/display/pack_places.hpp"
#include "kiosk/display/picture.hpp"

namespace lackwerk::kiosk {

struct Config {
  PackPlaces packs;           ///< what is shown
  std::string scene;          ///< .lws file
  OutputSettings output;      ///< without size and context, which are for the command line; profile: of [panel]
  std::string seat = "auto";  ///< who opens the devices: Seat::open()
  PictureSettings picture;
  InterfaceSettings interface;
  std::string icc;  ///< if not empty, the profile is in this file (read_icc) and output.profile is sRGB
  std::string input_seat = "seat0";  ///< udev's name of the seat whose touch screens are ours
  std::vector<input::TouchSettings> touch;
  input::KnobSettings knobs;
};

inline constexpr std::size_t max_config_bytes = 64 * 1024;

struct ConfigReading {
  Config config;              ///< keys with mistakes have their defaults
  std::vector<Error> errors;  ///< all of them, each with line and key where there is one, in order of lines
};

/// Reads a text of at most max_config_bytes. `file` is for the errors. No mistake in the text throws or aborts.
[[nodiscard]] ConfigReading parse_config(std::string_view text, const std::string& file);

/// Reads and parses a file. Error: cannot be read, too long, or all mistakes of the text in one: `what` then has a line
/// for each. A key that is absent has its default.
[[nodiscard]] Result<Config> read_config(const std::filesystem::path& path);

}  // namespace lackwerk::kiosk
