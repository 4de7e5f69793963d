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
#include "packs/tools/model_reader.hpp"

namespace lackwerk::packs {

/// 1280 x 720 has 0.9 million pixels: more triangles than `kept_triangles` show nothing, and at 34 bytes a vertex and 6
/// a triangle they take 23 MB of a weak machine's memory.
inline constexpr std::size_t usual_kept_triangles = 1'000'000;

struct ImportSettings {
  std::string paint;                                       ///< material that is painted; required
  std::vector<std::pair<std::string, SurfaceKind>> kinds;  ///< what other materials are, by name
  PlacementWish placement;                                 ///< in_metres and up_is_y are set by the format
  bool floor = true;                                       ///< a showroom floor under it
  double crease_deg = 40.0;                                ///< sharper edges stay sharp where normals are made
  ModelLimits limits;                                      ///< larger models are refused
  std::size_t kept_triangles = usual_kept_triangles;       ///< larger models are simplified, and that is said
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
