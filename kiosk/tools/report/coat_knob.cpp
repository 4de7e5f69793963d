#include "kiosk/tools/report/coat_knob.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <utility>
#include <vector>

#include "core/colour.hpp"
#include "core/paint_model.hpp"
#include "render_gles/renderer.hpp"
#include "render_gles/view.hpp"

namespace lackwerk::report {
namespace {

using glm::dvec2;
using glm::dvec3;

/// Curved as a wing is: some 300 mm of radius, where a pixel of a whole car at 1280 x 720 is 5 mm wide.
constexpr double radius_px = 60.0;
/// Of a grey that a white room would show at 18 %: differences of the mirror image count as they do on a body.
constexpr double body = 0.18;
constexpr double coat_ior = 1.5;

class MirrorBall {
 public:
  explicit MirrorBall(const core::Environment& environment) {
    model_.environment = &environment;
    model_.u_environment_scale = static_cast<double>(environment.range);
    // Whole pixels inside, without the outermost: a pixel that is cut by the outline is no question of the coat.
    constexpr int last = static_cast<int>(radius_px);
    for (int y = -last; y <= last; ++y)
      for (int x = -last; x <= last; ++x)
        if (std::hypot(std::abs(x) + 1.0, std::abs(y) + 1.0) < radius_px) pixels_.emplace_back(x, y);
  }
  [[nodiscard]] std::size_t pixel_count() const { return pixels_.size(); }

  /// All pixels, scene-linear: the mean over `offsets` of one look-up each, in pixels from the middle. `level`: 0, the
  /// map itself; below 0, the level as wide as what the pixel sees.
  [[nodiscard]] std::vector<dvec3> picture(const std::vector<dvec2>& offsets, double level) {
    std::vector<dvec3> out;
    out.reserve(pixels_.size());
    for (const dvec2& pixel : pixels_) {
      dvec3 sum(0.0);
      for (const dvec2& offset : offsets) sum += at(pixel + offset, level);
      out.push_back(sum / static_cast<double>(offsets.size()));
    }
    return out;
  }

 private:
  /// Seen from far away: the eye stands at +z, which is up in the room of the picture's side view: towards -y.
  [[nodiscard]] dvec3 at(const dvec2& place, double level) {
    const dvec2 xy = place / radius_px;
    const double nz = std::sqrt(std::max(0.0, 1.0 - xy.x * xy.x - xy.y * xy.y));
    const dvec3 mirrored(2.0 * nz * xy.x, 2.0 * nz * xy.y, 2.0 * nz * nz - 1.0);
    const dvec3 in_room(mirrored.x, -mirrored.z, mirrored.y);
    if (level < 0.0) {
      // A pixel turns the normal by 1 / (r nz) along the radius, the mirrored direction by twice that. A square so wide
      // has a standard deviation of width / sqrt(6), a level of roughness m one of 1.4 m.
      const double width = 2.0 / (radius_px * std::max(nz, 0.05));
      level = core::environment_level_of(width / (std::sqrt(6.0) * 1.4));
    }
    return dvec3(body) + model_.environment_at(in_room, level) * model_.fresnel_dielectric(nz, coat_ior);
  }

  core::PaintModel<double> model_;
  std::vector<dvec2> pixels_;
};

void judge(const std::vector<dvec3>& shown, const std::vector<dvec3>& truth, Setting& setting) {
  std::vector<double> all;
  all.reserve(truth.size());
  const auto lab = [](const dvec3& linear) { return core::lab_from_linear(glm::min(linear, dvec3(1.0))); };
  for (std::size_t k = 0; k < truth.size(); ++k) all.push_back(core::ciede2000(lab(shown[k]), lab(truth[k])));
  set_errors(setting, std::move(all));
}

std::vector<dvec2> jitter(int count) {
  std::vector<dvec2> out;
  out.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) out.emplace_back(gles::halton_jitter(k));
  return out;
}

/// The middles of edge x edge cells.
std::vector<dvec2> grid(int edge) {
  std::vector<dvec2> out;
  out.reserve(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge));
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) out.emplace_back((x + 0.5) / edge - 0.5, (y + 0.5) / edge - 0.5);
  return out;
}

}  // namespace

Result<Knob> coat_knob(Workbench& bench) {
  const auto car = bench.car();
  if (!car) return tl::unexpected(car.error());
  MirrorBall ball((*car)->environment);
  Knob knob;
  knob.id = "coat";
  knob.title = "Look-ups of the coat's mirror image";
  knob.what = "The studio in the clear coat of a ball of " + digits(radius_px) +
              " pixels' radius, curved as a car's wing: look-ups a pixel of the map itself, one a frame, spread as the "
              "still picture spreads them; and one look-up of the prefiltered level that fits the pixel.";
  knob.error_unit = "CIEDE2000 against the mean over the whole pixel";
  knob.time_of = std::to_string(ball.pixel_count()) + " pixels on the CPU, one core";
  const int fine = bench.choose(40, 24);
  const std::vector<dvec3> truth = ball.picture(grid(fine), 0.0);
  const auto add = [&](std::string label, std::string line, int count, double level) {
    Setting setting;
    setting.label = std::move(label);
    setting.line = std::move(line);
    setting.value = count;
    const std::vector<dvec2> offsets = jitter(count);
    std::vector<dvec3> shown;
    setting.time = bench.time([&] { shown = ball.picture(offsets, level); }, 300.0, 3, 20);
    judge(shown, truth, setting);
    knob.settings.push_back(std::move(setting));
  };
  const int most = bench.choose(256, gles::still_frames);
  for (int count = 1; count <= most; count *= 2) add(std::to_string(count), "the map itself", count, 0.0);
  add("1, prefiltered", "prefiltered", 1, -1.0);
  knob.chosen = std::to_string(gles::still_frames);
  const auto of = [&](const std::string& label) -> const Setting& {
    return *std::find_if(knob.settings.begin(), knob.settings.end(),
                         [&](const Setting& setting) { return setting.label == label; });
  };
  const Setting &one = knob.settings.front(), &filtered = knob.settings.back(), &chosen = of(knob.chosen);
  knob.why = "A resting picture has one look-up in each of its " + knob.chosen + " frames: off by " +
             digits(chosen.error) + " in the mean, from " + digits(of("8").error) +
             " with 8. A moving picture has one: " + digits(one.error) + " (95 %: " + digits(one.p95) +
             "). One look-up of a prefiltered level would be off by " + digits(filtered.error) +
             " (95 %: " + digits(filtered.p95) +
             "), for one lobe is round where a pixel of a curved body is not. The truth is the "
             "mean of " +
             std::to_string(fine * fine) + " look-ups.";
  return knob;
}

}  // namespace lackwerk::report
