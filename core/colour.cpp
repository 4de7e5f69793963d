#include "core/colour.hpp"

#include <algorithm>
#include <numbers>

namespace lackwerk::core {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// The root of C^7 / (C^7 + 25^7).
double chroma_root(double chroma) {
  const double square = chroma * chroma;
  const double seventh = square * square * square * chroma;
  constexpr double limit = 6103515625.0;  // 25^7
  return std::sqrt(seventh / (seventh + limit));
}

/// Hue in [0, 360) degrees; 0 for greys (Sharma et al. 2005, eq. 7).
double hue_degrees(double b, double a) {
  if (a == 0.0 && b == 0.0) return 0.0;
  const double hue = std::atan2(b, a) / degree;
  return hue < 0.0 ? hue + 360.0 : hue;
}

}  // namespace

double srgb_encode(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

double srgb_decode(double encoded) {
  const double x = std::clamp(encoded, 0.0, 1.0);
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

// Equation numbers: G. Sharma, W. Wu, E. N. Dalal, "The CIEDE2000 color-difference formula", Color Res. Appl. 30
// (2005).
double ciede2000(const glm::dvec3& lab1, const glm::dvec3& lab2) {
  const double raw_chroma1 = std::sqrt(lab1.y * lab1.y + lab1.z * lab1.z);  // eq. 2
  const double raw_chroma2 = std::sqrt(lab2.y * lab2.y + lab2.z * lab2.z);
  const double stretch = 1.5 - 0.5 * chroma_root((raw_chroma1 + raw_chroma2) / 2.0);  // 1 + G, eq. 3 to 5
  const double a1 = stretch * lab1.y;
  const double a2 = stretch * lab2.y;
  const double chroma1 = std::sqrt(a1 * a1 + lab1.z * lab1.z);  // eq. 6
  const double chroma2 = std::sqrt(a2 * a2 + lab2.z * lab2.z);
  const double hue1 = hue_degrees(lab1.z, a1);
  const double hue2 = hue_degrees(lab2.z, a2);

  // Are the hues more than half a turn apart? Asked of rounded angles, opposite hues fall on either side by chance;
  // the sign of the cross product (a common factor 1 + G left out) answers it for the inputs as they stand.
  const double turn = lab1.y * lab2.z - lab2.y * lab1.z;
  const bool grey = chroma1 * chroma2 == 0.0;
  const bool wraps = !grey && (hue2 > hue1 ? turn < 0.0 : turn > 0.0);
  double hue_step = grey ? 0.0 : hue2 - hue1;  // eq. 10
  double hue_mean = hue1 + hue2;               // eq. 14
  if (wraps) {
    hue_step += hue2 > hue1 ? -360.0 : 360.0;
    hue_mean += hue_mean < 360.0 ? 360.0 : -360.0;
  }
  if (!grey) hue_mean /= 2.0;

  const double delta_l = lab2.x - lab1.x;
  const double delta_c = chroma2 - chroma1;
  const double delta_h = 2.0 * std::sqrt(chroma1 * chroma2) * std::sin(hue_step / 2.0 * degree);  // eq. 11
  const double mean_l = (lab1.x + lab2.x) / 2.0 - 50.0;
  const double mean_c = (chroma1 + chroma2) / 2.0;
  const double t = 1.0 - 0.17 * std::cos((hue_mean - 30.0) * degree) + 0.24 * std::cos(2.0 * hue_mean * degree) +
                   0.32 * std::cos((3.0 * hue_mean + 6.0) * degree) -
                   0.20 * std::cos((4.0 * hue_mean - 63.0) * degree);  // eq. 15
  const double bump = (hue_mean - 275.0) / 25.0;
  const double rotation = 30.0 * std::exp(-bump * bump);                                     // eq. 16
  const double scale_l = 1.0 + 0.015 * mean_l * mean_l / std::sqrt(20.0 + mean_l * mean_l);  // eq. 18
  const double scale_c = 1.0 + 0.045 * mean_c;                                               // eq. 19
  const double scale_h = 1.0 + 0.015 * mean_c * t;                                           // eq. 20
  const double twist = -std::sin(2.0 * rotation * degree) * 2.0 * chroma_root(mean_c);       // eq. 17, 21
  const double l = delta_l / scale_l;
  const double c = delta_c / scale_c;
  const double h = delta_h / scale_h;
  return std::sqrt(std::max(0.0, l * l + c * c + h * h + twist * c * h));  // eq. 22
}

}  // namespace lackwerk::core
