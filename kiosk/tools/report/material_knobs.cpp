#include "kiosk/tools/report/material_knobs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "core/analysis/brdf_sphere.hpp"
#include "core/analysis/brdf_table.hpp"
#include "core/analysis/colour_map.hpp"
#include "core/analysis/ggx_fit.hpp"
#include "core/analysis/map_paint.hpp"
#include "packs/tools/capture_brdf.hpp"

namespace lackwerk::report {
namespace {

using core::CriticalAngleCure;
using glm::dvec3;

// ---- the engine fit

/// What an engine draws of a fit: one lobe of GGX, over the paint's diffuse part.
core::Brdf lobe_of(const core::GgxFit& fit, const dvec3& diffuse) {
  const dvec3 scale = fit.lobes + fit.flakes;
  return [scale, diffuse, alpha = fit.alpha](const dvec3& in, const dvec3& out) {
    if (in.z <= 0.0 || out.z <= 0.0) return dvec3(0.0);
    const dvec3 sum = in + out;
    const double tan_h = std::sqrt(sum.x * sum.x + sum.y * sum.y) / sum.z;
    const double factor = core::ggx_factor(alpha, tan_h, sum.z / glm::length(sum), in.z, out.z);
    return (diffuse + scale * factor) / std::numbers::pi;
  };
}

// ---- isochromatic maps

/// A paint to be mapped: its BRDF without the coat's mirror image, and its coat.
struct Mapped {
  std::string name;
  core::Brdf brdf;
  double index = 1.0;
};

/// One way to write it down, made for one paint.
struct Written {
  core::Brdf brdf;
  double bytes = 0.0;
};
using Writer = std::function<Result<Written>(const Mapped&)>;

Result<Written> write_map(const Mapped& paint, CriticalAngleCure cure, std::uint32_t edge) {
  core::ColourMapSettings settings;
  settings.edge = edge;
  settings.index = paint.index;
  settings.cure = cure;
  settings.carrier = [index = paint.index](const dvec3& in, const dvec3& out) {
    return core::coat_transmission(in, out, index);
  };
  auto map = core::colour_map_of(paint.brdf, settings);
  if (!map) return tl::unexpected(map.error());
  Written out;
  out.bytes = static_cast<double>(map->nodes().size() * sizeof(glm::vec3));
  out.brdf = [map = std::move(*map)](const dvec3& in, const dvec3& eye) {
    return map.factor(in, eye) / std::numbers::pi;
  };
  return out;
}

Result<Written> write_table(const Mapped& paint, const core::BrdfTableSize& size) {
  auto table = core::tabulate(paint.brdf, size);
  core::fill_holes(table);
  Written out;
  out.bytes = static_cast<double>(size.cells() * sizeof(glm::vec3));
  out.brdf = [table = std::move(table)](const dvec3& in, const dvec3& eye) {
    return table.at(in, eye).value_or(dvec3(0.0));
  };
  return out;
}

/// Pairs as a renderer asks for them: anywhere, in no order.
std::vector<core::DirectionPair> look_ups() {
  constexpr std::size_t count = 1000;
  std::vector<core::DirectionPair> pairs = core::grid_pairs(count);
  return pairs;
}

/// Errors are means over the paints, the largest of them the worst; of each paint in `note`.
Result<Setting> judge(const Workbench& bench, const std::vector<Mapped>& paints, const Writer& write) {
  // KI's geometries that lie out of the plane: in it a map is exact but for its nodes.
  core::GeometryGrid grid;
  grid.in_plane = false;
  Setting out;
  out.error = out.p95 = out.worst = 0.0;
  const auto share = 1.0 / static_cast<double>(paints.size());
  const std::vector<core::DirectionPair> pairs = look_ups();
  for (const Mapped& paint : paints) {
    const auto written = write(paint);
    if (!written) return tl::unexpected(written.error());
    const auto difference = core::compare(paint.brdf, written->brdf, grid);
    out.error += share * difference.e2000.mean;
    out.p95 += share * difference.e2000.p95;
    out.worst = std::max(out.worst, difference.e2000.max);
    out.bytes = written->bytes;
    out.note += (out.note.empty() ? "" : "; ") + paint.name + " " + digits(difference.e2000.mean);
    if (&paint != &paints.back()) continue;
    dvec3 sink(0.0);
    out.time = bench.time(
        [&] {
          for (const core::DirectionPair& pair : pairs) sink += written->brdf(pair.in, pair.out);
        },
        100.0, 5, 200);
    if (!(sink.x >= 0.0)) out.note += "; not a number";
  }
  return out;
}

struct Way {
  std::string label, line;
  double value = none;
  Writer write;
};

void add_way(std::vector<Way>& to, std::string label, std::string line, double value, Writer write) {
  Way way;
  way.label = std::move(label);
  way.line = std::move(line);
  way.value = value;
  way.write = std::move(write);
  to.push_back(std::move(way));
}

std::vector<Way> ways(const Workbench& bench) {
  const std::uint32_t usual = core::ColourMapSettings{}.edge;
  std::vector<Way> out;
  const auto map = [&](const char* cure_name, CriticalAngleCure cure, std::uint32_t edge) {
    add_way(out, std::string(cure_name) + ", " + std::to_string(edge), std::string("cure ") + cure_name, edge,
            [cure, edge](const Mapped& paint) { return write_map(paint, cure, edge); });
  };
  for (const std::uint32_t edge : {usual / 4, usual / 2, usual, 2 * usual}) {
    map("A", CriticalAngleCure::clip, edge);
  }
  map("B", CriticalAngleCure::slide, usual);
  map("B along", CriticalAngleCure::slide_along, usual);
  for (const std::uint32_t edge : {usual / 4, usual / 2, usual, 2 * usual})
    map("C", CriticalAngleCure::index_one, edge);
  for (const std::uint32_t part : {4u, 2u, 1u}) {
    if (part == 1 && bench.quick()) continue;  // 1.5 million cells of each paint
    const core::BrdfTableSize size{90 / part, 90 / part, 180 / part};
    add_way(out,
            std::to_string(size.theta_h) + " x " + std::to_string(size.theta_d) + " x " + std::to_string(size.phi_d),
            "table of three angles", static_cast<double>(size.cells()),
            [size](const Mapped& paint) { return write_table(paint, size); });
  }
  return out;
}

const Setting& setting_of(const Knob& knob, const std::string& label) {
  return *std::find_if(knob.settings.begin(), knob.settings.end(),
                       [&](const Setting& setting) { return setting.label == label; });
}

}  // namespace

Result<Knob> ggx_samples_knob(Workbench& bench) {
  const auto captures = bench.captures();
  if (!captures) return tl::unexpected(captures.error());
  Knob knob;
  knob.id = "ggx_samples";
  knob.title = "Samples of the engine fit";
  constexpr int most = 4096, truth_nodes = 4 * most;
  knob.what =
      "One GGX lobe for all lobes and mean flakes of each of the demo's paints (Kneiphof et al. 2018, 3.2), whose "
      "integrals are sums over so many angles at normal view.";
  knob.error_unit = "CIEDE2000 on a lit sphere against the fit with " + std::to_string(truth_nodes) + " samples";
  knob.time_of = "one fit, one core";
  struct Fitted {
    const packs::Capture* capture = nullptr;
    core::MeanFlakes flakes;
    core::Brdf truth;
  };
  std::vector<Fitted> paints;
  for (const packs::Capture& capture : **captures) {
    Fitted one;
    one.capture = &capture;
    one.flakes = packs::mean_flakes(capture);
    one.truth = lobe_of(core::fit_ggx(capture.analytic, one.flakes, {}, truth_nodes), capture.analytic.diffuse);
    paints.push_back(std::move(one));
  }
  const int edge_px = bench.choose(64, 32);
  double residual = 0.0;
  for (int nodes = 16; nodes <= most; nodes *= 2) {
    // The usual number, 1536, is no power of two.
    for (const int count : {nodes, nodes * 3 / 2}) {
      if (count != nodes && count != core::ggx_nodes) continue;
      Setting setting;
      setting.label = std::to_string(count);
      setting.value = count;
      setting.line = "fit";
      setting.error = setting.p95 = setting.worst = 0.0;
      for (const Fitted& paint : paints) {
        const auto fit = core::fit_ggx(paint.capture->analytic, paint.flakes, {}, count);
        const auto difference =
            core::compare_on_sphere(paint.truth, lobe_of(fit, paint.capture->analytic.diffuse), edge_px);
        setting.error += difference.mean / static_cast<double>(paints.size());
        setting.p95 = std::max(setting.p95, difference.p95);
        setting.worst = std::max(setting.worst, difference.max);
        if (count == core::ggx_nodes) residual = std::max(residual, fit.error);
      }
      setting.time =
          bench.time([&] { (void)core::fit_ggx(paints.front().capture->analytic, paints.front().flakes, {}, count); },
                     150.0, 3, 50);
      knob.settings.push_back(std::move(setting));
    }
  }
  knob.chosen = std::to_string(core::ggx_nodes);
  const Setting &chosen = setting_of(knob, knob.chosen), &fewest = knob.settings.front();
  knob.why = knob.chosen + " samples take " + digits(chosen.time.median_ms) + " ms a fit and are within " +
             digits(chosen.error) + " of the fit with " + std::to_string(truth_nodes) + "; " + fewest.label +
             " would be off by " + digits(fewest.error) +
             ". The number is set by the narrowest lobe the model allows, not by these paints. What one lobe itself "
             "leaves is far more: a relative residual of up to " +
             digits(residual) + ".";
  return knob;
}

Result<Knob> isochromatic_knob(Workbench& bench) {
  const auto captures = bench.captures();
  if (!captures) return tl::unexpected(captures.error());
  std::vector<Mapped> paints;
  for (const packs::Capture& capture : **captures) {
    Mapped paint;
    paint.name = capture.identity.name;
    paint.brdf = packs::capture_brdf(capture);
    paint.index = capture.analytic.coat_ior > 1.0 ? capture.analytic.coat_ior : capture.analytic.refraction_ior;
    paints.push_back(std::move(paint));
  }
  Knob knob;
  knob.id = "isochromatic";
  knob.title = "Isochromatic map";
  knob.what =
      "The demo's paints as maps over the plane of incidence, by the three cures of the critical angle (A: clip, "
      "B: slide to the map's edge, as printed and along the gloss line, C: index 1), of so many nodes an edge, "
      "and as tables of all three angles. The coat's transmissions are carried apart.";
  knob.error_unit = "CIEDE2000 against the paint's model over geometries out of the plane";
  knob.time_of = "1000 look-ups on the CPU, one core";
  knob.bytes_of = "map or table as floats, one paint";
  const std::vector<Way> all = ways(bench);
  knob.settings.reserve(all.size());
  for (const Way& way : all) {
    auto setting = judge(bench, paints, way.write);
    if (!setting) return tl::unexpected(setting.error());
    setting->label = way.label;
    setting->line = way.line;
    setting->value = way.value;
    knob.settings.push_back(std::move(*setting));
    bench.progress(0.3 + 0.7 * static_cast<double>(knob.settings.size()) / static_cast<double>(all.size()));
  }
  const std::string edge = ", " + std::to_string(core::ColourMapSettings{}.edge);
  knob.chosen = "A" + edge;
  const Setting &a = setting_of(knob, knob.chosen), &b = setting_of(knob, "B" + edge),
                &c = setting_of(knob, "C" + edge), &table = knob.settings.back();
  knob.why = "Cure A is the default, with " + digits(a.error) + " in the mean (" + a.note + "); B as printed has " +
             digits(b.error) + ", C " + digits(c.error) + " (" + c.note + "). " +
             (c.error < a.error ? "C is the better one on these paints. " : "") +
             "Packs hold a map as a colour table over the angles inside the coat, and of the cures with the coat's own "
             "index that table is the map itself; lines of index 1 lie across it. A paint's full table of " +
             table.label + " cells has " + digits(table.error) + " for " + digits(table.bytes / a.bytes) +
             " times the bytes and " + digits(table.time.median_ms / a.time.median_ms) + " times the time.";
  return knob;
}

Result<void> add_materials(Workbench& bench, Findings& findings) {
  auto samples = ggx_samples_knob(bench);
  if (!samples) return tl::unexpected(samples.error());
  bench.progress(0.3);
  auto map = isochromatic_knob(bench);
  if (!map) return tl::unexpected(map.error());
  findings.knobs.push_back(std::move(*samples));
  findings.knobs.push_back(std::move(*map));
  bench.progress(1.0);
  return {};
}

}  // namespace lackwerk::report
