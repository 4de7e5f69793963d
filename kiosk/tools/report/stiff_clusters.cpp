#include "kiosk/tools/report/stiff_clusters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/analysis/distribution_error.hpp"
#include "core/analysis/flake_clusters.hpp"

namespace lackwerk::report {

namespace {

using core::ClusterSettings;
using core::LabCuboid;
using core::PruneRule;
using Texels = std::vector<glm::vec3>;

constexpr const char* kernel = "clusters";

const char* rule_name(PruneRule rule) { return rule == PruneRule::misfit ? "misfit rule" : "density rule"; }

void add_case(Findings& findings, const std::string& name, const std::string& measure, double worst, double bound,
              const std::string& where) {
  StiffCase found;
  found.kernel = kernel;
  found.name = name;
  found.measure = measure;
  found.worst = worst;
  found.bound = bound;
  found.where = where;
  findings.stiff.push_back(std::move(found));
}

bool holds(const LabCuboid& box, const glm::vec3& p) {
  for (int axis = 0; axis < 3; ++axis)
    if (p[axis] < box.lo[axis] || p[axis] > box.hi[axis]) return false;
  return true;
}

/// By looking at every box for every texel.
struct BruteForce {
  double strays = 0.0;        ///< texels that are not in exactly one box
  double miscounted = 0.0;    ///< sum over boxes of |texels in it - its count|
  long double corner = 0.0L;  ///< mean distance of a texel to the farthest corner of its box
};

BruteForce brute_force(const Texels& texels, const std::vector<LabCuboid>& boxes) {
  BruteForce out;
  std::vector<double> count(boxes.size(), 0.0);
  long double sum = 0.0L;
  for (const glm::vec3& texel : texels) {
    int owners = 0;
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      if (!holds(boxes[k], texel)) continue;
      ++owners;
      count[k] += 1.0;
      if (owners > 1) continue;
      long double square = 0.0L;
      for (int axis = 0; axis < 3; ++axis) {
        const long double p = texel[axis];
        const long double away = std::max(p - boxes[k].lo[axis], boxes[k].hi[axis] - p);
        square += away * away;
      }
      sum += std::sqrt(square);
    }
    if (owners != 1) out.strays += 1.0;
  }
  for (std::size_t k = 0; k < boxes.size(); ++k)
    out.miscounted += std::abs(count[k] - static_cast<double>(boxes[k].count));
  out.corner = sum / static_cast<long double>(texels.size());
  return out;
}

/// The three judgements every case gets, by both rules. `w1_bound`: of the misfit rule, Lab.
void judge(const std::string& name, const Texels& texels, double w1_bound, const std::string& why, Findings& findings) {
  double strays = 0.0, miscounted = 0.0, excess = 0.0, w1 = none;
  std::string at;
  for (const PruneRule rule : {PruneRule::misfit, PruneRule::density}) {
    ClusterSettings settings;
    settings.rule = rule;
    const std::vector<LabCuboid> boxes = core::cluster_texels(texels, settings);
    const BruteForce brute = brute_force(texels, boxes);
    strays = std::max(strays, brute.strays);
    miscounted = std::max(miscounted, brute.miscounted);
    if (brute.strays > 0.0 || brute.miscounted > 0.0) {  // W1 has no meaning then, and would abort
      excess = w1 = none;
      at = rule_name(rule);
      continue;
    }
    const core::WassersteinBounds bounds = core::wasserstein1_bounds(texels, boxes);
    if (rule == PruneRule::misfit) w1 = bounds.upper;
    const double over = bounds.upper - static_cast<double>(brute.corner);
    if (!(over <= excess)) {
      excess = over;
      at = rule_name(rule);
    }
  }
  const std::string count = std::to_string(texels.size()) + " texels";
  add_case(findings, name, "texels outside their one box", strays, 0.0, at.empty() ? count : count + ", " + at);
  add_case(findings, name, "texels not counted", miscounted, 0.0, at.empty() ? count : count + ", " + at);
  // No plan inside a box can pay more than the way to its farthest corner: rounding of float sums alone, relative to
  // colours of 1e4.
  add_case(findings, name, "W1 bound above the farthest-corner plan, Lab", excess, 1e-3,
           at.empty() ? "both rules" : at);
  add_case(findings, name, "1-Wasserstein distance, Lab", w1, w1_bound, why);
}

Texels cloud(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  // Sums of uniform numbers: the same on every standard library, which normal_distribution is not.
  const auto bell = [&] {
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) sum += static_cast<double>(random()) / 4294967296.0;
    return static_cast<float>(sum);
  };
  Texels out;
  out.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const float l = bell(), a = bell(), b = bell();
    out.emplace_back(30.0f + 8.0f * l, 2.0f + 2.0f * a, -4.0f + 3.0f * b);
  }
  return out;
}

