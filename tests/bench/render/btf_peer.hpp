// The peer of the flake statistics: a plain look-up of the flake pictures themselves (Golla & Klein 2018, 3.1), drawn
// by the same shader with only the flakes' function exchanged.
//
// Why it exists: the statistics are meant to cost little more than what they replace, and to be far smaller. The
// pictures lie with their mip levels in two RGBA8 atlases of 4096 texels, as core ES 2.0 asks for. A benchmark, not a
// product: single paints only, one directional light. One GL thread.
#pragma once

#include <string>

#include "tests/bench/render/rounds.hpp"
#include "tests/bench/render/stage.hpp"

namespace lackwerk::bench {

/// Draws the paint parts of the stage's scene both ways from the "hero", "rim" and "macro" cameras and reports the
/// ratio of times and of bytes. `capture`: folder of the pack's first paint. Error: it cannot be read or does not fit.
[[nodiscard]] Result<void> compare_with_btf(Stage& stage, const std::string& capture, int rounds, Report& report);

}  // namespace lackwerk::bench
