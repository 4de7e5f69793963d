#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/colour.hpp"
#include "core/paint_model.hpp"
#include "core/paint_textures.hpp"
#include "core/realise.hpp"
#include "kiosk/tools/find_recipe.hpp"
#include "kiosk/tools/report/flake_knobs.hpp"
#include "kiosk/tools/report/flake_knobs_slices.hpp"
#include "packs/tools/virtual_goniometer.hpp"

namespace lackwerk::report {

namespace {

/// The model's own functions, put together in three ways. Angles in bins, level 0.
struct TapModel : core::PaintModel<float> {
  enum class Taps : std::uint8_t { nearest, shared, decorrelated };

  [[nodiscard]] vec3 nearest(vec2 at, vec2 texel) const { return self().flake_nearest(at.x, at.y, texel, 0.0f); }
  [[nodiscard]] vec3 shared(vec2 at, vec2 texel) const { return self().flake_level(at.x, at.y, texel, 0.0f); }
  /// Bilinear, but each slice draws with a random number of its own: that of a texel far away.
  [[nodiscard]] vec3 decorrelated(vec2 at, vec2 texel) const {
    TapModel& model = self();
    vec3 sum(0.0f);
    const vec2 base = floor(at);
    for (int tap = 0; tap < 4; ++tap) {
      const vec2 corner(static_cast<float>(tap & 1), static_cast<float>(tap >> 1));
      const vec2 other = floor(texel) + vec2(61.0f, 97.0f) * static_cast<float>(tap);
      const vec2 part = at - base;
      const float weight = (corner.x > 0.5f ? part.x : 1.0f - part.x) * (corner.y > 0.5f ? part.y : 1.0f - part.y);
      if (weight <= 0.0f) continue;
      const vec4 random = model.flake_random(other, 0.0f, at.x, at.y);
      sum += model.flake_tap(base.x + corner.x, base.y + corner.y, 0.0f, random) * weight;
    }
    return sum;
  }
  [[nodiscard]] vec3 draw(Taps taps, vec2 at, vec2 texel) const {
    if (taps == Taps::nearest) return nearest(at, texel);
    return taps == Taps::shared ? shared(at, texel) : decorrelated(at, texel);
  }

 private:
  /// The shader's text knows no const.
  [[nodiscard]] TapModel& self() const { return const_cast<TapModel&>(*this); }
};
using Taps = TapModel::Taps;

/// Of one picture: what the eye is given.
struct Distribution {
  std::vector<float> lightness;  ///< sorted
  double contrast = 0.0;         ///< standard deviation of luminance over its mean
};

Distribution distribution_of(const std::vector<glm::vec3>& linear) {
  Distribution out;
  out.lightness.reserve(linear.size());
  double sum = 0.0, squares = 0.0;
  for (const glm::vec3& rgb : linear) {
    const auto& weight = core::rgb_to_xyz[1];
    const double y = weight[0] * static_cast<double>(rgb.x) + weight[1] * static_cast<double>(rgb.y) +
                     weight[2] * static_cast<double>(rgb.z);
    sum += y;
    squares += y * y;
    out.lightness.push_back(static_cast<float>(116.0 * core::lab_forward(y) - 16.0));
  }
  std::sort(out.lightness.begin(), out.lightness.end());
  const double n = static_cast<double>(linear.size());
  const double mean = sum / n;
  if (mean > 0.0) out.contrast = std::sqrt(std::max(squares / n - mean * mean, 0.0)) / mean;
  return out;
}

/// The exact 1-Wasserstein distance on the line: both have as many texels.
double distance(const Distribution& one, const Distribution& two) {
  double sum = 0.0;
  for (std::size_t k = 0; k < one.lightness.size(); ++k)
    sum += std::abs(static_cast<double>(one.lightness[k]) - static_cast<double>(two.lightness[k]));
  return sum / static_cast<double>(one.lightness.size());
}

/// Half-bin angles, in bins of theta_h and theta_i; the last two are left out by quick reports.
constexpr std::array<std::array<float, 2>, 6> half_bins = {
    {{0.5f, 0.0f}, {0.5f, 0.5f}, {1.5f, 1.5f}, {0.5f, 4.5f}, {2.5f, 0.5f}, {1.5f, 3.5f}}};

/// The workbench's paints, by recipe, in the order of its captures.
constexpr std::array<const char*, 3> recipe_names = {"gu_polaris_silber_coated", "gu_ford_f8_coated",
                                                     "pearl_green_violet"};

/// What the paint's own flakes show at the half-bin angles. `seed` 1 is the capture's sample.
Result<std::vector<Distribution>> truth(const Workbench& bench, const char* name, double bin_rad, std::size_t angles,
                                        std::uint64_t seed) {
  const auto recipe = packs::read_recipe(tools::find_recipe(name));
  if (!recipe) return tl::unexpected(recipe.error());
  packs::GoniometerSettings settings;
  settings.edge_texels = bench.edge_texels();
  settings.seed = seed;
  std::vector<packs::PictureAngles> places;
  for (std::size_t k = 0; k < angles; ++k)
    places.push_back({static_cast<double>(half_bins[k][0]) * bin_rad, static_cast<double>(half_bins[k][1]) * bin_rad});
  const auto pictures = packs::photographs(*recipe, settings, places);
  if (!pictures) return tl::unexpected(pictures.error());
  std::vector<Distribution> out;
  out.reserve(angles);
  for (const packs::FlakeSlice& picture : *pictures) out.push_back(distribution_of(picture.texels));
  return out;
}

std::vector<glm::vec3> picture(const TapModel& model, Taps taps, const std::array<float, 2>& at, std::uint32_t edge) {
  std::vector<glm::vec3> out;
  out.reserve(std::size_t{edge} * edge);
  for (std::uint32_t y = 0; y < edge; ++y)
    for (std::uint32_t x = 0; x < edge; ++x)
      out.push_back(model.draw(taps, {at[0], at[1]}, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}));
  return out;
}

/// Errors and contrasts of one setting over paints and angles.
struct Way {
  const char* label;
  const char* line;
  Taps taps;
  std::vector<double> errors;
  double contrast_ratio = 0.0;
};

void compare(Way& way, const Distribution& shown, const Distribution& source) {
  way.errors.push_back(distance(shown, source));
  if (source.contrast > 0.0) way.contrast_ratio += shown.contrast / source.contrast;
}

}  // namespace

