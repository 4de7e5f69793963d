// The report's picture, light and material knobs as a quick report measures them: everything is there, errors fall
// where they must, and the governor's table comes out of it. One test for each part: they share what took long to make.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kiosk/tools/report/light_knobs.hpp"
#include "kiosk/tools/report/material_knobs.hpp"
#include "kiosk/tools/report/picture_knobs.hpp"
#include "render_gles/governor.hpp"
#include "tests/render/support.hpp"

namespace lackwerk::report {
namespace {

const Knob& knob_of(const Findings& findings, const std::string& id) {
  static const Knob missing;
  const auto found =
      std::find_if(findings.knobs.begin(), findings.knobs.end(), [&](const Knob& knob) { return knob.id == id; });
  EXPECT_NE(found, findings.knobs.end()) << id;
  return found == findings.knobs.end() ? missing : *found;
}

double error_of(const Knob& knob, const std::string& label) {
  const auto found = std::find_if(knob.settings.begin(), knob.settings.end(),
                                  [&](const Setting& setting) { return setting.label == label; });
  EXPECT_NE(found, knob.settings.end()) << knob.id << ": " << label;
  return found == knob.settings.end() ? none : found->error;
}

/// What the page and the plots need of every knob.
void expect_whole(const Findings& findings) {
  for (const Knob& knob : findings.knobs) {
    SCOPED_TRACE(knob.id);
    EXPECT_FALSE(knob.title.empty() || knob.what.empty() || knob.error_unit.empty() || knob.time_of.empty());
    EXPECT_GT(knob.why.size(), 40u);
    int chosen = 0;
    for (std::size_t k = 0; k < knob.settings.size(); ++k) {
      const Setting& setting = knob.settings[k];
      SCOPED_TRACE(setting.label);
      chosen += setting.label == knob.chosen ? 1 : 0;
      EXPECT_TRUE(std::isfinite(setting.error) && setting.error >= 0.0);
      EXPECT_TRUE(std::isfinite(setting.p95) && setting.p95 >= 0.0);
      EXPECT_GE(setting.worst, setting.p95);
      EXPECT_GT(setting.time.median_ms, 0.0);
      EXPECT_GE(setting.time.count, 1);
      EXPECT_FALSE(setting.line.empty());
      for (std::size_t other = 0; other < k; ++other) EXPECT_NE(knob.settings[other].label, setting.label);
    }
    EXPECT_EQ(chosen, 1) << knob.chosen;
  }
}

TEST(ReportPictures, MeasureTheLadderTheStillAndTheLight) {
  std::string reason;
  if (!test::open_context(gles::Backend::egl_surfaceless, reason) && !test::open_context(gles::Backend::osmesa, reason))
    GTEST_SKIP() << reason;
  Workbench bench(true);
  std::vector<double> progress;
  bench.on_progress = [&](double fraction) { progress.push_back(fraction); };
  Findings findings;
  const auto added = add_pictures(bench, findings);
  ASSERT_TRUE(added) << added.error().line();
  expect_whole(findings);
  ASSERT_FALSE(progress.empty());
  EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end()));
  EXPECT_EQ(progress.back(), 1.0);

  const Knob& quality = knob_of(findings, "quality");
  EXPECT_NE(gles::find_rung(quality.chosen), nullptr);
  // Half the resolution is seen in any view.
  EXPECT_GT(error_of(quality, "scale 0.5"), error_of(quality, "best"));
  const auto table = quality_table_of(findings);
  ASSERT_TRUE(table) << table.error().line();
  EXPECT_FALSE(table->renderer.empty());
  for (std::size_t k = 0; k < gles::rung_count; ++k) {
    EXPECT_EQ(table->rungs[k].name, gles::quality_ladder()[k].name);
    EXPECT_EQ(table->rungs[k].error_mean, error_of(quality, table->rungs[k].name));
  }
  EXPECT_TRUE(kiosk::check_quality_table(*table, ""));

  const Knob& still = knob_of(findings, "still");
  EXPECT_LT(error_of(still, "32"), error_of(still, "8"));
  EXPECT_LT(error_of(still, "8"), error_of(still, "1"));
  EXPECT_EQ(error_of(still, "1"), error_of(quality, "best")) << "the same picture";
  const Knob& light = knob_of(findings, "light_path");
  EXPECT_LT(error_of(light, "16 lights"), error_of(light, "1 light") + 1e-9);
}

TEST(ReportLight, ErrorsFallWithLightsTexelsAndSamples) {
  Workbench bench(true);
  Findings findings;
  const auto added = add_light(bench, findings);
  ASSERT_TRUE(added) << added.error().line();
  expect_whole(findings);
  const Knob& cut = knob_of(findings, "cut_lights");
  for (int count = 4; count <= 256; count *= 4)
    EXPECT_LT(error_of(cut, std::to_string(count)), 0.5 * error_of(cut, std::to_string(count / 4))) << count;
  for (const Setting& setting : cut.settings) EXPECT_EQ(setting.eligible, setting.value <= 64.0) << setting.label;
  const Knob& environment = knob_of(findings, "environment");
  EXPECT_LT(error_of(environment, "mirror, 512"), error_of(environment, "mirror, 128"));
  EXPECT_LT(error_of(environment, "lobe of m 0.0400, 96"), error_of(environment, "lobe of m 0.0400, 24"));
  const Knob& coat = knob_of(findings, "coat");
  EXPECT_LT(error_of(coat, "128"), error_of(coat, "16"));
  EXPECT_LT(error_of(coat, "16"), error_of(coat, "1"));
}

TEST(ReportMaterials, SamplesConvergeAndTheFullTableBeatsTheMaps) {
  Workbench bench(true);
  Findings findings;
  const auto added = add_materials(bench, findings);
  ASSERT_TRUE(added) << added.error().line();
  expect_whole(findings);
  const Knob& samples = knob_of(findings, "ggx_samples");
  EXPECT_LT(error_of(samples, "256"), error_of(samples, "16"));
  EXPECT_LT(error_of(samples, "1536"), error_of(samples, "256"));
  const Knob& map = knob_of(findings, "isochromatic");
  EXPECT_LT(error_of(map, "A, 64"), error_of(map, "B, 64"));
  EXPECT_LT(error_of(map, "45 x 45 x 90"), error_of(map, "A, 64"));
  EXPECT_LT(error_of(map, "45 x 45 x 90"), error_of(map, "C, 64"));
}

}  // namespace
}  // namespace lackwerk::report
