// The names of measuring angles, as makers of instruments write them.
//
// Why it exists: "15as45" is 15 degrees from the mirror direction under light at 45 degrees, but "45as110" names the
// light first; ASTM writes "45:as110". What a name leaves open the other names of its file settle. Pure; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/analysis/standard_angles.hpp"

namespace lackwerk::packs {

enum class AngleOrder : std::uint8_t { unknown, aspecular_first, light_first };

/// The numbers of a name, as they stand.
struct AngleName {
  double first = 0.0, second = 0.0;
  AngleOrder order = AngleOrder::unknown;  ///< known where the notation itself says it
};

/// "15as45", "-15 as 45", "45:as110" (light first), "as15" (light at 45): decimals with a point, blanks and degree
/// signs anywhere. Nothing where the text is no such name.
[[nodiscard]] std::optional<AngleName> parse_angle_name(std::string_view text);

/// The angles of one file's names, in their order. Lights are at 15 or 45 degrees. A name that can be read both ways
/// ("45as15") follows `told`; else the names that can be read one way, if they agree; else, if there are none, it is
/// read aspecular first. `wrong` gets the index of the first name that cannot be read, and why.
struct WrongName {
  std::size_t index = 0;
  std::string what;
};
[[nodiscard]] std::optional<std::vector<core::MeasuringAngle>> settle_angles(const std::vector<AngleName>& names,
                                                                             AngleOrder told, WrongName& wrong);

}  // namespace lackwerk::packs
