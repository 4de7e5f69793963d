// Fuzz target: any bytes as a paint pack.
//
// Input: a byte that says what the rest is. 0: a whole file. 1: a payload, which gets the header and the BLAKE2b-256 it
// needs, so that FlatBuffers and meaning are reached. Else: changes (three bytes of place, one of value) of the payload
// of a sound pack. Whatever comes: no sanitizer finding, every refusal with its field, and a pack that is taken can be
// mixed (corners in order, means finite) and written again as it was.
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/realise.hpp"
#include "packs/paint_pack.hpp"
#include "packs/paint_pack_checks.hpp"
#include "packs/paint_pack_codec.hpp"
#include "tests/fuzz/sealed.hpp"
#include "tests/fuzz/support.hpp"
#include "tests/unit/pack_samples.hpp"

namespace {

using namespace lackwerk;
using fuzz::require;

std::vector<std::uint8_t> changed_sample(fuzz::Bytes changes) {
  static const std::vector<std::uint8_t> sample = packs::encode_paint_pack(testing::SamplePack().contents);
  std::vector<std::uint8_t> payload = sample;
  while (!changes.empty()) {
    const std::size_t place = changes.place() % payload.size();
    payload[place] = changes.byte();
  }
  return payload;
}

void mix(const core::InterpolatablePaint& paint, const std::vector<double>& numbers) {
  const core::Weights weights = core::Weights::uniform(numbers);
  require(core::check_weights(paint, weights).has_value());
  core::RealisedPaint out;
  core::realise(paint, weights, out);
  for (const core::QuantisedCuboid& c : out.corners) require(c.q[0] <= c.q[1] && c.q[2] <= c.q[3] && c.q[4] <= c.q[5]);
  for (const glm::vec3& mean : out.flake_mean)
    for (int c = 0; c < 3; ++c) require(std::isfinite(mean[c]) && mean[c] >= 0.0f);
  for (const core::Lobe& lobe : out.analytic.lobes) require(lobe.m >= core::min_roughness && std::isfinite(lobe.m));
}

void use(const packs::PaintPack& pack) {
  const core::InterpolatablePaint& paint = pack.paint();
  const std::size_t count = paint.paints.size();
  require(count >= 1 && count <= core::max_paints && pack.info().errors.size() == count);
  std::vector<double> one(count, 0.0);
  one[count - 1] = 1.0;
  mix(paint, one);
  mix(paint, std::vector<double>(count, 1.0 / static_cast<double>(count)));
  if (count > 1) {
    one[count - 1] = 1.5;
    one[0] = -0.5;
    mix(paint, one);
  }
  std::uint64_t bytes = 0;
  for (std::size_t k = 0; k < count; ++k) bytes += packs::paint_bytes(paint, k);
  require(bytes <= pack.file_bytes() * count);
  // Written again it is taken again, and says the same. (Not the same bytes: FlatBuffers has many for one meaning.)
  const packs::PackContents contents{pack.info(), paint};
  auto again =
      packs::PaintPack::from_bytes(fuzz::sealed(packs::SealedKind::paint, packs::encode_paint_pack(contents)), "again");
  require(again.has_value() && again->info() == pack.info());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes input({data, size});
  const std::uint8_t kind = input.byte();
  std::vector<std::uint8_t> file;
  if (kind == 0)
    file.assign(input.rest().begin(), input.rest().end());
  else if (kind == 1)
    file = fuzz::sealed(packs::SealedKind::paint, input.rest());
  else
    file = fuzz::sealed(packs::SealedKind::paint, changed_sample(input));
  const auto pack = packs::PaintPack::from_bytes(std::move(file), "fuzz.lwp");
  if (pack)
    use(*pack);
  else
    require(pack.error().file == "fuzz.lwp" && !pack.error().field.empty() && !pack.error().what.empty());
  return 0;
}
