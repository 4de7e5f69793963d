// lackwerk: the colour engineer's and the dealer's command line. Every command is in a file of its own.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <exception>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"

namespace lackwerk::tools {

CLI::App& command_group(CLI::App& app, const char* name, const char* description) {
  for (CLI::App* known : app.get_subcommands([](CLI::App*) { return true; }))
    if (known->get_name() == name) return *known;
  CLI::App* group = app.add_subcommand(name, description);
  group->require_subcommand(1);
  return *group;
}

namespace {

int run(int argc, char** argv) {
  CLI::App app{"Lackwerk: measured car paints that morph. Exit codes: 0 done, 1 the run failed, 2 usage.", "lackwerk"};
  app.require_subcommand(1);
  app.set_version_flag("--version", "lackwerk " LACKWERK_VERSION);
  int exit_code = exit_done;
  add_capture_command(app, exit_code);
  add_import_command(app, exit_code);
  add_fit_command(app, exit_code);
  add_pack_build_command(app, exit_code);
  add_pack_info_command(app, exit_code);
  add_pack_verify_command(app, exit_code);
  add_pack_sign_command(app, exit_code);
  add_store_command(app, exit_code);
  add_scene_command(app, exit_code);
  add_render_command(app, exit_code);
  add_look_command(app, exit_code);
  add_compare_command(app, exit_code);
  add_measure_compare_command(app, exit_code);
  add_flake_life_command(app, exit_code);
  add_report_command(app, exit_code);
  add_scan_command(app, exit_code);
  add_scan_render_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return report(
        {"", "", error.what(), "lackwerk --help lists the commands, COMMAND --help its options", ErrorKind::usage});
  }
  return exit_code;
}

}  // namespace
}  // namespace lackwerk::tools

int main(int argc, char** argv) {
  try {
    return lackwerk::tools::run(argc, argv);
  } catch (const std::exception& error) {
    // Out of memory, or a library's exception that nobody expected: still one line, still exit code 1.
    return lackwerk::tools::report(
        {"", "", error.what(), "please report this with the command you ran", lackwerk::ErrorKind::run});
  }
}
