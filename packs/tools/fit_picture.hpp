// A fit for people: the measured sphere, the fitted one, and where they differ.
//
// Why it exists: numbers say how far a fit is off, the picture says whether it still is that paint. Free functions but
// for the file written; any thread.
#pragma once

#include <filesystem>

#include "core/analysis/brdf_sphere.hpp"
#include "core/error.hpp"

namespace lackwerk::packs {

/// The measured and the fitted sphere (core/analysis/brdf_sphere.hpp), `edge` pixels each. A table is compared through
/// its own cells: what is between them is the table's error, not the fit's.
[[nodiscard]] core::SphereComparison compare_fit(const core::BrdfTable& measured, const core::Brdf& fitted, int edge);

/// Three spheres side by side, no words: `a`, `b`, and CIEDE2000 in map_colour's colours (difference_picture.hpp).
/// Errors: the file cannot be written.
[[nodiscard]] Result<void> write_fit_picture(const std::filesystem::path& path,
                                             const core::SphereComparison& comparison);

}  // namespace lackwerk::packs
