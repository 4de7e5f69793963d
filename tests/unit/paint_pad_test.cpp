// The paint pad: exact on swatches, continuous everywhere, for every number of paints.
#include "kiosk/display/ui/paint_pad.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "kiosk/display/ui/layout.hpp"

namespace lackwerk::kiosk::ui {
namespace {

using Weights = std::vector<double>;
constexpr std::size_t most_paints = 5;

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double unit() { return static_cast<double>(random_()) / 4294967296.0; }
  Place place() {
    const double x = unit();
    return {x, unit()};
  }
  /// Swatches as a visitor may have left them.
  std::vector<Place> swatches(std::size_t paints) {
    std::vector<Place> places = first_places(paints);
    for (int k = 0; k < 6; ++k) places = move_swatch(std::move(places), random_() % paints, place());
    return places;
  }

 private:
  std::mt19937 random_;
};

double apart(Place a, Place b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

double misfit(const Weights& a, const Weights& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

double largest_change(const Weights& a, const Weights& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

TEST(PaintPad, OnASwatchItIsThatPaintAlone) {
  Dice dice(1);
  for (std::size_t n = 1; n <= most_paints; ++n)
    for (int k = 0; k < 200; ++k) {
      const auto swatches = dice.swatches(n);
      for (std::size_t paint = 0; paint < n; ++paint) {
        Weights only(n, 0.0);
        only[paint] = 1.0;
        EXPECT_EQ(pad_weights(swatches, swatches[paint]), only);
        const double angle = 6.28 * dice.unit(), off = 0.999 * on_swatch * dice.unit();
        const Place beside{swatches[paint][0] + off * std::cos(angle), swatches[paint][1] + off * std::sin(angle)};
        EXPECT_EQ(pad_weights(swatches, beside), only) << n << " paints, " << off << " off the middle";
      }
    }
}

TEST(PaintPad, WeightsAreSharesOfOne) {
  Dice dice(2);
  for (std::size_t n = 1; n <= most_paints; ++n)
    for (int k = 0; k < 400; ++k) {
      const Weights weights = pad_weights(dice.swatches(n), dice.place());
      ASSERT_EQ(weights.size(), n);
      EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-14);
      for (const double weight : weights) {
        EXPECT_GE(weight, 0.0);
        EXPECT_LE(weight, 1.0);
      }
    }
}

// Between two rims that are nearest to each other (0.22 - 0.07 = 0.15) two paints change by at most 2 / 0.15 a unit of
// the pad, and a third one near the same place adds less than as much again.
constexpr double steepest = 30.0;

TEST(PaintPad, ASmallMoveOfThePuckIsASmallChange) {
  Dice dice(3);
  const double step = 2e-4;
  for (std::size_t n = 2; n <= most_paints; ++n)
    for (int k = 0; k < 150; ++k) {
      const auto swatches = dice.swatches(n);
      // Across the pad on a line, through rims and all.
      const Place from = dice.place(), to = k % 2 == 0 ? swatches[static_cast<std::size_t>(k) % n] : dice.place();
      const double way = apart(from, to);
      Weights last = pad_weights(swatches, from);
      for (double done = step; done < way; done += step) {
        const Place at{from[0] + (to[0] - from[0]) * done / way, from[1] + (to[1] - from[1]) * done / way};
        Weights now = pad_weights(swatches, at);
        ASSERT_LE(largest_change(now, last), steepest * step) << n << " paints at " << at[0] << ", " << at[1];
        last = std::move(now);
      }
    }
}

TEST(PaintPad, ASmallMoveOfASwatchIsASmallChange) {
  Dice dice(4);
  const double step = 1e-4;
  for (std::size_t n = 2; n <= most_paints; ++n)
    for (int k = 0; k < 400; ++k) {
      const auto swatches = dice.swatches(n);
      const Place puck = dice.place();
      auto moved = swatches;
      const double angle = 6.28 * dice.unit();
      Place& one = moved[static_cast<std::size_t>(k) % n];
      one = {one[0] + step * std::cos(angle), one[1] + step * std::sin(angle)};
      ASSERT_LE(largest_change(pad_weights(swatches, puck), pad_weights(moved, puck)), 2.0 * steepest * step);
    }
}

TEST(PaintPad, TheOrderOfPaintsChangesNothing) {
  Dice dice(5);
  for (std::size_t n = 2; n <= most_paints; ++n)
    for (int k = 0; k < 200; ++k) {
      auto swatches = dice.swatches(n);
      const Place puck = dice.place();
      Weights weights = pad_weights(swatches, puck);
      std::rotate(swatches.begin(), swatches.begin() + 1, swatches.end());
      std::rotate(weights.begin(), weights.begin() + 1, weights.end());
      EXPECT_LE(largest_change(pad_weights(swatches, puck), weights), 1e-14);
    }
}

TEST(PaintPad, TwoPaintsAreASlider) {
  const std::vector<Place> ends{{0.1, 0.5}, {0.9, 0.5}};
  EXPECT_NEAR(pad_weights(ends, {0.5, 0.5})[0], 0.5, 1e-12);
  EXPECT_NEAR(pad_weights(ends, {0.5, 0.1})[0], 0.5, 1e-12) << "beside the line";
  const double quarter = 0.1 + on_swatch + 0.25 * (0.8 - 2.0 * on_swatch);
  EXPECT_NEAR(pad_weights(ends, {quarter, 0.5})[1], 0.25, 1e-12);
}

TEST(PaintPad, NonsenseIsTheFirstPaint) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(pad_weights(first_places(3), {nan, 0.5}), (Weights{1, 0, 0}));
  EXPECT_EQ(pad_weights({{nan, 0.0}, {1.0, 0.0}}, {0.5, 0.5}), (Weights{1, 0}));
  EXPECT_TRUE(pad_weights({}, {0.5, 0.5}).empty());
  EXPECT_EQ(puck_for(first_places(2), {nan, 1.0}), first_places(2)[0]);
  EXPECT_EQ(puck_for(first_places(3), {1.0}), first_places(3)[0]);
  EXPECT_EQ(move_swatch(first_places(3), 1, {nan, 0.0}), first_places(3));
  EXPECT_EQ(move_swatch(first_places(3), 7, {0.0, 0.0}), first_places(3));
  // Swatches on one another, which move_swatch never leaves: still shares of one.
  const Weights same = pad_weights({{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}}, {0.5, 0.5});
  EXPECT_EQ(std::accumulate(same.begin(), same.end(), 0.0), 1.0);
}

TEST(PaintPad, ThePuckIsFoundAgain) {
  Dice dice(6);
  for (std::size_t n = 1; n <= most_paints; ++n)
    for (int k = 0; k < 40; ++k) {
      const auto swatches = dice.swatches(n);
      const Weights weights = pad_weights(swatches, dice.place());
      EXPECT_LE(largest_change(pad_weights(swatches, puck_for(swatches, weights)), weights), 1e-4) << n << " paints";
      for (std::size_t paint = 0; paint < n; ++paint) {
        Weights only(n, 0.0);
        only[paint] = 1.0;
        EXPECT_EQ(puck_for(swatches, only), swatches[paint]);
      }
    }
}

TEST(PaintPad, ThePuckOfAnyWeightsIsTheNearestThatCanBe) {
  Dice dice(7);
  for (std::size_t n = 2; n <= most_paints; ++n)
    for (int k = 0; k < 12; ++k) {
      const auto swatches = dice.swatches(n);
      Weights weights(n);
      double sum = 0.0;
      for (double& weight : weights) sum += weight = dice.unit();
      for (double& weight : weights) weight /= sum;
      double least = 1e300;
      for (int y = 0; y <= 200; ++y)
        for (int x = 0; x <= 200; ++x)
          least = std::min(least, misfit(pad_weights(swatches, {x / 200.0, y / 200.0}), weights));
      EXPECT_LE(misfit(pad_weights(swatches, puck_for(swatches, weights)), weights), least + 1e-9) << n << " paints";
    }
}

TEST(PaintPad, SwatchesKeepTheirDistance) {
  Dice dice(8);
  for (std::size_t n = 1; n <= most_paints; ++n) {
    auto places = first_places(n);
    for (int k = 0; k < 3000; ++k) {
      // Now and then beyond the pad.
      const Place to{1.6 * dice.unit() - 0.3, 1.6 * dice.unit() - 0.3};
      const auto which = static_cast<std::size_t>(k) % n;
      places = move_swatch(std::move(places), which, to);
      for (std::size_t i = 0; i < n; ++i) {
        for (const double x : places[i]) ASSERT_TRUE(x >= 0.0 && x <= 1.0);
        for (std::size_t j = 0; j < i; ++j) ASSERT_GE(apart(places[i], places[j]), least_gap - 1e-6);
      }
    }
  }
}

TEST(PaintPad, AFreePlaceIsReachedAndATakenOneApproached) {
  auto places = first_places(3);
  places = move_swatch(std::move(places), 0, {0.5, 0.5});
  EXPECT_EQ(places[0], (Place{0.5, 0.5}));
  // Onto another swatch: as near as it goes.
  const Place other = places[1];
  places = move_swatch(std::move(places), 0, other);
  EXPECT_NEAR(apart(places[0], other), least_gap, 1e-6);
  // A little off the line through it, a swatch slides around.
  places = {{0.3, 0.5}, {0.6, 0.501}, {0.5, 0.05}};
  places = move_swatch(std::move(places), 0, {0.95, 0.5});
  EXPECT_EQ(places[0], (Place{0.95, 0.5}));
}

TEST(PaintPad, BeyondKeepsTheSum) {
  const Weights beyond = go_beyond({1.0, 0.0, 0.0, 0.0}, 0.4);
  EXPECT_NEAR(beyond[0], 1.3, 1e-15);
  EXPECT_NEAR(beyond[1], -0.1, 1e-15);
  EXPECT_NEAR(std::accumulate(beyond.begin(), beyond.end(), 0.0), 1.0, 1e-15);
  EXPECT_EQ(go_beyond({0.5, 0.5}, 0.3), (Weights{0.5, 0.5})) << "the middle has no beyond";
  EXPECT_EQ(go_beyond({0.25, 0.75}, 0.0), (Weights{0.25, 0.75}));
}

}  // namespace
}  // namespace lackwerk::kiosk::ui
