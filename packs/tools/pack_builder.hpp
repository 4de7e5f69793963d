// From captures to a paint pack: statistics of every slice and mip level, then transport between the paints.
//
// Why it exists: everything heavy happens once, here, so that the kiosk only blends corners. Functions over values; the
// threads they use end with the call, and the result is the same bytes for any number of them. Call from any thread.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "core/analysis/flake_clusters.hpp"
#include "core/analysis/interpolation.hpp"
#include "core/error.hpp"
#include "packs/paint_pack.hpp"
#include "packs/tools/capture.hpp"

namespace lackwerk::packs {

struct PackBuildSettings {
  std::string id = "paints";      ///< see PackInfo::id
  std::uint64_t serial = 1;       ///< see PackInfo::serial
  std::uint64_t random_seed = 1;  ///< of the random textures
  int threads = 0;                ///< [1, 64]; 0 = as many as the machine has
  bool keep_all_slices = false;   ///< also those that no light can reach below the paints' coats
  core::ClusterSettings clusters;
};

/// Called from the calling thread with the fraction done, rising to 1, and what is being done.
using PackProgress = std::function<void(double fraction, std::string_view stage)>;

/// A pack in memory. contents() points into it: valid while it lives unchanged.
struct BuiltPack {
  PackInfo info;
  int captured_slices = 0;  ///< of each capture; the pack has data.frame.layout's
  std::string beyond_stop;  ///< why the limit of extrapolation lies where it does: core::Beyond::stop
  core::InterpolatableData data;
  [[nodiscard]] PackContents contents() const { return {info, data.view()}; }
};

/// Builds from 1 to 5 captures. Captures with flakes must share layout, edge_texels and texel_mm; captures without mix
/// with them as black flakes. Random cells are fitted to each capture's angular life (flake_life.hpp). Stored with each
/// paint: upper bounds of the 1-Wasserstein distance (Lab) between level-0 texels and their clusters, before the 16-bit
/// grid (which moves corners by half a step of the range); and how far the paint is from what its capture holds as
/// measured (capture_error.hpp). Errors name the captures (by paint name) and the field that
/// differs, or a slice of wrong size or with a texel that is not finite.
[[nodiscard]] Result<BuiltPack> build_pack(std::span<const Capture> captures, const PackBuildSettings& settings,
                                           const PackProgress& progress = {});

/// The same from capture folders, holding at most two captures in memory at a time (one is read while another is
/// analysed). Errors also those of read_capture; captures are named by folder.
[[nodiscard]] Result<BuiltPack> build_pack_from_folders(std::span<const std::filesystem::path> folders,
                                                        const PackBuildSettings& settings,
                                                        const PackProgress& progress = {});

}  // namespace lackwerk::packs
