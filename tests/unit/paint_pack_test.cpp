#include "packs/paint_pack.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "packs/paint_pack_checks.hpp"
#include "packs/paint_pack_codec.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::packs {
namespace {

using testing::SamplePack;
using testing::TemporaryFolder;

template <class T>
std::vector<T> copy(std::span<const T> values) {
  return {values.begin(), values.end()};
}

void expect_same(const core::InterpolatablePaint& a, const core::InterpolatablePaint& b) {
  ASSERT_EQ(a.paints.size(), b.paints.size());
  for (std::size_t k = 0; k < a.paints.size(); ++k) {
    EXPECT_EQ(a.paints[k].identity, b.paints[k].identity);
    EXPECT_EQ(a.paints[k].analytic, b.paints[k].analytic);
    EXPECT_EQ(copy(a.paints[k].cluster_begin), copy(b.paints[k].cluster_begin));
    EXPECT_EQ(copy(a.paints[k].clusters), copy(b.paints[k].clusters));
    EXPECT_EQ(copy(a.paints[k].tuple_cluster), copy(b.paints[k].tuple_cluster));
    EXPECT_EQ(a.paints[k].life, b.paints[k].life);
  }
  EXPECT_EQ(a.layout, b.layout);
  EXPECT_EQ(a.level_count, b.level_count);
  EXPECT_EQ(a.texel_mm, b.texel_mm);
  EXPECT_EQ(a.level0_texels, b.level0_texels);
  EXPECT_EQ(a.range.lo, b.range.lo);
  EXPECT_EQ(a.range.hi, b.range.hi);
  EXPECT_EQ(copy(a.tuple_begin), copy(b.tuple_begin));
  EXPECT_EQ(copy(a.mass), copy(b.mass));
  EXPECT_EQ(a.row_mass, b.row_mass);
  EXPECT_EQ(a.random_seed, b.random_seed);
}

TEST(PaintPack, ComesBackBitForBit) {
  const TemporaryFolder folder;
  for (const std::size_t paints : {std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
    const SamplePack sample(paints);
    ASSERT_TRUE(write_paint_pack(folder / "p.lwp", sample.contents));
    for (const Backing backing : {Backing::map, Backing::copy}) {
      auto opened = PaintPack::open(folder / "p.lwp", backing);
      ASSERT_TRUE(opened) << opened.error().line();
      const PaintPack pack = std::move(*opened);  // spans must survive a move
      expect_same(pack.paint(), sample.contents.paint);
      EXPECT_EQ(pack.info(), sample.contents.info);
      EXPECT_EQ(pack.file_bytes(), std::filesystem::file_size(folder / "p.lwp"));
    }
  }
}

TEST(PaintPack, StatesHowFarBeyondItMayGo) {
  const TemporaryFolder folder;
  SamplePack sample;
  for (const double limit : {0.0, 0.35, 1.0}) {
    sample.contents.info.beyond_limit = limit;
    ASSERT_TRUE(write_paint_pack(folder / "p.lwp", sample.contents));
    const auto pack = PaintPack::open(folder / "p.lwp");
    ASSERT_TRUE(pack);
    EXPECT_EQ(pack->info().beyond_limit, limit);
    EXPECT_EQ(pack->info().schema_version, 4u);
    EXPECT_EQ(pack->info().minimum_reader, 1u) << "older readers do without it";
  }
}

TEST(PaintPack, SameContentsGiveTheSameBytesAndNoLeftovers) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_paint_pack(folder / "a.lwp", SamplePack().contents));
  ASSERT_TRUE(write_paint_pack(folder / "b.lwp", SamplePack().contents));
  ASSERT_TRUE(write_paint_pack(folder / "b.lwp", SamplePack().contents));
  EXPECT_EQ(testing::read_bytes(folder / "a.lwp"), testing::read_bytes(folder / "b.lwp"));
  const std::filesystem::directory_iterator entries(folder.path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 2);
}

TEST(PaintPack, PaintWithoutFlakesIsFine) {
  const TemporaryFolder folder;
  SamplePack sample(1);
  core::InterpolatablePaint& paint = sample.contents.paint;
  paint = {{paint.paints[0]}, {}, 0, 0.0f, 0, {}, {}, {}, 0, 0};
  paint.paints[0].cluster_begin = {};
  paint.paints[0].clusters = {};
  paint.paints[0].tuple_cluster = {};
  sample.contents.info.errors = {{}};
  ASSERT_TRUE(write_paint_pack(folder / "p.lwp", sample.contents));
  const auto pack = PaintPack::open(folder / "p.lwp");
  ASSERT_TRUE(pack) << pack.error().line();
  EXPECT_EQ(pack->paint().row_count(), 0);
}

