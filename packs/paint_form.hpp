// How a paint of a pack came to the one form that packs hold, and what that cost.
//
// Why it exists: a pack mixes paints that came as an instrument's own model and slices, as a whole measured BRDF that
// was fitted, or as readings in the plane of incidence that became a map. All are lobes, colour table and slices in the
// end; how far that is from what was measured belongs to the paint. Values; any thread.
#pragma once

#include <cstdint>

namespace lackwerk::packs {

enum class PaintForm : std::uint8_t {
  given = 0,   ///< lobes, table and slices are what was captured (AxF's quantities, recipes, photographs)
  fitted = 1,  ///< lobes and perhaps a colour table fitted to a BRDF or to readings
  mapped = 2,  ///< a colour table made from an isochromatic map
};
[[nodiscard]] constexpr const char* form_name(PaintForm form) {
  constexpr const char* names[] = {"given", "fitted", "mapped"};
  return names[static_cast<std::uint8_t>(form)];
}

/// What stands beside the measurement when a paint is judged.
enum class JudgedBy : std::uint8_t {
  nothing = 0,   ///< there is no measurement beside the model
  sphere = 1,    ///< pixels of a lit sphere (core/analysis/brdf_sphere.hpp)
  readings = 2,  ///< the instrument's own angles
};
[[nodiscard]] constexpr const char* judge_name(JudgedBy judge) {
  constexpr const char* names[] = {"nothing", "sphere pixels", "readings"};
  return names[static_cast<std::uint8_t>(judge)];
}

/// CIEDE2000 between what was measured and the paint (BRDF + mean flakes, without the coat's mirror image).
struct FormError {
  PaintForm form = PaintForm::given;
  JudgedBy judged_by = JudgedBy::nothing;
  std::uint32_t count = 0;  ///< of pixels or readings; 0: the figures mean nothing
  float e2000_mean = 0.0f, e2000_p95 = 0.0f, e2000_max = 0.0f;
  bool operator==(const FormError&) const = default;
};

}  // namespace lackwerk::packs
