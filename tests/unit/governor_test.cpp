// The governor holds a frame time on machines of any speed. Time is what the test says it is.
#include "render_gles/governor.hpp"

#include <gtest/gtest.h>

namespace lackwerk::gles {
namespace {

/// A machine on which the first rung takes `best_ms`, and the others what the ladder promises.
double frame_ms(const Governor& governor, double best_ms) { return best_ms * governor.rung().cost; }

void run(Governor& governor, double best_ms, int frames) {
  for (int k = 0; k < frames; ++k) governor.measured(frame_ms(governor, best_ms));
}

TEST(Governor, StaysWithTheBestWhereThereIsTime) {
  Governor governor(62.0);
  run(governor, 8.0, 1000);
  EXPECT_EQ(governor.rung().name, "best");
}

TEST(Governor, HoldsTheFrameTimeOnSlowMachines) {
  for (const double best_ms : {70.0, 90.0, 120.0, 200.0}) {
    Governor governor(62.0);
    run(governor, best_ms, 12);
    const bool last = governor.index() + 1 == static_cast<int>(quality_ladder().size());
    EXPECT_TRUE(frame_ms(governor, best_ms) <= 62.0 || last) << best_ms << " ms: " << governor.rung().name;
    EXPECT_GT(governor.index(), 0);
  }
}

TEST(Governor, OneLateFrameChangesNothing) {
  Governor governor(62.0);
  run(governor, 40.0, 10);
  governor.measured(500.0);
  run(governor, 40.0, 10);
  EXPECT_EQ(governor.index(), 0);
}

TEST(Governor, GoesUpWhenThereIsLastingRoomAndNotToAndFro) {
  Governor governor(62.0, 4);
  run(governor, 20.0, 1000);
  EXPECT_EQ(governor.index(), 0);

  // A machine on which the ladder's promise is wrong: the better rung is always late.
  Governor torn(62.0, 1);
  int changes = 0;
  for (int k = 0; k < 3000; ++k) changes += torn.measured(torn.index() == 0 ? 90.0 : 45.0) ? 1 : 0;
  EXPECT_LE(changes, 14) << "every failed attempt doubles the patience";
}

TEST(Governor, TheBuiltInTableIsTheLadders) {
  const RungCosts costs = RungCosts::built_in();
  EXPECT_EQ(costs.cost.front(), 1.0);
  for (std::size_t k = 0; k < rung_count; ++k) {
    EXPECT_EQ(costs.cost[k], quality_ladder()[k].cost);
    EXPECT_EQ(costs.error[k], quality_ladder()[k].error);
    EXPECT_FALSE(costs.dominated(static_cast<int>(k)));
  }
}

TEST(Governor, EveryRungIsCheaperAndCanBeFound) {
  double before = 2.0;
  for (const Rung& rung : quality_ladder()) {
    EXPECT_LT(rung.cost, before) << rung.name;
    before = rung.cost;
    ASSERT_NE(find_rung(rung.name), nullptr);
    EXPECT_EQ(find_rung(rung.name)->quality, rung.quality);
  }
  EXPECT_EQ(find_rung("nothing"), nullptr);
}

}  // namespace
}  // namespace lackwerk::gles
