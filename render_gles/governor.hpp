// Holds the frame time of moving pictures by choosing how they are drawn.
//
// Why it exists: the same kiosk runs on GPUs and on none. Qualities stand on a ladder from the best to the cheapest;
// the governor goes down at once when frames are late and up only when there is lasting room. What the rungs cost
// beside each other is a table that `lackwerk report` measures; the governor believes it until its own frames say
// otherwise. It never sees a clock: it is told frame times, so tests need none. Values; any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "render_gles/view.hpp"

namespace lackwerk::gles {

struct Rung {
  std::string_view name;
  Quality quality;
  double cost;   ///< frame time over that of the first rung on the machine of docs/figures.md, > 0
  double error;  ///< of its picture of the car against the reference there: mean CIEDE2000 over the subject
};

/// Number of rungs of the ladder.
inline constexpr std::size_t rung_count = 7;

/// Best first. Each leaves out what costs most for what it shows.
[[nodiscard]] std::span<const Rung> quality_ladder();
/// The rung of this name; null if there is none.
[[nodiscard]] const Rung* find_rung(std::string_view name);

/// What the rungs cost and how far they are from the reference, in the ladder's order.
struct RungCosts {
  std::array<double, rung_count> cost{};   ///< frame time over that of the first rung: finite, > 0, the first 1
  std::array<double, rung_count> error{};  ///< mean CIEDE2000 against the reference; for the reader, not for the choice
  /// The figures that stand in quality_ladder().
  [[nodiscard]] static RungCosts built_in();
  /// Some better rung costs no more: there is no use for this one. Better is what stands higher on the ladder, not what
  /// has the smaller `error`: that is of one view, in which most of what the upper rungs add cannot be seen.
  [[nodiscard]] bool dominated(int rung) const;
};

class Governor {
 public:
  /// `target_ms`: longest frame time that is still good, > 0. Starts on rung `start`, or on the next better one that is
  /// not dominated.
  explicit Governor(double target_ms, int start = 0, const RungCosts& costs = RungCosts::built_in());

  [[nodiscard]] const Rung& rung() const { return quality_ladder()[static_cast<std::size_t>(index())]; }
  [[nodiscard]] int index() const { return used_[here_]; }
  /// Tells it how long a moving frame on the present rung took, ms. Returns whether the rung has changed.
  bool measured(double frame_ms);
  /// Median of the last frames on this rung, ms (the lower one of two); 0 before there are any.
  [[nodiscard]] double median_ms() const;

 private:
  static constexpr int window = 5;
  void go_to(std::size_t place);
  [[nodiscard]] int counted() const;  ///< frames in the window
  [[nodiscard]] bool go_down(double median);
  [[nodiscard]] bool go_up(double median);
  void learn(double median);

  double target_ms_;
  std::array<int, rung_count> used_{};  ///< rungs that are not dominated, best first
  std::size_t used_count_ = 0;
  std::size_t here_ = 0;  ///< index into used_
  /// Frame time of a used rung over that of the next cheaper one: by the table, and as frames have shown it.
  std::array<double, rung_count> promised_{}, seen_ratio_{};
  std::int64_t seen_ = 0;     ///< frames since the rung changed
  int calm_ = 0;              ///< frames in a row with room for the next better rung, as frames have shown it
  int hopeful_ = 0;           ///< the same by the table alone
  int patience_;              ///< of them before it goes up; doubles when going up had to be taken back
  double median_before_ = 0;  ///< on the cheaper rung from which it has just come up; 0: it has not
  bool came_up_ = false;      ///< the last change was upwards
  bool settled_ = false;      ///< and the better rung had the room it was to have
  std::array<double, window> last_{};
};

}  // namespace lackwerk::gles
