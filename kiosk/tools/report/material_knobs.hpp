// The report's knobs of how a material is written down: the engine fit's samples, the isochromatic map's cure.
//
// Why it exists: both replace a paint by something smaller that other programs can draw; what that costs is measured on
// the demo's paints, whose whole truth is known. Free functions; one thread.
#pragma once

#include "core/error.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

/// Part "materials": knobs "ggx_samples" and "isochromatic". Error: what the bench cannot make.
[[nodiscard]] Result<void> add_materials(Workbench& bench, Findings& findings);

[[nodiscard]] Result<Knob> ggx_samples_knob(Workbench& bench);
[[nodiscard]] Result<Knob> isochromatic_knob(Workbench& bench);

}  // namespace lackwerk::report
