// The one table of what kiosk.toml may hold.
//
// Why it exists: a sample file, a parser and its messages that are written apart differ one day. A key knows where its
// value lives in the configuration; its default is what stands there before anything is read. Only config.cpp and
// config_text.cpp use this. Constant data; any thread.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kiosk/display/config.hpp"

namespace lackwerk::kiosk {

using Curves = std::array<std::vector<double>, 3>;
/// Width and height of a mode; 0, 0: the preferred one.
using Mode = std::array<int, 2>;

/// Where a value lives.
using Slot = std::variant<bool*, int*, double*, std::string*, std::vector<std::string>*, Platform*, Rotation*, Mode*,
                          Chromaticity*, Curves*, std::optional<input::CalibrationMatrix>*, input::KnobProfile*,
                          ui::Language*, NightHours*>;

template <class Owner>
struct Key {
  std::string_view name;
  Slot (*slot)(Owner&);
  std::string_view help;
  double least = 0.0, most = 0.0;                 ///< of numbers; of texts and lists: most is the length
  std::vector<std::string> (*words)() = nullptr;  ///< of texts that can be only these
};

/// A table of the file.
template <class Owner>
struct Section {
  std::string_view name;  ///< empty: the top of the file
  std::string_view help;
  std::vector<Key<Owner>> keys;
};

[[nodiscard]] const std::vector<Section<Config>>& config_sections();
/// [[knob]] and [[touch]]: any number of them, one per device.
[[nodiscard]] const Section<input::KnobMatch>& knob_section();
[[nodiscard]] const Section<input::TouchSettings>& touch_section();

inline constexpr std::size_t max_knob_settings = 16;
/// Below this no panel that fingers can use has its dots; 0 stands for "as the panel says".
inline constexpr double least_dpi = 30.0;
/// Bounds of an exponent of a panel's curve: power_curve()'s.
inline constexpr double least_exponent = 1.0, most_exponent = 4.0;

/// The value as the file writes it.
[[nodiscard]] std::string text_of(const Slot& slot);
/// What a value must be, for messages and help: "a whole number, 1 to 1000".
[[nodiscard]] std::string kind_of(const Slot& slot, double least, double most, const std::vector<std::string>& words);

/// The same for a key of some owner.
template <class Owner>
[[nodiscard]] std::string kind_of(const Key<Owner>& key, Owner& owner) {
  return kind_of(key.slot(owner), key.least, key.most, key.words ? key.words() : std::vector<std::string>{});
}

/// "auto" and so on, in the order of the enumeration.
[[nodiscard]] std::vector<std::string> platform_words();
[[nodiscard]] std::vector<std::string> profile_words();

}  // namespace lackwerk::kiosk
