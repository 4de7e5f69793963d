#include "packs/tools/pack_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/beyond.hpp"
#include "core/colour.hpp"
#include "packs/paint_pack_codec.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::packs {
namespace {

using testing::TemporaryFolder;

/// 16 x 16 texels, three slices: dark with a few bright flakes of one tint. Values are exact in half precision, so
/// that a capture is the same after it has been written and read.
Capture synthetic_capture(const std::string& name, const glm::vec3& tint, unsigned seed) {
  Capture capture;
  capture.identity.name = name;
  capture.identity.source = "synthetic";
  capture.analytic.diffuse = {0.25, 0.125, 0.5};
  capture.analytic.lobes.fill({glm::dvec3(0.0), 0.5, 0.5});
  capture.analytic.lobes[0].s = glm::dvec3(0.5);
  capture.layout = {3, {0, 2, 3}};
  capture.edge_texels = 16;
  capture.texel_mm = 0.0625f;
  std::mt19937 random(seed);
  for (int slice = 0; slice < 3; ++slice) {
    FlakeSlice image;
    for (int k = 0; k < 16 * 16; ++k) {
      const float grey = static_cast<float>(random() % 64) / 512.0f;
      image.texels.push_back(random() % 16 == 0 ? tint * (1.0f + static_cast<float>(random() % 8)) : glm::vec3(grey));
    }
    capture.slices.push_back(std::move(image));
  }
  return capture;
}

Capture plain_capture() {
  Capture capture;
  capture.identity.name = "Plain White";
  capture.analytic.diffuse = glm::dvec3(0.75);
  capture.analytic.lobes.fill({glm::dvec3(0.0), 0.25, 0.5});
  capture.analytic.lobes[0].s = glm::dvec3(0.25);
  return capture;
}

std::vector<Capture> three_captures() {
  return {synthetic_capture("Red", {1.0f, 0.25f, 0.125f}, 1), synthetic_capture("Green", {0.25f, 1.0f, 0.5f}, 2),
          synthetic_capture("Blue", {0.125f, 0.25f, 2.0f}, 3)};
}

PackBuildSettings settings_for(int threads) {
  PackBuildSettings settings;
  settings.id = "synthetic";
  settings.threads = threads;
  return settings;
}

TEST(PackBuilder, SameBytesForAnyNumberOfThreads) {
  const std::vector<Capture> captures = three_captures();
  std::vector<std::uint8_t> first;
  for (const int threads : {1, 2, 3, 0, 1}) {
    const auto built = build_pack(captures, settings_for(threads));
    ASSERT_TRUE(built) << built.error().line();
    const std::vector<std::uint8_t> bytes = encode_paint_pack(built->contents());
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first) << threads << " threads";
  }
}

TEST(PackBuilder, WhatItBuildsCanBeWrittenAndOpened) {
  const TemporaryFolder folder;
  const std::vector<Capture> captures = three_captures();
  std::vector<double> fractions;
  const auto built = build_pack(captures, settings_for(2), [&](double f, std::string_view) { fractions.push_back(f); });
  ASSERT_TRUE(built) << built.error().line();
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  ASSERT_FALSE(fractions.empty());
  EXPECT_EQ(fractions.back(), 1.0);
  const auto written = write_paint_pack(folder / "p.lwp", built->contents());
  ASSERT_TRUE(written) << written.error().line();
  const auto pack = PaintPack::open(folder / "p.lwp");
  ASSERT_TRUE(pack) << pack.error().line();
  EXPECT_EQ(pack->info(), built->info);
  EXPECT_EQ(pack->paint().row_count(), 5 * 3);
  EXPECT_EQ(pack->paint().row_mass, 256u);
  for (std::size_t k = 0; k < captures.size(); ++k) {
    EXPECT_EQ(pack->paint().paints[k].identity, captures[k].identity);
    EXPECT_EQ(pack->paint().paints[k].analytic, captures[k].analytic);
    EXPECT_GT(pack->info().errors[k].flake_w1_mean, 0.0f);
    EXPECT_GE(pack->info().errors[k].flake_w1_max, pack->info().errors[k].flake_w1_mean);
  }
  EXPECT_GT(pack->info().transport_cost, 0.0);
  EXPECT_EQ(pack->info().beyond_limit, core::beyond_limit(pack->paint()));
}

