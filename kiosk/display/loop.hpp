// The kiosk's main loop: input, state, realise, draw; and nothing at all while nothing changes.
//
// Why it exists: it is the one place where time passes. The clock is virtual when a number of frames is asked for, so
// that tests and recordings do not depend on the machine. One thread.
#pragma once

#include <cstdint>
#include <string>

#include "core/error.hpp"
#include "kiosk/display/options.hpp"

namespace lackwerk::kiosk {

struct RunSummary {
  std::uint64_t frames = 0;          ///< times the loop went round
  std::uint64_t drawn = 0;           ///< frames that were drawn, because something had changed
  std::uint64_t refined = 0;         ///< frames that improved a picture that did not change
  std::string quality;               ///< the rung moving pictures were last drawn on
  std::uint64_t uploaded_bytes = 0;  ///< paint textures sent
  double drawn_ms_median = 0.0;      ///< realise + upload + draw + finish, of the drawn frames
  double realise_ms_median = 0.0;    ///< realise + upload, of the frames whose weights had changed
};

/// Runs until the frames are done, the script has ended (real time only), or a signal asked to stop.
[[nodiscard]] Result<RunSummary> run(const Options& options);

/// Asks a running loop to end; safe in a signal handler.
void request_stop() noexcept;

}  // namespace lackwerk::kiosk
