// What a report's pages say in common: stiff cases by kernel, verdicts of speeds, units.
//
// Why it exists: page and document must not count differently. Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "kiosk/tools/report/findings.hpp"

namespace lackwerk::report {

/// The stiff cases of one kernel that share a measure and a bound.
struct StiffGroup {
  std::string kernel, measure;
  double bound = 0.0;
  std::vector<const StiffCase*> cases;  ///< in the order they were found
  const StiffCase* worst = nullptr;     ///< the largest; one that is no number above all
  int failed = 0;
};

[[nodiscard]] std::vector<StiffGroup> stiff_groups(const Findings& findings);
[[nodiscard]] int failed_cases(const Findings& findings);
[[nodiscard]] int missed_aims(const Findings& findings);

/// "12.3 ms (11.9 to 12.8, n 31)"; "-" if not measured.
[[nodiscard]] std::string timing_text(const Timing& timing);
/// "1.14 MB", "300 kB", "24 B"; "-" if not measured.
[[nodiscard]] std::string bytes_text(double bytes);
/// ">= 20 million texels/s", "at most 1 ms", "for the record".
[[nodiscard]] std::string aim_text(const Speed& speed);

}  // namespace lackwerk::report
