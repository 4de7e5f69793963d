// The report's stiff cases of scans hold their bounds.
#include <gtest/gtest.h>

#include "kiosk/tools/report/stiff_scans.hpp"

namespace lackwerk::report {
namespace {

TEST(ScanStiffness, EveryCaseHoldsItsBound) {
  Findings findings;
  add_stiff_scans(findings);
  EXPECT_EQ(findings.stiff.size(), 41u);  // twelve pairs of three measures, five refusals
  for (const StiffCase& found : findings.stiff)
    EXPECT_TRUE(found.passed()) << found.kernel << ", " << found.name << ": " << found.measure << " " << found.worst
                                << " > " << found.bound << " (" << found.where << ")";
}

}  // namespace
}  // namespace lackwerk::report
