#include "core/analysis/brdf_table.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "core/check.hpp"

namespace lackwerk::core {

using glm::dvec3;
using std::numbers::pi;

namespace {

constexpr double quarter = pi / 2.0;
constexpr float hole = std::numeric_limits<float>::quiet_NaN();
/// Below this sine a direction is the pole, and its azimuth is rounding (of directions kept as floats, too).
constexpr double pole = 1e-7;

dvec3 rotated_y(const dvec3& v, double cosine, double sine) {
  return {cosine * v.x + sine * v.z, v.y, cosine * v.z - sine * v.x};
}

/// The two neighbours of a grid coordinate (0 at the middle of cell 0) and the share of the upper one.
struct Step {
  std::uint32_t lower = 0, upper = 0;
  double share = 0.0;
};

Step clamped_step(double coordinate, std::uint32_t count) {
  const double at = std::clamp(coordinate, 0.0, static_cast<double>(count - 1));
  const auto lower = std::min(static_cast<std::uint32_t>(at), count - 2);
  return {lower, lower + 1, at - static_cast<double>(lower)};
}

Step wrapped_step(double coordinate, std::uint32_t count) {
  const double floor = std::floor(coordinate);
  const auto lower = static_cast<std::uint32_t>(floor < 0.0 ? count - 1 : static_cast<std::uint32_t>(floor) % count);
  return {lower, (lower + 1) % count, coordinate - floor};
}

}  // namespace

HalfAngles half_angles(const dvec3& in, const dvec3& out) {
  const dvec3 sum = in + out;
  const double length = glm::length(sum);
  // Opposite directions, both in the horizon: every half vector between them will do, and the normal is one.
  const dvec3 h = length > 0.0 ? sum / length : dvec3(0.0, 0.0, 1.0);
  const double sin_h = std::hypot(h.x, h.y);
  HalfAngles angles;
  angles.theta_h = std::clamp(std::atan2(sin_h, h.z), 0.0, quarter);
  // Turns h to the pole: about z into the xz plane, then about y.
  const double cos_p = sin_h > pole ? h.x / sin_h : 1.0, sin_p = sin_h > pole ? h.y / sin_h : 0.0;
  const dvec3 turned(cos_p * in.x + sin_p * in.y, cos_p * in.y - sin_p * in.x, in.z);
  const dvec3 d = rotated_y(turned, h.z, -sin_h);
  const double sin_d = std::hypot(d.x, d.y);
  angles.theta_d = std::clamp(std::atan2(sin_d, d.z), 0.0, quarter);
  if (sin_d > pole && sin_h > pole) {
    const double phi = std::atan2(d.y, d.x);  // (-pi, pi]; exchanging the directions adds pi, which changes nothing
    angles.phi_d = phi < 0.0 ? phi + pi : phi;
    if (angles.phi_d >= pi) angles.phi_d -= pi;
  }
  return angles;
}

DirectionPair directions(const HalfAngles& angles) {
  const double sin_d = std::sin(angles.theta_d), cos_d = std::cos(angles.theta_d);
  const double sin_h = std::sin(angles.theta_h), cos_h = std::cos(angles.theta_h);
  const dvec3 d(sin_d * std::cos(angles.phi_d), sin_d * std::sin(angles.phi_d), cos_d);
  const dvec3 mirrored(-d.x, -d.y, d.z);
  return {rotated_y(d, cos_h, sin_h), rotated_y(mirrored, cos_h, sin_h)};
}

BrdfTable::BrdfTable(BrdfTableSize size) : size_(size) {
  for (const std::uint32_t count : {size.theta_h, size.theta_d, size.phi_d}) {
    check_at_most(2u, count, "cells of a BRDF table");
    check_at_most(count, 512u, "cells of a BRDF table");
  }
  values_.assign(size.cells(), glm::vec3(hole));
}

HalfAngles BrdfTable::middle(std::size_t cell) const {
  const std::size_t k = cell % size_.phi_d, j = cell / size_.phi_d % size_.theta_d,
                    i = cell / size_.phi_d / size_.theta_d;
  const double root = (static_cast<double>(i) + 0.5) / size_.theta_h;
  return {root * root * quarter, (static_cast<double>(j) + 0.5) / size_.theta_d * quarter,
          (static_cast<double>(k) + 0.5) / size_.phi_d * pi};
}

std::size_t BrdfTable::cell_of(const HalfAngles& angles) const {
  const auto cell = [](double share, std::uint32_t count) {
    return std::min(static_cast<std::size_t>(std::max(share, 0.0) * count), static_cast<std::size_t>(count - 1));
  };
  const std::size_t i = cell(std::sqrt(std::max(angles.theta_h, 0.0) / quarter), size_.theta_h);
  const std::size_t j = cell(angles.theta_d / quarter, size_.theta_d);
  return (i * size_.theta_d + j) * size_.phi_d + cell(angles.phi_d / pi, size_.phi_d);
}

std::optional<glm::vec3> BrdfTable::value(std::size_t cell) const {
  const glm::vec3& stored = values_[cell];
  if (std::isnan(stored.x)) return std::nullopt;
  return stored;
}

void BrdfTable::set(std::size_t cell, const glm::vec3& value) {
  for (int channel = 0; channel < 3; ++channel) {
    check_at_most(0.0f, value[channel], "a BRDF table's value");
    check_at_most(value[channel], std::numeric_limits<float>::max(), "a BRDF table's value");
  }
  values_[cell] = value;
}

void BrdfTable::clear(std::size_t cell) { values_[cell] = glm::vec3(hole); }

std::size_t BrdfTable::holes() const {
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < values_.size(); ++cell) {
    if (std::isnan(values_[cell].x) && is_above(directions(middle(cell)))) ++count;
  }
  return count;
}

