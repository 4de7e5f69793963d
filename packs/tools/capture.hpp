// A capture: one measured (or virtually measured) paint before any statistics, in a folder.
//
// Why it exists: it is the door for real measurements. It holds AxF CarPaint2's quantities one to one, so whoever has
// that SDK can export into it. `paint.toml` carries names, provenance, lobes, IOR, layout; `colour.exr` the colour
// table, `flakes/slice_NN.exr` one HDR image per slice. Values; any thread. Files are read and written here only.
//
// Conventions: flake texels are the radiance factor pi * Xi (not radiance, not the BRDF) in linear sRGB, >= 0.
// AnalyticPaint holds lobes already lowered by what the flakes reflect, so that BRDF + mean flakes is the paint.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "core/analysis/brdf_table.hpp"
#include "core/error.hpp"
#include "core/paint.hpp"
#include "core/slice_layout.hpp"
#include "packs/paint_form.hpp"

namespace lackwerk::packs {

/// One square HDR image, linear sRGB, row-major, `edge * edge` texels.
struct FlakeSlice {
  std::vector<glm::vec3> texels;
};

/// How long flakes shine: half widths of the texels' autocorrelation (core/analysis/angular_life.hpp), measured at
/// angle steps much finer than the slices'. 90: it does not fall to 1/2.
struct MeasuredLife {
  double half_h_deg = 0.0;  ///< along theta_h, (0, 90]
  double half_i_deg = 0.0;  ///< along theta_i
  bool operator==(const MeasuredLife&) const = default;
};

/// One reading of a spectrophotometer, in the plane of incidence. Angles as the trade names them: "15as45" is 15
/// degrees from the mirror direction towards the light, lit at 45 degrees.
struct AngleReading {
  double light_deg = 45.0;     ///< from the normal, [0, 90)
  double aspecular_deg = 0.0;  ///< from the mirror direction, towards the light positive, "as-15" is negative
  glm::dvec3 lab{0.0};         ///< CIE Lab, D65, of the radiance factor (white = 100)
};

struct Capture {
  core::PaintIdentity identity;
  core::AnalyticPaint analytic;
  core::SliceLayout layout;        ///< empty: the paint has no flakes (a plain paint)
  std::uint32_t edge_texels = 0;   ///< per slice edge, [1, 4096]
  float texel_mm = 0.0f;           ///< edge of one texel on the paint, > 0
  std::vector<FlakeSlice> slices;  ///< layout.slice_count() of them
  std::optional<MeasuredLife> life;
  /// What was measured, where it was a whole BRDF (`brdf.exr`) or some angles (`angles.csv`): the fit's input, kept
  /// with the capture so that its error can be told again. `analytic` is then nothing until `lackwerk fit` has been
  /// run.
  std::optional<core::BrdfTable> measured;
  std::vector<AngleReading> angles;
  bool is_fitted = true;              ///< false: `analytic` stands for nothing yet, and no pack is built from it
  PaintForm form = PaintForm::given;  ///< how `analytic` was found
};

/// Reads a capture folder. Errors name file and field: missing or truncated images, wrong sizes, NaN or negative
/// texels, lobes out of range.
[[nodiscard]] Result<Capture> read_capture(const std::filesystem::path& folder);

/// Writes (and replaces) a capture folder.
[[nodiscard]] Result<void> write_capture(const Capture& capture, const std::filesystem::path& folder);

}  // namespace lackwerk::packs
