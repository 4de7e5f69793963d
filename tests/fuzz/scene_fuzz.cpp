// Fuzz target: any bytes as a scene pack.
//
// Input: a byte that says what the rest is. 0: a whole file. 1: a payload. Else: changes (three bytes of place, one of
// value) of the payload of a sound scene, whose atlas of 2.7 MB is left out of the places: any byte is a colour there.
// Whatever comes: no sanitizer finding, every refusal with its field, and a scene that is taken has one normal a
// vertex, indices inside, and no more of anything than is allowed.
#include <algorithm>
#include <cstddef>
#include <vector>

#include "packs/scene_pack.hpp"
#include "tests/fuzz/support.hpp"
#include "tests/unit/pack_samples.hpp"

namespace {

using namespace lackwerk;
using fuzz::require;

constexpr std::size_t atlas_bytes = std::size_t{core::environment_width} * core::environment_height * 4;

/// A sound payload that is changed in place and put right again: copying 2.7 MB for each input would take most of the
/// time.
class Sample {
 public:
  Sample() {
    packs::Scene scene = testing::sample_scene();
    for (packs::MeshPart& part : scene.parts) {
      part.visibility.assign(part.positions_mm.size(), packs::open_visibility);
      part.irradiance.assign(part.positions_mm.size(), packs::Irradiance{1, 2, 3});
    }
    std::fill(scene.environment.atlas.begin(), scene.environment.atlas.end(), atlas_byte);
    payload_ = packs::encode_scene_pack(scene);
    const std::vector<std::uint8_t> stretch(4096, atlas_byte);
    atlas_begin_ = static_cast<std::size_t>(
        std::search(payload_.begin(), payload_.end(), stretch.begin(), stretch.end()) - payload_.begin());
    require(packs::decode_scene_pack(payload_, "sample").has_value());
  }
  void change(fuzz::Bytes changes) {
    const std::size_t places = payload_.size() - atlas_bytes;
    while (!changes.empty()) {
      std::size_t place = changes.place() % places;
      if (place >= atlas_begin_) place += atlas_bytes;
      before_.push_back({place, payload_[place]});
      payload_[place] = changes.byte();
    }
  }
  void restore() {
    for (std::size_t k = before_.size(); k-- > 0;) payload_[before_[k].place] = before_[k].value;
    before_.clear();
  }
  [[nodiscard]] const std::vector<std::uint8_t>& payload() const { return payload_; }

 private:
  static constexpr std::uint8_t atlas_byte = 0xA7;
  struct Change {
    std::size_t place;
    std::uint8_t value;
  };
  std::vector<std::uint8_t> payload_;
  std::size_t atlas_begin_ = 0;
  std::vector<Change> before_;
};

void look(const Result<packs::Scene>& scene) {
  if (!scene) {
    require(scene.error().file == "fuzz.lws" && !scene.error().field.empty() && !scene.error().what.empty());
    return;
  }
  require(!scene->parts.empty() && scene->parts.size() <= packs::max_scene_parts &&
          scene->cameras.size() <= packs::max_scene_cameras && scene->environment.atlas.size() == atlas_bytes &&
          scene->environment.lights.size() == core::environment_light_count && scene->irradiance_range > 0.0f);
  for (const packs::MeshPart& part : scene->parts) {
    const std::size_t vertices = part.positions_mm.size();
    require(vertices <= packs::max_part_vertices && part.normals.size() == vertices && part.indices.size() % 3 == 0);
    require(part.visibility.empty() || part.visibility.size() == vertices);
    require(part.irradiance.empty() || part.irradiance.size() == vertices);
    require(static_cast<std::uint8_t>(part.kind) < packs::surface_kind_count);
    for (const std::uint32_t index : part.indices) require(index < vertices);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes input({data, size});
  const std::uint8_t kind = input.byte();
  const std::vector<std::uint8_t> rest(input.rest().begin(), input.rest().end());
  if (kind == 0) {
    const auto file = packs::SealedFile::from_bytes(rest, packs::SealedKind::scene, "fuzz.lws");
    if (file) look(packs::decode_scene_pack(file->payload(), "fuzz.lws"));
  } else if (kind == 1) {
    look(packs::decode_scene_pack(rest, "fuzz.lws"));
  } else {
    static Sample sample;
    sample.change(input);
    look(packs::decode_scene_pack(sample.payload(), "fuzz.lws"));
    sample.restore();
  }
  return 0;
}
