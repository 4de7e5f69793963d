// The analytic part of one paint, and where it came from.
//
// Why it exists: recipes, captures, packs and realisation all speak of the same parameters. Values; any thread.
// Model: f = chi(theta_h, theta_i) * (a/pi + sum_k s_k/pi D_k F_k G / (i_z o_z)) + Xi, under a clear coat
// (Golla & Klein 2018 eq. 1 to 7, Kneiphof et al. 2018 eq. 5 and 6; the numbers follow Guenther et al. 2005, eq. 1).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace lackwerk::core {

/// Where a quantity came from. Kept through every step and shown to dealers.
enum class Provenance : std::uint8_t { measured = 0, published_fit = 1, simulated = 2 };

/// The word for it in every file and on every screen.
[[nodiscard]] constexpr const char* provenance_name(Provenance provenance) {
  switch (provenance) {
    case Provenance::measured:
      return "measured";
    case Provenance::published_fit:
      return "published-fit";
    case Provenance::simulated:
      break;
  }
  return "simulated";
}

/// One Cook-Torrance lobe with Beckmann distribution D = exp(-tan^2/m^2) / (m^2 cos^4) (no 1/pi: it stands outside).
struct Lobe {
  glm::dvec3 s{0.0};  ///< weight per linear sRGB channel, >= 0
  double m = 1.0;     ///< Beckmann roughness, [1e-3, 1]
  double f0 = 1.0;    ///< Schlick's Fresnel value at normal incidence, [0, 1] (Guenther's r)
  bool operator==(const Lobe&) const = default;
};
inline constexpr std::size_t max_lobes = 3;
inline constexpr double min_roughness = 1e-3;

/// chi as a square table over theta_h (columns) and theta_i (rows), both nodes k * 90 deg / (num_theta - 1), so that
/// the last node is 90 degrees. Entries are linear sRGB factors; values above 1 are legal. Entries with
/// theta_i > pi/2 - theta_h are never read: the angles are clamped first.
struct ColourTable {
  std::uint16_t num_theta = 0;    ///< [2, 256]
  std::vector<glm::vec3> linear;  ///< num_theta^2 entries, index = bin_i * num_theta + bin_h
  bool operator==(const ColourTable&) const = default;
};

struct AnalyticPaint {
  glm::dvec3 diffuse{0.0};              ///< a, linear sRGB, >= 0
  std::array<Lobe, max_lobes> lobes{};  ///< sorted by falling roughness; unused ones have s = 0
  double coat_ior = 1.0;                ///< clear coat that mirrors and attenuates; 1 = none
  double refraction_ior = 1.0;          ///< index that bends directions; 1 = AxF's cc_no_refraction
  std::optional<ColourTable> table;     ///< chi; absent = 1 everywhere
  bool operator==(const AnalyticPaint&) const = default;
};

/// What a dealer is told about a paint.
struct PaintIdentity {
  std::string name;
  std::string source;  ///< "Guenther et al. 2005, Table 1", ...
  Provenance lobes = Provenance::published_fit;
  Provenance flakes = Provenance::simulated;
  Provenance coat = Provenance::simulated;
  bool operator==(const PaintIdentity&) const = default;
};

}  // namespace lackwerk::core
