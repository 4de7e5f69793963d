// The half-vector table: its angles, its interpolation around holes, its filling, and what it says of itself.
#include "core/analysis/brdf_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "core/analysis/reference_sampling.hpp"
#include "core/environment.hpp"

namespace lackwerk::core {
namespace {

using glm::dvec3;
using std::numbers::pi;

constexpr double degree = pi / 180.0;

dvec3 direction(double theta_deg, double phi_deg) {
  const double theta = theta_deg * degree, phi = phi_deg * degree;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Evenly over the hemisphere, down to the horizon.
dvec3 any_direction(std::mt19937_64& random) {
  std::uniform_real_distribution<double> even(0.0, 1.0);
  const double z = even(random), phi = 2.0 * pi * even(random), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// A metallic paint in short: a diffuse part and a Beckmann lobe that grows towards grazing, by colour.
dvec3 paint(const dvec3& in, const dvec3& out, double m) {
  const dvec3 h = glm::normalize(in + out);
  const double lobe = half_vector_pdf(h.z, m) / (4.0 * std::max(glm::dot(in, h), 0.1));
  return dvec3(0.05, 0.02, 0.01) + lobe * dvec3(0.3, 0.2, 0.5) * (1.0 + 2.0 * std::pow(1.0 - glm::dot(in, h), 5.0));
}
Brdf paint_of(double m) {
  return [m](const dvec3& in, const dvec3& out) { return paint(in, out, m); };
}

TEST(HalfAngles, OfKnownDirections) {
  const HalfAngles mirrored = half_angles(direction(40.0, 25.0), direction(40.0, 205.0));
  EXPECT_NEAR(mirrored.theta_h, 0.0, 1e-12);
  EXPECT_NEAR(mirrored.theta_d, 40.0 * degree, 1e-12);
  EXPECT_EQ(mirrored.phi_d, 0.0);
  const HalfAngles retro = half_angles(direction(30.0, 10.0), direction(30.0, 10.0));
  EXPECT_NEAR(retro.theta_h, 30.0 * degree, 1e-12);
  EXPECT_NEAR(retro.theta_d, 0.0, 1e-7);
  // In one plane, light further from the normal: the difference vector leans along the half vector's azimuth.
  const HalfAngles plane = half_angles(direction(60.0, 0.0), direction(20.0, 0.0));
  EXPECT_NEAR(plane.theta_h, 40.0 * degree, 1e-12);
  EXPECT_NEAR(plane.theta_d, 20.0 * degree, 1e-12);
  EXPECT_NEAR(plane.phi_d, 0.0, 1e-9);
  // Both in the horizon, opposite: no half vector, and no NaN.
  const HalfAngles flat = half_angles({1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0});
  EXPECT_EQ(flat.theta_h, 0.0);
  EXPECT_NEAR(flat.theta_d, pi / 2.0, 1e-12);
}

TEST(HalfAngles, AreTheInverseOfDirections) {
  for (int h = 1; h < 90; h += 4) {
    for (int d = 1; d < 90; d += 4) {
      for (int p = 0; p < 180; p += 7) {
        const HalfAngles angles{h * degree, d * degree, p * degree};
        const DirectionPair pair = directions(angles);
        EXPECT_NEAR(glm::length(pair.in), 1.0, 1e-12);
        if (!is_above(pair)) continue;
        const HalfAngles back = half_angles(pair.in, pair.out);
        EXPECT_NEAR(back.theta_h, angles.theta_h, 1e-9);
        EXPECT_NEAR(back.theta_d, angles.theta_d, 1e-9);
        const double turn = std::abs(back.phi_d - angles.phi_d);
        EXPECT_NEAR(std::min(turn, pi - turn), 0.0, 1e-9) << h << " " << d << " " << p;
      }
    }
  }
}

TEST(HalfAngles, DoNotSeeRotationNorExchange) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 2000; ++k) {
    const dvec3 in = any_direction(random), out = any_direction(random);
    const double turn = std::uniform_real_distribution<double>(0.0, 2.0 * pi)(random);
    const auto rotated = [&](const dvec3& v) {
      return dvec3(std::cos(turn) * v.x - std::sin(turn) * v.y, std::sin(turn) * v.x + std::cos(turn) * v.y, v.z);
    };
    const HalfAngles a = half_angles(in, out);
    for (const HalfAngles& b : {half_angles(rotated(in), rotated(out)), half_angles(out, in)}) {
      EXPECT_NEAR(a.theta_h, b.theta_h, 1e-9);
      EXPECT_NEAR(a.theta_d, b.theta_d, 1e-9);
      const double difference = std::abs(a.phi_d - b.phi_d);
      EXPECT_NEAR(std::min(difference, pi - difference), 0.0, 1e-6);
    }
    EXPECT_GE(a.phi_d, 0.0);
    EXPECT_LT(a.phi_d, pi);
  }
}

TEST(BrdfTable, MiddlesLieInTheirCells) {
  const BrdfTable table(BrdfTableSize{7, 11, 13});
  for (std::size_t cell = 0; cell < table.size().cells(); ++cell) ASSERT_EQ(table.cell_of(table.middle(cell)), cell);
  EXPECT_EQ(table.cell_of({0.0, 0.0, 0.0}), 0u);
  EXPECT_EQ(table.cell_of({pi / 2.0, pi / 2.0, pi}), table.size().cells() - 1);
  // MERL's: the tenth cell of theta_h begins at (10 / 90)^2 of 90 degrees.
  const BrdfTable merl;
  EXPECT_EQ(merl.size().cells(), 1458000u);
  EXPECT_EQ(merl.cell_of({90.0 * degree * 100.0 / 8100.0 + 1e-9, 0.0, 0.0}), std::size_t{10} * 90 * 180);
  EXPECT_NEAR(merl.middle(0).theta_h, 0.25 / 8100.0 * pi / 2.0, 1e-15);
}

TEST(BrdfTable, IsExactAtMiddlesAndReciprocalBetween) {
  const BrdfTable table = tabulate(paint_of(0.3), {30, 30, 36});
  EXPECT_EQ(table.holes(), 0u);
  std::size_t compared = 0;
  for (std::size_t cell = 0; cell < table.size().cells(); cell += 17) {
    const DirectionPair pair = directions(table.middle(cell));
    if (!is_above(pair)) {
      EXPECT_FALSE(table.value(cell));
      continue;
    }
    const auto at = table.at(pair.in, pair.out);
    ASSERT_TRUE(at && table.value(cell));
    const double scale = at->z;
    EXPECT_NEAR(at->z, static_cast<double>(table.value(cell)->z), 1e-5 * scale);
    EXPECT_NEAR(at->z, paint(pair.in, pair.out, 0.3).z, 1e-5 * scale);
    ++compared;
  }
  EXPECT_GT(compared, 1000u);
  std::mt19937_64 random(2);
  for (int k = 0; k < 500; ++k) {
    const dvec3 in = any_direction(random), out = any_direction(random);
    const auto a = table.at(in, out), b = table.at(out, in);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (a) {
      EXPECT_NEAR(a->x, b->x, 1e-6 * a->x);
    }
  }
}

TEST(BrdfTable, LeavesHolesOutOfItsMeans) {
  BrdfTable table(BrdfTableSize{4, 4, 4});
  const DirectionPair pair = directions({0.3, 0.3, 0.8});
  EXPECT_FALSE(table.at(pair.in, pair.out));
  table.set(table.cell_of({0.3, 0.3, 0.8}), {2.0f, 3.0f, 4.0f});
  const auto alone = table.at(pair.in, pair.out);
  ASSERT_TRUE(alone);
  EXPECT_NEAR(alone->y, 3.0, 1e-12);
  table.clear(table.cell_of({0.3, 0.3, 0.8}));
  EXPECT_FALSE(table.at(pair.in, pair.out));
}

TEST(BrdfTable, TabulatingDropsNoise) {
  const BrdfTable table = tabulate(
      [](const dvec3& in, const dvec3& out) {
        const HalfAngles angles = half_angles(in, out);
        if (angles.theta_h > 0.5) return dvec3(std::numeric_limits<double>::quiet_NaN(), 1.0, 1.0);
        return dvec3(-1.0, 0.5, angles.theta_d);
      },
      {20, 20, 20});
  EXPECT_FALSE(table.value(table.cell_of({0.6, 0.1, 1.5})));
  const auto value = table.value(table.cell_of({0.3, 0.1, 1.5}));
  ASSERT_TRUE(value);
  EXPECT_EQ(value->x, 0.0f);
  EXPECT_EQ(value->y, 0.5f);
  EXPECT_GT(table.holes(), 1000u);
}

/// Relative errors of the filled cells against the BRDF, sorted.
std::vector<double> errors_of(const BrdfTable& table, const std::vector<std::uint8_t>& filled, double m) {
  std::vector<double> errors;
  for (std::size_t cell = 0; cell < filled.size(); ++cell) {
    const DirectionPair pair = directions(table.middle(cell));
    if (filled[cell] == 0 || !is_above(pair)) continue;
    const double truth = luminance_of(paint(pair.in, pair.out, m));
    errors.push_back(std::abs(luminance_of(dvec3(table.value(cell).value_or(glm::vec3(0.0f)))) - truth) / truth);
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST(HoleFilling, HalfOfTheTableComesBack) {
  BrdfTable table = tabulate(paint_of(0.12), {60, 60, 90});
  std::mt19937_64 random(3);
  std::size_t cleared = 0;
  for (std::size_t cell = 0; cell < table.size().cells(); ++cell) {
    if ((random() & 1u) == 0 || !table.value(cell)) continue;
    table.clear(cell);
    ++cleared;
  }
  EXPECT_EQ(table.holes(), cleared);
  std::vector<std::uint8_t> filled;
  EXPECT_GE(fill_holes(table, &filled), cleared);  // and the rim
  EXPECT_EQ(table.holes(), 0u);
  const auto errors = errors_of(table, filled, 0.12);
  ASSERT_EQ(errors.size(), cleared);
  RecordProperty("median_error", std::to_string(errors[errors.size() / 2]));
  RecordProperty("p99_error", std::to_string(errors[errors.size() * 99 / 100]));
  EXPECT_LT(errors[errors.size() / 2], 0.002);
  EXPECT_LT(errors[errors.size() * 99 / 100], 0.13);  // where a whole neighbourhood along phi_d is gone
}

TEST(HoleFilling, MissingGrazingAnglesStayPlausible) {
  // What an instrument misses: everything with a direction beyond 75 degrees.
  BrdfTable table = tabulate(paint_of(0.3), {45, 45, 60});
  for (std::size_t cell = 0; cell < table.size().cells(); ++cell) {
    const DirectionPair pair = directions(table.middle(cell));
    if (std::min(pair.in.z, pair.out.z) < std::cos(75.0 * degree)) table.clear(cell);
  }
  std::vector<std::uint8_t> filled;
  fill_holes(table, &filled);
  EXPECT_EQ(table.holes(), 0u);
  // Constant from the edge on: off by what the BRDF does beyond it (its Fresnel factor alone is 3), never wild.
  const auto errors = errors_of(table, filled, 0.3);
  ASSERT_GT(errors.size(), 1000u);
  EXPECT_LT(errors[errors.size() / 2], 0.25);
  EXPECT_LT(errors.back(), 8.0);
}

TEST(HoleFilling, LeavesNoDirectionWithoutAnswer) {
  BrdfTable table = tabulate(paint_of(0.3));
  std::vector<std::uint8_t> filled;
  const std::size_t count = fill_holes(table, &filled);
  EXPECT_GT(count, 0u);     // grazing pairs between middles that all lie below the horizon
  EXPECT_LT(count, 2000u);  // and no more than those need
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  for (int k = 0; k < 100000; ++k) {
    const dvec3 in = any_direction(random);
    dvec3 out = any_direction(random);
    if (k % 2 == 0) {  // both grazing, light and eye opposite or nearly so
      const double z = 1e-3 * even(random), turn = pi * (1.0 + 0.01 * even(random));
      out = dvec3(std::cos(turn) * in.x - std::sin(turn) * in.y, std::sin(turn) * in.x + std::cos(turn) * in.y, 0.0);
      out = glm::normalize(glm::normalize(out) + dvec3(0.0, 0.0, z));
    }
    const dvec3 flat = k % 4 == 0 ? glm::normalize(dvec3(in.x, in.y, 1e-3 * even(random))) : in;
    ASSERT_TRUE(table.at(flat, out)) << k;
  }
}

TEST(HoleFilling, OfNothingIsNothing) {
  BrdfTable table(BrdfTableSize{4, 4, 4});
  EXPECT_EQ(fill_holes(table), 0u);
  EXPECT_FALSE(table.value(0));
}

TEST(BrdfHealth, OfADiffuserAndOfALobe) {
  const BrdfHealth grey = health([](const dvec3&, const dvec3&) { return dvec3(0.5 / pi); });
  ASSERT_EQ(grey.albedo.size(), grey.theta_in_deg.size());
  for (std::size_t k = 0; k + 1 < grey.albedo.size(); ++k) EXPECT_NEAR(grey.albedo[k].x, 0.5, 0.005) << k;
  EXPECT_EQ(grey.worst_reciprocity, 0.0);
  EXPECT_GT(grey.pairs, 4000u);
  // D cos_h / (4 in.h out.z) sends all light out again at normal incidence; a sharp one needs its samples.
  for (const double m : {0.3, 0.03, 0.003}) {
    const BrdfHealth lobe = health(
        [m](const dvec3& in, const dvec3& out) {
          const dvec3 h = glm::normalize(in + out);
          return dvec3(half_vector_pdf(h.z, m) / (4.0 * glm::dot(in, h) * out.z));
        },
        16384);
    EXPECT_NEAR(lobe.albedo[0].y, 1.0, 0.02) << m;
  }
}

TEST(BrdfHealth, SeesWhatIsNotReciprocal) {
  const Brdf lame = [](const dvec3& in, const dvec3&) { return dvec3(1.0 + in.z); };
  const BrdfHealth found = health(lame);
  EXPECT_GT(found.mean_reciprocity, 0.05);
  // Worst within 75 degrees: 1 - (1 + cos 75) / 2.
  EXPECT_NEAR(found.worst_reciprocity, 1.0 - (1.0 + std::cos(75.0 * degree)) / 2.0, 0.03);
  EXPECT_GT(found.weighted_reciprocity, 0.0);
  EXPECT_EQ(health(reciprocal(lame)).worst_reciprocity, 0.0);
}

TEST(BrdfHealth, GridPairsAreWithinTheirAngle) {
  const auto pairs = grid_pairs(1000);
  ASSERT_EQ(pairs.size(), 1000u);
  std::size_t near_peak = 0;
  for (const DirectionPair& pair : pairs) {
    EXPECT_GE(std::min(pair.in.z, pair.out.z), std::cos(75.0 * degree));
    near_peak += half_angles(pair.in, pair.out).theta_h < 5.0 * degree ? 1u : 0u;
  }
  // sqrt(5 / 90) = 0.24 of the grid lies within 5 degrees, and more of what is above the horizon.
  EXPECT_GT(near_peak, 240u);
}

}  // namespace
}  // namespace lackwerk::core
