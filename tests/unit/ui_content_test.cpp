// What the interface is told about a pack.
#include "kiosk/display/ui/content.hpp"

#include <gtest/gtest.h>

#include "core/character.hpp"
#include "core/colour.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::kiosk::ui {
namespace {

using lackwerk::testing::SamplePack;
using lackwerk::testing::TemporaryFolder;

packs::PaintPack opened(const SamplePack& sample) {
  const TemporaryFolder folder;
  EXPECT_TRUE(packs::write_paint_pack(folder / "p.lwp", sample.contents));
  auto pack = packs::PaintPack::open(folder / "p.lwp", packs::Backing::copy);
  EXPECT_TRUE(pack) << (pack ? "" : pack.error().line());
  return std::move(*pack);
}

TEST(UiContent, IsThatOfThePack) {
  SamplePack sample(3);
  sample.contents.info.beyond_limit = 0.25;
  const packs::PaintPack pack = opened(sample);
  const Content content = ui_content(pack);
  EXPECT_EQ(content.pack_id, "sample");
  EXPECT_EQ(content.serial, 42u);
  EXPECT_EQ(content.beyond_limit, 0.25);
  EXPECT_TRUE(content.has_flakes);
  ASSERT_EQ(content.paints.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(content.paints[k].identity, sample.contents.paint.paints[k].identity);
    std::vector<double> one(3, 0.0);
    one[k] = 1.0;
    EXPECT_EQ(content.paints[k].lively, core::liveliness(pack.paint(), core::Weights::uniform(one)));
    for (const double value : content.paints[k].srgb) {
      EXPECT_GE(value, 0.0);
      EXPECT_LE(value, 1.0);
    }
  }
}

TEST(UiContent, ShowsAPlainPaintsColour) {
  SamplePack sample(1);
  core::InterpolatablePaint& paint = sample.contents.paint;
  paint = {{paint.paints[0]}, {}, 0, 0.0f, 0, {}, {}, {}, 0, 0};
  auto& part = paint.paints[0];
  part.cluster_begin = {};
  part.clusters = {};
  part.tuple_cluster = {};
  part.analytic = {};
  part.analytic.diffuse = {0.5, 0.25, 2.0};
  sample.contents.info.errors = {{}};
  const Content content = ui_content(opened(sample));
  EXPECT_FALSE(content.has_flakes);
  EXPECT_EQ(content.paints[0].lively, 0.0);
  EXPECT_NEAR(content.paints[0].srgb[0], core::srgb_encode(0.5), 1e-6);
  EXPECT_NEAR(content.paints[0].srgb[1], core::srgb_encode(0.25), 1e-6);
  EXPECT_NEAR(content.paints[0].srgb[2], 1.0, 1e-9) << "brighter than the display";
}

}  // namespace
}  // namespace lackwerk::kiosk::ui
