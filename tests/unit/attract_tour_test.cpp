// The attract tour: smooth, and never the same twice within ten minutes.
#include "kiosk/display/attract_tour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "kiosk/display/ui/layout.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr double nearest_closeness = 4.2;

TourBounds bounds(std::size_t paints) { return {ui::first_places(paints), nearest_closeness, true}; }
TourPose home(std::size_t paints) { return {ui::first_places(paints).front(), 36.5, 4.1, 0.0, 0}; }

class Tours : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Paints, Tours, testing::Values(1u, 2u, 3u, 5u));

TEST_P(Tours, NeverRepeatsWithinTenMinutes) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const TourBounds within = bounds(GetParam());
    AttractTour tour(seed, within);
    tour.start(home(GetParam()), 0.0);
    struct Seen {
      double first_s, last_s;
    };
    std::map<std::uint64_t, Seen> seen;
    int repeats = 0;
    // Between the moments that the tour itself looks at.
    for (double s = 0.033; s < 3600.0; s += 0.1) {
      const std::uint64_t key = tour_key(within.swatches, tour.at(1e3 * s));
      const auto [place, fresh] = seen.try_emplace(key, Seen{s, s});
      if (fresh) continue;
      Seen& last = place->second;
      if (s - last.last_s > tour_memory_s) {
        last = {s, s};
        continue;
      }
      if (s - last.first_s > tour_repeat_s) ++repeats;
      last.last_s = s;
    }
    EXPECT_EQ(repeats, 0) << "seed " << seed;
  }
}

TEST_P(Tours, IsSmooth) {
  AttractTour tour(7, bounds(GetParam()));
  tour.start(home(GetParam()), 0.0);
  const double step_s = 0.02;
  TourPose before = tour.at(0.0), last = tour.at(1e3 * step_s);
  const auto check = [&](double a, double b, double c, double most_speed, double most_change, const char* what) {
    EXPECT_LE(std::abs(c - b) / step_s, most_speed) << what;
    EXPECT_LE(std::abs((c - b) - (b - a)) / step_s, most_change) << what << ": its speed jumps";
  };
  for (double s = 2.0 * step_s; s < 1200.0 && !testing::Test::HasFailure(); s += step_s) {
    const TourPose now = tour.at(1e3 * s);
    for (std::size_t axis = 0; axis < 2; ++axis)
      check(before.puck[axis], last.puck[axis], now.puck[axis], 0.4, 0.02, "puck");
    check(before.azimuth_deg, last.azimuth_deg, now.azimuth_deg, 12.0, 0.1, "azimuth");
    check(before.elevation_deg, last.elevation_deg, now.elevation_deg, 8.0, 0.1, "elevation");
    check(before.closeness, last.closeness, now.closeness, 0.7, 0.02, "closeness");
    EXPECT_GE(now.azimuth_deg, last.azimuth_deg - 1e-9) << "one way round";
    before = last;
    last = now;
  }
}

TEST(AttractTour, ShowsEverything) {
  AttractTour tour(3, bounds(3));
  tour.start(home(3), 0.0);
  std::set<int> moods;
  double nearest = 0.0, farthest = 10.0, turned = 0.0;
  std::array<double, 3> most{};
  for (double s = 0.0; s < 600.0; s += 0.25) {
    const TourPose pose = tour.at(1e3 * s);
    moods.insert(pose.light);
    nearest = std::max(nearest, pose.closeness);
    farthest = std::min(farthest, pose.closeness);
    turned = pose.azimuth_deg - home(3).azimuth_deg;
    for (std::size_t k = 0; k < 3; ++k) {
      const ui::Place swatch = bounds(3).swatches[k];
      most[k] = std::max(most[k], 1.0 - std::hypot(pose.puck[0] - swatch[0], pose.puck[1] - swatch[1]));
    }
  }
  EXPECT_EQ(moods.size(), 3u);
  EXPECT_GT(nearest, nearest_closeness - 1.0) << "down to the flakes";
  EXPECT_LT(farthest, 0.0);
  EXPECT_GT(turned, 1000.0);
  for (const double near : most) EXPECT_GT(near, 0.7) << "every paint has its time";
}

TEST(AttractTour, IsDeterministicAndGoesOnAfterAVisit) {
  AttractTour one(5, bounds(3)), other(5, bounds(3));
  const auto first_legs = [](AttractTour& tour, double at_ms) {
    tour.start(home(3), at_ms);
    std::vector<TourPose> poses;
    for (double s = 0.0; s < 60.0; s += 1.0) poses.push_back(tour.at(at_ms + 1e3 * s));
    return poses;
  };
  const auto same = [](const std::vector<TourPose>& a, const std::vector<TourPose>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const TourPose& p, const TourPose& q) {
      return p.puck == q.puck && p.azimuth_deg == q.azimuth_deg && p.closeness == q.closeness && p.light == q.light;
    });
  };
  const auto a = first_legs(one, 0.0);
  EXPECT_TRUE(same(a, first_legs(other, 1e6))) << "the clock's zero does not matter";
  // Home again after a visit, and on with other legs.
  const auto b = first_legs(one, 2e6);
  EXPECT_EQ(b.front().puck, home(3).puck);
  EXPECT_EQ(b.front().azimuth_deg, home(3).azimuth_deg);
  EXPECT_FALSE(same(a, b));
  AttractTour third(6, bounds(3));
  EXPECT_FALSE(same(a, first_legs(third, 0.0))) << "another seed";
}

TEST(AttractTour, MixesAloneLeaveTheViewAlone) {
  TourBounds still = bounds(3);
  still.moves_camera = false;
  AttractTour tour(1, still);
  tour.start(home(3), 0.0);
  double way = 0.0;
  ui::Place last = home(3).puck;
  for (double s = 0.0; s < 300.0; s += 0.5) {
    const TourPose pose = tour.at(1e3 * s);
    EXPECT_NEAR(pose.azimuth_deg, home(3).azimuth_deg, 1e-9);
    EXPECT_NEAR(pose.elevation_deg, home(3).elevation_deg, 1e-9);
    EXPECT_NEAR(pose.closeness, 0.0, 1e-9);
    EXPECT_EQ(pose.light, 0);
    way += std::hypot(pose.puck[0] - last[0], pose.puck[1] - last[1]);
    last = pose.puck;
  }
  EXPECT_GT(way, 1.0);
}

TEST(AttractTour, ASleepIsNotCaughtUp) {
  AttractTour tour(1, bounds(3));
  tour.start(home(3), 0.0);
  const TourPose before = tour.at(5'000.0);
  const TourPose after = tour.at(1e9);
  EXPECT_LT(std::abs(after.azimuth_deg - before.azimuth_deg), 100.0);
}

}  // namespace
}  // namespace lackwerk::kiosk
