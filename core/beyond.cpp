#include "core/beyond.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/character.hpp"
#include "core/directional_albedo.hpp"
#include "core/level0_paint.hpp"

namespace lackwerk::core {
namespace {

constexpr int steps = 20;  // of most_beyond: 0.05
constexpr std::array<double, 3> albedo_angles_deg{0.0, 45.0, 75.0};
/// CIEDE2000 that is about as much as an eye can tell.
constexpr double just_seen = 1.0;
/// How exactly the albedo is known (directional_albedo.hpp).
constexpr double albedo_error = 0.01;

using Albedos = std::array<glm::dvec3, albedo_angles_deg.size()>;
using Colours = std::array<glm::dvec3, shop_angles_deg.size()>;

/// Sum over all terms of the paint at a viewing cosine, linear between the table's columns.
glm::dvec3 albedo_at(const AlbedoTable& table, double cosine) {
  const double at = std::clamp(std::sqrt(cosine) * albedo_columns - 0.5, 0.0, albedo_columns - 1.0);
  const auto low = std::min(static_cast<std::size_t>(at), std::size_t{albedo_columns - 2});
  const double part = at - static_cast<double>(low);
  glm::dvec3 sum(0.0);
  for (const AlbedoRow& row : table.rows)
    sum += glm::dvec3(row.albedo[low]) * (1.0 - part) + glm::dvec3(row.albedo[low + 1]) * part;
  return sum;
}

Albedos albedos(const InterpolatablePaint& near, const AnalyticPaint& analytic, const PaintTextures& textures) {
  AlbedoTable table;
  directional_albedo(near, analytic, textures, table);
  Albedos out{};
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = albedo_at(table, std::cos(albedo_angles_deg[k] * std::numbers::pi / 180.0));
  return out;
}

struct Mix {
  AnalyticPaint drawn;
  PaintTextures textures;
};
Mix mix_of(const InterpolatablePaint& near, const Weights& weights) {
  RealisedPaint realised;
  realise(near, weights, realised);
  Mix out;
  out.drawn = realised.analytic;
  out.textures = mean_textures(near, realised);
  return out;
}

/// What the weights would break; empty: nothing. `own`: of the paint that is gone beyond.
std::string violation(const InterpolatablePaint& near, const Weights& weights, const Albedos& own) {
  const Mix mix = mix_of(near, weights);
  const Albedos given = albedos(near, mix.drawn, mix.textures);
  for (std::size_t k = 0; k < given.size(); ++k)
    for (int c = 0; c < 3; ++c)
      if (given[k][c] > std::max(1.0, own[k][c]) + albedo_error)
        return "give back more light than it gets, at " + std::to_string(std::lround(albedo_angles_deg[k])) +
               " degrees";
  const Colours drawn = shop_colours(near, mix.drawn, mix.textures);
  const Colours meant = shop_colours(near, extrapolate_analytic(near, weights), mix.textures);
  const auto clamped = shop_differences(drawn, meant);
  for (std::size_t k = 0; k < clamped.size(); ++k)
    if (clamped[k] > just_seen)
      return "be held back by its parameters' ranges, at " + std::to_string(std::lround(shop_angles_deg[k])) +
             " degrees from the mirror";
  return {};
}

}  // namespace

Beyond measure_beyond(const InterpolatablePaint& paint) {
  const std::size_t paints = paint.paints.size();
  if (paints < 2) return {0.0, "there is nothing to go away from"};
  const InterpolatablePaint near = level0_of(paint);
  const auto weights_at = [&](std::size_t k, double beyond) {
    std::vector<double> weights(paints, -beyond / static_cast<double>(paints));
    weights[k] += 1.0 + beyond;
    return Weights::uniform(weights);
  };
  std::vector<Albedos> own;
  own.reserve(paints);
  for (std::size_t k = 0; k < paints; ++k) {
    const Mix mix = mix_of(near, weights_at(k, 0.0));
    own.push_back(albedos(near, mix.drawn, mix.textures));
  }
  for (int step = 1; step <= steps; ++step)
    for (std::size_t k = 0; k < paints; ++k) {
      const std::string broken = violation(near, weights_at(k, most_beyond * step / steps), own[k]);
      if (!broken.empty())
        return {most_beyond * (step - 1) / steps, paint.paints[k].identity.name + " would " + broken};
    }
  return {most_beyond, {}};
}

double beyond_limit(const InterpolatablePaint& paint) { return measure_beyond(paint).limit; }

}  // namespace lackwerk::core
