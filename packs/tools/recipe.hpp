// Recipes: the small TOML files from which the virtual goniometer makes captures.
//
// Why it exists: published fits are a table of numbers; what the flakes and the coat add is ours and must say so. A
// recipe states the whole paint before any flake is split off. Values; any thread. Files are only read.
//
// Keys (docs/capture.md explains them with units): name, source, provenance, coat_provenance, coat_ior,
// refraction_ior, diffuse, [[lobe]] s m f0, [flakes] provenance share coverage diameter_um diameter_spread
// diameter_max_um, [film] resin_ior table_nodes layer; or base, replace_lobe, coat_ior to derive a coated paint.
#pragma once

#include <filesystem>
#include <optional>

#include "core/error.hpp"
#include "core/paint.hpp"

namespace lackwerk::packs {

/// How much of the broadest lobe is explicit mirrors, and what they are like.
struct FlakeRecipe {
  double share = 0.0;            ///< kappa: part of the lobe the flakes carry, (0, 1]
  double coverage = 0.0;         ///< footprint of all flakes / area of the paint, (0, 1]
  double diameter_um = 0.0;      ///< median by number of the log-normal law, [1, 200]
  double diameter_spread = 0.0;  ///< standard deviation of ln(diameter), [0, 1]
  double diameter_max_um = 0.0;  ///< larger ones are cut to this, [diameter_um, 500]
};

struct Recipe {
  core::PaintIdentity identity;
  core::AnalyticPaint analytic;  ///< the full paint: nothing is taken off for the flakes yet
  std::optional<FlakeRecipe> flakes;
};

/// Reads a recipe; `base` is looked for beside it and must not have a base itself. Errors name file, line and key; an
/// unknown key is answered with the nearest known one.
[[nodiscard]] Result<Recipe> read_recipe(const std::filesystem::path& file);

/// chi at an angle pair in radians, bilinear between nodes, theta_i clamped to pi/2 - theta_h. (1, 1, 1) without table.
[[nodiscard]] glm::dvec3 table_colour(const core::AnalyticPaint& paint, double theta_h, double theta_i);

}  // namespace lackwerk::packs