TEST(PaintPack, EveryFlippedBitIsRefused) {
  const TemporaryFolder folder;
  const auto path = folder / "p.lwp";
  ASSERT_TRUE(write_paint_pack(path, SamplePack().contents));
  testing::BitFlipper file(path);
  for (std::size_t bit = 0; bit < file.size_bits(); ++bit) {
    file.flip(bit);
    const auto pack = PaintPack::open(path, bit % 2 == 0 ? Backing::map : Backing::copy);
    ASSERT_FALSE(pack) << "bit " << bit;
    ASSERT_EQ(pack.error().file, path.string());
    ASSERT_FALSE(pack.error().field.empty());
    file.flip(bit);
  }
  EXPECT_TRUE(PaintPack::open(path));
  std::printf("%zu single-bit flips of a pack of %zu bytes, all refused\n", file.size_bits(), file.size_bits() / 8);
}

TEST(PaintPack, EveryTruncationAndExtensionIsRefused) {
  const TemporaryFolder folder;
  const auto path = folder / "p.lwp";
  ASSERT_TRUE(write_paint_pack(path, SamplePack().contents));
  std::vector<char> bytes = testing::read_bytes(path);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    testing::write_bytes(path, bytes.data(), size);
    ASSERT_FALSE(PaintPack::open(path, size % 2 == 0 ? Backing::map : Backing::copy)) << size;
  }
  bytes.push_back(0);
  testing::write_bytes(path, bytes.data(), bytes.size());
  EXPECT_FALSE(PaintPack::open(path));
}

TEST(PaintPack, NotAFileIsRefused) {
  const TemporaryFolder folder;
  EXPECT_FALSE(PaintPack::open(folder.path()));
  const auto missing = PaintPack::open(folder / "missing.lwp");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::run);
  EXPECT_FALSE(missing.error().remedy.empty());
  ASSERT_FALSE(write_paint_pack(folder / "no" / "such" / "folder.lwp", SamplePack().contents));
}

struct BadMeaning {
  const char* field;  ///< must be named by the error
  std::function<void(SamplePack&)> spoil;
};

