#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "core/colour.hpp"
#include "kiosk/tools/report/ciede2000_pairs.hpp"
#include "kiosk/tools/report/stiff_numbers.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

namespace {

constexpr const char* kernel = "colour";

/// The largest relative error of a colour that went to Lab and back, its largest channel as the measure.
template <class T>
std::pair<double, std::string> round_trip(double size) {
  double worst = 0.0;
  std::string where;
  for (const double r : {-1.0, -0.01, 0.0, 0.003, 0.3, 1.0})
    for (const double g : {-1.0, 0.0, 0.0089, 1.0})
      for (const double b : {-0.2, 0.0, 0.5, 1.0}) {
        const glm::dvec3 colour = size * glm::dvec3(r, g, b);
        const auto back = core::linear_from_lab(core::lab_from_linear(glm::vec<3, T>(colour)));
        // Below white the error is absolute: L has an offset of 16.
        const double largest = std::max({std::abs(colour.x), std::abs(colour.y), std::abs(colour.z), 1.0});
        for (int c = 0; c < 3; ++c) {
          const double error = std::abs(static_cast<double>(back[c]) - colour[c]) / largest;
          if (error <= worst) continue;
          worst = error;
          where = "linear " + digits(colour.x) + " " + digits(colour.y) + " " + digits(colour.z);
        }
      }
  return {worst, where};
}

/// Lab in double against the same formulas in long double, relative to 1 + |Lab|.
std::pair<double, std::string> against_long_double(double size) {
  double worst = 0.0;
  std::string where;
  std::mt19937 random(11);
  for (int k = 0; k < 2000; ++k) {
    glm::dvec3 colour;
    for (int c = 0; c < 3; ++c) colour[c] = size * (2.0 * static_cast<double>(random()) / 4294967296.0 - 1.0);
    const glm::dvec3 lab = core::lab_from_linear(colour);
    const auto reference = core::lab_from_linear(glm::vec<3, long double>(colour));
    // L, a and b are differences of the same three terms: their size is the measure.
    const double scale = 1.0 + std::abs(lab.x) + std::abs(lab.y) + std::abs(lab.z);
    for (int c = 0; c < 3; ++c) {
      const double error = std::abs(lab[c] - static_cast<double>(reference[c])) / scale;
      if (error <= worst) continue;
      worst = error;
      where = "linear " + digits(colour.x) + " " + digits(colour.y) + " " + digits(colour.z);
    }
  }
  return {worst, where};
}

}  // namespace

void add_case(Findings& findings, const char* kernel_name, const std::string& name, const char* measure, double worst,
              double bound, const std::string& where) {
  StiffCase found;
  found.kernel = kernel_name;
  found.name = name;
  found.measure = measure;
  found.worst = worst;
  found.bound = bound;
  found.where = where;
  findings.stiff.push_back(std::move(found));
}

void add_stiff_colour(Findings& findings) {
  for (const double size : {1e-6, 1.0, 1e3, 1e6}) {
    const std::string name = "channels of -" + digits(size) + " to " + digits(size);
    const auto wide = round_trip<double>(size);
    // A negative channel goes through the toe, whose slope is 7.8: its f is off by a rounding of 7.8 size. Where it
    // meets the cube root of a positive one, f ~ size^(1/3), the way back multiplies by 3 f^2: 23 roundings of
    // size^(5/3), and some twenty more; the same in Lab, where 500 times that error stands beside Lab of 100
    // size^(1/3).
    const double growth = std::pow(std::max(size, 1.0), 2.0 / 3.0);
    const double eps = std::numeric_limits<double>::epsilon();
    add_case(findings, kernel, name, "to Lab and back in double, relative", wide.first, 40.0 * eps * growth,
             wide.second);
    const auto single = round_trip<float>(size);
    add_case(findings, kernel, name, "to Lab and back in float, relative", single.first,
             40.0 * static_cast<double>(std::numeric_limits<float>::epsilon()) * growth, single.second);
    const auto reference = against_long_double(size);
    add_case(findings, kernel, name, "double against long double, relative", reference.first, 100.0 * eps * growth,
             reference.second);
  }
  double worst = 0.0, unlike = 0.0;
  int number = 0, at = 0;
  for (const ColourPair& pair : ciede2000_pairs) {
    ++number;
    const double forth = core::ciede2000(pair.one, pair.two), back = core::ciede2000(pair.two, pair.one);
    unlike = std::max(unlike, std::abs(forth - back));
    if (std::abs(forth - pair.difference) <= worst) continue;
    worst = std::abs(forth - pair.difference);
    at = number;
  }
  add_case(findings, kernel, "the 34 published pairs", "CIEDE2000 off the published figure", worst, 5.0001e-5,
           "pair " + std::to_string(at) + "; published with four digits");
  add_case(findings, kernel, "the 34 published pairs", "CIEDE2000 one way less the other", unlike, 1e-12);
  int wrong = 0;
  for (const glm::dvec3& lab : {glm::dvec3(0.0), glm::dvec3(50.0, 3.0, -7.0), glm::dvec3(1e4, 1e5, -1e5)})
    if (core::ciede2000(lab, lab) != 0.0) ++wrong;
  add_case(findings, kernel, "a colour and itself", "CIEDE2000 that is not 0", wrong, 0.0);
  int no_numbers = 0;
  for (const double size : {1e3, 1e5, 1e7})
    for (const double sign : {-1.0, 1.0})
      if (!std::isfinite(core::ciede2000({sign * size, size, -size}, {10.0, -size, sign * size}))) ++no_numbers;
  add_case(findings, kernel, "Lab to 1e7", "CIEDE2000 that are no numbers", no_numbers, 0.0);
}

}  // namespace lackwerk::report
