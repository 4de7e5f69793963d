// The report's precision knob: the paint model in long double, double, float and emulated 16 bits.
//
// Why it exists: GPUs offer two of these, and which one a shader may use is decided by what it loses. One thread.
#pragma once

#include "core/error.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

/// Adds knob "precision". Error: a recipe of the published paints is missing.
[[nodiscard]] Result<void> add_precision(Workbench& bench, Findings& findings);

}  // namespace lackwerk::report
