// Fitting the paint model to a measured BRDF: diffuse part, up to three Cook-Torrance lobes, and their colour.
//
// Why it exists: measurements become paints that can be mixed. After Guenther et al. 2005, section 4.2: multi-lobe
// Cook-Torrance, a robust log error, bounded parameters, the clear coat's peak as a lobe of its own. Unlike theirs the
// start is searched for (brdf_fit_start.hpp) and not guessed. Pure functions; any thread; the same numbers for the same
// input, whatever the machine's number of threads.
//
// Two forms of colour: per lobe (s and diffuse have three channels each), or grey lobes below a colour table
// chi(theta_h, theta_d) that carries colour and what the lobes leave. Neither coat nor refraction is fitted: the fit is
// in air, as Guenther's own rows are, and coat_ior and refraction_ior come back as 1.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/analysis/brdf_fit_report.hpp"
#include "core/analysis/brdf_fit_samples.hpp"
#include "core/error.hpp"
#include "core/paint.hpp"

namespace lackwerk::core {

enum class FitColour : std::uint8_t { lobes = 0, table = 1 };

struct FitOptions {
  int lobes = 3;  ///< most, [0, max_lobes]; fewer where they gain nothing or there are too few values
  FitColour colour = FitColour::lobes;
  std::uint16_t table_nodes = 46;  ///< num_theta of the colour table, [2, 256]; 46: every 2 degrees
  std::uint32_t samples = 6000;    ///< cells taken from a table, [1000, 1000000]
  int starts = 4;                  ///< [1, 16]
  Brdf known;  ///< part of the measured BRDF that the flakes make (their mean): not fitted. Empty: none
};

struct BrdfFit {
  AnalyticPaint paint;
  int lobes = 0;           ///< that have weight
  std::size_t points = 0;  ///< values that counted
  std::size_t masked = 0;  ///< values that did not: negative, not finite, beyond fit_min_cosine
  bool has_converged = false;
  FitCondition condition;  ///< of the lobes; for the table form, with the table held
  FitErrors errors;        ///< over what was given: all cells of a table, or the samples
};

/// Fits samples. Fewer lobes where there are not twice as many numbers (3 a sample) as parameters. Errors: no sample
/// counts; a colour table from fewer samples than it has nodes with theta_h + theta_i <= 90 degrees.
[[nodiscard]] Result<BrdfFit> fit_brdf(std::span<const BrdfSample> samples, const FitOptions& options = {});

/// Fits a table through table_samples, its known part from the options (samples carry their own); `filled` marks cells
/// that are guesses (fill_holes) and get no weight.
[[nodiscard]] Result<BrdfFit> fit_brdf(const BrdfTable& table, const FitOptions& options = {},
                                       const std::vector<std::uint8_t>& filled = {});

}  // namespace lackwerk::core
