// Draws a scene with one realised paint.
//
// Why it exists: the kiosk, `lackwerk render` and the tests draw the same pictures through it. It uploads what changed,
// compiles what the scene and the pack need, and can say why a frame need not be drawn again. Reads the paint through
// a pointer (whoever made it keeps it alive); copies the scene to the GPU. Its context must outlive it and be current
// in every call but needs_draw, explain and the counters; one GL thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render_gles/framebuffer.hpp"
#include "render_gles/image.hpp"
#include "render_gles/mesh_buffers.hpp"
#include "render_gles/paint_gpu.hpp"
#include "render_gles/program.hpp"
#include "render_gles/view.hpp"

namespace lackwerk::gles {

class Renderer {
 public:
  explicit Renderer(Context& context);
  /// Makes its context current to delete what it owns.
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Uploads the scene's parts; the scene may go afterwards.
  void set_scene(const packs::Scene& scene);

  /// Takes a pack's paints; their static textures are uploaded. Call update before the next draw.
  /// `paint` must outlive its use. Error: too large for the driver; the previous paint stays.
  [[nodiscard]] Result<void> set_paint(const core::InterpolatablePaint& paint);

  /// Realises the paint at these weights and uploads what changed. Error: weights refused; nothing has changed then.
  [[nodiscard]] Result<void> update(const core::Weights& weights);

  /// Whether a draw with these values could differ from the last one into a picture of this size.
  [[nodiscard]] bool needs_draw(const View& view, const Lighting& lighting, const Framebuffer& target) const;

  /// Draws one frame. Needs a scene and, if the scene has paint, set_paint and update before it.
  void draw(const View& view, const Lighting& lighting, const Framebuffer& target);

  /// Compiles what draw would need for this lighting, so that the first frame is not late.
  void prepare(const Lighting& lighting);

  /// Still quality: `samples` frames, each shifted by part of a pixel, averaged in linear light on the CPU in a fixed
  /// order. `samples` >= 1. Leaves the last frame in `target`.
  [[nodiscard]] Image still(const View& view, const Lighting& lighting, const Framebuffer& target, int samples);

  /// What was left out of the last drawn frame and why, and what was compiled; one line each.
  [[nodiscard]] std::vector<std::string> explain() const;

  [[nodiscard]] std::uint64_t draw_count() const { return draws_; }
  /// Paint textures sent so far (geometry is sent once, by set_scene).
  [[nodiscard]] UploadCount uploads() const { return paint_ ? paint_->uploads() : UploadCount{}; }
  [[nodiscard]] std::size_t program_count() const { return programs_.size(); }
  /// The paint on the GPU, or null before set_paint.
  [[nodiscard]] const PaintGpu* paint() const { return paint_ ? &*paint_ : nullptr; }
  /// Bounds of the scene, mm; empty before set_scene.
  [[nodiscard]] const Box& bounds() const { return bounds_; }

 private:
  struct Frame {
    View view;
    Lighting lighting;
    int width = 0, height = 0;
    GLuint texture = 0;
    std::uint64_t revision = 0;
    bool operator==(const Frame&) const = default;
  };
  [[nodiscard]] Features features_of(packs::SurfaceKind surface, const Lighting& lighting) const;
  [[nodiscard]] std::vector<const MeshBuffers::Draw*> opaque_order(const View& view) const;
  [[nodiscard]] std::vector<const MeshBuffers::Draw*> glass_order(const View& view) const;
  void apply_frame(const Program& program, const Frame& frame, const glm::mat4& clip) const;
  void draw_parts(const std::vector<const MeshBuffers::Draw*>& parts, const Frame& frame, const glm::mat4& clip);

  Context& context_;
  const GlApi& gl_;
  ProgramCache programs_;
  MeshBuffers mesh_;
  std::vector<Box> boxes_;
  Box bounds_;
  glm::vec2 floor_shadow_{0.0f};  ///< half length and half width of what stands on the floor, mm
  std::optional<PaintGpu> paint_;
  std::uint64_t revision_ = 0;  ///< rises with every change of scene or paint
  std::optional<Frame> drawn_;
  std::uint64_t draws_ = 0;
};

}  // namespace lackwerk::gles
