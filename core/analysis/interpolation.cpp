#include "core/analysis/interpolation.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <thread>

#include "core/analysis/transport.hpp"

namespace lackwerk::core {

namespace {

using Clusters = std::vector<LabCuboid>;

/// A tuple under construction.
struct Tuple {
  std::array<std::uint8_t, max_paints> cluster{};
  std::int64_t mass = 0;
};

struct Row {
  std::vector<Tuple> tuples;
  std::array<std::vector<QuantisedCuboid>, max_paints> clusters;
};

std::string row_name(const FlakeFrame& frame, std::size_t row) {
  const auto slices = static_cast<std::size_t>(std::max(frame.layout.slice_count(), 1));
  return "row " + std::to_string(row) + " (level " + std::to_string(row / slices) + ", slice " +
         std::to_string(row % slices) + ")";
}

Result<void> check_clusters(const Clusters& clusters, const std::string& paint, const std::string& field) {
  if (clusters.empty()) return fail(paint, field, "has no clusters");
  if (clusters.size() > max_clusters_per_row)
    return fail(paint, field, std::to_string(clusters.size()) + " clusters are more than the 250 a row may have",
                "cluster with fewer");
  std::uint64_t total = 0;
  for (const LabCuboid& cluster : clusters) {
    if (cluster.count == 0) return fail(paint, field, "a cluster stands for no texel");
    total += cluster.count;
    for (int axis = 0; axis < 3; ++axis)
      if (!std::isfinite(cluster.lo[axis]) || !std::isfinite(cluster.hi[axis]) || cluster.lo[axis] > cluster.hi[axis])
        return fail(paint, field, "a cluster's box is inside out or not finite");
  }
  if (total > std::uint64_t{1} << 30) return fail(paint, field, "more than 2^30 texels");
  return {};
}

Result<void> check_input(const std::vector<ClusteredPaint>& paints, const FlakeFrame& frame, int threads) {
  if (paints.empty() || paints.size() > max_paints)
    return fail({}, "paints", std::to_string(paints.size()) + " paints", "a pack holds 1 to 5", ErrorKind::usage);
  if (threads < 1) return fail({}, "threads", std::to_string(threads) + " threads", "use 1 or more", ErrorKind::usage);
  const std::size_t rows = std::size_t{frame.level_count} * static_cast<std::size_t>(frame.layout.slice_count());
  for (const ClusteredPaint& paint : paints) {
    if (paint.rows.empty()) continue;
    if (paint.rows.size() != rows)
      return fail(paint.identity.name, "rows",
                  std::to_string(paint.rows.size()) + " rows of clusters where layout and levels ask for " +
                      std::to_string(rows),
                  "build all paints of a pack with the same layout");
    for (std::size_t row = 0; row < rows; ++row)
      if (auto ok = check_clusters(paint.rows[row], paint.identity.name, row_name(frame, row)); !ok) return ok;
  }
  return {};
}

/// The grid for all corners: their bounds and a quarter more on each side for extrapolation. L stops at 0, below which
/// there is no light, unless a corner is darker.
LabRange range_of(const std::vector<ClusteredPaint>& paints) {
  LabRange range{glm::vec3(0.0f), glm::vec3(0.0f)};
  bool any = false;
  for (const ClusteredPaint& paint : paints) {
    const Clusters black{{glm::vec3(0.0f), glm::vec3(0.0f), 1}};
    const std::vector<Clusters> plain{black};
    for (const Clusters& row : paint.rows.empty() ? plain : paint.rows) {
      for (const LabCuboid& cluster : row) {
        for (int axis = 0; axis < 3; ++axis) {
          range.lo[axis] = any ? std::min(range.lo[axis], cluster.lo[axis]) : cluster.lo[axis];
          range.hi[axis] = any ? std::max(range.hi[axis], cluster.hi[axis]) : cluster.hi[axis];
        }
        any = true;
      }
    }
  }
  const float darkest = std::min(range.lo.x, 0.0f);
  for (int axis = 0; axis < 3; ++axis) {
    const float margin = std::max(0.25f * (range.hi[axis] - range.lo[axis]), 0.5f);
    range.lo[axis] -= margin;
    range.hi[axis] += margin;
  }
  range.lo.x = std::max(range.lo.x, darkest);
  return range;
}

QuantisedCuboid quantise(const LabCuboid& cluster, const LabRange& range) {
  QuantisedCuboid out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<int>(axis);
    const double lo = range.lo[a];
    const double scale = 65535.0 / (static_cast<double>(range.hi[a]) - lo);
    const auto nearest = [&](double value) {
      return static_cast<std::uint16_t>(std::clamp((value - lo) * scale + 0.5, 0.0, 65535.0));
    };
    out.q[2 * axis] = nearest(cluster.lo[a]);
    out.q[2 * axis + 1] = nearest(cluster.hi[a]);
  }
  return out;
}

/// Counts scaled to sum to row_mass exactly: rounded down, what is left over goes one by one to the largest remainders
/// (ties to the first). row_mass is at least the number of texels, so that no cluster falls to 0.
std::vector<std::int64_t> scale_counts(const Clusters& clusters, std::uint32_t row_mass) {
  std::uint64_t total = 0;
  for (const LabCuboid& cluster : clusters) total += cluster.count;
  std::vector<std::int64_t> mass(clusters.size());
  std::vector<std::uint64_t> remainder(clusters.size());
  std::uint64_t left = row_mass;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    const std::uint64_t product = std::uint64_t{clusters[c].count} * row_mass;
    mass[c] = static_cast<std::int64_t>(product / total);
    remainder[c] = product % total;
    left -= product / total;
  }
  std::vector<std::size_t> order(clusters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t one, std::size_t two) { return remainder[one] > remainder[two]; });
  for (std::size_t i = 0; i < left; ++i) ++mass[order[i]];
  return mass;
}