Result<void> add_flake_angles(Workbench& bench, Findings& findings) {
  const auto pack = bench.pack();
  if (!pack) return tl::unexpected(pack.error());
  const core::InterpolatablePaint paint = (*pack)->data.view();
  const std::size_t angles = bench.choose(half_bins.size(), half_bins.size() - 2);
  std::array<Way, 4> ways = {{{"nearest", "one slice", Taps::nearest, {}, 0.0},
                              {"bilinear", "four slices", Taps::shared, {}, 0.0},
                              {"bilinear, decorrelated", "four slices", Taps::decorrelated, {}, 0.0},
                              {"another sample", "the source itself", Taps::nearest, {}, 0.0}}};
  std::array<Timing, 3> times;
  for (std::size_t k = 0; k < paint.paints.size(); ++k) {
    const double bin = paint.layout.bin_width_rad();
    const auto source = truth(bench, recipe_names[k], bin, angles, 1);
    if (!source) return tl::unexpected(source.error());
    const auto other = truth(bench, recipe_names[k], bin, angles, 2);
    if (!other) return tl::unexpected(other.error());
    std::vector<double> weights(paint.paints.size(), 0.0);
    weights[k] = 1.0;
    core::RealisedPaint realised;
    core::realise(paint, core::Weights::uniform(weights), realised);
    core::PaintTextures textures = core::make_static_textures(paint);
    const core::AnalyticPaint analytic = realised.analytic;
    core::update_textures(paint, realised, textures);
    TapModel model;
    core::bind_model(paint, analytic, textures, model);
    for (std::size_t angle = 0; angle < angles; ++angle) {
      for (std::size_t w = 0; w < 3; ++w)
        compare(ways[w], distribution_of(picture(model, ways[w].taps, half_bins[angle], bench.edge_texels())),
                (*source)[angle]);
      compare(ways[3], (*other)[angle], (*source)[angle]);
    }
    if (k > 0) continue;
    for (std::size_t w = 0; w < 3; ++w) {
      std::size_t texels = 0;
      times[w] = bench.time([&] { texels += picture(model, ways[w].taps, half_bins[1], 256).size(); }, 200.0, 3, 20);
      if (texels == 0) times[w] = {};
    }
  }

  Knob knob;
  knob.id = "angle_taps";
  knob.title = "Slices blended between angle bins";
  knob.what = "Flakes at " + std::to_string(angles) +
              " half-bin angles of three paints, from the pack's slices, against photographs of the same flakes "
              "taken there by the virtual goniometer.";
  knob.error_unit = "1-Wasserstein distance of texels' lightness, L";
  knob.time_of = "65,536 texels at level 0 on the CPU, float";
  knob.chosen = "bilinear";
  for (std::size_t w = 0; w < ways.size(); ++w) {
    Setting one;
    one.label = ways[w].label;
    one.line = ways[w].line;
    const double count = static_cast<double>(ways[w].errors.size());
    one.note = "sparkle contrast " + digits(ways[w].contrast_ratio / count) + " of the source's";
    set_errors(one, std::move(ways[w].errors));
    if (w < times.size()) {
      one.time = times[w];
    } else {
      one.eligible = false;
      one.note += "; the same recipe's flakes drawn anew: what chance alone makes of the distance";
    }
    knob.settings.push_back(std::move(one));
  }
  const auto& found = knob.settings;
  knob.why = "Four slices at one rank are " + digits(found[1].error) + " L from the source, the nearest slice alone " +
             digits(found[0].error) + " at " + digits(found[0].time.median_ms / found[1].time.median_ms) +
             " of the time; with a random number for each slice " + digits(found[2].error) +
             ". Another sample of the " + "same flakes is " + digits(found[3].error) + " away.";
  findings.knobs.push_back(std::move(knob));
  return {};
}

}  // namespace lackwerk::report
