// Fuzz target: any text as the table of a spectrophotometer.
//
// Input: the text. Whatever comes: no sanitizer finding, every refusal on one line with its remedy, rows of one length,
// and what is taken is readings at angles that light and eye can have, of colours that a capture can keep.
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "core/analysis/standard_angles.hpp"
#include "core/in_plane.hpp"
#include "packs/tools/angle_table.hpp"
#include "packs/tools/csv_table.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace lackwerk;
using fuzz::require;

template <class T>
void require_told(const Result<T>& result) {
  if (result) return;
  const Error& error = result.error();
  require(error.file == "fuzz.csv" && !error.what.empty() && !error.remedy.empty());
  require(error.line().find('\n') == std::string::npos);
}

void table(std::string_view text) {
  const auto csv = packs::parse_csv(text, "fuzz.csv");
  require_told(csv);
  if (!csv) return;
  require(!csv->rows.empty() && csv->rows.size() <= 1024);
  for (const auto& row : csv->rows) {
    require(row.size() == csv->rows[0].size() && !row.empty() && row.size() <= 1024);
    for (const auto& cell : row) {
      require(cell.line >= 1 && cell.line <= text.size() + 1);
      if (const auto number = packs::csv_number(cell.text, csv->decimal_comma)) require(std::isfinite(*number));
    }
  }
  const packs::CsvTable back = packs::transposed(packs::transposed(*csv));
  require(back.rows.size() == csv->rows.size() && back.rows[0].size() == csv->rows[0].size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  table(text);
  const auto capture = packs::parse_angle_table(text, "fuzz.csv");
  require_told(capture);
  if (!capture) return 0;
  require(!capture->is_fitted && !capture->angles.empty() && capture->angles.size() <= 64);
  require(!capture->identity.name.empty() && !capture->identity.source.empty());
  constexpr double highest_lab = 1e5;  // of what a capture's angles.csv may hold (docs/capture.md)
  for (const packs::AngleReading& reading : capture->angles) {
    require(reading.light_deg >= 0.0 && reading.light_deg < 90.0);
    require(std::abs(reading.aspecular_deg) <= 180.0);
    require(std::abs(core::eye_deg(reading.light_deg, reading.aspecular_deg)) < 90.0);
    require(!core::angle_name({reading.light_deg, reading.aspecular_deg}).empty());
    require(reading.lab.x >= -1e-9 && reading.lab.x <= highest_lab);
    require(std::abs(reading.lab.y) <= highest_lab && std::abs(reading.lab.z) <= highest_lab);
  }
  return 0;
}
