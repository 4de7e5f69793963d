// Draws a scan pack at any time: points on their way from one scan to the next, above a floor that they shade.
//
// Why it exists: the second exhibit. Points move in the vertex shader, the GPU holding one step as it lies in the pack;
// on a software rasteriser the CPU draws them itself, which is quicker there (docs/figures.md). Reads the pack through
// a pointer (whoever opened it keeps it alive). Its context must outlive it and be current in every call but
// needs_draw; one GL thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "packs/scan_pack.hpp"
#include "render_gles/context.hpp"
#include "render_gles/framebuffer.hpp"
#include "render_gles/gl_object.hpp"
#include "render_gles/scan_splatter.hpp"
#include "render_gles/view.hpp"

namespace lackwerk::gles {

/// Who moves and draws the points.
enum class ScanWay {
  quickest,  ///< the CPU below a software rasteriser, else shaders
  shaders,   ///< vertex and fragment shader
  cpu,       ///< ScanSplatter; the picture goes to the driver as a texture, every frame
};

/// How a scan is drawn.
struct ScanLook {
  glm::vec3 albedo{0.17f, 0.30f, 0.055f};  ///< linear sRGB; a leaf
  glm::vec3 sky{0.75f, 0.85f, 1.0f};       ///< light from above, linear, times exposure
  glm::vec3 sun{1.9f, 1.75f, 1.5f};        ///< of the key light
  glm::vec3 floor{0.055f, 0.056f, 0.06f};  ///< the floor's light without shade
  glm::vec3 backdrop{0.012f, 0.0125f, 0.014f};
  float key_azimuth_deg = -55.0f, key_height_deg = 50.0f;  ///< where the key light stands, in world axes
  /// Most points that are drawn; the first of the pack's order, their splats grown to cover as much.
  std::size_t most_points = 400'000;
  /// Points nearer than this on the screen are thinned until they are not. Neighbours of points at random are half as
  /// far apart as those of an even grid of as many (Clark & Evans 1954): three quarters of a pixel leave no holes
  /// there.
  float least_spacing_px = 0.75f;
  float least_splat_px = 1.0f, most_splat_px = 32.0f;
  bool dither = true;
  ScanWay way = ScanWay::quickest;
  bool operator==(const ScanLook&) const = default;
};

class ScanRenderer {
 public:
  explicit ScanRenderer(Context& context);
  ~ScanRenderer();
  ScanRenderer(const ScanRenderer&) = delete;
  ScanRenderer& operator=(const ScanRenderer&) = delete;

  /// Takes a pack; its first step is uploaded by the next draw. `pack` must outlive its use.
  void set_pack(const packs::ScanPack& pack);

  /// Draws the pack at `time` (in its own unit; clamped to its scans). Coordinates of the view: z upwards, the origin
  /// below the middle of all scans on their lowest point, the pack's cube 1000 wide. Needs set_pack before it.
  void draw(const View& view, const ScanLook& look, double time, const Framebuffer& target);
  /// Whether draw with these values could differ from the last one into a picture of this size.
  [[nodiscard]] bool needs_draw(const View& view, const ScanLook& look, double time, const Framebuffer& target) const;

  /// A view of all scans from `azimuth_deg` (0: from -y) and `height_deg` above the horizon; they fill most of a
  /// picture of this aspect (width over height).
  [[nodiscard]] View view_from(double azimuth_deg, double height_deg, double aspect) const;
  /// Around everything that any step shows, in the view's coordinates; empty before set_pack.
  [[nodiscard]] const Box& bounds() const { return bounds_; }

  [[nodiscard]] std::uint64_t draw_count() const { return draws_; }
  [[nodiscard]] std::size_t drawn_points() const { return drawn_points_; }
  /// Bytes of the step and of what the CPU drew in the driver.
  [[nodiscard]] std::size_t gpu_bytes() const;
  /// Bytes of steps handed to the driver since this was made, not what the CPU drew.
  [[nodiscard]] std::uint64_t uploaded_bytes() const { return uploaded_bytes_; }

 private:
  struct Shader {
    GlObject program;
    std::map<std::string, GLint, std::less<>> uniforms;
    [[nodiscard]] GLint at(std::string_view name) const;
  };
  struct Frame {
    View view;
    ScanLook look;
    double time = 0.0;
    int width = 0, height = 0;
    GLuint texture = 0;
    bool operator==(const Frame&) const = default;
  };
  [[nodiscard]] bool on_cpu(const ScanLook& look) const;
  void upload(std::size_t step, bool on_cpu);
  void upload_shade(const packs::ScanStep& step);
  void draw_floor(const Frame& frame, const glm::mat4& clip, float t);
  void draw_points(const Frame& frame, const glm::mat4& clip, float t);
  void draw_corners();
  void draw_splats(std::span<const packs::ScanPath> paths, const SplatShot& shot, const Frame& frame);

  Context& context_;
  const GlApi& gl_;
  std::array<Shader, 2> points_;  ///< square, round
  Shader floor_, splats_;
  GlObject vertices_, corners_, shade_, splat_texture_;
  int splat_width_ = 0, splat_height_ = 0;  ///< of its texture
  ScanSplatter splatter_;
  const packs::ScanPack* pack_ = nullptr;
  glm::mat4 world_from_cube_{1.0f};
  Box bounds_;
  std::size_t step_ = 0;
  bool uploaded_ = false, vertices_uploaded_ = false;
  std::size_t vertex_bytes_ = 0, drawn_points_ = 0;
  std::uint64_t uploaded_bytes_ = 0;
  std::optional<Frame> last_;
  std::uint64_t draws_ = 0;
};

}  // namespace lackwerk::gles
