// The pictures that golden tests draw: scenes, light and settings, all made here in milliseconds.
//
// Why it exists: a golden picture must depend on the renderer alone, not on a builder, a capture or a file, so that a
// change of it says where to look. Test code; values.
#pragma once

#include <string>
#include <vector>

#include "packs/scene.hpp"
#include "render_gles/view.hpp"

namespace lackwerk::test {

/// A room with a gradient and four lamps, 3 m in radius. Its levels are computed from formulas (each lamp a von
/// Mises-Fisher spot, widened with the level), not filtered from one another, which would take seconds. `sun`: radiance
/// of a fifth lamp, 4 degrees wide.
[[nodiscard]] core::Environment golden_environment(double sun = 0.0);

/// What a golden picture shows.
enum class GoldenSubject {
  sphere,  ///< the paint alone, nothing baked
  table,   ///< a painted capsule with invented baked light, around it chrome, rubber, a lamp and glass; a floor
};
[[nodiscard]] packs::Scene golden_scene(GoldenSubject subject);

/// One golden picture: tests/golden/NAME.png.
struct GoldenShot {
  std::string name;
  GoldenSubject subject = GoldenSubject::sphere;
  gles::View view;
  gles::Lighting lighting;
  int samples = 1;   ///< frames of a still picture; 1 = moving
  double mix = 0.4;  ///< between the two paints of SyntheticPaint
};
inline constexpr int golden_width_px = 256, golden_height_px = 144;

/// All of them but the car. Names are file names.
[[nodiscard]] std::vector<GoldenShot> golden_shots();
/// The one of that name; it must exist.
[[nodiscard]] GoldenShot golden_shot(const std::string& name);

}  // namespace lackwerk::test
