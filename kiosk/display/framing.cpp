#include "kiosk/display/framing.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace lackwerk::kiosk {
namespace {

constexpr float made_for = 16.0f / 9.0f;
/// Upright, this part of the width is enough: the built-in car fills 0.83 of it from the first camera.
constexpr float upright_width = 0.88f;
/// Wider than this, straight lines at the border look bent.
constexpr float widest_deg = 100.0f;
/// Where the camera's target comes to lie, in half widths and half heights from the middle. Lying: the pad takes the
/// lower right fifth. Upright: it takes the lower third.
constexpr float left_lying = 0.05f, up_lying = 0.09f, up_upright = 0.2f;

/// The slider's panel takes a tenth to a seventh of the height; half of that keeps the subject clear of it.
constexpr float up_square = 0.08f;

/// `view` with its target moved by these parts of the picture's half width and half height.
gles::View moved(gles::View view, float left, float up, float aspect) {
  const float half_height = std::tan(glm::radians(view.vertical_fov_deg) * 0.5f);
  const glm::vec3 forward = view.target_mm - view.eye_mm;
  const float distance = glm::length(forward);
  const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0.0f, 0.0f, 1.0f)));
  const glm::vec3 upwards = glm::cross(right, forward / distance);
  view.target_mm += distance * half_height * (left * aspect * right - up * upwards);
  return view;
}

}  // namespace

gles::View framed(const packs::Camera& camera, int width, int height, KeepFree keep_free) {
  gles::View view = gles::View::from(camera);
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const bool upright = aspect < 1.0f;
  float half_height = std::tan(glm::radians(view.vertical_fov_deg) * 0.5f);
  if (aspect < made_for) {
    half_height *= std::max(1.0f, made_for / aspect * (upright ? upright_width : 1.0f));
    view.vertical_fov_deg =
        std::max(view.vertical_fov_deg, std::min(widest_deg, glm::degrees(2.0f * std::atan(half_height))));
  }
  if (keep_free == KeepFree::nothing) return view;
  return moved(view, upright ? 0.0f : left_lying, upright ? up_upright : up_lying, aspect);
}

gles::View framed_square(const packs::Camera& camera, int width, int height, KeepFree keep_free) {
  gles::View view = gles::View::from(camera);
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  if (aspect < 1.0f) {
    const float half_height = std::tan(glm::radians(view.vertical_fov_deg) * 0.5f) / aspect;
    view.vertical_fov_deg = std::min(widest_deg, glm::degrees(2.0f * std::atan(half_height)));
  }
  return keep_free == KeepFree::nothing ? view : moved(view, 0.0f, up_square, aspect);
}

}  // namespace lackwerk::kiosk
