#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "packs/paint_pack.hpp"
#include "packs/scene_pack.hpp"

namespace lackwerk::tools {
namespace {

struct VerifyOptions {
  std::string pack;
  bool json = false;
};

/// Whichever of the two kinds the file is; the paint pack's error where it is neither.
Result<const char*> verify(const std::string& path) {
  const auto paint = packs::PaintPack::open(path, packs::Backing::copy);
  if (paint) return "paint pack";
  if (paint.error().field != "kind") return tl::unexpected(paint.error());
  if (const auto scene = packs::read_scene_pack(path, packs::Backing::copy); !scene)
    return tl::unexpected(scene.error());
  return "scene pack";
}

int run_verify(const VerifyOptions& options) {
  const auto kind = verify(options.pack);
  if (!kind) return report(kind.error());
  if (options.json)
    print(nlohmann::ordered_json{{"file", options.pack}, {"kind", *kind}, {"ok", true}}.dump(
        -1, ' ', false, nlohmann::json::error_handler_t::replace));
  else
    print(options.pack + ": " + *kind + ", whole and sound");
  return exit_done;
}

}  // namespace

void add_pack_verify_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* command = command_group(app, "pack", "Paint packs").add_subcommand("verify", "Check a paint or scene pack");
  command->add_option("PACK", options->pack, "file to check")->required();
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, &exit_code] { exit_code = run_verify(*options); });
}

}  // namespace lackwerk::tools
