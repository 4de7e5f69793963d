#include "kiosk/tools/report/flake_knobs.hpp"

#include <array>

namespace lackwerk::report {

Result<void> add_flakes(Workbench& bench, Findings& findings) {
  using Step = Result<void> (*)(Workbench&, Findings&);
  constexpr std::array<Step, 6> steps = {add_flake_clusters, add_flake_ranks,  add_flake_corners,
                                         add_flake_angles,   add_flake_levels, add_flake_memory};
  for (const Step step : steps)
    if (auto ok = step(bench, findings); !ok) return ok;
  return {};
}

}  // namespace lackwerk::report
