// How fast a drag is answered: realise() of packs of several sizes, beside the memory's own speed.
//
// Why it exists: it is the one kernel that runs in every frame of a drag. One thread.
#pragma once

#include "core/error.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

[[nodiscard]] Result<void> add_realise(Workbench& bench, Findings& findings);

}  // namespace lackwerk::report
