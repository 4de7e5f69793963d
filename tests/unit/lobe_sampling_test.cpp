// Directions and numbers of the reference integrator: densities against samples, samples against quadrature.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <ostream>
#include <random>
#include <vector>

#include "core/analysis/reference_numbers.hpp"
#include "core/analysis/reference_sampling.hpp"
#include "core/paint_model.hpp"

namespace lackwerk::core {
namespace {

using glm::dvec2;
using glm::dvec3;
using std::numbers::pi;

const dvec3 up(0.0, 0.0, 1.0);

dvec3 direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  dvec2 pair() { return {number(), number()}; }
  double number() { return (static_cast<double>(engine_()) + 0.5) * 0x1p-32; }

 private:
  std::mt19937 engine_;
};

/// Integral of f over the directions above the surface, on rings around `peak` that lie denser near it.
template <class F>
double integral(const dvec3& peak, const F& f) {
  constexpr int rings = 700, spokes = 128;
  const ReferenceFrame frame(peak);
  double sum = 0.0;
  for (int a = 0; a < rings; ++a) {
    const auto angle = [](double t) { return pi * t * t * t; };
    const double from = angle(static_cast<double>(a) / rings), to = angle((a + 1.0) / rings);
    const double middle = 0.5 * (from + to), area = (std::cos(from) - std::cos(to)) * 2.0 * pi / spokes;
    for (int b = 0; b < spokes; ++b) {
      const dvec3 d = frame.to_world(direction(middle, 2.0 * pi * (b + 0.5) / spokes));
      if (d.z > 0.0) sum += f(d) * area;
    }
  }
  return sum;
}

struct Case {
  double m, eta, theta;
};
void PrintTo(const Case& c, std::ostream* out) { *out << "m " << c.m << ", index " << c.eta << ", view " << c.theta; }

class LobeSampling : public testing::TestWithParam<Case> {
 protected:
  static constexpr int draws = 200000;
  const Case c = GetParam();
  const dvec3 o = direction(c.theta, 0.4);
  const dvec3 mirror = direction(c.theta, 0.4 + pi);
  const LobeSampler sampler{up, o, c.eta};

