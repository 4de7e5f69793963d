#include "kiosk/display/panel_size.hpp"

#include <algorithm>
#include <cmath>

namespace lackwerk::kiosk {
namespace {

constexpr double mm_an_inch = 25.4;
constexpr double most_oblong = 1.1;

bool is_a_shape(std::array<int, 2> mm) {
  for (const int times : {1, 10, 100})
    for (const std::array<int, 2> shape : {std::array{16, 9}, std::array{16, 10}})
      if (mm == std::array{times * shape[0], times * shape[1]} || mm == std::array{times * shape[1], times * shape[0]})
        return true;
  return false;
}

}  // namespace

double panel_dpi(std::array<int, 2> panel_px, std::array<int, 2> panel_mm) {
  if (std::min({panel_px[0], panel_px[1], panel_mm[0], panel_mm[1]}) <= 0 || is_a_shape(panel_mm)) return 0.0;
  const double across = mm_an_inch * panel_px[0] / panel_mm[0], down = mm_an_inch * panel_px[1] / panel_mm[1];
  if (std::max(across, down) > most_oblong * std::min(across, down)) return 0.0;
  const double dpi = std::sqrt(across * down);
  return dpi >= least_dpi && dpi <= most_dpi ? dpi : 0.0;
}

}  // namespace lackwerk::kiosk
