#include "packs/tools/thin_film.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/colour.hpp"
#include "packs/tools/cie_observer.hpp"

namespace lackwerk::packs {
namespace {

using Complex = std::complex<double>;

/// A Gaussian with different widths on both sides (Wyman et al. 2013, eq. 2).
double lobe(double x, double mean, double left, double right) {
  const double t = (x - mean) / (x < mean ? left : right);
  return std::exp(-0.5 * t * t);
}

/// CIE 1931 colour matching functions, multi-lobe fit (Wyman et al. 2013, eq. 4).
glm::dvec3 observer(double nm) {
  return {
      1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) - 0.065 * lobe(nm, 501.1, 20.4, 26.2),
      0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
      1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

/// One polarisation. Admittance n cos for s, n / cos for p; the product of characteristic matrices acts on the far
/// side's admittance. In a lossless stack r = (eta0 B - C) / (eta0 B + C).
double reflect_one(std::span<const OpticalLayer> layers, double outside, double inside, double wavelength_nm,
                   double cosine, bool parallel) {
  const double sine2 = outside * outside * (1.0 - cosine * cosine);  // (n sin)^2 is the same in every layer
  const auto cosine_in = [&](double n) { return std::sqrt(Complex(1.0 - sine2 / (n * n), 0.0)); };
  const auto admittance = [&](double n, Complex c) { return parallel ? n / c : n * c; };
  Complex b = 1.0;
  Complex c = admittance(inside, cosine_in(inside));
  for (std::size_t k = layers.size(); k-- > 0;) {
    const Complex cos_k = cosine_in(layers[k].index);
    const Complex eta = admittance(layers[k].index, cos_k);
    const Complex delta = 2.0 * std::numbers::pi * layers[k].index * layers[k].nm / wavelength_nm * cos_k;
    const Complex i_sin = Complex(0.0, 1.0) * std::sin(delta);
    const Complex next_b = std::cos(delta) * b + i_sin / eta * c;
    c = i_sin * eta * b + std::cos(delta) * c;
    b = next_b;
  }
  const Complex eta0 = admittance(outside, Complex(cosine, 0.0));
  return std::norm((eta0 * b - c) / (eta0 * b + c));
}

}  // namespace

double film_index(FilmMaterial material, double wavelength_nm) {
  const double um2 = wavelength_nm * wavelength_nm * 1e-6;
  if (material == FilmMaterial::titania) return std::sqrt(5.913 + 0.2441 / (um2 - 0.0803));
  return std::sqrt(1.0 + 0.6961663 * um2 / (um2 - 0.0684043 * 0.0684043) +
                   0.4079426 * um2 / (um2 - 0.1162414 * 0.1162414) + 0.8974794 * um2 / (um2 - 9.896161 * 9.896161));
}

Reflectance film_reflectance(std::span<const OpticalLayer> layers, double outside, double inside, double wavelength_nm,
                             double cosine) {
  return {reflect_one(layers, outside, inside, wavelength_nm, cosine, false),
          reflect_one(layers, outside, inside, wavelength_nm, cosine, true)};
}

glm::dvec3 film_colour(std::span<const FilmLayer> layers, double resin, double theta) {
  glm::dvec3 sum(0.0);
  glm::dvec3 white(0.0);
  std::vector<OpticalLayer> optical(layers.size());
  for (std::size_t w = 0; w < observer_rows().size(); ++w) {
    const double nm = observer_first_nm + observer_step_nm * static_cast<double>(w);
    for (std::size_t k = 0; k < layers.size(); ++k) optical[k] = {film_index(layers[k].material, nm), layers[k].nm};
    const Reflectance r = film_reflectance(optical, resin, resin, nm, std::cos(theta));
    const glm::dvec3 stimulus = observer(nm) * observer_rows()[w].d65;
    white += stimulus;
    sum += stimulus * (0.5 * (r.s + r.p));
  }
  // The fitted observer's white differs slightly from the tabulated one: scale XYZ so that a mirror is exactly white.
  glm::dvec3 rgb(0.0);
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 3; ++k) rgb[row] += core::xyz_to_rgb[row][k] * core::white_xyz[k] * sum[k] / white[k];
  }
  return rgb;
}

}  // namespace lackwerk::packs
