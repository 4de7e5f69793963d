// Renderer::refine and still: the quality that is drawn once nothing changes any more.
#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "render_gles/renderer.hpp"

namespace lackwerk::gles {
namespace {

/// k-th point of the R2 sequence (Roberts 2018): 1/g and 1/g^2, g the real root of x^3 = x + 1. Every prefix of it is
/// spread evenly, so the picture is usable before the last frame.
glm::vec2 spread_point(int k) {
  const double x = k * 0.7548776662466927, y = k * 0.5698402909980532;
  return {static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y))};
}

/// The sampled path needs so many fragment uniform vectors with four lights.
constexpr int sampled_uniform_vectors = 40;

}  // namespace

Result<void> Renderer::ensure_accumulator(int width, int height) {
  if (accumulator_ && accumulator_->frame().width() == width && accumulator_->frame().height() == height) return {};
  accumulator_.reset();
  auto made = Accumulator::create(context_, width, height);
  if (!made) return tl::unexpected(made.error());
  accumulator_ = std::move(*made);
  return {};
}

bool Renderer::add_sampled(const Frame& frame, int index, int frames, Accumulator& sum, int strip, int strips) {
  Frame shifted = frame;
  shifted.view.jitter_px += halton_jitter(index);
  Quality& quality = shifted.lighting.quality;
  quality.coarse = false;
  quality.scale = 1.0f;
  const bool sampled = frames >= sampled_still_frames && quality.path == LightPath::filtered &&
                       context_.info().max_fragment_uniforms >= sampled_uniform_vectors && !frame.lighting.stripes;
  if (!sampled) {
    std::vector<DirectionalLight> cut;
    const std::vector<Pass> passes = passes_of(shifted, cut);
    if (passes.front().floor_mirror) draw_mirror(shifted);
    add_passes(shifted, passes, sum);
    return true;
  }
  if (quality.flakes == FlakeMode::nearest) quality.flakes = FlakeMode::bilinear;
  quality.flake_cross_fade = true;
  quality.floor_mirror = true;
  Pass pass = moving_pass(shifted);
  if (pass.floor_mirror && strip == 0) draw_mirror(shifted);
  const bool single =
      quality.flakes == FlakeMode::bilinear && flakes_show(shifted.view, shifted.height, still_contrast);
  pass.path = ShaderPath::sampled;
  pass.output = sum.linear() ? ShaderOutput::linear : ShaderOutput::display;
  pass.flake_lights = single ? static_cast<int>(pass.lights.size()) : 0;
  pass.sparkle_lights = 0;
  pass.still_flakes = single;
  pass.sample = glm::vec3(spread_point(index), static_cast<float>(frames));
  pass.strip = strip;
  pass.strips = strips;
  draw_pass(shifted, pass, sum.frame());
  if (strip + 1 < strips) return false;
  sum.add(screen_);
  return true;
}

Result<Renderer::Refined> Renderer::refine(const View& view, const Lighting& lighting, const Framebuffer& target,
                                           int frames, int strips) {
  check_at_most(frames, Accumulator::max_frames, "frames of a still picture");
  check_at_most(1, strips, "strips of a still picture's frame");
  check_at_most(strips, max_strips, "strips of a still picture's frame");
  const Frame frame = frame_of(view, lighting, target);
  if (drawn_ != frame || frames < 2) return Refined{};
  if (refined_ != frame) {
    if (auto made = ensure_accumulator(frame.width, frame.height); !made) return tl::unexpected(made.error());
    accumulator_->reset();
    refined_ = frame;
    strip_ = 0;
  }
  const int done = accumulator_->count();
  if (done >= frames) return Refined{};
  if (strip_ == 0) strips_ = strips;
  if (!add_sampled(frame, done, frames, *accumulator_, strip_, strips_)) {
    ++strip_;
    target.bind();
    return Refined{true, false, false};
  }
  strip_ = 0;
  // A quarter of the frames is gathered unseen; over the second quarter the picture fades from moving to still, so that
  // no step shows; from then on every frame is shown.
  const int fade_from = frames / 4, fade_to = std::max(frames / 2, fade_from + 1);
  const int count = done + 1;
  if (count > fade_from) {
    // After the k-th of n equal steps the share of the new picture is k/n.
    const float alpha = count >= fade_to ? 1.0f : 1.0f / static_cast<float>(fade_to - count + 1);
    accumulator_->show(screen_, target, lighting.dither, alpha);
  }
  target.bind();
  return Refined{count<frames, true, count> fade_from};
}

Image Renderer::subject(const View& view, const Framebuffer& target) {
  Lighting lighting;
  lighting.quality.path = LightPath::none;
  lighting.quality.flakes = FlakeMode::off;
  Pass pass;
  pass.path = ShaderPath::none;
  pass.output = ShaderOutput::subject;
  pass.black = true;
  draw_pass(frame_of(view, lighting, target), pass, target);
  drawn_.reset();
  refined_.reset();
  return target.read();
}

Image Renderer::still(const View& view, const Lighting& lighting, const Framebuffer& target, int samples) {
  check_at_most(1, samples, "samples of a still picture");
  check_at_most(samples, Accumulator::max_frames, "samples of a still picture");
  draw(view, lighting, target);
  if (samples == 1) return target.read();
  const Frame frame = frame_of(view, lighting, target);
  const auto made = ensure_accumulator(frame.width, frame.height);
  check_equal(made.has_value(), true, "frame buffers of the size of one that exists");
  accumulator_->reset();
  for (int k = 0; k < samples; ++k) add_sampled(frame, k, samples, *accumulator_);
  accumulator_->show(screen_, target, lighting.dither, 1.0f);
  refined_.reset();
  return target.read();
}

}  // namespace lackwerk::gles
