// Functions on the unit square given at nodes, and the map of the square onto itself that one of them defines.
//
// Why it exists: RGL's files store a BRDF on squares that are warped by the density of visible normals, so that their
// few nodes lie where the material reflects. Reading a value means inverting that warp. Values; any thread.
//
// Nodes of a square stand at x = k / (width - 1), y = l / (height - 1); between them values are bilinear. A square may
// depend on up to three parameters (azimuth and elevation of the light, channel), linear between their values and
// constant beyond (Dupuy & Jakob 2018, section 5.3; Marginal2D of their reader).
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace lackwerk::packs {

/// A family of functions on the unit square.
class RglSquare {
 public:
  /// `nodes`: height * width values per slice, slices ordered like nested loops over `parameters`, the last fastest.
  /// Each parameter list rises. width and height >= 2. Sizes must agree (checked: an invariant of the caller).
  RglSquare(std::vector<float> nodes, std::size_t width, std::size_t height,
            std::vector<std::vector<float>> parameters);

  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t height() const { return height_; }
  /// Value at a point of [0, 1]^2. `parameters`: one per list.
  [[nodiscard]] double eval(const glm::dvec2& at, std::span<const double> parameters) const;

 protected:
  static constexpr std::size_t max_parameters = 3;
  /// Which slices take part, with which weights. At most 2^3.
  struct Blend {
    std::array<std::size_t, 8> slice{};
    std::array<double, 8> weight{};
    std::size_t count = 0;
  };
  /// The lower node of the patch a point lies in, and the place in it, [0, 1].
  struct Place {
    std::size_t x = 0, y = 0;
    double u = 0.0, v = 0.0;
  };
  [[nodiscard]] Blend blend(std::span<const double> parameters) const;
  [[nodiscard]] Place place(const glm::dvec2& at) const;
  /// Blends entry `index` of arrays with `stride` entries per slice.
  template <class T>
  [[nodiscard]] static double mixed(const std::vector<T>& values, const Blend& blend, std::size_t stride,
                                    std::size_t index) {
    double sum = 0.0;
    for (std::size_t k = 0; k < blend.count; ++k)
      sum += blend.weight[k] * static_cast<double>(values[blend.slice[k] * stride + index]);
    return sum;
  }

  std::size_t width_, height_;
  std::vector<float> nodes_;
  std::vector<std::vector<float>> parameters_;
};

/// A family of densities, and the warp from uniform points to points distributed by them: rows by their marginal, then
/// within the row.
class RglWarp : private RglSquare {
 public:
  /// As RglSquare; values >= 0, and no slice may hold only zeros (`has_empty_slice` says so). Densities are normalised
  /// per slice, before slices are blended.
  RglWarp(std::vector<float> nodes, std::size_t width, std::size_t height, std::vector<std::vector<float>> parameters);

  [[nodiscard]] bool has_empty_slice() const { return has_empty_slice_; }
  /// The uniform point that the warp sends to `at`.
  [[nodiscard]] glm::dvec2 invert(const glm::dvec2& at, std::span<const double> parameters) const;
  /// The point to which the warp sends a uniform point. The inverse of the above where the density is not 0.
  [[nodiscard]] glm::dvec2 sample(const glm::dvec2& uniform, std::span<const double> parameters) const;

 private:
  struct Row;                        ///< two rows of nodes, blended at a height between them
  std::vector<double> conditional_;  ///< per row, integral from the left up to a node; ends at the row's total
  std::vector<double> marginal_;     ///< integral of the rows' totals up to a row; ends at 1
  bool has_empty_slice_ = false;
};

}  // namespace lackwerk::packs
