// The kiosk's state: which mix is shown, from where and in which light. A pure state machine over control events.
//
// Why it exists: behaviour is tested without GL, devices or a clock. It owns copies of the scene's cameras. One thread.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/interpolatable_paint.hpp"
#include "input/control.hpp"
#include "kiosk/display/camera_rig.hpp"
#include "packs/scene.hpp"

namespace lackwerk::kiosk {

inline constexpr int light_moods = 3;
/// How much of each mood is in the light; they sum to 1.
using LightShares = std::array<double, light_moods>;

/// One mood and nothing else.
[[nodiscard]] LightShares light_alone(int light);

class State {
 public:
  /// Starts on the first paint and the first camera. `paint_count` in [1, max_paints]; `cameras` not empty.
  State(int paint_count, std::vector<packs::Camera> cameras, Room room = {});

  /// What an event changed. All false: it was not understood here, or it asked for what already is.
  struct Changes {
    bool weights = false;
    bool view = false;  ///< camera, light, dimmer or time
    [[nodiscard]] bool any() const { return weights || view; }
  };

  /// Applies one event. Weights that are not finite, do not fit the number of paints or do not sum to 1 are ignored;
  /// unknown cameras and moods too. The camera keeps within CameraRig's limits: never under the floor, never inside the
  /// car, never out of the room.
  Changes apply(const input::Control& event);
  /// The same for values that are known to be good: weights as apply() takes them, a place of rig().
  Changes set_weights(const core::Weights& weights);
  Changes set_place(const RigPlace& place);
  /// On the way from one mood to another; apply() goes there at once.
  Changes set_light_shares(const LightShares& shares);
  /// Where the scans are, clamped to [0, 1]; what is not finite changes nothing.
  Changes set_time(double position);
  /// The first camera, at its own place.
  Changes go_home();

  [[nodiscard]] const core::Weights& weights() const { return weights_; }
  [[nodiscard]] const packs::Camera& camera() const { return camera_; }
  [[nodiscard]] const CameraRig& rig() const { return rig_; }
  /// The mood of the light that is chosen, [0, light_moods), and how far it is dimmed from day (0) to showroom night
  /// (1). The mood steps; what is drawn are its shares.
  [[nodiscard]] int light() const { return light_; }
  [[nodiscard]] const LightShares& light_shares() const { return light_shares_; }
  [[nodiscard]] double dimmer() const { return dimmer_; }
  /// Of scans: [0, 1] from the first scan's time to the last one's. What nobody has moved shows the newest.
  [[nodiscard]] double time() const { return time_; }

 private:
  bool set_group(std::vector<double>& group, const std::vector<double>& values) const;
  bool choose(const std::string& name);
  bool show_place();
  bool set_view(const packs::Camera& camera);
  bool set_light(const std::vector<double>& values);

  std::size_t paint_count_;
  CameraRig rig_;
  core::Weights weights_;
  packs::Camera camera_;
  int light_ = 0;
  LightShares light_shares_ = light_alone(0);
  double dimmer_ = 0.0;
  double time_ = 1.0;
};

/// The mix on the first paint: what every kiosk starts with.
[[nodiscard]] core::Weights first_paint(int paint_count);

}  // namespace lackwerk::kiosk
