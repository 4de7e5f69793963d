// Draws a scene with one realised paint.
//
// Why it exists: the kiosk, `lackwerk render` and the tests draw the same pictures through it. It uploads what changed,
// compiles what the scene and the pack need, and can say why a frame need not be drawn again. Reads the paint through
// a pointer (whoever made it keeps it alive); copies the scene to the GPU. Its context must outlive it and be current
// in every call but needs_draw, explain and the counters; one GL thread.
//
// Two qualities: draw() is for pictures that move, one pass with prefiltered light; refine() adds sampled frames to a
// still one until it has converged, and fades over to it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render_gles/accumulator.hpp"
#include "render_gles/framebuffer.hpp"
#include "render_gles/image.hpp"
#include "render_gles/light_shares.hpp"
#include "render_gles/material_table.hpp"
#include "render_gles/mesh_buffers.hpp"
#include "render_gles/paint_gpu.hpp"
#include "render_gles/program.hpp"
#include "render_gles/screen_pass.hpp"
#include "render_gles/view.hpp"

namespace lackwerk::gles {

/// Frames of a converged still picture. docs/figures.md says how far that is from the reference.
inline constexpr int still_frames = 128;
/// From this many frames on a still picture samples the environment; fewer only smooth the moving one.
inline constexpr int sampled_still_frames = 32;

/// Flakes under a pixel whose sum varies by less than this share of its mean are drawn as their mean. Flakes give about
/// half of a metallic's light, so 4 % of theirs is two steps of 8 bits at one standard deviation, on a grain a pixel
/// and a half wide: not to be seen in motion. A picture that rests is held to half a step.
inline constexpr double moving_contrast = 0.04;
inline constexpr double still_contrast = 0.01;

/// Bytes on the GPU, without what the driver adds.
struct GpuBytes {
  std::size_t geometry = 0, environment = 0, paint = 0, materials = 0;
  std::size_t pictures = 0;  ///< frame buffers of still and scaled pictures and of the floor's mirror
  [[nodiscard]] std::size_t without_pictures() const { return geometry + environment + paint + materials; }
};

/// What one thing that was left out would have cost.
struct Saving {
  std::string what;
  double with_ms = 0.0, without_ms = 0.0;  ///< medians of a moving frame
};

class Renderer {
 public:
  explicit Renderer(Context& context);
  /// Makes its context current to delete what it owns.
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Uploads the scene's parts and environment; the scene may go afterwards.
  void set_scene(const packs::Scene& scene);

  /// Takes a pack's paints; their static textures are uploaded. Call update before the next draw.
  /// `paint` must outlive its use; `map` is copied and stands in for its colour table, see PaintGpu::create.
  /// Error: too large for the driver, or a bad map; the previous paint stays.
  [[nodiscard]] Result<void> set_paint(const core::InterpolatablePaint& paint, const PaintMap* map = nullptr);

  /// Realises the paint at these weights and uploads what changed. Error: weights refused; nothing has changed then.
  [[nodiscard]] Result<void> update(const core::Weights& weights);

  /// Makes the single flakes of this mip level and coarser ones those of the last update, as draw does for what its
  /// view shows: for those who read or draw the paint's textures themselves. Needs set_paint and update before it.
  void bring_flakes(int finest_level) { paint_->bring(finest_level); }

  /// Whether a draw with these values could differ from the last one into a picture of this size.
  [[nodiscard]] bool needs_draw(const View& view, const Lighting& lighting, const Framebuffer& target) const;

  /// Draws one moving frame. Needs a scene and, if the scene has paint, set_paint and update before it.
  void draw(const View& view, const Lighting& lighting, const Framebuffer& target);

  /// Compiles what draw would need for this lighting, so that the first frame is not late.
  void prepare(const View& view, const Lighting& lighting, const Framebuffer& target);

  /// What a refine() did.
  struct Refined {
    bool more = false;   ///< further calls would improve the picture
    bool frame = false;  ///< a frame has been finished and added
    bool shown = false;  ///< `target` has changed
  };
  /// Adds to the still picture of what draw() drew last into `target`, and shows it once it is good enough (fading over
  /// from the moving picture). `strips`, in [1, max_strips]: a frame is drawn in so many calls, so that none takes
  /// long; counts from the next frame on. Does nothing if anything has changed since draw(). Error: no memory for the
  /// frame buffers.
  [[nodiscard]] Result<Refined> refine(const View& view, const Lighting& lighting, const Framebuffer& target,
                                       int frames = still_frames, int strips = 1);
  static constexpr int max_strips = 16;

  /// A still picture of `samples` frames, in [1, Accumulator::max_frames], also left in `target`. 1 is one moving
  /// frame; below sampled_still_frames the moving picture is smoothed; from there on the environment is sampled.
  [[nodiscard]] Image still(const View& view, const Lighting& lighting, const Framebuffer& target, int samples);

  /// White where something stands, black where floor or background show: what pictures of the subject are compared on.
  /// Left in `target` too.
  [[nodiscard]] Image subject(const View& view, const Framebuffer& target);

  /// What was left out of the last drawn frame and why, and what was compiled; one line each.
  [[nodiscard]] std::vector<std::string> explain() const;

  /// Draws this picture with each left-out part put back (which changes no pixel by more than rounding, but for single
  /// flakes, whose sum it then draws) and without, in turn, `runs` times each. Leaves the plain picture in `target`.
  [[nodiscard]] std::vector<Saving> measure_savings(const View& view, const Lighting& lighting,
                                                    const Framebuffer& target, int runs = 5);

