#include <cmath>
#include <nlohmann/json.hpp>

#include "kiosk/tools/report/pages.hpp"
#include "kiosk/tools/report/pareto.hpp"
#include "kiosk/tools/report/summary.hpp"

namespace lackwerk::report {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json timing_json(const Timing& timing) {
  if (timing.count == 0) return nullptr;
  return {{"median", number(timing.median_ms)},
          {"low_quartile", number(timing.low_ms)},
          {"high_quartile", number(timing.high_ms)},
          {"count", timing.count}};
}

Json labels(const Knob& knob, const std::vector<std::size_t>& front) {
  Json out = Json::array();
  for (const std::size_t k : front) out.push_back(knob.settings[k].label);
  return out;
}

Json knob_json(const Knob& knob) {
  Json out{{"id", knob.id},
           {"title", knob.title},
           {"what", knob.what},
           {"error_unit", knob.error_unit},
           {"time_of", knob.time_of},
           {"bytes_of", knob.bytes_of},
           {"default", knob.chosen},
           {"why", knob.why},
           {"pareto_front", labels(knob, pareto_front(knob.settings))},
           {"settings", Json::array()}};
  if (!knob.bytes_of.empty()) out["pareto_front_of_bytes"] = labels(knob, pareto_front_of_bytes(knob.settings));
  for (const Setting& setting : knob.settings)
    out["settings"].push_back({{"label", setting.label},
                               {"value", number(setting.value)},
                               {"line", setting.line},
                               {"time_ms", timing_json(setting.time)},
                               {"error", number(setting.error)},
                               {"error_p95", number(setting.p95)},
                               {"error_worst", number(setting.worst)},
                               {"bytes", number(setting.bytes)},
                               {"eligible", setting.eligible},
                               {"note", setting.note}});
  return out;
}

}  // namespace

std::string report_json(const Findings& findings, const Run& run) {
  const Machine& machine = run.machine;
  Json out{{"lackwerk", LACKWERK_VERSION},
           {"quick", run.quick},
           {"seconds", number(run.seconds)},
           {"machine",
            {{"processor", machine.processor},
             {"cores", machine.cores},
             {"memory_gib", number(machine.memory_gib)},
             {"system", machine.system},
             {"compiler", machine.compiler},
             {"load_before", number(machine.load_before)},
             {"load_after", number(machine.load_after)}}},
           {"left_out", run.left_out},
           {"parts_s", Json::object()},
           {"stiff_failed", failed_cases(findings)},
           {"speeds_missed", missed_aims(findings)},
           {"knobs", Json::array()},
           {"stiff", Json::array()},
           {"speeds", Json::array()}};
  for (const auto& [part, seconds] : run.parts_s) out["parts_s"][part] = number(seconds);
  for (const Knob& knob : findings.knobs) out["knobs"].push_back(knob_json(knob));
  for (const StiffCase& one : findings.stiff)
    out["stiff"].push_back({{"kernel", one.kernel},
                            {"name", one.name},
                            {"measure", one.measure},
                            {"worst", number(one.worst)},
                            {"bound", number(one.bound)},
                            {"passed", one.passed()},
                            {"where", one.where}});
  for (const Speed& speed : findings.speeds)
    out["speeds"].push_back({{"id", speed.id},
                             {"what", speed.what},
                             {"value", number(speed.value)},
                             {"unit", speed.unit},
                             {"aim", number(speed.aim)},
                             {"aim_is", speed.at_least ? "at least" : "at most"},
                             {"reached", speed.reached()},
                             {"count", speed.count},
                             {"bound_by", speed.bound_by}});
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lackwerk::report
