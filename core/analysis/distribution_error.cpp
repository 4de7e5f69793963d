#include "core/analysis/distribution_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/check.hpp"

namespace lackwerk::core {

namespace {

/// Finds the box that holds a texel: boxes are listed by bands of L, so that few need be looked at.
class BoxFinder {
 public:
  explicit BoxFinder(std::span<const LabCuboid> clusters) : clusters_(clusters), bands_(band_count) {
    lo_ = std::numeric_limits<float>::max();
    float hi = std::numeric_limits<float>::lowest();
    for (const LabCuboid& cluster : clusters) {
      lo_ = std::min(lo_, cluster.lo.x);
      hi = std::max(hi, cluster.hi.x);
    }
    scale_ = hi > lo_ ? static_cast<float>(band_count) / (hi - lo_) : 0.0f;
    for (std::size_t c = 0; c < clusters.size(); ++c)
      for (std::size_t band = band_of(clusters[c].lo.x); band <= band_of(clusters[c].hi.x); ++band)
        bands_[band].push_back(c);
  }

  /// The index of the box, or the number of boxes if none holds it.
  [[nodiscard]] std::size_t find(const glm::vec3& lab) const {
    for (const std::size_t c : bands_[band_of(lab.x)]) {
      const LabCuboid& box = clusters_[c];
      if (box.lo.x <= lab.x && lab.x <= box.hi.x && box.lo.y <= lab.y && lab.y <= box.hi.y && box.lo.z <= lab.z &&
          lab.z <= box.hi.z)
        return c;
    }
    return clusters_.size();
  }

 private:
  static constexpr std::size_t band_count = 256;
  [[nodiscard]] std::size_t band_of(float l) const {
    const float band = std::clamp((l - lo_) * scale_, 0.0f, static_cast<float>(band_count - 1));
    return static_cast<std::size_t>(band);
  }

  std::span<const LabCuboid> clusters_;
  std::vector<std::vector<std::size_t>> bands_;
  float lo_ = 0.0f;
  float scale_ = 0.0f;
};

/// Sum over texels of what each pays to its share of the box, all shares of equal volume.
double pay(std::span<glm::vec3> texels, const glm::vec3& lo, const glm::vec3& hi) {
  const glm::vec3 side = hi - lo;
  if (texels.size() == 1) {
    const glm::vec3 away = texels[0] - 0.5f * (lo + hi);
    const float square = away.x * away.x + away.y * away.y + away.z * away.z;
    return std::sqrt(square + (side.x * side.x + side.y * side.y + side.z * side.z) / 12.0f);
  }
  int axis = side.x >= side.y ? 0 : 1;
  if (side.z > side[axis]) axis = 2;
  const std::size_t half = texels.size() / 2;
  std::nth_element(texels.begin(), texels.begin() + static_cast<std::ptrdiff_t>(half), texels.end(),
                   [axis](const glm::vec3& one, const glm::vec3& two) { return one[axis] < two[axis]; });
  glm::vec3 lower_hi = hi;
  lower_hi[axis] = lo[axis] + side[axis] * (static_cast<float>(half) / static_cast<float>(texels.size()));
  glm::vec3 upper_lo = lo;
  upper_lo[axis] = lower_hi[axis];
  return pay(texels.first(half), lo, lower_hi) + pay(texels.subspan(half), upper_lo, hi);
}

/// Texels by cluster, one after the other; `begin` gets clusters + 1 offsets.
std::vector<glm::vec3> group(std::span<const glm::vec3> texels, std::span<const LabCuboid> clusters,
                             std::vector<std::size_t>& begin) {
  const BoxFinder finder(clusters);
  std::vector<std::uint32_t> owner(texels.size());
  begin.assign(clusters.size() + 2, 0);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const std::size_t c = finder.find(texels[i]);
    owner[i] = static_cast<std::uint32_t>(c);
    ++begin[c + 1];
  }
  check_equal(begin[clusters.size() + 1], std::size_t{0}, "texels outside all clusters");
  begin.pop_back();
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    check_equal(begin[c + 1], std::size_t{clusters[c].count}, "texels in a cluster");
    begin[c + 1] += begin[c];
  }
  std::vector<glm::vec3> grouped(texels.size());
  std::vector<std::size_t> place(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < texels.size(); ++i) grouped[place[owner[i]]++] = texels[i];
  return grouped;
}

