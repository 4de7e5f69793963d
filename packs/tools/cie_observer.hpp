// Spectra to colours: the CIE's 2-degree observer and D65, in steps of 10 nm.
//
// Why it exists: spectrophotometers give spectra; everything here speaks Lab. Tables as published, not fitted curves
// (those of thin_film.cpp are within 2 %, enough for a pearl that is invented anyway). Pure; any thread.
//
// Source: CIE 15:2004, tables T.1 (D65) and T.4 (CIE 1931 colour-matching functions).
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>

namespace lackwerk::packs {

inline constexpr double observer_first_nm = 380.0, observer_step_nm = 10.0;

struct ObserverRow {
  double x, y, z;  ///< colour-matching functions
  double d65;      ///< relative power of the light
};
/// 380, 390, ... 780 nm.
[[nodiscard]] const std::array<ObserverRow, 41>& observer_rows();

/// CIE Lab (D65, 2 degrees) of a reflectance factor (1: perfect white, which gives exactly 100, 0, 0). `nm` rises
/// strictly and has at least two entries; between them the reflectance is linear, beyond them it stays what it was at
/// the end (ASTM E308). Both have the same length.
[[nodiscard]] glm::dvec3 lab_from_reflectance(std::span<const double> nm, std::span<const double> reflectance);

}  // namespace lackwerk::packs
