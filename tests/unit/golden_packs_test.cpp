// Packs written by earlier versions of this program, and what they say.
//
// Each file of tests/packs was written once, by the code of its schema version, and stays. Beside it lies what it
// means, in words and numbers: a field that is read into another place, in another unit or by another formula changes a
// line. There is nothing here that writes those texts: whoever must change one has broken every pack there is.
#include <gtest/gtest.h>

#include <cinttypes>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/realise.hpp"
#include "packs/paint_pack.hpp"
#include "packs/scene_pack.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::packs {
namespace {

const std::filesystem::path folder = std::filesystem::path(LACKWERK_SOURCE_DIR) / "tests/packs";

/// Lines "name = value value ...".
class Text {
 public:
  void line(const std::string& name, const std::string& value) { text_ += name + " = " + value + "\n"; }
  void integer(const std::string& name, std::uint64_t value) { line(name, std::to_string(value)); }
  template <class Numbers>
  void integers(const std::string& name, const Numbers& values) {
    std::string all;
    for (const auto& value : values) all += (all.empty() ? "" : " ") + std::to_string(value);
    line(name, all);
  }
  /// Every digit that distinguishes a double.
  void exact(const std::string& name, std::initializer_list<double> values) { numbers(name, 17, values); }
  /// Of what is computed: the last digits are the mathematical library's.
  void rounded(const std::string& name, std::initializer_list<double> values) { numbers(name, 5, values); }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void numbers(const std::string& name, int digits, std::initializer_list<double> values) {
    std::string all;
    for (const double value : values) {
      std::array<char, 40> number{};
      std::snprintf(number.data(), number.size(), "%.*g", digits, value);
      all += (all.empty() ? "" : " ") + std::string(number.data());
    }
    line(name, all);
  }
  std::string text_;
};

std::string at(const char* name, std::size_t index) { return std::string(name) + "[" + std::to_string(index) + "]"; }

std::string origin_name(core::Provenance origin) {
  switch (origin) {
    case core::Provenance::measured:
      return "measured";
    case core::Provenance::published_fit:
      return "published-fit";
    case core::Provenance::simulated:
      return "simulated";
  }
  return "?";
}

std::string life_name(core::LifeOrigin origin) {
  switch (origin) {
    case core::LifeOrigin::assumed:
      return "assumed";
    case core::LifeOrigin::slices:
      return "slices";
    case core::LifeOrigin::fine:
      return "fine";
  }
  return "?";
}

template <class V>
void vector_line(Text& out, const std::string& name, const V& v) {
  out.exact(name, {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)});
}

void describe_paint(Text& out, const std::string& name, const core::InterpolatablePaint::PaintPart& part,
                    const PaintError& error, std::uint32_t schema_version) {
  out.line(name + ".name", part.identity.name);
  out.line(name + ".source", part.identity.source);
  out.line(name + ".lobes_origin", origin_name(part.identity.lobes));
  out.line(name + ".flakes_origin", origin_name(part.identity.flakes));
  out.line(name + ".coat_origin", origin_name(part.identity.coat));
  vector_line(out, name + ".diffuse", part.analytic.diffuse);
  for (std::size_t k = 0; k < core::max_lobes; ++k) {
    const core::Lobe& lobe = part.analytic.lobes[k];
    vector_line(out, name + "." + at("lobes", k) + ".s", lobe.s);
    out.exact(name + "." + at("lobes", k) + ".m", {lobe.m});
    out.exact(name + "." + at("lobes", k) + ".f0", {lobe.f0});
  }
  out.exact(name + ".coat_ior", {part.analytic.coat_ior});
  out.exact(name + ".refraction_ior", {part.analytic.refraction_ior});
  if (part.analytic.table) {
    const core::ColourTable& table = *part.analytic.table;
    for (std::size_t i = 0; i < table.num_theta; ++i)
      for (std::size_t h = 0; h < table.num_theta; ++h)
        vector_line(out, name + ".chi at bin_i " + std::to_string(i) + ", bin_h " + std::to_string(h),
                    table.linear[i * table.num_theta + h]);
  }
  out.integers(name + ".cluster_begin", part.cluster_begin);
  for (std::size_t k = 0; k < part.clusters.size(); ++k) {
    const auto& q = part.clusters[k].q;
    out.line(name + "." + at("clusters", k), "L " + std::to_string(q[0]) + " to " + std::to_string(q[1]) + ", a " +
                                                 std::to_string(q[2]) + " to " + std::to_string(q[3]) + ", b " +
                                                 std::to_string(q[4]) + " to " + std::to_string(q[5]));
  }
  out.integers(name + ".tuple_cluster", part.tuple_cluster);
  out.exact(name + ".error.flake_w1_mean_lab", {error.flake_w1_mean});
  out.exact(name + ".error.flake_w1_max_lab", {error.flake_w1_max});
  for (std::size_t k = 0; k < error.flake_w1_slice.size(); ++k)
    out.exact(name + ".error." + at("flake_w1_slice_lab", k), {error.flake_w1_slice[k]});
  if (schema_version >= 4) {
    out.line(name + ".error.form", form_name(error.form.form));
    out.line(name + ".error.form.judged_by", judge_name(error.form.judged_by));
    out.integer(name + ".error.form.count", error.form.count);
    out.exact(name + ".error.form.e2000_mean_p95_max",
              {error.form.e2000_mean, error.form.e2000_p95, error.form.e2000_max});
  } else {
    EXPECT_EQ(error.form, FormError{}) << "older packs say nothing of it";
  }
  out.exact(name + ".life.cell_h_deg", {part.life.cell_h_deg});
  out.exact(name + ".life.cell_i_deg", {part.life.cell_i_deg});
  out.line(name + ".life.origin", life_name(part.life.origin));
}

