// A touch screen's calibration from four touches.
#include "kiosk/display/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace lackwerk::kiosk {
namespace {

using input::CalibrationMatrix;

const std::vector<Point> crosses{{0.1, 0.1}, {0.9, 0.1}, {0.9, 0.9}, {0.1, 0.9}};

std::vector<Point> reported_through(const CalibrationMatrix& panel) {
  std::vector<Point> out;
  for (const Point& cross : crosses) out.push_back(calibrated(panel, cross));
  return out;
}

TEST(Calibration, UndoesWhatThePanelDoes) {
  // Shifted and scaled, turned a little, mirrored, edges exchanged.
  for (const CalibrationMatrix& panel :
       {CalibrationMatrix{0.9, 0.0, 0.06, 0.0, 1.1, -0.03}, CalibrationMatrix{0.99, 0.05, -0.02, -0.05, 0.99, 0.03},
        CalibrationMatrix{-1.0, 0.0, 1.0, 0.0, 1.0, 0.0}, CalibrationMatrix{0.0, 1.0, 0.0, 1.0, 0.0, 0.0},
        no_calibration}) {
    const auto fitted = fit_calibration(reported_through(panel), crosses);
    ASSERT_TRUE(fitted);
    for (const Point p : {Point{0.0, 0.0}, Point{0.33, 0.71}, Point{1.0, 0.2}}) {
      const Point back = calibrated(*fitted, calibrated(panel, p));
      EXPECT_NEAR(back[0], p[0], 1e-12);
      EXPECT_NEAR(back[1], p[1], 1e-12);
    }
  }
}

TEST(Calibration, AveragesUnsteadyFingers) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.004);
  for (int k = 0; k < 100; ++k) {
    auto reported = reported_through({0.95, 0.0, 0.02, 0.0, 0.95, 0.02});
    for (Point& p : reported)
      for (double& x : p) x += noise(random);
    const auto fitted = fit_calibration(reported, crosses);
    ASSERT_TRUE(fitted);
    const Point middle = calibrated(*fitted, {0.95 * 0.5 + 0.02, 0.95 * 0.5 + 0.02});
    EXPECT_NEAR(middle[0], 0.5, 0.012);
    EXPECT_NEAR(middle[1], 0.5, 0.012);
  }
}

TEST(Calibration, RefusesWhatIsNoPanel) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(fit_calibration({}, {}));
  EXPECT_FALSE(fit_calibration(crosses, {crosses[0]}));
  EXPECT_FALSE(fit_calibration({{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}}, crosses)) << "one place";
  EXPECT_FALSE(fit_calibration({{0.1, 0.1}, {0.4, 0.4}, {0.9, 0.9}, {0.6, 0.6}}, crosses)) << "a line";
  EXPECT_FALSE(fit_calibration({{nan, 0.1}, {0.9, 0.1}, {0.9, 0.9}, {0.1, 0.9}}, crosses));
  // One cross missed by a third of the panel.
  EXPECT_FALSE(fit_calibration({{0.4, 0.4}, {0.9, 0.1}, {0.9, 0.9}, {0.1, 0.9}}, crosses));
  // Four touches in a corner: a scale that no panel has.
  EXPECT_FALSE(fit_calibration(reported_through({0.2, 0.0, 0.0, 0.0, 0.2, 0.0}), crosses));
}

TEST(Calibration, ComesAfterTheOneOfToday) {
  const CalibrationMatrix today{0.9, 0.1, 0.05, -0.1, 1.2, 0.0}, then{1.1, 0.0, -0.03, 0.02, 0.9, 0.1};
  const Point p{0.3, 0.6};
  const Point both = calibrated(composed(then, today), p), stepwise = calibrated(then, calibrated(today, p));
  EXPECT_NEAR(both[0], stepwise[0], 1e-15);
  EXPECT_NEAR(both[1], stepwise[1], 1e-15);
}

}  // namespace
}  // namespace lackwerk::kiosk
