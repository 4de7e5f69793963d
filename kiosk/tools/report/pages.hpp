// A report as what people and programs read: a page, JSON, and a page of the documents.
//
// Why it exists: the same findings stand in all three, so none can say what the others do not. Pure functions; any
// thread.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/machine.hpp"

namespace lackwerk::report {

struct Run {
  Machine machine;
  bool quick = false;
  double seconds = 0.0;
  std::vector<std::string> left_out;                    ///< parts that could not run, and why
  std::vector<std::pair<std::string, double>> parts_s;  ///< how long each part took
};

/// Everything, for machines: `knobs[]`, `stiff[]`, `speeds[]`, `machine`. Numbers that do not exist are null.
[[nodiscard]] std::string report_json(const Findings& findings, const Run& run);
/// One self-contained HTML page with all curves inside.
[[nodiscard]] std::string report_page(const Findings& findings, const Run& run);
/// One page of Markdown. Curves are linked as `plots`/<file>, see plot_files.
[[nodiscard]] std::string report_markdown(const Findings& findings, const Run& run, const std::string& plots);
/// The curves as files: name and SVG text.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> plot_files(const Findings& findings);

}  // namespace lackwerk::report