/// What comes out of it: numbers that change where a field keeps its place and loses its meaning.
void describe_mix(Text& out, const core::InterpolatablePaint& paint, const std::string& name,
                  const std::vector<double>& weights) {
  core::RealisedPaint mix;
  core::realise(paint, core::Weights::uniform(weights), mix);
  out.rounded(name + ".diffuse", {mix.analytic.diffuse.x, mix.analytic.diffuse.y, mix.analytic.diffuse.z});
  for (const core::Lobe& lobe : mix.analytic.lobes)
    out.rounded(name + ".lobe", {lobe.s.x, lobe.s.y, lobe.s.z, lobe.m, lobe.f0});
  for (std::size_t k = 0; k < mix.flake_mean.size(); ++k)
    out.rounded(name + "." + at("flake_mean", k), {mix.flake_mean[k].x, mix.flake_mean[k].y, mix.flake_mean[k].z});
  for (std::size_t row = 0; row < static_cast<std::size_t>(paint.row_count()); ++row)
    out.integers(name + "." + at("first_corner_of_row", row), mix.corners[row * static_cast<std::size_t>(mix.width)].q);
}

std::string describe(const PaintPack& pack) {
  const core::InterpolatablePaint& paint = pack.paint();
  const PackInfo& info = pack.info();
  Text out;
  out.line("id", info.id);
  out.integer("serial", info.serial);
  out.line("tool_version", info.tool_version);
  out.integer("schema_version", info.schema_version);
  out.integer("minimum_reader", info.minimum_reader);
  out.exact("transport_cost_lab", {info.transport_cost});
  out.exact("beyond_limit", {info.beyond_limit});
  out.integer("num_theta", paint.layout.num_theta);
  out.integers("layout", paint.layout.lut);
  out.integer("level_count", paint.level_count);
  out.exact("texel_mm", {paint.texel_mm});
  out.integer("level0_texels", paint.level0_texels);
  vector_line(out, "range_lo_lab", paint.range.lo);
  vector_line(out, "range_hi_lab", paint.range.hi);
  out.integers("tuple_begin", paint.tuple_begin);
  out.integers("mass", paint.mass);
  out.integer("row_mass", paint.row_mass);
  out.integer("random_seed", paint.random_seed);
  for (std::size_t k = 0; k < paint.paints.size(); ++k)
    describe_paint(out, at("paints", k), paint.paints[k], info.errors[k], info.schema_version);
  const auto cells = paint.flake_cells_per_bin();
  out.rounded("flake_cells_per_bin", {cells[0], cells[1]});
  describe_mix(out, paint, "alone", {0.0, 1.0});
  describe_mix(out, paint, "mixed", {0.25, 0.75});
  return out.text();
}

std::string kind_name(SurfaceKind kind) {
  constexpr std::array<const char*, surface_kind_count> names{"paint", "glass",      "chrome",   "rubber",   "trim",
                                                              "rim",   "lamp_clear", "lamp_red", "interior", "floor"};
  return names.at(static_cast<std::size_t>(kind));
}

void describe_part(Text& out, const std::string& name, const MeshPart& part) {
  out.line(name + ".name", part.name);
  out.line(name + ".kind", kind_name(part.kind));
  out.line(name + ".detail", std::string((part.detail & detail_full) != 0 ? "full " : "") +
                                 ((part.detail & detail_coarse) != 0 ? "coarse" : ""));
  for (std::size_t v = 0; v < part.positions_mm.size(); ++v) {
    vector_line(out, name + "." + at("positions_mm", v), part.positions_mm[v]);
    const glm::vec3& n = part.normals[v];
    // Stored as 16-bit integers.
    out.rounded(name + "." + at("normals", v), {std::round(1e4 * n.x), std::round(1e4 * n.y), std::round(1e4 * n.z)});
    if (!part.visibility.empty()) out.integers(name + "." + at("visibility", v), part.visibility[v]);
    if (!part.irradiance.empty()) out.integers(name + "." + at("irradiance", v), part.irradiance[v]);
  }
  out.integers(name + ".indices", part.indices);
}

