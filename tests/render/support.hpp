// What the render tests share: contexts that may be missing, picture differences, a sphere.
//
// Why it exists: a missing backend must be a visible skip here and a failure where it is required. Test code; one
// thread.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "packs/scene.hpp"
#include "render_gles/context.hpp"
#include "render_gles/framebuffer.hpp"
#include "render_gles/image.hpp"

namespace lackwerk::test {

/// The context, or null with the reason in `reason`. Where LACKWERK_REQUIRE_EGL=1 or LACKWERK_REQUIRE_OSMESA=1 asks for
/// this backend, a missing one is also a test failure.
[[nodiscard]] std::unique_ptr<gles::Context> open_context(gles::Backend backend, std::string& reason);

/// A test on one backend: skipped with the reason where there is none.
class OnBackend : public testing::TestWithParam<gles::Backend> {
 protected:
  void SetUp() override;
  std::unique_ptr<gles::Context> context_;
};

/// A backend, perhaps held to what the weakest drivers offer.
struct Driver {
  gles::Backend backend;
  gles::CoreEs2 core;
};
[[nodiscard]] std::string driver_name(const Driver& driver);
/// A test on such a driver: skipped with the reason where there is none. `all_drivers` is what to instantiate it with.
class OnDriver : public testing::TestWithParam<Driver> {
 protected:
  void SetUp() override;
  [[nodiscard]] bool mediump() const { return !context_->info().fragment_highp; }
  std::unique_ptr<gles::Context> context_;
};
inline constexpr std::array all_drivers = {Driver{gles::Backend::egl_surfaceless, gles::CoreEs2::off},
                                           Driver{gles::Backend::egl_surfaceless, gles::CoreEs2::highp},
                                           Driver{gles::Backend::egl_surfaceless, gles::CoreEs2::mediump},
                                           Driver{gles::Backend::osmesa, gles::CoreEs2::off}};

/// A framebuffer without depth that holds the image; its alpha is not 255, for it must not matter.
[[nodiscard]] gles::Framebuffer framebuffer_of(const gles::Context& context, const gles::Image& image);
/// Noise, the same every time.
[[nodiscard]] gles::Image random_image(int width, int height);
/// Bytes that differ between two pictures of equal size.
[[nodiscard]] std::size_t different_bytes(const gles::Image& a, const gles::Image& b);

/// CIEDE2000 over the pixels of two pictures of equal size, as an sRGB display shows them.
struct Difference {
  double mean = 0.0, p95 = 0.0, p99 = 0.0, max = 0.0;
  std::size_t pixels = 0;
};
/// `mask`: one entry per pixel, 0 = left out; empty = all.
[[nodiscard]] Difference compare_images(const gles::Image& a, const gles::Image& b,
                                        const std::vector<std::uint8_t>& mask = {});
[[nodiscard]] std::string text(const Difference& difference);

/// A sphere around the origin, millimetres, with exact normals. `rings` bands from pole to pole, 2 * rings around.
[[nodiscard]] packs::MeshPart sphere(float radius_mm, int rings, packs::SurfaceKind kind = packs::SurfaceKind::paint);

/// Mean of the display-linear luminance (Y of CIE 1931) over the pixels whose mask is not 0.
[[nodiscard]] double mean_luminance(const gles::Image& image, const std::vector<std::uint8_t>& mask);

}  // namespace lackwerk::test
