#include "packs/tools/capture_colours.hpp"

#include <algorithm>
#include <optional>

#include "packs/tools/capture_brdf.hpp"

namespace lackwerk::packs {
namespace {

ColourSource settled(const Capture& capture, ColourSource wanted) {
  if (wanted != ColourSource::automatic) return wanted;
  if (!capture.angles.empty()) return ColourSource::angles;
  return capture.measured ? ColourSource::brdf : ColourSource::model;
}

bool holds(const Capture& capture, ColourSource source) {
  if (source == ColourSource::angles) return !capture.angles.empty();
  return source == ColourSource::brdf ? capture.measured.has_value() : capture.is_fitted;
}

std::vector<core::MeasuringAngle> angles_of(const Capture& capture) {
  std::vector<core::MeasuringAngle> out;
  out.reserve(capture.angles.size());
  for (const AngleReading& reading : capture.angles) out.push_back({reading.light_deg, reading.aspecular_deg});
  return out;
}

/// Those of `from` that the comparison lacks.
void note_left_out(const std::vector<core::AngleColour>& from, CaptureComparison& out) {
  for (const core::AngleColour& colour : from) {
    const auto same = [&](const core::MeasuringAngle& angle) {
      const core::AngleColour other{angle, colour.lab};
      return !core::compare_angles({&colour, 1}, {&other, 1}).angles.empty();
    };
    const bool compared = std::any_of(out.at.angles.begin(), out.at.angles.end(),
                                      [&](const core::AngleDifference& d) { return same(d.angle); });
    if (!compared) out.left_out.push_back(colour.angle);
  }
}

}  // namespace

const char* source_name(ColourSource source) {
  switch (source) {
    case ColourSource::angles:
      return "table of angles";
    case ColourSource::brdf:
      return "measured BRDF";
    case ColourSource::model:
    case ColourSource::automatic:
      break;
  }
  return "model";
}

Result<CaptureColours> capture_colours(const Capture& capture, ColourSource wanted,
                                       std::span<const core::MeasuringAngle> angles, const std::string& file) {
  CaptureColours out{settled(capture, wanted), {}};
  if (!holds(capture, out.source))
    return fail(file, "", std::string("the capture holds no ") + source_name(out.source),
                out.source == ColourSource::model ? "run lackwerk fit" : "choose another part of it");
  if (out.source == ColourSource::angles) {
    for (const AngleReading& reading : capture.angles)
      out.colours.push_back({{reading.light_deg, reading.aspecular_deg}, reading.lab});
    return out;
  }
  core::PartialBrdf brdf;
  if (out.source == ColourSource::brdf) {
    brdf = [&capture](const glm::dvec3& in, const glm::dvec3& eye) { return capture.measured->at(in, eye); };
  } else {
    brdf = [model = capture_brdf(capture)](const glm::dvec3& in, const glm::dvec3& eye) {
      return std::optional(model(in, eye));
    };
  }
  for (const core::MeasuringAngle& angle : angles)
    if (const auto lab = core::colour_at(brdf, angle)) out.colours.push_back({angle, *lab});
  return out;
}

Result<CaptureComparison> compare_captures(const Capture& a, ColourSource from_a, const std::string& file_a,
                                           const Capture& b, ColourSource from_b, const std::string& file_b) {
  CaptureComparison out{settled(a, from_a), settled(b, from_b), {}, {}};
  std::vector<core::MeasuringAngle> angles(core::standard_angles().begin(), core::standard_angles().end());
  if (out.b == ColourSource::angles && !b.angles.empty()) angles = angles_of(b);
  if (out.a == ColourSource::angles && !a.angles.empty()) angles = angles_of(a);
  const auto of_a = capture_colours(a, out.a, angles, file_a);
  if (!of_a) return tl::unexpected(of_a.error());
  const auto of_b = capture_colours(b, out.b, angles, file_b);
  if (!of_b) return tl::unexpected(of_b.error());
  out.at = core::compare_angles(of_a->colours, of_b->colours);
  if (out.at.angles.empty())
    return fail(file_b, "", "shares no measuring angle with " + file_a, "compare captures measured at the same angles");
  note_left_out(of_a->colours, out);
  note_left_out(of_b->colours, out);
  return out;
}

}  // namespace lackwerk::packs
