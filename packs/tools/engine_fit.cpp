#include "packs/tools/engine_fit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "core/analysis/reference_numbers.hpp"
#include "core/analysis/reference_sampling.hpp"
#include "core/colour.hpp"
#include "core/environment.hpp"
#include "core/paint_model.hpp"
#include "packs/tools/capture_brdf.hpp"
#include "packs/tools/recipe.hpp"

namespace lackwerk::packs {
namespace {

using glm::dvec3;

/// Pairs of directions for the two filtered colours: 64 batches of stratified numbers. Colours change slowly with
/// angle: doubling the number moves the demo paints' colours by less than 0.3 %.
constexpr int colour_batches = 64;
/// A lobe is taken for a coat's peak below this m: a coat with orange peel and an instrument's own blur stay below
/// (published: 0.010 to 0.034) ...
constexpr double widest_peak = 0.1;
/// ... where the next lobe is this much wider (published: 2.1 times and more) ...
constexpr double peak_contrast = 2.0;
/// ... and up to this albedo 4 s f0: a dielectric of index 1.8 mirrors 0.08.
constexpr double strongest_peak = 0.08;
/// What flakes lose where they are cut at 1 is given to all texels; each round leaves the share of cut texels, a few
/// per cent, of what was missing.
constexpr int most_rounds = 40;
constexpr double kept_to = 1e-4;  ///< reflectance: a fortieth of an 8-bit step

double largest(const dvec3& v) { return std::max({v.x, v.y, v.z}); }

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// The narrowest lobe with weight, if it is a coat's peak.
std::optional<std::size_t> coat_peak(const core::AnalyticPaint& paint) {
  if (paint.coat_ior > 1.0) return std::nullopt;
  std::optional<std::size_t> narrowest, next;
  for (std::size_t k = 0; k < core::max_lobes; ++k) {
    if (!(largest(paint.lobes[k].s) > 0.0)) continue;
    if (!narrowest || paint.lobes[k].m <= paint.lobes[*narrowest].m) {
      next = narrowest;
      narrowest = k;
    } else if (!next || paint.lobes[k].m < paint.lobes[*next].m) {
      next = k;
    }
  }
  if (!narrowest || (!next && !(largest(paint.diffuse) > 0.0))) return std::nullopt;
  const core::Lobe& lobe = paint.lobes[*narrowest];
  const bool narrow = lobe.m < widest_peak && (!next || paint.lobes[*next].m >= peak_contrast * lobe.m);
  const bool dielectric = 4.0 * core::luminance_of(lobe.s) * lobe.f0 <= strongest_peak;
  return narrow && dielectric ? narrowest : std::nullopt;
}

/// A model that shows one part of a paint, for sampling chi by it.
core::PaintModel<double> model_of(const core::AnalyticPaint& paint, bool lobes) {
  core::AnalyticPaint part = paint;
  part.table.reset();
  if (lobes) part.diffuse = dvec3(0.0);
  if (!lobes)
    for (core::Lobe& lobe : part.lobes) lobe.s = dvec3(0.0);
  core::PaintModel<double> model;
  core::bind_model(core::InterpolatablePaint(), part, core::no_textures(), model);
  return model;
}

/// Sums over pairs of directions, o ~ cos (KN 3.3), i as given.
struct Filtered {
  dvec3 with_table{0.0}, without{0.0};
  double engine = 0.0;  ///< of the engine's coat alone
  [[nodiscard]] dvec3 chi() const {
    dvec3 out(1.0);
    for (int c = 0; c < 3; ++c)
      if (without[c] > 0.0) out[c] = with_table[c] / without[c];
    return out;
  }
};

/// One part's reflectance of light from everywhere, with and without chi.
class ColourFilter {
 public:
  ColourFilter(const core::AnalyticPaint& paint, double clearcoat) : paint_(paint), clearcoat_(clearcoat) {}

  [[nodiscard]] Filtered diffuse() const {
    auto model = model_of(paint_, false);
    return filtered([&](const dvec3& i, const dvec3& o) { return term(model, i, o); });
  }

