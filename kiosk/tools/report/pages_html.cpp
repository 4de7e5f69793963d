#include <algorithm>
#include <cmath>
#include <string_view>

#include "kiosk/tools/output.hpp"
#include "kiosk/tools/report/curve_svg.hpp"
#include "kiosk/tools/report/pages.hpp"
#include "kiosk/tools/report/pareto.hpp"
#include "kiosk/tools/report/summary.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {
namespace {

constexpr std::string_view style = R"(
:root{--ink:#1f2430;--soft:#5b6472;--line:#e3e6ea;--good:#0f766e;--bad:#b42318;--paper:#fff;--wash:#f6f7f9}
*{box-sizing:border-box}
body{margin:0;background:var(--wash);color:var(--ink);font:15px/1.55 Inter,"Helvetica Neue",Arial,sans-serif}
main{max-width:1080px;margin:0 auto;padding:48px 32px 96px}
h1{font-size:34px;font-weight:600;letter-spacing:-.02em;margin:0 0 8px}
h2{font-size:23px;font-weight:600;letter-spacing:-.01em;margin:56px 0 16px}
h3{font-size:18px;font-weight:600;margin:0 0 4px}
p{margin:6px 0;max-width:74ch}
.soft{color:var(--soft)}
.card{background:var(--paper);border:1px solid var(--line);border-radius:10px;padding:24px 28px;margin:18px 0}
.tiles{display:grid;grid-template-columns:repeat(4,1fr);gap:14px;margin:28px 0 8px}
.tile{background:var(--paper);border:1px solid var(--line);border-radius:10px;padding:16px 18px}
.tile b{display:block;font-size:26px;font-weight:600;letter-spacing:-.02em}
.why{border-left:3px solid var(--ink);padding-left:12px;margin:12px 0 16px}
svg{max-width:100%;height:auto;display:block;margin:8px 0}
table{border-collapse:collapse;width:100%;font-size:13px;font-variant-numeric:tabular-nums;margin:10px 0}
th{text-align:left;font-weight:600;color:var(--soft);border-bottom:1px solid var(--ink);padding:6px 10px 6px 0;vertical-align:bottom}
td{border-bottom:1px solid var(--line);padding:5px 14px 5px 0;vertical-align:top}
.figures td{white-space:nowrap}.figures td.text{white-space:normal;width:45%}
tr.chosen td{font-weight:600}
.good{color:var(--good)}.bad{color:var(--bad);font-weight:600}
summary{cursor:pointer;color:var(--soft);font-size:13px;margin-top:8px}
nav{columns:3;font-size:13px;margin:14px 0}nav a{color:var(--ink);text-decoration:none;border-bottom:1px solid var(--line)}
)";

std::string e(const std::string& text) { return markup_escaped(text); }
std::string cell(const std::string& text, std::string_view kind = "td") {
  return "<" + std::string(kind) + ">" + text + "</" + std::string(kind) + ">";
}
std::string tile(const std::string& number, const std::string& text, std::string_view colour = "") {
  return "<div class=\"tile\"><b class=\"" + std::string(colour) + "\">" + e(number) + "</b>" + e(text) + "</div>\n";
}

template <class Has>
bool any_setting(const Knob& knob, Has has) {
  return std::any_of(knob.settings.begin(), knob.settings.end(), has);
}

std::string settings_table(const Knob& knob) {
  const bool tail = any_setting(knob, [](const Setting& s) { return std::isfinite(s.p95); });
  const bool worst = any_setting(knob, [](const Setting& s) { return std::isfinite(s.worst); });
  const bool bytes = any_setting(knob, [](const Setting& s) { return std::isfinite(s.bytes); });
  const bool timed = any_setting(knob, [](const Setting& s) { return s.time.count > 0; });
  const bool notes = any_setting(knob, [](const Setting& s) { return !s.note.empty(); });
  const auto front = pareto_front(knob.settings);
  std::string out = "<table class=\"figures\"><tr>" + cell("setting", "th") + cell("error", "th");
  if (tail) out += cell("p95", "th");
  if (worst) out += cell("worst", "th");
  if (timed) out += cell("median", "th") + cell("quartiles", "th") + cell("n", "th");
  if (bytes) out += cell("bytes", "th");
  if (timed) out += cell("front", "th");
  if (notes) out += cell("", "th");
  out += "</tr>\n";
  for (std::size_t k = 0; k < knob.settings.size(); ++k) {
    const Setting& s = knob.settings[k];
    out += s.label == knob.chosen ? "<tr class=\"chosen\">" : "<tr>";
    out += cell(e(s.label) + (s.label == knob.chosen ? " (default)" : "")) + cell(digits(s.error));
    if (tail) out += cell(digits(s.p95));
    if (worst) out += cell(digits(s.worst));
    if (timed) {
      const bool here = s.time.count > 0;
      out += cell(here ? digits(s.time.median_ms) + " ms" : "") +
             cell(here ? digits(s.time.low_ms) + " to " + digits(s.time.high_ms) : "") +
             cell(here ? std::to_string(s.time.count) : "");
    }
    if (bytes) out += cell(bytes_text(s.bytes));
    if (timed) out += cell(std::find(front.begin(), front.end(), k) != front.end() ? "&#9679;" : "");
    if (notes) out += "<td class=\"text\">" + e(s.note) + "</td>";
    out += "</tr>\n";
  }
  return out + "</table>";
}

std::string knob_card(const Knob& knob) {
  std::string out = "<div class=\"card\" id=\"" + e(knob.id) + "\"><h3>" + e(knob.title) + "</h3>\n<p class=\"soft\">" +
                    e(knob.what) + "</p>\n<p class=\"why\"><b>Default: " + e(knob.chosen) + ".</b> " + e(knob.why) +
                    "</p>\n";
  for (const Price price : {Price::time, Price::bytes}) out += curve_svg(knob, price);
  out += "<p class=\"soft\">Error: " + e(knob.error_unit) + ". Time: " + e(knob.time_of) +
         (knob.bytes_of.empty() ? "" : ". Bytes: " + e(knob.bytes_of)) +
         ". Ringed: the default; grey band: the Pareto front; hollow: measured, not to be chosen.</p>\n";
  return out + settings_table(knob) + "</div>\n";
}

std::string speeds_card(const Findings& findings) {
  std::string out = "<div class=\"card\"><table><tr>" + cell("what", "th") + cell("figure", "th") + cell("aim", "th") +
                    cell("n", "th") + cell("bounded by", "th") + "</tr>\n";
  for (const Speed& speed : findings.speeds) {
    const bool aimed = std::isfinite(speed.aim);
    out += "<tr>" + cell(e(speed.what)) + cell(e(digits(speed.value) + " " + speed.unit)) +
           cell("<span class=\"" +
                std::string(!aimed            ? "soft"
                            : speed.reached() ? "good"
                                              : "bad") +
                "\">" + e(aim_text(speed)) + (aimed ? speed.reached() ? " &#10003;" : " missed" : "") + "</span>") +
           cell(std::to_string(speed.count)) + cell(e(speed.bound_by)) + "</tr>\n";
  }
  return out + "</table></div>\n";
}

std::string stiff_cards(const Findings& findings) {
  std::string out;
  std::string kernel;
  for (const StiffGroup& group : stiff_groups(findings)) {
    if (group.kernel != kernel) {
      if (!kernel.empty()) out += "</div>\n";
      kernel = group.kernel;
      out += "<div class=\"card\"><h3>" + e(kernel) + "</h3>\n";
    }
    const auto verdict = std::string("<span class=\"") + (group.failed > 0 ? "bad" : "good") + "\">" +
                         (group.failed > 0 ? std::to_string(group.failed) + " beyond the bound" : "all within") +
                         "</span>";
    out += "<p>" + std::to_string(group.cases.size()) + " cases, " + e(group.measure) + " at most " +
           digits(group.bound) + ": " + verdict + "; worst " + digits(group.worst->worst) + " at " +
           e(group.worst->name + (group.worst->where.empty() ? "" : ", " + group.worst->where)) + "</p>\n";
    out += "<details><summary>the cases</summary><table><tr>" + cell("case", "th") + cell("worst", "th") +
           cell("where", "th") + "</tr>\n";
    for (const StiffCase* one : group.cases)
      out += "<tr>" + cell(e(one->name)) +
             cell("<span class=\"" + std::string(one->passed() ? "" : "bad") + "\">" + digits(one->worst) + "</span>") +
             cell(e(one->where)) + "</tr>\n";
    out += "</table></details>\n";
  }
  return kernel.empty() ? out : out + "</div>\n";
}

}  // namespace

