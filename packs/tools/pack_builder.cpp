#include "packs/tools/pack_builder.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <future>
#include <glm/geometric.hpp>
#include <mutex>
#include <numbers>
#include <numeric>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "core/analysis/distribution_error.hpp"
#include "core/analysis/mip_chain.hpp"
#include "core/beyond.hpp"
#include "core/colour.hpp"
#include "packs/tools/capture_error.hpp"
#include "packs/tools/flake_life.hpp"

namespace lackwerk::packs {
namespace {

/// Clustering is nearly all of the work; transport gets the rest of the progress bar.
constexpr double clustering_share = 0.95;

/// Slices up to here decide on the random cells: as far as a life is measured (life_scan_h).
constexpr double life_reach_rad = 22.0 * std::numbers::pi / 180.0;

int thread_count(int wanted) {
  const int machine = static_cast<int>(std::thread::hardware_concurrency());
  return std::clamp(wanted > 0 ? wanted : machine, 1, 64);
}

/// Runs `work(k)` for k in [0, count) on `threads` threads, the calling one included, which also calls `done` with the
/// number finished. An exception (no memory) ends the rest and comes out here.
template <class Work, class Done>
void for_each_index(std::size_t count, int threads, const Work& work, const Done& done) {
  std::atomic<std::size_t> next{0}, finished{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto run = [&](bool reports) {
    try {
      for (std::size_t k = next++; k < count; k = next++) {
        work(k);
        const std::size_t now = ++finished;
        if (reports) done(now);
      }
    } catch (...) {
      next = count;
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (int t = 1; t < threads && static_cast<std::size_t>(t) < count; ++t) others.emplace_back(run, false);
    run(true);
  }
  if (failure) std::rethrow_exception(failure);
}

struct SliceStatistics {
  std::vector<std::vector<core::LabCuboid>> levels;
  double w1_lab = 0.0;
};

SliceStatistics analyse(const FlakeSlice& slice, std::uint32_t edge, const core::ClusterSettings& settings) {
  SliceStatistics out;
  std::vector<glm::vec3> lab;
  for (const core::MipLevel& level : core::mip_chain(slice.texels, edge)) {
    lab.resize(level.texels.size());
    std::transform(level.texels.begin(), level.texels.end(), lab.begin(),
                   [](const glm::vec3& rgb) { return core::lab_from_linear(rgb); });
    out.levels.push_back(core::cluster_texels(lab, settings));
    if (out.levels.size() == 1) out.w1_lab = core::wasserstein1_lab(lab, out.levels[0]);
  }
  return out;
}

Result<void> check_slices(const Capture& capture, const std::string& name) {
  const std::size_t texels = std::size_t{capture.edge_texels} * capture.edge_texels;
  if (texels == 0 || !(capture.texel_mm > 0.0f))
    return fail(name, "edge_texels", "slices have no size", "export the capture again");
  if (capture.slices.size() != static_cast<std::size_t>(capture.layout.slice_count()))
    return fail(name, "slices", "their number differs from the layout's", "export the capture again");
  for (std::size_t k = 0; k < capture.slices.size(); ++k) {
    const auto& image = capture.slices[k].texels;
    const bool finite = std::all_of(image.begin(), image.end(), [](const glm::vec3& t) {
      return std::isfinite(t.x) && std::isfinite(t.y) && std::isfinite(t.z);
    });
    if (image.size() != texels || !finite)
      return fail(name, "slice " + std::to_string(k), "has a wrong size or a texel that is not finite",
                  "export the capture again");
  }
  return {};
}

/// Takes captures one by one and keeps only their statistics.
class Builder {
 public:
  Builder(const PackBuildSettings& settings, std::size_t captures, const PackProgress& progress)
      : settings_(settings), threads_(thread_count(settings.threads)), captures_(captures), progress_(progress) {}

  Result<void> add(const Capture& capture, const std::string& name) {
    if (!capture.is_fitted)
      return fail(name, "fitted", "measured, but not fitted yet", "run \"lackwerk fit\" on it first");
    core::ClusteredPaint paint{capture.identity, capture.analytic, {}, {}};
    PaintError error;
    error.form = capture_error(capture);
    if (capture.layout.slice_count() > 0) {
      if (auto ok = check_frame(capture, name); !ok) return ok;
      if (auto ok = check_slices(capture, name); !ok) return ok;
      cluster(capture, paint, error);
    }
    paints_.push_back(std::move(paint));
    errors_.push_back(std::move(error));
    return {};
  }

  Result<BuiltPack> finish() {
    const int captured_slices = frame_.layout.slice_count();
    if (!settings_.keep_all_slices) drop_unreachable_slices();
    report(clustering_share, "transport");
    auto data = core::build_interpolatable(paints_, frame_, threads_, [this](double fraction) {
      report(clustering_share + (1.0 - clustering_share) * fraction, "transport");
    });
    if (!data) return tl::unexpected(data.error());
    BuiltPack out{{}, captured_slices, {}, std::move(*data)};
    out.info.id = settings_.id;
    out.info.serial = settings_.serial;
    out.info.errors = std::move(errors_);
    for (PaintError& error : out.info.errors)
      error.flake_w1_slice.resize(static_cast<std::size_t>(out.data.frame.layout.slice_count()), 0.0f);
    out.info.transport_cost = mean_distance(out.data);
    core::Beyond beyond = core::measure_beyond(out.data.view());
    out.info.beyond_limit = beyond.limit;
    out.beyond_stop = std::move(beyond.stop);
    return out;
  }

 private:
  void report(double fraction, std::string_view stage) const {
    if (progress_) progress_(fraction, stage);
  }

  /// The first capture with flakes sets the frame; the others must match it.
  Result<void> check_frame(const Capture& capture, const std::string& name) {
    if (frame_name_.empty()) {
      frame_name_ = name;
      frame_ = {capture.layout, static_cast<std::uint16_t>(core::mip_level_count(capture.edge_texels)),
                capture.texel_mm, capture.edge_texels, settings_.random_seed};
      return {};
    }
    const auto differs = [&](const char* field) {
      return fail(name, field, "differs from that of " + frame_name_, "capture both with the same settings");
    };
    if (capture.layout != frame_.layout) return differs("layout");
    if (capture.edge_texels != frame_.level0_texels) return differs("edge_texels");
    if (capture.texel_mm != frame_.texel_mm) return differs("texel_mm");
    return {};
  }

  /// A coat lets in only directions within its critical angle: with an index of 1.5, 31 of AxF's 67 slices, 44 with
  /// the neighbours they blend with. The paint that bends least decides, for a mix bends no less.
  void drop_unreachable_slices() {
    if (frame_.layout.slice_count() == 0) return;
    double index = 1e9;
    for (const core::ClusteredPaint& paint : paints_) index = std::min(index, paint.analytic.refraction_ior);
    const core::SliceLayout all = frame_.layout;
    frame_.layout = core::reachable_layout(all, index);
    std::vector<std::size_t> kept;
    kept.reserve(static_cast<std::size_t>(frame_.layout.slice_count()));
    for (int slice = 0; slice < frame_.layout.slice_count(); ++slice) {
      const auto node = frame_.layout.node_of(slice);
      kept.push_back(static_cast<std::size_t>(*all.slice_at(node.bin_h, node.bin_i)));
    }
    const auto before = static_cast<std::size_t>(all.slice_count());
    for (std::size_t k = 0; k < paints_.size(); ++k) {
      auto& rows = paints_[k].rows;
      if (rows.empty()) continue;
      std::vector<std::vector<core::LabCuboid>> fewer;
      fewer.reserve(frame_.level_count * kept.size());
      for (std::size_t level = 0; level < frame_.level_count; ++level)
        for (const std::size_t slice : kept) fewer.push_back(std::move(rows[level * before + slice]));
      rows = std::move(fewer);
      std::vector<float> errors;
      errors.reserve(kept.size());
      for (const std::size_t slice : kept) errors.push_back(errors_[k].flake_w1_slice[slice]);
      errors_[k].flake_w1_slice = std::move(errors);
      errors_[k].flake_w1_max = *std::max_element(errors_[k].flake_w1_slice.begin(), errors_[k].flake_w1_slice.end());
      errors_[k].flake_w1_mean =
          std::accumulate(errors_[k].flake_w1_slice.begin(), errors_[k].flake_w1_slice.end(), 0.0f) /
          static_cast<float>(kept.size());
    }
  }

  void cluster(const Capture& capture, core::ClusteredPaint& paint, PaintError& error) {
    std::vector<SliceStatistics> slices(capture.slices.size());
    const double share = clustering_share / static_cast<double>(captures_);
    const double before = share * static_cast<double>(paints_.size());
    for_each_index(
        slices.size(), threads_,
        [&](std::size_t k) { slices[k] = analyse(capture.slices[k], capture.edge_texels, settings_.clusters); },
        [&](std::size_t done) {
          report(before + share * static_cast<double>(done) / static_cast<double>(slices.size()),
                 capture.identity.name);
        });
    paint.life = fit(capture, slices);
    for (std::size_t level = 0; level < frame_.level_count; ++level)
      for (SliceStatistics& slice : slices) paint.rows.push_back(std::move(slice.levels[level]));
    double sum = 0.0, most = 0.0;
    for (const SliceStatistics& slice : slices) {
      error.flake_w1_slice.push_back(static_cast<float>(slice.w1_lab));
      sum += slice.w1_lab;
      most = std::max(most, slice.w1_lab);
    }
    error.flake_w1_mean = static_cast<float>(sum / static_cast<double>(slices.size()));
    error.flake_w1_max = static_cast<float>(most);
  }

  /// Random cells for this paint's life, by the distributions of the slices from the mirror angle on.
  static core::FlakeLife fit(const Capture& capture, const std::vector<SliceStatistics>& slices) {
    const KnownLife known = known_life(capture);
    std::vector<std::vector<core::LabCuboid>> bright;
    for (int bin_h = 0; bin_h * capture.layout.bin_width_rad() < life_reach_rad; ++bin_h)
      if (const auto slice = capture.layout.slice_at(bin_h, 0))
        bright.push_back(slices[static_cast<std::size_t>(*slice)].levels[0]);
    if (bright.empty()) return {};
    return core::fit_life(known.life.half_h_deg, known.life.half_i_deg, bright, known.origin);
  }

  /// Mean over rows and pairs of paints of how far apart in Lab the middles are that a tuple joins, by mass.
  static double mean_distance(const core::InterpolatableData& data) {
    const glm::dvec3 step = (glm::dvec3(data.range.hi) - glm::dvec3(data.range.lo)) / 65535.0;
    const auto middle = [&](const core::InterpolatableData::Part& part, std::size_t row, std::size_t tuple) {
      const auto& q = part.clusters[part.cluster_begin[row] + part.tuple_cluster[tuple]].q;
      return 0.5 * step * glm::dvec3(q[0] + q[1], q[2] + q[3], q[4] + q[5]);
    };
    const std::size_t rows = data.tuple_begin.size() - 1;
    double sum = 0.0;
    std::size_t pairs = 0;
    for (std::size_t j = 0; j < data.parts.size(); ++j)
      for (std::size_t k = j + 1; k < data.parts.size(); ++k, ++pairs)
        for (std::size_t row = 0; row < rows; ++row)
          for (std::size_t t = data.tuple_begin[row]; t < data.tuple_begin[row + 1]; ++t)
            sum += data.mass[t] * glm::distance(middle(data.parts[j], row, t), middle(data.parts[k], row, t));
    const double terms = static_cast<double>(pairs) * static_cast<double>(rows) * data.row_mass;
    return terms > 0.0 ? sum / terms : 0.0;
  }

  const PackBuildSettings& settings_;
  const int threads_;
  const std::size_t captures_;
  const PackProgress& progress_;
  core::FlakeFrame frame_;
  std::string frame_name_;  ///< the capture that set the frame
  std::vector<core::ClusteredPaint> paints_;
  std::vector<PaintError> errors_;
};

Result<void> check_settings(const PackBuildSettings& settings, std::size_t captures) {
  if (captures < 1 || captures > core::max_paints)
    return fail("", "captures", std::to_string(captures) + " given", "a pack is made from 1 to 5", ErrorKind::usage);
  if (settings.threads < 0 || settings.threads > 64)
    return fail("", "threads", std::to_string(settings.threads) + " is outside 0 to 64", "leave it out",
                ErrorKind::usage);
  if (settings.clusters.max_clusters < 1 || settings.clusters.max_clusters > core::max_clusters_per_row)
    return fail("", "max_clusters", std::to_string(settings.clusters.max_clusters) + " is outside 1 to 250",
                "leave it out", ErrorKind::usage);
  return {};
}

}  // namespace

Result<BuiltPack> build_pack(std::span<const Capture> captures, const PackBuildSettings& settings,
                             const PackProgress& progress) {
  if (auto ok = check_settings(settings, captures.size()); !ok) return tl::unexpected(ok.error());
  Builder builder(settings, captures.size(), progress);
  for (const Capture& capture : captures)
    if (auto ok = builder.add(capture, capture.identity.name); !ok) return tl::unexpected(ok.error());
  return builder.finish();
}

Result<BuiltPack> build_pack_from_folders(std::span<const std::filesystem::path> folders,
                                          const PackBuildSettings& settings, const PackProgress& progress) {
  if (auto ok = check_settings(settings, folders.size()); !ok) return tl::unexpected(ok.error());
  Builder builder(settings, folders.size(), progress);
  const auto read = [&](std::size_t k) {
    return std::async(std::launch::async, [path = folders[k]] { return read_capture(path); });
  };
  auto reading = read(0);
  for (std::size_t k = 0; k < folders.size(); ++k) {
    const Result<Capture> capture = reading.get();
    if (!capture) return tl::unexpected(capture.error());
    if (k + 1 < folders.size()) reading = read(k + 1);
    if (auto ok = builder.add(*capture, folders[k].string()); !ok) return tl::unexpected(ok.error());
  }
  return builder.finish();
}

}  // namespace lackwerk::packs
