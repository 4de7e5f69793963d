// What a capture reflects as one function: lobes, colour table, mean flakes and coat together.
//
// Why it exists: fits, comparisons and engine exports are judged against BRDF + mean flakes (the capture's lobes were
// lowered by what the flakes reflect). Values that own what they need; any thread may call what is returned, several at
// once.
#pragma once

#include "core/analysis/brdf_table.hpp"
#include "core/analysis/ggx_fit.hpp"
#include "packs/tools/capture.hpp"

namespace lackwerk::packs {

/// The slices' means, bilinear between nodes, 0 where there is no slice; angles in radians inside the coat. Empty where
/// the capture has no flakes.
[[nodiscard]] core::MeanFlakes mean_flakes(const Capture& capture);

/// The capture's BRDF without the coat's mirror image: radiance factor / pi, as paint_factor (paint_model.glsl) has it.
[[nodiscard]] core::Brdf capture_brdf(const Capture& capture);

}  // namespace lackwerk::packs
