#include "kiosk/display/morph_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/check.hpp"

namespace lackwerk::kiosk {

double on_path(double position, int paints, PathEnds ends) {
  check_at_most(1, paints, "paints on a path");
  if (!std::isfinite(position)) return 0.0;
  if (ends == PathEnds::open) return std::clamp(position, 0.0, static_cast<double>(paints - 1));
  const double n = paints;
  const double rest = std::fmod(position, n);
  // A tiny negative rest plus n rounds to n, which is 0 again.
  const double wrapped = rest < 0.0 ? rest + n : rest;
  return wrapped < n ? wrapped : 0.0;
}

std::vector<double> weights_at(double position, int paints, PathEnds ends) {
  const double place = on_path(position, paints, ends);
  const double before = std::floor(place);
  const auto k = static_cast<std::size_t>(before);
  std::vector<double> weights(static_cast<std::size_t>(paints), 0.0);
  weights[k] = 1.0 - (place - before);
  weights[(k + 1) % weights.size()] += place - before;
  return weights;
}

double nearest_position(const std::vector<double>& weights, int paints, PathEnds ends) {
  check_at_most(1, paints, "paints on a path");
  const auto n = static_cast<std::size_t>(paints);
  if (weights.size() != n || !std::all_of(weights.begin(), weights.end(), [](double w) { return std::isfinite(w); }))
    return 0.0;
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  const std::size_t segments = ends == PathEnds::closed && n > 1 ? n : n - 1;
  for (std::size_t k = 0; k < segments; ++k) {
    const std::size_t next = (k + 1) % n;
    // d/df of (w_k - (1 - f))^2 + (w_next - f)^2 is 0 at f = (1 + w_next - w_k) / 2.
    const double f = std::clamp((1.0 + weights[next] - weights[k]) / 2.0, 0.0, 1.0);
    // Against |w|^2, which is the same for all segments.
    const double misfit = (1.0 - f) * (1.0 - f) + f * f - 2.0 * ((1.0 - f) * weights[k] + f * weights[next]);
    if (misfit >= least) continue;
    least = misfit;
    best = static_cast<double>(k) + f;
  }
  return on_path(best, paints, ends);
}

}  // namespace lackwerk::kiosk
