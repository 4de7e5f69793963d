// Isochromatic lines: against Kirchner et al. 2015 (KI) done the long way, the cures of the critical angle, the
// degenerate cases, and the shader's text at double, float and 16 bits.
#include "core/isochromatic.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <numbers>
#include <random>

namespace lackwerk::core {
namespace {

using glm::dvec2;
using glm::dvec3;
using enum CriticalAngleCure;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double quarter = std::numbers::pi / 2.0;
const dvec3 up(0.0, 0.0, 1.0);

/// Light at azimuth 180, eye at this one less 180: phi as KI count it, 0 on the light's side.
struct Pair {
  dvec3 in, out;
};
dvec3 direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}
Pair pair_deg(double ill, double det, double phi) {
  return {direction(ill * degree, 0.0), direction(det * degree, phi * degree)};
}

/// Calls f with pairs of random directions, even over angles.
template <class F>
void for_random_pairs(int count, F f) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> polar(0.5, 89.5), azimuth(0.5, 179.5);
  for (int k = 0; k < count; ++k) f(pair_deg(polar(random), polar(random), azimuth(random)));
}

/// KI's way, by refraction and Snell's law: eq. 1 to 4.
FlakeAngles flake_angles_by_refraction(const Pair& at, double index) {
  const double sin1 = std::sqrt(1.0 - at.in.z * at.in.z) / index, sin2 = std::sqrt(1.0 - at.out.z * at.out.z) / index;
  const double cos1 = std::sqrt(1.0 - sin1 * sin1), cos2 = std::sqrt(1.0 - sin2 * sin2);
  const double cos_phi =
      (at.in.x * at.out.x + at.in.y * at.out.y) / (sin1 * index * sin2 * index);  // azimuths do not refract
  const double dot = sin1 * sin2 * cos_phi + cos1 * cos2;
  return {0.5 * std::acos(dot), std::acos((cos1 + cos2) / std::sqrt(2.0 + 2.0 * dot))};
}

TEST(Isochromatic, FlakeAnglesAreThoseOfEquations1To4) {
  for (const double index : {1.0, 1.3, 1.5, 2.5})
    for_random_pairs(2000, [&](const Pair& at) {
      const FlakeAngles long_way = flake_angles_by_refraction(at, index), ours = flake_angles(at.in, at.out, index);
      EXPECT_NEAR(ours.theta_inc, long_way.theta_inc, 1e-7) << index;  // acos loses half of the digits near 0
      EXPECT_NEAR(ours.theta_flake, long_way.theta_flake, 1e-7) << index;
    });
}

TEST(Isochromatic, Equations5To7CollapseToSumAndDifference) {
  for_random_pairs(500, [](const Pair& at) {
    const FlakeAngles f = flake_angles(at.in, at.out, 1.5);
    const double ci = std::cos(f.theta_inc), si = std::sin(f.theta_inc);
    const double cf = std::cos(f.theta_flake), sf = std::sin(f.theta_flake);
    for (const double cos_phi : {1.0, -1.0})  // phi_flake = 0 and 180
      for (const double root : {1.0, -1.0}) {
        const double cos1 = cf * ci + root * sf * cos_phi * si;  // eq. 5; sin(phi_flake) = 0, SQ = si
        const double sin1 = (ci - cf * cos1) / (sf * cos_phi);   // eq. 6 with theta'_1 on its right side
        const double cos2 = -cos1 + 2.0 * (sf * cos_phi * sin1 + cf * cos1) * cf;  // eq. 7
        EXPECT_NEAR(sin1 * sin1 + cos1 * cos1, 1.0, 1e-6);
        const double s = root * cos_phi;
        EXPECT_NEAR(cos1, std::cos(f.theta_inc - s * f.theta_flake), 1e-9);
        EXPECT_NEAR(cos2, std::cos(f.theta_inc + s * f.theta_flake), 1e-9);
      }
  });
}

