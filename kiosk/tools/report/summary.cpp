#include "kiosk/tools/report/summary.hpp"

#include <algorithm>
#include <cmath>

#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

namespace {

/// Whether one case is worse than another: a figure that is no number is the worst.
bool worse(const StiffCase& one, const StiffCase& two) {
  if (std::isnan(one.worst) || std::isnan(two.worst)) return std::isnan(one.worst) && !std::isnan(two.worst);
  return one.worst > two.worst;
}

}  // namespace

std::vector<StiffGroup> stiff_groups(const Findings& findings) {
  std::vector<StiffGroup> groups;
  for (const StiffCase& one : findings.stiff) {
    auto found = std::find_if(groups.begin(), groups.end(), [&](const StiffGroup& group) {
      return group.kernel == one.kernel && group.measure == one.measure && group.bound == one.bound;
    });
    if (found == groups.end()) {
      // Beside the kernel's other groups, so that a table reads by kernel.
      auto place = std::find_if(groups.rbegin(), groups.rend(),
                                [&](const StiffGroup& group) { return group.kernel == one.kernel; });
      StiffGroup group;
      group.kernel = one.kernel;
      group.measure = one.measure;
      group.bound = one.bound;
      found = groups.insert(place == groups.rend() ? groups.end() : place.base(), std::move(group));
    }
    found->cases.push_back(&one);
    if (found->worst == nullptr || worse(one, *found->worst)) found->worst = &one;
    if (!one.passed()) ++found->failed;
  }
  return groups;
}

int failed_cases(const Findings& findings) {
  return static_cast<int>(
      std::count_if(findings.stiff.begin(), findings.stiff.end(), [](const StiffCase& one) { return !one.passed(); }));
}

int missed_aims(const Findings& findings) {
  return static_cast<int>(std::count_if(findings.speeds.begin(), findings.speeds.end(),
                                        [](const Speed& speed) { return !speed.reached(); }));
}

std::string timing_text(const Timing& timing) {
  if (timing.count == 0) return "-";
  return digits(timing.median_ms) + " ms (" + digits(timing.low_ms) + " to " + digits(timing.high_ms) + ", n " +
         std::to_string(timing.count) + ")";
}

std::string bytes_text(double bytes) {
  if (!std::isfinite(bytes)) return "-";
  if (bytes >= 1e6) return digits(bytes / 1e6) + " MB";
  if (bytes >= 1e3) return digits(bytes / 1e3) + " kB";
  return digits(bytes) + " B";
}

std::string aim_text(const Speed& speed) {
  if (!std::isfinite(speed.aim)) return "for the record";
  return std::string(speed.at_least ? "at least " : "at most ") + digits(speed.aim) + " " + speed.unit;
}

}  // namespace lackwerk::report
