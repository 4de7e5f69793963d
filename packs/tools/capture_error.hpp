// How far a capture's model is from what the capture holds as measured.
//
// Why it exists: `lackwerk fit` tells it when the model is made and every pack carries it: the same figure by the same
// code. Pure; any thread.
#pragma once

#include "core/analysis/brdf_table.hpp"
#include "packs/paint_form.hpp"
#include "packs/tools/capture.hpp"

namespace lackwerk::packs {

/// CIEDE2000 of `model` against the capture's measured BRDF over a sphere, else against its readings; judged by nothing
/// where it has neither.
[[nodiscard]] FormError capture_error(const Capture& capture, const core::Brdf& model);

/// Of the capture's own model, mean flakes included (capture_brdf.hpp).
[[nodiscard]] FormError capture_error(const Capture& capture);

/// A reading as two directions and a BRDF value; channels below 0 (colours outside sRGB) are cut, as no paint has them.
struct ReadingSample {
  core::DirectionPair directions;
  glm::dvec3 brdf{0.0};  ///< 1/sr
};
[[nodiscard]] ReadingSample reading_sample(const AngleReading& reading);

}  // namespace lackwerk::packs
