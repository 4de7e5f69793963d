// A pack as behaviour and interface see it: names, colours, limits, and the numbers of a mix.
//
// Why it exists: neither may know paint data; here the two meet. The pack must outlive what is made of it. One thread.
#pragma once

#include <string>

#include "kiosk/display/experience.hpp"
#include "kiosk/display/ui/content.hpp"
#include "packs/exhibit_pack.hpp"
#include "packs/scene.hpp"

namespace lackwerk::kiosk {

/// `pin_hash`: of InterfaceSettings; empty: no PIN is right. A pack of scans has no mixes to name.
[[nodiscard]] ExperienceLinks links_to(const packs::ExhibitPack& pack, const std::string& pin_hash);

/// The room that a scene's environment is.
[[nodiscard]] Room room_of(const packs::Scene& scene);

}  // namespace lackwerk::kiosk
