// Which of our surfaces a model's material names mean.
//
// Why it exists: models come with names like "Windshield_Glass" and no agreed meaning. One name is the paint, because
// the user says so; the others are sorted by their words unless the user says better. Pure functions; any thread.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "packs/scene.hpp"

namespace lackwerk::packs {

/// What the command line calls a kind: paint, glass, chrome, rubber, trim, rim, lamp_clear, lamp_red, interior, floor.
[[nodiscard]] std::string_view name_of(SurfaceKind kind);

/// By name; a usage error that lists the names otherwise. `floor` is refused: the floor is added, not imported.
[[nodiscard]] Result<SurfaceKind> importable_kind(std::string_view name);

/// By the words in a material's name; trim where none is known.
[[nodiscard]] SurfaceKind kind_by_name(std::string_view material);

/// The kind of each of `names`. `paint` is one of them, whatever the case, or a part of exactly one. `chosen` pairs
/// name a material each, whatever the case. Errors list the names there are.
[[nodiscard]] Result<std::vector<SurfaceKind>> assign_kinds(
    const std::vector<std::string>& names, const std::string& paint,
    const std::vector<std::pair<std::string, SurfaceKind>>& chosen, const std::string& file);

}  // namespace lackwerk::packs
