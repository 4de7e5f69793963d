// The flake slices on which the report judges the flakes' knobs, and how errors over them are summed up.
//
// Why it exists: every knob of the flakes is to be judged on the same texels: of each paint near the mirror angle, in
// the middle and grazing, at several mip levels. Values; the slices own their texels; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

/// One mip level of one slice.
struct FlakeLevel {
  std::uint32_t edge = 0;         ///< texels
  std::vector<glm::vec3> linear;  ///< radiance factor, linear sRGB, row by row
  std::vector<glm::vec3> lab;     ///< the same in Lab
};

/// One slice of one paint with all its levels.
struct FlakeSample {
  std::string name;  ///< "Polaris Silber, theta_h 0, theta_i 0"
  std::vector<FlakeLevel> levels;
};

/// Slices at (theta_h, theta_i) bins (0, 0), (2, 2), (1, 5) of every paint, full reports also (4, 1). Error: as of
/// Workbench::captures.
[[nodiscard]] Result<std::vector<FlakeSample>> flake_samples(Workbench& bench);

/// Levels whose error is looked at: 0, 2 and 4, quick 0 and 3. What is beyond has fewer texels than clusters.
[[nodiscard]] std::vector<std::size_t> judged_levels(const Workbench& bench);

}  // namespace lackwerk::report
