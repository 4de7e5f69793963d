// What the rungs of the quality ladder cost and show on one machine, as a file: quality.json.
//
// Why it exists: `lackwerk report` measures the rungs on the very machine that will draw them; the kiosk's governor
// goes by the same figures. The file comes from outside, so it is read like one: bounded, every rung known, none
// missing. Values; any thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "render_gles/governor.hpp"

namespace lackwerk::kiosk {

struct RungFigure {
  std::string name;         ///< of a rung of gles::quality_ladder
  double cost = 1.0;        ///< frame time over that of the first rung
  double error_mean = 0.0;  ///< CIEDE2000 of a moving picture of the car against the reference
  double error_p95 = 0.0;   ///< of the same
};

struct QualityTable {
  std::string renderer;           ///< GL_RENDERER of the machine it was measured on
  std::vector<RungFigure> rungs;  ///< every rung once, in the ladder's order

  /// For the governor. The table must have passed check_quality_table.
  [[nodiscard]] gles::RungCosts costs() const;
};

/// Costs beyond are none: rungs differ by a hundred times at most.
inline constexpr double least_rung_cost = 1e-3, most_rung_cost = 1e3;
inline constexpr std::size_t max_quality_table_bytes = 64 * 1024;

/// Whether every rung is there once, in the ladder's order, the first with cost 1, all costs in range, all errors
/// finite and not negative. `file` is for the error, which names the field.
[[nodiscard]] Result<void> check_quality_table(const QualityTable& table, const std::string& file);

/// Error: the table is none, or the file cannot be written.
[[nodiscard]] Result<void> write_quality_table(const std::filesystem::path& path, const QualityTable& table);

/// Rungs may stand in any order in the file; unknown keys are passed over. Errors: cannot be read, too long, no JSON,
/// or no table; they name file and field and what to do.
[[nodiscard]] Result<QualityTable> read_quality_table(const std::filesystem::path& path);

}  // namespace lackwerk::kiosk
