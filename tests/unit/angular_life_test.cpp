// How long flakes shine: measured on pictures, fitted, and met by what is shown.
#include "core/analysis/angular_life.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "packs/paint_pack_codec.hpp"
#include "packs/paint_pack_generated.h"
#include "packs/tools/flake_life.hpp"
#include "packs/tools/pack_builder.hpp"
#include "tests/unit/pack_samples.hpp"
#include "tests/unit/random_flakes.hpp"

namespace lackwerk {
namespace {

using core::LifeCurve;

/// Two levels of grey: `rare` of 10,000 texels are bright.
std::vector<core::LabCuboid> flakes(std::uint32_t rare) {
  return {{glm::vec3(5, 0, 0), glm::vec3(5, 0, 0), 10000 - rare}, {glm::vec3(90, 0, 0), glm::vec3(90, 0, 0), rare}};
}

/// Pictures of mirrors whose normals are scattered over 60 degrees; each shines while theta_h is within half a life.
std::vector<std::vector<float>> window_pictures(double life_deg, double step_deg, int pictures) {
  std::mt19937 random(5);
  std::vector<double> tilt(20000);
  for (double& t : tilt) t = core::testing::uniform(random, -20.0, 40.0);
  std::vector<std::vector<float>> out;
  for (int k = 0; k < pictures; ++k) {
    out.emplace_back();
    for (const double t : tilt) out.back().push_back(std::abs(t - k * step_deg) < 0.5 * life_deg ? 1.0f : 0.0f);
  }
  return out;
}

TEST(AngularLife, CorrelationIsPearsons) {
  const std::vector<float> a{1, 2, 3, 4}, b{2, 4, 6, 8}, c{4, 3, 2, 1}, flat{7, 7, 7, 7}, even{1, -1, -1, 1};
  EXPECT_NEAR(core::texel_correlation(a, b), 1.0, 1e-12);
  EXPECT_NEAR(core::texel_correlation(a, c), -1.0, 1e-12);
  EXPECT_NEAR(core::texel_correlation(a, even), 0.0, 1e-12);
  EXPECT_EQ(core::texel_correlation(a, flat), 0.0);
}

TEST(AngularLife, WindowsHaveATriangleForTheirCurve) {
  // A window of width w overlaps its copy at lag d by 1 - d/w. A tenth of the mirrors shine; Pearson's takes that
  // chance overlap off: (1 - d/w - 0.1) / 0.9 is 1/2 at 0.45 w.
  const LifeCurve curve = core::life_curve(window_pictures(6.0, 0.5, 40), 0.5, 20);
  ASSERT_EQ(curve.correlation.size(), 21u);
  EXPECT_EQ(curve.correlation[0], 1.0);
  EXPECT_NEAR(core::half_width_deg(curve), 2.7, 0.1);
  EXPECT_NEAR(curve.correlation[14], -0.11, 0.03);
  EXPECT_EQ(core::half_width_deg({1.0, {1.0, 0.9, 0.8}}), 90.0);
  EXPECT_NEAR(core::half_width_deg({2.0, {1.0, 0.75, 0.25}}), 3.0, 1e-12);
}

TEST(AngularLife, RareFlakesLiveShorterInACell) {
  // Two levels of equal number: the arc-sine law, correlation 2/pi asin(r); r = cos(pi d/2) inside a cell gives a
  // straight line 1 - d there, and crossing a border keeps more. Rarer ones are lost sooner.
  const std::vector<std::vector<core::LabCuboid>> even{flakes(5000)}, few{flakes(500)}, rare{flakes(10)}, none{{}};
  const double cells_even = core::half_width_in_cells(even), cells_few = core::half_width_in_cells(few);
  EXPECT_GT(cells_even, 0.5);
  EXPECT_LT(cells_even, 0.7);
  EXPECT_LT(cells_few, cells_even);
  EXPECT_LT(core::half_width_in_cells(rare), cells_few);
  EXPECT_GT(core::half_width_in_cells(rare), 0.2);
  const std::vector<std::vector<core::LabCuboid>> plain{{{glm::vec3(5), glm::vec3(5), 100}}};
  EXPECT_EQ(core::half_width_in_cells(plain), 1.0);
}

TEST(AngularLife, FitScalesTheCellToTheLife) {
  const std::vector<std::vector<core::LabCuboid>> slices{flakes(300), flakes(200)};
  const double cells = core::half_width_in_cells(slices);
  const core::FlakeLife life = core::fit_life(2.6, 90.0, slices, core::LifeOrigin::fine);
  EXPECT_NEAR(static_cast<double>(life.cell_h_deg), 2.6 / cells, 1.0 / 32.0);
  EXPECT_EQ(life.cell_i_deg, core::widest_cell_deg);
  EXPECT_EQ(life.origin, core::LifeOrigin::fine);
  EXPECT_EQ(core::fit_life(0.01, 80.0, slices, core::LifeOrigin::slices).cell_h_deg, 1.0f);
  EXPECT_EQ(core::fit_life(0.01, 80.0, slices, core::LifeOrigin::slices).cell_i_deg, core::widest_cell_deg);
}

TEST(AngularLife, DiscsOverlapByHalfAtTheStatedLag) {
  const double d = core::half_width_of_life(1.0);
  EXPECT_NEAR(2.0 / std::numbers::pi * (std::acos(d) - d * std::sqrt(1.0 - d * d)), 0.5, 1e-5);
}

class DemoPaint : public ::testing::TestWithParam<const char*> {};

// What the whole chain is for: the shown flakes twinkle as fast as the source's, for each demo paint.
TEST_P(DemoPaint, ShownFlakesLiveAsLongAsTheSources) {
  const auto recipe = packs::read_recipe(std::string(LACKWERK_SOURCE_DIR) + "/packs/recipes/" + GetParam() + ".toml");
  ASSERT_TRUE(recipe) << recipe.error().line();
  packs::GoniometerSettings settings;
  settings.edge_texels = 96;
  std::vector<packs::Capture> captures;
  captures.push_back(*packs::measure(*recipe, settings));
  ASSERT_TRUE(captures[0].life);
  // The lamp's cone lets a flake shine over 6.5 degrees at most; along theta_i it stays.
  EXPECT_NEAR(captures[0].life->half_h_deg, core::half_width_of_life(6.5), 0.08);
  EXPECT_EQ(captures[0].life->half_i_deg, 90.0);
  const auto built = packs::build_pack(captures, {});
  ASSERT_TRUE(built) << built.error().line();
  const core::InterpolatablePaint paint = built->data.view();
  EXPECT_EQ(paint.paints[0].life.origin, core::LifeOrigin::fine);
  EXPECT_EQ(paint.paints[0].life.cell_i_deg, core::widest_cell_deg);

  const auto source = packs::source_curve(*recipe, settings, packs::life_scan_h);
  ASSERT_TRUE(source);
  const LifeCurve shown = packs::reconstruction_curve(paint, 0, packs::life_scan_h, 64);
  const double ratio = core::half_width_deg(shown) / core::half_width_deg(*source);
  std::printf("  cells of %.2f degrees; half widths %.2f (source) and %.2f (shown), ratio %.3f\n",
              static_cast<double>(paint.paints[0].life.cell_h_deg), core::half_width_deg(*source),
              core::half_width_deg(shown), ratio);
  EXPECT_GT(ratio, 0.8);
  EXPECT_LT(ratio, 1.2);
  // What the place inside the cuboid, which stays with the texel, leaves over for ever.
  EXPECT_LT(shown.correlation.back(), 0.03);
}

INSTANTIATE_TEST_SUITE_P(Recipes, DemoPaint,
                         ::testing::Values("gu_polaris_silber_coated", "gu_ford_f8_coated", "pearl_green_violet"),
                         [](const auto& info) { return std::string(info.param); });

TEST(FlakeLife, SlicesTellOnlyLongLives) {
  packs::Capture capture;
  capture.layout = core::axf_layout();
  capture.edge_texels = 40;
  const auto fill = [&](double life_deg) {
    std::mt19937 random(9);
    std::vector<double> tilt(1600);
    for (double& t : tilt) t = core::testing::uniform(random, -30.0, 60.0);
    capture.slices.assign(static_cast<std::size_t>(capture.layout.slice_count()), {});
    for (int slice = 0; slice < capture.layout.slice_count(); ++slice)
      for (const double t : tilt)
        capture.slices[static_cast<std::size_t>(slice)].texels.emplace_back(
            std::abs(t - 7.5 * capture.layout.node_of(slice).bin_h) < 0.5 * life_deg ? 1.0f : 0.01f);
  };
  fill(6.0);  // gone within a bin
  packs::KnownLife known = packs::known_life(capture);
  EXPECT_EQ(known.origin, core::LifeOrigin::assumed);
  EXPECT_NEAR(known.life.half_h_deg, 2.626, 0.001);
  EXPECT_EQ(known.life.half_i_deg, 90.0);
  fill(24.0);
  known = packs::known_life(capture);
  EXPECT_EQ(known.origin, core::LifeOrigin::slices);
  EXPECT_NEAR(known.life.half_h_deg, 10.5, 2.5);
  EXPECT_EQ(known.life.half_i_deg, 90.0) << "the same flakes at all theta_i";
  capture.life = packs::MeasuredLife{2.0, 33.0};
  known = packs::known_life(capture);
  EXPECT_EQ(known.origin, core::LifeOrigin::fine);
  EXPECT_EQ(known.life, *capture.life);
}

// A pack as an older program wrote it has no such field: its entry in the table of fields is 0.
TEST(FlakeLife, PacksWithoutItGetTheDefault) {
  const testing::SamplePack sample(1);
  std::vector<std::uint8_t> bytes = packs::encode_paint_pack(sample.contents);
  const auto with = packs::decode_paint_pack(bytes, "p.lwp");
  ASSERT_TRUE(with);
  EXPECT_EQ(with->paint.paints[0].life, sample.contents.paint.paints[0].life);
  const auto* paint = reinterpret_cast<const std::uint8_t*>(packs::fb::GetPaintPack(bytes.data())->paints()->Get(0));
  std::int32_t to_fields = 0;
  std::memcpy(&to_fields, paint, sizeof to_fields);
  const std::ptrdiff_t entry = paint - bytes.data() - to_fields + packs::fb::Paint::VT_LIFE;
  bytes[static_cast<std::size_t>(entry)] = bytes[static_cast<std::size_t>(entry) + 1] = 0;
  const auto without = packs::decode_paint_pack(bytes, "p.lwp");
  ASSERT_TRUE(without) << without.error().line();
  EXPECT_EQ(without->paint.paints[0].life, core::FlakeLife{});
  EXPECT_EQ(without->paint.paints[0].life.origin, core::LifeOrigin::assumed);
  EXPECT_NEAR(without->paint.flake_cells_per_bin()[0], 7.5 / 4.75, 1e-6);
}

}  // namespace
}  // namespace lackwerk
