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

void Renderer::draw_sampled(const Frame& frame, int index, int frames, Accumulator& sum) {
  Frame shifted = frame;
  shifted.view.jitter_px += halton_jitter(index);
  Quality& quality = shifted.lighting.quality;
  quality.coarse = false;
  quality.scale = 1.0f;
  const ShaderOutput output = sum.linear() ? ShaderOutput::linear : ShaderOutput::display;
  const bool sampled = frames >= sampled_still_frames && quality.path == LightPath::filtered &&
                       context_.info().max_fragment_uniforms >= sampled_uniform_vectors && !frame.lighting.stripes;
  if (!sampled) {
    draw_moving(shifted, output, sum.frame());
    return;
  }
  if (quality.flakes == FlakeMode::nearest) quality.flakes = FlakeMode::bilinear;
  quality.flake_cross_fade = true;
  quality.floor_mirror = true;
  std::vector<DirectionalLight> lights;
  Pass pass = moving_pass(shifted, lights);
  if (pass.floor_mirror) draw_mirror(shifted);
  const bool single =
      quality.flakes == FlakeMode::bilinear && flakes_show(shifted.view, shifted.height, still_contrast);
  pass.path = ShaderPath::sampled;
  pass.output = output;
  pass.flake_lights = single ? static_cast<int>(lights.size()) : 0;
  pass.sparkle_lights = 0;
  pass.still_flakes = single;
  pass.sample = glm::vec3(spread_point(index), static_cast<float>(frames));
  draw_pass(shifted, pass, sum.frame());
}

Result<bool> Renderer::refine(const View& view, const Lighting& lighting, const Framebuffer& target, int frames) {
  check_at_most(frames, Accumulator::max_frames, "frames of a still picture");
  const Frame frame = frame_of(view, lighting, target);
  if (drawn_ != frame || frames < 2) return false;
  if (refined_ != frame) {
    if (auto made = ensure_accumulator(frame.width, frame.height); !made) return tl::unexpected(made.error());
    accumulator_->reset();
    refined_ = frame;
  }
  const int done = accumulator_->count();
  if (done >= frames) return false;
  draw_sampled(frame, done, frames, *accumulator_);
  accumulator_->add(screen_);
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
  return count < frames;
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
  for (int k = 0; k < samples; ++k) {
    draw_sampled(frame, k, samples, *accumulator_);
    accumulator_->add(screen_);
  }
  accumulator_->show(screen_, target, lighting.dither, 1.0f);
  refined_.reset();
  return target.read();
}

}  // namespace lackwerk::gles
