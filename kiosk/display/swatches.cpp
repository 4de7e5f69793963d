#include "kiosk/display/swatches.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/check.hpp"
#include "kiosk/display/mood.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr int least_edge_px = 16, most_edge_px = 1024;
/// Smoothed moving frames: a thumbnail shows no more, and each costs what a visitor waits.
constexpr int samples = 9;
/// Width of paint that is seen. At some hundred pixels flakes of 0.05 to 0.1 mm are then about as large as one: single
/// glints on an even metal.
constexpr float seen_mm = 18.0f;
/// Tilt of the dome where the square's edges touch it: the paint's darkest flop begins about here.
constexpr float rim_tilt_deg = 48.0f;
constexpr float fov_deg = 12.0f;
constexpr int cells = 48;  ///< a side of the mesh: its silhouette is never seen, its normals are exact
/// As a visitor before the car holds a sample: at chest height, towards the eye.
constexpr glm::vec3 middle_mm(0.0f, 0.0f, 1100.0f);
glm::vec3 direction_to_eye() { return glm::normalize(glm::vec3(0.66f, 0.44f, 0.61f)); }

packs::Camera swatch_camera() {
  const float distance_mm = seen_mm / 2.0f / std::tan(glm::radians(fov_deg / 2.0f));
  return {"swatch", middle_mm + distance_mm * direction_to_eye(), middle_mm, fov_deg};
}

gles::View swatch_view() { return gles::View::from(swatch_camera()); }

/// Hard light for the flakes, the room's soft boxes for the coat.
gles::Lighting swatch_lighting() {
  gles::Lighting lighting = lighting_of(Mood::sun);
  lighting.environment_gain = 0.7f;
  lighting.lights.front().radiance *= 0.8f;
  return lighting;
}

}  // namespace

packs::Scene swatch_scene(core::Environment environment) {
  packs::Scene scene;
  scene.name = "swatch";
  const glm::vec3 towards_eye = direction_to_eye();
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0.0f, 0.0f, 1.0f), towards_eye));
  const glm::vec3 up = glm::cross(towards_eye, right);
  const float half_mm = seen_mm / 2.0f;
  // A paraboloid z = -(x^2 + y^2) / 2R fills the square's corners, which a sphere would not.
  const float radius_mm = half_mm / std::tan(glm::radians(rim_tilt_deg));
  packs::MeshPart part;
  part.name = "swatch";
  part.kind = packs::SurfaceKind::paint;
  // The corners lie lower than the middle: the camera's cone is wider there.
  constexpr float margin = 1.25f;
  for (int row = 0; row <= cells; ++row)
    for (int column = 0; column <= cells; ++column) {
      const float x = margin * half_mm * (2.0f * static_cast<float>(column) / cells - 1.0f);
      const float y = margin * half_mm * (2.0f * static_cast<float>(row) / cells - 1.0f);
      part.positions_mm.push_back(middle_mm + x * right + y * up - (x * x + y * y) / (2.0f * radius_mm) * towards_eye);
      part.normals.push_back(glm::normalize(x * right + y * up + radius_mm * towards_eye));
    }
  const auto vertex = [](int row, int column) { return static_cast<std::uint32_t>(row * (cells + 1) + column); };
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column) {
      const std::uint32_t a = vertex(row, column), b = vertex(row, column + 1), c = vertex(row + 1, column + 1),
                          d = vertex(row + 1, column);
      part.indices.insert(part.indices.end(), {a, b, c, a, c, d});
    }
  scene.parts.push_back(std::move(part));
  scene.cameras.push_back(swatch_camera());
  scene.environment = std::move(environment);
  return scene;
}

Swatches::Swatches(gles::Context& context, const core::InterpolatablePaint& paint, core::Environment environment)
    : context_(&context), paint_(&paint), environment_(std::move(environment)) {}

void Swatches::wants(int edge_px) {
  check_at_most(least_edge_px, edge_px, "edge of a swatch, px");
  check_at_most(edge_px, most_edge_px, "edge of a swatch, px");
  if (edge_px == edge_px_) return;
  edge_px_ = edge_px;
  next_ = 0;
  studio_.reset();
}

Result<void> Swatches::set_up() {
  auto studio = std::make_unique<Studio>(*context_);
  auto framebuffer = gles::Framebuffer::create(*context_, edge_px_, edge_px_);
  if (!framebuffer) return tl::unexpected(framebuffer.error());
  studio->framebuffer = std::move(*framebuffer);
  studio->renderer.set_scene(swatch_scene(environment_));
  if (auto set = studio->renderer.set_paint(*paint_); !set) return set;
  studio_ = std::move(studio);
  if (auto realised = realise(0); !realised) return realised;
  studio_->renderer.prepare(swatch_view(), swatch_lighting(), *studio_->framebuffer);
  return {};
}

Result<void> Swatches::realise(std::size_t paint) {
  std::vector<double> weights(paint_->paints.size(), 0.0);
  weights[paint] = 1.0;
  return studio_->renderer.update(core::Weights::uniform(weights));
}

Result<std::optional<SwatchPicture>> Swatches::step() {
  if (!studio_) {
    if (auto ready = set_up(); !ready) return tl::unexpected(ready.error());
    return std::nullopt;
  }
  if (auto realised = realise(next_); !realised) return tl::unexpected(realised.error());
  gles::Image image = studio_->renderer.still(swatch_view(), swatch_lighting(), *studio_->framebuffer, samples);
  return SwatchPicture{next_++, edge_px_, std::move(image.rgb)};
}

Result<std::optional<SwatchPicture>> Swatches::next() {
  check_at_most(next_ + 1, paint_->paints.size(), "swatches to draw");
  auto stepped = step();
  if (!stepped) next_ = paint_->paints.size();
  if (!pending()) studio_.reset();
  return stepped;
}

}  // namespace lackwerk::kiosk
