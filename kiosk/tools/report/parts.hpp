// The parts of a report, in the order they run.
//
// Why it exists: `lackwerk report` shows progress and remaining time, so it must know the parts and about how long each
// takes; `--only` runs some. Each part adds its knobs, stiff cases and speeds to the findings. Free functions; one
// thread. Error: an input could not be made (a recipe is missing, no GL context).
#pragma once

#include <span>
#include <string_view>

#include "core/error.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

struct Part {
  std::string_view name;   ///< "transport"; for --only
  double quick_s, full_s;  ///< about how long it takes on two cores: what the progress goes by
  Result<void> (*run)(Workbench&, Findings&);
};

[[nodiscard]] std::span<const Part> parts();

}  // namespace lackwerk::report
