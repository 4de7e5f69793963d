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
/// A rung is taken only if it is predicted to leave this much room: predictions are for another scene and machine.
constexpr double up_margin = 0.8;
constexpr int longest_patience = 720;

}  // namespace

std::span<const Rung> quality_ladder() {
  static const std::array<Rung, 7> ladder = {{
      {"best", quality(FlakeMode::bilinear, true, 4, true, false, 1.0f), 1.0},
      {"fine", quality(FlakeMode::bilinear, true, 1, true, false, 1.0f), 0.95},
      {"good", quality(FlakeMode::bilinear, true, 1, true, true, 1.0f), 0.72},
      {"plain", quality(FlakeMode::nearest, false, 1, true, true, 1.0f), 0.70},
      {"lean", quality(FlakeMode::nearest, false, 1, false, true, 1.0f), 0.61},
      {"soft", quality(FlakeMode::nearest, false, 1, false, true, 0.75f), 0.39},
      {"least", quality(FlakeMode::mean, false, 0, false, true, 0.5f), 0.25},
  }};
  return ladder;
}

const Rung* find_rung(std::string_view name) {
  for (const Rung& rung : quality_ladder())
    if (rung.name == name) return &rung;
  return nullptr;
}

Governor::Governor(double target_ms, int start) : target_ms_(target_ms) {
  check_equal(target_ms > 0.0, true, "a frame time to hold");
  rung_ = std::clamp(start, 0, static_cast<int>(quality_ladder().size()) - 1);
}

double Governor::median_ms() const {
  const int count = std::min(seen_ - ignored_frames, window);
  if (count <= 0) return 0.0;
  std::array<double, window> sorted = last_;
  std::nth_element(sorted.begin(), sorted.begin() + count / 2, sorted.begin() + count);
  return sorted[static_cast<std::size_t>(count / 2)];
}

void Governor::go_to(int rung) {
  rung_ = rung;
  seen_ = calm_ = 0;
}

bool Governor::measured(double frame_ms) {
  ++seen_;
  if (seen_ <= ignored_frames) return false;
  last_[static_cast<std::size_t>((seen_ - ignored_frames - 1) % window)] = frame_ms;
  const auto ladder = quality_ladder();
  const int worst = static_cast<int>(ladder.size()) - 1;
  const double median = median_ms();
  // Late: two frames suffice to see it, for a customer is dragging.
  if (seen_ >= ignored_frames + 2 && median > target_ms_ && rung_ < worst) {
    if (went_up_) patience_ = std::min(2 * patience_, longest_patience);
    went_up_ = false;
    // Close up flakes cost far more of a frame than from afar, so the ladder's promises hold for one view only: two
    // rungs at most, then it looks again.
    const int furthest = std::min(rung_ + 2, worst);
    int next = rung_ + 1;
    const double here = ladder[static_cast<std::size_t>(rung_)].cost;
    while (next < furthest && median * ladder[static_cast<std::size_t>(next)].cost / here > target_ms_) ++next;
    go_to(next);
    return true;
  }
  if (rung_ > 0) {
    const double ratio =
        ladder[static_cast<std::size_t>(rung_ - 1)].cost / ladder[static_cast<std::size_t>(rung_)].cost;
    calm_ = median * ratio < up_margin * target_ms_ ? calm_ + 1 : 0;
    if (calm_ >= patience_) {
      went_up_ = true;
      go_to(rung_ - 1);
      return true;
    }
  }
  return false;
}

}  // namespace lackwerk::gles
