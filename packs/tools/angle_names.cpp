#include "packs/tools/angle_names.hpp"

#include "packs/tools/csv_table.hpp"

namespace lackwerk::packs {
namespace {

constexpr double usual_light_deg = 45.0;

bool is_light(double degrees) { return degrees == 15.0 || degrees == 45.0; }

/// Lower case, without blanks and degree signs (UTF-8 and Latin-1).
std::string bare(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == ' ' || c == '_' || byte == 0xc2 || byte == 0xb0) continue;
    out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return out;
}

AngleOrder order_of(const AngleName& name) {
  if (name.order != AngleOrder::unknown) return name.order;
  const bool light_last = is_light(name.second), light_first = is_light(name.first);
  if (light_last && light_first) return AngleOrder::unknown;
  return light_last ? AngleOrder::aspecular_first : AngleOrder::light_first;
}

}  // namespace

std::optional<AngleName> parse_angle_name(std::string_view text) {
  constexpr std::size_t longest = 32;
  if (text.size() > longest) return std::nullopt;
  const std::string name = bare(text);
  const std::size_t as = name.find("as");
  if (as == std::string::npos) return std::nullopt;
  std::string first = name.substr(0, as);
  const auto second = csv_number(name.substr(as + 2), false);
  if (!second) return std::nullopt;
  if (first.empty()) return AngleName{usual_light_deg, *second, AngleOrder::light_first};
  const bool colon = first.back() == ':';
  if (colon) first.pop_back();
  const auto number = csv_number(first, false);
  if (!number) return std::nullopt;
  return AngleName{*number, *second, colon ? AngleOrder::light_first : AngleOrder::unknown};
}

std::optional<std::vector<core::MeasuringAngle>> settle_angles(const std::vector<AngleName>& names, AngleOrder told,
                                                               WrongName& wrong) {
  bool says_aspecular = false, says_light = false;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const AngleName& name = names[k];
    if (name.order == AngleOrder::unknown && !is_light(name.first) && !is_light(name.second)) {
      wrong = {k, "no light at 15 or 45 degrees in it"};
      return std::nullopt;
    }
    says_aspecular = says_aspecular || order_of(name) == AngleOrder::aspecular_first;
    says_light = says_light || order_of(name) == AngleOrder::light_first;
  }
  AngleOrder open = told;
  if (open == AngleOrder::unknown && !(says_aspecular && says_light))
    open = says_light ? AngleOrder::light_first : AngleOrder::aspecular_first;
  std::vector<core::MeasuringAngle> out;
  for (std::size_t k = 0; k < names.size(); ++k) {
    AngleOrder order = order_of(names[k]);
    if (order == AngleOrder::unknown) order = names[k].first == names[k].second ? AngleOrder::light_first : open;
    if (order == AngleOrder::unknown) {
      wrong = {k, "can be read both ways, and the other names do not agree"};
      return std::nullopt;
    }
    const bool light_first = order == AngleOrder::light_first;
    out.push_back({light_first ? names[k].first : names[k].second, light_first ? names[k].second : names[k].first});
  }
  return out;
}

}  // namespace lackwerk::packs