  static Lobe lossless(double m) { return {dvec3(0.25), m, 1.0}; }
  /// One lobe of 4 s F = 1, bent by the index but under no coat's Fresnel.
  [[nodiscard]] PaintModel<double> model() const {
    PaintModel<double> out;
    const Lobe lobe = lossless(c.m);
    out.u_lobe[0] = {lobe.s, lobe.f0};
    out.u_inv_m = {1.0 / c.m, 1.0, 1.0};
    out.u_refraction_ior = c.eta;
    return out;
  }
};

TEST_P(LobeSampling, DensityIntegratesToTheShareOfDrawsThatLeave) {
  Random random(7);
  int left = 0;
  for (int k = 0; k < draws; ++k) left += sampler.sample(random.pair(), c.m).has_value() ? 1 : 0;
  const double share = static_cast<double>(left) / draws;
  const double mass = integral(mirror, [&](const dvec3& d) { return LobeSampler::pdf(sampler.target(d), c.m); });
  EXPECT_NEAR(mass, share, 4.0 * std::sqrt(share * (1.0 - share) / draws) + 2e-3);
  EXPECT_LE(mass, 1.0 + 2e-3);
  if (c.m < 0.05 && c.theta < 0.5) {
    EXPECT_NEAR(mass, 1.0, 1e-3) << "a narrow lobe loses nothing";
  }
}

TEST_P(LobeSampling, DrawsFollowTheDensity) {
  // Chi-square over rings around the mirror direction, cut so that each holds enough.
  constexpr int bins = 24;
  const double width = 6.0 * c.m * c.eta;
  const auto bin_of = [&](const dvec3& d) {
    const double t = std::acos(std::clamp(glm::dot(d, mirror), -1.0, 1.0)) / std::min(width, pi);
    return std::min(static_cast<int>(t * bins), bins - 1);
  };
  std::array<double, bins> seen{}, expected{};
  Random random(11);
  for (int k = 0; k < draws; ++k)
    if (const auto d = sampler.sample(random.pair(), c.m)) seen[static_cast<std::size_t>(bin_of(*d))] += 1.0;
  constexpr int rings = 6000, spokes = 96;
  const ReferenceFrame frame(mirror);
  for (int a = 0; a < rings; ++a) {
    // Rings that never straddle two bins: 240 to each; the rest of the sphere goes to the last one, too.
    const double edge = std::min(width, pi);
    const auto angle = [&](double t) { return t <= 0.96 ? edge * t / 0.96 : edge + (pi - edge) * (t - 0.96) / 0.04; };
    const double from = angle(static_cast<double>(a) / rings), to = angle((a + 1.0) / rings);
    const double middle = 0.5 * (from + to), area = (std::cos(from) - std::cos(to)) * 2.0 * pi / spokes;
    for (int b = 0; b < spokes; ++b) {
      const dvec3 d = frame.to_world(direction(middle, 2.0 * pi * (b + 0.5) / spokes));
      if (d.z > 0.0)
        expected[static_cast<std::size_t>(bin_of(d))] += LobeSampler::pdf(sampler.target(d), c.m) * area * draws;
    }
  }
  double chi2 = 0.0;
  int used = 0;
  for (std::size_t k = 0; k < bins; ++k) {
    if (expected[k] < 50.0) continue;
    // The quadrature's own error, 0.3 % of a bin, beside the counts' scatter.
    chi2 += std::pow(seen[k] - expected[k], 2) / (expected[k] + std::pow(0.003 * expected[k], 2));
    ++used;
  }
  ASSERT_GE(used, 4);
  EXPECT_LT(chi2, used + 5.0 * std::sqrt(2.0 * used)) << "over " << used << " bins";
}

TEST_P(LobeSampling, WeightedDrawsGiveTheIntegral) {
  PaintModel<double> lobe = model();
  const auto reflected = [&](const dvec3& d) { return lobe.paint_factor(up, d, o, {0, 0}, 0, 0).x / pi * d.z; };
  const double exact = integral(mirror, reflected);
  Random random(13);
  double sum = 0.0, squared = 0.0;
  for (int k = 0; k < draws; ++k) {
    const auto d = sampler.sample(random.pair(), c.m);
    const double pdf = d ? LobeSampler::pdf(sampler.target(*d), c.m) : 0.0;
    const double value = pdf > 0.0 ? reflected(*d) / pdf : 0.0;
    sum += value;
    squared += value * value;
  }
  const double mean = sum / draws;
  const double error = std::sqrt(std::max(squared / draws - mean * mean, 0.0) / draws);
  EXPECT_NEAR(mean, exact, 4.0 * error + 2e-3 * exact);
  if (c.eta == 1.0) {
    EXPECT_LE(mean, 1.0 + 4.0 * error) << "a lossless lobe gives no more than it takes";
  }
}

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const double m : {0.013, 0.1, 0.4, 0.9})
    for (const double eta : {1.0, 1.5})
      for (const double theta : {0.2, 0.9, 1.3}) out.push_back({m, eta, theta});
  return out;
}
INSTANTIATE_TEST_SUITE_P(All, LobeSampling, testing::ValuesIn(cases()));

TEST(LobeSamplingParts, HalfVectorsHaveTheirDensity) {
  for (const double m : {0.013, 0.1, 0.4, 0.9}) {
    // In t = tan^2/m^2 the density is exp(-t) whatever m: its mean is 1 and its variance 1.
    Random random(3);
    constexpr int draws = 100000;
    double sum = 0.0, mass = 0.0;
    for (int k = 0; k < draws; ++k) {
      const dvec3 h = sample_half_vector(random.pair(), m);
      EXPECT_NEAR(glm::length(h), 1.0, 1e-12);
      sum += (1.0 / (h.z * h.z) - 1.0) / (m * m);
    }
    EXPECT_NEAR(sum / draws, 1.0, 4.0 / std::sqrt(draws)) << m;
    for (int k = 0; k < 20000; ++k) {
      const double from = 0.5 * pi * std::pow(k / 20000.0, 3), to = 0.5 * pi * std::pow((k + 1) / 20000.0, 3);
      mass += half_vector_pdf(std::cos(0.5 * (from + to)), m) * 2.0 * pi * (std::cos(from) - std::cos(to));
    }
    EXPECT_NEAR(mass, 1.0, 1e-5) << m;
  }
}

