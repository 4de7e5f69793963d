// The code a customer takes home: the same mix again, from any text nothing worse than an error.
#include "packs/mix_code.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "core/realise.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::string_view alphabet = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";

PackInfo info(std::string id = "showroom", std::uint64_t serial = 1) {
  PackInfo out;
  out.id = std::move(id);
  out.serial = serial;
  return out;
}

/// Weights that sum to 1, each in [lo, hi].
std::vector<double> random_group(std::mt19937& random, std::size_t paints, double lo, double hi) {
  std::uniform_real_distribution<double> any(lo, hi);
  while (true) {
    std::vector<double> out;
    double last = 1.0;
    for (std::size_t k = 0; k + 1 < paints; ++k) last -= out.emplace_back(any(random));
    out.push_back(last);
    if (last >= lo && last <= hi) return out;
  }
}

core::Weights random_mix(std::mt19937& random, std::size_t paints) {
  const bool beyond = random() % 2 == 0;
  const auto group = [&] { return random_group(random, paints, beyond ? -1.0 : 0.0, beyond ? 2.0 : 1.0); };
  core::Weights out = core::Weights::uniform(group());
  if (random() % 2 == 0) out.flake_lightness = group();
  if (random() % 2 == 0) out.flake_colour = group();
  if (random() % 2 == 0) out.flake_white = std::uniform_real_distribution<double>(0.0, 1.0)(random);
  return out;
}

void expect_near(const std::vector<double>& one, const std::vector<double>& two) {
  ASSERT_EQ(one.size(), two.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_NEAR(one[k], two[k], 1e-3) << "to a thousandth, though the sum is kept";
    sum += one[k];
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(MixCode, ComesBackToAThousandthAndAsTheSameText) {
  std::mt19937 random(7);
  core::InterpolatablePaint paint;
  for (int round = 0; round < 20'000; ++round) {
    const std::size_t paints = 1 + random() % core::max_paints;
    paint.paints.resize(paints);
    const core::Weights weights = random_mix(random, paints);
    // Serials of all lengths.
    const std::uint64_t serial = (std::uint64_t{random()} << 32 | random()) >> random() % 64;
    const PackInfo pack = info("pack-" + std::to_string(round % 7), serial);
    const std::string code = encode_mix(pack, weights);
    ASSERT_LE(code.size(), 63u);
    const auto mix = decode_mix(code);
    ASSERT_TRUE(mix) << code << ": " << mix.error().line();
    EXPECT_EQ(mix->serial, serial);
    EXPECT_EQ(mix->pack_tag, pack_tag_of(pack.id));
    expect_near(mix->weights.base, weights.base);
    expect_near(mix->weights.flake_lightness, weights.flake_lightness);
    expect_near(mix->weights.flake_colour, weights.flake_colour);
    EXPECT_NEAR(mix->weights.flake_white, weights.flake_white, 0.5001e-3);
    EXPECT_TRUE(core::check_weights(paint, mix->weights));
    ASSERT_EQ(encode_mix(pack, mix->weights), code);
    const auto again = mix_for(pack, paints, code);
    ASSERT_TRUE(again);
    EXPECT_EQ(*again, mix->weights);
    ASSERT_FALSE(::testing::Test::HasFailure()) << code;
  }
}

// A code on paper must be read by every later version: these texts may never change.
TEST(MixCode, IsTheSameForEver) {
  EXPECT_EQ(encode_mix(info("demo", 1), core::Weights::uniform({0.72, 0.28, 0.0})), "LW1V3E2ST186Q18062TFR");
  EXPECT_EQ(encode_mix(info("demo", 20261122), {{1.1, -0.1}, {0.5, 0.5}, {0.0, 1.0}, 0.25}),
            "LW1V3E2STHKNJSG27R6HEW7T1YG3HGEC");
}

TEST(MixCode, IsMadeOfWhatQrCodesHoldInTheirAlphanumericMode) {
  std::mt19937 random(8);
  for (int round = 0; round < 100; ++round) {
    const std::string code = encode_mix(info(), random_mix(random, 5));
    EXPECT_TRUE(code.starts_with("LW1"));
    EXPECT_EQ(code.find_first_not_of("0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ $%*+-./:"), std::string::npos);
  }
}

TEST(MixCode, SumsAreKeptWhenThirdsAreRounded) {
  const auto mix = decode_mix(encode_mix(info(), core::Weights::uniform({1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0})));
  ASSERT_TRUE(mix);
  EXPECT_EQ(mix->weights.base, (std::vector<double>{0.334, 0.333, 0.333}));
}

TEST(MixCode, EveryChangeOfOneCharacterIsFound) {
  std::mt19937 random(9);
  for (int round = 0; round < 50; ++round) {
    const std::string code = encode_mix(info(), random_mix(random, 1 + random() % 5));
    for (std::size_t at = 0; at < code.size(); ++at) {
      for (int other = 0; other < 256; ++other) {
        std::string changed = code;
        changed[at] = static_cast<char>(other);
        if (changed == code) continue;
        ASSERT_FALSE(decode_mix(changed)) << code << " / " << changed;
      }
      std::string shorter = code;
      ASSERT_FALSE(decode_mix(shorter.erase(at, 1)));
      if (at + 1 < code.size() && code[at] != code[at + 1]) {
        std::string swapped = code;
        std::swap(swapped[at], swapped[at + 1]);
        ASSERT_FALSE(decode_mix(swapped));
      }
    }
  }
}

// Longer damage passes the checksum with a chance of 2^-24 at most; of these 300,000 none does.
TEST(MixCode, DamageIsFound) {
  std::mt19937 random(10);
  const std::string code = encode_mix(info(), random_mix(random, 4));
  int taken = 0;
  for (int round = 0; round < 300'000; ++round) {
    std::string changed = code;
    for (int change = 0; change < 4; ++change) changed[3 + random() % (code.size() - 3)] = alphabet[random() % 32];
    if (changed != code && decode_mix(changed)) ++taken;
  }
  EXPECT_EQ(taken, 0);
}

TEST(MixCode, OtherTextsAreErrorsThatSayWhatToDo) {
  const std::string code = encode_mix(info(), core::Weights::uniform({0.5, 0.5}));
  std::string small = code;
  for (char& c : small) c = static_cast<char>(std::tolower(c));
  for (const std::string& text :
       {std::string(), std::string("LW1"), std::string("LW"), std::string("LW1") + std::string(13, '0'),
        "LW2" + code.substr(3), small, " " + code, code + " ", code + "0", code + std::string(1, '\0'),
        std::string(160, '0'), "LW1" + std::string(157, '0'), std::string(1'000'000, 'Z'), std::string("\x1b[2J"),
        "https://" + code}) {
    const auto mix = decode_mix(text);
    ASSERT_FALSE(mix) << text;
    EXPECT_EQ(mix.error().kind, ErrorKind::usage);
    EXPECT_FALSE(mix.error().remedy.empty());
    for (const char c : mix.error().line()) EXPECT_GE(c, ' ') << "nothing of a stranger's text goes to a terminal";
  }
}

TEST(MixCode, BelongsToItsPack) {
  const std::string code = encode_mix(info("showroom", 5), core::Weights::uniform({0.5, 0.5}));
  EXPECT_TRUE(mix_for(info("showroom", 5), 2, code));
  EXPECT_TRUE(mix_for(info("showroom", 9), 2, code)) << "a newer serial of the same pack";
  for (const auto& refused : {mix_for(info("showroom", 4), 2, code), mix_for(info("other", 5), 2, code),
                              mix_for(info("showroom", 5), 3, code)}) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::run);
  }
  EXPECT_EQ(mix_for(info(), 2, "x").error().kind, ErrorKind::usage);
  std::set<std::string> tags;
  for (int k = 0; k < 1000; ++k) tags.insert(pack_tag_of("pack-" + std::to_string(k)));
  EXPECT_EQ(tags.size(), 1000u);
}

