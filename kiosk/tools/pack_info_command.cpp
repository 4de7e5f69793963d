#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "packs/paint_pack.hpp"

namespace lackwerk::tools {
namespace {

struct InfoOptions {
  std::string pack;
  bool json = false;
};

/// How the widths of the random cells were found.
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

nlohmann::ordered_json life_json(const core::FlakeLife& life) {
  return {{"cell_theta_h_deg", life.cell_h_deg}, {"cell_theta_i_deg", life.cell_i_deg}, {"origin", life_origin(life)}};
}

/// "random cells 6.5 degrees of theta_h, one for all theta_i (assumed: ...)".
std::string life_text(const core::FlakeLife& life) {
  const auto width = [](float deg, const char* angle) {
    return deg < core::widest_cell_deg ? fixed(static_cast<double>(deg), 2) + " degrees of " + angle
                                       : std::string("one for all ") + angle;
  };
  return "random cells " + width(life.cell_h_deg, "theta_h") + ", " + width(life.cell_i_deg, "theta_i") + " (" +
         life_origin(life) + ")";
}

nlohmann::ordered_json paint_json(const packs::PaintPack& pack, std::size_t k) {
  const core::PaintIdentity& identity = pack.paint().paints[k].identity;
  const packs::PaintError& error = pack.info().errors[k];
  return {{"name", identity.name},
          {"source", identity.source},
          {"provenance",
           {{"lobes", core::provenance_name(identity.lobes)},
            {"flakes", core::provenance_name(identity.flakes)},
            {"coat", core::provenance_name(identity.coat)}}},
          {"errors",
           {{"flake_w1_mean_lab", error.flake_w1_mean},
            {"flake_w1_max_lab", error.flake_w1_max},
            {"flake_w1_slice_lab", error.flake_w1_slice}}},
          {"flake_life", life_json(pack.paint().paints[k].life)},
          {"clusters", pack.paint().paints[k].clusters.size()},
          {"bytes", packs::paint_bytes(pack.paint(), k)}};
}

void print_json(const packs::PaintPack& pack) {
  const core::InterpolatablePaint& paint = pack.paint();
  const packs::PackInfo& info = pack.info();
  nlohmann::ordered_json out{{"id", info.id},
                             {"serial", info.serial},
                             {"schema_version", info.schema_version},
                             {"minimum_reader", info.minimum_reader},
                             {"tool_version", info.tool_version},
                             {"bytes", pack.file_bytes()},
                             {"slices", paint.layout.slice_count()},
                             {"levels", paint.level_count},
                             {"level0_texels", paint.level0_texels},
                             {"texel_mm", paint.texel_mm},
                             {"tuples", paint.mass.size()},
                             {"transport_cost_lab", info.transport_cost},
                             {"beyond_limit", info.beyond_limit},
                             {"paints", nlohmann::json::array()}};
  for (std::size_t k = 0; k < paint.paints.size(); ++k) out["paints"].push_back(paint_json(pack, k));
  print(out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void print_text(const packs::PaintPack& pack) {
  const core::InterpolatablePaint& paint = pack.paint();
  const packs::PackInfo& info = pack.info();
  print(info.id + ", serial " + std::to_string(info.serial) + ", " +
        fixed(static_cast<double>(pack.file_bytes()) / 1e6, 2) + " MB, made by " + info.tool_version);
  print(std::to_string(paint.layout.slice_count()) + " slices, " + std::to_string(paint.level_count) + " levels from " +
        std::to_string(paint.level0_texels) + " texels of " + fixed(static_cast<double>(paint.texel_mm), 3) +
        " mm; transport moves " + fixed(info.transport_cost, 2) + " Lab");
  print("mixes may go beyond a paint by up to " + fixed(info.beyond_limit, 2));
  for (std::size_t k = 0; k < paint.paints.size(); ++k) {
    const core::PaintIdentity& identity = paint.paints[k].identity;
    print("  " + identity.name + ": " + fixed(static_cast<double>(packs::paint_bytes(paint, k)) / 1e6, 2) +
          " MB, flake W1 mean " + fixed(static_cast<double>(info.errors[k].flake_w1_mean), 2) + " max " +
          fixed(static_cast<double>(info.errors[k].flake_w1_max), 2) + " Lab; lobes " +
          core::provenance_name(identity.lobes) + ", flakes " + core::provenance_name(identity.flakes) + ", coat " +
          core::provenance_name(identity.coat) + "; " + identity.source);
    if (paint.layout.slice_count() > 0) print("    " + life_text(paint.paints[k].life));
  }
}

int run_info(const InfoOptions& options) {
  const auto pack = packs::PaintPack::open(options.pack, packs::Backing::copy);
  if (!pack) return report(pack.error());
  options.json ? print_json(*pack) : print_text(*pack);
  return exit_done;
}

}  // namespace

void add_pack_info_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = command_group(app, "pack", "Paint packs").add_subcommand("info", "What is in a paint pack");
  command->add_option("PACK", options->pack, "paint pack")->required();
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, &exit_code] { exit_code = run_info(*options); });
}

}  // namespace lackwerk::tools