TEST(LobeSamplingParts, RefractionGoesBothWays) {
  for (double theta = 0.05; theta < 1.55; theta += 0.1) {
    const dvec3 out = direction(theta, 1.1);
    const dvec3 in = refracted_in(out, up, 1.5);
    const auto back = refracted_out(in, up, 1.5);
    ASSERT_TRUE(back) << theta;
    EXPECT_NEAR(glm::distance(*back, out), 0.0, 1e-12) << theta;
    // The same Snell as the model's text.
    EXPECT_NEAR(glm::distance(PaintModel<double>().refract_into(out, up, 1.5), in), 0.0, 1e-12);
  }
  EXPECT_FALSE(refracted_out(direction(std::asin(1.0 / 1.5) + 1e-6, 0.0), up, 1.5)) << "total reflection";
}

TEST(LobeSamplingParts, CosineDirectionsHaveTheirMean) {
  Random random(5);
  const ReferenceFrame frame(glm::normalize(dvec3(0.3, -0.5, -0.8)));
  double sum = 0.0;
  constexpr int draws = 100000;
  for (int k = 0; k < draws; ++k) {
    const dvec3 d = sample_cosine(frame, random.pair());
    EXPECT_NEAR(glm::length(d), 1.0, 1e-12);
    sum += glm::dot(d, frame.z);
  }
  EXPECT_NEAR(sum / draws, 2.0 / 3.0, 1e-3) << "mean cosine under a cosine density";
}

TEST(ReferenceNumbersTest, ABatchFillsEveryCellOnce) {
  for (std::uint64_t pixel = 0; pixel < 50; ++pixel) {
    std::array<int, reference_batch> squares{}, rows{}, columns{};
    for (std::uint32_t k = 0; k < reference_batch; ++k) {
      ReferenceNumbers numbers(9, pixel, 3, k);
      (void)numbers.next();
      const dvec2 u = numbers.next();
      ASSERT_TRUE(u.x > 0.0 && u.x < 1.0 && u.y > 0.0 && u.y < 1.0);
      ++squares[static_cast<std::size_t>(static_cast<int>(u.x * 8) * 8 + static_cast<int>(u.y * 8))];
      ++rows[static_cast<std::size_t>(u.x * reference_batch)];
      ++columns[static_cast<std::size_t>(u.y * reference_batch)];
    }
    for (std::size_t k = 0; k < squares.size(); ++k)
      EXPECT_TRUE(squares[k] == 1 && rows[k] == 1 && columns[k] == 1) << k;
  }
}

TEST(ReferenceNumbersTest, BatchesAndPairsAreIndependent) {
  // Means, and correlations between pairs of one sample and between batches of one pixel, all within 4 sigma of 0.
  constexpr int count = 40000;
  double mean = 0.0, pairs = 0.0, batches = 0.0, pixels = 0.0, lag = 0.0, before = 0.0;
  for (int k = 0; k < count; ++k) {
    const auto pixel = static_cast<std::uint64_t>(k);
    ReferenceNumbers here(1, pixel, 0, 5), later(1, pixel, 1, 5), beside(1, pixel + 1, 0, 5);
    const dvec2 a = here.next() - 0.5, b = here.next() - 0.5;
    mean += a.x + a.y + b.x + b.y;
    pairs += a.x * b.x + a.y * b.y;
    batches += a.x * (later.next().x - 0.5);
    pixels += a.y * (beside.next().y - 0.5);
    lag += before * a.x;
    before = a.y;
  }
  const double scatter = 1.0 / 12.0 * std::sqrt(count);
  EXPECT_LT(std::abs(mean), 4.0 * std::sqrt(4.0 * count / 12.0));
  EXPECT_LT(std::abs(pairs), 4.0 * std::sqrt(2.0) * scatter);
  EXPECT_LT(std::abs(batches), 4.0 * scatter);
  EXPECT_LT(std::abs(pixels), 4.0 * scatter);
  EXPECT_LT(std::abs(lag), 4.0 * scatter);
}

}  // namespace
}  // namespace lackwerk::core