  [[nodiscard]] Filtered specular() const {
    auto model = model_of(paint_, true);
    std::array<double, core::max_lobes> part{};
    double sum = 0.0;
    for (std::size_t k = 0; k < part.size(); ++k) sum += part[k] = core::luminance_of(paint_.lobes[k].s);
    if (!(sum > 0.0)) return {};
    Filtered out;
    const dvec3 n(0.0, 0.0, 1.0);
    const core::ReferenceFrame frame(n);
    for_each_sample([&](core::ReferenceNumbers& numbers) {
      const dvec3 o = core::sample_cosine(frame, numbers.next());
      const core::LobeSampler sampler(n, o, paint_.refraction_ior);
      double choice = numbers.next().x * sum;
      std::size_t k = 0;
      while (k + 1 < part.size() && (choice >= part[k] || part[k] <= 0.0)) choice -= part[k++];
      const auto i = sampler.sample(numbers.next(), paint_.lobes[k].m);
      if (!i || i->z <= 0.0) return;
      const auto target = sampler.target(*i);
      double pdf = 0.0;
      for (std::size_t j = 0; j < part.size(); ++j)
        if (part[j] > 0.0) pdf += part[j] / sum * core::LobeSampler::pdf(target, paint_.lobes[j].m);
      if (pdf > 0.0) add(out, term(model, *i, o), i->z / pdf);
    });
    return out;
  }

 private:
  struct Term {
    dvec3 factor, chi;
  };
  Term term(core::PaintModel<double>& model, const dvec3& i, const dvec3& o) const {
    const dvec3 n(0.0, 0.0, 1.0);
    const double eta = paint_.refraction_ior;
    const auto g = model.paint_geometry(n, model.refract_into(i, n, eta), model.refract_into(o, n, eta));
    const double through =
        (1.0 - model.fresnel_dielectric(i.z, paint_.coat_ior)) * (1.0 - model.fresnel_dielectric(o.z, paint_.coat_ior));
    return {model.lobes_factor(g, 1.0) * through, table_colour(paint_, g.theta_h, g.theta_i)};
  }
  static void add(Filtered& out, const Term& t, double weight) {
    out.with_table += t.factor * t.chi * weight;
    out.without += t.factor * weight;
  }
  template <class Work>
  static void for_each_sample(const Work& work) {
    for (std::uint64_t batch = 0; batch < colour_batches; ++batch)
      for (std::uint32_t k = 0; k < core::reference_batch; ++k) {
        core::ReferenceNumbers numbers(1, 0, batch, k);
        work(numbers);
      }
  }
  template <class Value>
  [[nodiscard]] Filtered filtered(const Value& value) const {
    Filtered out;
    const dvec3 n(0.0, 0.0, 1.0);
    const core::ReferenceFrame frame(n);
    for_each_sample([&](core::ReferenceNumbers& numbers) {
      const dvec3 o = core::sample_cosine(frame, numbers.next()), i = core::sample_cosine(frame, numbers.next());
      add(out, value(i, o), 1.0);
      out.engine += 1.0 - core::clearcoat_fresnel(o.z, clearcoat_);
    });
    return out;
  }

  const core::AnalyticPaint& paint_;
  double clearcoat_;
};

/// A texel's reflectance, hue kept, cut at 1: an engine's mirror cannot give more than it gets.
dvec3 cut(const dvec3& s) {
  const double most = largest(s);
  return most > 1.0 ? s / most : s;
}

/// s(x): lobes as they are, flakes in proportion to the slice seen along the normal (KN 3.1).
class FlakeColours {
 public:
  FlakeColours(const FlakeSlice& slice, const dvec3& lobes, const dvec3& flakes) : slice_(slice), lobes_(lobes) {
    dvec3 mean(0.0);
    for (const glm::vec3& texel : slice.texels) mean += dvec3(texel);
    mean /= static_cast<double>(slice.texels.size());
    for (int c = 0; c < 3; ++c) per_value_[c] = mean[c] > 0.0 ? flakes[c] / mean[c] : 0.0;
  }
  [[nodiscard]] dvec3 uncut(std::size_t k) const { return lobes_ + per_value_ * dvec3(slice_.texels[k]); }
  [[nodiscard]] dvec3 at(std::size_t k) const { return cut(uncut(k) + fill_); }
  /// Chooses what all texels get so that the mean is `wanted`, or as near as a mirror allows. Returns what is missing.
  double keep_mean(const dvec3& wanted) {
    dvec3 missing(0.0);
    for (int round = 0; round < most_rounds; ++round) {
      missing = wanted;
      for (std::size_t k = 0; k < slice_.texels.size(); ++k)
        missing -= at(k) / static_cast<double>(slice_.texels.size());
      if (largest(missing) < kept_to) break;
      fill_ = glm::clamp(fill_ + missing, 0.0, 1.0);
    }
    return largest(missing);
  }

