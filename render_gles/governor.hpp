// Holds the frame time of moving pictures by choosing how they are drawn.
//
// Why it exists: the same kiosk runs on GPUs and on none. Qualities stand on a ladder from the best to the cheapest;
// the governor goes down at once when frames are late and up only when there is lasting room. It never sees a clock: it
// is told frame times, so tests need none. A value; any thread.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "render_gles/view.hpp"

namespace lackwerk::gles {

struct Rung {
  std::string_view name;
  Quality quality;
  double cost;  ///< guess of its frame time over that of the first rung; docs/figures.md has what was measured
};

/// Best first. Each leaves out what costs most for what it shows.
[[nodiscard]] std::span<const Rung> quality_ladder();
/// The rung of this name; null if there is none.
[[nodiscard]] const Rung* find_rung(std::string_view name);

class Governor {
 public:
  /// `target_ms`: longest frame time that is still good, > 0. Starts on rung `start`.
  explicit Governor(double target_ms, int start = 0);

  [[nodiscard]] const Rung& rung() const { return quality_ladder()[static_cast<std::size_t>(rung_)]; }
  [[nodiscard]] int index() const { return rung_; }
  /// Tells it how long a moving frame on the present rung took, ms. Returns whether the rung has changed.
  bool measured(double frame_ms);
  /// Median of the last frames on this rung, ms; 0 before there are any.
  [[nodiscard]] double median_ms() const;

 private:
  void go_to(int rung);

  static constexpr int window = 5;
  double target_ms_;
  int rung_ = 0;
  int seen_ = 0;       ///< frames since the rung changed
  int calm_ = 0;       ///< frames in a row with room for the next better rung
  int patience_ = 45;  ///< of them before it goes up; doubles when going up had to be taken back
  bool went_up_ = false;
  std::array<double, window> last_{};
};

}  // namespace lackwerk::gles
