#include "kiosk/display/attract_tour.hpp"

#include <algorithm>
#include <cmath>

#include "kiosk/display/state.hpp"
#include "kiosk/display/ui/paint_pad.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr std::size_t x_channel = 0, y_channel = 1, azimuth_channel = 2, elevation_channel = 3, closeness_channel = 4;

/// Legs last this long: a view is taken in, and nobody waits for the next one.
constexpr double shortest_leg_s = 9.0, usual_leg_s = 15.0;
/// Down to the flakes and up again are long ways; mixes alone change slowly.
constexpr double long_way = 1.4;
constexpr double longest_leg_s = long_way * usual_leg_s;
/// A calm turn. Five degrees never take as long as tour_repeat_s.
constexpr double slowest_deg_s = 2.6, fastest_deg_s = 4.4;
/// Keys are taken this often, and kept somewhat longer than promised: a test may look in between.
constexpr double moment_s = 0.02;
constexpr double margin_s = 1.0;
constexpr int most_draws = 400;
constexpr double mix_steps = 20.0, azimuth_step_deg = 5.0, distance_step = 0.05;

double cubic(double a, double da, double b, double db, double length, double t) {
  const double t2 = t * t, t3 = t2 * t;
  return a * (2.0 * t3 - 3.0 * t2 + 1.0) + da * length * (t3 - 2.0 * t2 + t) + b * (3.0 * t2 - 2.0 * t3) +
         db * length * (t3 - t2);
}

/// A speed with which neither the leg that ends here nor the longest one that begins here leaves [lo, hi]: the control
/// points of both cubics are inside.
double kept_within(double at, double speed, double lo, double hi) {
  const double room = std::max(std::min(at - lo, hi - at), 0.0) * 3.0 / longest_leg_s;
  return std::clamp(speed, -room, room);
}

}  // namespace

std::uint64_t tour_key(const std::vector<ui::Place>& swatches, const TourPose& pose) {
  std::uint64_t key = 0;
  for (const double weight : ui::pad_weights(swatches, pose.puck))
    key = key * 32 + static_cast<std::uint64_t>(std::lround(std::clamp(weight, 0.0, 1.0) * mix_steps));
  const double turned = pose.azimuth_deg - 360.0 * std::floor(pose.azimuth_deg / 360.0);
  key = key * 128 + static_cast<std::uint64_t>(std::floor(turned / azimuth_step_deg));
  key =
      key * 256 + static_cast<std::uint64_t>(std::clamp(std::floor(pose.closeness / distance_step) + 64.0, 0.0, 255.0));
  return key * 4 + static_cast<std::uint64_t>(pose.light);
}

TourPose AttractTour::Leg::pose(double at_s) const {
  const double t = std::clamp((at_s - begin_s) / length_s, 0.0, 1.0);
  Numbers n{};
  for (std::size_t c = 0; c < channels; ++c) n[c] = cubic(from[c], from_speed[c], to[c], to_speed[c], length_s, t);
  TourPose pose;
  pose.puck = {std::clamp(n[x_channel], 0.0, 1.0), std::clamp(n[y_channel], 0.0, 1.0)};
  pose.azimuth_deg = n[azimuth_channel];
  pose.elevation_deg = n[elevation_channel];
  pose.closeness = n[closeness_channel];
  pose.light = light;
  return pose;
}

AttractTour::AttractTour(std::uint64_t seed, TourBounds bounds) : bounds_(std::move(bounds)), random_(seed) {
  if (bounds_.swatches.empty()) bounds_.swatches.push_back({0.5, 0.5});
  leg_.from[x_channel] = leg_.to[x_channel] = bounds_.swatches.front()[0];
  leg_.from[y_channel] = leg_.to[y_channel] = bounds_.swatches.front()[1];
}

double AttractTour::unit() { return static_cast<double>(random_() >> 11) * 0x1.0p-53; }

void AttractTour::start(const TourPose& from, double now_ms) {
  start_ms_ = now_ms;
  start_s_ = now_s_;
  leg_ = {};
  leg_.to = {from.puck[0], from.puck[1], from.azimuth_deg, from.elevation_deg, from.closeness};
  leg_.from = leg_.to;
  leg_.light = std::clamp(from.light, 0, light_moods - 1);
  leg_.begin_s = now_s_;
  leg_.length_s = 0.0;
  home_closeness_ = from.closeness;
  legs_to_macro_ = 2 + static_cast<int>(3.0 * unit());
  started_ = true;
  next_leg();
}

void AttractTour::draw_puck(Leg& leg) {
  // Among the swatches, more often near one of them than in the middle.
  const std::vector<ui::Place>& swatches = bounds_.swatches;
  std::vector<double> shares;
  double sum = 0.0;
  for (std::size_t k = 0; k < swatches.size(); ++k) {
    const double u = unit();
    shares.push_back(u * u * u * u + 1e-3);
    sum += shares.back();
  }
  ui::Place to{0.0, 0.0};
  for (std::size_t k = 0; k < swatches.size(); ++k)
    for (std::size_t axis = 0; axis < 2; ++axis) to[axis] += swatches[k][axis] * shares[k] / sum;
  const double keep = 0.6 * unit();
  for (std::size_t axis = 0; axis < 2; ++axis) {
    leg.to[axis] = to[axis];
    leg.to_speed[axis] = kept_within(to[axis], keep * (to[axis] - leg.from[axis]) / leg.length_s, 0.0, 1.0);
  }
}

