// The colour map's peer: the colour table, drawn by the same renderer.
//
// Why it exists: a map asks for one pair of directions where a table asks for two angles, which costs square roots; the
// ratio says whether a weak GPU can afford it. A benchmark, not a product. One GL thread.
#pragma once

#include "tests/bench/render/rounds.hpp"
#include "tests/bench/render/stage.hpp"

namespace lackwerk::bench {

/// Draws the stage's scene with one and the same invented paint, chi from a map of 64 x 127 nodes and from its table of
/// 91 x 91, and without either; under one light, under four, and with an environment that lights are cut from. The
/// stage's own paint stays as it was. `camera`: as Stage::view has it.
void compare_map_with_table(Stage& stage, const char* camera, int rounds, Report& report);

}  // namespace lackwerk::bench
