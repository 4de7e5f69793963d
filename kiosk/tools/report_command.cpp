#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "kiosk/display/quality_table.hpp"
#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/progress.hpp"
#include "kiosk/tools/report/machine.hpp"
#include "kiosk/tools/report/pages.hpp"
#include "kiosk/tools/report/parts.hpp"
#include "kiosk/tools/report/picture_knobs.hpp"
#include "kiosk/tools/report/summary.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::tools {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::string out;
  std::vector<std::string> only;
  bool quick = false, json = false;
};

Result<std::vector<report::Part>> wanted_parts(const ReportOptions& options) {
  const auto all = report::parts();
  if (options.only.empty()) return std::vector<report::Part>(all.begin(), all.end());
  std::vector<report::Part> out;
  out.reserve(options.only.size());
  for (const std::string& name : options.only) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const report::Part& part) { return part.name == name; });
    if (found == all.end()) {
      std::string known;
      for (const report::Part& part : all) known += (known.empty() ? "" : ", ") + std::string(part.name);
      return fail("", "--only", "there is no part '" + name + "'", "parts are: " + known, ErrorKind::usage);
    }
    out.push_back(*found);
  }
  return out;
}

Result<void> write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) return fail(path.string(), "", "cannot be written", "check folder, space and permissions");
  return {};
}

/// Makes the folder and shows that it can be written to: now, not after a quarter of an hour.
Result<void> ready_folder(const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return fail(folder.string(), "", "cannot be made: " + code.message(), "give another folder");
  return write_text(folder / "report.json", "{}\n");
}

/// Runs the parts; those that cannot run are told in `run`.
void measure(const std::vector<report::Part>& parts, report::Workbench& bench, report::Findings& findings,
             report::Run& run, Progress& progress) {
  double total = 0.0;
  for (const report::Part& part : parts) total += run.quick ? part.quick_s : part.full_s;
  double before = 0.0;
  for (const report::Part& part : parts) {
    const double share = (run.quick ? part.quick_s : part.full_s) / total;
    bench.on_progress = [&](double fraction) {
      progress.update(before + share * std::clamp(fraction, 0.0, 1.0), part.name);
    };
    bench.progress(0.0);
    const double started_s = progress.elapsed_s();
    if (auto done = part.run(bench, findings); !done)
      run.left_out.push_back(std::string(part.name) + ": " + done.error().what +
                             (done.error().remedy.empty() ? "" : " (" + done.error().remedy + ")"));
    run.parts_s.emplace_back(part.name, progress.elapsed_s() - started_s);
    before += share;
  }
  bench.on_progress = nullptr;
}

Result<void> write_all(const fs::path& folder, const report::Findings& findings, const report::Run& run) {
  for (const auto& [name, svg] : report::plot_files(findings))
    if (auto done = write_text(folder / name, svg); !done) return done;
  const bool ladder = std::any_of(findings.knobs.begin(), findings.knobs.end(),
                                  [](const report::Knob& knob) { return knob.id == "quality"; });
  if (ladder) {
    const auto table = report::quality_table_of(findings);
    if (!table) return tl::unexpected(table.error());
    if (auto done = kiosk::write_quality_table(folder / "quality.json", *table); !done) return done;
  }
  if (auto done = write_text(folder / "report.json", report::report_json(findings, run)); !done) return done;
  if (auto done = write_text(folder / "error-time.md", report::report_markdown(findings, run, "error-time")); !done)
    return done;
  return write_text(folder / "index.html", report::report_page(findings, run));
}

int run_report(const ReportOptions& options) {
  const auto parts = wanted_parts(options);
  if (!parts) return report(parts.error());
  const fs::path folder = options.out;
  if (const auto ready = ready_folder(folder); !ready) return report(ready.error());

  report::Run run;
  run.quick = options.quick;
  run.machine = report::this_machine();
  report::Workbench bench(options.quick);
  report::Findings findings;
  {
    Progress progress("report", options.json);
    measure(*parts, bench, findings, run, progress);
    run.seconds = progress.elapsed_s();
  }
  run.machine.load_after = report::load_now();
  if (const auto written = write_all(folder, findings, run); !written) return report(written.error());

  const int failed = report::failed_cases(findings), missed = report::missed_aims(findings);
  if (options.json) {
    print(report::report_json(findings, run));
  } else {
    for (const std::string& line : run.left_out) print("left out: " + line);
    for (const report::StiffCase& one : findings.stiff)
      if (!one.passed())
        print("beyond its bound: " + one.kernel + ", " + one.name + ": " + one.measure + " " +
              report::digits(one.worst) + ", bound " + report::digits(one.bound) + ", " + one.where);
    for (const report::Speed& speed : findings.speeds)
      if (!speed.reached())
        print("short of its aim: " + speed.what + ": " + report::digits(speed.value) + " " + speed.unit + ", aim " +
              report::aim_text(speed));
    print((folder / "index.html").string() + ": " + std::to_string(findings.knobs.size()) + " knobs, " +
          std::to_string(findings.stiff.size()) + " stiff cases (" + std::to_string(failed) +
          " beyond their bounds), " + std::to_string(findings.speeds.size()) + " speeds (" + std::to_string(missed) +
          " short of their aims), " + fixed(run.seconds, 1) + " s");
  }
  // A slow machine is no failure; a wrong result is.
  return failed == 0 ? exit_done : exit_failed;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand(
      "report",
      "Error against run time for every knob, and the stiff cases, measured on this machine: index.html, report.json, "
      "one SVG a knob, quality.json for the kiosk. Exit code 1 if a stiff case is beyond its bound");
  command->add_option("-o,--output", options->out, "folder that gets the files; made if it does not exist")->required();
  command->add_flag("--quick", options->quick,
                    "smaller inputs and fewer repetitions: a minute instead of a quarter of an hour");
  std::string known;
  for (const report::Part& part : report::parts()) known += (known.empty() ? "" : ", ") + std::string(part.name);
  command->add_option("--only", options->only, "run these parts alone: " + known)->delimiter(',');
  command->add_flag("--json", options->json, "print report.json on stdout");
  command->callback([options, &exit_code] { exit_code = run_report(*options); });
}

}  // namespace lackwerk::tools
