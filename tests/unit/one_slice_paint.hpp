// A paint of flakes alone, all of them in the slice at (0, 0), realised and bound to a model on the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "core/paint_model.hpp"
#include "core/paint_textures.hpp"
#include "core/realise.hpp"

namespace lackwerk::core::testing {

/// What one mip level holds: boxes on the grid of `OneSlicePaint::range`, each with its mass.
struct FlakeRow {
  std::vector<QuantisedCuboid> boxes;
  std::vector<std::uint32_t> mass;
};

class OneSlicePaint {
 public:
  InterpolatablePaint paint;
  PaintTextures textures;
  PaintModel<double> model;

  /// Two levels whose masses have one sum.
  OneSlicePaint(const FlakeRow& near, const FlakeRow& far, std::uint64_t seed) {
    for (const FlakeRow* row : {&near, &far}) {
      for (std::size_t k = 0; k < row->boxes.size(); ++k) index_.push_back(static_cast<std::uint8_t>(k));
      boxes_.insert(boxes_.end(), row->boxes.begin(), row->boxes.end());
      mass_.insert(mass_.end(), row->mass.begin(), row->mass.end());
      begin_.push_back(static_cast<std::uint32_t>(boxes_.size()));
    }
    for (const std::uint32_t m : near.mass) paint.row_mass += m;
    paint.layout = {12, {0, 1}};
    paint.level_count = 2;
    paint.texel_mm = 0.05f;
    paint.level0_texels = 2;
    paint.range = {{0.0f, -100.0f, -100.0f}, {200.0f, 100.0f, 100.0f}};
    paint.tuple_begin = begin_;
    paint.mass = mass_;
    paint.random_seed = seed;
    paint.paints.push_back({{}, {}, begin_, boxes_, index_, {}});
    RealisedPaint realised;
    realise(paint, Weights::uniform({1.0}), realised);
    textures = make_static_textures(paint);
    const AnalyticPaint analytic = realised.analytic;
    update_textures(paint, realised, textures);
    bind_model(paint, analytic, textures, model);
  }
  ~OneSlicePaint() = default;
  OneSlicePaint(const OneSlicePaint&) = delete;  // the paint's spans are of this object's arrays
  OneSlicePaint& operator=(const OneSlicePaint&) = delete;
  OneSlicePaint(OneSlicePaint&&) = delete;
  OneSlicePaint& operator=(OneSlicePaint&&) = delete;

 private:
  std::vector<QuantisedCuboid> boxes_;
  std::vector<std::uint32_t> begin_{0}, mass_;
  std::vector<std::uint8_t> index_;
};

}  // namespace lackwerk::core::testing
