#include <algorithm>
#include <cmath>

#include "kiosk/tools/output.hpp"
#include "kiosk/tools/report/curve_svg.hpp"
#include "kiosk/tools/report/pages.hpp"
#include "kiosk/tools/report/summary.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {
namespace {

/// A cell of a table: bars would end it.
std::string cell(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : tools::one_line(text)) {
    if (c == '|') out += '\\';
    out += c;
  }
  return out;
}

std::string row(const std::vector<std::string>& cells) {
  std::string out = "|";
  for (const std::string& text : cells) out += " " + cell(text) + " |";
  return out + "\n";
}

std::string plot_name(const Knob& knob, Price price) {
  return knob.id + (price == Price::bytes ? "-bytes" : "") + ".svg";
}

std::string knob_text(const Knob& knob, const std::string& plots) {
  std::string out =
      "### " + knob.title + "\n\n" + knob.what + "\n\nDefault: **" + knob.chosen + "**. " + knob.why + "\n\n";
  for (const Price price : {Price::time, Price::bytes})
    if (!curve_svg(knob, price).empty())
      out += "![" + knob.title + "](" + plots + "/" + plot_name(knob, price) + ")\n\n";
  const bool tail = std::any_of(knob.settings.begin(), knob.settings.end(),
                                [](const Setting& setting) { return std::isfinite(setting.p95); });
  const bool bytes = std::any_of(knob.settings.begin(), knob.settings.end(),
                                 [](const Setting& setting) { return std::isfinite(setting.bytes); });
  std::vector<std::string> head{"setting", "error: " + knob.error_unit}, rule{"---", "---"};
  if (tail) head.insert(head.end(), {"p95", "worst"});
  head.push_back("time: " + knob.time_of);
  if (bytes) head.push_back("bytes: " + knob.bytes_of);
  head.emplace_back("note");
  rule.resize(head.size(), "---");
  out += row(head) + row(rule);
  for (const Setting& setting : knob.settings) {
    const std::string label = setting.label == knob.chosen ? "**" + setting.label + "**" : setting.label;
    std::vector<std::string> cells{label, digits(setting.error)};
    if (tail) cells.insert(cells.end(), {digits(setting.p95), digits(setting.worst)});
    cells.push_back(timing_text(setting.time));
    if (bytes) cells.push_back(bytes_text(setting.bytes));
    cells.push_back(setting.note);
    out += row(cells);
  }
  return out + "\n";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> plot_files(const Findings& findings) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const Knob& knob : findings.knobs)
    for (const Price price : {Price::time, Price::bytes})
      if (std::string svg = curve_svg(knob, price); !svg.empty())
        out.emplace_back(plot_name(knob, price), std::move(svg));
  return out;
}

std::string report_markdown(const Findings& findings, const Run& run, const std::string& plots) {
  const Machine& machine = run.machine;
  std::string out =
      "# Error against run time\n\nMade by `scripts/error-time` from `lackwerk report`; nothing here is written by "
      "hand. " +
      machine.processor + ", " + std::to_string(machine.cores) + " cores, " + digits(machine.memory_gib) + " GiB, " +
      machine.system + ", " + machine.compiler + "; load before " + tools::fixed(machine.load_before, 2) + "; " +
      tools::fixed(run.seconds, 0) + " s in all. Times are medians with quartiles and counts.\n\n";
  for (const std::string& line : run.left_out) out += "Left out: " + line + "\n\n";
  out +=
      "## Findings\n\n" + row({"knob", "default", "error", "time", "why"}) + row({"---", "---", "---", "---", "---"});
  for (const Knob& knob : findings.knobs) {
    const auto chosen = std::find_if(knob.settings.begin(), knob.settings.end(),
                                     [&](const Setting& setting) { return setting.label == knob.chosen; });
    if (chosen == knob.settings.end()) continue;
    out += row({knob.title, knob.chosen, digits(chosen->error) + " (" + knob.error_unit + ")",
                chosen->time.count > 0 ? digits(chosen->time.median_ms) + " ms" : "-", knob.why});
  }
  out += "\n## Speeds\n\n" + row({"what", "figure", "aim", "count", "bounded by"}) +
         row({"---", "---", "---", "---", "---"});
  for (const Speed& speed : findings.speeds)
    out +=
        row({speed.what, digits(speed.value) + " " + speed.unit,
             aim_text(speed) + (speed.reached() ? "" : ": **missed**"), std::to_string(speed.count), speed.bound_by});
  out += "\n## Stiff and extreme cases\n\n" + std::to_string(findings.stiff.size()) + " cases, " +
         std::to_string(failed_cases(findings)) + " beyond their bounds. The same cases are unit tests.\n\n" +
         row({"kernel", "measure", "cases", "worst", "bound", "where"}) +
         row({"---", "---", "---", "---", "---", "---"});
  for (const StiffGroup& group : stiff_groups(findings))
    out += row({group.kernel, group.measure, std::to_string(group.cases.size()), digits(group.worst->worst),
                digits(group.bound) + (group.failed > 0 ? ": **failed**" : ""),
                group.worst->name + (group.worst->where.empty() ? "" : "; " + group.worst->where)});
  out += "\n## Knobs\n\n";
  for (const Knob& knob : findings.knobs) out += knob_text(knob, plots);
  return out;
}

}  // namespace lackwerk::report
