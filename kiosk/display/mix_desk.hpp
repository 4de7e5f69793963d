// The desk a mix is made on: puck and swatches, sparkle and hue with their locks, beyond; weights come of it.
//
// Why it exists: what the pad, the sliders and the locks mean together is one function of a few values and the time,
// and no step in it may be seen: where a rule changes (a lock, a script's weights) the mix blends over. Values; one
// thread.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/interpolatable_paint.hpp"
#include "input/control.hpp"
#include "kiosk/display/ui/content.hpp"
#include "kiosk/display/ui/model.hpp"

namespace lackwerk::kiosk {

/// A puck that was sent to a swatch is there after this.
inline constexpr double glide_ms = 250.0;
/// The mix follows another rule after this.
inline constexpr double blend_ms = 300.0;
/// Detents of a knob from one paint to the next, and from one end of a slider to the other: a dial with 24 a turn shows
/// a new paint each turn.
inline constexpr double detents_a_paint = 24.0;

/// 0 at 0, 1 at 1, at rest at both ends.
[[nodiscard]] double eased(double part);

/// Paints by rising liveliness, ties in the pack's order.
[[nodiscard]] std::vector<std::size_t> by_liveliness(const ui::Content& content);

/// What the hue slider says: white flakes at 0, then every paint in its order.
struct Hue {
  std::vector<double> weights;
  double white = 0.0;
};
[[nodiscard]] Hue hue_at(double position, std::size_t paints);
/// What the sparkle slider says: along the paints in `order`.
[[nodiscard]] std::vector<double> sparkle_at(double position, const std::vector<std::size_t>& order);

class MixDesk {
 public:
  explicit MixDesk(const ui::Content& content);

  /// Everything as a visit begins. With `now_ms` the mix blends over, without it is there at once.
  void reset(std::optional<double> now_ms = std::nullopt);
  /// No glides and blends.
  void set_reduced_motion(bool reduced) { reduced_ = reduced; }

  void put_puck(ui::Place place, double now_ms);
  void send_puck(std::size_t swatch, double now_ms);
  /// Along the closed path through the swatches: a whole position is a swatch.
  void turn_puck(double detents, double now_ms);
  /// The swatch goes towards `to` by at most `reach` of the pad. True: it has not arrived where it could go.
  bool drag_swatch(std::size_t swatch, ui::Place to, double reach, double now_ms);
  /// Opens the lock.
  void set_sparkle(double position, double now_ms);
  void set_hue(double position, double now_ms);
  void toggle_sparkle_lock(double now_ms);
  void toggle_hue_lock(double now_ms);
  /// [0, 1] of the pack's limit.
  void set_beyond(double part, double now_ms);

  /// A script has set weights: the desk shows the nearest it can, the mix is exactly these.
  void script(input::ControlKind kind, const core::Weights& weights, double now_ms);

  [[nodiscard]] core::Weights weights(double now_ms) const;
  /// Something glides or blends.
  [[nodiscard]] bool moves(double now_ms) const;
  /// Into the model's part of it.
  void show(ui::Model& model, double now_ms) const;

  [[nodiscard]] ui::Place puck(double now_ms) const;
  [[nodiscard]] const std::vector<ui::Place>& swatches() const { return swatches_; }
  [[nodiscard]] double sparkle(double now_ms) const;
  [[nodiscard]] double hue(double now_ms) const;
  [[nodiscard]] double beyond() const { return beyond_; }

 private:
  [[nodiscard]] core::Weights wanted(double now_ms) const;
  [[nodiscard]] double progress(double since_ms, double over_ms, double now_ms) const;
  /// The mix as it is now fades into what the desk says from now on.
  void blend(double now_ms);
  /// A visitor's hand is on it: a script's weights fade out.
  void by_hand(double now_ms);
  void put_down(ui::Place place);
  [[nodiscard]] ui::Place on_path(double position) const;
  [[nodiscard]] double nearest_on_path(ui::Place place) const;

  std::size_t paints_;
  std::vector<std::size_t> order_;
  double limit_;
  bool reduced_ = false;

  std::vector<ui::Place> swatches_;
  ui::Place puck_{0.5, 0.5};       ///< where it is going
  ui::Place glide_off_{0.0, 0.0};  ///< from there, where the glide began
  double glide_since_ms_;
  std::optional<double> path_;  ///< position on the knob's path, while nobody else moved the puck
  bool sparkle_free_ = false, hue_free_ = false;
  double sparkle_ = 0.0, hue_ = 0.0, beyond_ = 0.0;
  std::optional<core::Weights> scripted_;
  std::optional<core::Weights> blend_from_;
  double blend_since_ms_ = 0.0;
};

}  // namespace lackwerk::kiosk
