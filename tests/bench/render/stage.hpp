// What the renderer's benchmarks draw: a pack and a scene on one context, from several cameras.
//
// Why it exists: every section needs the same context, target and scene, and "draw one frame and wait". Owns them; one
// GL thread.
#pragma once

#include <memory>
#include <string>

#include "packs/paint_pack.hpp"
#include "packs/scene.hpp"
#include "render_gles/renderer.hpp"

namespace lackwerk::bench {

class Stage {
 public:
  /// Error: a file that cannot be read, or no context.
  [[nodiscard]] static Result<std::unique_ptr<Stage>> open(const std::string& pack, const std::string& scene,
                                                           gles::Backend backend, int width, int height);

  [[nodiscard]] const gles::Context& context() const { return *context_; }
  [[nodiscard]] gles::Context& context() { return *context_; }
  [[nodiscard]] gles::Renderer& renderer() { return *renderer_; }
  [[nodiscard]] const gles::Framebuffer& target() const { return *target_; }
  [[nodiscard]] const core::InterpolatablePaint& paint() const { return pack_.paint(); }
  [[nodiscard]] const packs::Scene& scene() const { return scene_; }
  /// Puts another scene on the stage, under the light of the file's.
  void show(packs::Scene scene);

  /// The scene's camera, turned around the car's axis by a tenth of a degree a frame.
  [[nodiscard]] gles::View view(const std::string& camera, int frame) const;
  /// Draws one moving frame and waits for it.
  void draw(const gles::View& view, const gles::Quality& quality);
  /// A mix that no two frames share.
  [[nodiscard]] core::Weights weights(int frame) const;

 private:
  explicit Stage(packs::PaintPack pack) : pack_(std::move(pack)) {}
  packs::PaintPack pack_;
  packs::Scene scene_;
  std::unique_ptr<gles::Context> context_;
  std::unique_ptr<gles::Framebuffer> target_;
  std::unique_ptr<gles::Renderer> renderer_;
};

/// A plate of paint that fills the picture from its "macro" camera: 320 x 180 mm seen from 250 mm.
[[nodiscard]] packs::Scene plate(const packs::Scene& light);

}  // namespace lackwerk::bench
