// Measured BRDF files become captures that wait for their fit.
//
// Why it exists: whatever a file's own coordinates are, fits and maps want a BrdfTable, a name that says what was
// measured, and figures that say how good it is. Values; any thread. Files are only read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "core/analysis/brdf_table.hpp"
#include "core/error.hpp"
#include "packs/tools/capture.hpp"

namespace lackwerk::packs {

struct BrdfImportSettings {
  std::string name;  ///< empty: from the file
  std::string note;  ///< added to the source, where not empty
  /// Of lobes, coat and (absent) flakes. Files made from fits or by simulation must be called so.
  core::Provenance provenance = core::Provenance::measured;
};

/// CIEDE2000 between two BRDFs' radiance factors over grid_pairs().
struct BrdfDifference {
  double mean = 0.0, p95 = 0.0, max = 0.0;
  std::size_t directions = 0;
};

/// What is told about an import.
struct BrdfImportReport {
  core::BrdfHealth health;      ///< of the file itself, where it can be evaluated at any directions, else of the table
  double highest_albedo = 0.0;  ///< of any channel at any of health's angles; above 1 energy is made
  double negative_share = 0.0;  ///< of colours outside sRGB, which the table cuts to 0 (rgl_file.hpp)
  std::size_t cells = 0;        ///< with both directions above the horizon
  std::size_t holes = 0;        ///< among them, left open: whoever fits fills them and gives them no weight
  /// The table against what it was sampled from, and against the file before it was made reciprocal. RGL only: the
  /// table of a MERL file is the file.
  std::optional<BrdfDifference> resampling, from_file;
};

/// Where "name" is not given: an RGL film's is its product's with ", vinyl film", so that no caption calls it a paint.
[[nodiscard]] Result<Capture> import_rgl(const std::filesystem::path& file, const BrdfImportSettings& settings,
                                         BrdfImportReport& report);
[[nodiscard]] Result<Capture> import_merl(const std::filesystem::path& file, const BrdfImportSettings& settings,
                                          BrdfImportReport& report);

/// A caption from an RGL file's own description, and its file name where that says nothing.
[[nodiscard]] std::string rgl_name(const std::string& description, const std::string& stem);

/// `a` and `b` at the same `count` pairs of directions; negative channels count as 0.
[[nodiscard]] BrdfDifference difference(const core::Brdf& a, const core::Brdf& b, std::size_t count);

}  // namespace lackwerk::packs
