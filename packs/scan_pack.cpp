#include "packs/scan_pack.hpp"

#include <bit>
#include <cmath>
#include <type_traits>
#include <utility>

#include "packs/pack_id.hpp"
#include "packs/paint_pack.hpp"
#include "packs/scan_pack_generated.h"
#include "packs/scene_pack_checks.hpp"
#include "packs/utf8.hpp"

namespace lackwerk::packs {
namespace {

static_assert(std::endian::native == std::endian::little, "spans point straight into little-endian FlatBuffers");
static_assert(sizeof(fb::ScanPath) == sizeof(ScanPath) && std::alignment_of_v<fb::ScanPath> == 2 &&
              std::alignment_of_v<ScanPath> == 2);

constexpr flatbuffers::uoffset_t max_depth = 4, max_tables = 2 * max_scans + 2;
/// Generous bounds that keep a later computation finite.
constexpr double most_place = 1e9, most_time = 1e12;
constexpr const char* remedy = "make the pack again from its scans";

Result<void> check_text(const std::string& text, bool may_be_empty, const std::string& field, const std::string& file) {
  if ((text.empty() && !may_be_empty) || text.size() > max_scan_text_bytes || !is_printable(text))
    return fail(file, field, "must be at most 200 bytes of UTF-8 without control characters", remedy);
  return {};
}

Result<void> check_states(const ScanInfo& info, const std::string& file) {
  if (info.states.size() < 2 || info.states.size() > max_scans)
    return fail(file, "states", std::to_string(info.states.size()) + " scans; 2 to 256 make a series", remedy);
  for (std::size_t k = 0; k < info.states.size(); ++k) {
    const ScanState& state = info.states[k];
    if (auto ok = check_text(state.name, false, item_name("states", k) + ".name", file); !ok) return ok;
    if (!(std::abs(state.time) <= most_time) || (k > 0 && !(state.time > info.states[k - 1].time)))
      return fail(file, item_name("states", k) + ".time", "must be a number and ascend", remedy);
  }
  return {};
}

Result<void> check_steps(const ScanContents& contents, const std::string& file) {
  if (contents.steps.size() + 1 != contents.info.states.size())
    return fail(
        file, "steps",
        std::to_string(contents.steps.size()) + " between " + std::to_string(contents.info.states.size()) + " scans",
        remedy);
  for (std::size_t k = 0; k < contents.steps.size(); ++k) {
    const ScanStep& step = contents.steps[k];
    const std::string field = item_name("steps", k) + ".paths";
    if (step.paths.empty() || step.paths.size() > max_step_paths)
      return fail(file, field, std::to_string(step.paths.size()) + " paths; 1 to 4000000 make a step", remedy);
    for (std::size_t i = 0; i < step.paths.size(); ++i)
      if (step.paths[i].from_normal[3] < 0 || step.paths[i].to_normal[3] < 0)
        return fail(file, field + "[" + std::to_string(i) + "]", "sees less than none of the sky", remedy);
  }
  return {};
}

ScanInfo decode_info(const fb::ScanPack& root) {
  ScanInfo info;
  info.id = root.id()->str();
  info.serial = root.serial();
  info.name = root.name()->str();
  info.time_unit = root.time_unit()->str();
  info.tool_version = root.tool_version()->str();
  if (root.low() != nullptr) info.low = {root.low()->x(), root.low()->y(), root.low()->z()};
  info.edge = root.edge();
  info.spacing = root.spacing();
  info.up = root.up();
  info.states.reserve(root.states()->size());
  for (const fb::ScanState* state : *root.states())
    info.states.push_back({state->name()->str(), state->time(), state->points()});
  return info;
}

Result<ScanContents> decode(std::span<const std::uint8_t> payload, const std::string& file) {
  flatbuffers::Verifier verifier(payload.data(), payload.size(), max_depth, max_tables);
  if (!fb::VerifyScanPackBuffer(verifier)) return fail(file, "payload", "not a well-formed scan pack", remedy);
  const fb::ScanPack& root = *fb::GetScanPack(payload.data());
  if (root.minimum_reader() < 1 || root.minimum_reader() > scan_schema_version)
    return fail(file, "minimum_reader", "needs schema version " + std::to_string(root.minimum_reader()),
                "update this program");
  // Before memory is taken: a small file can name one text a thousand times.
  if (root.states()->size() > max_scans || root.steps()->size() > max_scans)
    return fail(file, "states", "too many", remedy);
  for (const flatbuffers::String* text : {root.id(), root.name(), root.time_unit(), root.tool_version()})
    if (text->size() > max_scan_text_bytes) return fail(file, "name", "a text is longer than 200 bytes", remedy);
  for (const fb::ScanState* state : *root.states())
    if (state->name()->size() > max_scan_text_bytes)
      return fail(file, "states", "a name is longer than 200 bytes", remedy);
  ScanContents out{decode_info(root), {}};
  out.steps.reserve(root.steps()->size());
  for (const fb::ScanStep* step : *root.steps())
    out.steps.push_back({{reinterpret_cast<const ScanPath*>(step->paths()->Data()), step->paths()->size()},
                         step->matched(),
                         step->grown(),
                         step->decayed()});
  return out;
}

}  // namespace

Result<void> check_scan(const ScanContents& contents, const std::string& file) {
  const ScanInfo& info = contents.info;
  if (!is_pack_id(info.id))
    return fail(file, "id", "must be 1 to 64 letters, digits, dots, dashes or underscores, not a mark first",
                "choose another id");
  if (auto ok = check_text(info.name, false, "name", file); !ok) return ok;
  if (auto ok = check_text(info.time_unit, true, "time_unit", file); !ok) return ok;
  if (auto ok = check_text(info.tool_version, true, "tool_version", file); !ok) return ok;
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(info.low[c]) <= most_place)) return fail(file, "low", "is no place", remedy);
  if (!(info.edge > 0.0 && info.edge <= most_place)) return fail(file, "edge", "must be above 0", remedy);
  if (!(info.spacing >= 0.0 && info.spacing <= info.edge))
    return fail(file, "spacing", "must lie between 0 and the edge", remedy);
  if (info.up < 0 || info.up > 2) return fail(file, "up", "must be 0, 1 or 2", remedy);
  if (auto ok = check_states(info, file); !ok) return ok;
  return check_steps(contents, file);
}

