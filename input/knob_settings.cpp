#include "input/knob_settings.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <utility>

namespace lackwerk::input {
namespace {

constexpr std::array<std::pair<std::string_view, KnobProfile>, 5> profile_words{
    {{"automatic", KnobProfile::automatic},
     {"generic", KnobProfile::generic},
     {"surface-dial", KnobProfile::surface_dial},
     {"powermate", KnobProfile::powermate},
     {"spacemouse", KnobProfile::spacemouse}}};

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// NaN lies outside every range.
bool outside(double value, double least, double most) { return !(value >= least && value <= most); }

}  // namespace

std::optional<KnobProfile> knob_profile_of(std::string_view word) {
  for (const auto& [name, profile] : profile_words)
    if (name == word) return profile;
  return std::nullopt;
}

std::string_view word_of(KnobProfile profile) {
  for (const auto& [name, known] : profile_words)
    if (known == profile) return name;
  return "automatic";
}

KnobProfile known_profile(std::uint16_t vendor, std::uint16_t product) {
  // Ids as in the kernel's drivers (drivers/hid/hid-ids.h, drivers/input/misc/powermate.c) and in spacenavd's list.
  if (vendor == 0x045e && product == 0x091b) return KnobProfile::surface_dial;
  if (vendor == 0x077d && product == 0x0410) return KnobProfile::powermate;
  // Under Logitech's vendor id: SpaceMouse Plus, Classic, Spaceball 5000, SpaceTraveler, SpacePilot, SpaceNavigator,
  // SpaceExplorer, SpaceNavigator for Notebooks, SpacePilot Pro, SpaceMouse Pro.
  constexpr std::array<std::uint16_t, 10> logitech{0xc603, 0xc606, 0xc621, 0xc623, 0xc625,
                                                   0xc626, 0xc627, 0xc628, 0xc629, 0xc62b};
  if (vendor == 0x046d && std::find(logitech.begin(), logitech.end(), product) != logitech.end())
    return KnobProfile::spacemouse;
  // 3Dconnexion's own: wireless ones have one id by cable (c62e, c631) and another by radio (c62f, c632, c652);
  // whatever else this vendor sells that has six axes behaves alike.
  if (vendor == 0x256f) return KnobProfile::spacemouse;
  return KnobProfile::automatic;
}

std::optional<std::string> complaint(const KnobTuning& tuning) {
  if (outside(tuning.detents_per_turn, 1.0, 1000.0)) return "detents_per_turn must lie in 1 to 1000";
  if (outside(tuning.counts_per_turn, 0.0, 100000.0)) return "counts_per_turn must lie in 0 to 100000";
  if (outside(tuning.acceleration, 0.0, 2.0)) return "acceleration must lie in 0 to 2";
  if (outside(tuning.dead_zone, 0.0, 0.9)) return "dead_zone must lie in 0 to 0.9";
  constexpr std::array<std::string_view, 7> axes{"", "x", "y", "z", "rx", "ry", "rz"};
  if (std::find(axes.begin(), axes.end(), tuning.axis) == axes.end()) return "axis must be x, y, z, rx, ry or rz";
  return std::nullopt;
}

KnobTuning tuning_for(const KnobSettings& settings, std::uint16_t vendor, std::uint16_t product,
                      std::string_view name) {
  KnobTuning tuning = settings.tuning;
  const std::string id = device_id(vendor, product), low = lower(name);
  for (const auto& device : settings.devices) {
    const std::string wanted = lower(device.match);
    if (wanted.empty() || (wanted != id && low.find(wanted) == std::string::npos)) continue;
    tuning = device.tuning;
    break;
  }
  if (tuning.profile == KnobProfile::automatic) tuning.profile = known_profile(vendor, product);
  return tuning;
}

std::string device_id(std::uint16_t vendor, std::uint16_t product) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%04x:%04x", vendor, product);
  return text.data();
}

}  // namespace lackwerk::input