/// Sum of both corners over the tuple's first `paints` clusters on one axis: 2 * paints * the middle, exact.
int corner_sum(const Row& row, const Tuple& tuple, std::size_t paints, std::size_t axis) {
  int sum = 0;
  for (std::size_t k = 0; k < paints; ++k) {
    const QuantisedCuboid& cuboid = row.clusters[k][tuple.cluster[k]];
    sum += cuboid.q[2 * axis] + cuboid.q[2 * axis + 1];
  }
  return sum;
}

/// Middle in Lab of a tuple's box at equal weights of its first `paints` clusters. Equal clusters give equal bits.
glm::dvec3 middle(const Row& row, const Tuple& tuple, std::size_t paints, const LabRange& range) {
  glm::dvec3 centre;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<int>(axis);
    const double grid = corner_sum(row, tuple, paints, axis) / (2.0 * static_cast<double>(paints));
    const double lo = range.lo[a];
    centre[a] = lo + (static_cast<double>(range.hi[a]) - lo) * grid / 65535.0;
  }
  return centre;
}

/// Transports the clusters of paint `k` onto the tuples of the paints before it.
Result<void> add_paint(Row& row, std::size_t k, const std::vector<std::int64_t>& target_mass, const LabRange& range) {
  std::vector<glm::dvec3> source_centres, target_centres;
  std::vector<std::int64_t> source_mass;
  for (const Tuple& tuple : row.tuples) {
    source_centres.push_back(middle(row, tuple, k, range));
    source_mass.push_back(tuple.mass);
  }
  Row alone;  // the paint's clusters, so that the same arithmetic gives their middles
  alone.clusters[0] = row.clusters[k];
  for (std::size_t c = 0; c < row.clusters[k].size(); ++c)
    target_centres.push_back(middle(alone, Tuple{{static_cast<std::uint8_t>(c)}, 0}, 1, range));

  auto plan = solve_transport(source_centres, source_mass, target_centres, target_mass);
  if (!plan) return tl::unexpected(plan.error());
  std::vector<Tuple> tuples;
  tuples.reserve(plan->entries.size());
  for (const PlanEntry& entry : plan->entries) {
    tuples.push_back(row.tuples[entry.source]);
    tuples.back().cluster[k] = static_cast<std::uint8_t>(entry.target);
    tuples.back().mass = entry.mass;
  }
  row.tuples = std::move(tuples);
  return {};
}

Result<Row> build_row(const std::vector<ClusteredPaint>& paints, std::size_t index, const LabRange& range,
                      std::uint32_t row_mass) {
  const Clusters black{{glm::vec3(0.0f), glm::vec3(0.0f), 1}};
  Row row;
  for (std::size_t k = 0; k < paints.size(); ++k) {
    const Clusters& clusters = paints[k].rows.empty() ? black : paints[k].rows[index];
    for (const LabCuboid& cluster : clusters) row.clusters[k].push_back(quantise(cluster, range));
    const std::vector<std::int64_t> mass = scale_counts(clusters, row_mass);
    if (k > 0) {
      if (auto ok = add_paint(row, k, mass, range); !ok) return tl::unexpected(ok.error());
      continue;
    }
    for (std::size_t c = 0; c < mass.size(); ++c) row.tuples.push_back({{static_cast<std::uint8_t>(c)}, mass[c]});
  }
  if (row.tuples.size() > max_tuples_per_row)
    return fail({}, {}, std::to_string(row.tuples.size()) + " tuples are more than the 256 a row may have",
                "cluster with fewer");
  std::vector<std::pair<int, Tuple>> sorted;
  for (const Tuple& tuple : row.tuples) sorted.emplace_back(corner_sum(row, tuple, paints.size(), 0), tuple);
  std::sort(sorted.begin(), sorted.end(), [](const auto& one, const auto& two) {
    return one.first != two.first ? one.first < two.first : one.second.cluster < two.second.cluster;
  });
  for (std::size_t t = 0; t < sorted.size(); ++t) row.tuples[t] = sorted[t].second;
  return row;
}

