#include "render_gles/accumulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "core/check.hpp"
#include "core/colour.hpp"
#include "render_gles/display_model.hpp"

namespace lackwerk::gles {
namespace {

std::array<float, 256> decoding_table() {
  std::array<float, 256> table{};
  for (std::size_t k = 0; k < table.size(); ++k)
    table[k] = static_cast<float>(core::srgb_decode(static_cast<double>(k) / 255.0));
  return table;
}

/// Undoes display_transform (core/display.glsl) for a pixel whose sRGB curve is undone already. The last byte stands
/// for its lower half: 254.75 / 255, or white would be infinite.
glm::vec3 undo_display(glm::vec3 shown) {
  static const auto top = static_cast<float>(core::srgb_decode(254.75 / 255.0));
  const float dark = std::min(std::max({shown.x, shown.y, shown.z}), top);
  if (dark <= 0.0f) return glm::vec3(0.0f);
  const float over = dark - 0.45f;
  const float peak = over <= 0.0f ? dark : 0.45f + over / (1.0f - over / 0.55f);
  const float white = peak / (peak + 16.0f);
  const glm::vec3 v = glm::min(shown, glm::vec3(dark)) * (peak / dark);
  return glm::max((v - glm::vec3(peak * white)) / (1.0f - white), glm::vec3(0.0f));
}

void clear(const GlApi& gl, const Framebuffer& target) {
  target.bind();
  gl.Disable(GL_SCISSOR_TEST);
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.ClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  gl.Clear(GL_COLOR_BUFFER_BIT);
}

}  // namespace

Result<Accumulator> Accumulator::create(const Context& context, int width, int height, bool allow_half) {
  if (allow_half) {
    auto frame = Framebuffer::create(context, width, height, PixelFormat::rgba16f);
    auto group = Framebuffer::create(context, width, height, PixelFormat::rgba16f, false);
    auto total = Framebuffer::create(context, width, height, PixelFormat::rgba16f, false);
    if (frame && group && total) {
      Accumulator out(context.gl(), std::move(*frame));
      out.group_ = std::move(*group);
      out.total_ = std::move(*total);
      out.reset();
      return out;
    }
  }
  auto frame = Framebuffer::create(context, width, height);
  if (!frame) return tl::unexpected(frame.error());
  Accumulator out(context.gl(), std::move(*frame));
  out.reset();
  return out;
}

void Accumulator::reset() {
  count_ = in_group_ = 0;
  if (linear()) {
    clear(*gl_, *group_);
    clear(*gl_, *total_);
  } else {
    sum_.assign(static_cast<std::size_t>(frame_.width()) * static_cast<std::size_t>(frame_.height()) * 3, 0.0f);
  }
}

void Accumulator::add(const ScreenPass& screen) {
  check_at_most(count_ + 1, max_frames, "frames of a still picture");
  if (linear() && in_group_ == group_size) {
    screen.copy(group_->texture(), *total_, 1.0f / group_size, ScreenPass::Blend::add);
    clear(*gl_, *group_);
    in_group_ = 0;
  }
  ++count_;
  ++in_group_;
  add_to_last(screen);
}

void Accumulator::add_to_last(const ScreenPass& screen) {
  if (linear()) {
    screen.copy(frame_.texture(), *group_, 1.0f, ScreenPass::Blend::add);
    return;
  }
  static const std::array<float, 256> decode = decoding_table();
  const Image image = frame_.read();
  for (std::size_t i = 0; i < sum_.size(); i += 3) {
    const glm::vec3 lit = undo_display({decode[image.rgb[i]], decode[image.rgb[i + 1]], decode[image.rgb[i + 2]]});
    for (int c = 0; c < 3; ++c) sum_[i + static_cast<std::size_t>(c)] += lit[c];
  }
}

void Accumulator::show(const ScreenPass& screen, const Framebuffer& target, bool dither, float alpha) {
  check_at_most(1, count_, "frames of a picture to be shown");
  if (!linear()) {
    show_bytes(screen, target, alpha);
    return;
  }
  const float n = 1.0f / static_cast<float>(count_);
  screen.resolve(total_->texture(), group_->texture(), {group_size * n, n}, dither, target, alpha);
}

void Accumulator::show_bytes(const ScreenPass& screen, const Framebuffer& target, float alpha) {
  DisplayModel<float> display;
  const auto width = static_cast<std::size_t>(frame_.width()), height = static_cast<std::size_t>(frame_.height());
  std::vector<std::uint8_t> rgba(width * height * 4);
  const float n = 1.0f / static_cast<float>(count_);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const float* sum = &sum_[((height - 1 - y) * width + x) * 3];
      const glm::vec3 shown = display.display_transform({sum[0] * n, sum[1] * n, sum[2] * n});
      std::uint8_t* out = &rgba[(y * width + x) * 4];
      for (int c = 0; c < 3; ++c)
        out[c] = static_cast<std::uint8_t>(std::lround(std::clamp(shown[c], 0.0f, 1.0f) * 255.0f));
      out[3] = 255;
    }
  if (!upload_) upload_ = make_texture(*gl_);
  gl_->ActiveTexture(GL_TEXTURE0);
  gl_->BindTexture(GL_TEXTURE_2D, upload_.id());
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, frame_.width(), frame_.height(), 0, GL_RGBA, GL_UNSIGNED_BYTE,
                  rgba.data());
  screen.copy(upload_.id(), target, 1.0f, alpha < 1.0f ? ScreenPass::Blend::alpha : ScreenPass::Blend::replace, alpha);
}

std::size_t Accumulator::bytes() const {
  std::size_t sum = frame_.bytes();
  if (group_) sum += group_->bytes();
  if (total_) sum += total_->bytes();
  return sum;
}

}  // namespace lackwerk::gles