TEST(PackBuilder, SmallestLevelIsTheMeanOfTheSlice) {
  const std::vector<Capture> captures = three_captures();
  const auto built = build_pack(captures, settings_for(1));
  ASSERT_TRUE(built);
  const core::InterpolatablePaint paint = built->data.view();
  for (std::size_t k = 0; k < captures.size(); ++k)
    for (std::size_t slice = 0; slice < 3; ++slice) {
      glm::dvec3 mean(0.0);
      for (const glm::vec3& texel : captures[k].slices[slice].texels) mean += glm::dvec3(texel) / 256.0;
      const glm::dvec3 expected = core::lab_from_linear(mean);
      const std::size_t row = 4 * 3 + slice;
      ASSERT_EQ(paint.paints[k].cluster_begin[row + 1] - paint.paints[k].cluster_begin[row], 1u);
      const auto& q = paint.paints[k].clusters[paint.paints[k].cluster_begin[row]].q;
      for (int axis = 0; axis < 3; ++axis) {
        const double step = (static_cast<double>(paint.range.hi[axis]) - paint.range.lo[axis]) / 65535.0;
        const double found = paint.range.lo[axis] + step * q[static_cast<std::size_t>(2 * axis)];
        EXPECT_NEAR(found, expected[axis], step + 1e-3) << "paint " << k << " slice " << slice << " axis " << axis;
      }
    }
}

TEST(PackBuilder, EqualPaintsCostNothingToTransport) {
  const std::vector<Capture> captures = {synthetic_capture("A", {1, 0.5f, 0.25f}, 7),
                                         synthetic_capture("B", {1, 0.5f, 0.25f}, 7)};
  const auto built = build_pack(captures, settings_for(1));
  ASSERT_TRUE(built);
  EXPECT_EQ(built->info.transport_cost, 0.0);
}

TEST(PackBuilder, PlainPaintsMixWithFlakes) {
  const TemporaryFolder folder;
  const std::vector<Capture> captures = {plain_capture(), synthetic_capture("Red", {1.0f, 0.25f, 0.125f}, 1)};
  const auto built = build_pack(captures, settings_for(1));
  ASSERT_TRUE(built) << built.error().line();
  const core::InterpolatablePaint paint = built->data.view();
  EXPECT_EQ(paint.paints[0].clusters.size(), static_cast<std::size_t>(paint.row_count()));
  EXPECT_EQ(built->info.errors[0].flake_w1_max, 0.0f);
  const auto written = write_paint_pack(folder / "p.lwp", built->contents());
  ASSERT_TRUE(written) << written.error().line();

  const std::vector<Capture> plain = {plain_capture(), plain_capture()};
  const auto flakeless = build_pack(plain, settings_for(1));
  ASSERT_TRUE(flakeless);
  const auto also = write_paint_pack(folder / "q.lwp", flakeless->contents());
  ASSERT_TRUE(also) << also.error().line();
  const auto pack = PaintPack::open(folder / "q.lwp");
  ASSERT_TRUE(pack) << pack.error().line();
  EXPECT_EQ(pack->paint().row_count(), 0);
}

TEST(PackBuilder, FoldersGiveTheSameAsMemory) {
  const TemporaryFolder folder;
  const std::vector<Capture> captures = three_captures();
  std::vector<std::filesystem::path> folders;
  for (const Capture& capture : captures) {
    folders.push_back(folder / capture.identity.name);
    const auto written = write_capture(capture, folders.back());
    ASSERT_TRUE(written) << written.error().line();
  }
  const auto from_folders = build_pack_from_folders(folders, settings_for(2));
  ASSERT_TRUE(from_folders) << from_folders.error().line();
  const auto from_memory = build_pack(captures, settings_for(1));
  ASSERT_TRUE(from_memory);
  EXPECT_EQ(encode_paint_pack(from_folders->contents()), encode_paint_pack(from_memory->contents()));

  folders.push_back(folder / "missing");
  const auto missing = build_pack_from_folders(folders, settings_for(2));
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().file.find("missing"), std::string::npos);
}

TEST(PackBuilder, CapturesThatDoNotFitAreNamed) {
  const std::vector<Capture> good = three_captures();
  const auto expect_error = [](const std::vector<Capture>& captures, const char* file, const char* field,
                               const char* mentions) {
    const auto built = build_pack(captures, settings_for(1));
    ASSERT_FALSE(built) << field;
    EXPECT_EQ(built.error().file, file);
    EXPECT_EQ(built.error().field, field);
    EXPECT_NE(built.error().what.find(mentions), std::string::npos) << built.error().line();
  };
  auto captures = good;
  captures[2].texel_mm = 0.1f;
  expect_error(captures, "Blue", "texel_mm", "Red");
  captures = good;
  captures[1].edge_texels = 8;
  expect_error(captures, "Green", "edge_texels", "Red");
  captures = good;
  captures[1].layout = {3, {0, 3}};
  expect_error(captures, "Green", "layout", "Red");
  captures = good;
  captures[1].slices[2].texels[5].y = std::numeric_limits<float>::quiet_NaN();
  expect_error(captures, "Green", "slice 2", "finite");
  captures = good;
  captures[0].slices[1].texels.pop_back();
  expect_error(captures, "Red", "slice 1", "size");
  expect_error({}, "", "captures", "0");
  expect_error(std::vector<Capture>(6, good[0]), "", "captures", "6");
}

}  // namespace
}  // namespace lackwerk::packs
