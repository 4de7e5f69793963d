// The attract screen's way through time: scans grow, stand a while, go back and begin again.
//
// Why it exists: a passer-by sees growth without touching anything, and no loop may jump. Every leg is at rest at both
// of its ends and begins where the one before ended, so the loop is C1 from wherever it is started. Values; one thread.
#pragma once

namespace lackwerk::kiosk {

/// How long the whole way takes, and how long its ends are shown.
inline constexpr double growing_s = 16.0, grown_s = 4.0, shrinking_s = 6.0, small_s = 1.5;

class GrowthLoop {
 public:
  /// Sets off from rest at `position`, [0, 1] along the scans' time, growing first.
  void start(double position, double now_ms);
  /// Where it is; `now_ms` does not go back. Before start(): 1.
  [[nodiscard]] double at(double now_ms);

 private:
  struct Leg {
    double from = 1.0, to = 1.0;
    double begin_ms = 0.0, length_ms = 0.0;
  };
  [[nodiscard]] Leg after(const Leg& leg) const;
  Leg leg_;
  bool started_ = false;
};

}  // namespace lackwerk::kiosk
