#include "kiosk/display/picture.hpp"

#include <algorithm>
#include <cmath>

#include "kiosk/display/log.hpp"
#include "kiosk/display/mood.hpp"

namespace lackwerk::kiosk {

void Picture::Times::add(double ms) {
  last_ = ms;
  if (ms_.size() < kept)
    ms_.push_back(ms);
  else
    ms_[next_++ % kept] = ms;
}

double Picture::Times::median() const {
  if (ms_.empty()) return 0.0;
  std::vector<double> sorted = ms_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

Picture::Picture(Stage& stage, const PictureSettings& settings)
    : stage_(stage),
      settings_(settings),
      governor_(settings.frame_ms, 0, settings.costs),
      scans_(settings.frame_ms),
      fixed_(gles::find_rung(settings.quality)) {}

Result<void> Picture::prepare(const State& state) {
  if (stage_.shows_scans()) return {};
  if (auto updated = stage_.renderer().update(state.weights()); !updated) return updated;
  stage_.renderer().prepare(view(state), lighting(state), stage_.framebuffer());
  return {};
}

bool Picture::differs(const State& state) const {
  if (stage_.shows_scans()) return scans_.differs(stage_, state, view(state));
  return stage_.renderer().needs_draw(view(state), lighting(state), stage_.framebuffer());
}

Picture::Step Picture::step_scans(const State& state) {
  const gles::View shown = view(state);
  if (scans_.differs(stage_, state, shown)) {
    const double start = monotonic_ms();
    scans_.draw(stage_, state, shown);
    drawn_ms_.add(monotonic_ms() - start);
    ++drawn_;
    resting_ = false;
    return Step::drawn;
  }
  if (resting_) return Step::nothing;
  resting_ = true;
  if (!scans_.complete(stage_, state, shown)) return Step::nothing;
  ++refined_;
  return Step::refined;
}

Result<Picture::Step> Picture::step(const State& state, bool weights_changed) {
  if (stage_.shows_scans()) return step_scans(state);
  const double start = monotonic_ms();
  gles::Renderer& renderer = stage_.renderer();
  if (weights_changed) {
    if (auto updated = renderer.update(state.weights()); !updated) return tl::unexpected(updated.error());
    realise_ms_.add(monotonic_ms() - start);
  }
  const gles::View shown = view(state);
  // A new quality alone is no reason to draw: it would show as a step in a picture that rests.
  if (!differs(state)) return rest(state);
  quality_ = (fixed_ != nullptr ? *fixed_ : governor_.rung()).quality;
  const std::uint64_t programs = renderer.program_count();
  renderer.draw(shown, lighting(state), stage_.framebuffer());
  stage_.context().gl().Finish();
  drawn_ms_.add(monotonic_ms() - start);
  ++drawn_;
  resting_ = false;
  still_frame_ms_ = 0.0;
  // Frames that compiled something say nothing about the next ones.
  if (programs == renderer.program_count()) governor_.measured(drawn_ms_.last());
  return Step::drawn;
}

Result<Picture::Step> Picture::rest(const State& state) {
  if (resting_) return Step::nothing;
  if (settings_.still_frames < 2) {
    resting_ = true;
    return Step::nothing;
  }
  const double start = monotonic_ms();
  const auto refined =
      stage_.renderer().refine(view(state), lighting(state), stage_.framebuffer(), settings_.still_frames, strips_);
  if (!refined) return tl::unexpected(refined.error());
  stage_.context().gl().Finish();
  still_frame_ms_ += monotonic_ms() - start;
  resting_ = !refined->more;
  if (refined->frame) {
    ++refined_;
    // Strips of half a frame's time: input that arrives waits for one, then for its own frame.
    const double wanted = std::ceil(still_frame_ms_ / (0.5 * settings_.frame_ms));
    strips_ = static_cast<int>(std::clamp(wanted, 1.0, double{gles::Renderer::max_strips}));
    still_frame_ms_ = 0.0;
  }
  return refined->shown ? Step::refined : Step::nothing;
}

gles::Image Picture::still(const State& state, int samples) {
  if (stage_.shows_scans()) {
    const gles::View shown = view(state);
    if (scans_.differs(stage_, state, shown)) scans_.draw(stage_, state, shown);
    (void)scans_.complete(stage_, state, shown);
    return stage_.framebuffer().read();
  }
  return stage_.renderer().still(view(state), lighting(state), stage_.framebuffer(), samples);
}

gles::View Picture::view(const State& state) const {
  const int width = stage_.framebuffer().width(), height = stage_.framebuffer().height();
  return stage_.shows_scans() ? framed_square(state.camera(), width, height, settings_.keep_free)
                              : framed(state.camera(), width, height, settings_.keep_free);
}

gles::Lighting Picture::lighting(const State& state) const {
  gles::Lighting lighting = lighting_of(state.camera(), state.light_shares(), state.dimmer());
  lighting.quality = quality_;
  return lighting;
}

std::string Picture::quality() const {
  if (stage_.shows_scans()) return std::to_string(stage_.scan_renderer().drawn_points()) + " points";
  return fixed_ != nullptr ? std::string(fixed_->name) : std::string(governor_.rung().name) + " (chosen)";
}

double Picture::frame_period_ms() const {
  const double governed = fixed_ != nullptr || stage_.shows_scans() ? 0.0 : governor_.median_ms();
  return governed > 0.0 ? governed : drawn_ms_.median();
}

double Picture::drawn_ms_median() const { return drawn_ms_.median(); }
double Picture::realise_ms_median() const { return realise_ms_.median(); }

}  // namespace lackwerk::kiosk
