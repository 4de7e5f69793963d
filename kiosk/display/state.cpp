#include "kiosk/display/state.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/check.hpp"
#include "core/realise.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr float lowest_elevation_deg = -10.0f;
constexpr float highest_elevation_deg = 85.0f;
/// The eye stays this far above the floor, so that the floor never covers the picture.
constexpr float lowest_eye_mm = 60.0f;
constexpr float nearest_share = 0.1f;
constexpr float farthest_share = 3.0f;

}  // namespace

core::Weights first_paint(int paint_count) {
  std::vector<double> w(static_cast<std::size_t>(paint_count), 0.0);
  w.front() = 1.0;
  return core::Weights::uniform(w);
}

State::State(int paint_count, std::vector<packs::Camera> cameras)
    : paint_count_(static_cast<std::size_t>(paint_count)),
      cameras_(std::move(cameras)),
      weights_(first_paint(paint_count)),
      camera_((check_at_most(std::size_t{1}, cameras_.size(), "a scene has a camera"), cameras_.front())),
      home_distance_mm_(glm::length(camera_.eye_mm - camera_.target_mm)) {}

bool State::set_weights(std::vector<double>& group, const std::vector<double>& values) const {
  if (values.size() != paint_count_ || values == group) return false;
  double sum = 0.0;
  for (const double value : values) sum += value;
  // A NaN fails this comparison too.
  if (!(std::abs(sum - 1.0) <= core::weight_sum_tolerance)) return false;
  group = values;
  return true;
}

void State::orbit(double azimuth_deg, double elevation_deg) {
  const glm::vec3 from_target = camera_.eye_mm - camera_.target_mm;
  const float distance = glm::length(from_target);
  const float azimuth = std::atan2(from_target.y, from_target.x) + glm::radians(static_cast<float>(azimuth_deg));
  const float elevation =
      std::clamp(glm::degrees(std::asin(from_target.z / distance)) + static_cast<float>(elevation_deg),
                 lowest_elevation_deg, highest_elevation_deg);
  const float e = glm::radians(elevation);
  camera_.eye_mm = camera_.target_mm +
                   distance * glm::vec3(std::cos(e) * std::cos(azimuth), std::cos(e) * std::sin(azimuth), std::sin(e));
  camera_.eye_mm.z = std::max(camera_.eye_mm.z, lowest_eye_mm);
}

void State::zoom(double factor) {
  const glm::vec3 from_target = camera_.eye_mm - camera_.target_mm;
  const float distance = glm::length(from_target);
  const float wanted = std::clamp(distance * static_cast<float>(factor), home_distance_mm_ * nearest_share,
                                  home_distance_mm_ * farthest_share);
  camera_.eye_mm = camera_.target_mm + from_target * (wanted / distance);
  camera_.eye_mm.z = std::max(camera_.eye_mm.z, lowest_eye_mm);
}

State::Changes State::apply(const input::Control& event) {
  using input::ControlKind;
  Changes changes;
  const glm::vec3 eye_before = camera_.eye_mm;
  switch (event.kind) {
    case ControlKind::weights: {
      const bool base = set_weights(weights_.base, event.values);
      const bool lightness = set_weights(weights_.flake_lightness, event.values);
      const bool colour = set_weights(weights_.flake_colour, event.values);
      changes.weights = base || lightness || colour;
      break;
    }
    case ControlKind::base:
      changes.weights = set_weights(weights_.base, event.values);
      break;
    case ControlKind::flake_lightness:
      changes.weights = set_weights(weights_.flake_lightness, event.values);
      break;
    case ControlKind::flake_colour:
      changes.weights = set_weights(weights_.flake_colour, event.values);
      break;
    case ControlKind::camera: {
      const auto found =
          std::find_if(cameras_.begin(), cameras_.end(), [&](const packs::Camera& c) { return c.name == event.name; });
      if (found == cameras_.end()) break;
      changes.view = found->eye_mm != camera_.eye_mm || found->target_mm != camera_.target_mm ||
                     found->vertical_fov_deg != camera_.vertical_fov_deg;
      camera_ = *found;
      home_distance_mm_ = glm::length(camera_.eye_mm - camera_.target_mm);
      return changes;
    }
    case ControlKind::orbit:
      if (event.values.size() == 2 && std::isfinite(event.values[0]) && std::isfinite(event.values[1]))
        orbit(event.values[0], event.values[1]);
      break;
    case ControlKind::zoom:
      if (event.values.size() == 1 && std::isfinite(event.values[0]) && event.values[0] > 0.0) zoom(event.values[0]);
      break;
    case ControlKind::turn:
    case ControlKind::press:
    case ControlKind::release:
    case ControlKind::touch_down:
    case ControlKind::touch_move:
    case ControlKind::touch_up:
    case ControlKind::touch_cancel:
      break;  // what these mean is for Gestures to say
  }
  changes.view = camera_.eye_mm != eye_before;
  return changes;
}

}  // namespace lackwerk::kiosk
