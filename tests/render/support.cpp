#include "tests/render/support.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string_view>

#include "core/check.hpp"
#include "core/colour.hpp"

// LeakSanitizer's documented hook: OSMesa keeps a few kilobytes per process that no call gives back.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa\n";
}  // NOLINT(bugprone-reserved-identifier)

namespace lackwerk::test {
namespace {

glm::dvec3 linear_of(const std::uint8_t* pixel) {
  return {core::srgb_decode(pixel[0] / 255.0), core::srgb_decode(pixel[1] / 255.0),
          core::srgb_decode(pixel[2] / 255.0)};
}

}  // namespace

std::unique_ptr<gles::Context> open_context(gles::Backend backend, std::string& reason) {
  auto context = gles::create_context(backend);
  if (context) return std::move(*context);
  reason = context.error().line();
  const char* variable = backend == gles::Backend::osmesa ? "LACKWERK_REQUIRE_OSMESA" : "LACKWERK_REQUIRE_EGL";
  const char* required = std::getenv(variable);
  if (required != nullptr && std::string_view(required) == "1") ADD_FAILURE() << variable << "=1, but " << reason;
  return nullptr;
}

void OnBackend::SetUp() {
  std::string reason;
  context_ = open_context(GetParam(), reason);
  if (!context_ && HasFailure()) FAIL() << reason;  // fatal: the body must not run
  if (!context_) GTEST_SKIP() << reason;
}

std::string driver_name(const Driver& driver) {
  const std::string name = gles::backend_name(driver.backend);
  if (driver.core == gles::CoreEs2::off) return name;
  return name + (driver.core == gles::CoreEs2::highp ? "_core" : "_mediump");
}

void OnDriver::SetUp() {
  std::string reason;
  context_ = open_context(GetParam().backend, reason);
  if (context_ && GetParam().core != gles::CoreEs2::off) {
    context_.reset();
    auto limited = gles::create_context(GetParam().backend, {.core_es2 = GetParam().core});
    ASSERT_TRUE(limited) << limited.error().line();
    context_ = std::move(*limited);
  }
  if (!context_ && HasFailure()) FAIL() << reason;  // fatal: the body must not run
  if (!context_) GTEST_SKIP() << reason;
}

gles::Framebuffer framebuffer_of(const gles::Context& context, const gles::Image& image) {
  auto made = gles::Framebuffer::create(context, image.width, image.height, gles::PixelFormat::rgba8, false);
  if (!made) std::abort();
  std::vector<std::uint8_t> rgba(image.rgb.size() / 3 * 4, 17);
  std::uint8_t* out = rgba.data();
  for (int y = image.height - 1; y >= 0; --y)
    for (int x = 0; x < image.width; ++x, out += 4) std::copy_n(image.pixel(x, y), 3, out);
  const gles::GlApi& gl = context.gl();
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, made->texture());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  return std::move(*made);
}

gles::Image random_image(int width, int height) {
  gles::Image image(width, height);
  std::mt19937 random(4);
  for (std::uint8_t& byte : image.rgb) byte = static_cast<std::uint8_t>(random());
  return image;
}

std::size_t different_bytes(const gles::Image& a, const gles::Image& b) {
  check_equal(a.rgb.size(), b.rgb.size(), "sizes");
  std::size_t count = 0;
  for (std::size_t k = 0; k < a.rgb.size(); ++k) count += a.rgb[k] != b.rgb[k] ? 1 : 0;
  return count;
}

Difference compare_images(const gles::Image& a, const gles::Image& b, const std::vector<std::uint8_t>& mask) {
  Difference out;
  if (a.width != b.width || a.height != b.height) {
    ADD_FAILURE() << "pictures of different size";
    return out;
  }
  std::vector<double> differences;
  const std::size_t count = a.rgb.size() / 3;
  for (std::size_t k = 0; k < count; ++k) {
    if (!mask.empty() && mask[k] == 0) continue;
    const std::uint8_t *one = &a.rgb[3 * k], *two = &b.rgb[3 * k];
    differences.push_back(std::equal(one, one + 3, two) ? 0.0
                                                        : core::ciede2000(core::lab_from_linear(linear_of(one)),
                                                                          core::lab_from_linear(linear_of(two))));
  }
  if (differences.empty()) return out;
  std::sort(differences.begin(), differences.end());
  const auto at = [&](double part) {
    return differences[static_cast<std::size_t>(part * static_cast<double>(differences.size() - 1))];
  };
  double sum = 0.0;
  for (const double d : differences) sum += d;
  return {sum / static_cast<double>(differences.size()), at(0.95), at(0.99), at(1.0), differences.size()};
}

std::string text(const Difference& d) {
  std::array<char, 160> line{};
  std::snprintf(line.data(), line.size(), "CIEDE2000 mean %.4f, p95 %.3f, p99 %.3f, max %.2f over %zu pixels", d.mean,
                d.p95, d.p99, d.max, d.pixels);
  return line.data();
}

packs::MeshPart sphere(float radius_mm, int rings, packs::SurfaceKind kind) {
  packs::MeshPart part;
  part.name = "sphere";
  part.kind = kind;
  const int around = 2 * rings;
  for (int ring = 0; ring <= rings; ++ring)
    for (int k = 0; k <= around; ++k) {
      const double theta = std::numbers::pi * ring / rings;
      const double phi = 2.0 * std::numbers::pi * (k % around) / around;
      const glm::dvec3 n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      part.normals.emplace_back(n);
      part.positions_mm.emplace_back(n * static_cast<double>(radius_mm));
    }
  const auto vertex = [around](int ring, int k) { return static_cast<std::uint32_t>(ring * (around + 1) + k); };
  for (int ring = 0; ring < rings; ++ring)
    for (int k = 0; k < around; ++k) {
      const std::uint32_t a = vertex(ring, k), b = vertex(ring + 1, k), c = vertex(ring + 1, k + 1),
                          d = vertex(ring, k + 1);
      if (ring + 1 < rings) part.indices.insert(part.indices.end(), {a, b, c});
      if (ring > 0) part.indices.insert(part.indices.end(), {a, c, d});
    }
  return part;
}

double mean_luminance(const gles::Image& image, const std::vector<std::uint8_t>& mask) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < mask.size(); ++k) {
    if (mask[k] == 0) continue;
    const glm::dvec3 rgb = linear_of(&image.rgb[3 * k]);
    sum += core::rgb_to_xyz[1][0] * rgb.x + core::rgb_to_xyz[1][1] * rgb.y + core::rgb_to_xyz[1][2] * rgb.z;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace lackwerk::test
