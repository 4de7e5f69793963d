#include "kiosk/display/ui/paint_pad.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

namespace lackwerk::kiosk::ui {
namespace {

double distance(Place a, Place b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

bool is_finite(Place p) { return std::isfinite(p[0]) && std::isfinite(p[1]); }

Place on_pad(Place p) { return {std::clamp(p[0], 0.0, 1.0), std::clamp(p[1], 0.0, 1.0)}; }

Place between(Place a, Place b, double part) { return {a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part}; }

/// How much of the second of two paints: 0 and 1 from the swatches' rims on.
double share_of_second(Place first, Place second, Place puck) {
  const double length = distance(first, second);
  if (length <= 2.0 * on_swatch) return distance(puck, second) < distance(puck, first) ? 1.0 : 0.0;
  const double along =
      ((puck[0] - first[0]) * (second[0] - first[0]) + (puck[1] - first[1]) * (second[1] - first[1])) / length;
  return std::clamp((along - on_swatch) / (length - 2.0 * on_swatch), 0.0, 1.0);
}

double misfit(const std::vector<Place>& swatches, const std::vector<double>& wanted, Place puck) {
  const std::vector<double> weights = pad_weights(swatches, puck);
  double sum = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) sum += (weights[k] - wanted[k]) * (weights[k] - wanted[k]);
  return sum;
}

struct Try {
  Place at;
  double misfit;
};

/// Downhill in steps that halve, to far below 1e-3 of the pad.
Try refined(const std::vector<Place>& swatches, const std::vector<double>& wanted, Try best, double step) {
  constexpr double finest = 1e-6;
  constexpr int directions = 8;
  while (step > finest) {
    step *= 0.5;
    bool better = true;
    while (better) {
      better = false;
      for (int k = 0; k < directions; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / directions;
        const Place at = on_pad({best.at[0] + step * std::cos(angle), best.at[1] + step * std::sin(angle)});
        const double off = misfit(swatches, wanted, at);
        // By a part of it: steps that gain nothing never end.
        if (!(off < best.misfit * (1.0 - 1e-9))) continue;
        best = {at, off};
        better = true;
      }
    }
  }
  return best;
}

/// Whether `at` is far enough from all but the k-th. Rounding may not shut a swatch in.
bool is_free(const std::vector<Place>& places, std::size_t k, Place at) {
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (i != k && distance(places[i], at) < least_gap - rounding) return false;
  return true;
}

/// The free place nearest to `to` among `to` itself and those on the others' rings around it.
std::optional<Place> nearest_free(const std::vector<Place>& places, std::size_t k, Place to) {
  const Place inside = on_pad(to);
  if (is_free(places, k, inside)) return inside;
  std::optional<Place> best;
  double least = std::numeric_limits<double>::infinity();
  const auto offer = [&](Place at) {
    const bool on = at[0] >= -1e-12 && at[0] <= 1.0 + 1e-12 && at[1] >= -1e-12 && at[1] <= 1.0 + 1e-12;
    if (!on || !is_free(places, k, at) || distance(at, to) >= least) return;
    least = distance(at, to);
    best = on_pad(at);
  };
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i == k) continue;
    const Place c = places[i];
    // Straight out of the ring.
    const double off = distance(c, inside);
    if (off > 0.0) offer(between(c, inside, least_gap / off));
    // Where the ring meets the pad's edges.
    for (const double edge : {0.0, 1.0})
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double across = edge - c[axis];
        if (std::abs(across) > least_gap) continue;
        const double along = std::sqrt(least_gap * least_gap - across * across);
        for (const double side : {-along, along}) {
          Place at;
          at[axis] = edge;
          at[1 - axis] = c[1 - axis] + side;
          offer(at);
        }
      }
    // Where two rings meet.
    for (std::size_t j = i + 1; j < places.size(); ++j) {
      const double apart = distance(c, places[j]);
      if (j == k || apart <= 0.0 || apart > 2.0 * least_gap) continue;
      const double half = apart / 2.0, high = std::sqrt(least_gap * least_gap - half * half);
      const Place middle = between(c, places[j], 0.5);
      const Place across{-(places[j][1] - c[1]) / apart, (places[j][0] - c[0]) / apart};
      for (const double side : {-high, high}) offer({middle[0] + side * across[0], middle[1] + side * across[1]});
    }
  }
  return best;
}

}  // namespace