  [[nodiscard]] std::uint64_t draw_count() const { return draws_; }
  /// Paint textures sent so far (geometry is sent once, by set_scene).
  [[nodiscard]] UploadCount uploads() const { return paint_ ? paint_->uploads() : UploadCount{}; }
  [[nodiscard]] std::size_t program_count() const { return programs_.size(); }
  /// The paint on the GPU, or null before set_paint.
  [[nodiscard]] const PaintGpu* paint() const { return paint_ ? &*paint_ : nullptr; }
  /// Bounds of the scene, mm; empty before set_scene.
  [[nodiscard]] const Box& bounds() const { return bounds_; }
  [[nodiscard]] GpuBytes gpu_bytes() const;
  /// Mip level of the flakes on the nearest paint, seen face on.
  [[nodiscard]] double finest_level(const View& view, int height) const;
  /// Whether single flakes of the paint can show from here at this picture height; else their mean is drawn.
  /// `contrast`: see moving_contrast.
  [[nodiscard]] bool flakes_show(const View& view, int height, double contrast) const;

 private:
  struct Frame {
    View view;
    Lighting lighting;
    int width = 0, height = 0;
    GLuint texture = 0;
    std::uint64_t revision = 0;
    bool operator==(const Frame&) const = default;
  };
  /// What is compiled in although nothing needs it, to measure what leaving it out saves.
  struct Keep {
    bool lobes = false, coat = false, refraction = false, sharp_levels = false, single_flakes = false;
  };
  /// One time through the geometry.
  struct Pass {
    ShaderPath path = ShaderPath::filtered;
    ShaderOutput output = ShaderOutput::display;
    std::span<const DirectionalLight> lights;
    int flake_lights = 0;
    int sparkle_lights = 0;
    bool still_flakes = false;
    bool floor_mirror = false;
    int cut = 0;         ///< the lights are of a cut of the environment into so many; 0: they are the mood's
    double parts = 1.0;  ///< effective_parts of that cut
    std::uint8_t detail = packs::detail_full;
    glm::vec3 sample{0.0f};     ///< u, v, number of frames
    int strip = 0, strips = 1;  ///< the part of the picture's rows that is drawn
    bool mirrored = false;      ///< seen from below the floor, without the floor
    bool black = false;         ///< clears to black instead of the backdrop: an addition to another pass
  };
  /// Whether the paint is drawn with one lobe: no light needs the others.
  [[nodiscard]] static bool merges_lobes(const Lighting& lighting, const Pass& pass);
  [[nodiscard]] Features features_of(const MeshBuffers::Draw& part, const Lighting& lighting, const Pass& pass) const;
  [[nodiscard]] std::vector<const MeshBuffers::Draw*> order_of(const View& view, const Pass& pass, bool glass) const;
  void apply_frame(const Program& program, const Frame& frame, const Pass& pass, const glm::mat4& clip) const;
  void apply_material(const Program& program, packs::SurfaceKind kind, const Frame& frame, const Pass& pass) const;
  void draw_parts(const std::vector<const MeshBuffers::Draw*>& parts, const Frame& frame, const Pass& pass,
                  const glm::mat4& clip);
  void draw_pass(const Frame& frame, const Pass& pass, const Framebuffer& target);
  void draw_mirror(const Frame& frame);
  void draw_moving(const Frame& frame, const Framebuffer& target);
  void add_passes(const Frame& frame, const std::vector<Pass>& passes, Accumulator& sum);
  /// Draws strip `strip` of `strips` of a still picture's frame; true when that finished it and added it to the sum.
  bool add_sampled(const Frame& frame, int index, int frames, Accumulator& sum, int strip = 0, int strips = 1);
  [[nodiscard]] Pass moving_pass(const Frame& frame) const;
  /// What a moving picture is put together from; `cut` keeps the lights of a cut alive.
  [[nodiscard]] std::vector<Pass> passes_of(const Frame& frame, std::vector<DirectionalLight>& cut) const;
  [[nodiscard]] std::vector<Pass> light_passes(const Frame& frame, std::vector<DirectionalLight>& cut) const;
  /// Whether a pass's lights stand on the room's wall and floor.
  [[nodiscard]] bool in_room(const Pass& pass) const { return pass.cut > 0 && environment_.room_radius_mm > 0.0f; }
  /// What the lights of this pass give of a surface; everything unless they are a cut.
  [[nodiscard]] LightShares shares_of(packs::SurfaceKind kind, const Pass& pass) const;
  [[nodiscard]] Result<void> ensure_accumulator(int width, int height);
  [[nodiscard]] Frame frame_of(const View& view, const Lighting& lighting, const Framebuffer& target) const;

  Context& context_;
  const GlApi& gl_;
  ProgramCache programs_;
  ScreenPass screen_;
  MaterialTable materials_;
  MeshBuffers mesh_;
  std::vector<Box> boxes_;
  std::vector<Box> paint_boxes_;  ///< of the paint in cells of some decimetres: how near it is
  Box bounds_;
  core::Environment environment_;  ///< without its atlas
  float irradiance_range_ = 1.0f;
  GlObject environment_texture_;
  std::vector<core::EnvironmentLight> sparkle_;  ///< strongest lights of the environment
  std::optional<PaintGpu> paint_;
  std::optional<Framebuffer> mirror_, unfinished_;  ///< unfinished: before scaling and smoothing
  std::optional<Accumulator> accumulator_;
  std::uint64_t revision_ = 0;  ///< rises with every change of scene or paint
  std::optional<Frame> drawn_;
  std::optional<Frame> refined_;  ///< what the accumulator's frames show
  int strip_ = 0, strips_ = 1;    ///< of the frame that is being added
  Keep keep_;
  bool left_out_flakes_ = false;  ///< of the last frame: too small to show
  std::uint64_t draws_ = 0;
};

}  // namespace lackwerk::gles
