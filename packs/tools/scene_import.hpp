// Somebody else's car as a scene: any model file that Assimp reads.
//
// Why it exists: a dealer's own model can stand in the kiosk. Models in the wild are rarely whole; what can be mended
// is mended and said, what cannot is refused by name. The model is untrusted: sizes are bounded before memory is taken
// where the format allows it. Free function; one thread, no state.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "packs/scene.hpp"
#include "packs/tools/import_placement.hpp"

namespace lackwerk::packs {

inline constexpr std::uintmax_t max_model_bytes = std::uintmax_t{2} << 30;
inline constexpr std::size_t max_model_triangles = 10'000'000;

struct ImportSettings {
  std::string paint;                                       ///< material that is painted; required
  std::vector<std::pair<std::string, SurfaceKind>> kinds;  ///< what other materials are, by name
  PlacementWish placement;                                 ///< in_metres and up_is_y are set by the format
  bool floor = true;                                       ///< a showroom floor under it
  double crease_deg = 40.0;                                ///< sharper edges stay sharp where normals are made
};

struct ImportedMaterial {
  std::string name;
  SurfaceKind kind;
};
struct ImportedScene {
  Scene scene;  ///< both levels of detail, cameras; neither lit nor baked
  std::vector<ImportedMaterial> materials;
  std::string placement;             ///< what its axes and unit were taken for
  std::vector<std::string> repairs;  ///< what was mended or left out, one sentence each
};

/// Called with the share done, [0, 1], and what is going on.
using ImportProgress = std::function<void(double, const std::string&)>;

/// Errors name the file: not there, too large, not readable, no faces, numbers that are not finite, no such material,
/// no unit that makes a car of it.
[[nodiscard]] Result<ImportedScene> import_scene(const std::filesystem::path& path, const ImportSettings& settings,
                                                 const ImportProgress& progress = {});

}  // namespace lackwerk::packs
