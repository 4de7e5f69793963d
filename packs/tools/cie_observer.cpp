#include "packs/tools/cie_observer.hpp"

#include <algorithm>
#include <cstddef>

#include "core/check.hpp"
#include "core/colour.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::array<ObserverRow, 41> rows{
    {{0.0014, 0.0000, 0.0065, 49.98},  {0.0042, 0.0001, 0.0201, 54.65},  {0.0143, 0.0004, 0.0679, 82.75},
     {0.0435, 0.0012, 0.2074, 91.49},  {0.1344, 0.0040, 0.6456, 93.43},  {0.2839, 0.0116, 1.3856, 86.68},
     {0.3483, 0.0230, 1.7471, 104.86}, {0.3362, 0.0380, 1.7721, 117.01}, {0.2908, 0.0600, 1.6692, 117.81},
     {0.1954, 0.0910, 1.2876, 114.86}, {0.0956, 0.1390, 0.8130, 115.92}, {0.0320, 0.2080, 0.4652, 108.81},
     {0.0049, 0.3230, 0.2720, 109.35}, {0.0093, 0.5030, 0.1582, 107.80}, {0.0633, 0.7100, 0.0782, 104.79},
     {0.1655, 0.8620, 0.0422, 107.69}, {0.2904, 0.9540, 0.0203, 104.41}, {0.4334, 0.9950, 0.0087, 104.05},
     {0.5945, 0.9950, 0.0039, 100.00}, {0.7621, 0.9520, 0.0021, 96.33},  {0.9163, 0.8700, 0.0017, 95.79},
     {1.0263, 0.7570, 0.0011, 88.69},  {1.0622, 0.6310, 0.0008, 90.01},  {1.0026, 0.5030, 0.0003, 89.60},
     {0.8544, 0.3810, 0.0002, 87.70},  {0.6424, 0.2650, 0.0000, 83.29},  {0.4479, 0.1750, 0.0000, 83.70},
     {0.2835, 0.1070, 0.0000, 80.03},  {0.1649, 0.0610, 0.0000, 80.21},  {0.0874, 0.0320, 0.0000, 82.28},
     {0.0468, 0.0170, 0.0000, 78.28},  {0.0227, 0.0082, 0.0000, 69.72},  {0.0114, 0.0041, 0.0000, 71.61},
     {0.0058, 0.0021, 0.0000, 74.35},  {0.0029, 0.0010, 0.0000, 61.60},  {0.0014, 0.0005, 0.0000, 69.89},
     {0.0007, 0.0002, 0.0000, 75.09},  {0.0003, 0.0001, 0.0000, 63.59},  {0.0002, 0.0001, 0.0000, 46.42},
     {0.0001, 0.0000, 0.0000, 66.81},  {0.0000, 0.0000, 0.0000, 63.38}}};

double reflectance_at(double wanted, std::span<const double> nm, std::span<const double> reflectance) {
  if (wanted <= nm.front()) return reflectance.front();
  if (wanted >= nm.back()) return reflectance.back();
  const auto above = static_cast<std::size_t>(std::upper_bound(nm.begin(), nm.end(), wanted) - nm.begin());
  const double t = (wanted - nm[above - 1]) / (nm[above] - nm[above - 1]);
  return reflectance[above - 1] * (1.0 - t) + reflectance[above] * t;
}

}  // namespace

const std::array<ObserverRow, 41>& observer_rows() { return rows; }

glm::dvec3 lab_from_reflectance(std::span<const double> nm, std::span<const double> reflectance) {
  check_equal(nm.size(), reflectance.size(), "one reflectance per wavelength");
  check_at_most(std::size_t{2}, nm.size(), "wavelengths of a spectrum");
  glm::dvec3 sum(0.0), white(0.0);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const glm::dvec3 stimulus = glm::dvec3(rows[k].x, rows[k].y, rows[k].z) * rows[k].d65;
    white += stimulus;
    sum += stimulus * reflectance_at(observer_first_nm + observer_step_nm * static_cast<double>(k), nm, reflectance);
  }
  // Relative to the same sums of a perfect white, so that rounding in the tables tints nothing.
  glm::dvec3 rgb(0.0);
  for (int row = 0; row < 3; ++row)
    for (int k = 0; k < 3; ++k) rgb[row] += core::xyz_to_rgb[row][k] * core::white_xyz[k] * sum[k] / white[k];
  return core::lab_from_linear(rgb);
}

}  // namespace lackwerk::packs
