// The report's knobs of the environment's light: how many lights it is cut into, how fine its map is.
//
// Why it exists: on the CPU both can be turned further than a scene file holds, against integrals that are exact. Free
// functions; one thread (the builder's own threads end with each call).
#pragma once

#include "core/error.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

/// Part "light": knobs "cut_lights", "environment" and "coat". Error: what the bench cannot make.
[[nodiscard]] Result<void> add_light(Workbench& bench, Findings& findings);

/// Irradiance of median cuts of the studio into 1 to 256 lights against the sum over the map.
[[nodiscard]] Result<Knob> cut_lights_knob(Workbench& bench);
/// Edges of the studio's octahedral levels, for mirrors and for two narrow lobes.
[[nodiscard]] Result<Knob> environment_knob(Workbench& bench);

}  // namespace lackwerk::report
