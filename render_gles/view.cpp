#include "render_gles/view.hpp"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace lackwerk::gles {
namespace {

/// The part of the k-th number in `base` behind the point, mirrored.
float radical_inverse(int k, int base) {
  float value = 0.0f;
  float digit = 1.0f / static_cast<float>(base);
  for (; k > 0; k /= base, digit /= static_cast<float>(base)) value += digit * static_cast<float>(k % base);
  return value;
}

}  // namespace

glm::mat4 clip_from_world(const View& view, int width, int height, std::span<const Box> boxes) {
  const glm::vec3 forward = glm::normalize(view.target_mm - view.eye_mm);
  const glm::vec3 up = std::abs(forward.z) > 0.999f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 0.0f, 1.0f);
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const float half = std::tan(glm::radians(view.vertical_fov_deg) * 0.5f);

  // Nearest and farthest point of any box; depth of a point at distance d is at least d times the cosine of the
  // picture's half diagonal.
  float nearest = 1e30f, farthest = 0.0f;
  for (const Box& box : boxes) {
    const glm::vec3 closest = glm::clamp(view.eye_mm, box.lo, box.hi);
    nearest = std::min(nearest, glm::distance(closest, view.eye_mm));
    const glm::vec3 corner = glm::max(glm::abs(view.eye_mm - box.lo), glm::abs(view.eye_mm - box.hi));
    farthest = std::max(farthest, glm::length(corner));
  }
  const float cosine = 1.0f / std::sqrt(1.0f + half * half * (1.0f + aspect * aspect));
  const float z_near = std::max(0.95f * nearest * cosine, 20.0f);
  const float z_far = std::max(1.05f * farthest, 2.0f * z_near);

  glm::mat4 projection = glm::perspective(glm::radians(view.vertical_fov_deg), aspect, std::min(z_near, 1e6f), z_far);
  // A shift of the picture by the jitter: x_clip += 2 j / width * w_clip, and w_clip = -z_view.
  projection[2][0] -= 2.0f * view.jitter_px.x / static_cast<float>(width);
  projection[2][1] -= 2.0f * view.jitter_px.y / static_cast<float>(height);
  return projection * glm::lookAt(view.eye_mm, view.target_mm, up);
}

float pixel_size_per_mm(const View& view, int height) {
  return 2.0f * std::tan(glm::radians(view.vertical_fov_deg) * 0.5f) / static_cast<float>(height);
}

glm::vec2 halton_jitter(int k) {
  if (k == 0) return glm::vec2(0.0f);
  return glm::vec2(radical_inverse(k, 2), radical_inverse(k, 3)) - 0.5f;
}

}  // namespace lackwerk::gles
