// Renderer::explain: what was left out of a picture, and why.
#include <algorithm>

#include "render_gles/renderer.hpp"

namespace lackwerk::gles {

std::vector<std::string> Renderer::explain() const {
  std::vector<std::string> out = context_.info().lines();
  if (paint_) {
    for (std::string& line : paint_->explain()) out.push_back(std::move(line));
  } else {
    out.emplace_back("left out: paint: no pack is loaded");
  }
  for (const auto kind : {packs::SurfaceKind::paint, packs::SurfaceKind::glass, packs::SurfaceKind::floor})
    if (!mesh_.has(kind))
      out.push_back(std::string("left out: ") + surface_name(kind) + ": the scene has no such part");
  if (drawn_) {
    const Lighting& lighting = drawn_->lighting;
    if (lighting.stripes) {
      out.emplace_back("left out: paint shading: stripe reflections are switched on");
    } else {
      if (!lighting.studio) out.emplace_back("left out: studio: switched off");
      if (lighting.lights.empty()) out.emplace_back("left out: directional lights: none is set");
      if (lighting.flakes == FlakeMode::off) out.emplace_back("left out: flakes and their mean: switched off");
      if (lighting.flakes == FlakeMode::mean) out.emplace_back("left out: single flakes: only their mean is asked for");
      if (lighting.flakes == FlakeMode::nearest)
        out.emplace_back("left out: blending between angle slices: the nearest slice is asked for");
      const int wanted = static_cast<int>(lighting.lights.size());
      const int lights = std::min(wanted, usable_lights(context_.info()));
      if (lights < wanted)
        out.push_back("left out: " + std::to_string(wanted - lights) + " of " + std::to_string(wanted) +
                      " lights: the driver has too few fragment uniform vectors");
      if (lighting.flake_lights < lights && lighting.flakes > FlakeMode::mean)
        out.push_back("left out: single flakes of " + std::to_string(lights - lighting.flake_lights) + " of " +
                      std::to_string(lights) + " lights: their mean is drawn");
    }
    if (!lighting.dither) out.emplace_back("left out: dither: switched off");
  }
  for (std::string& line : programs_.lines()) out.push_back(std::move(line));
  out.push_back("programs: " + std::to_string(programs_.size()) + ", draws: " + std::to_string(draws_) +
                ", paint uploads: " + std::to_string(uploads().uploads) + " (" + std::to_string(uploads().bytes) +
                " bytes), geometry: " + std::to_string(mesh_.bytes()) + " bytes");
  return out;
}

}  // namespace lackwerk::gles