constexpr MixWords english{"calm", "gentle", "lively", "white flakes"};

TEST(MixName, NamesTheLargestSharesAndTheSparkle) {
  lackwerk::testing::SamplePack sample(5);
  core::InterpolatablePaint& paint = sample.contents.paint;
  const auto name = [&](const std::vector<double>& weights, double white = 0.0) {
    core::Weights w = core::Weights::uniform(weights);
    w.flake_white = white;
    return mix_name(paint, w, english);
  };
  EXPECT_EQ(name({0.28, 0.72, 0, 0, 0}), "72 % Paint 1, 28 % Paint 0, calm");
  EXPECT_EQ(name({0, 0, 1, 0, 0}), "100 % Paint 2, calm");
  EXPECT_EQ(name({0.1, 0.2, 0.3, 0.25, 0.15}), "30 % Paint 2, 25 % Paint 3, 20 % Paint 1, calm");
  EXPECT_EQ(name({0.004, 0.5, 0.496, 0, 0}), "50 % Paint 1, 50 % Paint 2, calm");
  EXPECT_EQ(name({1.2, -0.2, 0, 0, 0}), "120 % Paint 0, calm");
  EXPECT_EQ(name({0, 0, 1, 0, 0}, 1.0), "100 % Paint 2, calm, white flakes");
  EXPECT_EQ(name({0, 0, 1, 0, 0}, 0.3), "100 % Paint 2, calm");
  // Brighter flakes beside dark ones.
  for (auto& clusters : sample.clusters) clusters[1].q = {65000, 65535, 0, 0, 0, 0};
  sample.link();
  EXPECT_EQ(name({0, 0, 1, 0, 0}), "100 % Paint 2, lively");
  for (auto& clusters : sample.clusters) clusters[1].q = {8500, 8800, 0, 0, 0, 0};
  sample.link();
  EXPECT_EQ(name({0, 0, 1, 0, 0}), "100 % Paint 2, gentle");
}

TEST(MixName, WithoutFlakesNothingSparkles) {
  core::InterpolatablePaint paint;
  paint.paints.resize(2);
  paint.paints[0].identity.name = "Rot";
  paint.paints[1].identity.name = "Blau";
  EXPECT_EQ(mix_name(paint, core::Weights::uniform({0.5, 0.5}), english), "50 % Rot, 50 % Blau");
}

}  // namespace
}  // namespace lackwerk::packs
