#include "kiosk/display/pack_facts.hpp"

#include <algorithm>
#include <numeric>

#include "core/character.hpp"
#include "kiosk/display/pin.hpp"
#include "kiosk/display/ui/strings.hpp"
#include "packs/mix_code.hpp"

namespace lackwerk::kiosk {
namespace {

core::Weights paint_alone(std::size_t paints, std::size_t k) {
  std::vector<double> weights(paints, 0.0);
  weights[k] = 1.0;
  return core::Weights::uniform(weights);
}

using ShopColours = std::array<glm::dvec3, 3>;

std::vector<ShopColours> colours_of(const core::InterpolatablePaint& paint) {
  std::vector<ShopColours> out;
  for (std::size_t k = 0; k < paint.paints.size(); ++k)
    out.push_back(core::shop_colours(paint, paint_alone(paint.paints.size(), k)));
  return out;
}

/// The paint with the least mean difference over the three angles.
ui::Nearest nearest_of(const ShopColours& mix, const std::vector<ShopColours>& paints) {
  ui::Nearest best;
  double least = 0.0;
  for (std::size_t k = 0; k < paints.size(); ++k) {
    const std::array<double, 3> apart = core::shop_differences(mix, paints[k]);
    const double sum = std::accumulate(apart.begin(), apart.end(), 0.0);
    if (k > 0 && sum >= least) continue;
    least = sum;
    best = {static_cast<int>(k), apart};
  }
  return best;
}

}  // namespace

ExperienceLinks links_to(const packs::ExhibitPack& pack, const std::string& pin_hash) {
  ExperienceLinks links;
  links.check_pin = [pin_hash](const std::string& pin) { return check_pin(pin_hash, pin); };
  if (pack.paints() == nullptr) return links;
  const core::InterpolatablePaint* paint = &pack.paints()->paint();
  links.nearest = [paint, paints = colours_of(*paint)](const core::Weights& weights) {
    return nearest_of(core::shop_colours(*paint, weights), paints);
  };
  links.mix_name = [paint](const core::Weights& weights, ui::Language language) {
    return packs::mix_name(*paint, weights, ui::mix_words(language));
  };
  // By value: packs are swapped, and the info is small.
  links.mix_code = [info = pack.paints()->info()](const core::Weights& weights) {
    return packs::encode_mix(info, weights);
  };
  return links;
}

Room room_of(const packs::Scene& scene) { return {scene.environment.centre_mm, scene.environment.room_radius_mm}; }

}  // namespace lackwerk::kiosk
