#include "render_gles/governor.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace lackwerk::gles {
namespace {

Quality quality(FlakeMode flakes, bool cross_fade, int sparkle_lights, bool mirror, bool coarse, float scale) {
  Quality out;
  out.flakes = flakes;
  out.flake_cross_fade = cross_fade;
  out.flake_lights = 1;
  out.sparkle_lights = sparkle_lights;
  out.floor_mirror = mirror;
  out.coarse = coarse;
  out.one_lobe = !mirror;  // the leaner half of the ladder
  out.scale = scale;
  out.smooth_edges = scale == 1.0f;  // a picture that is stretched is soft already
  return out;
}

/// The first frame on a rung compiles shaders: it says nothing.
constexpr int ignored_frames = 1;
/// A rung is taken only if it is predicted to leave this much room: predictions are for another scene and machine, and
/// medians of five frames that vary by 20 % vary by some 8 %.
constexpr double up_margin = 0.8;
/// Frames of calm before it goes up: at 16 frames a second about three seconds.
constexpr int shortest_patience = 45;
/// The most where its own frames say that there is room: 45 s. Visitors who zoom in and out all the time are shown what
/// holds close up.
constexpr int longest_calm = shortest_patience << 4;
/// The most where only the table says so: half an hour of moving pictures at 25 frames a second. A table that is wrong
/// for good costs one vain attempt in that time.
constexpr int longest_patience = shortest_patience << 10;
/// A rung that held for so long (a minute and a half) was right: what made it late is new.
constexpr std::int64_t long_stay = std::int64_t{shortest_patience} << 5;

}  // namespace

std::span<const Rung> quality_ladder() {
  // Costs: the hero view of docs/figures.md, 1280 x 720 on llvmpipe. Errors: the same view at 160 x 90 in one quick
  // `lackwerk report`, mostly edges; single flakes do not show in it, so that "fine" and "plain" look like their
  // neighbours. A machine's own figures: its quality table.
  static const std::array<Rung, rung_count> ladder = {{
      {"best", quality(FlakeMode::bilinear, true, 4, true, false, 1.0f), 1.0, 4.48},
      {"fine", quality(FlakeMode::bilinear, true, 1, true, false, 1.0f), 0.95, 4.48},
      {"good", quality(FlakeMode::bilinear, true, 1, true, true, 1.0f), 0.72, 4.52},
      {"plain", quality(FlakeMode::nearest, false, 1, true, true, 1.0f), 0.70, 4.52},
      {"lean", quality(FlakeMode::nearest, false, 1, false, true, 1.0f), 0.61, 4.61},
      {"soft", quality(FlakeMode::nearest, false, 1, false, true, 0.75f), 0.39, 4.66},
      {"least", quality(FlakeMode::mean, false, 0, false, true, 0.5f), 0.25, 5.82},
  }};
  return ladder;
}

const Rung* find_rung(std::string_view name) {
  for (const Rung& rung : quality_ladder())
    if (rung.name == name) return &rung;
  return nullptr;
}

RungCosts RungCosts::built_in() {
  RungCosts out;
  for (std::size_t k = 0; k < rung_count; ++k) {
    out.cost[k] = quality_ladder()[k].cost;
    out.error[k] = quality_ladder()[k].error;
  }
  return out;
}

bool RungCosts::dominated(int rung) const {
  const auto* end = cost.begin() + rung;
  return std::any_of(cost.begin(), end, [&](double better) { return better <= *end; });
}

Governor::Governor(double target_ms, int start, const RungCosts& costs)
    : target_ms_(target_ms), patience_(shortest_patience) {
  check_equal(target_ms > 0.0, true, "a frame time to hold");
  for (int k = 0; k < static_cast<int>(rung_count); ++k) {
    check_equal(costs.cost[static_cast<std::size_t>(k)] > 0.0, true, "a rung's cost above 0");
    if (costs.dominated(k)) continue;
    used_[used_count_] = k;
    if (k <= start) here_ = used_count_;
    ++used_count_;
  }
  for (std::size_t k = 0; k + 1 < used_count_; ++k)
    promised_[k] = costs.cost[static_cast<std::size_t>(used_[k])] / costs.cost[static_cast<std::size_t>(used_[k + 1])];
  seen_ratio_ = promised_;
}

int Governor::counted() const { return static_cast<int>(std::clamp<std::int64_t>(seen_ - ignored_frames, 0, window)); }

double Governor::median_ms() const {
  const int count = counted();
  if (count == 0) return 0.0;
  std::array<double, window> sorted = last_;
  const int middle = (count - 1) / 2;
  std::nth_element(sorted.begin(), sorted.begin() + middle, sorted.begin() + count);
  return sorted[static_cast<std::size_t>(middle)];
}

void Governor::go_to(std::size_t place) {
  here_ = place;
  seen_ = calm_ = hopeful_ = 0;
}

/// What the step up has really cost. Only steps up teach: before one the machine was calm for a while, before a step
/// down the load or the view has just changed.
void Governor::learn(double median) {
  if (median_before_ <= 0.0) return;
  seen_ratio_[here_] = std::max(median / median_before_, 1.0);
  median_before_ = 0.0;
  settled_ = median < up_margin * target_ms_;
}

bool Governor::go_down(double median) {
  if (counted() < 2 || median <= target_ms_ || here_ + 1 == used_count_) return false;
  learn(median);
  if (came_up_)
    patience_ = settled_ && seen_ > long_stay ? shortest_patience : std::min(2 * patience_, longest_patience);
  came_up_ = false;
  // Close up flakes cost far more of a frame than from afar, so the table's promises hold for one view only: two
  // rungs at most, then it looks again.
  const std::size_t furthest = std::min(here_ + 2, used_count_ - 1);
  std::size_t next = here_ + 1;
  double predicted = median / promised_[here_];
  while (next < furthest && predicted > target_ms_) predicted /= promised_[next++];
  go_to(next);
  return true;
}

bool Governor::go_up(double median) {
  if (here_ == 0) return false;
  const std::size_t better = here_ - 1;
  const double room = up_margin * target_ms_;
  calm_ = median * seen_ratio_[better] < room ? calm_ + 1 : 0;
  hopeful_ = median * promised_[better] < room ? hopeful_ + 1 : 0;
  if (calm_ < std::min(patience_, longest_calm) && hopeful_ < patience_) return false;
  median_before_ = median;
  came_up_ = true;
  settled_ = false;
  go_to(better);
  return true;
}

bool Governor::measured(double frame_ms) {
  ++seen_;
  if (seen_ <= ignored_frames) return false;
  last_[static_cast<std::size_t>((seen_ - ignored_frames - 1) % window)] = frame_ms;
  const double median = median_ms();
  // Late: two frames suffice to see it, for a customer is dragging.
  if (go_down(median)) return true;
  if (counted() == window) learn(median);
  return go_up(median);
}

}  // namespace lackwerk::gles
