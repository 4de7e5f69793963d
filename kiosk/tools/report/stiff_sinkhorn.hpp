// Regularised transport on stiff cases: gamma from 10 down to 0.01 Lab, float and double, plain and log domain.
//
// Why it exists: the report shows them and the unit tests hold them to their bounds. Pure; any thread.
#pragma once

#include "kiosk/tools/report/findings.hpp"

namespace lackwerk::report {

/// Four for each of transport_cases() and two for supports without a plan.
void add_stiff_sinkhorn(Findings& findings);

}  // namespace lackwerk::report
