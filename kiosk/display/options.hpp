// The kiosk's command line.
//
// Why it exists: it is parsed without a library (the kiosk stays lean) and tested without a kiosk. Values; any thread.
#pragma once

#include <optional>
#include <string>

#include "core/error.hpp"
#include "kiosk/display/stage.hpp"
#include "render_gles/context.hpp"
#include "render_gles/renderer.hpp"

namespace lackwerk::kiosk {

struct Options {
  std::string pack, scene;
  gles::Backend backend = gles::Backend::egl_surfaceless;
  gles::CoreEs2 core_es2 = gles::CoreEs2::off;
  Size size;
  std::optional<int> frames;  ///< run this many on a virtual clock of 30 a second, then end
  std::string input_script, screenshot, record;
  int record_samples = 1;                 ///< samples a pixel of recorded frames
  std::string quality = "auto";           ///< a rung of gles::quality_ladder, or auto
  int frame_ms = 62;                      ///< what auto holds: 16 frames a second on machines without a GPU
  int still_frames = gles::still_frames;  ///< 0: a picture that does not change is left as it moved
  bool help = false, version = false;
};

inline constexpr int max_frames = 1'000'000;

/// Errors are usage errors that name the option.
[[nodiscard]] Result<Options> parse_options(int argc, char** argv);

/// What `--help` prints.
[[nodiscard]] const char* help_text();

}  // namespace lackwerk::kiosk
