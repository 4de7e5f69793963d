// Renderer::explain: what was left out of a picture, and why.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "render_gles/renderer.hpp"

namespace lackwerk::gles {
namespace {

std::string short_number(double value, int digits = 1) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

}  // namespace

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
      if (lighting.quality.path == LightPath::none) out.emplace_back("left out: environment: switched off");
      if (paint_ && paint_->has_flakes() && !context_.info().fragment_highp) {
        out.emplace_back(
            "left out: single flakes: the driver's fragment shaders have 16-bit floats; their mean is drawn");
      } else if (left_out_flakes_ && paint_ && paint_->has_flakes()) {
        out.push_back("left out: single flakes: from here a pixel covers so many that their sum varies by less than " +
                      short_number(100.0 * moving_contrast) + " % (mip level " +
                      short_number(paint_->calm_level(moving_contrast)) + " and above)");
      }
      if (lighting.quality.path == LightPath::lights) {
        const std::vector<core::EnvironmentLight> cut = core::lights_of(environment_, lighting.quality.cut_lights);
        const double parts = effective_parts(cut);
        out.push_back("environment: " + std::to_string(cut.size()) + " lights, worth " + short_number(parts) +
                      " even parts of the sphere; what is sharper than m = " +
                      short_number(std::sqrt(share_border / parts), 2) + " is looked up instead");
      }
      if (lighting.orange_peel_mrad > 0.0f && !context_.info().fragment_highp)
        out.emplace_back("left out: orange peel: the driver's fragment shaders have 16-bit floats");
      if (lighting.lights.empty()) out.emplace_back("left out: directional lights: none is set");
      if (lighting.quality.flakes == FlakeMode::off) out.emplace_back("left out: flakes and their mean: switched off");
      if (lighting.quality.flakes == FlakeMode::mean)
        out.emplace_back("left out: single flakes: only their mean is asked for");
      if (lighting.quality.flakes == FlakeMode::nearest)
        out.emplace_back("left out: blending between angle slices: the nearest slice is asked for");
      const int wanted = static_cast<int>(lighting.lights.size());
      const int lights = std::min(wanted, usable_lights(context_.info()));
      if (lights < wanted)
        out.push_back("left out: " + std::to_string(wanted - lights) + " of " + std::to_string(wanted) +
                      " lights: the driver has too few fragment uniform vectors");
      const int glints = std::min(lighting.quality.sparkle_lights, static_cast<int>(sparkle_.size()));
      const int shown = std::min(glints, usable_sparkle_lights(context_.info(), lights));
      if (shown < glints && lighting.quality.path == LightPath::filtered && !left_out_flakes_)
        out.push_back("left out: single flakes of " + std::to_string(glints - shown) + " of " + std::to_string(glints) +
                      " lights of the environment: the driver has too few fragment uniform vectors");
      if (lighting.quality.flake_lights < lights && lighting.quality.flakes > FlakeMode::mean)
        out.push_back("left out: single flakes of " + std::to_string(lights - lighting.quality.flake_lights) + " of " +
                      std::to_string(lights) + " lights: their mean is drawn");
    }
    if (paint_ && paint_->has_flakes() && !lighting.stripes)
      out.push_back("flakes: the nearest paint is at mip level " +
                    short_number(finest_level(drawn_->view, drawn_->height)) + ", calm from level " +
                    short_number(paint_->calm_level(moving_contrast)) + " moving and " +
                    short_number(paint_->calm_level(still_contrast)) + " still");
    if (!lighting.dither) out.emplace_back("left out: dither: switched off");
  }
  for (std::string& line : programs_.lines()) out.push_back(std::move(line));
  out.push_back("programs: " + std::to_string(programs_.size()) + ", draws: " + std::to_string(draws_) +
                ", paint uploads: " + std::to_string(uploads().uploads) + " (" + std::to_string(uploads().bytes) +
                " bytes), geometry: " + std::to_string(mesh_.bytes()) + " bytes");
  return out;
}

}  // namespace lackwerk::gles
