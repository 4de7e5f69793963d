// Fuzz target: any bytes as a measured material of RGL.
//
// Input: the file. Whatever comes: no sanitizer finding, every refusal with its field and remedy, and what is taken can
// be evaluated everywhere: numbers that are finite, no light below the horizon, and none that is negative unless the
// file says so.
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "packs/tools/rgl_file.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace lackwerk;
using fuzz::require;
using std::numbers::pi;

glm::dvec3 direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

void evaluate(const packs::RglMaterial& material, const glm::dvec3& in, const glm::dvec3& out) {
  const glm::dvec3 value = material(in, out);
  for (int channel = 0; channel < 3; ++channel) {
    require(std::isfinite(value[channel]));
    if (material.negative_share() == 0.0) require(value[channel] >= 0.0);
  }
  if (in.z <= 0.0 || out.z <= 0.0) require(value == glm::dvec3(0.0));
}

void use(const packs::RglMaterial& material) {
  require(material.negative_share() >= 0.0 && std::isfinite(material.negative_share()));
  require(!material.theta_in().empty());
  // The pole, grazing, beyond the horizon, and angles on both sides of whatever the file has as its first and last.
  constexpr std::array thetas{0.0, 1e-9, 0.3, 1.1, pi / 2.0 - 1e-6, pi / 2.0, 2.0};
  constexpr std::array phis{0.0, 1.0, pi, -pi + 1e-12, -2.5};
  for (const double theta_in : thetas) {
    const glm::dvec3 in = direction(theta_in, 0.4);
    if (in.z > 0.0) require(material.sigma(in) > 0.0 && std::isfinite(material.sigma(in)));
    for (const double theta : thetas)
      for (const double phi : phis) {
        const glm::dvec3 out = direction(theta, phi);
        if (out.z >= 0.0) require(material.ndf(out) >= 0.0 && std::isfinite(material.ndf(out)));
        evaluate(material, in, out);
      }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto material = packs::read_rgl(std::span(data, size), "fuzz.bsdf");
  if (material)
    use(*material);
  else
    require(material.error().file == "fuzz.bsdf" && !material.error().what.empty() &&
            !material.error().remedy.empty() && material.error().field.empty() == (size == 0));
  return 0;
}