std::vector<double> pad_weights(const std::vector<Place>& swatches, Place puck) {
  const std::size_t n = swatches.size();
  std::vector<double> weights(n, 0.0);
  if (n == 0) return weights;
  const bool finite = is_finite(puck) && std::all_of(swatches.begin(), swatches.end(), is_finite);
  if (n == 1 || !finite) {
    weights[0] = 1.0;
    return weights;
  }
  if (n == 2) {
    weights[1] = share_of_second(swatches[0], swatches[1], puck);
    weights[0] = 1.0 - weights[1];
    return weights;
  }
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < n; ++k)
    if (distance(swatches[k], puck) < distance(swatches[nearest], puck)) nearest = k;
  const double least = distance(swatches[nearest], puck) - on_swatch;
  if (least <= 0.0) {
    weights[nearest] = 1.0;
    return weights;
  }
  // In parts of the least distance nothing overflows, however near the rim is.
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double part = least / (distance(swatches[k], puck) - on_swatch);
    sum += weights[k] = part * part;
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

Place puck_for(const std::vector<Place>& swatches, const std::vector<double>& weights) {
  const std::size_t n = swatches.size();
  if (n == 0) return {0.5, 0.5};
  const bool finite = std::all_of(weights.begin(), weights.end(), [](double w) { return std::isfinite(w); });
  if (n == 1 || weights.size() != n || !finite) return swatches[0];
  if (n == 2) {
    // d/df of (w0 - (1 - f))^2 + (w1 - f)^2 is 0 there.
    const double f = std::clamp((1.0 + weights[1] - weights[0]) / 2.0, 0.0, 1.0);
    if (f <= 0.0 || f >= 1.0) return swatches[f <= 0.0 ? 0 : 1];
    const double length = distance(swatches[0], swatches[1]);
    if (length <= 2.0 * on_swatch) return swatches[f < 0.5 ? 0 : 1];
    return between(swatches[0], swatches[1], (on_swatch + f * (length - 2.0 * on_swatch)) / length);
  }
  std::vector<Try> tries;
  tries.reserve(n);
  for (const Place& swatch : swatches) tries.push_back({swatch, misfit(swatches, weights, swatch)});
  // Weights change over a swatch's size, so the grid is finer than that.
  constexpr int cells = 32;
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x) {
      const Place at{static_cast<double>(x) / cells, static_cast<double>(y) / cells};
      tries.push_back({at, misfit(swatches, weights, at)});
    }
  // A swatch's own place first, then the best few: there can be several hollows.
  constexpr std::size_t kept = 6;
  std::stable_sort(tries.begin(), tries.end(), [](const Try& a, const Try& b) { return a.misfit < b.misfit; });
  if (tries.front().misfit <= 0.0) return tries.front().at;
  tries.resize(kept);
  Try best = tries.front();
  for (const Try& start : tries) {
    const Try found = refined(swatches, weights, start, 2.0 / cells);
    if (found.misfit < best.misfit) best = found;
  }
  return best.at;
}

std::vector<Place> move_swatch(std::vector<Place> places, std::size_t k, Place to) {
  if (k >= places.size() || !is_finite(to)) return places;
  // In steps well below the rings' size, so that a swatch slides around another one instead of jumping over it.
  constexpr double step = 0.02;
  constexpr int most_steps = 200;
  const Place goal = on_pad(to);
  for (int done = 0; done < most_steps; ++done) {
    const Place from = places[k];
    const double way = distance(from, goal);
    if (way <= 0.0) break;
    const std::optional<Place> next = nearest_free(places, k, way <= step ? goal : between(from, goal, step / way));
    // Nothing is free, or it goes no nearer.
    if (!next || (distance(*next, goal) >= way - 1e-12 && is_free(places, k, from))) break;
    places[k] = *next;
  }
  return places;
}

std::vector<double> go_beyond(const std::vector<double>& weights, double b) {
  std::vector<double> beyond = weights;
  const double shared = b / static_cast<double>(std::max<std::size_t>(weights.size(), 1));
  for (double& weight : beyond) weight = (1.0 + b) * weight - shared;
  return beyond;
}

}  // namespace lackwerk::kiosk::ui