/// Packs with a correct digest and sound FlatBuffers, in which one thing makes no sense.
std::vector<BadMeaning> bad_meanings() {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr float nanf = std::numeric_limits<float>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {
      {"paints", [](SamplePack& s) { s.contents.paint.paints.clear(); }},
      {"id", [](SamplePack& s) { s.contents.info.id = ""; }},
      {"id", [](SamplePack& s) { s.contents.info.id = "a serial=9"; }},
      {"id", [](SamplePack& s) { s.contents.info.id = "../up"; }},
      {"id", [](SamplePack& s) { s.contents.info.id = std::string(65, 'a'); }},
      {"minimum_reader", [](SamplePack& s) { s.contents.info.minimum_reader = paint_schema_version + 1; }},
      {"minimum_reader", [](SamplePack& s) { s.contents.info.minimum_reader = 0; }},
      {"schema_version", [](SamplePack& s) { s.contents.info.schema_version = 0; }},
      {"transport_cost", [](SamplePack& s) { s.contents.info.transport_cost = nan; }},
      {"beyond_limit", [](SamplePack& s) { s.contents.info.beyond_limit = nan; }},
      {"beyond_limit", [](SamplePack& s) { s.contents.info.beyond_limit = -0.05; }},
      {"beyond_limit", [](SamplePack& s) { s.contents.info.beyond_limit = 1.05; }},
      {"tool_version", [](SamplePack& s) { s.contents.info.tool_version = "a\nb"; }},
      {"paints[1].name", [](SamplePack& s) { s.contents.paint.paints[1].identity.name = ""; }},
      {"paints[1].name", [](SamplePack& s) { s.contents.paint.paints[1].identity.name = "\xC0\x80"; }},
      {"paints[1].name", [](SamplePack& s) { s.contents.paint.paints[1].identity.name = "\xED\xA0\x80"; }},
      {"paints[1].name", [](SamplePack& s) { s.contents.paint.paints[1].identity.name = "cut \xE2\x82"; }},
      {"paints[0].source", [](SamplePack& s) { s.contents.paint.paints[0].identity.source = "\x1B[31m"; }},
      {"paints[0].origin",
       [](SamplePack& s) { s.contents.paint.paints[0].identity.coat = static_cast<core::Provenance>(3); }},
      {"paints[0].diffuse", [](SamplePack& s) { s.contents.paint.paints[0].analytic.diffuse.y = nan; }},
      {"paints[0].diffuse", [](SamplePack& s) { s.contents.paint.paints[0].analytic.diffuse.z = -1e-9; }},
      {"paints[1].lobes[0].s", [](SamplePack& s) { s.contents.paint.paints[1].analytic.lobes[0].s.x = infinity; }},
      {"paints[1].lobes[1].m", [](SamplePack& s) { s.contents.paint.paints[1].analytic.lobes[1].m = 0.0; }},
      {"paints[1].lobes[2].f0", [](SamplePack& s) { s.contents.paint.paints[1].analytic.lobes[2].f0 = 1.01; }},
      {"paints[0].coat_ior", [](SamplePack& s) { s.contents.paint.paints[0].analytic.coat_ior = 0.9; }},
      {"paints[0].refraction_ior", [](SamplePack& s) { s.contents.paint.paints[0].analytic.refraction_ior = nan; }},
      {"paints[0].chi[3]", [](SamplePack& s) { s.contents.paint.paints[0].analytic.table->linear[3].y = nanf; }},
      {"paints[0].chi", [](SamplePack& s) { s.contents.paint.paints[0].analytic.table->linear.pop_back(); }},
      {"paints[0].chi",
       [](SamplePack& s) {
         s.contents.paint.paints[0].analytic.table = core::ColourTable{1, {{}}};
       }},
      {"paints[1].error.flake_w1_mean", [](SamplePack& s) { s.contents.info.errors[1].flake_w1_mean = nanf; }},
      {"paints[1].error.flake_w1_max", [](SamplePack& s) { s.contents.info.errors[1].flake_w1_max = -1.0f; }},
      {"paints[1].error.flake_w1_slice", [](SamplePack& s) { s.contents.info.errors[1].flake_w1_slice = {1.0f}; }},
      {"paints[1].error.form", [](SamplePack& s) { s.contents.info.errors[1].form.form = static_cast<PaintForm>(3); }},
      {"paints[1].error.form.judge",
       [](SamplePack& s) { s.contents.info.errors[1].form.judged_by = static_cast<JudgedBy>(3); }},
      {"paints[1].error.form.count", [](SamplePack& s) { s.contents.info.errors[1].form.count = 7; }},
      {"paints[1].error.form.e2000", [](SamplePack& s) { s.contents.info.errors[1].form.e2000_p95 = -1.0f; }},
      {"paints[1].life", [](SamplePack& s) { s.contents.paint.paints[1].life.cell_h_deg = 0.0f; }},
      {"paints[1].life", [](SamplePack& s) { s.contents.paint.paints[1].life.cell_i_deg = nanf; }},
      {"paints[0].life.origin",
       [](SamplePack& s) { s.contents.paint.paints[0].life.origin = static_cast<core::LifeOrigin>(3); }},
      {"num_theta", [](SamplePack& s) { s.contents.paint.layout.num_theta = 0; }},
      {"num_theta", [](SamplePack& s) { s.contents.paint.layout.num_theta = 16; }},
      {"layout",
       [](SamplePack& s) {
         s.contents.paint.layout.lut = {1, 1, 2};
       }},
      {"layout[2]",
       [](SamplePack& s) {
         s.contents.paint.layout.lut = {0, 3, 2};
       }},
      {"layout", [](SamplePack& s) { s.contents.paint.layout.lut = std::vector<std::uint16_t>(20, 2); }},
      {"level_count", [](SamplePack& s) { s.contents.paint.level_count = 3; }},
      {"level0_texels", [](SamplePack& s) { s.contents.paint.level0_texels = 0; }},
      {"level0_texels", [](SamplePack& s) { s.contents.paint.level0_texels = 5000; }},
      {"texel_mm", [](SamplePack& s) { s.contents.paint.texel_mm = 0.0f; }},
      {"texel_mm", [](SamplePack& s) { s.contents.paint.texel_mm = nanf; }},
      {"range_lo", [](SamplePack& s) { s.contents.paint.range.lo.x = 500.0f; }},
      {"range_hi", [](SamplePack& s) { s.contents.paint.range.hi.z = nanf; }},
      {"row_mass", [](SamplePack& s) { s.contents.paint.row_mass = 0; }},
      {"row_mass", [](SamplePack& s) { s.contents.paint.row_mass = (1u << 30) + 1; }},
      {"mass", [](SamplePack& s) { s.mass[2] = 3; }},
      {"mass", [](SamplePack& s) { s.mass[2] = 0xFFFFFFFFu; }},
      {"mass[4]", [](SamplePack& s) { s.mass[4] = 0; }},
      {"tuple_begin",
       [](SamplePack& s) {
         s.tuple_begin = {0, 2, 4, 8};
       }},
      {"tuple_begin", [](SamplePack& s) { s.tuple_begin[0] = 1; }},
      {"tuple_begin[2]", [](SamplePack& s) { s.tuple_begin[2] = 1; }},
      {"tuple_begin[1]", [](SamplePack& s) { s.tuple_begin[1] = 300; }},
      {"tuple_begin", [](SamplePack& s) { s.mass.push_back(4); }},
      {"paints[1].cluster_begin", [](SamplePack& s) { s.cluster_begin[1].back() = 7; }},
      {"paints[1].cluster_begin[1]", [](SamplePack& s) { s.cluster_begin[1][1] = 0; }},
      {"paints[1].tuple_cluster[5]", [](SamplePack& s) { s.tuple_cluster[1][5] = 2; }},
      {"paints[0].tuple_cluster", [](SamplePack& s) { s.tuple_cluster[0].pop_back(); }},
      {"paints[1].clusters[6]", [](SamplePack& s) { std::swap(s.clusters[1][6].q[0], s.clusters[1][6].q[1]); }},
  };
}

