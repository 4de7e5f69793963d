// Where a fit starts: the best of a grid of roughnesses, each with its best non-negative weights.
//
// Why it exists: the error of a sum of lobes has many minima over the roughnesses, so they are searched as a whole. For
// given m the model is linear: with u = s f0 and v = s a lobe is shape * (u (1 - p) + v p), p = (1 - h.o)^5. So every
// tuple of grid roughnesses costs one small non-negative least-squares problem over a Gram matrix made once (variable
// projection: Golub & Pereyra 1973; NNLS: Lawson & Hanson 1974, chapter 23). A pure function; any thread;
// deterministic.
#pragma once

#include <span>
#include <vector>

#include "core/analysis/brdf_fit_model.hpp"

namespace lackwerk::core {

/// At most `count` parameter vectors that differ in roughness, best first. At least one.
[[nodiscard]] std::vector<std::vector<double>> fit_starts(const FitLayout& layout, std::span<const FitPoint> points,
                                                          int count);

}  // namespace lackwerk::core
