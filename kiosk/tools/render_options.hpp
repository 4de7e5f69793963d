// What `render` and `look` share: texts from the command line into weights, scenes and backends.
//
// Why it exists: both commands must understand the same words. Pure functions apart from reading files; one thread.
#pragma once

#include <string>

#include "core/error.hpp"
#include "core/interpolatable_paint.hpp"
#include "packs/scene.hpp"
#include "render_gles/context.hpp"

namespace CLI {
class App;
}

namespace lackwerk::tools {

/// "0.2,0.3,0.5" to numbers. Error (usage): not numbers, or not `count` of them. `option` names the option.
[[nodiscard]] Result<std::vector<double>> parse_weights(const std::string& text, std::size_t count,
                                                        const std::string& option);

/// A scene pack's path, or one of the words builtin, sphere, capsule.
[[nodiscard]] Result<packs::Scene> load_scene(const std::string& name);

/// "egl" or "osmesa". Error (usage): anything else.
[[nodiscard]] Result<gles::Backend> parse_backend(const std::string& name);

/// Adds --orange-peel to a command that draws: see gles::Lighting::orange_peel_mrad.
void add_orange_peel_option(CLI::App& command, float& milliradians);

/// The camera of that name; empty: the first. Error (usage): names those there are.
[[nodiscard]] Result<packs::Camera> find_camera(const packs::Scene& scene, const std::string& name);

}  // namespace lackwerk::tools
