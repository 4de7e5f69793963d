#include "kiosk/display/latency.hpp"

#include <gtest/gtest.h>

namespace lackwerk::kiosk {
namespace {

TEST(Latency, RunsFromTheOldestEventOfAPictureToItsFlip) {
  Latency latency;
  latency.input(1'010'000);
  latency.input(1'000'000);
  latency.handed_over();
  latency.input(1'020'000);  // too late for that picture
  latency.flipped(1'030'000, 20.0);
  const LatencySummary first = latency.summary();
  EXPECT_EQ(first.count, 1u);
  EXPECT_DOUBLE_EQ(first.median_ms, 30.0);
  EXPECT_DOUBLE_EQ(first.p95_frames, 1.5);
  latency.flipped(1'050'000, 20.0);  // nothing was handed over for it
  EXPECT_EQ(latency.summary().count, 1u);
  latency.handed_over();
  latency.flipped(1'060'000, 20.0);
  EXPECT_EQ(latency.summary().count, 2u);
  EXPECT_DOUBLE_EQ(latency.summary().p95_ms, 40.0);
}

TEST(Latency, APictureThatNeverFlippedHandsItsEventsOn) {
  Latency latency;
  latency.input(1'000'000);
  latency.handed_over();  // unplugged now
  latency.input(2'000'000);
  latency.handed_over();
  latency.flipped(3'000'000, 20.0);
  EXPECT_DOUBLE_EQ(latency.summary().median_ms, 2000.0);
}

TEST(Latency, EventsWithoutATimeAndEmptySummariesAreNothing) {
  Latency latency;
  latency.input(0);
  latency.handed_over();
  latency.flipped(1'000'000, 20.0);
  EXPECT_EQ(latency.summary().count, 0u);
  EXPECT_EQ(latency.summary().p95_ms, 0.0);
}

TEST(Latency, KeepsTheLastOnesOnly) {
  Latency latency;
  for (std::uint64_t k = 1; k <= 2 * Latency::kept; ++k) {
    latency.input(k * 1'000'000);
    latency.handed_over();
    latency.flipped(k * 1'000'000 + (k <= Latency::kept ? 500'000 : 10'000), 10.0);
  }
  EXPECT_EQ(latency.summary().count, 2 * Latency::kept);
  EXPECT_DOUBLE_EQ(latency.summary().p95_ms, 10.0);
}

}  // namespace
}  // namespace lackwerk::kiosk