TEST(Isochromatic, Equation6AsPrintedIsNoSine) {
  // Light at 60, eye at 30 degrees, 90 degrees apart: with the unprimed theta_1 sine and cosine are of no one angle.
  const Pair at = pair_deg(60.0, 30.0, 90.0);
  const FlakeAngles f = flake_angles(at.in, at.out, 1.5);
  const double cos1 = std::cos(f.theta_inc + f.theta_flake);
  const double cos_unprimed = std::sqrt(1.0 - std::pow(std::sin(60.0 * degree) / 1.5, 2));
  const auto sine = [&](double right_side) {
    return (std::cos(f.theta_inc) - std::cos(f.theta_flake) * right_side) / std::sin(f.theta_flake);
  };
  EXPECT_NEAR(sine(cos1) * sine(cos1) + cos1 * cos1, 1.0, 1e-9);
  EXPECT_GT(std::abs(sine(cos_unprimed) * sine(cos_unprimed) + cos1 * cos1 - 1.0), 0.05);
}

TEST(Isochromatic, PairInThePlaneGivesItselfAndItsReverse) {
  for (const double index : {1.0, 1.05, 1.5, 2.5})
    for (double ill = 0.0; ill <= 89.0; ill += 1.0)
      for (double det = -89.0; det <= 89.0; det += 1.0) {
        const Pair at = pair_deg(ill, std::abs(det), det < 0.0 ? 0.0 : 180.0);
        const auto found = in_plane(at.in, at.out, index, clip);
        const bool as_given = ill >= std::abs(det);
        const InPlane& same = found[as_given ? 0 : 1];
        const InPlane& reverse = found[as_given ? 1 : 0];
        // At index 1 and 89 degrees an error of one bit in a cosine is 1e-14 of the angle; at the mirror direction the
        // root of a difference of squares makes 1e-8 of it.
        EXPECT_NEAR(same.light, ill * degree, 1e-7) << index << " " << ill << " " << det;
        // A light along the normal has no side.
        EXPECT_NEAR(ill > 0.0 ? same.eye : std::abs(same.eye), (ill > 0.0 ? det : std::abs(det)) * degree, 1e-7)
            << index << " " << ill << " " << det;
        EXPECT_NEAR(reverse.light, std::abs(det) * degree, 1e-7);
        EXPECT_NEAR(std::abs(reverse.eye), ill * degree, 1e-7);
      }
}

TEST(Isochromatic, BothSolutionsLieOnTheLine) {
  int lines = 0;
  for_random_pairs(20000, [&](const Pair& at) {
    if (needs_cure(at.in, at.out, 1.5)) return;
    const FlakeAngles f = flake_angles(at.in, at.out, 1.5);
    for (const InPlane& solution : in_plane(at.in, at.out, 1.5, clip)) {
      const InPlaneDirections there = in_plane_directions(solution);
      const FlakeAngles same = flake_angles(there.in, there.out, 1.5);
      EXPECT_NEAR(same.theta_inc, f.theta_inc, 1e-7);
      EXPECT_NEAR(same.theta_flake, f.theta_flake, 1e-7);
      EXPECT_EQ(solution.eye >= 0.0, f.theta_inc >= f.theta_flake);
    }
    const auto by_angles = in_plane(f, 1.5, clip);
    EXPECT_NEAR(by_angles[0].light, in_plane(at.in, at.out, 1.5, clip)[0].light, 1e-6);
    ++lines;
  });
  EXPECT_GT(lines, 10000);
}

TEST(Isochromatic, ExchangeOfLightAndEyeChangesNoBit) {
  for (const double index : {1.0, 1.5, 2.5})
    for (const auto cure : {clip, slide, slide_along, index_one})
      for_random_pairs(1000, [&](const Pair& at) {
        EXPECT_EQ(map_place(at.in, at.out, index, cure), map_place(at.out, at.in, index, cure));
      });
}

// ---- cures of the critical angle