std::string report_page(const Findings& findings, const Run& run) {
  const Machine& m = run.machine;
  const int failed = failed_cases(findings), missed = missed_aims(findings);
  std::string out =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>Lackwerk: error against run time</title>"
      "<style>" +
      std::string(style) + "</style></head><body><main>\n<h1>Error against run time</h1>\n";
  out += "<p class=\"soft\">" + e(m.processor) + ", " + std::to_string(m.cores) + " cores, " + digits(m.memory_gib) +
         " GiB. " + e(m.system) + ". " + e(m.compiler) +
         ". Lackwerk " LACKWERK_VERSION ". Load before: " + tools::fixed(m.load_before, 2) + ".</p>\n";
  if (m.load_before > 0.5)
    out += "<p class=\"bad\">The machine was busy when this began: times are too long, ratios within a row hold.</p>\n";
  if (run.quick) out += "<p class=\"soft\">Quick run: smaller inputs, fewer repetitions.</p>\n";
  for (const std::string& line : run.left_out) out += "<p class=\"bad\">Left out: " + e(line) + "</p>\n";
  out += "<div class=\"tiles\">\n" + tile(std::to_string(findings.knobs.size()), "knobs measured") +
         tile(std::to_string(findings.stiff.size()), "stiff cases, " + std::to_string(failed) + " beyond their bounds",
              failed > 0 ? "bad" : "good") +
         tile(std::to_string(findings.speeds.size()), "speeds, " + std::to_string(missed) + " short of their aims",
              missed > 0 ? "bad" : "good") +
         tile(tools::fixed(run.seconds, 0) + " s", run.quick ? "quick run" : "full run") + "</div>\n";
  out += "<nav>";
  for (const Knob& knob : findings.knobs)
    out += "<a href=\"#" + e(knob.id) + "\">" + e(knob.title) + "</a>: " + e(knob.chosen) + "<br>\n";
  out += "</nav>\n";
  if (!findings.speeds.empty()) out += "<h2>Speeds</h2>\n" + speeds_card(findings);
  if (!findings.knobs.empty()) out += "<h2>Knobs</h2>\n";
  for (const Knob& knob : findings.knobs) out += knob_card(knob);
  if (!findings.stiff.empty())
    out +=
        "<h2>Stiff and extreme cases</h2>\n<p class=\"soft\">Each kernel against a reference of higher precision or "
        "another method. The same cases are unit tests with the same bounds.</p>\n" +
        stiff_cards(findings);
  return out + "</main></body></html>\n";
}

}  // namespace lackwerk::report
