// The drift against burn-in: one pixel at a time, within its reach, everywhere in it, and only while nobody is there.
#include "kiosk/display/drift.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "input/source.hpp"

namespace lackwerk::kiosk {
namespace {

TEST(Drift, WalksOverItsWholeFieldAPixelAtATime) {
  constexpr int reach = 3;
  Drift drift(reach);
  std::set<std::array<int, 2>> seen;
  auto before = drift.at();
  EXPECT_EQ(before, (std::array<int, 2>{0, 0}));
  double now = 0.0;
  for (int k = 0; k < 4 * reach * (2 * reach + 1); ++k) {
    now += drift_step_ms;
    ASSERT_TRUE(drift.advance(now, -1e9));
    const auto at = drift.at();
    EXPECT_EQ(std::abs(at[0] - before[0]) + std::abs(at[1] - before[1]), 1) << k;
    EXPECT_LE(std::max(std::abs(at[0]), std::abs(at[1])), reach);
    seen.insert(at);
    before = at;
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>((2 * reach + 1) * (2 * reach + 1)));
}

TEST(Drift, RestsWhileSomebodyIsThereAndWithoutReach) {
  Drift drift(8);
  EXPECT_FALSE(drift.advance(1000.0, 500.0));
  EXPECT_EQ(drift.wake_at_ms(500.0), 500.0 + drift_rest_ms);
  EXPECT_TRUE(drift.advance(500.0 + drift_rest_ms, 500.0));
  EXPECT_FALSE(drift.advance(600.0 + drift_rest_ms, 500.0)) << "not two at once";
  Drift none(0);
  EXPECT_EQ(none.wake_at_ms(0.0), input::never_ms);
  EXPECT_FALSE(none.advance(1e9, 0.0));
}

}  // namespace
}  // namespace lackwerk::kiosk
