#include "packs/tools/capture_brdf.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/paint_model.hpp"
#include "packs/tools/recipe.hpp"

namespace lackwerk::packs {
namespace {

struct SliceMeans {
  core::SliceLayout layout;
  std::vector<glm::dvec3> means;

  [[nodiscard]] glm::dvec3 at(int bin_h, int bin_i) const {
    const auto slice = layout.slice_at(bin_h, bin_i);
    return slice ? means[static_cast<std::size_t>(*slice)] : glm::dvec3(0.0);
  }
};

}  // namespace

core::MeanFlakes mean_flakes(const Capture& capture) {
  if (capture.slices.empty() || capture.layout.slice_count() != static_cast<int>(capture.slices.size())) return {};
  SliceMeans all{capture.layout, {}};
  for (const FlakeSlice& slice : capture.slices) {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& texel : slice.texels) sum += glm::dvec3(texel);
    all.means.push_back(slice.texels.empty() ? sum : sum / static_cast<double>(slice.texels.size()));
  }
  return [all = std::move(all)](double theta_h, double theta_i) {
    const double h = theta_h / all.layout.bin_width_rad(), i = theta_i / all.layout.bin_width_rad();
    const double wh = h - std::floor(h), wi = i - std::floor(i);
    const int h0 = static_cast<int>(h), i0 = static_cast<int>(i);
    return (all.at(h0, i0) * (1.0 - wh) + all.at(h0 + 1, i0) * wh) * (1.0 - wi) +
           (all.at(h0, i0 + 1) * (1.0 - wh) + all.at(h0 + 1, i0 + 1) * wh) * wi;
  };
}

core::Brdf capture_brdf(const Capture& capture) {
  struct Bound {
    core::AnalyticPaint paint;
    core::PaintModel<double> model;
    core::MeanFlakes flakes;
  };
  auto bound = std::make_shared<Bound>();
  bound->paint = capture.analytic;
  bound->flakes = mean_flakes(capture);
  core::bind_model(core::InterpolatablePaint(), bound->paint, core::no_textures(), bound->model);
  return [bound = std::shared_ptr<const Bound>(bound)](const glm::dvec3& in, const glm::dvec3& out) {
    if (in.z <= 0.0 || out.z <= 0.0) return glm::dvec3(0.0);
    const core::AnalyticPaint& paint = bound->paint;
    core::PaintModel<double> model = bound->model;  // its functions, being GLSL too, cannot be const
    const glm::dvec3 n(0.0, 0.0, 1.0);
    const double eta = paint.refraction_ior;
    const auto g = model.paint_geometry(n, model.refract_into(in, n, eta), model.refract_into(out, n, eta));
    glm::dvec3 factor = model.lobes_factor(g, 1.0) * table_colour(paint, g.theta_h, g.theta_i);
    if (bound->flakes) factor += bound->flakes(g.theta_h, g.theta_i);
    const double through = (1.0 - model.fresnel_dielectric(in.z, paint.coat_ior)) *
                           (1.0 - model.fresnel_dielectric(out.z, paint.coat_ior));
    return factor * (through / std::numbers::pi);
  };
}

}  // namespace lackwerk::packs
