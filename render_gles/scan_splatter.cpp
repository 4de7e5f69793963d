#include "render_gles/scan_splatter.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <limits>

#include "core/check.hpp"
#include "render_gles/display_model.hpp"

namespace lackwerk::gles {
namespace {

/// scan_light.glsl and display.glsl, compiled here.
struct Shading : DisplayModel<float> {
  static real dot(vec3 a, vec3 b) { return glm::dot(a, b); }
#define R(x) static_cast<real>(x)
#include "render_gles/scan_light.glsl"
#undef R
};

constexpr std::uint64_t nothing = std::numeric_limits<std::uint64_t>::max();
/// A point smaller than this share of a spacing is gone, as in the shader.
constexpr float least_size = 0.004f;

float between(float from, float to, float t) { return from + (to - from) * t; }

ScanSplatter::Texel lit(const packs::ScanPath& path, const SplatShot& shot) {
  glm::vec3 place{}, normal{};
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    place[c] = between(path.from[k], path.to[k], shot.time) / 65535.0f;
    normal[c] = between(path.from_normal[k], path.to_normal[k], shot.time) / 127.0f;
  }
  const float open = between(path.from_normal[3], path.to_normal[3], shot.time) / 127.0f;
  normal /= std::max(glm::length(normal), 0.01f);
  Shading shading;
  const glm::vec3 light =
      shading.scan_light(normal, shot.eye - place, open, shot.up, shot.key, shot.sky, shot.sun) * shot.albedo;
  const glm::vec3 shown = shading.display_transform(light);
  const auto byte = [](float x) { return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(x, 0.0f, 1.0f))); };
  return {byte(shown.x), byte(shown.y), byte(shown.z), 255};
}

}  // namespace

void ScanSplatter::draw(std::span<const packs::ScanPath> paths, const SplatShot& shot, int width, int height) {
  check_equal(width > 0 && height > 0, true, "a picture has pixels");
  width_ = width;
  height_ = height;
  nearest_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), nothing);
  splat(paths, shot);
  resolve(paths, shot);
}

void ScanSplatter::splat(std::span<const packs::ScanPath> paths, const SplatShot& shot) {
  // Straight from the pack's numbers to clip space.
  const glm::mat4 clip = shot.clip * glm::mat4(glm::mat3(1.0f / 65535.0f));
  const auto columns = static_cast<float>(width_), rows = static_cast<float>(height_);
  int left = width_, right = 0, low = height_, high = 0;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    const packs::ScanPath& path = paths[k];
    const float size = between(path.from[3], path.to[3], shot.time) / 65535.0f;
    if (size < least_size) continue;
    const glm::vec3 at(between(path.from[0], path.to[0], shot.time), between(path.from[1], path.to[1], shot.time),
                       between(path.from[2], path.to[2], shot.time));
    const glm::vec4 place = clip[0] * at.x + clip[1] * at.y + clip[2] * at.z + clip[3];
    if (!(place.w > 0.0f) || std::abs(place.z) > place.w) continue;
    const float per_w = 1.0f / place.w;
    const float x = (0.5f + 0.5f * place.x * per_w) * columns, y = (0.5f + 0.5f * place.y * per_w) * rows;
    const float half = 0.5f * std::clamp(shot.point_px * size * per_w, shot.least_splat_px, shot.most_splat_px);
    // A point whose middle is not in the picture is not drawn at all: GL clips points so.
    if (!(x >= 0.0f && x <= columns && y >= 0.0f && y <= rows)) continue;
    // Pixels whose middles lie in it.
    const int x0 = std::max(0, static_cast<int>(std::ceil(x - half - 0.5f)));
    const int x1 = std::min(width_, static_cast<int>(std::ceil(x + half - 0.5f)));
    const int y0 = std::max(0, static_cast<int>(std::ceil(y - half - 0.5f)));
    const int y1 = std::min(height_, static_cast<int>(std::ceil(y + half - 0.5f)));
    if (x0 >= x1 || y0 >= y1) continue;
    left = std::min(left, x0);
    right = std::max(right, x1);
    low = std::min(low, y0);
    high = std::max(high, y1);
    // 24 bits of depth, as a depth buffer has; of equal ones the later point wins, as with GL_LEQUAL.
    const auto depth = static_cast<std::uint64_t>((0.5f + 0.5f * place.z * per_w) * 16777215.0f);
    const std::uint64_t mine = depth << 32 | (0xffffffffu - static_cast<std::uint32_t>(k));
    for (int row = y0; row < y1; ++row) {
      std::uint64_t* const line = nearest_.data() + static_cast<std::ptrdiff_t>(row) * width_;
      const float dy = static_cast<float>(row) + 0.5f - y;
      for (int column = x0; column < x1; ++column) {
        const float dx = static_cast<float>(column) + 0.5f - x;
        if (shot.round && dx * dx + dy * dy > half * half) continue;
        line[column] = std::min(line[column], mine);
      }
    }
  }
  rectangle_ = left < right ? Rectangle{left, low, right - left, high - low} : Rectangle{};
}

void ScanSplatter::resolve(std::span<const packs::ScanPath> paths, const SplatShot& shot) {
  colours_.assign(paths.size(), Texel{});
  texels_.assign(static_cast<std::size_t>(rectangle_.width) * static_cast<std::size_t>(rectangle_.height), Texel{});
  Texel* out = texels_.data();
  for (int row = rectangle_.y; row < rectangle_.y + rectangle_.height; ++row) {
    const std::uint64_t* cell = nearest_.data() + static_cast<std::ptrdiff_t>(row) * width_ + rectangle_.x;
    for (int k = 0; k < rectangle_.width; ++k, ++cell, ++out) {
      if (*cell == nothing) continue;
      const std::size_t point = 0xffffffffu - static_cast<std::uint32_t>(*cell & 0xffffffffu);
      Texel& colour = colours_[point];
      if (colour[3] == 0) colour = lit(paths[point], shot);
      *out = colour;
    }
  }
}

}  // namespace lackwerk::gles
