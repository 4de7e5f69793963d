// The report's knob of the clear coat's mirror image: how many look-ups a pixel has of it.
//
// Why it exists: the coat mirrors sharply, and a pixel of a curved body sees a piece of the room that may hold a whole
// lamp. Moving pictures look it up once a pixel, resting ones once a frame at another place in the pixel. Free
// function; one thread.
#pragma once

#include "core/error.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

/// Knob "coat". Error: what the bench cannot make.
[[nodiscard]] Result<Knob> coat_knob(Workbench& bench);

}  // namespace lackwerk::report
