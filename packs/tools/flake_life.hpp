// The angular life of flakes, before and after: of a recipe's own flakes, of a capture's slices, and of what a pack's
// random cells make of them.
//
// Why it exists: the renderer's flakes must twinkle as fast as the source's (core/analysis/angular_life.hpp says how
// that is measured), and whoever builds a pack wants to see both curves in one plot. Pure functions; any thread.
#pragma once

#include <cstddef>
#include <optional>

#include "core/analysis/angular_life.hpp"
#include "core/error.hpp"
#include "core/interpolatable_paint.hpp"
#include "packs/tools/capture.hpp"
#include "packs/tools/recipe.hpp"
#include "packs/tools/virtual_goniometer.hpp"

namespace lackwerk::packs {

/// A row of pictures along one angle, the other one fixed.
struct LifeScan {
  bool along_h = true;
  double other_deg = 0.0;  ///< the fixed angle
  double step_deg = 0.5;
  std::size_t pictures = 60;
  std::size_t starts = 30;  ///< first angles that are averaged over; pictures - starts lags
};
/// theta_h at theta_i = 0: from 0 to 14.5 degrees on, where flakes are bright, at lags up to 15 degrees.
inline constexpr LifeScan life_scan_h{};
/// theta_i at theta_h = 0: from 0 to 30 degrees on, at lags up to 45 degrees.
inline constexpr LifeScan life_scan_i{false, 0.0, 2.5, 31, 13};
/// Edge of the sample that is looked at, in texels: 6 mm hold hundreds of shining flakes.
inline constexpr std::uint32_t life_edge_texels = 128;

/// The recipe's own flakes, photographed along a scan. Errors as for photographs().
[[nodiscard]] Result<core::LifeCurve> source_curve(const Recipe& recipe, const GoniometerSettings& settings,
                                                   const LifeScan& scan);

/// Both half widths of the recipe's flakes.
[[nodiscard]] Result<MeasuredLife> source_life(const Recipe& recipe, const GoniometerSettings& settings);

/// The autocorrelation of a capture's slices along a scan's angle, at the layout's steps. Nothing where a row of the
/// layout has fewer than three slices.
[[nodiscard]] std::optional<core::LifeCurve> slice_curve(const Capture& capture, const LifeScan& scan);

/// What is known of a capture's life: its own measurement, else what its slices say. A correlation of less than 0.1 at
/// the first step tells only that a life is shorter than a bin: then default_life_deg along theta_h, and no end along
/// theta_i.
struct KnownLife {
  MeasuredLife life{core::half_width_of_life(core::default_life_deg), double{core::widest_cell_deg}};
  core::LifeOrigin origin = core::LifeOrigin::assumed;  ///< of the life along theta_h
};
[[nodiscard]] KnownLife known_life(const Capture& capture);

/// What the renderer shows of paint `index` of a pack alone, at level 0, through PaintModel<double>::flake_factor.
/// `edge` squared texels are looked at.
[[nodiscard]] core::LifeCurve reconstruction_curve(const core::InterpolatablePaint& paint, std::size_t index,
                                                   const LifeScan& scan, std::uint32_t edge = life_edge_texels);

}  // namespace lackwerk::packs
