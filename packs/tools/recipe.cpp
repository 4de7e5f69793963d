#include "packs/tools/recipe.hpp"

#include <vector>

#include "core/analysis/brdf_fit_model.hpp"
#include "packs/tools/film_table.hpp"
#include "packs/tools/toml_fields.hpp"

namespace lackwerk::packs {
namespace {

constexpr double max_weight = 1e3;  ///< of s and a: far above any paint, far below trouble

FlakeRecipe read_flakes(Fields& fields, core::PaintIdentity& identity) {
  identity.flakes = fields.provenance("provenance");
  FlakeRecipe flakes;
  flakes.share = fields.number("share", 1e-3, 1.0);
  flakes.coverage = fields.number("coverage", 1e-4, 1.0);
  flakes.diameter_um = fields.number("diameter_um", 1.0, 200.0);
  flakes.diameter_spread = fields.number("diameter_spread", 0.0, 1.0);
  flakes.diameter_max_um = fields.number("diameter_max_um", flakes.diameter_um, 500.0);
  return flakes;
}

FilmStack read_film(Fields& fields) {
  FilmStack film;
  film.resin = fields.number("resin_ior", 1.0, 2.0);
  film.table_nodes = static_cast<std::uint16_t>(fields.whole("table_nodes", 2, 256));
  for (Fields& layer : fields.tables("layer", {"material", "nm"}, 16)) {
    const std::string material = layer.text("material");
    if (material != "TiO2" && material != "SiO2") layer.wrong("material", "unknown material", "use TiO2 or SiO2");
    film.layers.push_back(
        {material == "TiO2" ? FilmMaterial::titania : FilmMaterial::silica, layer.number("nm", 0.0, 5000.0)});
  }
  return film;
}

void read_lobes(Fields& fields, core::AnalyticPaint& paint) {
  const auto lobes = fields.tables("lobe", {"s", "m", "f0"}, core::max_lobes);
  std::size_t count = 0;
  for (Fields lobe : lobes) {
    paint.lobes[count].s = lobe.rgb("s", 0.0, max_weight);
    paint.lobes[count].m = lobe.number("m", core::min_roughness, 1.0);
    paint.lobes[count].f0 = lobe.number("f0", 0.0, 1.0);
    ++count;
  }
  order_lobes(paint, count);
}

/// A published lobe gives way to a real coat: the fit was made through that coat, so what lies below it is divided by
/// the two transmissions at normal incidence.
void put_under_coat(core::AnalyticPaint& paint, std::size_t lobe, double ior) {
  const double f0 = (ior - 1.0) * (ior - 1.0) / ((ior + 1.0) * (ior + 1.0));
  const double twice_through = (1.0 - f0) * (1.0 - f0);
  paint.lobes[lobe].s = glm::dvec3(0.0);
  paint.diffuse /= twice_through;
  for (core::Lobe& other : paint.lobes) other.s /= twice_through;
  paint.coat_ior = ior;
}

Result<Recipe> read_at_depth(const std::filesystem::path& file, int depth) {
  auto document = parse_toml(file);
  if (!document) return tl::unexpected(document.error());
  FirstError first{file.string(), std::nullopt};

  if (document->contains("base")) {
    Fields fields(first, *document, "",
                  {"name", "source", "base", "replace_lobe", "coat_ior", "refraction_ior", "coat_provenance"});
    if (depth > 0) fields.wrong("base", "a base must not have a base itself", "name the recipe with the numbers");
    const std::string base = fields.text("base");
    const std::string name = fields.text("name");
    const std::string source = fields.text("source");
    const auto lobe = static_cast<std::size_t>(fields.whole("replace_lobe", 1, core::max_lobes)) - 1;
    const double coat = fields.number("coat_ior", 1.0, 4.0);
    const double refraction = fields.number("refraction_ior", 1.0, 4.0);
    const core::Provenance provenance = fields.provenance("coat_provenance");
    if (first.error) return tl::unexpected(*first.error);
    auto recipe = read_at_depth(file.parent_path() / base, depth + 1);
    if (!recipe) return recipe;
    if (recipe->analytic.coat_ior != 1.0) return fail(file.string(), "base", "already has a coat", "name one without");
    recipe->identity.name = name;
    recipe->identity.source = source;
    recipe->identity.coat = provenance;
    recipe->analytic.refraction_ior = refraction;
    put_under_coat(recipe->analytic, lobe, coat);
    return recipe;
  }

  Recipe recipe;
  Fields fields(first, *document, "",
                {"name", "source", "provenance", "coat_provenance", "coat_ior", "refraction_ior", "diffuse", "lobe",
                 "flakes", "film", "base", "replace_lobe"});
  recipe.identity.name = fields.text("name");
  recipe.identity.source = fields.text("source");
  recipe.identity.lobes = fields.provenance("provenance");
  recipe.identity.coat = fields.provenance("coat_provenance");
  recipe.analytic.coat_ior = fields.number("coat_ior", 1.0, 4.0);
  recipe.analytic.refraction_ior = fields.number("refraction_ior", 1.0, 4.0);
  recipe.analytic.diffuse = fields.rgb("diffuse", 0.0, max_weight);
  read_lobes(fields, recipe.analytic);
  if (fields.has("replace_lobe")) fields.wrong("replace_lobe", "needs a base", "add base = \"...\"");
  if (auto flakes = fields.table(
          "flakes", {"provenance", "share", "coverage", "diameter_um", "diameter_spread", "diameter_max_um"})) {
    recipe.flakes = read_flakes(*flakes, recipe.identity);
  }
  std::optional<FilmStack> film;
  if (auto inner = fields.table("film", {"resin_ior", "table_nodes", "layer"})) film = read_film(*inner);
  if (first.error) return tl::unexpected(*first.error);
  if (film) recipe.analytic.table = film_table(*film, recipe.analytic);
  return recipe;
}

}  // namespace

Result<Recipe> read_recipe(const std::filesystem::path& file) { return read_at_depth(file, 0); }

glm::dvec3 table_colour(const core::AnalyticPaint& paint, double theta_h, double theta_i) {
  return core::chi_at(paint, theta_h, theta_i);
}

}  // namespace lackwerk::packs