TEST(Isochromatic, CuresAAndBAreOneWhereNoneIsNeeded) {
  int cured = 0, uncured = 0, moved = 0;
  for (const double index : {1.05, 1.33, 1.5, 2.5})
    for_random_pairs(20000, [&](const Pair& at) {
      const dvec2 a = map_place(at.in, at.out, index, clip);
      const dvec2 b = map_place(at.in, at.out, index, slide), along = map_place(at.in, at.out, index, slide_along);
      if (needs_cure(at.in, at.out, index)) {
        ++cured;
        EXPECT_EQ(a.x, 1.0);
        EXPECT_EQ(b.x, 1.0);
        EXPECT_GE(b.y, a.y);
        EXPECT_LE(along.y, a.y);
        if (b.y > a.y + 0.01) ++moved;
        return;
      }
      ++uncured;
      EXPECT_EQ(a, b);
      EXPECT_EQ(a, along);
    });
  EXPECT_GT(uncured, 40000);
  EXPECT_GT(cured, 20000);
  EXPECT_GT(moved, cured / 2);
}

TEST(Isochromatic, CureBMovesOnADiagonal) {
  // KI's points a, b, c lie on one diagonal and have one colour: that of the diagonal's end at x = 1.
  IsochromaticModel<double> model;
  const double y = 0.3;
  for (const double beyond : {0.0, 0.1, 0.25}) {
    const double sine_x = std::sqrt(1.0 + beyond * beyond), cos_y = 1.0 - (y - beyond);
    const dvec2 place = model.isochromatic_slide({sine_x, std::sqrt(1.0 - cos_y * cos_y)}, 1.0);
    EXPECT_NEAR(place.x, 1.0, 1e-12);
    EXPECT_NEAR(place.y, y, 1e-12);
  }
}

TEST(Isochromatic, CureCAgreesInThePlaneAlone) {
  double in_the_plane = 0.0;
  for (double ill = 0.0; ill <= 89.0; ill += 1.0)
    for (double det = 0.0; det <= 89.0; det += 1.0)
      for (const double phi : {0.0, 180.0}) {
        const Pair at = pair_deg(ill, det, phi);
        const InPlane a = in_plane(at.in, at.out, 1.5, clip)[0], c = in_plane(at.in, at.out, 1.5, index_one)[0];
        in_the_plane = std::max({in_the_plane, std::abs(a.light - c.light), std::abs(a.eye - c.eye)});
      }
  EXPECT_LT(in_the_plane / degree, 1e-5);
}

TEST(Isochromatic, HowOftenCuresAreNeededAndHowFarCMoves) {
  // Every angle in steps of 1 degree: polar 0 to 90, azimuth 0 to 180 (1,498,861 geometries), index 1.5.
  long all = 0, needs_a = 0, needs_c = 0;
  double moved = 0.0;
  for (int phi = 0; phi <= 180; ++phi)
    for (int ill = 0; ill <= 90; ++ill)
      for (int det = 0; det <= ill; ++det) {  // the other half is the same by reciprocity
        const int weight = det < ill ? 2 : 1;
        const Pair at = pair_deg(ill, det, phi);
        const bool a = needs_cure(at.in, at.out, 1.5), c = needs_cure(at.in, at.out, 1.0);
        all += weight;
        needs_a += a ? weight : 0;
        needs_c += c ? weight : 0;
        if (a || c) continue;
        const InPlane x = in_plane(at.in, at.out, 1.5, clip)[0], y = in_plane(at.in, at.out, 1.5, index_one)[0];
        moved = std::max({moved, std::abs(x.light - y.light), std::abs(x.eye - y.eye)});
      }
  EXPECT_EQ(all, 91L * 91L * 181L);
  const auto share = [all](long count) { return 100.0 * static_cast<double>(count) / static_cast<double>(all); };
  EXPECT_NEAR(share(needs_a), 35.8, 0.2);
  EXPECT_NEAR(share(needs_c), 17.5, 0.2);
  EXPECT_NEAR(moved / degree, 21.4, 0.1);
}

