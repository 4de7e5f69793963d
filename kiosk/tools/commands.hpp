// Every command of the `lackwerk` program, one registration each.
//
// Why it exists: main.cpp knows the list and nothing else; a command knows CLI11 and the library call behind it. Each
// function adds a subcommand whose callback sets `exit_code` (see output.hpp). `app` and `exit_code` must outlive the
// parsing. One thread.
#pragma once

namespace CLI {
class App;
}

namespace lackwerk::tools {

void add_capture_command(CLI::App& app, int& exit_code);          ///< capture: recipe -> capture folder
void add_import_command(CLI::App& app, int& exit_code);           ///< import: measured data -> capture folder
void add_fit_command(CLI::App& app, int& exit_code);              ///< fit: what was measured -> paint model
void add_pack_build_command(CLI::App& app, int& exit_code);       ///< pack build: captures -> paint pack
void add_pack_info_command(CLI::App& app, int& exit_code);        ///< pack info: what is in a paint pack
void add_pack_verify_command(CLI::App& app, int& exit_code);      ///< pack verify: is a pack whole and sane
void add_pack_sign_command(CLI::App& app, int& exit_code);        ///< pack sign: a minisign signature
void add_store_command(CLI::App& app, int& exit_code);            ///< store: add, list, remove, rollback
void add_scene_command(CLI::App& app, int& exit_code);            ///< scene build: a scene pack
void add_render_command(CLI::App& app, int& exit_code);           ///< render: a picture of a mix
void add_look_command(CLI::App& app, int& exit_code);             ///< look: the contact sheet of docs/look
void add_compare_command(CLI::App& app, int& exit_code);          ///< compare: CIEDE2000 of two pictures
void add_measure_compare_command(CLI::App& app, int& exit_code);  ///< measure-compare: CIEDE2000 of two captures
void add_flake_life_command(CLI::App& app, int& exit_code);       ///< flake-life: how fast flakes twinkle
void add_report_command(CLI::App& app, int& exit_code);           ///< report: error against run time, stiff cases
void add_scan_command(CLI::App& app, int& exit_code);             ///< scan morph, scan check: scans that grow
void add_scan_render_command(CLI::App& app, int& exit_code);      ///< scan render: a picture of a scan pack

/// The subcommand group `name` ("pack", "scene") of `app`, made on first use.
[[nodiscard]] CLI::App& command_group(CLI::App& app, const char* name, const char* description);

}  // namespace lackwerk::tools
