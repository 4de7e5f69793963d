#include "tests/bench/render/stage.hpp"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "packs/scene_pack.hpp"

namespace lackwerk::bench {

Result<std::unique_ptr<Stage>> Stage::open(const std::string& pack, const std::string& scene, gles::Backend backend,
                                           int width, int height) {
  auto paints = packs::PaintPack::open(pack);
  if (!paints) return tl::unexpected(paints.error());
  auto read = packs::read_scene_pack(scene);
  if (!read) return tl::unexpected(read.error());
  auto context = gles::create_context(backend);
  if (!context) return tl::unexpected(context.error());
  std::unique_ptr<Stage> out(new Stage(std::move(*paints)));
  out->context_ = std::move(*context);
  auto target = gles::Framebuffer::create(*out->context_, width, height);
  if (!target) return tl::unexpected(target.error());
  out->target_ = std::make_unique<gles::Framebuffer>(std::move(*target));
  out->renderer_ = std::make_unique<gles::Renderer>(*out->context_);
  out->show(std::move(*read));
  if (auto ok = out->renderer_->set_paint(out->paint()); !ok) return tl::unexpected(ok.error());
  if (auto ok = out->renderer_->update(out->weights(0)); !ok) return tl::unexpected(ok.error());
  return out;
}

void Stage::show(packs::Scene scene) {
  scene_ = std::move(scene);
  renderer_->set_scene(scene_);
}

gles::View Stage::view(const std::string& camera, int frame) const {
  const auto found = std::find_if(scene_.cameras.begin(), scene_.cameras.end(),
                                  [&](const packs::Camera& candidate) { return candidate.name == camera; });
  gles::View view = gles::View::from(found == scene_.cameras.end() ? scene_.cameras.front() : *found);
  const float angle = glm::radians(0.1f * static_cast<float>(frame));
  const float c = std::cos(angle), s = std::sin(angle);
  const glm::vec3 from = view.eye_mm - view.target_mm;
  view.eye_mm = view.target_mm + glm::vec3(c * from.x - s * from.y, s * from.x + c * from.y, from.z);
  return view;
}

void Stage::draw(const gles::View& view, const gles::Quality& quality) {
  gles::Lighting lighting;
  lighting.quality = quality;
  renderer_->draw(view, lighting, *target_);
  context_->gl().Finish();
}

core::Weights Stage::weights(int frame) const {
  const std::size_t paints = paint().paints.size();
  if (paints == 1) return core::Weights::uniform({1.0});
  std::vector<double> w(paints, 0.0);
  const double t = std::fmod(0.37 * frame, 1.0);
  w[0] = 1.0 - t;
  w[1 + static_cast<std::size_t>(frame) % (paints - 1)] = t;
  return core::Weights::uniform(w);
}

packs::Scene plate(const packs::Scene& light) {
  packs::Scene scene;
  scene.name = "plate";
  scene.environment = light.environment;
  scene.irradiance_range = light.irradiance_range;
  packs::MeshPart part;
  part.name = "plate";
  part.positions_mm = {
      {0.0f, -160.0f, 860.0f}, {0.0f, 160.0f, 860.0f}, {0.0f, 160.0f, 1040.0f}, {0.0f, -160.0f, 1040.0f}};
  part.normals.assign(4, {1.0f, 0.0f, 0.0f});
  part.indices = {0, 1, 2, 0, 2, 3};
  part.visibility.assign(4, packs::open_visibility);
  part.irradiance.assign(4, {20000, 20000, 20000});
  scene.parts.push_back(std::move(part));
  scene.cameras.push_back({"macro", {250.0f, 0.0f, 950.0f}, {0.0f, 0.0f, 950.0f}, 39.0f});
  return scene;
}

}  // namespace lackwerk::bench
