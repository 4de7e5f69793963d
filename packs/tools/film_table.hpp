// The colour table (chi) of a pearlescent paint from its film stack.
//
// Why it exists: chi multiplies diffuse light and lobes alike, so its two dimensions come from two physical parts:
// what the flakes mirror has the film's colour at theta_i; what reaches the base and comes back has passed the flakes
// and has the complement's. Their shares follow the recipe's own lobes at (theta_h, theta_i). Pure; any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "core/paint.hpp"
#include "packs/tools/thin_film.hpp"

namespace lackwerk::packs {

struct FilmStack {
  double resin = 1.5;              ///< index of what surrounds the flakes
  std::uint16_t table_nodes = 46;  ///< nodes per axis, [2, 256]
  std::vector<FilmLayer> layers;
};

/// chi over theta_h and theta_i (angles inside the coat), normalised to luminance 1 at theta_i = 0, so that the lobe
/// weights keep their meaning. Colours outside the sRGB gamut are clamped to >= 0. A stack that mirrors nothing
/// gives 1.
[[nodiscard]] core::ColourTable film_table(const FilmStack& film, const core::AnalyticPaint& paint);

/// Luminance of what the stack mirrors at normal incidence, [0, 1]: 4 share s / coverage should be near it.
[[nodiscard]] double film_luminance(const FilmStack& film);

}  // namespace lackwerk::packs
