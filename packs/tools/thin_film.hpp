// The colour of an interference flake: a stack of thin films, both sides in the same resin.
//
// Why it exists: pearlescent paints get their flop from path differences inside coated flakes. The demo pearls take
// their colour table from this physics instead of a painter's guess. Pure functions; any thread.
//
// Sources: characteristic matrices after Abeles 1950 as in Born & Wolf, Principles of Optics, 1.6; refractive indices
// DeVore 1951 (rutile TiO2, ordinary ray; J. Opt. Soc. Am. 41, 416) and Malitson 1965 (fused silica; J. Opt. Soc.
// Am. 55, 1205); CIE 1931 2-degree observer by the multi-lobe fit of Wyman, Sloan & Shirley 2013 (JCGT 2(2)); D65 from
// CIE's table at 10 nm. The media here do not absorb; coatings are taken as dense as the bulk material.
#pragma once

#include <glm/vec3.hpp>
#include <span>

namespace lackwerk::packs {

enum class FilmMaterial { titania, silica };

struct FilmLayer {
  FilmMaterial material = FilmMaterial::silica;
  double nm = 0.0;  ///< thickness, >= 0
};

/// Refractive index at a wavelength in nanometres, [380, 780] (DeVore's data begin at 430: extrapolated below).
[[nodiscard]] double film_index(FilmMaterial material, double wavelength_nm);

/// A layer of known index; 0 nm thick layers do nothing.
struct OpticalLayer {
  double index = 1.0;
  double nm = 0.0;
};
struct Reflectance {
  double s = 0.0;  ///< perpendicular to the plane of incidence
  double p = 0.0;  ///< parallel to it
};
/// Power reflectance of a stack between two non-absorbing half spaces. `cosine` of incidence in (0, 1], in `outside`.
/// Total reflection gives 1.
[[nodiscard]] Reflectance film_reflectance(std::span<const OpticalLayer> layers, double outside, double inside,
                                           double wavelength_nm, double cosine);

/// Colour of unpolarised D65 light mirrored by a stack in resin of index `resin`: linear sRGB in which a perfect mirror
/// is exactly (1, 1, 1). Components can be negative (outside the gamut). `theta` in radians, inside the resin, below
/// pi/2. Costs 41 wavelengths.
[[nodiscard]] glm::dvec3 film_colour(std::span<const FilmLayer> layers, double resin, double theta);

}  // namespace lackwerk::packs
