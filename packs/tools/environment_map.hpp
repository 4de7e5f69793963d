// HDR maps from files.
//
// Why it exists: customers bring their own showroom as a lat-long picture. Here it is read, checked and mended before
// anything is computed from it. Pure functions of the file; any thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/analysis/environment_build.hpp"
#include "core/analysis/environment_latlong.hpp"
#include "core/environment.hpp"
#include "core/error.hpp"

namespace lackwerk::packs {

/// A mended map, and one sentence for each thing that had to be mended (empty = nothing).
struct EnvironmentMap {
  core::LatLongMap map;  ///< its name is the file's, without folder and ending
  std::vector<std::string> repairs;
};

/// Reads a lat-long picture with linear radiances (.hdr or .exr): 1 to 4 channels (one or two: grey, alpha is ignored),
/// at most 16384 pixels wide. Conventions: core::LatLongMap. Fails with file, field and remedy.
[[nodiscard]] Result<EnvironmentMap> read_environment_map(const std::filesystem::path& path);

struct LoadedEnvironment {
  core::Environment environment;
  std::vector<std::string> repairs;
};

/// The same, made into an environment around `room`.
[[nodiscard]] Result<LoadedEnvironment> load_environment(const std::filesystem::path& path,
                                                         const core::EnvironmentRoom& room);

}  // namespace lackwerk::packs
