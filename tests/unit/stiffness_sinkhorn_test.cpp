// The report's stiff cases of Sinkhorn transport hold their bounds.
#include <gtest/gtest.h>

#include "kiosk/tools/report/stiff_sinkhorn.hpp"

namespace lackwerk::report {
namespace {

TEST(SinkhornStiffness, EveryCaseHoldsItsBound) {
  Findings findings;
  add_stiff_sinkhorn(findings);
  EXPECT_EQ(findings.stiff.size(), 74u);  // six of each of twelve cases, and two supports without a plan
  for (const StiffCase& found : findings.stiff)
    EXPECT_TRUE(found.passed()) << found.kernel << ", " << found.name << ": " << found.measure << " " << found.worst
                                << " > " << found.bound << " (" << found.where << ")";
}

}  // namespace
}  // namespace lackwerk::report
