// The report's picture knobs: qualities of moving pictures, frames of still ones, ways of light.
//
// Why it exists: these are the settings a visitor sees. All are judged on one PictureStage. Free functions; one GL
// thread.
#pragma once

#include "core/error.hpp"
#include "kiosk/display/quality_table.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/picture_stage.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

/// Part "pictures": knobs "quality", "still" and "light_path". Error: no GL context, no ray tracing device; nothing has
/// been added then.
[[nodiscard]] Result<void> add_pictures(Workbench& bench, Findings& findings);

/// Every rung of the quality ladder (line "ladder") and each switch of the best one varied (other lines).
[[nodiscard]] Knob quality_knob(Workbench& bench, PictureStage& stage);
/// How a resting picture converges with its frames.
[[nodiscard]] Knob still_knob(Workbench& bench, PictureStage& stage);
/// Directional lights cut from the environment against prefiltered levels.
[[nodiscard]] Knob light_path_knob(Workbench& bench, PictureStage& stage);

/// The figures of knob "quality" that the kiosk's governor goes by: its settings on the line "ladder". The name of the
/// machine's renderer is the first note on that line. Error: the knob was not measured, or lacks a rung.
[[nodiscard]] Result<kiosk::QualityTable> quality_table_of(const Findings& findings);

}  // namespace lackwerk::report
