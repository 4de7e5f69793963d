#include "kiosk/tools/pack_info_json.hpp"

#include <glm/vec3.hpp>

namespace lackwerk::tools {
namespace {

using Json = nlohmann::ordered_json;

struct Field {
  const char* path;
  const char* unit;
  const char* meaning;
};

/// In the order in which they are printed; ranges stand in docs/pack-format.md.
constexpr Field documented[] = {
    {"id", "", "the pack's name in signatures, stores and codes of mixes"},
    {"serial", "", "grows with every release of the same id; a store refuses a lower one"},
    {"schema_version", "", "version of the format the pack was written in"},
    {"minimum_reader", "", "oldest schema version whose readers may open it"},
    {"tool_version", "", "the program that wrote it"},
    {"bytes", "bytes", "size of the file"},
    {"num_theta", "bins per 90 degrees", "resolution of the slices along theta_h and theta_i"},
    {"layout", "slices", "first slice of each theta_i row, and the end; empty: no flakes"},
    {"slices", "", "flake slices: angle pairs at which flakes are stored"},
    {"levels", "", "mip levels of each slice; the last is one texel"},
    {"level0_texels", "texels", "along an edge of a slice at level 0"},
    {"texel_mm", "mm", "edge of a texel of level 0 on the paint"},
    {"range_lo", "CIE Lab, D65", "lower end of the 16-bit grid of cluster corners, of the radiance factor pi Xi"},
    {"range_hi", "CIE Lab, D65", "upper end of that grid"},
    {"tuples", "", "over all slices and levels: one cluster per paint under one transported probability"},
    {"row_mass", "", "what the masses of one slice's tuples sum to; a mass divided by it is a probability"},
    {"random_seed", "", "of the random textures, which are not stored"},
    {"transport_cost_lab", "Lab units", "mean distance that the transport moves a flake, for information"},
    {"beyond_limit", "weight", "how far beyond its paints a mix may go and still be a paint"},
    {"paints", "", "one entry per paint, in the order of weights"},
    {"paints[].name", "", "as shown to visitors"},
    {"paints[].source", "", "where the numbers were published or measured"},
    {"paints[].provenance", "", "measured, published-fit or simulated, for each part"},
    {"paints[].provenance.lobes", "", "of diffuse part, lobes and colour table"},
    {"paints[].provenance.flakes", "", "of the flake slices"},
    {"paints[].provenance.coat", "", "of the clear coat"},
    {"paints[].diffuse", "albedo, linear sRGB", "a of the diffuse part a / pi"},
    {"paints[].lobes", "", "Cook-Torrance lobes with Beckmann's distribution, by falling roughness"},
    {"paints[].lobes[].s", "weight, linear sRGB", "factor of the lobe"},
    {"paints[].lobes[].m", "slope", "roughness: root mean square slope of the microfacets"},
    {"paints[].lobes[].f0", "reflectance", "Schlick's Fresnel value at normal incidence"},
    {"paints[].coat_ior", "refractive index", "of the clear coat that mirrors and attenuates; 1: none"},
    {"paints[].refraction_ior", "refractive index", "by which directions are bent below the coat; 1: not at all"},
    {"paints[].colour_table_nodes", "nodes per 90 degrees", "edge of the colour table chi; 0: chi is 1"},
    {"paints[].errors", "", "what the builder measured between the capture and this pack"},
    {"paints[].errors.flake_w1_mean_lab", "Lab units", "1-Wasserstein distance of slices and their clusters, mean"},
    {"paints[].errors.flake_w1_max_lab", "Lab units", "the same of the worst slice"},
    {"paints[].errors.flake_w1_slice_lab", "Lab units", "the same slice by slice"},
    {"paints[].form", "", "how it came to lobes, table and slices"},
    {"paints[].form.name", "", "given (as captured), fitted or mapped (docs/import.md)"},
    {"paints[].form.judged_by", "", "what was measured beside the model: sphere pixels, readings or nothing"},
    {"paints[].form.count", "", "of pixels or readings; 0: the figures are null"},
    {"paints[].form.ciede2000_mean", "CIEDE2000", "between measurement and this paint"},
    {"paints[].form.ciede2000_p95", "CIEDE2000", "the same, 95 of 100 are below"},
    {"paints[].form.ciede2000_max", "CIEDE2000", "the worst"},
    {"paints[].flake_life", "", "over which angles a flake shines"},
    {"paints[].flake_life.cell_theta_h_deg", "degrees inside the coat", "width of a random cell along theta_h"},
    {"paints[].flake_life.cell_theta_i_deg", "degrees inside the coat", "along theta_i; 90: one for all angles"},
    {"paints[].flake_life.origin", "", "how the widths were found"},
    {"paints[].clusters", "", "cuboids over all slices and levels"},
    {"paints[].bytes", "bytes", "of the file, for this paint alone"},
    {"fields", "", "this list"},
};

Json rgb(const glm::dvec3& value) { return Json::array({value.x, value.y, value.z}); }
Json lab(const glm::vec3& value) { return Json::array({value.x, value.y, value.z}); }

Json lobes_json(const core::AnalyticPaint& paint) {
  Json out = Json::array();
  for (const core::Lobe& lobe : paint.lobes) out.push_back({{"s", rgb(lobe.s)}, {"m", lobe.m}, {"f0", lobe.f0}});
  return out;
}

Json form_json(const packs::FormError& form) {
  const auto figure = [&](float value) { return form.count > 0 ? Json(value) : Json(); };
  return {{"name", packs::form_name(form.form)},
          {"judged_by", packs::judge_name(form.judged_by)},
          {"count", form.count},
          {"ciede2000_mean", figure(form.e2000_mean)},
          {"ciede2000_p95", figure(form.e2000_p95)},
          {"ciede2000_max", figure(form.e2000_max)}};
}

Json paint_json(const packs::PaintPack& pack, std::size_t k) {
  const core::InterpolatablePaint::PaintPart& part = pack.paint().paints[k];
  const core::PaintIdentity& identity = part.identity;
  const packs::PaintError& error = pack.info().errors[k];
  return {{"name", identity.name},
          {"source", identity.source},
          {"provenance",
           {{"lobes", core::provenance_name(identity.lobes)},
            {"flakes", core::provenance_name(identity.flakes)},
            {"coat", core::provenance_name(identity.coat)}}},
          {"diffuse", rgb(part.analytic.diffuse)},
          {"lobes", lobes_json(part.analytic)},
          {"coat_ior", part.analytic.coat_ior},
          {"refraction_ior", part.analytic.refraction_ior},
          {"colour_table_nodes", part.analytic.table ? part.analytic.table->num_theta : 0},
          {"errors",
           {{"flake_w1_mean_lab", error.flake_w1_mean},
            {"flake_w1_max_lab", error.flake_w1_max},
            {"flake_w1_slice_lab", error.flake_w1_slice}}},
          {"form", form_json(error.form)},
          {"flake_life",
           {{"cell_theta_h_deg", part.life.cell_h_deg},
            {"cell_theta_i_deg", part.life.cell_i_deg},
            {"origin", life_origin(part.life)}}},
          {"clusters", part.clusters.size()},
          {"bytes", packs::paint_bytes(pack.paint(), k)}};
}

}  // namespace

const char* life_origin(const core::FlakeLife& life) {
  switch (life.origin) {
    case core::LifeOrigin::fine:
      return "measured at fine angle steps";
    case core::LifeOrigin::slices:
      return "from neighbouring slices";
    case core::LifeOrigin::assumed:
      break;
  }
  return "assumed for a life of 6.5 degrees: not measured";
}

Json pack_info_json(const packs::PaintPack& pack) {
  const core::InterpolatablePaint& paint = pack.paint();
  const packs::PackInfo& info = pack.info();
  Json out{{"id", info.id},
           {"serial", info.serial},
           {"schema_version", info.schema_version},
           {"minimum_reader", info.minimum_reader},
           {"tool_version", info.tool_version},
           {"bytes", pack.file_bytes()},
           {"num_theta", paint.layout.num_theta},
           {"layout", paint.layout.lut},
           {"slices", paint.layout.slice_count()},
           {"levels", paint.level_count},
           {"level0_texels", paint.level0_texels},
           {"texel_mm", paint.texel_mm},
           {"range_lo", lab(paint.range.lo)},
           {"range_hi", lab(paint.range.hi)},
           {"tuples", paint.mass.size()},
           {"row_mass", paint.row_mass},
           {"random_seed", paint.random_seed},
           {"transport_cost_lab", info.transport_cost},
           {"beyond_limit", info.beyond_limit},
           {"paints", Json::array()}};
  for (std::size_t k = 0; k < paint.paints.size(); ++k) out["paints"].push_back(paint_json(pack, k));
  Json& fields = out["fields"] = Json::object();
  for (const Field& field : documented) fields[field.path] = {{"unit", field.unit}, {"meaning", field.meaning}};
  return out;
}

}  // namespace lackwerk::tools
