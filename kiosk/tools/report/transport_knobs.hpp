// Solver and gamma of the transport between slices: error against run time.
//
// Why it exists: the exact solver is judged beside LEMON's and beside Sinkhorn's on the workbench's own paints. Free
// functions; one thread.
#pragma once

#include "core/error.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

/// The knob "transport", the speeds "transport" and "transport_best". Error: the captures cannot be made.
[[nodiscard]] Result<void> add_transport(Workbench& bench, Findings& findings);

}  // namespace lackwerk::report
