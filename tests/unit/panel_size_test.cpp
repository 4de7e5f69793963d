// What a panel says of its size, and what of it is believed.
#include "kiosk/display/panel_size.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace lackwerk::kiosk {
namespace {

TEST(PanelSize, RealPanelsHaveTheirDensity) {
  EXPECT_NEAR(panel_dpi({1920, 1080}, {344, 194}), 141.5, 0.5) << "15.6 inches";
  EXPECT_NEAR(panel_dpi({1920, 1080}, {1210, 680}), 40.3, 0.5) << "a TV of 55 inches that tells the truth";
  EXPECT_NEAR(panel_dpi({1080, 1920}, {194, 344}), 141.5, 0.5) << "built upright";
  EXPECT_NEAR(panel_dpi({800, 480}, {154, 86}), 136.8, 1.0) << "7 inches";
}

TEST(PanelSize, NonsenseIsNotBelieved) {
  constexpr int most = std::numeric_limits<int>::max();
  for (const std::array<int, 2> mm :
       {std::array{0, 0}, std::array{344, 0}, std::array{-344, -194}, std::array{160, 90}, std::array{160, 100},
        std::array{16, 9}, std::array{1600, 900}, std::array{90, 160}, std::array{344, 344}, std::array{1, 1},
        std::array{40, 22}, std::array{3200, 1800}, std::array{most, most}})
    EXPECT_EQ(panel_dpi({1920, 1080}, mm), 0.0) << mm[0] << " x " << mm[1];
  EXPECT_EQ(panel_dpi({1024, 768}, {344, 194}), 0.0) << "stretched";
  EXPECT_EQ(panel_dpi({0, 0}, {344, 194}), 0.0);
}

}  // namespace
}  // namespace lackwerk::kiosk
