// How long a customer's touch takes to show.
//
// Why it exists: the promise is an input event on the panel within two frame periods, so it is measured where it
// happens and reported. A value; the kiosk's thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lackwerk::kiosk {

struct LatencySummary {
  std::size_t count = 0;  ///< events so far; the figures are of the last `Latency::kept` of them
  double median_ms = 0.0;
  double p95_ms = 0.0;
  double p95_frames = 0.0;  ///< in frame periods at the time of the event
};

class Latency {
 public:
  static constexpr std::size_t kept = 256;

  /// An input event of this time (CLOCK_MONOTONIC, µs; 0: unknown, ignored) has changed what is to be shown. The oldest
  /// event since the last flip counts.
  void input(std::uint64_t event_us);
  /// The picture handed over at this moment contains all input so far.
  void handed_over();
  /// A flip happened; `frame_period_ms` is what a frame takes now, > 0.
  void flipped(std::uint64_t flip_us, double frame_period_ms);

  [[nodiscard]] LatencySummary summary() const;

 private:
  std::uint64_t waiting_us_ = 0;  ///< oldest event that no picture has yet
  std::uint64_t on_way_us_ = 0;   ///< oldest event of the picture that is on its way
  std::size_t count_ = 0;
  std::array<double, kept> ms_{}, frames_{};
};

}  // namespace lackwerk::kiosk
