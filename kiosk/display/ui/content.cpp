#include "kiosk/display/ui/content.hpp"

#include <algorithm>

#include "core/character.hpp"
#include "core/colour.hpp"
#include "packs/paint_pack.hpp"
#include "packs/scan_pack.hpp"

namespace lackwerk::kiosk::ui {
namespace {

/// Index of 45 degrees from the mirror direction in core::shop_angles_deg: the colour without gloss and without shade.
constexpr std::size_t face_angle = 1;

std::array<double, 3> display_of(const glm::dvec3& lab) {
  const glm::dvec3 linear = core::linear_from_lab(lab);
  std::array<double, 3> out{};
  for (std::size_t c = 0; c < out.size(); ++c)
    out[c] = core::srgb_encode(std::clamp(linear[static_cast<glm::length_t>(c)], 0.0, 1.0));
  return out;
}

}  // namespace

Content ui_content(const packs::PaintPack& pack) {
  const core::InterpolatablePaint& paint = pack.paint();
  Content out;
  out.pack_id = pack.info().id;
  out.serial = pack.info().serial;
  out.beyond_limit = pack.info().beyond_limit;
  out.has_flakes = paint.row_count() > 0;
  out.paints.reserve(paint.paints.size());
  for (std::size_t k = 0; k < paint.paints.size(); ++k) {
    std::vector<double> one(paint.paints.size(), 0.0);
    one[k] = 1.0;
    const core::Weights weights = core::Weights::uniform(one);
    out.paints.push_back({paint.paints[k].identity, display_of(core::shop_colours(paint, weights)[face_angle]),
                          core::liveliness(paint, weights)});
  }
  return out;
}

Content ui_content(const packs::ScanPack& pack) {
  const packs::ScanInfo& info = pack.info();
  Content out;
  out.pack_id = info.id;
  out.serial = info.serial;
  out.has_flakes = false;
  PaintFacts series;
  series.identity.name = info.name;
  out.paints.push_back(std::move(series));
  ScanFacts& scans = out.scans.emplace();
  scans.name = info.name;
  scans.time_unit = info.time_unit;
  scans.times.reserve(info.states.size());
  for (const packs::ScanState& state : info.states) scans.times.push_back(state.time);
  return out;
}

}  // namespace lackwerk::kiosk::ui
