#include "kiosk/tools/scan_info.hpp"

#include "kiosk/tools/output.hpp"

namespace lackwerk::tools {
namespace {

using Json = nlohmann::ordered_json;

struct Field {
  const char* path;
  const char* unit;
  const char* meaning;
};

/// In the order in which they are printed; ranges stand in docs/pack-format.md.
constexpr Field documented[] = {
    {"kind", "", "scans: points that move from one scan to the next"},
    {"id", "", "the pack's name in signatures and stores"},
    {"serial", "", "grows with every release of the same id; a store refuses a lower one"},
    {"name", "", "as shown to visitors"},
    {"time_unit", "", "what the times count, as shown"},
    {"tool_version", "", "the program that wrote it"},
    {"bytes", "bytes", "size of the file"},
    {"low", "units of the scans", "lowest corner of the cube that all places lie in"},
    {"edge", "units of the scans", "of that cube; places are stored in 65535ths of it"},
    {"spacing", "units of the scans", "between neighbouring points"},
    {"up", "axis", "the vertical one: 0 x, 1 y, 2 z"},
    {"scans", "", "one entry per scan, in the order of time"},
    {"scans[].name", "", "of the file it came from"},
    {"scans[].time", "time_unit", "when it was taken"},
    {"scans[].points", "points", "that were kept of it"},
    {"steps", "", "one entry from each scan to the next"},
    {"steps[].paths", "paths", "straight ways of points"},
    {"steps[].matched", "segments", "pairs of parts that belong together"},
    {"steps[].grown", "segments", "parts that are new"},
    {"steps[].decayed", "segments", "parts that are gone"},
    {"fields", "", "this list"},
};

}  // namespace

Json scan_info_json(const packs::ScanPack& pack) {
  const packs::ScanInfo& info = pack.info();
  Json out{{"kind", "scans"},
           {"id", info.id},
           {"serial", info.serial},
           {"name", info.name},
           {"time_unit", info.time_unit},
           {"tool_version", info.tool_version},
           {"bytes", pack.file_bytes()},
           {"low", {info.low.x, info.low.y, info.low.z}},
           {"edge", info.edge},
           {"spacing", info.spacing},
           {"up", info.up},
           {"scans", Json::array()},
           {"steps", Json::array()}};
  for (const packs::ScanState& state : info.states)
    out["scans"].push_back({{"name", state.name}, {"time", state.time}, {"points", state.points}});
  for (const packs::ScanStep& step : pack.steps())
    out["steps"].push_back(
        {{"paths", step.paths.size()}, {"matched", step.matched}, {"grown", step.grown}, {"decayed", step.decayed}});
  Json& fields = out["fields"] = Json::object();
  for (const Field& field : documented) fields[field.path] = {{"unit", field.unit}, {"meaning", field.meaning}};
  return out;
}

std::string scan_info_text(const packs::ScanPack& pack) {
  const packs::ScanInfo& info = pack.info();
  const std::string unit = info.time_unit.empty() ? "" : " " + one_line(info.time_unit);
  std::string out = info.id + " " + std::to_string(info.serial) + ": " + one_line(info.name) + ", " +
                    std::to_string(info.states.size()) + " scans, " +
                    fixed(static_cast<double>(pack.file_bytes()) / 1e6, 2) + " MB, made by " + info.tool_version;
  for (std::size_t k = 0; k < info.states.size(); ++k) {
    const packs::ScanState& state = info.states[k];
    out.append("\n  ").append(fixed(state.time, 2)).append(unit).append(": ").append(one_line(state.name));
    out.append(", ").append(std::to_string(state.points)).append(" points");
    if (k + 1 == info.states.size()) break;
    const packs::ScanStep& step = pack.steps()[k];
    out.append("\n    ").append(std::to_string(step.paths.size())).append(" paths; parts: ");
    out.append(std::to_string(step.matched)).append(" matched, ").append(std::to_string(step.grown));
    out.append(" grown, ").append(std::to_string(step.decayed)).append(" gone");
  }
  return out;
}

}  // namespace lackwerk::tools
