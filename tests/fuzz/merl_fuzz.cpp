// Fuzz target: any bytes as a MERL binary.
//
// Input: the file, of the size that its header says where that is small, else of a size that no header has. Whatever
// comes: no sanitizer finding, every refusal with its field and remedy, and what is taken is a table whose cells are
// holes or finite and not negative, some of them known, and none of them brighter than the brightest node.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>

#include "packs/tools/merl_file.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace lackwerk;
using fuzz::require;

/// A header's numbers where all are small enough for an input; else ones that disagree with it.
core::BrdfTableSize size_for(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint32_t, 2> allowed{2, 12};  // BrdfTable's least; 12 x 2 x 2 cells and more fit 4 KiB
  std::array<std::uint32_t, 3> found{};
  if (bytes.size() < sizeof found) return {4, 3, 5};
  std::memcpy(found.data(), bytes.data(), sizeof found);
  for (const std::uint32_t number : found)
    if (number < allowed[0] || number > allowed[1]) return {4, 3, 5};
  return {found[0], found[1], found[2]};
}

void use(const packs::MerlMaterial& material, const core::BrdfTableSize& size) {
  require(material.table.size() == size);
  require(material.holes < material.nodes && material.nodes <= size.cells());
  constexpr float brightest = 1e9f / 1500.0f * 1.66f * 1.0001f;  // docs of merl_file.hpp, and rounding
  for (std::size_t cell = 0; cell < size.cells(); ++cell) {
    const auto value = material.table.value(cell);
    if (!value) continue;
    for (int channel = 0; channel < 3; ++channel) require((*value)[channel] >= 0.0f && (*value)[channel] <= brightest);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  const core::BrdfTableSize cells = size_for(bytes);
  const auto material = packs::read_merl(bytes, "fuzz.binary", cells);
  if (material)
    use(*material, cells);
  else
    require(material.error().file == "fuzz.binary" && !material.error().what.empty() &&
            !material.error().remedy.empty() && material.error().field.empty() == bytes.empty());
  return 0;
}
