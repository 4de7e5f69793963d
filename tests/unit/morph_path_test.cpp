// The slider's path: exact at the paints, continuous between them.
#include "kiosk/display/morph_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace lackwerk::kiosk {
namespace {

using Weights = std::vector<double>;

TEST(MorphPath, WholePositionsArePaints) {
  for (int n = 1; n <= 5; ++n)
    for (const PathEnds ends : {PathEnds::open, PathEnds::closed})
      for (int k = 0; k < n; ++k) {
        Weights only(static_cast<std::size_t>(n), 0.0);
        only[static_cast<std::size_t>(k)] = 1.0;
        EXPECT_EQ(weights_at(k, n, ends), only);
      }
}

TEST(MorphPath, AnOpenPathStopsAtItsEnds) {
  EXPECT_EQ(weights_at(-0.5, 3, PathEnds::open), (Weights{1, 0, 0}));
  EXPECT_EQ(weights_at(7.0, 3, PathEnds::open), (Weights{0, 0, 1}));
  EXPECT_EQ(weights_at(0.25, 3, PathEnds::open), (Weights{0.75, 0.25, 0}));
}

TEST(MorphPath, AClosedPathGoesRound) {
  EXPECT_EQ(weights_at(2.5, 3, PathEnds::closed), (Weights{0.5, 0, 0.5}));
  EXPECT_EQ(weights_at(3.0, 3, PathEnds::closed), (Weights{1, 0, 0}));
  EXPECT_EQ(weights_at(-0.25, 3, PathEnds::closed), (Weights{0.75, 0, 0.25}));
  EXPECT_EQ(weights_at(-1e-18, 3, PathEnds::closed), (Weights{1, 0, 0}));
  EXPECT_EQ(weights_at(1.5, 2, PathEnds::closed), (Weights{0.5, 0.5}));
  EXPECT_EQ(weights_at(0.5, 1, PathEnds::closed), (Weights{1}));
}

TEST(MorphPath, IsContinuousAndSumsToOne) {
  const double step = 1.0 / 1024.0;
  for (int n = 1; n <= 5; ++n)
    for (const PathEnds ends : {PathEnds::open, PathEnds::closed}) {
      Weights last = weights_at(-2.0 * n, n, ends);
      for (double p = -2.0 * n; p <= 2.0 * n; p += step) {
        const Weights now = weights_at(p, n, ends);
        EXPECT_DOUBLE_EQ(std::accumulate(now.begin(), now.end(), 0.0), 1.0);
        for (std::size_t k = 0; k < now.size(); ++k) {
          EXPECT_GE(now[k], 0.0);
          EXPECT_LE(std::abs(now[k] - last[k]), step * (1.0 + 1e-9)) << n << " paints at " << p;
        }
        last = now;
      }
    }
}

TEST(MorphPath, NonsenseIsTheFirstPaint) {
  for (const double p : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                         -std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(weights_at(p, 3, PathEnds::open), (Weights{1, 0, 0}));
    EXPECT_EQ(weights_at(p, 3, PathEnds::closed), (Weights{1, 0, 0}));
  }
  EXPECT_EQ(weights_at(1e300, 3, PathEnds::open), (Weights{0, 0, 1}));
  EXPECT_EQ(nearest_position({1, 0}, 3, PathEnds::open), 0.0);
  EXPECT_EQ(nearest_position({0, std::numeric_limits<double>::quiet_NaN(), 1}, 3, PathEnds::open), 0.0);
}

TEST(MorphPath, ThePositionIsFoundAgain) {
  for (int n = 1; n <= 5; ++n)
    for (const PathEnds ends : {PathEnds::open, PathEnds::closed})
      for (double p = 0.0; p <= on_path(n - 1.0, n, ends); p += 0.125) {
        // Between two paints a closed path passes the same mixes on both ways.
        if (n == 2 && p > 1.0) continue;
        EXPECT_NEAR(nearest_position(weights_at(p, n, ends), n, ends), p, 1e-12) << n << " paints";
      }
  EXPECT_NEAR(nearest_position({0.5, 0.0, 0.5}, 3, PathEnds::closed), 2.5, 1e-12);
  // A mix of three: the segment of the two largest.
  EXPECT_NEAR(nearest_position({0.1, 0.5, 0.4}, 3, PathEnds::closed), 1.45, 1e-12);
}

}  // namespace
}  // namespace lackwerk::kiosk
