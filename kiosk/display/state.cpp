#include "kiosk/display/state.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "core/realise.hpp"

namespace lackwerk::kiosk {
namespace {

bool is_number(const std::vector<double>& values) { return values.size() == 1 && std::isfinite(values[0]); }

}  // namespace

core::Weights first_paint(int paint_count) {
  check_at_most(1, paint_count, "paints of a pack");
  std::vector<double> w(static_cast<std::size_t>(paint_count), 0.0);
  w.front() = 1.0;
  return core::Weights::uniform(w);
}

LightShares light_alone(int light) {
  LightShares shares{};
  shares[static_cast<std::size_t>(std::clamp(light, 0, light_moods - 1))] = 1.0;
  return shares;
}

State::State(int paint_count, std::vector<packs::Camera> cameras, Room room)
    : paint_count_(static_cast<std::size_t>(paint_count)),
      rig_(std::move(cameras), room),
      weights_(first_paint(paint_count)),
      camera_(rig_.first()) {}

bool State::set_group(std::vector<double>& group, const std::vector<double>& values) const {
  if (values.size() != paint_count_ || values == group) return false;
  double sum = 0.0;
  for (const double value : values) sum += value;
  // A NaN fails this comparison too.
  if (!(std::abs(sum - 1.0) <= core::weight_sum_tolerance)) return false;
  group = values;
  return true;
}

State::Changes State::set_weights(const core::Weights& weights) {
  Changes changes;
  changes.weights |= set_group(weights_.base, weights.base);
  changes.weights |= set_group(weights_.flake_lightness, weights.flake_lightness);
  changes.weights |= set_group(weights_.flake_colour, weights.flake_colour);
  if (weights.flake_white >= 0.0 && weights.flake_white <= 1.0 && weights.flake_white != weights_.flake_white) {
    weights_.flake_white = weights.flake_white;
    changes.weights = true;
  }
  return changes;
}

bool State::set_view(const packs::Camera& camera) {
  const bool differs = camera.eye_mm != camera_.eye_mm || camera.target_mm != camera_.target_mm ||
                       camera.vertical_fov_deg != camera_.vertical_fov_deg;
  camera_ = camera;
  return differs;
}

bool State::show_place() {
  packs::Camera camera = rig_.camera_at(rig_.place());
  camera.name = camera_.name;
  return set_view(camera);
}

State::Changes State::set_place(const RigPlace& place) {
  if (place == rig_.place()) return {};
  rig_.set_place(place);
  Changes changes;
  changes.view = show_place();
  return changes;
}

bool State::choose(const std::string& name) {
  // The camera itself, to the last bit: pictures are compared.
  const packs::Camera* camera = rig_.choose(name);
  return camera != nullptr && set_view(*camera);
}

State::Changes State::go_home() {
  Changes changes;
  changes.view = choose(std::string(rig_.first().name));
  return changes;
}

bool State::set_light(const std::vector<double>& values) {
  if (!is_number(values) || values[0] < 0.0 || values[0] >= light_moods) return false;
  const int light = static_cast<int>(values[0]);
  const bool differs = light != light_;
  light_ = light;
  light_shares_ = light_alone(light);
  return differs;
}

State::Changes State::set_light_shares(const LightShares& shares) {
  Changes changes;
  changes.view = shares != light_shares_;
  light_shares_ = shares;
  return changes;
}

State::Changes State::set_time(double position) {
  Changes changes;
  if (!std::isfinite(position)) return changes;
  const double time = std::clamp(position, 0.0, 1.0);
  changes.view = time != time_;
  time_ = time;
  return changes;
}

State::Changes State::apply(const input::Control& event) {
  using input::ControlKind;
  Changes changes;
  switch (event.kind) {
    case ControlKind::weights:
      return set_weights({event.values, event.values, event.values, 0.0});
    case ControlKind::base:
      changes.weights = set_group(weights_.base, event.values);
      break;
    case ControlKind::flake_lightness:
      changes.weights = set_group(weights_.flake_lightness, event.values);
      break;
    case ControlKind::flake_colour:
      changes.weights = set_group(weights_.flake_colour, event.values);
      break;
    case ControlKind::flake_white:
      if (!is_number(event.values) || event.values[0] < 0.0 || event.values[0] > 1.0) break;
      changes.weights = event.values[0] != weights_.flake_white;
      weights_.flake_white = event.values[0];
      break;
    case ControlKind::camera:
      changes.view = choose(event.name);
      break;
    case ControlKind::orbit:
      if (event.values.size() != 2 || !std::isfinite(event.values[0]) || !std::isfinite(event.values[1])) break;
      if (event.values[0] == 0.0 && event.values[1] == 0.0) break;
      rig_.orbit(event.values[0], event.values[1]);
      changes.view = show_place();
      break;
    case ControlKind::zoom:
      if (!is_number(event.values) || !(event.values[0] > 0.0) || event.values[0] == 1.0) break;
      rig_.zoom(event.values[0]);
      changes.view = show_place();
      break;
    case ControlKind::light:
      changes.view = set_light(event.values);
      break;
    case ControlKind::dimmer:
      if (!is_number(event.values) || event.values[0] < 0.0 || event.values[0] > 1.0) break;
      changes.view = event.values[0] != dimmer_;
      dimmer_ = event.values[0];
      break;
    case ControlKind::time:
      if (!is_number(event.values) || event.values[0] < 0.0 || event.values[0] > 1.0) break;
      return set_time(event.values[0]);
    case ControlKind::turn:
    case ControlKind::press:
    case ControlKind::release:
    case ControlKind::touch_down:
    case ControlKind::touch_move:
    case ControlKind::touch_up:
    case ControlKind::touch_cancel:
      break;  // what these mean is for Experience to say
  }
  return changes;
}

}  // namespace lackwerk::kiosk