void AttractTour::draw_view(Leg& leg, double previous_closeness, bool near) {
  const double before = leg.from_speed[azimuth_channel];
  const double after = slowest_deg_s + (fastest_deg_s - slowest_deg_s) * unit();
  // A mean between both speeds never turns back, and from rest it is under way at once.
  const double mean = before > 0.0 ? std::clamp(0.5 * (before + after), slowest_deg_s, fastest_deg_s) : 0.8 * after;
  leg.to[azimuth_channel] = leg.from[azimuth_channel] + mean * leg.length_s;
  leg.to_speed[azimuth_channel] = after;

  constexpr double lowest_deg = -2.0, highest_deg = 30.0;
  const double elevation = lowest_deg + (highest_deg - lowest_deg) * unit() * unit();
  leg.to[elevation_channel] = elevation;
  leg.to_speed[elevation_channel] = 0.0;

  // Around the car between three quarters and some more of the home distance; now and then down to the flakes.
  const bool was_near = previous_closeness > home_closeness_ + 1.0;
  double closeness = home_closeness_ - 0.3 + 0.75 * unit();
  if (near) closeness = bounds_.nearest_closeness - 0.1 - 0.7 * unit();
  leg.to[closeness_channel] = closeness;
  leg.to_speed[closeness_channel] = 0.0;
  if (near || was_near) {
    leg.length_s *= long_way;
    leg.to[azimuth_channel] = leg.from[azimuth_channel] + mean * leg.length_s;
  }
  leg.light = static_cast<int>(light_moods * unit());
}

AttractTour::Leg AttractTour::draw(const Leg& before, bool near) {
  Leg leg;
  leg.from = before.to;
  leg.from_speed = before.to_speed;
  leg.begin_s = before.begin_s + before.length_s;
  leg.length_s = shortest_leg_s + (usual_leg_s - shortest_leg_s) * unit();
  leg.to = leg.from;
  leg.light = before.light;
  if (bounds_.moves_camera)
    draw_view(leg, before.to[closeness_channel], near);
  else
    leg.length_s *= long_way;
  draw_puck(leg);
  return leg;
}

int AttractTour::repeats(const Leg& leg, Moments& moments, int most) const {
  moments.clear();
  std::unordered_map<std::uint64_t, double> own;
  int count = 0;
  const int moments_of_leg = static_cast<int>(std::ceil(leg.length_s / moment_s));
  for (int k = 0; k < moments_of_leg; ++k) {
    const double t = leg.begin_s + k * moment_s;
    const std::uint64_t key = tour_key(bounds_.swatches, leg.pose(t));
    moments.emplace_back(t, key);
    const auto seen = seen_.find(key);
    const double first = own.try_emplace(key, t).first->second;
    const bool again = seen != seen_.end() && seen->second.last_s >= t - tour_memory_s - margin_s &&
                       seen->second.first_s <= t - tour_repeat_s + margin_s;
    if (again || first <= t - tour_repeat_s + margin_s) ++count;
    if (count >= most) break;
  }
  return count;
}

bool AttractTour::goes_on(const Leg& leg) {
  constexpr int tries = 60;
  Moments moments;
  for (int k = 0; k < tries; ++k)
    if (repeats(draw(leg, false), moments, 1) == 0) return true;
  return false;
}

void AttractTour::next_leg() {
  Leg best;
  bool best_is_near = false;
  Moments best_moments, moments;
  int least = static_cast<int>(longest_leg_s * 2.0 / moment_s);
  for (int draws = 0; draws < most_draws && least > 0; ++draws) {
    // The flakes when it is their turn; where that would repeat something, a little later or earlier.
    const bool near = bounds_.nearest_closeness > 0.0 && (draws < most_draws / 2 ? legs_to_macro_ <= 0 : unit() < 0.5);
    const Leg leg = draw(leg_, near);
    // Mixes alone have too few places for ten minutes: no promise is made.
    if (!bounds_.moves_camera) {
      best = leg;
      break;
    }
    // A leg after which none goes on is worth as much as one that repeats a moment.
    const int repeated = repeats(leg, moments, least);
    if (repeated >= least) continue;
    // A leg after which none goes on is no better than one that repeats a moment.
    const int count = repeated == 0 && !goes_on(leg) ? 1 : repeated;
    if (count >= least) continue;
    least = count;
    best = leg;
    best_is_near = near;
    best_moments = moments;
  }
  leg_ = best;
  legs_to_macro_ = best_is_near ? 3 + static_cast<int>(4.0 * unit()) : legs_to_macro_ - 1;
  for (const auto& [t, key] : best_moments) {
    memory_.emplace_back(t, key);
    const auto [place, fresh] = seen_.try_emplace(key, Seen{t, t});
    if (!fresh) place->second.last_s = t;
  }
  while (!memory_.empty() && memory_.front().first < leg_.begin_s - tour_memory_s - 2.0 * margin_s) {
    const auto found = seen_.find(memory_.front().second);
    if (found != seen_.end() && found->second.last_s <= memory_.front().first) seen_.erase(found);
    memory_.pop_front();
  }
}

TourPose AttractTour::at(double now_ms) {
  if (!started_) return leg_.pose(0.0);
  now_s_ = std::max(now_s_, start_s_ + (now_ms - start_ms_) / 1e3);
  // After a long sleep of the caller the tour goes on from where it was.
  if (now_s_ > leg_.begin_s + leg_.length_s + longest_leg_s) {
    now_s_ = leg_.begin_s + leg_.length_s;
    start_s_ = now_s_;
    start_ms_ = now_ms;
  }
  while (now_s_ >= leg_.begin_s + leg_.length_s) next_leg();
  return leg_.pose(now_s_);
}

}  // namespace lackwerk::kiosk
