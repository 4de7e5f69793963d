// The kiosk's command line.
//
// Why it exists: it is parsed without a library (the kiosk stays lean) and tested without a kiosk. Values; any thread.
#pragma once

#include <optional>
#include <string>

#include "core/error.hpp"
#include "kiosk/display/config.hpp"

namespace lackwerk::kiosk {

struct Options {
  Config config;              ///< kiosk.toml, and over it what the command line says
  std::optional<int> frames;  ///< on a virtual clock of 30 a second on headless platforms; else pictures on the panel
  std::string input_script, screenshot, record;
  int record_samples = 1;  ///< samples a pixel of recorded frames
  std::string import;      ///< take packs from the stick that is mounted there, instead of showing anything
  bool help = false, version = false, sample_config = false, hash_pin = false;

  /// Platforms without a panel can run on a virtual clock, and have no devices.
  [[nodiscard]] bool headless() const {
    return config.output.platform == Platform::surfaceless || config.output.platform == Platform::osmesa;
  }
};

inline constexpr int max_frames = 1'000'000;

/// Errors are usage errors that name the option, or those of the configuration file.
[[nodiscard]] Result<Options> parse_options(int argc, char** argv);

/// What `--help` prints.
[[nodiscard]] const char* help_text();

}  // namespace lackwerk::kiosk
