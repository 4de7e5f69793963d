#include "kiosk/display/scan_picture.hpp"

#include <algorithm>
#include <cmath>

#include "kiosk/display/log.hpp"

namespace lackwerk::kiosk {
namespace {

/// A frame that is a tenth late is no reason for anything.
constexpr double late = 1.1;
/// Half as many points again must still fit, with a tenth to spare: 1 / 1.5 * 0.9.
constexpr double growth = 1.5, quick_enough = 0.6;
constexpr int slow_frames = 3, quick_frames = 12, most_patience = 960;
/// With fewer, nothing is seen that could be called a plant.
constexpr std::size_t least_points = 4'000;

}  // namespace

PointBudget::PointBudget(double frame_ms, std::size_t most)
    : frame_ms_(frame_ms), most_(most), points_(most), patience_(quick_frames) {}

void PointBudget::set(double points) {
  const auto least = std::min(least_points, most_);
  const auto next =
      static_cast<std::size_t>(std::clamp(points, static_cast<double>(least), static_cast<double>(most_)));
  slow_ = quick_ = 0;
  if (next == points_) return;
  points_ = next;
  ++changes_;
}

void PointBudget::measured(double ms, std::size_t drawn) {
  if (!(ms > 0.0) || drawn == 0) return;
  const double share = ms / frame_ms_;
  slow_ = share > late ? slow_ + 1 : 0;
  quick_ = share < quick_enough ? quick_ + 1 : 0;
  if (slow_ >= slow_frames) {
    patience_ = std::min(2 * patience_, most_patience);
    // At most to a quarter at once: one frame may be slow for other reasons.
    set(static_cast<double>(std::min(drawn, points_)) / std::min(share, 4.0));
  } else if (quick_ >= patience_ && points_ < most_) {
    set(growth * static_cast<double>(points_));
  }
}

ScanPicture::ScanPicture(double frame_ms) : budget_(frame_ms, gles::ScanLook{}.most_points) {}

double ScanPicture::time_of(Stage& stage, const State& state) {
  const auto& states = stage.pack().scans()->info().states;
  return std::lerp(states.front().time, states.back().time, state.time());
}

bool ScanPicture::differs(Stage& stage, const State& state, const gles::View& view) const {
  return stage.scan_renderer().needs_draw(view, look_, time_of(stage, state), stage.framebuffer());
}

void ScanPicture::draw(Stage& stage, const State& state, const gles::View& view) {
  look_.most_points = budget_.points();
  const double start = monotonic_ms();
  gles::ScanRenderer& renderer = stage.scan_renderer();
  const std::uint64_t uploaded = renderer.uploaded_bytes();
  renderer.draw(view, look_, time_of(stage, state), stage.framebuffer());
  stage.context().gl().Finish();
  // Frames that brought a step to the GPU say nothing about the next ones.
  if (uploaded == renderer.uploaded_bytes()) budget_.measured(monotonic_ms() - start, renderer.drawn_points());
}

bool ScanPicture::complete(Stage& stage, const State& state, const gles::View& view) {
  gles::ScanRenderer& renderer = stage.scan_renderer();
  // The view may show fewer points than the budget has: they are thinned by distance.
  if (look_.most_points == gles::ScanLook{}.most_points || renderer.drawn_points() < look_.most_points) return false;
  look_.most_points = gles::ScanLook{}.most_points;
  renderer.draw(view, look_, time_of(stage, state), stage.framebuffer());
  stage.context().gl().Finish();
  return true;
}

}  // namespace lackwerk::kiosk