TEST(Isochromatic, OnlyTheLargerAngleCanPassTheCriticalOne) {
  for (const double index : {1.0, 1.1, 1.5, 2.5})
    for_random_pairs(20000, [&](const Pair& at) {
      const FlakeAngles f = flake_angles(at.in, at.out, index);
      EXPECT_LE(std::abs(f.theta_inc - f.theta_flake), std::asin(1.0 / index) + 1e-9);
    });
}

// ---- degenerate geometries

TEST(Isochromatic, MirrorAndRetroDirections) {
  for (const double index : {1.0, 1.5, 2.5})
    for (double theta = 0.0; theta < 90.0; theta += 5.0) {
      const Pair mirror = pair_deg(theta, theta, 180.0), retro = pair_deg(theta, theta, 0.0);
      EXPECT_NEAR(flake_angles(mirror.in, mirror.out, index).theta_flake, 0.0, 1e-15);
      const InPlane m = in_plane(mirror.in, mirror.out, index, clip)[0];
      EXPECT_NEAR(m.light, theta * degree, 1e-9);
      EXPECT_NEAR(m.eye, m.light, 1e-9);
      EXPECT_NEAR(flake_angles(retro.in, retro.out, index).theta_inc, 0.0, 1e-15);
      const InPlane r = in_plane(retro.in, retro.out, index, clip)[0];
      EXPECT_NEAR(r.light, theta * degree, 1e-9);
      EXPECT_NEAR(r.eye, -r.light, 1e-9);
    }
}

TEST(Isochromatic, NormalLightOrEyeNeedsNoAzimuth) {
  for (double phi = 0.0; phi <= 360.0; phi += 15.0) {
    const InPlane at = in_plane(up, direction(0.8, phi * degree), 1.5, clip)[0];
    EXPECT_NEAR(at.light, 0.8, 1e-12);
    EXPECT_NEAR(at.eye, 0.0, 1e-7);
  }
}

TEST(Isochromatic, OppositeGrazingDirectionsHaveTheNormalBetweenThem) {
  for (const double index : {1.0, 1.5}) {
    const InPlane at = in_plane({1, 0, 0}, {-1, 0, 0}, index, clip)[0];
    EXPECT_NEAR(at.light, quarter, 1e-6) << index;
    EXPECT_NEAR(at.eye, quarter, 1e-6) << index;
  }
}

TEST(Isochromatic, IndexOneChangesNothing) {
  for_random_pairs(1000, [](const Pair& at) {
    EXPECT_EQ(map_place(at.in, at.out, 1.0, clip), map_place(at.in, at.out, 1.5, index_one));
    const dvec3 half = glm::normalize(at.in + at.out);
    EXPECT_NEAR(flake_angles(at.in, at.out, 1.0).theta_flake, std::acos(half.z), 1e-9);
    EXPECT_NEAR(flake_angles(at.in, at.out, 1.0).theta_inc, std::acos(glm::dot(half, at.in)), 1e-7);
  });
}

// ---- the shader's text

/// Everything the text gives for a pair, in the map and beside it.
template <class Model>
bool all_good(Model model, const Pair& at, double index, double slack) {
  using T = typename Model::real;
  using V3 = typename Model::vec3;
  const auto narrow = [](const dvec3& v) { return V3(T(v.x), T(v.y), T(v.z)); };
  const auto sines =
      model.isochromatic_sines(model.isoline(narrow(up), narrow(at.in), narrow(at.out), T(index)), T(index));
  for (const auto& place : {model.isochromatic_clip(sines), model.isochromatic_slide(sines, T(1)),
                            model.isochromatic_slide(sines, T(-1))}) {
    const auto texel = model.isochromatic_texel(place);
    const auto cosines = model.isochromatic_cosines(place);
    // Written so that a NaN fails.
    for (const T& x : {place.x, texel.x, cosines.x, cosines.y})
      if (!(x >= T(0) && x <= T(1))) return false;
    for (const T& y : {place.y, texel.y})
      if (!(y >= T(-1) && y <= T(1))) return false;
    if (!(std::abs(static_cast<double>(place.y)) <= static_cast<double>(place.x) + slack)) return false;
  }
  return true;
}