std::optional<dvec3> BrdfTable::at(const dvec3& in, const dvec3& out) const {
  const HalfAngles angles = half_angles(in, out);
  const Step h = clamped_step(std::sqrt(angles.theta_h / quarter) * size_.theta_h - 0.5, size_.theta_h);
  const Step d = clamped_step(angles.theta_d / quarter * size_.theta_d - 0.5, size_.theta_d);
  const Step p = wrapped_step(angles.phi_d / pi * size_.phi_d - 0.5, size_.phi_d);
  dvec3 sum(0.0);
  double total = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const bool up_h = (corner & 1u) != 0, up_d = (corner & 2u) != 0, up_p = (corner & 4u) != 0;
    const double weight =
        (up_h ? h.share : 1.0 - h.share) * (up_d ? d.share : 1.0 - d.share) * (up_p ? p.share : 1.0 - p.share);
    const std::size_t cell =
        (static_cast<std::size_t>(up_h ? h.upper : h.lower) * size_.theta_d + (up_d ? d.upper : d.lower)) *
            size_.phi_d +
        (up_p ? p.upper : p.lower);
    const glm::vec3& stored = values_[cell];
    if (weight <= 0.0 || std::isnan(stored.x)) continue;
    sum += dvec3(stored) * weight;
    total += weight;
  }
  if (total <= 0.0) return std::nullopt;
  return sum / total;
}

BrdfTable tabulate(const Brdf& brdf, BrdfTableSize size) {
  BrdfTable table(size);
  for (std::size_t cell = 0; cell < size.cells(); ++cell) {
    const DirectionPair pair = directions(table.middle(cell));
    if (!is_above(pair)) continue;
    const dvec3 value = brdf(pair.in, pair.out);
    // What is no number stays a hole; noise below zero is none.
    if (std::isfinite(value.x + value.y + value.z)) table.set(cell, glm::vec3(glm::max(value, dvec3(0.0))));
  }
  return table;
}

Brdf reciprocal(Brdf brdf) {
  return [brdf = std::move(brdf)](const dvec3& in, const dvec3& out) { return 0.5 * (brdf(in, out) + brdf(out, in)); };
}

}  // namespace lackwerk::core
