// The report's stiff cases of the paint model hold their bounds.
#include <gtest/gtest.h>

#include <set>

#include "kiosk/tools/report/stiff_model.hpp"

namespace lackwerk::report {
namespace {

TEST(StiffnessModel, EveryCaseHoldsItsBound) {
  Findings findings;
  add_stiff_model(true, findings);
  std::set<std::string> names;
  for (const StiffCase& found : findings.stiff) {
    names.insert(found.name);
    EXPECT_TRUE(found.passed()) << found.name << ": " << found.measure << " " << found.worst << " > " << found.bound
                                << " (" << found.where << ")";
  }
  // Sixteen published paints (eight, with and without a coat) and 27 extreme ones, each twice; opposite directions.
  EXPECT_EQ(names.size(), 2u * (16u + 27u) + 1u);
}

// What the judging itself is worth: black against white is far, a mirror peak's overflow is none.
TEST(StiffnessModel, DifferencesAreThoseOfADisplay) {
  EXPECT_NEAR(shown_difference(glm::dvec3(0.0), glm::dvec3(1.0), 1.0), 100.0, 1e-9);
  EXPECT_EQ(shown_difference(glm::dvec3(500.0), glm::dvec3(9000.0), 0.5), 0.0);
  EXPECT_GT(shown_difference(glm::dvec3(0.5), glm::dvec3(0.55), 1.0), 1.0);
}

}  // namespace
}  // namespace lackwerk::report
