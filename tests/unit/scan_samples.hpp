// A small pack of scans for tests: a stem that grows and a leaf that opens at its top.
//
// Why it exists: tests of the kiosk, the store and the renderer want scans without reading any. Test code; one thread.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "packs/scan_pack.hpp"

namespace lackwerk::testing {

/// The vectors own what the contents point into.
struct SampleScans {
  std::vector<std::vector<packs::ScanPath>> steps;
  packs::ScanContents contents;

  /// `count`: paths of each step. Days 5, 6 and 8.
  explicit SampleScans(const std::string& id = "plant", std::uint64_t serial = 1, std::size_t count = 600) {
    packs::ScanInfo& info = contents.info;
    info.id = id;
    info.serial = serial;
    info.name = "Tomato";
    info.time_unit = "days";
    info.edge = 100.0;
    info.spacing = 1.0;
    info.up = 2;
    const auto points = static_cast<std::uint32_t>(count);
    info.states = {{"five.xyz", 5.0, points}, {"six.xyz", 6.0, points}, {"eight.ply", 8.0, points}};
    constexpr double heights[] = {0.3, 0.5, 0.95};
    steps.resize(2);
    for (std::size_t s = 0; s < 2; ++s) {
      steps[s].reserve(count);
      for (std::size_t k = 0; k < count; ++k)
        steps[s].push_back(
            {place(k, count, heights[s]), place(k, count, heights[s + 1]), {0, 0, 127, 127}, {0, 0, 127, 127}});
      contents.steps.push_back({steps[s], 2, 0, 0});
    }
  }
  SampleScans(const SampleScans&) = delete;
  SampleScans& operator=(const SampleScans&) = delete;

  /// As if it had been read from a file that is whole and sound.
  [[nodiscard]] packs::ScanPack pack() const {
    const auto file = std::string(::testing::TempDir()) + "lackwerk_scans_" + contents.info.id + ".lwp";
    EXPECT_TRUE(packs::write_scan_pack(file, contents));
    auto opened = packs::ScanPack::open(file, packs::Backing::copy);
    EXPECT_TRUE(opened) << opened.error().line();
    std::filesystem::remove(file);
    return std::move(*opened);
  }

 private:
  /// Every third point is of the stem, the others of a disc that is as wide as the stem is high; in no order of place.
  static std::array<std::uint16_t, 4> place(std::size_t k, std::size_t count, double height) {
    const double part = std::fmod(static_cast<double>(k) * 0.6180339887498949, 1.0);
    double x = 0.5, y = 0.5, z = height;
    if (k % 3 == 0) {
      z = height * part;
    } else {
      const double radius = 0.4 * height * std::sqrt(static_cast<double>(k) / static_cast<double>(count));
      x += radius * std::cos(100.0 * part);
      y += radius * std::sin(100.0 * part);
    }
    const auto steps_of = [](double share) { return static_cast<std::uint16_t>(std::lround(share * 65535.0)); };
    return {steps_of(x), steps_of(y), steps_of(z), 65535};
  }
};

}  // namespace lackwerk::testing
