// The report's stiff cases of exact transport hold their bounds.
#include <gtest/gtest.h>

#include "kiosk/tools/report/stiff_transport.hpp"

namespace lackwerk::report {
namespace {

TEST(TransportStiffness, EveryCaseHoldsItsBound) {
  Findings findings;
  add_stiff_transport(findings);
  EXPECT_EQ(findings.stiff.size(), 24u);  // twelve cases, objective and marginals
  for (const StiffCase& found : findings.stiff)
    EXPECT_TRUE(found.passed()) << found.kernel << ", " << found.name << ": " << found.measure << " " << found.worst
                                << " > " << found.bound << " (" << found.where << ")";
}

}  // namespace
}  // namespace lackwerk::report