/// Runs `build` for each row on `threads` threads, the calling one included.
template <class Build>
void for_each_row(std::size_t rows, int threads, const std::function<void(double)>& progress, Build build) {
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  const auto work = [&](bool reports) {
    for (std::size_t row = next++; row < rows; row = next++) {
      build(row);
      const std::size_t finished = ++done;
      if (reports && progress && finished < rows) progress(static_cast<double>(finished) / static_cast<double>(rows));
    }
  };
  std::vector<std::thread> others;
  const std::size_t helpers = std::min(static_cast<std::size_t>(threads), std::max<std::size_t>(rows, 1)) - 1;
  for (std::size_t t = 0; t < helpers; ++t) others.emplace_back(work, false);
  work(true);
  for (std::thread& other : others) other.join();
  if (progress) progress(1.0);
}

/// At least the texels of every row (so that no cluster is lost), else the smallest such number: masses are counts.
std::uint32_t common_mass(const std::vector<ClusteredPaint>& paints) {
  std::uint64_t most = 1;
  for (const ClusteredPaint& paint : paints) {
    for (const Clusters& row : paint.rows) {
      std::uint64_t total = 0;
      for (const LabCuboid& cluster : row) total += cluster.count;
      most = std::max(most, total);
    }
  }
  return static_cast<std::uint32_t>(most);
}

}  // namespace

Result<InterpolatableData> build_interpolatable(const std::vector<ClusteredPaint>& paints, const FlakeFrame& frame,
                                                int threads, const std::function<void(double)>& progress) {
  if (auto ok = check_input(paints, frame, threads); !ok) return tl::unexpected(ok.error());
  const bool any_flakes =
      std::any_of(paints.begin(), paints.end(), [](const ClusteredPaint& paint) { return !paint.rows.empty(); });
  InterpolatableData data;
  data.frame = frame;
  if (!any_flakes) data.frame = {{}, 0, frame.texel_mm, frame.level0_texels, frame.random_seed};
  data.range = range_of(paints);
  data.row_mass = common_mass(paints);

  const std::size_t row_count =
      std::size_t{data.frame.level_count} * static_cast<std::size_t>(data.frame.layout.slice_count());
  std::vector<std::optional<Result<Row>>> rows(row_count);
  for_each_row(row_count, threads, progress,
               [&](std::size_t row) { rows[row] = build_row(paints, row, data.range, data.row_mass); });

  data.tuple_begin.push_back(0);
  for (const ClusteredPaint& paint : paints)
    data.parts.push_back({paint.identity, paint.analytic, {0}, {}, {}, paint.life});
  for (std::size_t index = 0; index < row_count; ++index) {
    if (!*rows[index]) {
      Error error = rows[index]->error();
      error.field = row_name(frame, index) + (error.field.empty() ? "" : ", " + error.field);
      return tl::unexpected(error);
    }
    const Row& row = **rows[index];
    for (const Tuple& tuple : row.tuples) data.mass.push_back(static_cast<std::uint32_t>(tuple.mass));
    data.tuple_begin.push_back(static_cast<std::uint32_t>(data.mass.size()));
    for (std::size_t k = 0; k < paints.size(); ++k) {
      InterpolatableData::Part& part = data.parts[k];
      part.clusters.insert(part.clusters.end(), row.clusters[k].begin(), row.clusters[k].end());
      part.cluster_begin.push_back(static_cast<std::uint32_t>(part.clusters.size()));
      for (const Tuple& tuple : row.tuples) part.tuple_cluster.push_back(tuple.cluster[k]);
    }
  }
  return data;
}

InterpolatablePaint InterpolatableData::view() const {
  InterpolatablePaint paint;
  for (const Part& part : parts)
    paint.paints.push_back(
        {part.identity, part.analytic, part.cluster_begin, part.clusters, part.tuple_cluster, part.life});
  paint.layout = frame.layout;
  paint.level_count = frame.level_count;
  paint.texel_mm = frame.texel_mm;
  paint.level0_texels = frame.level0_texels;
  paint.range = range;
  paint.tuple_begin = tuple_begin;
  paint.mass = mass;
  paint.row_mass = row_mass;
  paint.random_seed = frame.random_seed;
  return paint;
}

}  // namespace lackwerk::core
