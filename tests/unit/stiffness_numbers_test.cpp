// The report's stiff cases of colour, weights, light, fits and isochromatic lines hold their bounds.
#include <gtest/gtest.h>

#include "kiosk/tools/report/stiff_numbers.hpp"

namespace lackwerk::report {
namespace {

void expect_held(const Findings& findings, std::size_t cases) {
  EXPECT_EQ(findings.stiff.size(), cases) << "cases that are to be judged";
  for (const StiffCase& found : findings.stiff)
    EXPECT_TRUE(found.passed()) << found.kernel << ", " << found.name << ": " << found.measure << " " << found.worst
                                << " > " << found.bound << " (" << found.where << ")";
}

TEST(ColourStiffness, EveryCaseHoldsItsBound) {
  Findings findings;
  add_stiff_colour(findings);
  expect_held(findings, 4 * 3 + 4);
}

TEST(WeightStiffness, EveryCaseHoldsItsBound) {
  Findings findings;
  add_stiff_weights(findings);
  expect_held(findings, 5 * 4 + 4 * 3);
}

TEST(LightStiffness, EveryCaseHoldsItsBound) {
  Findings findings;
  add_stiff_light(false, findings);
  expect_held(findings, 2 * 2 + 2);
}

TEST(FitStiffness, EveryCaseHoldsItsBound) {
  Findings findings;
  add_stiff_fits(findings);
  expect_held(findings, 3 + 3 * 3 * 2);
}

}  // namespace
}  // namespace lackwerk::report