 private:
  const FlakeSlice& slice_;
  dvec3 lobes_, per_value_{0.0}, fill_{0.0};
};

std::uint8_t byte_of(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
}

/// Fills texture, weights and mean of `material` from the slice.
void make_texture(const Capture& capture, const dvec3& lobes, const dvec3& flakes, EngineFit& fit) {
  EngineMaterial& material = fit.material;
  const auto slice = static_cast<std::size_t>(*capture.layout.slice_at(0, 0));
  FlakeColours colours(capture.slices[slice], lobes, flakes);
  const std::size_t count = capture.slices[slice].texels.size();
  for (std::size_t k = 0; k < count; ++k)
    fit.brightest_flake = std::max(fit.brightest_flake, largest(colours.uncut(k)));
  const double missing = colours.keep_mean(lobes + flakes);
  for (std::size_t k = 0; k < count; ++k)
    material.specular_weight = std::max(material.specular_weight, largest(colours.at(k)));
  material.flakes = {capture.edge_texels, static_cast<double>(capture.texel_mm), std::vector<std::uint8_t>(4 * count)};
  dvec3 mean(0.0);
  for (std::size_t k = 0; k < count; ++k) {
    const dvec3 s = colours.at(k);
    std::uint8_t* rgba = &material.flakes.rgba[4 * k];
    // Rounded up, so that s / w stays below 1; the colour, encoded, makes up for the step.
    rgba[3] = static_cast<std::uint8_t>(
        std::min(255.0, std::ceil(largest(s) / std::max(material.specular_weight, 1e-12) * 255.0 - 1e-9)));
    const double w = rgba[3] / 255.0 * material.specular_weight;
    for (int c = 0; c < 3; ++c) {
      rgba[c] = w > 0.0 ? byte_of(core::srgb_encode(s[c] / w)) : std::uint8_t{0};
      mean[c] += w * core::srgb_decode(rgba[c] / 255.0);
    }
    material.mean_weight += w;
  }
  material.specular = mean / static_cast<double>(count);
  material.mean_weight /= static_cast<double>(count);
  if (fit.brightest_flake > 1.0)
    fit.notes.push_back("the brightest flakes would mirror " + rounded(fit.brightest_flake) +
                        " times the light in the engine's one lobe: cut at 1, what they lose is spread over the paint");
  if (missing >= kept_to)
    fit.notes.push_back(rounded(missing) + " of the specular colour is lost where texels are full");
}

void note_outcome(const core::GgxFit& fit, double index, const char* what, std::vector<std::string>& notes) {
  if (fit.outcome == core::GgxOutcome::too_narrow)
    notes.push_back(std::string(what) + ": narrower than an engine's 32-bit arithmetic resolves (one lobe of m below " +
                    rounded(core::least_stable_roughness(index)) + "); no roughness is given, it is drawn at alpha " +
                    rounded(fit.alpha));
  if (fit.outcome == core::GgxOutcome::too_wide)
    notes.push_back(std::string(what) + ": wider than roughness 1, which is used");
}

Result<void> check_capture(const Capture& capture) {
  if (!capture.is_fitted)
    return fail("", "lobes", "the capture is not fitted yet", "run `lackwerk fit` without --engine first");
  const std::size_t texels = std::size_t{capture.edge_texels} * capture.edge_texels;
  for (const FlakeSlice& slice : capture.slices)
    if (slice.texels.size() != texels || texels == 0)
      return fail("", "flakes", "a slice is no square of edge_texels", "export it again");
  return {};
}

}  // namespace

Result<EngineFit> fit_engine_material(const Capture& capture) {
  if (auto ok = check_capture(capture); !ok) return tl::unexpected(ok.error());
  EngineFit fit;
  EngineMaterial& material = fit.material;
  core::AnalyticPaint body = capture.analytic;
  const double index = body.refraction_ior;
  const core::MeanFlakes flakes = mean_flakes(capture);
  fit.kn = core::fit_ggx(body, flakes);
  note_outcome(fit.kn, index, "one lobe for all", fit.notes);

  material.clearcoat = core::clearcoat_factor(body.coat_ior);
  if (body.coat_ior > 1.5 + 1e-9)
    fit.notes.push_back("a coat of index " + rounded(body.coat_ior) +
                        " is drawn as 1.5: KHR_materials_clearcoat has no index of its own");
  if (const auto peak = coat_peak(body)) {
    core::AnalyticPaint alone;
    alone.refraction_ior = index;
    alone.lobes[*peak] = body.lobes[*peak];
    body.lobes[*peak].s = dvec3(0.0);
    fit.peak_is_coat = true;
    fit.coat = core::fit_ggx(alone);
    note_outcome(fit.coat, index, "the coat's peak", fit.notes);
    const double strength = core::luminance_of(fit.coat.scale()) / core::clearcoat_fresnel(1.0, 1.0);
    material.clearcoat = std::min(strength, 1.0);
    material.clearcoat_alpha = fit.coat.alpha;
    if (strength > 1.0)
      fit.notes.push_back("the coat's peak mirrors " + rounded(strength) +
                          " times what KHR_materials_clearcoat can: drawn at 1");
  }
  fit.gltf = core::fit_ggx(body, flakes, material.clearcoat);
  if (fit.peak_is_coat) note_outcome(fit.gltf, index, "the body's lobe", fit.notes);
  material.alpha = fit.gltf.alpha;

  const ColourFilter filter(body, material.clearcoat);
  fit.specular_chi = filter.specular().chi();
  const Filtered diffuse = filter.diffuse();
  fit.diffuse_chi = diffuse.chi();

  dvec3 lobes = fit.specular_chi * fit.gltf.lobes, sparkle = fit.gltf.flakes;
  if (capture.analytic.table)
    fit.notes.push_back("the paint's colour changes with the angle; an engine's lobe has one colour, its mean");
  if (const double most = largest(lobes + sparkle); most > 1.0) {
    fit.notes.push_back("the lobe would mirror " + rounded(most) +
                        " times the light: cut at 1, hue kept, the energy is not kept");
    lobes /= most;
    sparkle /= most;
  }
  if (!capture.slices.empty() && largest(sparkle) > 0.0 && capture.layout.slice_at(0, 0)) {
    make_texture(capture, lobes, sparkle, fit);
  } else {
    material.specular = lobes + sparkle;
    material.specular_weight = material.mean_weight = largest(material.specular);
  }
  // Below the engine's coat as much diffuse light comes out as below the paint's own.
  material.diffuse = diffuse.with_table / diffuse.engine;
  const double room = 1.0 - material.mean_weight;
  if (largest(material.diffuse) > room) {
    fit.notes.push_back("diffuse colour " + rounded(largest(material.diffuse)) + " beside a specular colour of " +
                        rounded(material.mean_weight) + " is more light than there is: cut at " + rounded(room));
    material.diffuse = glm::min(material.diffuse, dvec3(room));
  }
  return fit;
}

core::Brdf engine_brdf(const EngineMaterial& m) {
  // Only what the function needs: the texture's bytes stay behind.
  const dvec3 diffuse = m.diffuse, specular = m.specular;
  const double alpha = m.alpha, weight = m.mean_weight, coat = m.clearcoat, coat_alpha = m.clearcoat_alpha;
  return [=](const dvec3& in, const dvec3& out) {
    if (in.z <= 0.0 || out.z <= 0.0) return dvec3(0.0);
    const dvec3 sum = in + out;
    const double length = glm::length(sum), nh = sum.z / length, ho = 0.5 * length;
    const double tan_h = std::sqrt(sum.x * sum.x + sum.y * sum.y) / sum.z;
    const double rise = core::PaintModel<double>().pow5(1.0 - std::min(ho, 1.0));
    const dvec3 colour = specular + (dvec3(weight) - specular) * rise;
    dvec3 factor = diffuse + colour * core::ggx_factor(alpha, tan_h, nh, in.z, out.z);
    const double mirrored = core::clearcoat_fresnel(out.z, coat);
    factor *= 1.0 - mirrored;
    if (coat_alpha > 0.0) factor += dvec3(mirrored * core::ggx_factor(coat_alpha, tan_h, nh, in.z, out.z));
    return factor / std::numbers::pi;
  };
}

}  // namespace lackwerk::packs