template <class Model>
void expect_good_everywhere(Model model, std::initializer_list<double> indices, int step, double slack) {
  for (const double index : indices) {
    long bad = 0;
    for (int phi = 0; phi <= 180; phi += step)
      for (int ill = 0; ill <= 90; ill += step)
        for (int det = 0; det <= ill; det += step)  // exchanged, all is the same to the last bit
          if (!all_good(model, pair_deg(ill, det, phi), index, slack)) ++bad;
    EXPECT_EQ(bad, 0) << index;
  }
}

TEST(Isochromatic, NoNanOnAOneDegreeGridOfAllAngles) {
  expect_good_everywhere(IsochromaticModel<double>{}, {1.0, 1.05, 1.41, 1.5, 1.8, 2.5}, 1, 1e-7);
}

TEST(Isochromatic, NoNanOnAOneDegreeGridAtFloat) {
  expect_good_everywhere(IsochromaticModel<float>{}, {1.0, 1.5, 2.5}, 1, 1e-3);
}

/// 16-bit vectors: glm takes no scalar of another make. Eigen::half rounds after every operation, as a GPU does.
using Half = Eigen::half;
struct HalfVec2 {
  Half x, y;
  HalfVec2(Half x_, Half y_) : x(x_), y(y_) {}
};
struct HalfVec3 {
  Half x, y, z;
  HalfVec3(Half x_, Half y_, Half z_) : x(x_), y(y_), z(z_) {}
  HalfVec3 operator+(const HalfVec3& b) const { return {x + b.x, y + b.y, z + b.z}; }
  HalfVec3 operator-(const HalfVec3& b) const { return {x - b.x, y - b.y, z - b.z}; }
};
using HalfModel = IsochromaticModel<Half, HalfVec2, HalfVec3>;

TEST(Isochromatic, SixteenBitsStayFiniteAndInTheMap) { expect_good_everywhere(HalfModel{}, {1.0, 1.5, 2.5}, 3, 0.1); }

double isochromatic_light(const Pair& at, double index) { return in_plane(at.in, at.out, index, clip)[0].light; }

/// Largest distance between the texel coordinates of two precisions, over places with theta'_ill up to `steepest`
/// degrees: 1 - cos of an angle grows without bound over its sine towards 90.
template <class Model>
double largest_shift(Model model, double index, double steepest) {
  using T = typename Model::real;
  using V3 = typename Model::vec3;
  IsochromaticModel<double> exact;
  double worst = 0.0;
  for_random_pairs(50000, [&](const Pair& at) {
    if (isochromatic_light(at, index) > steepest * degree) return;
    const auto narrow = [](const dvec3& v) { return V3(T(v.x), T(v.y), T(v.z)); };
    const auto here = model.isochromatic_texel(model.isochromatic_clip(
        model.isochromatic_sines(model.isoline(narrow(up), narrow(at.in), narrow(at.out), T(index)), T(index))));
    const dvec2 there = exact.isochromatic_texel(
        exact.isochromatic_clip(exact.isochromatic_sines(exact.isoline(up, at.in, at.out, index), index)));
    worst = std::max(
        {worst, std::abs(static_cast<double>(here.x) - there.x), std::abs(static_cast<double>(here.y) - there.y)});
  });
  return worst;
}

TEST(Isochromatic, PrecisionsAgreeWithinATexel) {
  // Texels of a map of 64 are 1/63 = 0.0159 apart.
  for (const double index : {1.0, 1.5, 2.5}) {
    EXPECT_LT(largest_shift(IsochromaticModel<float>{}, index, 90.0), 1e-3) << index;
    EXPECT_LT(largest_shift(HalfModel{}, index, 70.0), 1.0 / 63.0) << index;
    EXPECT_LT(largest_shift(HalfModel{}, index, 90.0), 2.0 / 63.0) << index;
  }
}

}  // namespace
}  // namespace lackwerk::core