/// FNV-1a: the whole atlas in one line.
std::string fingerprint(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 1099511628211ull;
  std::array<char, 20> text{};
  std::snprintf(text.data(), text.size(), "%016" PRIx64, hash);
  return text.data();
}

std::string describe(const Scene& scene) {
  Text out;
  out.line("name", scene.name);
  for (std::size_t k = 0; k < scene.parts.size(); ++k) describe_part(out, at("parts", k), scene.parts[k]);
  for (std::size_t k = 0; k < scene.cameras.size(); ++k) {
    const Camera& camera = scene.cameras[k];
    out.line(at("cameras", k) + ".name", camera.name);
    vector_line(out, at("cameras", k) + ".eye_mm", camera.eye_mm);
    vector_line(out, at("cameras", k) + ".target_mm", camera.target_mm);
    out.exact(at("cameras", k) + ".vertical_fov_deg", {camera.vertical_fov_deg});
  }
  const core::Environment& environment = scene.environment;
  out.line("environment.name", environment.name);
  vector_line(out, "environment.centre_mm", environment.centre_mm);
  out.exact("environment.room_radius_mm", {environment.room_radius_mm});
  out.exact("environment.range", {environment.range});
  out.line("environment.atlas", fingerprint(environment.atlas));
  for (const int row : {1, 300, 700}) {
    const auto light = core::decode_radiance(core::filtered_texel(environment, 10.5, row + 0.5), environment.range);
    out.rounded("environment.radiance in row " + std::to_string(row), {light.x, light.y, light.z});
  }
  for (std::size_t k = 0; k < environment.lights.size(); k += 21) {
    vector_line(out, "environment." + at("lights", k) + ".direction", environment.lights[k].direction);
    vector_line(out, "environment." + at("lights", k) + ".radiance", environment.lights[k].radiance);
  }
  out.exact("irradiance_range", {scene.irradiance_range});
  return out.text();
}

/// Scenes hold an atlas of 2.7 MB, here of one colour a row: they are kept as runs, each a count (four bytes,
/// little-endian) and the four bytes that come so many times.
std::vector<char> unrolled(const std::filesystem::path& path) {
  const std::vector<char> runs = testing::read_bytes(path);
  std::vector<char> out;
  for (std::size_t k = 0; k + 8 <= runs.size(); k += 8) {
    std::uint32_t count = 0;
    std::memcpy(&count, runs.data() + k, sizeof count);
    for (std::uint32_t n = 0; n < count && out.size() < (4u << 20u); ++n)
      out.insert(out.end(), runs.begin() + static_cast<std::ptrdiff_t>(k) + 4,
                 runs.begin() + static_cast<std::ptrdiff_t>(k) + 8);
  }
  return out;
}

/// Line by line, so that a difference says which field it is.
void expect_text(const std::string& found, const std::string& name) {
  std::ifstream file(folder / (name + ".txt"));
  ASSERT_TRUE(file) << "tests/packs/" << name << ".txt is missing; what was read:\n" << found;
  std::istringstream now(found);
  std::string was, is;
  int lines = 0;
  for (; std::getline(file, was); ++lines) {
    ASSERT_TRUE(std::getline(now, is)) << name << " does not say any more: " << was;
    EXPECT_EQ(is, was) << name << ": a field changed its meaning";
  }
  EXPECT_FALSE(std::getline(now, is)) << name << " says more than it did: " << is;
  EXPECT_GT(lines, 20);
  std::printf("  %s: %d lines as they were\n", name.c_str(), lines);
}

class GoldenPack : public ::testing::TestWithParam<int> {};

TEST_P(GoldenPack, MeansWhatItMeant) {
  const std::string name = "paint_v" + std::to_string(GetParam());
  const auto pack = PaintPack::open(folder / (name + ".lwp"));
  ASSERT_TRUE(pack) << pack.error().line();
  EXPECT_EQ(pack->info().schema_version, static_cast<std::uint32_t>(GetParam()));
  expect_text(describe(*pack), name);
}

INSTANTIATE_TEST_SUITE_P(Schema, GoldenPack, ::testing::Range(1, static_cast<int>(paint_schema_version) + 1));

class GoldenScene : public ::testing::TestWithParam<int> {};

TEST_P(GoldenScene, MeansWhatItMeant) {
  const std::string name = "scene_v" + std::to_string(GetParam());
  const testing::TemporaryFolder temporary;
  const std::vector<char> bytes = unrolled(folder / (name + ".lws.runs"));
  testing::write_bytes(temporary / "s.lws", bytes.data(), bytes.size());
  const auto scene = read_scene_pack(temporary / "s.lws");
  ASSERT_TRUE(scene) << scene.error().line();
  expect_text(describe(*scene), name);
}

INSTANTIATE_TEST_SUITE_P(Schema, GoldenScene,
                         ::testing::Range(static_cast<int>(oldest_scene_schema_version),
                                          static_cast<int>(scene_schema_version) + 1));

}  // namespace
}  // namespace lackwerk::packs
