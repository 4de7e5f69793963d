#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/analysis/environment_build.hpp"
#include "core/analysis/environment_latlong.hpp"
#include "kiosk/tools/report/stiff_numbers.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

namespace {

constexpr const char* kernel = "environment";
constexpr int width = 256, height = 128;

core::LatLongMap map_of(float everywhere) {
  return {"stiff", width, height, std::vector<glm::vec3>(std::size_t{width} * height, glm::vec3(everywhere))};
}

glm::dvec3 light_of(const core::LatLongMap& map) {
  glm::dvec3 sum(0.0);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      sum += glm::dvec3(map.pixels[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)]) *
             core::pixel_solid_angle(map, y);
  return sum;
}

double off(const glm::dvec3& light, const glm::dvec3& wanted) {
  double worst = 0.0;
  for (int c = 0; c < 3; ++c) {
    const double error = std::abs(light[c] - wanted[c]) / std::max(wanted[c], 1e-12);
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

/// Light of the levels and of the cut against that of the map, relative.
void judge(const std::string& name, const core::LatLongMap& map, Findings& findings) {
  const core::Environment environment = core::build_environment(map, {0.0f, glm::vec3(0.0f)});
  const glm::dvec3 wanted = light_of(map);
  double levels = 0.0;
  int at = 0;
  for (const int level : {0, 1, 4, 9}) {
    const double error = off(core::sphere_integral(core::shown_means(environment, level)), wanted);
    if (error <= levels) continue;
    levels = error;
    at = level;
  }
  // Eight bits under a square: the fit of texels keeps 0.2 % of a room's light; a single lamp leaves it one texel to
  // do so.
  add_case(findings, kernel, name, "light of the levels off the map's, relative", levels, 0.01,
           "level " + std::to_string(at));
  glm::dvec3 cut(0.0);
  for (const core::EnvironmentLight& light : environment.lights) cut += glm::dvec3(light.radiance) * std::numbers::pi;
  add_case(findings, kernel, name, "light of the 64 lights off the map's, relative", off(cut, wanted), 0.01);
}

}  // namespace

void add_stiff_light(bool quick, Findings& findings) {
  core::LatLongMap sun = map_of(0.0f);
  sun.pixels[std::size_t{30} * width + 77] = glm::vec3(1e6f, 9e5f, 8e5f);
  judge("one texel of 1e6 in the dark", sun, findings);
  if (!quick) {
    core::LatLongMap day = map_of(0.5f);
    day.pixels[std::size_t{20} * width + 200] = glm::vec3(1e6f);
    judge("one texel of 1e6 by day", day, findings);
  }

  const core::Environment black = core::build_environment(map_of(0.0f), {0.0f, glm::vec3(0.0f)});
  glm::dvec3 light = core::sphere_integral(core::shown_means(black, 5));
  for (const core::EnvironmentLight& one : black.lights) light += glm::dvec3(one.radiance);
  add_case(findings, kernel, "a black map", "light from nothing",
           std::abs(light.x) + std::abs(light.y) + std::abs(light.z), 0.0);

  core::LatLongMap holed = map_of(0.5f);
  holed.pixels[std::size_t{64} * width + 10].y = std::numeric_limits<float>::quiet_NaN();
  holed.pixels[std::size_t{64} * width + 11].x = std::numeric_limits<float>::infinity();
  holed.pixels[std::size_t{65} * width + 10].z = -3.0f;
  const auto mended = core::repair(holed);
  int bad = mended ? 0 : 1;
  for (const glm::vec3& pixel : holed.pixels)
    for (int c = 0; c < 3; ++c)
      if (!(pixel[c] >= 0.0f && std::isfinite(pixel[c]))) ++bad;
  add_case(findings, kernel, "texels that are no number, infinite, negative", "texels left as they were", bad, 0.0,
           mended ? "mended, and counted for who asks" : "refused");
}

}  // namespace lackwerk::report
