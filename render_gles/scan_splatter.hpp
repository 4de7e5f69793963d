// Points of a scan drawn by the CPU: moved, sorted by depth, lit where they are seen.
//
// Why it exists: a software rasteriser takes a quarter of a microsecond to set up each point, however small it is;
// this takes a tenth of that (docs/figures.md). Draws what scan_vertex.glsl and scan_fragment.glsl draw. Owns its
// buffers, which keep their size from frame to frame; one thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "packs/scan_pack.hpp"

namespace lackwerk::gles {

/// The uniforms of scan_vertex.glsl.
struct SplatShot {
  float time = 0.0f;                                ///< [0, 1] within the step
  glm::mat4 clip{1.0f};                             ///< clip space of the pack's cube
  glm::vec3 up{0, 0, 1}, key{0, 0, 1};              ///< unit vectors in the scan's axes
  glm::vec3 eye{0.0f};                              ///< in the pack's cube
  glm::vec3 albedo{1.0f}, sky{1.0f}, sun{1.0f};     ///< linear
  float point_px = 1.0f;                            ///< edge of a splat at clip w of 1
  float least_splat_px = 1.0f, most_splat_px = 32;  ///< 0 < least <= most
  bool round = false;                               ///< discs instead of squares
};

class ScanSplatter {
 public:
  /// Pixels [x, x + width) x [y, y + height), y upwards as GL counts.
  struct Rectangle {
    int x = 0, y = 0, width = 0, height = 0;
  };
  using Texel = std::array<std::uint8_t, 4>;  ///< the screen's red, green, blue; 255, or 0 where no point is

  /// Draws `paths` into a picture of width x height pixels, both >= 1; what stood there before is gone.
  void draw(std::span<const packs::ScanPath> paths, const SplatShot& shot, int width, int height);
  /// All that is not empty lies in here; without any point it is empty.
  [[nodiscard]] Rectangle rectangle() const { return rectangle_; }
  /// The rectangle's rows, the lowest first.
  [[nodiscard]] std::span<const Texel> texels() const { return texels_; }

 private:
  void splat(std::span<const packs::ScanPath> paths, const SplatShot& shot);
  void resolve(std::span<const packs::ScanPath> paths, const SplatShot& shot);

  int width_ = 0, height_ = 0;
  Rectangle rectangle_;
  std::vector<std::uint64_t> nearest_;  ///< depth, then which point; row by row
  std::vector<Texel> colours_;          ///< of points that are seen
  std::vector<Texel> texels_;
};

}  // namespace lackwerk::gles
