// RGL's measured materials (`*_rgb.bsdf`), evaluated through their own warp.
//
// Why it exists: real measurements of one car paint and many films are published in this form (Dupuy & Jakob 2018, "An
// Adaptive Parameterization for Efficient Material Acquisition and Rendering"). Files are read here only. A value;
// evaluating is const and may be done from many threads.
//
// What the file holds: theta_i, phi_i (radians; azimuths: one entry or two for isotropic materials), ndf and sigma
// (microfacets and their projected area over the sphere), vndf (the warp's density), luminance and rgb over the warped
// square. Squares' coordinates: x = sqrt(2 theta / pi), y = (phi + pi) / (2 pi). With the half vector h and
// u = warp^-1(h):
//     f(i, o) cos(o) = rgb(u) ndf(h) / (4 sigma(i)),
// so the cosine is IN what the file's own reader returns, and is divided out here. `rgb` is linear sRGB under D65: its
// luminance with the weights of colour.hpp is the file's `luminance` to 3e-4. Colours outside sRGB have negative
// channels, and their luminance is still positive.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "packs/tools/rgl_warp.hpp"

namespace lackwerk::packs {

class RglMaterial {
 public:
  /// The BRDF without its cosine, 1/sr, linear sRGB; channels may be negative (see above). `in` is the light. 0 where a
  /// direction is on or below the horizon.
  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& in, const glm::dvec3& out) const;
  /// Density of the half vector's microfacets, 1/sr, and projected area of all, as the file has them.
  [[nodiscard]] double ndf(const glm::dvec3& half) const;
  [[nodiscard]] double sigma(const glm::dvec3& in) const;

  [[nodiscard]] const std::string& description() const { return description_; }
  [[nodiscard]] const std::vector<float>& theta_in() const { return theta_in_; }  ///< radians, rising
  /// Of the file's numbers: sum of the negative over sum of the positive values of `rgb`.
  [[nodiscard]] double negative_share() const { return negative_share_; }

 private:
  friend class RglReader;
  RglMaterial(RglSquare ndf, RglSquare sigma, RglWarp vndf, RglSquare rgb)
      : ndf_(std::move(ndf)), sigma_(std::move(sigma)), vndf_(std::move(vndf)), rgb_(std::move(rgb)) {}

  std::string description_;
  std::vector<float> theta_in_;
  double negative_share_ = 0.0;
  bool has_jacobian_ = true;  ///< the factor ndf / (4 sigma) is not in `rgb` yet
  RglSquare ndf_, sigma_;
  RglWarp vndf_;
  RglSquare rgb_;
};

/// From the bytes of a file; `file` names it in errors. Errors name the field: no tensor file, cut, a field outside the
/// file or upon another, wrong type or dimensions, no numbers, negative densities or luminance, anisotropic, spectral.
[[nodiscard]] Result<RglMaterial> read_rgl(std::span<const std::uint8_t> bytes, const std::string& file);
/// From a file of at most 64 MiB.
[[nodiscard]] Result<RglMaterial> read_rgl(const std::filesystem::path& path);

}  // namespace lackwerk::packs
