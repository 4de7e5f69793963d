#include "packs/tools/flake_life.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "core/colour.hpp"
#include "core/paint_model.hpp"
#include "core/realise.hpp"

namespace lackwerk::packs {
namespace {

constexpr double radians = std::numbers::pi / 180.0;
/// Below this correlation at the first lag a capture's slices do not tell how short a life is.
constexpr double least_slice_correlation = 0.1;

template <class Vector>
float luminance(const Vector& rgb) {
  const auto& y = core::rgb_to_xyz[1];
  return static_cast<float>(y[0] * static_cast<double>(rgb.x) + y[1] * static_cast<double>(rgb.y) +
                            y[2] * static_cast<double>(rgb.z));
}

std::vector<float> luminances(const FlakeSlice& slice) {
  std::vector<float> out(slice.texels.size());
  std::transform(slice.texels.begin(), slice.texels.end(), out.begin(), luminance<glm::vec3>);
  return out;
}

std::vector<PictureAngles> angles_of(const LifeScan& scan) {
  std::vector<PictureAngles> out;
  for (std::size_t k = 0; k < scan.pictures; ++k) {
    const double along = static_cast<double>(k) * scan.step_deg * radians, fixed = scan.other_deg * radians;
    out.push_back(scan.along_h ? PictureAngles{along, fixed} : PictureAngles{fixed, along});
  }
  return out;
}

}  // namespace

Result<core::LifeCurve> source_curve(const Recipe& recipe, const GoniometerSettings& settings, const LifeScan& scan) {
  GoniometerSettings small = settings;
  small.edge_texels = life_edge_texels;
  const auto slices = photographs(recipe, small, angles_of(scan));
  if (!slices) return tl::unexpected(slices.error());
  std::vector<std::vector<float>> pictures;
  for (const FlakeSlice& slice : *slices) pictures.push_back(luminances(slice));
  return core::life_curve(pictures, scan.step_deg, scan.starts);
}

Result<MeasuredLife> source_life(const Recipe& recipe, const GoniometerSettings& settings) {
  const auto along_h = source_curve(recipe, settings, life_scan_h);
  if (!along_h) return tl::unexpected(along_h.error());
  const auto along_i = source_curve(recipe, settings, life_scan_i);
  if (!along_i) return tl::unexpected(along_i.error());
  return MeasuredLife{core::half_width_deg(*along_h), core::half_width_deg(*along_i)};
}

std::optional<core::LifeCurve> slice_curve(const Capture& capture, const LifeScan& scan) {
  const double bin_deg = 90.0 / std::max<int>(capture.layout.num_theta, 1);
  const int fixed = static_cast<int>(std::lround(scan.other_deg / bin_deg));
  const auto starts_within = static_cast<std::size_t>(static_cast<double>(scan.starts) * scan.step_deg / bin_deg) + 1;
  std::vector<std::vector<float>> pictures;
  for (int k = 0;; ++k) {
    const auto slice = scan.along_h ? capture.layout.slice_at(k, fixed) : capture.layout.slice_at(fixed, k);
    if (!slice) break;
    pictures.push_back(luminances(capture.slices[static_cast<std::size_t>(*slice)]));
  }
  if (pictures.size() < 3) return std::nullopt;
  return core::life_curve(pictures, bin_deg, std::min(starts_within, pictures.size() - 2));
}

KnownLife known_life(const Capture& capture) {
  if (capture.life) return {*capture.life, core::LifeOrigin::fine};
  const auto along_h = slice_curve(capture, life_scan_h), along_i = slice_curve(capture, life_scan_i);
  const auto tells = [](const std::optional<core::LifeCurve>& curve) {
    return curve && curve->correlation.size() > 1 && curve->correlation[1] >= least_slice_correlation;
  };
  KnownLife out;
  if (tells(along_i)) out.life.half_i_deg = core::half_width_deg(*along_i);
  if (!tells(along_h)) return out;
  out.life.half_h_deg = core::half_width_deg(*along_h);
  out.origin = core::LifeOrigin::slices;
  return out;
}

core::LifeCurve reconstruction_curve(const core::InterpolatablePaint& paint, std::size_t index, const LifeScan& scan,
                                     std::uint32_t edge) {
  std::vector<double> weights(paint.paints.size(), 0.0);
  weights.at(index) = 1.0;
  core::RealisedPaint realised;
  core::realise(paint, core::Weights::uniform(weights), realised);
  core::PaintTextures textures = core::make_static_textures(paint);
  const core::AnalyticPaint analytic = realised.analytic;
  core::update_textures(paint, realised, textures);
  core::PaintModel<double> model;
  core::bind_model(paint, analytic, textures, model);
  std::vector<std::vector<float>> pictures;
  for (const PictureAngles& at : angles_of(scan)) {
    std::vector<float>& picture = pictures.emplace_back();
    for (std::uint32_t y = 0; y < edge; ++y)
      for (std::uint32_t x = 0; x < edge; ++x)
        picture.push_back(luminance(model.flake_factor(at.theta_h, at.theta_i, {x + 0.5, y + 0.5}, 0.0)));
  }
  return core::life_curve(pictures, scan.step_deg, scan.starts);
}

}  // namespace lackwerk::packs
