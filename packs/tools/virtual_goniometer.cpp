#include "packs/tools/virtual_goniometer.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "packs/tools/flake_life.hpp"
#include "packs/tools/flake_population.hpp"
#include "packs/tools/node_geometry.hpp"

namespace lackwerk::packs {
namespace {

constexpr double max_flakes = 30e6;

/// What all flakes of one slice share.
struct Shot {
  NodeGeometry at;
  double cos_source = 1.0;  ///< a flake shines where the mirrored eye comes this near to the light
  double tilt_lo = 0.0;     ///< no flake outside these tilts can shine
  double tilt_hi = 0.0;
  double seen = 0.0;       ///< seen footprint / footprint along n: G (h.o) / (h_z o_z), at most 2
  double shining = 0.0;    ///< expected share of flakes (by footprint) that shine
  glm::dvec3 factor{0.0};  ///< radiance factor of a texel that one shining flake covers
};

/// Share of all flakes (by footprint) that shine: the density of normals over the source's cone, with
/// dw_h = dw_i / (4 h.o) (Torrance & Sparrow 1967). Midpoints of rings of equal solid angle.
double shining_share(const NodeGeometry& at, double roughness, double source_radius) {
  constexpr int rings = 64;
  constexpr int spokes = 64;
  const glm::dvec3 side = glm::normalize(glm::cross(at.light, glm::dvec3(1.0, 0.0, 0.1)));
  const glm::dvec3 up = glm::cross(side, at.light);
  const double cap = 1.0 - std::cos(source_radius);
  double sum = 0.0;
  for (int ring = 0; ring < rings; ++ring) {
    const double cosine = 1.0 - cap * (ring + 0.5) / rings;
    const double sine = std::sqrt(1.0 - cosine * cosine);
    for (int spoke = 0; spoke < spokes; ++spoke) {
      const double phi = 2.0 * std::numbers::pi * (spoke + 0.5) / spokes;
      const glm::dvec3 light = at.light * cosine + (side * std::cos(phi) + up * std::sin(phi)) * sine;
      const glm::dvec3 normal = glm::normalize(light + at.eye);
      sum += tilt_density(roughness, normal.z) / (4.0 * glm::dot(normal, at.eye));
    }
  }
  return sum * 2.0 * std::numbers::pi * cap / (rings * spokes);
}

/// Schlick's F of the broadest lobe and its shape D G / (i_z o_z), from the model's own text.
struct LobeAt {
  double fresnel = 0.0;
  double shape = 0.0;
};
LobeAt broad_lobe(const core::AnalyticPaint& paint, const NodeGeometry& at) {
  core::PaintModel<double> model;
  const auto g = model.paint_geometry({0.0, 0.0, 1.0}, at.light, at.eye);
  return {model.fresnel_schlick(g.ho, paint.lobes[0].f0),
          model.lobe_shape(g.tan_h, g.nh, g.ho, g.iz, g.oz, 1.0 / paint.lobes[0].m, 1.0)};
}

/// What one flake mirrors at a node: R = 4 share s F chi / coverage.
glm::dvec3 mirror(const Recipe& recipe, double coverage, double fresnel, double theta_h, double theta_i) {
  return 4.0 * recipe.flakes->share / coverage * fresnel * recipe.analytic.lobes[0].s *
         table_colour(recipe.analytic, theta_h, theta_i);
}

Shot aim(const Recipe& recipe, const FlakePopulation& sample, double theta_h, double theta_i, double source_radius) {
  Shot shot;
  shot.at = node_geometry(theta_h, theta_i);
  shot.cos_source = std::cos(source_radius);
  // Moving the light by dw moves h by at most dw / (2 cos(theta_d)), and theta_d grows by half the radius at most.
  const double reach = source_radius / (2.0 * std::cos(theta_i + 0.5 * source_radius)) + 1e-4;
  shot.tilt_lo = theta_h - reach;
  shot.tilt_hi = theta_h + reach;

  const double hz = shot.at.half.z;
  const double iz = shot.at.light.z;
  const double ho = std::cos(theta_i);
  const double density = tilt_density(sample.roughness, hz);
  if (density < 1e-60) return shot;  // nothing shines that far from the normal
  const LobeAt lobe = broad_lobe(recipe.analytic, shot.at);
  const double sin2 = 1.0 - shot.cos_source * shot.cos_source;
  // D = pi density / h_z, so shape / D = G / (i_z o_z), and i_z = o_z here.
  shot.seen = lobe.shape * iz * ho / (std::numbers::pi * density);
  // The source's cone blurs the lobe; dividing by that blur is the instrument's calibration.
  const double point_share = std::numbers::pi * sin2 * density / (4.0 * ho);
  shot.shining = shining_share(shot.at, sample.roughness, source_radius);
  const double calibration = point_share / shot.shining;
  // pi f = pi R L / E with E = L pi sin^2(alpha) i_z.
  shot.factor = mirror(recipe, sample.coverage, lobe.fresnel, theta_h, theta_i) * (calibration / (sin2 * iz));
  return shot;
}

/// Adds a disc's exact area in each texel, times `value`; the picture wraps around.
void splat(const Flake& flake, double radius, const glm::vec3& value, std::int64_t edge,
           std::vector<glm::vec3>& texels) {
  const double x = flake.x;
  const double y = flake.y;
  const auto x0 = static_cast<std::int64_t>(std::floor(x - radius));
  const auto x1 = static_cast<std::int64_t>(std::floor(x + radius));
  const auto y0 = static_cast<std::int64_t>(std::floor(y - radius));
  const auto y1 = static_cast<std::int64_t>(std::floor(y + radius));
  for (std::int64_t row = y0; row <= y1; ++row) {
    for (std::int64_t column = x0; column <= x1; ++column) {
      double area = std::numbers::pi * radius * radius;
      if (x0 != x1 || y0 != y1) {
        const double left = static_cast<double>(column) - x;
        const double low = static_cast<double>(row) - y;
        area = disc_corner_area(radius, left + 1.0, low + 1.0) - disc_corner_area(radius, left, low + 1.0) -
               disc_corner_area(radius, left + 1.0, low) + disc_corner_area(radius, left, low);
      }
      const std::int64_t wrapped_row = ((row % edge) + edge) % edge;
      const std::int64_t wrapped_column = ((column % edge) + edge) % edge;
      texels[static_cast<std::size_t>(wrapped_row * edge + wrapped_column)] +=
          value * static_cast<float>(std::max(area, 0.0));
    }
  }
}

/// Takes one picture. `even_out` divides by what this finite sample happens to hold too much or too little of the
/// shining flakes; where far too few shine, they are brightened by 4 at most.
void photograph(const FlakePopulation& sample, const Shot& shot, bool even_out, std::uint32_t edge, FlakeSlice& slice) {
  slice.texels.assign(static_cast<std::size_t>(edge) * edge, glm::vec3(0.0f));
  if (shot.seen <= 0.0) return;
  const auto range = sample.tilts_between(shot.tilt_lo, shot.tilt_hi);
  const double light_eye = glm::dot(shot.at.light, shot.at.eye);
  std::vector<std::size_t> shining;
  double footprints = 0.0;
  for (std::size_t k = range.begin; k < range.end; ++k) {
    const glm::dvec3 normal(sample.flakes[k].normal);
    const double mirrored = 2.0 * glm::dot(normal, shot.at.eye) * glm::dot(normal, shot.at.light) - light_eye;
    if (mirrored < shot.cos_source) continue;
    const double radius = sample.flakes[k].radius;
    footprints += std::numbers::pi * radius * radius;
    shining.push_back(k);
  }
  const double texels = static_cast<double>(edge) * edge;
  double correction = footprints > 0.0 ? shot.shining * sample.coverage * texels / footprints : 1.0;
  if (!even_out) correction = 1.0;
  correction = std::min(correction, 4.0);
  const glm::vec3 value(shot.factor * correction);
  const double grow = std::sqrt(shot.seen);
  for (const std::size_t k : shining) {
    splat(sample.flakes[k], static_cast<double>(sample.flakes[k].radius) * grow, value, edge, slice.texels);
  }
}

Result<void> check_settings(const GoniometerSettings& settings) {
  const auto bad = [](std::string field, std::string remedy) {
    return fail("", std::move(field), "is out of range", std::move(remedy), ErrorKind::usage);
  };
  if (settings.edge_texels < 1 || settings.edge_texels > 4096) return bad("edge_texels", "give [1, 4096]");
  if (!(settings.texel_mm >= 0.005f && settings.texel_mm <= 1.0f)) return bad("texel_mm", "give [0.005, 1] mm");
  if (settings.threads < 1 || settings.threads > 64) return bad("threads", "give [1, 64]");
  if (!(settings.source_radius_rad >= 0.005 && settings.source_radius_rad <= 0.15)) {
    return bad("source_radius_rad", "give [0.005, 0.15]");
  }
  return {};
}

/// No flake may send back more than it gets, in any channel, at any node.
Result<void> check_mirrors(const Recipe& recipe, const core::SliceLayout& layout, double coverage) {
  double most = 0.0;
  for (int slice = 0; slice < layout.slice_count(); ++slice) {
    const auto node = layout.node_of(slice);
    const double theta_h = node.bin_h * layout.bin_width_rad();
    const double theta_i = node.bin_i * layout.bin_width_rad();
    const LobeAt lobe = broad_lobe(recipe.analytic, node_geometry(theta_h, theta_i));
    const glm::dvec3 r = mirror(recipe, coverage, lobe.fresnel, theta_h, theta_i);
    most = std::max({most, r.x, r.y, r.z});
  }
  if (most <= 1.0) return {};
  return fail("", "flakes", "a flake would mirror " + std::to_string(most) + " of the light it gets",
              "raise coverage to " + std::to_string(coverage * most) + " or lower share to " +
                  std::to_string(recipe.flakes->share / most));
}

/// The sample that these settings ask for.
Result<FlakePopulation> make_sample(const Recipe& recipe, const GoniometerSettings& settings) {
  const double edge_mm = static_cast<double>(settings.texel_mm) * settings.edge_texels;
  const double count = std::round(expected_flakes(*recipe.flakes, edge_mm * edge_mm));
  if (!(count >= 1.0 && count <= max_flakes)) {
    return fail("", "flakes.coverage", "needs " + std::to_string(count) + " flakes on this sample",
                "allowed are 1 to 30 million: change coverage, diameters or the sample's size");
  }
  return draw_flakes(*recipe.flakes, recipe.analytic.lobes[0].m, static_cast<std::size_t>(count), settings.edge_texels,
                     settings.texel_mm, settings.seed);
}

/// One picture per pair of angles, shared among the threads.
std::vector<FlakeSlice> photograph_all(const Recipe& recipe, const GoniometerSettings& settings,
                                       const FlakePopulation& sample, std::span<const PictureAngles> angles,
                                       const MeasureProgress& progress) {
  std::vector<FlakeSlice> out(angles.size());
  std::atomic<std::size_t> next{0};
  int done = 0;
  std::mutex reporting;
  const auto work = [&] {
    for (std::size_t k = next++; k < angles.size(); k = next++) {
      const Shot shot = aim(recipe, sample, angles[k].theta_h, angles[k].theta_i, settings.source_radius_rad);
      photograph(sample, shot, settings.even_out, settings.edge_texels, out[k]);
      const std::scoped_lock lock(reporting);
      ++done;
      if (progress) progress(done, static_cast<int>(angles.size()));
    }
  };
  std::vector<std::jthread> helpers;
  for (int k = 1; k < settings.threads; ++k) helpers.emplace_back(work);
  work();
  helpers.clear();  // joins
  return out;
}

}  // namespace

Result<std::vector<FlakeSlice>> photographs(const Recipe& recipe, const GoniometerSettings& settings,
                                            std::span<const PictureAngles> angles) {
  if (auto ok = check_settings(settings); !ok) return tl::unexpected(ok.error());
  if (!recipe.flakes) return fail("", "flakes", "the recipe has none", "there is nothing to photograph");
  const auto sample = make_sample(recipe, settings);
  if (!sample) return tl::unexpected(sample.error());
  return photograph_all(recipe, settings, *sample, angles, {});
}

Result<Capture> measure(const Recipe& recipe, const GoniometerSettings& settings, const MeasureProgress& progress) {
  if (auto ok = check_settings(settings); !ok) return tl::unexpected(ok.error());
  Capture capture;
  capture.identity = recipe.identity;
  capture.analytic = recipe.analytic;
  if (!recipe.flakes) return capture;

  const auto sample = make_sample(recipe, settings);
  if (!sample) return tl::unexpected(sample.error());
  capture.layout = core::axf_layout();
  capture.edge_texels = settings.edge_texels;
  capture.texel_mm = settings.texel_mm;
  if (auto ok = check_mirrors(recipe, capture.layout, sample->coverage); !ok) return tl::unexpected(ok.error());

  std::vector<PictureAngles> angles;
  for (int slice = 0; slice < capture.layout.slice_count(); ++slice) {
    const auto node = capture.layout.node_of(slice);
    const double width = capture.layout.bin_width_rad();
    angles.push_back({node.bin_h * width, node.bin_i * width});
  }
  capture.slices = photograph_all(recipe, settings, *sample, angles, progress);
  const auto life = source_life(recipe, settings);
  if (!life) return tl::unexpected(life.error());
  capture.life = *life;
  capture.analytic.lobes[0].s *= 1.0 - recipe.flakes->share;
  return capture;
}

}  // namespace lackwerk::packs