Result<ScanPack> ScanPack::from_file(Result<SealedFile> file, const std::string& name) {
  if (!file) return tl::unexpected(file.error());
  auto contents = decode(file->payload(), name);
  if (!contents) return tl::unexpected(contents.error());
  if (auto checked = check_scan(*contents, name); !checked) return tl::unexpected(checked.error());
  return ScanPack(std::move(*file), std::move(*contents));
}

Result<ScanPack> ScanPack::open(const std::filesystem::path& path, Backing backing) {
  return from_file(SealedFile::open(path, SealedKind::scan, backing), path.string());
}

Result<ScanPack> ScanPack::from_bytes(std::vector<std::uint8_t> bytes, const std::string& file) {
  return from_file(SealedFile::from_bytes(std::move(bytes), SealedKind::scan, file), file);
}

std::vector<std::uint8_t> encode_scan_pack(const ScanContents& contents) {
  flatbuffers::FlatBufferBuilder out(1 << 20);
  const ScanInfo& info = contents.info;
  std::vector<flatbuffers::Offset<fb::ScanState>> states;
  states.reserve(info.states.size());
  for (const ScanState& state : info.states)
    states.push_back(fb::CreateScanState(out, out.CreateString(state.name), state.time, state.points));
  std::vector<flatbuffers::Offset<fb::ScanStep>> steps;
  steps.reserve(contents.steps.size());
  for (const ScanStep& step : contents.steps) {
    const auto paths =
        out.CreateVectorOfStructs(reinterpret_cast<const fb::ScanPath*>(step.paths.data()), step.paths.size());
    steps.push_back(fb::CreateScanStep(out, paths, step.matched, step.grown, step.decayed));
  }
  const auto tool = out.CreateString(pack_tool_version.data(), pack_tool_version.size());
  const auto id = out.CreateString(info.id);
  const auto name = out.CreateString(info.name);
  const auto unit = out.CreateString(info.time_unit);
  const fb::ScanPoint low(info.low.x, info.low.y, info.low.z);
  const auto state_vector = out.CreateVector(states);
  const auto step_vector = out.CreateVector(steps);
  fb::FinishScanPackBuffer(
      out, fb::CreateScanPack(out, scan_schema_version, scan_schema_version, tool, id, info.serial, name, unit, &low,
                              info.edge, info.spacing, static_cast<std::uint8_t>(info.up), state_vector, step_vector));
  return {out.GetBufferPointer(), out.GetBufferPointer() + out.GetSize()};
}

Result<void> write_scan_pack(const std::filesystem::path& path, const ScanContents& contents) {
  if (auto checked = check_scan(contents, path.string()); !checked) return checked;
  return write_sealed_file(path, SealedKind::scan, encode_scan_pack(contents));
}

}  // namespace lackwerk::packs
