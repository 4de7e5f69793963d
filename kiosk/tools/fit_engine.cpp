#include "kiosk/tools/fit_engine.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/analysis/brdf_sphere.hpp"
#include "core/analysis/standard_angles.hpp"
#include "core/colour.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/svg_plot.hpp"
#include "packs/tools/capture_brdf.hpp"
#include "packs/tools/difference_picture.hpp"
#include "packs/tools/engine_export.hpp"

namespace lackwerk::tools {
namespace {

constexpr int sphere_edge = 192;
constexpr std::size_t six_angles = 6;  ///< of the twelve: the first are those of six-angle instruments
constexpr int plot_points = 100;
constexpr double usual_index = 1.5;

/// How far the engine's model is from the measured one.
struct EngineError {
  std::vector<core::AngleColour> measured, engine;
  core::AngleComparison angles;
  core::SphereComparison sphere;
};

EngineError errors_of(const core::Brdf& measured, const core::Brdf& engine) {
  EngineError out;
  for (const core::MeasuringAngle& angle : core::standard_angles().first(six_angles)) {
    const auto a = core::colour_at(measured, angle), b = core::colour_at(engine, angle);
    if (!a || !b) continue;
    out.measured.push_back({angle, *a});
    out.engine.push_back({angle, *b});
  }
  out.angles = core::compare_angles(out.measured, out.engine);
  out.sphere = core::compare_on_sphere(measured, engine, sphere_edge);
  return out;
}

/// KN Figure 2: one lobe with s = 1, F0 = 1 under this index, roughness and scale. Lobes that an engine cannot show
/// leave a gap at either end of the curves.
void add_figure_2(double ior, std::vector<Plot>& panels) {
  PlotLine alpha{"GGX alpha", {}, "#1f5fa8", false};
  PlotLine roughness{"roughness of engines (root of alpha)", {}, "#b0402a", false};
  PlotLine scale{"scale s", {}, "#1f5fa8", false};
  double highest = 0.0;
  for (int k = 1; k <= plot_points; ++k) {
    const double m = static_cast<double>(k) / plot_points;
    core::AnalyticPaint paint;
    paint.lobes[0] = {glm::dvec3(1.0), m, 1.0};
    paint.coat_ior = paint.refraction_ior = ior;
    const core::GgxFit fit = core::fit_ggx(paint);
    if (fit.outcome != core::GgxOutcome::fitted) continue;
    alpha.points.emplace_back(m, fit.alpha);
    roughness.points.emplace_back(m, std::sqrt(fit.alpha));
    scale.points.emplace_back(m, fit.lobes.x);
    highest = std::max(highest, fit.lobes.x);
  }
  const std::string under = ", one lobe, s = 1, F0 = 1, index " + fixed(ior, 2);
  const char* m_label = "Beckmann m of the paint's lobe";
  panels.push_back({"Fitted roughness" + under, m_label, "roughness", 1.0, 1.0, {alpha, roughness}});
  panels.push_back({"Fitted scale" + under, m_label, "scale", 1.0, std::max(1.0, std::ceil(highest * 1.1)), {scale}});
}

/// Under the paint's own index, and under a clear coat's where that is another.
std::string figure_2(double ior) {
  std::vector<Plot> panels;
  add_figure_2(ior, panels);
  if (std::abs(ior - usual_index) > 1e-6) add_figure_2(usual_index, panels);
  return svg_text(panels);
}

/// Against what was measured, where the capture keeps that: the engine's model is read through the same cells.
std::optional<EngineError> errors_of_measurement(const packs::Capture& capture, const core::Brdf& model,
                                                 const core::Brdf& engine) {
  if (!capture.measured) return std::nullopt;
  const core::BrdfTable through = core::measured_like(*capture.measured, engine);
  return errors_of(core::table_brdf(*capture.measured, model), core::table_brdf(through, engine));
}

packs::LinearImage picture_of(const core::SpherePicture& sphere) { return {sphere.edge, sphere.edge, sphere.pixels}; }

Result<void> write_pictures(const EngineError& error, double ior, const std::filesystem::path& out) {
  const auto svg = out / "lobe.svg";
  std::ofstream stream(svg);
  stream << figure_2(ior);
  if (!stream.flush()) return fail(svg.string(), "", "cannot be written", "check the folder and free space");
  const QuietStderr quiet;
  return packs::write_difference_picture(
      out / "compare.png", picture_of(error.sphere.a), picture_of(error.sphere.b), error.sphere.map,
      "A paint, B engine; mean " + fixed(error.sphere.mean, 2) + ", p95 " + fixed(error.sphere.p95, 2));
}

nlohmann::ordered_json json_of(const glm::dvec3& v) { return nlohmann::ordered_json::array({v.x, v.y, v.z}); }

/// Numbers that mean nothing are left out: null.
nlohmann::ordered_json json_of(const core::GgxFit& fit) {
  nlohmann::ordered_json out{{"outcome", core::outcome_name(fit.outcome)}};
  const bool known = fit.outcome == core::GgxOutcome::fitted;
  out["alpha"] = known ? nlohmann::ordered_json(fit.alpha) : nullptr;
  out["roughness"] = known ? nlohmann::ordered_json(std::sqrt(fit.alpha)) : nullptr;
  out["scale"] = json_of(fit.scale());
  out["energy"] = json_of(fit.energy);
  out["error"] = known ? nlohmann::ordered_json(fit.error) : nullptr;
  return out;
}

nlohmann::ordered_json json_of(const EngineError& error) {
  nlohmann::ordered_json angles = nlohmann::ordered_json::object();
  for (const core::AngleDifference& at : error.angles.angles) angles[core::angle_name(at.angle)] = at.ciede2000;
  return {{"angles", angles},
          {"angles_mean", error.angles.mean},
          {"sphere", {{"mean", error.sphere.mean}, {"p95", error.sphere.p95}, {"max", error.sphere.max}}}};
}

/// What the run found, to be told in either form.
struct Found {
  const packs::Capture& capture;
  const packs::EngineFit& fit;
  EngineError model;                       ///< against the capture's lobes, table and mean flakes
  std::optional<EngineError> measurement;  ///< against what was measured
  std::filesystem::path out;
};

void print_json(const Found& found) {
  const packs::EngineMaterial& m = found.fit.material;
  nlohmann::ordered_json json{{"name", found.capture.identity.name},
                              {"folder", found.out.string()},
                              {"lobe", json_of(found.fit.kn)},
                              {"body", json_of(found.fit.gltf)}};
  json["coat_peak"] = found.fit.peak_is_coat ? json_of(found.fit.coat) : nullptr;
  json["material"] = {
      {"alpha", m.alpha},         {"specular", json_of(m.specular)},      {"diffuse", json_of(m.diffuse)},
      {"clearcoat", m.clearcoat}, {"clearcoat_alpha", m.clearcoat_alpha}, {"flake_texels", m.flakes.edge}};
  json["ciede2000"] = json_of(found.model);
  json["ciede2000_measurement"] = found.measurement ? json_of(*found.measurement) : nullptr;
  json["notes"] = found.fit.notes;
  print(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string colour_text(const glm::dvec3& v) { return fixed(v.x, 3) + " " + fixed(v.y, 3) + " " + fixed(v.z, 3); }

std::string lobe_text(const core::GgxFit& fit) {
  if (fit.outcome != core::GgxOutcome::fitted) return core::outcome_name(fit.outcome);
  return "alpha " + fixed(fit.alpha, 4) + " (roughness " + fixed(std::sqrt(fit.alpha), 3) + "), scale " +
         colour_text(fit.scale()) + ", error " + fixed(100.0 * fit.error, 1) + " %";
}

void print_error(const EngineError& error, const char* against) {
  std::string angles;
  for (const core::AngleDifference& at : error.angles.angles)
    angles += " " + core::angle_name(at.angle) + " " + fixed(at.ciede2000, 1) + ",";
  print(std::string("  CIEDE2000 against the ") + against + ":" + angles + " mean " + fixed(error.angles.mean, 2) +
        "; sphere mean " + fixed(error.sphere.mean, 2) + ", p95 " + fixed(error.sphere.p95, 2));
}

void print_text(const Found& found) {
  const packs::EngineFit& fit = found.fit;
  const packs::EngineMaterial& m = fit.material;
  print(found.out.string() + ": " + one_line(found.capture.identity.name) + " for game engines (" +
        core::provenance_name(found.capture.identity.lobes) + ")");
  print("  one lobe for all (Kneiphof et al. 2018): " + lobe_text(fit.kn));
  print(std::string("  under glTF's coat") + (fit.peak_is_coat ? ", without the coat's peak: " : ": ") +
        lobe_text(fit.gltf));
  if (fit.peak_is_coat) print("  the coat's peak: " + lobe_text(fit.coat));
  print("  diffuse " + colour_text(m.diffuse) + ", specular " + colour_text(m.specular) + ", clear coat " +
        fixed(m.clearcoat, 2) + ", flakes " + (m.flakes.edge > 0 ? std::to_string(m.flakes.edge) + " texels" : "none"));
  print_error(found.model, "paint's model");
  if (found.measurement) print_error(*found.measurement, "measurement");
  for (const std::string& note : fit.notes) print("  note: " + note);
}

}  // namespace

int run_engine_fit(const packs::Capture& capture, const std::filesystem::path& out, const EngineFitOptions& options) {
  auto fit = packs::fit_engine_material(capture);
  if (!fit) {
    fit.error().file = options.source.string();
    return report(fit.error());
  }
  if (const auto written = packs::write_engine_material(fit->material, capture.identity, out); !written)
    return report(written.error());
  const core::Brdf model = packs::capture_brdf(capture), engine = packs::engine_brdf(fit->material);
  const Found found{capture, *fit, errors_of(model, engine), errors_of_measurement(capture, model, engine), out};
  const EngineError& shown = found.measurement ? *found.measurement : found.model;
  if (const auto written = write_pictures(shown, capture.analytic.refraction_ior, out); !written)
    return report(written.error());
  if (options.json) {
    print_json(found);
  } else {
    print_text(found);
  }
  return exit_done;
}

}  // namespace lackwerk::tools
