// Exact transport on stiff cases, against LEMON on costs made here in long double.
//
// Why it exists: the report shows them and the unit tests hold them to their bounds. Pure; any thread.
#pragma once

#include "kiosk/tools/report/findings.hpp"

namespace lackwerk::report {

/// Two for each of transport_cases(): the relative objective gap, and the marginal violation in units of mass.
void add_stiff_transport(Findings& findings);

}  // namespace lackwerk::report
