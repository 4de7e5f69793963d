// Pairs of scans at their worst, morphed both ways.
//
// Why it exists: the report shows them and the unit tests hold them to their bounds. Pure; any thread.
#pragma once

#include "kiosk/tools/report/findings.hpp"

namespace lackwerk::report {

/// For each pair: points that do not leave or arrive, places that are no numbers, and how far marginals are off; for
/// each scan that cannot be morphed: whether it is refused with one line.
void add_stiff_scans(Findings& findings);

}  // namespace lackwerk::report