void add_flat(Findings& findings) {
  judge("1 pixel", Texels(1, glm::vec3(61.0f, -3.0f, 7.0f)), 0.0, "its box is the texel", findings);
  judge("one colour", Texels(10'000, glm::vec3(61.0f, -3.0f, 7.0f)), 0.0, "its box is the colour", findings);
  Texels two(7'000, glm::vec3(10.0f, 1.0f, 2.0f));
  two.resize(10'000, glm::vec3(10.0f, 1.0f, 2.001f));
  // Sums over the 1024 cells of the lower bound's grid in double, of colours up to 16: rounding alone.
  judge("two colours", two, 1024 * 16.0 * 0x1p-52, "one box each, 0.001 Lab apart", findings);

  constexpr int steps = 9'000;
  Texels line;
  line.reserve(steps);
  for (int k = 0; k < steps; ++k) {
    const float at = static_cast<float>(k) / static_cast<float>(steps - 1);
    line.emplace_back(90.0f * at, -45.0f * at, 30.0f * at);
  }
  // Texels on the diagonal of a box pay at most half its diagonal on average (they lie evenly along it, the box fills
  // its middle): half of 105 Lab by at least 33 leaves, which an octree with 50 always has of a line cut in halves.
  judge("collinear", line, 0.5 * 105.0 / 33.0, "even on a slanted line of 105 Lab", findings);

  constexpr int edge = 100;
  Texels plane;
  plane.reserve(std::size_t{edge} * edge);
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(edge - 1);
      const float v = static_cast<float>(y) / static_cast<float>(edge - 1);
      plane.emplace_back(64.0f * u, 64.0f * v, 32.0f * (u + v));
    }
  // Boxes of a plane that is slanted in all axes are cut by it: a texel pays at most half a diagonal. 48 squares of
  // 64 / 4 have the diagonal 16 sqrt(3).
  judge("coplanar", plane, 0.5 * 16.0 * std::sqrt(3.0), "even on a slanted plane, 64 x 64 x 64 Lab", findings);
}

void add_outliers(Findings& findings) {
  constexpr std::size_t count = 10'000;
  const Texels others = cloud(count, 5);
  const double alone = core::wasserstein1_lab(others, core::cluster_texels(others, {}));
  double worst = 0.0;
  std::string where;
  const std::array<std::pair<const char*, glm::vec3>, 3> outliers = {
      {{"L", {1e4f, 0.0f, 0.0f}}, {"a", {30.0f, -1e4f, 0.0f}}, {"b", {30.0f, 0.0f, 1e4f}}}};
  for (const auto& [axis, colour] : outliers) {
    Texels texels = others;
    texels.push_back(colour);
    // The outlier's box is itself and pays nothing.
    const double with = core::wasserstein1_lab(texels, core::cluster_texels(texels, {})) *
                        static_cast<double>(count + 1) / static_cast<double>(count);
    if (with / alone <= worst) continue;
    worst = with / alone;
    where = std::string("outlier along ") + axis;
  }
  // The root is 16384 Lab wide then and 16 levels end at 0.25 Lab, far below the boxes of 50 clusters. What remains is
  // where the grid's planes happen to lie, and one cluster of 50 that the outlier takes.
  add_case(findings, "one outlier of 1e4", "error of the others, over that without it", worst, 1.5, where);
  Texels texels = others;
  texels.push_back(outliers[0].second);
  judge("one outlier of 1e4", texels, 1.5, "all texels", findings);
}

/// So many texels of 4096 colours, colour k as often as its share of a falling series says.
void add_many(bool quick, Findings& findings) {
  const std::size_t count = quick ? 1'000'000 : 16'000'000;
  constexpr std::size_t colours = 4096;
  const auto colour = [](std::size_t k) {
    const std::size_t l = k % 16, a = k / 16 % 16, b = k / 256;
    return glm::vec3(2.0f * static_cast<float>(l), static_cast<float>(a) - 8.0f, static_cast<float>(b) - 8.0f);
  };
  std::vector<std::uint64_t> often(colours, 0);
  Texels texels(count);
  for (std::size_t k = 0; k < count; ++k) {
    // Two uniform numbers from one golden-ratio walk, multiplied: dark corners of the lattice are crowded.
    const std::uint64_t walk = k * 0x9E3779B97F4A7C15ull;
    const std::uint64_t at = (((walk >> 40) * (walk >> 16 & 0xffffff)) >> 36) % colours;
    ++often[at];
    texels[k] = colour(at);
  }
  const std::vector<LabCuboid> boxes = core::cluster_texels(texels, {});
  std::uint64_t sum = 0;
  for (const LabCuboid& box : boxes) sum += box.count;
  double miscounted = 0.0, strays = 0.0;
  std::vector<std::uint64_t> inside(boxes.size(), 0);
  long double corner = 0.0L;
  for (std::size_t k = 0; k < colours; ++k) {
    if (often[k] == 0) continue;
    int owners = 0;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      if (!holds(boxes[b], colour(k))) continue;
      ++owners;
      inside[b] += often[k];
      const glm::dvec3 side = glm::dvec3(boxes[b].hi) - glm::dvec3(boxes[b].lo);
      corner += static_cast<long double>(often[k]) * std::sqrt(side.x * side.x + side.y * side.y + side.z * side.z);
    }
    if (owners != 1) strays += static_cast<double>(often[k]);
  }
  for (std::size_t b = 0; b < boxes.size(); ++b)
    miscounted += std::abs(static_cast<double>(inside[b]) - static_cast<double>(boxes[b].count));
  miscounted += std::abs(static_cast<double>(sum) - static_cast<double>(count));
  const std::string name = std::to_string(count / 1'000'000) + " million pixels";
  const std::string where = std::to_string(boxes.size()) + " boxes of 4096 colours";
  add_case(findings, name, "texels outside their one box", strays, 0.0, where);
  add_case(findings, name, "texels not counted", miscounted, 0.0, where);
  // 30 x 15 x 15 Lab in 50 boxes: cells of 7.5 x 7.5 x 7.5 (32 of them would do) have this diagonal, the way between
  // two places in a box at most.
  add_case(findings, name, "mean diagonal of a texel's box, Lab (bounds W1)",
           static_cast<double>(corner / static_cast<long double>(count)), 7.5 * std::sqrt(3.0), where);
}

}  // namespace

void add_stiff_clusters(bool quick, Findings& findings) {
  add_flat(findings);
  add_outliers(findings);
  add_many(quick, findings);
}

}  // namespace lackwerk::report
