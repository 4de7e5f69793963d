// Energy of the reference integrator: what is lit evenly from everywhere gives back no more than it gets.
#include <gtest/gtest.h>

#include <cmath>

#include "core/environment.hpp"
#include "tests/unit/reference_scenes.hpp"

namespace lackwerk::core {
namespace {

using glm::dvec3;
using testing::Mesh;
using testing::options_of;
using testing::overall;
using testing::render;
using testing::sphere;
using testing::white;

class Furnace : public ::testing::TestWithParam<ReferenceVisibility> {};

TEST_P(Furnace, AWhiteSphereInUniformLightCannotBeSeen) {
  const Environment environment = uniform_environment(glm::vec3(1.0f));
  const Mesh ball = sphere(glm::vec3(0.0f), 100.0f, 48);
  const ReferenceScene scene{{{white()}}, {ball.spans(0)}, &environment, {}};
  ReferenceOptions options = options_of(24, 256);
  options.visibility = GetParam();
  const ReferenceImage image =
      render(scene, {{0, -400, 100}, {0, 0, 0}, 40.0}, {{}, 1.0, 1.0, 0.0, dvec3(1.0)}, options);
  const auto [mean, error] = overall(image);
  EXPECT_NEAR(mean.y, 1.0, 4.0 * error.y);
  EXPECT_LT(error.y, 1e-3);
  const double typical = error.y * std::sqrt(static_cast<double>(image.mean.size()));
  for (std::size_t k = 0; k < image.mean.size(); ++k) EXPECT_NEAR(image.mean[k].y, 1.0, 7.0 * typical) << k;
}

TEST_P(Furnace, AMirroringLobeGivesNoMoreThanItTakes) {
  const Environment environment = uniform_environment(glm::vec3(1.0f));
  const Mesh ball = sphere(glm::vec3(0.0f), 100.0f, 48);
  for (const double m : {0.02, 0.15, 0.6}) {
    AnalyticPaint mirror;
    mirror.lobes[0] = {dvec3(0.25), m, 1.0};
    const ReferenceScene scene{{{mirror}}, {ball.spans(0)}, &environment, {}};
    ReferenceOptions options = options_of(16, 256);
    options.visibility = GetParam();
    const ReferenceImage image = render(scene, {{0, -150, 20}, {0, 0, 0}, 20.0}, {}, options);
    const auto [mean, error] = overall(image);
    EXPECT_LE(mean.y, 1.0 + 4.0 * error.y) << m;
    // At near normal view V-cavities hide little: a narrow lobe keeps nearly all.
    EXPECT_GE(mean.y, m < 0.1 ? 0.99 : 0.6) << m;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Furnace, ::testing::Values(ReferenceVisibility::baked, ReferenceVisibility::traced),
                         [](const auto& info) {
                           return info.param == ReferenceVisibility::baked ? "Baked" : "Traced";
                         });

}  // namespace
}  // namespace lackwerk::core
