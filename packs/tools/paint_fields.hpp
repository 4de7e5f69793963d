// The keys that captures and folders of flake pictures share: AxF's quantities in paint.toml.
//
// Why it exists: one key has one meaning and one range, whoever reads it. Include it where toml_fields.hpp is included
// already (toml++ is slow to compile). Free functions over values; one thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "packs/tools/capture.hpp"
#include "packs/tools/toml_fields.hpp"

namespace lackwerk::packs {

inline constexpr double max_paint_weight = 1e3;  ///< of s and a: far above any paint, far below trouble
inline constexpr int max_layout_slices = 256;
inline constexpr int max_layout_theta = 256;
inline constexpr std::uint32_t max_slice_edge = 4096;
inline constexpr std::uint64_t max_slice_texels = 1u << 27;  ///< of all slices together: 1.6 GB, nine real captures

inline void read_lobe_fields(Fields& fields, core::AnalyticPaint& paint) {
  paint.diffuse = fields.rgb("CT_diffuse", 0.0, max_paint_weight);
  const auto s = fields.rgb_list("CT_coeffs", 0.0, max_paint_weight, core::max_lobes);
  const auto f0 = fields.numbers("CT_F0s", 0.0, 1.0, core::max_lobes);
  const auto m = fields.numbers("CT_spreads", core::min_roughness, 1.0, core::max_lobes);
  if (s.size() != f0.size() || s.size() != m.size()) {
    return fields.wrong("CT_coeffs", "CT_coeffs, CT_F0s and CT_spreads differ in length", "give one entry per lobe");
  }
  for (std::size_t k = 0; k < s.size(); ++k) paint.lobes[k] = {s[k], m[k], f0[k]};
  order_lobes(paint, s.size());
}

/// name, source, IOR, cc_no_refraction, refraction_IOR, [provenance].
inline void read_identity_fields(Fields& fields, core::PaintIdentity& identity, core::AnalyticPaint& paint) {
  identity.name = fields.text("name");
  identity.source = fields.text("source");
  paint.coat_ior = fields.number("IOR", 1.0, 4.0);
  const bool straight = fields.flag("cc_no_refraction", false);
  paint.refraction_ior = straight ? 1.0 : fields.number_or("refraction_IOR", paint.coat_ior, 1.0, 4.0);
  if (auto origin = fields.table("provenance", {"lobes", "flakes", "coat"})) {
    identity.lobes = origin->provenance("lobes");
    identity.flakes = origin->provenance("flakes");
    identity.coat = origin->provenance("coat");
  } else {
    fields.wrong("provenance", "is missing", "say where lobes, flakes and coat came from");
  }
}

/// The name of a file or folder below the document's own.
[[nodiscard]] inline std::string read_file_name(Fields& fields, std::string_view key) {
  std::string name = fields.text(key);
  if (name.find("..") != std::string::npos || std::filesystem::path(name).is_absolute())
    fields.wrong(key, "leads out of the folder", "put it beside this file");
  return name;
}

/// Which of the words a key holds; 0 where it is absent and not needed.
[[nodiscard]] inline std::size_t read_word(Fields& fields, std::string_view key, const std::vector<std::string>& words,
                                           bool needed) {
  if (!needed && !fields.has(key)) return 0;
  const std::string said = fields.text(key);
  const auto at = std::find(words.begin(), words.end(), said);
  if (at != words.end()) return static_cast<std::size_t>(at - words.begin());
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  fields.wrong(key, "is none of the known words", "use one of " + list);
  return 0;
}

/// num_thetaF, num_thetaI, max_thetaI, thetaFI_sliceLUT. A layout without slices is an error.
[[nodiscard]] inline core::SliceLayout read_layout_fields(Fields& fields) {
  core::SliceLayout layout;
  layout.num_theta = static_cast<std::uint16_t>(fields.whole("num_thetaF", 1, max_layout_theta));
  if (fields.whole("num_thetaI", 1, max_layout_theta) != layout.num_theta)
    fields.wrong("num_thetaI", "differs from num_thetaF", "files that shift and swap uv per bin are not read yet");
  for (const double entry : fields.numbers("thetaFI_sliceLUT", 0.0, max_layout_slices, max_layout_theta + 1)) {
    const auto next = static_cast<std::uint16_t>(entry);
    const int rise = layout.lut.empty() ? next : static_cast<int>(next) - layout.lut.back();
    if (entry != std::floor(entry)) fields.wrong("thetaFI_sliceLUT", "must hold whole numbers", "");
    if (layout.lut.empty() ? next != 0 : (rise < 0 || rise > layout.num_theta))
      fields.wrong("thetaFI_sliceLUT", "does not start at 0 and rise by 0 to num_thetaF per row",
                   "export it unchanged");
    layout.lut.push_back(next);
  }
  if (layout.rows() != fields.whole("max_thetaI", 1, max_layout_theta) || layout.rows() > layout.num_theta)
    fields.wrong("max_thetaI", "is not the number of rows of thetaFI_sliceLUT", "export it unchanged");
  if (layout.slice_count() == 0) fields.wrong("thetaFI_sliceLUT", "has no slices", "leave [flakes] out");
  return layout;
}

}  // namespace lackwerk::packs
