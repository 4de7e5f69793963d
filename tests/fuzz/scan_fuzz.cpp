// Fuzz target: any bytes as a scan pack.
//
// Input: a byte that says what the rest is. 0: a whole file. 1: a payload, sealed properly. Else: changes (three bytes
// of place, one of value) of the payload of a sound pack, sealed properly. Whatever comes: no sanitizer finding, every
// refusal with its field, and a pack that is taken has times that ascend and a step of paths between any two scans.
#include <cmath>
#include <cstddef>
#include <vector>

#include "packs/scan_pack.hpp"
#include "tests/fuzz/sealed.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace lackwerk;
using fuzz::require;

std::vector<std::uint8_t> sound_payload() {
  std::vector<packs::ScanPath> paths;
  for (std::uint16_t k = 0; k < 40; ++k) {
    const auto step = static_cast<std::uint16_t>(1600 * k);
    paths.push_back({{step, 7, 65535, 65535}, {7, step, 0, 0}, {127, 0, 0, 127}, {0, -127, 0, 3}});
  }
  packs::ScanContents contents;
  contents.info.id = "plant";
  contents.info.serial = 3;
  contents.info.name = "Plant";
  contents.info.time_unit = "days";
  contents.info.states = {{"a.xyz", 5.0, 40}, {"b.xyz", 6.0, 45}, {"c.ply", 8.5, 50}};
  contents.steps = {{paths, 4, 1, 0}, {std::span(paths).first(20), 5, 0, 2}};
  require(packs::check_scan(contents, "sample").has_value());
  return packs::encode_scan_pack(contents);
}

void look(const Result<packs::ScanPack>& pack) {
  if (!pack) {
    require(pack.error().file == "fuzz.lwp" && !pack.error().field.empty() && !pack.error().what.empty());
    return;
  }
  const packs::ScanInfo& info = pack->info();
  require(info.states.size() >= 2 && info.states.size() <= packs::max_scans);
  require(pack->steps().size() + 1 == info.states.size());
  require(info.edge > 0.0 && std::isfinite(info.edge) && info.up >= 0 && info.up <= 2);
  for (std::size_t k = 0; k + 1 < info.states.size(); ++k)
    require(info.states[k].time < info.states[k + 1].time && !pack->steps()[k].paths.empty());
  // Each byte of the paths is read, as the renderer does.
  std::uint64_t sum = 0;
  for (const packs::ScanStep& step : pack->steps())
    for (const packs::ScanPath& path : step.paths) sum += path.from[0] + path.to[3] + path.from_normal[3];
  require(sum < ~std::uint64_t{0});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes input({data, size});
  const std::uint8_t kind = input.byte();
  if (kind == 0) {
    look(packs::ScanPack::from_bytes({input.rest().begin(), input.rest().end()}, "fuzz.lwp"));
    return 0;
  }
  std::vector<std::uint8_t> payload;
  if (kind == 1) {
    payload.assign(input.rest().begin(), input.rest().end());
    if (payload.empty()) return 0;
  } else {
    static const std::vector<std::uint8_t> sound = sound_payload();
    payload = sound;
    while (!input.empty()) {
      const std::size_t place = input.place() % payload.size();
      payload[place] = input.byte();
    }
  }
  look(packs::ScanPack::from_bytes(fuzz::sealed(packs::SealedKind::scan, payload), "fuzz.lwp"));
  return 0;
}
