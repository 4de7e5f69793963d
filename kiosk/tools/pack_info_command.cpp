#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/pack_info_json.hpp"
#include "kiosk/tools/scan_info.hpp"
#include "packs/paint_pack.hpp"

namespace lackwerk::tools {
namespace {

struct InfoOptions {
  std::string pack;
  bool json = false;
};

/// "random cells 6.5 degrees of theta_h, one for all theta_i (assumed: ...)".
std::string life_text(const core::FlakeLife& life) {
  const auto width = [](float deg, const char* angle) {
    return deg < core::widest_cell_deg ? fixed(static_cast<double>(deg), 2) + " degrees of " + angle
                                       : std::string("one for all ") + angle;
  };
  return "random cells " + width(life.cell_h_deg, "theta_h") + ", " + width(life.cell_i_deg, "theta_i") + " (" +
         life_origin(life) + ")";
}

/// "fitted; CIEDE2000 against the measurement, 7212 sphere pixels: mean 0.97, p95 2.31, max 5.02".
std::string form_text(const packs::FormError& form) {
  const std::string name = packs::form_name(form.form);
  if (form.count == 0) return name + "; nothing measured beside the model";
  return name + "; CIEDE2000 against the measurement, " + std::to_string(form.count) + " " +
         packs::judge_name(form.judged_by) + ": mean " + fixed(static_cast<double>(form.e2000_mean), 2) + ", p95 " +
         fixed(static_cast<double>(form.e2000_p95), 2) + ", max " + fixed(static_cast<double>(form.e2000_max), 2);
}

void print_json(const packs::PaintPack& pack) {
  print(pack_info_json(pack).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
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
    print("    " + form_text(info.errors[k].form));
    if (paint.layout.slice_count() > 0) print("    " + life_text(paint.paints[k].life));
  }
}

int print_scans(const InfoOptions& options) {
  const auto pack = packs::ScanPack::open(options.pack, packs::Backing::copy);
  if (!pack) return report(pack.error());
  if (options.json)
    print(scan_info_json(*pack).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  else
    print(scan_info_text(*pack));
  return exit_done;
}

int run_info(const InfoOptions& options) {
  if (packs::sealed_kind_of(std::filesystem::path(options.pack)) == packs::SealedKind::scan)
    return print_scans(options);
  const auto pack = packs::PaintPack::open(options.pack, packs::Backing::copy);
  if (!pack) return report(pack.error());
  options.json ? print_json(*pack) : print_text(*pack);
  return exit_done;
}

}  // namespace

void add_pack_info_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command =
      command_group(app, "pack", "Paint packs").add_subcommand("info", "What is in a paint or scan pack");
  command->add_option("PACK", options->pack, "paint or scan pack")->required();
  command->add_flag("--json", options->json, "print JSON: every field, and what each of them means in which unit");
  command->callback([options, &exit_code] { exit_code = run_info(*options); });
}

}  // namespace lackwerk::tools
