// A run on a virtual clock: a fixed number of frames, each drawn and perhaps written.
//
// Why it exists: tests, benchmarks and recorded tours must not depend on how fast the machine is. It shares everything
// with the live kiosk but the clock and the panel. One GL thread.
#pragma once

#include "kiosk/display/loop.hpp"
#include "kiosk/display/options.hpp"
#include "kiosk/display/stage.hpp"

namespace lackwerk::kiosk {

/// Runs options.frames frames, thirty a virtual second. Errors: script, folder or picture file, weights refused.
[[nodiscard]] Result<RunSummary> record(const Options& options, Stage& stage, bool vouched);

}  // namespace lackwerk::kiosk