/// Integral of the CDF of a uniform [lo, hi] from below up to x.
double cdf_integral(double lo, double hi, double x) {
  if (x <= lo) return 0.0;
  if (x >= hi) return x - 0.5 * (lo + hi);
  return (x - lo) * (x - lo) / (2.0 * (hi - lo));
}

/// The distance of both distributions projected to one axis, from below: sum over grid cells of |integral of F - G|.
double projected_bound(std::span<const glm::vec3> texels, std::span<const LabCuboid> clusters,
                       std::span<const LabCuboid> stored, int axis) {
  constexpr std::size_t cells = 1024;
  double lo = std::numeric_limits<double>::max();
  double hi = std::numeric_limits<double>::lowest();
  for (const LabCuboid& box : stored) {
    lo = std::min(lo, static_cast<double>(box.lo[axis]));
    hi = std::max(hi, static_cast<double>(box.hi[axis]));
  }
  for (const glm::vec3& texel : texels) {  // stored boxes need not hold every texel
    lo = std::min(lo, static_cast<double>(texel[axis]));
    hi = std::max(hi, static_cast<double>(texel[axis]));
  }
  if (!(hi > lo)) return 0.0;
  const double width = (hi - lo) / cells;
  std::vector<double> count(cells, 0.0);
  std::vector<double> sum(cells, 0.0);  // of offsets from the cell's lower edge
  for (const glm::vec3& texel : texels) {
    const double offset = static_cast<double>(texel[axis]) - lo;
    const std::size_t cell = std::min(cells - 1, static_cast<std::size_t>(offset / width));
    count[cell] += 1.0;
    sum[cell] += offset - width * static_cast<double>(cell);
  }
  const double total = static_cast<double>(texels.size());
  double below = 0.0;
  double last = 0.0;
  double bound = 0.0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double texel_integral = (below * width + count[cell] * width - sum[cell]) / total;
    below += count[cell];
    double integral = 0.0;
    const double edge = lo + width * static_cast<double>(cell + 1);
    for (std::size_t c = 0; c < clusters.size(); ++c)
      integral += clusters[c].count / total *
                  cdf_integral(static_cast<double>(stored[c].lo[axis]), static_cast<double>(stored[c].hi[axis]), edge);
    bound += std::abs(texel_integral - (integral - last));
    last = integral;
  }
  return bound;
}

double coupling_bound(std::span<const glm::vec3> texels, std::span<const LabCuboid> clusters,
                      std::span<const LabCuboid> stored, std::size_t most_texels) {
  check_at_most(std::size_t{1}, most_texels, "texels looked at in a cluster");
  std::vector<std::size_t> begin;
  std::vector<glm::vec3> grouped = group(texels, clusters, begin);
  double sum = 0.0;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    const std::span<glm::vec3> own(grouped.data() + begin[c], begin[c + 1] - begin[c]);
    if (own.empty()) continue;
    std::size_t used = own.size();
    if (used > most_texels) {
      for (std::size_t i = 0; i < most_texels; ++i) own[i] = own[i * own.size() / most_texels];
      used = most_texels;
    }
    const double mean = pay(own.first(used), stored[c].lo, stored[c].hi) / static_cast<double>(used);
    sum += mean * static_cast<double>(own.size());
  }
  return sum / static_cast<double>(texels.size());
}

}  // namespace

WassersteinBounds wasserstein1_bounds(std::span<const glm::vec3> texels_lab, std::span<const LabCuboid> clusters,
                                      std::span<const LabCuboid> stored, std::size_t most_texels) {
  if (texels_lab.empty()) return {};
  if (stored.empty()) stored = clusters;
  check_equal(stored.size(), clusters.size(), "stored clusters");
  WassersteinBounds bounds;
  bounds.upper = coupling_bound(texels_lab, clusters, stored, most_texels);
  for (int axis = 0; axis < 3; ++axis)
    bounds.lower = std::max(bounds.lower, projected_bound(texels_lab, clusters, stored, axis));
  bounds.upper = std::max(bounds.upper, bounds.lower);  // the selection may have been a lucky one
  return bounds;
}

double wasserstein1_lab(std::span<const glm::vec3> texels_lab, std::span<const LabCuboid> clusters,
                        std::span<const LabCuboid> stored, std::size_t most_texels) {
  return wasserstein1_bounds(texels_lab, clusters, stored, most_texels).upper;
}

}  // namespace lackwerk::core
