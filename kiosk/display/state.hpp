// The kiosk's state: which mix is shown and from where. A pure state machine over control events.
//
// Why it exists: behaviour is tested without GL, devices or a clock. It owns copies of the scene's cameras. One thread.
#pragma once

#include <string>
#include <vector>

#include "core/interpolatable_paint.hpp"
#include "input/control.hpp"
#include "packs/scene.hpp"

namespace lackwerk::kiosk {

class State {
 public:
  /// Starts on the first paint and the first camera. `paint_count` in [1, max_paints]; `cameras` not empty.
  State(int paint_count, std::vector<packs::Camera> cameras);

  /// What an event changed. All false: it was not understood here, or it asked for what already is.
  struct Changes {
    bool weights = false;
    bool view = false;
    [[nodiscard]] bool any() const { return weights || view; }
  };

  /// Applies one event. Weights that are not finite, do not fit the number of paints or do not sum to 1 are ignored;
  /// unknown cameras too. The camera keeps between 10 degrees below the target and 85 above it, never goes under the
  /// floor, and keeps its distance within [0.1, 3] times that of the named camera.
  Changes apply(const input::Control& event);

  [[nodiscard]] const core::Weights& weights() const { return weights_; }
  [[nodiscard]] const packs::Camera& camera() const { return camera_; }

 private:
  bool set_weights(std::vector<double>& group, const std::vector<double>& values) const;
  void orbit(double azimuth_deg, double elevation_deg);
  void zoom(double factor);

  std::size_t paint_count_;
  std::vector<packs::Camera> cameras_;
  core::Weights weights_;
  packs::Camera camera_;
  float home_distance_mm_;
};

/// The mix on the first paint: what every kiosk starts with.
[[nodiscard]] core::Weights first_paint(int paint_count);

}  // namespace lackwerk::kiosk
