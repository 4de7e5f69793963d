// The knobs of the flakes: how many clusters, how their ranks and corners are stored, what is kept of angles and
// levels, and what all that takes in memory.
//
// Why it exists: part "flakes" of the report. Each function adds its knobs and speeds to the findings. Free functions;
// one thread. Error: a recipe cannot be found, or a pack cannot be built.
#pragma once

#include "core/error.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

/// All of the below, in this order.
[[nodiscard]] Result<void> add_flakes(Workbench& bench, Findings& findings);

/// Knobs "clusters" and "octree_depth", speed "octree".
[[nodiscard]] Result<void> add_flake_clusters(Workbench& bench, Findings& findings);
/// Knob "ranks": from a random number to a tuple.
[[nodiscard]] Result<void> add_flake_ranks(Workbench& bench, Findings& findings);
/// Knobs "corners" and "cuboid_space".
[[nodiscard]] Result<void> add_flake_corners(Workbench& bench, Findings& findings);
/// Knob "angle_taps".
[[nodiscard]] Result<void> add_flake_angles(Workbench& bench, Findings& findings);
/// Knob "levels".
[[nodiscard]] Result<void> add_flake_levels(Workbench& bench, Findings& findings);
/// Knob "memory", speeds "pack_bytes_per_paint", "gpu_bytes_per_paint" and "pack_build".
[[nodiscard]] Result<void> add_flake_memory(Workbench& bench, Findings& findings);

}  // namespace lackwerk::report
