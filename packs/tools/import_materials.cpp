#include "packs/tools/import_materials.hpp"

#include <algorithm>
#include <array>

namespace lackwerk::packs {
namespace {

constexpr std::array<std::string_view, surface_kind_count> kind_names = {
    "paint", "glass", "chrome", "rubber", "trim", "rim", "lamp_clear", "lamp_red", "interior", "floor"};

struct Word {
  std::string_view text;
  SurfaceKind kind;
};

// The first word found decides, so the narrower ones stand first: "trim" holds "rim", "brake disc" is no lamp.
constexpr std::array words = {
    Word{"interior", SurfaceKind::interior}, Word{"seat", SurfaceKind::interior},
    Word{"dash", SurfaceKind::interior},     Word{"carpet", SurfaceKind::interior},
    Word{"leather", SurfaceKind::interior},  Word{"disc", SurfaceKind::rim},
    Word{"caliper", SurfaceKind::trim},      Word{"tail", SurfaceKind::lamp_red},
    Word{"brake", SurfaceKind::lamp_red},    Word{"red_light", SurfaceKind::lamp_red},
    Word{"light", SurfaceKind::lamp_clear},  Word{"lamp", SurfaceKind::lamp_clear},
    Word{"head", SurfaceKind::lamp_clear},   Word{"window", SurfaceKind::glass},
    Word{"windscreen", SurfaceKind::glass},  Word{"windshield", SurfaceKind::glass},
    Word{"glass", SurfaceKind::glass},       Word{"tyre", SurfaceKind::rubber},
    Word{"tire", SurfaceKind::rubber},       Word{"rubber", SurfaceKind::rubber},
    Word{"chrome", SurfaceKind::chrome},     Word{"mirror", SurfaceKind::chrome},
    Word{"trim", SurfaceKind::trim},         Word{"rim", SurfaceKind::rim},
    Word{"wheel", SurfaceKind::rim},         Word{"alloy", SurfaceKind::rim},
};

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 40;
  std::string out;
  for (std::size_t k = 0; k < names.size() && k < most; ++k) out += (k == 0 ? "" : ", ") + names[k];
  return names.size() > most ? out + " and " + std::to_string(names.size() - most) + " more" : out;
}

/// Every name that equals `wanted` but for the case.
std::vector<std::size_t> equal_names(const std::vector<std::string>& names, const std::string& wanted) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (lower(names[k]) == lower(wanted)) out.push_back(k);
  return out;
}

Result<std::vector<std::size_t>> find_paint(const std::vector<std::string>& names, const std::string& paint,
                                            const std::string& file) {
  std::vector<std::size_t> found = equal_names(names, paint);
  if (!found.empty()) return found;
  if (!paint.empty())
    for (std::size_t k = 0; k < names.size(); ++k)
      if (lower(names[k]).find(lower(paint)) != std::string::npos) found.push_back(k);
  if (found.size() == 1) return found;
  return fail(file, "--paint", (found.empty() ? "no material '" : "more than one material like '") + paint + "'",
              "the model has: " + listed(names));
}

}  // namespace

std::string_view name_of(SurfaceKind kind) { return kind_names[static_cast<std::size_t>(kind)]; }

Result<SurfaceKind> importable_kind(std::string_view name) {
  const auto found = std::find(kind_names.begin(), kind_names.end(), name);
  const auto index = static_cast<std::size_t>(found - kind_names.begin());
  if (found != kind_names.end() && static_cast<SurfaceKind>(index) != SurfaceKind::floor)
    return static_cast<SurfaceKind>(index);
  std::string known;
  for (const std::string_view kind : kind_names)
    if (kind != name_of(SurfaceKind::floor)) known += (known.empty() ? "" : ", ") + std::string(kind);
  return fail("", "--material", "'" + std::string(name) + "' is no kind of surface", "use " + known, ErrorKind::usage);
}

SurfaceKind kind_by_name(std::string_view material) {
  const std::string text = lower(material);
  for (const Word& word : words)
    if (text.find(word.text) != std::string::npos) return word.kind;
  return SurfaceKind::trim;
}

Result<std::vector<SurfaceKind>> assign_kinds(const std::vector<std::string>& names, const std::string& paint,
                                              const std::vector<std::pair<std::string, SurfaceKind>>& chosen,
                                              const std::string& file) {
  const auto painted = find_paint(names, paint, file);
  if (!painted) return tl::unexpected(painted.error());
  std::vector<SurfaceKind> kinds;
  kinds.reserve(names.size());
  for (const std::string& name : names) kinds.push_back(kind_by_name(name));
  for (const auto& [name, kind] : chosen) {
    const std::vector<std::size_t> found = equal_names(names, name);
    if (found.empty()) return fail(file, "--material", "no material '" + name + "'", "the model has: " + listed(names));
    for (const std::size_t k : found) kinds[k] = kind;
  }
  for (const std::size_t k : *painted) kinds[k] = SurfaceKind::paint;
  return kinds;
}

}  // namespace lackwerk::packs
