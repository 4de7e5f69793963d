// The path of a slider or a knob through the paints of a pack.
//
// Why it exists: a customer moves one thing, a pack holds many paints. Position k is exactly paint k; between whole
// positions two neighbours are mixed. A slider's path has two ends, a knob's goes on from the last paint to the first.
// Pure; any thread.
#pragma once

#include <vector>

namespace lackwerk::kiosk {

enum class PathEnds {
  open,    ///< positions in [0, n-1]
  closed,  ///< positions in [0, n), n is 0 again
};

/// Brings a position onto the path: an open one stops at its ends, a closed one goes round. Not finite: 0.
/// `paints`: at least 1.
[[nodiscard]] double on_path(double position, int paints, PathEnds ends);

/// One weight per paint, sum 1: at most two are not 0. Continuous; at a whole position exactly one is 1.
[[nodiscard]] std::vector<double> weights_at(double position, int paints, PathEnds ends);

/// The position whose weights are nearest to these (least squares): where a knob goes on from after somebody else has
/// set the weights. Not `paints` finite numbers: 0.
[[nodiscard]] double nearest_position(const std::vector<double>& weights, int paints, PathEnds ends);

}  // namespace lackwerk::kiosk
