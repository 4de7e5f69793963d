// From scans of one plant at several times to the paths its points take between them.
//
// Why it exists: everything heavy happens once, here, so that the kiosk only moves points along straight lines (Golla
// 2021, chapter 4). Functions over values; threads end with the call, and the result is the same bytes for any number
// of them. Call from any thread.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/analysis/cloud_align.hpp"
#include "core/analysis/cloud_morph.hpp"
#include "core/analysis/point_cloud.hpp"
#include "core/error.hpp"

namespace lackwerk::packs {

/// One scan as it was read.
struct ScanSource {
  std::string name;   ///< for messages and the pack: the file's name
  double time = 0.0;  ///< in any unit; ascending over the series
  core::PointCloud cloud;
};

struct ScanSettings {
  bool clean = true;  ///< take stray points away
  core::CloudCleaning cleaning;
  /// Edge of the cubes that keep one point each, in units of the scans. 0: the widest of the scans' own spacings, so
  /// that all have the same; below 0: points stay as they are.
  double spacing = 0.0;
  bool align = true;  ///< carry every scan to the one before it
  core::AlignOptions alignment;
  bool segment = true;       ///< false: one segment a scan (GT Figure 4.3, for comparison)
  bool by_label = true;      ///< where every scan has labels, they are the segments; else they are found
  bool labels_agree = true;  ///< false: labels say the parts, but not which is which in the next scan (GT's case 3)
  core::SegmentOptions segments;  ///< its skeleton_spacing 0: six spacings
  core::MatchOptions matching;    ///< its by_label follows what is above
  core::CloudTransportOptions transport;
  int threads = 0;  ///< [1, 64]; 0 = as many as the machine has
};

/// A scan ready to be morphed.
struct PreparedScan {
  std::string name;
  double time = 0.0;
  core::PointCloud cloud;  ///< cleaned, even, carried to its predecessor
  core::CloudSegments tree;
  std::size_t read = 0, strays = 0;  ///< points of the file; points taken away as strays
  core::Alignment alignment;         ///< of this scan to its predecessor; nothing for the first
};

struct ScanSeries {
  double spacing = 0.0;   ///< 0: as the points were
  bool labelled = false;  ///< segments are labels
  std::vector<PreparedScan> scans;
  std::vector<core::CloudMorph> steps;                                        ///< one less than scans
  double prepare_s = 0.0, segment_s = 0.0, match_s = 0.0, transport_s = 0.0;  ///< where the time went
};

/// Called from the calling thread with the fraction done, rising to 1, and what is being done.
using ScanProgress = std::function<void(double fraction, std::string_view stage)>;

/// Cleaned, resampled, aligned. Errors name the scan: no points left, one not finite, times that do not ascend, a
/// spacing of no use, fewer than two scans.
[[nodiscard]] Result<ScanSeries> prepare_scans(std::span<const ScanSource> sources, const ScanSettings& settings,
                                               const ScanProgress& progress = {});

/// prepare_scans, then segments, matches and paths between each scan and the next.
[[nodiscard]] Result<ScanSeries> morph_series(std::span<const ScanSource> sources, const ScanSettings& settings,
                                              const ScanProgress& progress = {});

/// Segments, matches and paths of a series that is prepared (again, where it had some). `to_stage`: where in the
/// progress this begins.
[[nodiscard]] Result<void> morph_prepared(ScanSeries& series, const ScanSettings& settings,
                                          const ScanProgress& progress = {}, double begin = 0.0);

}  // namespace lackwerk::packs
