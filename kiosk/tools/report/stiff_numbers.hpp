// Stiff cases of colour, of weights, of light from an environment, and of fits and isochromatic lines.
//
// Why it exists: `report` shows them beside those of transport, clusters and the paint model, and the unit tests hold
// them to the same bounds. Free functions; any thread.
#pragma once

#include "kiosk/tools/report/findings.hpp"

namespace lackwerk::report {

/// Lab of negative and huge values and back; CIEDE2000 against its published pairs and at its extremes.
void add_stiff_colour(Findings& findings);
/// realise() of one to five paints: at the paints, beside them, far beyond them, with sums a little off.
void add_stiff_weights(Findings& findings);
/// Environments: one texel of 1e6 in the dark and (not when `quick`) by day, black, a texel that is no number. Takes
/// about two seconds an environment.
void add_stiff_light(bool quick, Findings& findings);
/// Engine fits and isochromatic lines: narrow lobes, critical and equal angles, grazing, flakes that lie flat.
void add_stiff_fits(Findings& findings);

/// Appends one case.
void add_case(Findings& findings, const char* kernel, const std::string& name, const char* measure, double worst,
              double bound, const std::string& where = {});

}  // namespace lackwerk::report
