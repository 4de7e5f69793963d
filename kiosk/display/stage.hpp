// A stage: a context, one framebuffer, one renderer, with a pack and a scene on it. A pack of paints is shown on the
// scene by gles::Renderer, a pack of scans by gles::ScanRenderer; the one that is not needed does not exist.
//
// Why it exists: the kiosk and the tools that draw set up the same four things in the same order and must take them
// down in the reverse one. Owns them all, but for a context that was given; one GL thread.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "packs/exhibit_pack.hpp"
#include "packs/scene.hpp"
#include "render_gles/context.hpp"
#include "render_gles/framebuffer.hpp"
#include "render_gles/renderer.hpp"
#include "render_gles/scan_renderer.hpp"

namespace lackwerk::kiosk {

class Stage {
 public:
  /// `width`, `height` in pixels, [16, 8192]. Errors: backend, framebuffer or paint refused by the driver.
  [[nodiscard]] static Result<std::unique_ptr<Stage>> create(gles::Backend backend, int width, int height,
                                                             packs::ExhibitPack pack, packs::Scene scene,
                                                             const gles::ContextSettings& settings = {});

  /// The same on somebody else's context, which must outlive the stage and be current.
  [[nodiscard]] static Result<std::unique_ptr<Stage>> create(gles::Context& context, int width, int height,
                                                             packs::ExhibitPack pack, packs::Scene scene);

  /// Another picture size; the old picture is lost. Error: framebuffer refused by the driver; the old one stays.
  [[nodiscard]] Result<void> resize(int width, int height);

  /// Another pack in place of this one, of either kind. Error: its paint is refused by the driver; the old pack stays.
  [[nodiscard]] Result<void> set_pack(packs::ExhibitPack pack);

  [[nodiscard]] const packs::ExhibitPack& pack() const { return pack_; }
  [[nodiscard]] bool shows_scans() const { return pack_.scans() != nullptr; }
  /// Where it is looked at from: the scene's cameras, or one around the scans. Never empty.
  [[nodiscard]] const std::vector<packs::Camera>& cameras() const { return cameras_; }
  [[nodiscard]] const packs::Scene& scene() const { return scene_; }
  [[nodiscard]] gles::Context& context() { return *context_; }
  [[nodiscard]] gles::Framebuffer& framebuffer() { return *framebuffer_; }
  /// Of paints; there is none while scans are shown.
  [[nodiscard]] gles::Renderer& renderer();
  /// Of scans; there is none while paints are shown.
  [[nodiscard]] gles::ScanRenderer& scan_renderer();

 private:
  Stage(packs::ExhibitPack pack, packs::Scene scene) : pack_(std::move(pack)), scene_(std::move(scene)) {}

  packs::ExhibitPack pack_;
  packs::Scene scene_;
  [[nodiscard]] Result<void> set_up(int width, int height);
  [[nodiscard]] Result<void> show();
  void show_scans();

  std::unique_ptr<gles::Context> own_context_;
  gles::Context* context_ = nullptr;
  std::unique_ptr<gles::Framebuffer> framebuffer_;
  std::unique_ptr<gles::Renderer> renderer_;
  std::unique_ptr<gles::ScanRenderer> scan_renderer_;
  std::vector<packs::Camera> cameras_;
};

struct Size {
  int width = 1280;
  int height = 720;
};
/// "1280x720". Error (usage): not two numbers in [16, 8192].
[[nodiscard]] Result<Size> parse_size(const std::string& text);

}  // namespace lackwerk::kiosk
