#include "render_gles/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/check.hpp"
#include "render_gles/display_model.hpp"

namespace lackwerk::gles {

Renderer::Renderer(Context& context) : context_(context), gl_(context.gl()), programs_(context) {}

Renderer::~Renderer() {
  // A context that cannot be made current any more has taken its objects with it.
  (void)context_.make_current();
}

void Renderer::set_scene(const packs::Scene& scene) {
  mesh_ = MeshBuffers(gl_, scene);
  boxes_.clear();
  bounds_ = {};
  Box standing;
  for (const MeshBuffers::Draw& draw : mesh_.draws()) {
    boxes_.push_back(draw.box);
    bounds_.include(draw.box);
    if (draw.surface != packs::SurfaceKind::floor) standing.include(draw.box);
  }
  floor_shadow_ = standing.empty() ? glm::vec2(0.0f) : glm::vec2(standing.hi - standing.lo) * 0.5f;
  ++revision_;
  check_gl(gl_, "upload of a scene");
}

Result<void> Renderer::set_paint(const core::InterpolatablePaint& paint) {
  auto made = PaintGpu::create(context_, paint);
  if (!made) return tl::unexpected(made.error());
  paint_ = std::move(*made);
  ++revision_;
  return {};
}

Result<void> Renderer::update(const core::Weights& weights) {
  check_equal(paint_.has_value(), true, "set_paint before update");
  const auto changed = paint_->update(weights);
  if (!changed) return tl::unexpected(changed.error());
  if (*changed) ++revision_;
  return {};
}

bool Renderer::needs_draw(const View& view, const Lighting& lighting, const Framebuffer& target) const {
  return drawn_ != Frame{view, lighting, target.width(), target.height(), target.texture(), revision_};
}

Features Renderer::features_of(packs::SurfaceKind surface, const Lighting& lighting) const {
  Features features;
  features.surface = surface;
  features.lights = std::min(static_cast<int>(lighting.lights.size()), usable_lights(context_.info()));
  features.studio = lighting.studio;
  features.stripes = lighting.stripes;
  features.flakes = lighting.flakes != FlakeMode::off;
  const bool single = lighting.flakes == FlakeMode::nearest || lighting.flakes == FlakeMode::bilinear;
  features.flake_lights = single ? std::clamp(lighting.flake_lights, 0, features.lights) : 0;
  features.flake_taps = lighting.flakes == FlakeMode::bilinear ? 4 : 1;
  if (paint_) paint_->add_features(features);
  return features.canonical();
}

void Renderer::apply_frame(const Program& program, const Frame& frame, const glm::mat4& clip) const {
  const auto vector = [&](const char* name, const glm::vec3& v) {
    gl_.Uniform3f(program.location(name), v.x, v.y, v.z);
  };
  const auto number = [&](const char* name, float v) { gl_.Uniform1f(program.location(name), v); };
  const Lighting& lighting = frame.lighting;
  program.use();
  gl_.UniformMatrix4fv(program.location("u_clip_from_world"), 1, GL_FALSE, &clip[0][0]);
  vector("u_eye", frame.view.eye_mm);
  number("u_exposure", lighting.exposure);
  number("u_dither", lighting.dither ? 1.0f : 0.0f);
  vector("u_backdrop", lighting.backdrop);
  number("u_lamp_glow", lighting.lamp_glow);
  number("u_studio_gain", lighting.studio ? lighting.studio_gain : 0.0f);
  gl_.Uniform2f(program.location("u_floor_shadow"), floor_shadow_.x, floor_shadow_.y);
  std::vector<float> directions, radiances;
  const std::size_t usable = std::min(lighting.lights.size(), static_cast<std::size_t>(usable_lights(context_.info())));
  for (const DirectionalLight& light : std::span(lighting.lights).first(usable))
    for (int c = 0; c < 3; ++c) {
      directions.push_back(light.direction[c]);
      radiances.push_back(light.radiance[c]);
    }
  if (const auto count = static_cast<GLsizei>(usable); count > 0) {
    gl_.Uniform3fv(program.location("u_light_dir"), count, directions.data());
    gl_.Uniform3fv(program.location("u_light"), count, radiances.data());
  }
  if (!paint_) return;
  paint_->apply(gl_, program);
  const float texels_per_mm = paint_->texel_mm() > 0.0f ? 1.0f / paint_->texel_mm() : 0.0f;
  number("u_texels_per_mm", texels_per_mm);
  number("u_pixel_texels", pixel_size_per_mm(frame.view, frame.height) * texels_per_mm);
}

std::vector<const MeshBuffers::Draw*> Renderer::opaque_order(const View& view) const {
  std::vector<const MeshBuffers::Draw*> order;
  for (const MeshBuffers::Draw& draw : mesh_.draws())
    if (draw.surface != packs::SurfaceKind::glass) order.push_back(&draw);
  // Front to back, so that the depth test spares hidden paint its shading; the floor lies behind nearly everything.
  const auto key = [&](const MeshBuffers::Draw* draw) {
    const bool floor = draw->surface == packs::SurfaceKind::floor;
    return std::pair(floor, glm::distance(draw->box.centre(), view.eye_mm));
  };
  std::stable_sort(order.begin(), order.end(), [&](const auto* a, const auto* b) { return key(a) < key(b); });
  return order;
}

std::vector<const MeshBuffers::Draw*> Renderer::glass_order(const View& view) const {
  std::vector<const MeshBuffers::Draw*> order;
  for (const MeshBuffers::Draw& draw : mesh_.draws())
    if (draw.surface == packs::SurfaceKind::glass) order.push_back(&draw);
  const auto key = [&](const MeshBuffers::Draw* draw) { return -glm::distance(draw->box.centre(), view.eye_mm); };
  std::stable_sort(order.begin(), order.end(), [&](const auto* a, const auto* b) { return key(a) < key(b); });
  return order;
}

void Renderer::draw_parts(const std::vector<const MeshBuffers::Draw*>& parts, const Frame& frame,
                          const glm::mat4& clip) {
  std::vector<const Program*> applied;  // programs keep their uniforms: set them once a frame
  for (const MeshBuffers::Draw* part : parts) {
    const Program& program = programs_.get(features_of(part->surface, frame.lighting));
    if (std::find(applied.begin(), applied.end(), &program) == applied.end()) {
      apply_frame(program, frame, clip);
      applied.push_back(&program);
    }
    program.use();
    mesh_.draw(gl_, *part);
  }
}

void Renderer::prepare(const Lighting& lighting) {
  for (const MeshBuffers::Draw& draw : mesh_.draws()) programs_.get(features_of(draw.surface, lighting));
}

void Renderer::draw(const View& view, const Lighting& lighting, const Framebuffer& target) {
  check_at_most(lighting.lights.size(), static_cast<std::size_t>(max_lights), "directional lights");
  if (mesh_.has(packs::SurfaceKind::paint) && !lighting.stripes)
    check_equal(paint_ && !paint_->pending(), true, "set_paint and update before a scene with paint is drawn");
  const Frame frame{view, lighting, target.width(), target.height(), target.texture(), revision_};
  const glm::mat4 clip = clip_from_world(view, frame.width, frame.height, boxes_);

  target.bind();
  const auto sky = DisplayModel<float>().display_transform(lighting.backdrop);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.ClearColor(sky.x, sky.y, sky.z, 1.0f);
  gl_.ClearDepthf(1.0f);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LEQUAL);
  gl_.Enable(GL_CULL_FACE);
  gl_.CullFace(GL_BACK);
  gl_.FrontFace(GL_CCW);
  gl_.Disable(GL_DITHER);
  draw_parts(opaque_order(view), frame, clip);

  if (mesh_.has(packs::SurfaceKind::glass)) {
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl_.DepthMask(GL_FALSE);
    draw_parts(glass_order(view), frame, clip);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_BLEND);
  }
  check_gl(gl_, "drawing a frame");
  drawn_ = frame;
  ++draws_;
}

}  // namespace lackwerk::gles
