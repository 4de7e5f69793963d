#include "packs/tools/merl_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>
#include <optional>

#include "packs/tools/whole_file.hpp"

namespace lackwerk::packs {

using std::numbers::pi;

namespace {

constexpr std::array<double, 3> scales{1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
constexpr std::array<const char*, 3> planes{"red", "green", "blue"};
constexpr std::array<const char*, 3> axes{"theta_h", "theta_d", "phi_d"};
constexpr std::size_t header_bytes = 3 * sizeof(std::int32_t);
/// Of the stored numbers. A mirror that spreads over MERL's first cell (0.011 degrees) would have 1.6e10; real ones,
/// and their instrument's resolution, stay below 1e7.
constexpr double highest = 1e9;
constexpr const char* again = "copy or download the file again";

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie in the file");

template <class T>
T number_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  T out;
  std::memcpy(&out, bytes.data() + at, sizeof out);
  return out;
}

Result<void> check_header(std::span<const std::uint8_t> bytes, const std::string& file,
                          const core::BrdfTableSize& size) {
  if (bytes.empty()) return fail(file, "", "is empty", again);
  if (bytes.size() < header_bytes) return fail(file, "dimensions", "the file ends inside its header", again);
  const std::array<std::uint32_t, 3> expected{size.theta_h, size.theta_d, size.phi_d};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found = number_at<std::int32_t>(bytes, k * sizeof(std::int32_t));
    if (found == static_cast<std::int64_t>(expected[k])) continue;
    return fail(file, "dimensions",
                "has " + std::to_string(found) + " " + axes[k] + ", not " + std::to_string(expected[k]),
                "give an isotropic MERL binary of 90 x 90 x 180 values");
  }
  const std::size_t whole = header_bytes + 3 * size.cells() * sizeof(double);
  if (bytes.size() == whole) return {};
  return fail(file, bytes.size() < whole ? "values" : "end",
              "the file has " + std::to_string(bytes.size()) + " bytes, not " + std::to_string(whole), again);
}

/// Values at the nodes, 1/sr; NaN in red where the file has a hole.
class Nodes {
 public:
  Nodes(std::span<const std::uint8_t> bytes, const core::BrdfTableSize& size) : bytes_(bytes), size_(size) {}

  [[nodiscard]] double stored(std::size_t node, std::size_t channel) const {
    return number_at<double>(bytes_, header_bytes + (channel * size_.cells() + node) * sizeof(double));
  }
  [[nodiscard]] std::optional<glm::dvec3> value(std::size_t node) const {
    const glm::dvec3 raw(stored(node, 0), stored(node, 1), stored(node, 2));
    if (raw.x < 0.0 || raw.y < 0.0 || raw.z < 0.0) return std::nullopt;
    return raw * glm::dvec3(scales[0], scales[1], scales[2]);
  }

 private:
  std::span<const std::uint8_t> bytes_;
  core::BrdfTableSize size_;
};

/// Which nodes hold a value and mean something.
struct Use {
  std::vector<std::uint8_t> known;
  std::vector<std::uint8_t> above;
};

}  // namespace

core::HalfAngles merl_node(std::size_t node, const core::BrdfTableSize& size) {
  const std::size_t k = node % size.phi_d, j = node / size.phi_d % size.theta_d, i = node / size.phi_d / size.theta_d;
  const double root = static_cast<double>(i) / size.theta_h;
  return {root * root * pi / 2.0, static_cast<double>(j) / size.theta_d * pi / 2.0,
          static_cast<double>(k) / size.phi_d * pi};
}

Result<MerlMaterial> read_merl(std::span<const std::uint8_t> bytes, const std::string& file,
                               const core::BrdfTableSize& size) {
  if (auto ok = check_header(bytes, file, size); !ok) return tl::unexpected(ok.error());
  const Nodes nodes(bytes, size);
  MerlMaterial out{core::BrdfTable(size)};
  Use use{std::vector<std::uint8_t>(size.cells()), std::vector<std::uint8_t>(size.cells())};
  for (std::size_t node = 0; node < size.cells(); ++node) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double stored = nodes.stored(node, channel);
      if (std::abs(stored) <= highest) continue;  // false for NaN, too
      return fail(file, std::string(planes[channel]) + " plane, value " + std::to_string(node),
                  std::isfinite(stored) ? "is beyond 1e9" : "is not a finite number", again);
    }
    if (!core::is_above(core::directions(merl_node(node, size)))) continue;
    use.above[node] = 1;
    use.known[node] = nodes.value(node) ? 1 : 0;
    ++out.nodes;
    out.holes += use.known[node] == 0 ? 1u : 0u;
  }
  if (out.holes == out.nodes) return fail(file, "values", "holds nothing but holes", again);
  for (std::size_t cell = 0; cell < size.cells(); ++cell) {
    if (!core::is_above(core::directions(out.table.middle(cell)))) continue;
    const std::size_t k = cell % size.phi_d, j = cell / size.phi_d % size.theta_d, i = cell / size.phi_d / size.theta_d;
    glm::dvec3 sum(0.0);
    int known = 0, above = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      // The last middles have no node beyond; phi_d wraps (180 degrees exchange light and eye).
      const std::size_t ci = i + (corner & 1u), cj = j + (corner >> 1 & 1u), ck = (k + (corner >> 2)) % size.phi_d;
      if (ci >= size.theta_h || cj >= size.theta_d) continue;
      const std::size_t node = (ci * size.theta_d + cj) * size.phi_d + ck;
      above += use.above[node];
      if (use.known[node] == 0) continue;
      sum += *nodes.value(node);  // a middle is as far from all eight
      ++known;
    }
    if (known > 0 && 2 * known >= above) out.table.set(cell, glm::vec3(sum / static_cast<double>(known)));
  }
  return out;
}

Result<MerlMaterial> read_merl(const std::filesystem::path& path) {
  // One byte more than a MERL file: a longer one is answered with its size.
  const auto bytes = read_whole_file(path, header_bytes + 3 * core::BrdfTableSize{}.cells() * sizeof(double) + 1);
  if (!bytes) return tl::unexpected(bytes.error());
  return read_merl(*bytes, path.string());
}

std::vector<std::uint8_t> merl_bytes(const core::Brdf& brdf, const core::BrdfTableSize& size) {
  std::vector<std::uint8_t> out(header_bytes + 3 * size.cells() * sizeof(double));
  const std::array<std::int32_t, 3> header{static_cast<std::int32_t>(size.theta_h),
                                           static_cast<std::int32_t>(size.theta_d),
                                           static_cast<std::int32_t>(size.phi_d)};
  std::memcpy(out.data(), header.data(), header_bytes);
  for (std::size_t node = 0; node < size.cells(); ++node) {
    const core::DirectionPair pair = core::directions(merl_node(node, size));
    glm::dvec3 value(-1.0);
    if (core::is_above(pair)) value = brdf(pair.in, pair.out);
    const bool is_hole =
        !(value.x >= 0.0 && value.y >= 0.0 && value.z >= 0.0) || !std::isfinite(value.x + value.y + value.z);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double stored = is_hole ? -1.0 : value[static_cast<int>(channel)] / scales[channel];
      std::memcpy(&out[header_bytes + (channel * size.cells() + node) * sizeof stored], &stored, sizeof stored);
    }
  }
  return out;
}

Result<void> write_merl(const core::Brdf& brdf, const std::filesystem::path& path) {
  const auto bytes = merl_bytes(brdf);
  std::ofstream stream(path, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) return fail(path.string(), "", "cannot be written", "check the folder and free space");
  return {};
}

}  // namespace lackwerk::packs