TEST(PaintPack, SoundFilesWithoutSenseAreRefusedByField) {
  const TemporaryFolder folder;
  const auto path = folder / "p.lwp";
  std::size_t cases = 0;
  for (const BadMeaning& bad : bad_meanings()) {
    SamplePack sample;
    bad.spoil(sample);
    sample.link();
    ASSERT_TRUE(write_sealed_file(path, SealedKind::paint, encode_paint_pack(sample.contents)));
    const auto pack = PaintPack::open(path);
    ASSERT_FALSE(pack) << "case " << cases << ", " << bad.field;
    const std::string& field = pack.error().field;
    EXPECT_TRUE(field == bad.field || field.starts_with(std::string(bad.field) + "[")) << pack.error().line();
    EXPECT_FALSE(pack.error().what.empty());
    EXPECT_FALSE(pack.error().remedy.empty());
    // The writer refuses it as well, and leaves what was there.
    const auto before = testing::read_bytes(path);
    EXPECT_FALSE(write_paint_pack(path, sample.contents)) << bad.field;
    EXPECT_EQ(before, testing::read_bytes(path));
    ++cases;
  }
  std::printf("%zu packs with a correct digest and bad meaning, all refused\n", cases);
}

TEST(PaintPack, SixPaintsAreRefused) {
  const TemporaryFolder folder;
  const SamplePack sample(6);
  ASSERT_TRUE(write_sealed_file(folder / "p.lwp", SealedKind::paint, encode_paint_pack(sample.contents)));
  const auto pack = PaintPack::open(folder / "p.lwp");
  ASSERT_FALSE(pack);
  EXPECT_EQ(pack.error().field, "paints");
}

TEST(PaintPack, DamageUnderACorrectDigestNeverReadsOutside) {
  // The FlatBuffers verifier and the checks of meaning must hold alone. Some flips (a colour's low bits, a letter of a
  // name) are other sound packs; none may crash. A copy of exact size lets the sanitizer see reads past the end.
  const std::vector<std::uint8_t> payload = encode_paint_pack(SamplePack().contents);
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < payload.size() * 8; ++bit) {
    std::vector<std::uint8_t> flipped = payload;
    flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1u << (bit % 8)));
    const auto contents = decode_paint_pack(flipped, "p.lwp");
    if (!contents || !check_contents(*contents, "p.lwp")) ++refused;
  }
  std::printf("%zu of %zu resealed single-bit flips refused by structure or meaning\n", refused, payload.size() * 8);
  EXPECT_GT(refused, payload.size() * 8 / 4);
  EXPECT_FALSE(decode_paint_pack(std::vector<std::uint8_t>(64, 0xFF), "p.lwp"));
}

TEST(PaintPack, ScenePackIsRefusedByName) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_sealed_file(folder / "s.lws", SealedKind::scene, std::vector<std::uint8_t>(64)));
  const auto pack = PaintPack::open(folder / "s.lws");
  ASSERT_FALSE(pack);
  EXPECT_EQ(pack.error().field, "kind");
}

}  // namespace
}  // namespace lackwerk::packs
