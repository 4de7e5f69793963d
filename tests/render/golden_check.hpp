// Compares a picture with the one in tests/golden.
//
// Why it exists: every golden test must judge by the same tolerance and leave the same evidence behind. A missing
// golden is a failure, never an occasion to make one: only scripts/golden --update (which sets LACKWERK_GOLDEN=update)
// writes them. Test code; one thread.
#pragma once

#include <filesystem>
#include <string>

#include "render_gles/image.hpp"

namespace lackwerk::test {

/// The tolerance. Pictures of one build on one machine agree byte by byte, and so do both backends of one Mesa. Between
/// machines llvmpipe compiles other vector widths and fused operations, which moves the last bit of a float: a channel
/// rounds the other way (1/255), a texel's rank passes its threshold and a single flake changes, an edge covers another
/// pixel (any amount, few pixels). A change that a person would see moves areas: the mean catches it at a tenth of a
/// just noticeable difference.
inline constexpr int golden_channel_steps = 5;         ///< of 255
inline constexpr double golden_outlier_share = 0.001;  ///< of pixels may differ by more
inline constexpr double golden_mean_limit = 0.3;       ///< CIEDE2000

/// The repository's root.
[[nodiscard]] std::filesystem::path source_folder();

/// Adds test failures if the picture is not tests/golden/NAME.png within the tolerance, and then writes both and the
/// map of differences to build/golden-failures/NAME.png (where there is no golden, the picture alone). In update mode
/// writes the golden instead if `may_write` (one backend is enough) and skips the test.
void expect_golden(const gles::Image& image, const std::string& name, bool may_write);

/// Writes build/golden-failures/NAME.png: both pictures and their map. Returns its path.
[[nodiscard]] std::string write_failure(const gles::Image& golden, const gles::Image& image, const std::string& name);

}  // namespace lackwerk::test
