// The kiosk's command line.
//
// Why it exists: it is parsed without a library (the kiosk stays lean) and tested without a kiosk. Values; any thread.
#pragma once

#include <optional>
#include <string>

#include "core/error.hpp"
#include "kiosk/display/stage.hpp"
#include "render_gles/context.hpp"

namespace lackwerk::kiosk {

struct Options {
  std::string pack, scene;
  gles::Backend backend = gles::Backend::egl_surfaceless;
  Size size;
  std::optional<int> frames;  ///< run this many on a virtual clock of 30 a second, then end
  std::string input_script, screenshot, record;
  int record_samples = 1;  ///< samples a pixel of recorded frames
  bool help = false, version = false;
};

inline constexpr int max_frames = 1'000'000;

/// Errors are usage errors that name the option.
[[nodiscard]] Result<Options> parse_options(int argc, char** argv);

/// What `--help` prints.
[[nodiscard]] const char* help_text();

}  // namespace lackwerk::kiosk
