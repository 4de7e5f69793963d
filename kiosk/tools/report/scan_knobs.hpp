// Scans that grow: neighbours and gamma of the transport, and the spacing of the points, error against run time.
//
// Why it exists: the defaults of `lackwerk scan morph` are judged on a tree whose state between two scans is known.
// Free functions; one thread.
#pragma once

#include "core/error.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

/// The knobs "scan_neighbours", "scan_gamma" and "scan_spacing". Error: the tree cannot be morphed.
[[nodiscard]] Result<void> add_scans(Workbench& bench, Findings& findings);

}  // namespace lackwerk::report
