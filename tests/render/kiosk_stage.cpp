#include "tests/render/kiosk_stage.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "packs/paint_pack.hpp"
#include "tests/render/support.hpp"
#include "tests/render/synthetic_paint.hpp"

namespace lackwerk::test {

std::unique_ptr<kiosk::Stage> synthetic_stage(gles::Context& context, int width, int height) {
  const SyntheticPaint paint({.table = false, .lobes = 2});
  packs::PackContents contents;
  contents.info.id = "live-test";
  contents.info.serial = 7;
  contents.info.errors.resize(paint.get().paints.size());
  for (packs::PaintError& error : contents.info.errors)
    error.flake_w1_slice.resize(static_cast<std::size_t>(paint.get().layout.slice_count()));
  contents.paint = paint.get();
  const auto file = std::filesystem::temp_directory_path() / ("lackwerk_stage_" + std::to_string(getpid()) + ".lwp");
  const auto written = packs::write_paint_pack(file, contents);
  auto pack = packs::PaintPack::open(file, packs::Backing::copy);
  std::filesystem::remove(file);
  if (!written || !pack) {
    ADD_FAILURE() << (written ? pack.error().line() : written.error().line());
    return nullptr;
  }
  packs::Scene scene;
  scene.name = "sphere";
  scene.parts = {sphere(100.0f, 24)};
  scene.cameras = {{"hero", {0.0f, -400.0f, 150.0f}, {0.0f, 0.0f, 0.0f}, 40.0f}};
  auto stage = kiosk::Stage::create(context, width, height, std::move(*pack), std::move(scene));
  if (!stage) {
    ADD_FAILURE() << stage.error().line();
    return nullptr;
  }
  return std::move(*stage);
}

}  // namespace lackwerk::test
