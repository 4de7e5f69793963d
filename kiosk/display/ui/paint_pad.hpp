// The paint pad: a puck among swatches sets the weights (the capsule demo of Golla & Klein 2018, section 5 and
// Figure 7, as a touch surface).
//
// Why it exists: the one gesture the kiosk is about. Pure; any thread.
#pragma once

#include <vector>

#include "kiosk/display/ui/model.hpp"

namespace lackwerk::kiosk::ui {

/// A puck this near to a swatch's place is on it, in parts of the pad. Derived: the swatch's own radius on screen.
inline constexpr double on_swatch = 0.035;
/// Swatches are kept at least this far apart, so that the weights stay continuous.
inline constexpr double least_gap = 0.22;

/// Weights by distance, one a swatch, each in [0, 1], sum 1: exactly one is 1 within on_swatch of its place; continuous
/// in puck and places. One: {1}. Two: linear along the line between them. More: inverse squared distance, each counted
/// from the swatch's rim (Shepard 1968).
[[nodiscard]] std::vector<double> pad_weights(const std::vector<Place>& swatches, Place puck);

/// The puck's place for weights somebody else has set: its weights are the nearest to these (least squares) that the
/// pad can give, found to 1e-3 of the pad.
[[nodiscard]] Place puck_for(const std::vector<Place>& swatches, const std::vector<double>& weights);

/// `places` with swatch `k` moved towards `to`: inside the pad and least_gap from the others; where that cannot be, as
/// near as it goes.
[[nodiscard]] std::vector<Place> move_swatch(std::vector<Place> places, std::size_t k, Place to);

/// Beyond the measured paints: (1 + b) w - b / n for every paint. Sum stays 1. `b` in [0, the pack's limit].
[[nodiscard]] std::vector<double> go_beyond(const std::vector<double>& weights, double b);

}  // namespace lackwerk::kiosk::ui
