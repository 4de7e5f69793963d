// A capture's colours at measuring angles, from whatever it holds.
//
// Why it exists: a table of angles, a whole measured BRDF and a model are compared by the same numbers. Pure; any
// thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/analysis/standard_angles.hpp"
#include "core/error.hpp"
#include "packs/tools/capture.hpp"

namespace lackwerk::packs {

/// Which part of a capture speaks. `automatic`: what was measured (angles before BRDF), else the model.
enum class ColourSource : std::uint8_t { automatic, angles, brdf, model };

struct CaptureColours {
  ColourSource source = ColourSource::model;  ///< never automatic
  std::vector<core::AngleColour> colours;     ///< of a table: all its angles; else those of the wanted that are known
};

/// The word for it: "table of angles", "measured BRDF", "model".
[[nodiscard]] const char* source_name(ColourSource source);

/// Colours at the wanted angles. The model is BRDF + mean flakes under the coat (capture_brdf.hpp); holes of a measured
/// BRDF leave their angle out. Errors name `file`: the capture lacks the wanted part.
[[nodiscard]] Result<CaptureColours> capture_colours(const Capture& capture, ColourSource wanted,
                                                     std::span<const core::MeasuringAngle> angles,
                                                     const std::string& file);

/// Both captures at all angles they share: where one is a table, that table's; else the twelve standard ones.
struct CaptureComparison {
  ColourSource a = ColourSource::model, b = ColourSource::model;
  core::AngleComparison at;
  std::vector<core::MeasuringAngle> left_out;  ///< known to one of them alone
};
/// Errors: as capture_colours(), and no angle in common.
[[nodiscard]] Result<CaptureComparison> compare_captures(const Capture& a, ColourSource from_a,
                                                         const std::string& file_a, const Capture& b,
                                                         ColourSource from_b, const std::string& file_b);

}  // namespace lackwerk::packs
