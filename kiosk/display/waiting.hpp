// How the kiosk waits: for descriptors, a time or a signal, whichever comes first.
//
// Why it exists: an idle kiosk must cost nothing and still answer at once; the loop and the benchmark that measures
// this wait alike. One thread.
#pragma once

#include <csignal>
#include <vector>

namespace lackwerk::kiosk {

/// Signals that ask for the end arrive while waiting only: no frame is cut in the middle, none is missed.
class HeldSignals {
 public:
  HeldSignals();
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;
  /// The mask to wait with.
  [[nodiscard]] const sigset_t* before() const { return &before_; }

 private:
  sigset_t before_{};
};

/// Returns when one of them is readable, at `until_ms` (CLOCK_MONOTONIC) or when a signal arrives. `mask`: signals
/// blocked meanwhile; null: as they are.
void wait(const std::vector<int>& descriptors, double until_ms, const sigset_t* mask);

}  // namespace lackwerk::kiosk
