// The attract screen's tour: an endless walk through mixes, views and moods that nobody has to start.
//
// Why it exists: somebody who passes by twice must not see the same twice. Every channel is a chain of cubic legs with
// common speeds at the joints, so all of it is C1. A leg is drawn by a seeded random and thrown away if any moment of
// it repeats one of the last ten minutes: the same mix (5 % steps), azimuth (10 degrees), distance (10 % steps) and
// mood more than 5 s apart. Deterministic: the same seed and starts give the same tour. Values; one thread.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <random>
#include <unordered_map>
#include <vector>

#include "kiosk/display/ui/model.hpp"

namespace lackwerk::kiosk {

struct TourPose {
  ui::Place puck{0.5, 0.5};
  double azimuth_deg = 0.0, elevation_deg = 0.0, closeness = 0.0;  ///< as RigPlace
  int light = 0;
};

/// What the tour may do.
struct TourBounds {
  std::vector<ui::Place> swatches;  ///< it walks among these
  double nearest_closeness = 0.0;   ///< the macro view's; 0: there is none
  bool moves_camera = true;         ///< false: mixes only
};

/// What counts as the same moment.
[[nodiscard]] std::uint64_t tour_key(const std::vector<ui::Place>& swatches, const TourPose& pose);
/// Moments with one key this far apart are a repetition, within that time.
inline constexpr double tour_repeat_s = 5.0, tour_memory_s = 600.0;

class AttractTour {
 public:
  AttractTour(std::uint64_t seed, TourBounds bounds);

  /// Sets off, from rest, with new legs; what was shown lately is remembered.
  void start(const TourPose& from, double now_ms);
  /// Where it is; `now_ms` does not go back. Before start(): the pose of rest.
  [[nodiscard]] TourPose at(double now_ms);

 private:
  static constexpr std::size_t channels = 5;  ///< puck x and y, azimuth, elevation, closeness
  using Numbers = std::array<double, channels>;
  struct Leg {
    Numbers from{}, from_speed{}, to{}, to_speed{};  ///< speeds a second
    double begin_s = 0.0, length_s = 1.0;
    int light = 0;
    [[nodiscard]] TourPose pose(double at_s) const;
  };
  struct Seen {
    double first_s, last_s;
  };
  using Moments = std::vector<std::pair<double, std::uint64_t>>;

  [[nodiscard]] double unit();
  [[nodiscard]] Leg draw(const Leg& before, bool near);
  void draw_puck(Leg& leg);
  void draw_view(Leg& leg, double previous_closeness, bool near);
  /// How many moments of the leg repeat something; fills `moments`.
  [[nodiscard]] int repeats(const Leg& leg, Moments& moments, int most) const;
  /// Whether some leg after this one repeats nothing.
  [[nodiscard]] bool goes_on(const Leg& leg);
  void next_leg();

  TourBounds bounds_;
  std::mt19937_64 random_;
  Leg leg_;
  bool started_ = false;
  double start_ms_ = 0.0, start_s_ = 0.0, now_s_ = 0.0;  ///< seconds of tour, over all starts
  double home_closeness_ = 0.0;
  int legs_to_macro_ = 3;
  std::unordered_map<std::uint64_t, Seen> seen_;
  std::deque<std::pair<double, std::uint64_t>> memory_;
};

}  // namespace lackwerk::kiosk
