#include "core/level0_paint.hpp"

namespace lackwerk::core {

InterpolatablePaint level0_of(const InterpolatablePaint& paint) {
  InterpolatablePaint out = paint;
  const auto rows = static_cast<std::size_t>(paint.level_count > 0 ? paint.layout.slice_count() : 0);
  if (rows == 0) return out;
  out.level_count = 1;
  out.tuple_begin = paint.tuple_begin.first(rows + 1);
  out.mass = paint.mass.first(out.tuple_begin.back());
  for (InterpolatablePaint::PaintPart& part : out.paints) {
    part.cluster_begin = part.cluster_begin.first(rows + 1);
    part.clusters = part.clusters.first(part.cluster_begin.back());
    part.tuple_cluster = part.tuple_cluster.first(out.mass.size());
  }
  return out;
}

PaintTextures mean_textures(const InterpolatablePaint& paint, RealisedPaint& realised) {
  PaintTextures out;
  out.row_count = paint.row_count();
  out.mean.assign(std::size_t{angle_grid} * angle_grid * 4, 0);
  update_textures(paint, realised, out);
  return out;
}

}  // namespace lackwerk::core
