#include "tests/render/cpu_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/paint_model.hpp"
#include "render_gles/display_model.hpp"

namespace lackwerk::test {
namespace {

using glm::dvec2;
using glm::dvec3;

using Model = core::PaintModel<double>;

/// flake_factor as FLAKE_TAPS 1 compiles it: C++ has the four-tap text.
dvec3 nearest_flakes(Model& model, const Model::Geometry& g, const dvec2& texel, double lod) {
  const double fh = g.theta_h * model.u_bins_per_rad;
  const double fi = g.theta_i * model.u_bins_per_rad;
  const double last = model.u_level_count - 1.0;
  const dvec3 mean = model.flake_mean(g.theta_h, g.theta_i);
  const double low = std::floor(std::max(lod, 0.0));
  const double part = std::max(lod, 0.0) - low;
  const auto level = [&](double l) { return l >= last ? mean : model.flake_nearest(fh, fi, texel, l); };
  return level(low) * (1.0 - part) + level(low + 1.0) * part;
}

dvec3 paint_factor(Model& model, gles::FlakeMode mode, const dvec3& n, const dvec3& i, const dvec3& o,
                   const dvec2& texel, double lod) {
  const bool bilinear = mode == gles::FlakeMode::bilinear;
  const dvec3 factor = model.paint_factor(n, i, o, texel, lod, bilinear ? 1.0 : 0.0);
  if (mode != gles::FlakeMode::nearest || glm::dot(n, i) <= 0.0) return factor;
  // The same with the nearest slice's flakes in place of the mean, through the same coat.
  const double eta = model.u_refraction_ior;
  const auto g = model.paint_geometry(n, model.refract_into(i, n, eta), model.refract_into(o, n, eta));
  const double through = (1.0 - model.fresnel_dielectric(glm::dot(n, i), model.u_coat_ior)) *
                         (1.0 - model.fresnel_dielectric(glm::dot(n, o), model.u_coat_ior));
  return factor + through * (nearest_flakes(model, g, texel, lod) - model.flake_mean(g.theta_h, g.theta_i));
}

}  // namespace

CpuPicture shade_sphere(float radius_mm, const gles::View& view, const gles::Lighting& lighting,
                        const core::InterpolatablePaint& paint, const gles::PaintGpu& gpu, int width, int height,
                        double min_cosine) {
  Model model;
  core::bind_model(paint, gpu.analytic(), gpu.textures(), model);
  gles::DisplayModel<double> display;
  const bool flakes = lighting.quality.flakes != gles::FlakeMode::off && gpu.textures().row_count > 0;
  core::PaintTextures bare;  // no flakes: the same textures without means and slices
  if (!flakes) {
    bare = gpu.textures();
    bare.mean.clear();
    bare.slice.clear();
    model.textures = &bare;
  }
  const dvec3 eye(view.eye_mm);
  const dvec3 forward = glm::normalize(dvec3(view.target_mm) - eye);
  const dvec3 right = glm::normalize(glm::cross(forward, dvec3(0, 0, 1)));
  const dvec3 up = glm::cross(right, forward);
  const double half = std::tan(glm::radians(static_cast<double>(view.vertical_fov_deg)) * 0.5);
  const double texels_per_mm = gpu.texel_mm() > 0.0f ? 1.0 / gpu.texel_mm() : 0.0;
  const double pixel_texels = 2.0 * half / height * texels_per_mm;
  const double radius = radius_mm;

  CpuPicture out;
  out.image = gles::Image(width, height);
  out.mask.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = (2.0 * (x + 0.5) / width - 1.0) * half * width / height;
      const double v = (1.0 - 2.0 * (y + 0.5) / height) * half;
      const dvec3 ray = glm::normalize(forward + right * u + up * v);
      const double b = glm::dot(ray, eye);
      const double d = b * b - glm::dot(eye, eye) + radius * radius;
      if (d < 0.0) continue;
      const double distance = -b - std::sqrt(d);
      const dvec3 p = eye + ray * distance;
      const dvec3 n = p / radius;
      const dvec3 o = -ray;
      const double co = glm::dot(n, o);
      const dvec2 texel = model.surface_texel(p, n, texels_per_mm);
      const double lod = model.surface_lod(distance, co, pixel_texels);
      dvec3 sum(0.0);
      for (std::size_t k = 0; k < lighting.lights.size(); ++k) {
        const dvec3 i(lighting.lights[k].direction);
        const bool single = flakes && static_cast<int>(k) < lighting.quality.flake_lights;
        sum += dvec3(lighting.lights[k].radiance) * std::max(glm::dot(n, i), 0.0) *
               paint_factor(model, single ? lighting.quality.flakes : gles::FlakeMode::mean, n, i, o, texel, lod);
      }
      const dvec3 shown = display.display_transform(sum * static_cast<double>(lighting.exposure));
      const std::size_t at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      for (int c = 0; c < 3; ++c)
        out.image.rgb[3 * at + static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::lround(std::clamp(shown[c], 0.0, 1.0) * 255.0));
      ++out.hit;
      if (co <= min_cosine) continue;
      out.mask[at] = 1;
      ++out.compared;
    }
  return out;
}

}  // namespace lackwerk::test
