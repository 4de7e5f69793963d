// Contexts, the function table, framebuffers and pictures.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "render_gles/framebuffer.hpp"
#include "render_gles/gl_object.hpp"
#include "tests/render/support.hpp"

namespace lackwerk::test {
namespace {

using gles::Backend;

TEST_P(OnBackend, SaysWhatItIs) {
  const gles::ContextInfo& info = context_->info();
  for (const std::string& line : info.lines()) std::printf("  %s\n", line.c_str());
  EXPECT_FALSE(info.vendor.empty());
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_FALSE(info.platform.empty());
  EXPECT_EQ(info.desktop, GetParam() == Backend::osmesa);
  // The minima of core ES 2.0 (2.0.25, tables 6.18 to 6.20).
  EXPECT_GE(info.max_texture_size, 64);
  EXPECT_GE(info.max_renderbuffer_size, 1);
  EXPECT_GE(info.max_texture_units, 8);
  EXPECT_GE(info.max_vertex_attributes, 8);
  EXPECT_GE(info.max_varying_vectors, 8);
  EXPECT_GE(info.max_vertex_uniforms, 128);
  EXPECT_GE(info.max_fragment_uniforms, 16);
  EXPECT_EQ(info.lines().size(), 13u);
}

TEST_P(OnBackend, RefusesSizesByName) {
  for (const auto& [w, h] : {std::pair(0, 10), std::pair(10, -1), std::pair(1 << 20, 8)}) {
    const auto made = gles::Framebuffer::create(*context_, w, h);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().kind, ErrorKind::usage);
    EXPECT_NE(made.error().what.find(std::to_string(w) + "x" + std::to_string(h)), std::string::npos);
  }
}

TEST_P(OnBackend, TriangleReadsBackTopDown) {
  const gles::GlApi& gl = context_->gl();
  auto target = gles::Framebuffer::create(*context_, 33, 17);
  ASSERT_TRUE(target);
  EXPECT_TRUE(target->depth_bits() == 16 || target->depth_bits() == 24);
  const auto shader = [&](GLenum stage, const char* text) {
    gles::GlObject made = gles::make_shader(gl, stage);
    gl.ShaderSource(made.id(), 1, &text, nullptr);
    gl.CompileShader(made.id());
    return made;
  };
  const auto vertex =
      shader(GL_VERTEX_SHADER, "#version 100\nattribute vec2 p; void main() { gl_Position = vec4(p, 0.0, 1.0); }");
  const auto fragment =
      shader(GL_FRAGMENT_SHADER,
             "#version 100\nprecision mediump float; void main() { gl_FragColor = vec4(1.0, 0.2, 0.0, 1.0); }");
  const gles::GlObject program = gles::make_program(gl);
  gl.AttachShader(program.id(), vertex.id());
  gl.AttachShader(program.id(), fragment.id());
  gl.BindAttribLocation(program.id(), 0, "p");
  gl.LinkProgram(program.id());
  GLint linked = 0;
  gl.GetProgramiv(program.id(), GL_LINK_STATUS, &linked);
  ASSERT_EQ(linked, GL_TRUE);
  // The left upper half: corners top left, bottom left, top right.
  const std::array<float, 6> corners = {-1, 1, -1, -1, 1, 1};
  const gles::GlObject buffer = gles::make_buffer(gl);
  gl.BindBuffer(GL_ARRAY_BUFFER, buffer.id());
  gl.BufferData(GL_ARRAY_BUFFER, sizeof(corners), corners.data(), GL_STATIC_DRAW);
  target->bind();
  gl.ClearColor(0.0f, 0.0f, 1.0f, 1.0f);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl.UseProgram(program.id());
  gl.EnableVertexAttribArray(0);
  gl.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gles::check_gl(gl, "triangle");
  const gles::Image image = target->read();
  const auto is = [&](int x, int y, std::array<int, 3> rgb) {
    const std::uint8_t* p = image.pixel(x, y);
    EXPECT_EQ(p[0], rgb[0]) << x << ',' << y;
    EXPECT_EQ(p[1], rgb[1]) << x << ',' << y;
    EXPECT_EQ(p[2], rgb[2]) << x << ',' << y;
  };
  is(1, 1, {255, 51, 0});
  is(1, 14, {255, 51, 0});
  is(28, 1, {255, 51, 0});
  is(31, 15, {0, 0, 255});
}

INSTANTIATE_TEST_SUITE_P(Backends, OnBackend, testing::Values(Backend::egl_surfaceless, Backend::osmesa),
                         [](const auto& info) { return std::string(gles::backend_name(info.param)); });

TEST(Contexts, BothInOneProcessTakeTurns) {
  std::string reason;
  const std::array contexts = {open_context(Backend::egl_surfaceless, reason), open_context(Backend::osmesa, reason)};
  if (!contexts[0] || !contexts[1]) GTEST_SKIP() << reason;
  std::array<std::unique_ptr<gles::Framebuffer>, 2> targets;
  for (int round = 0; round < 4; ++round)
    for (std::size_t k = 0; k < 2; ++k) {
      ASSERT_TRUE(contexts[k]->make_current());
      if (!targets[k]) {
        auto made = gles::Framebuffer::create(*contexts[k], 8, 8);
        ASSERT_TRUE(made);
        targets[k] = std::make_unique<gles::Framebuffer>(std::move(*made));
      }
      const gles::GlApi& gl = contexts[k]->gl();
      targets[k]->bind();
      gl.ClearColor(k == 0 ? 1.0f : 0.0f, static_cast<float>(round) * 0.2f, 0.0f, 1.0f);
      gl.Clear(GL_COLOR_BUFFER_BIT);
      const gles::Image image = targets[k]->read();
      EXPECT_EQ(image.pixel(4, 4)[0], k == 0 ? 255 : 0);
      EXPECT_EQ(image.pixel(4, 4)[1], 51 * round);
    }
  for (std::size_t k = 0; k < 2; ++k) {
    ASSERT_TRUE(contexts[k]->make_current());
    targets[k].reset();
  }
}

TEST(Contexts, OneEndsTheOtherLives) {
  std::string reason;
  auto first = open_context(Backend::egl_surfaceless, reason);
  auto second = open_context(Backend::egl_surfaceless, reason);
  if (!first || !second) GTEST_SKIP() << reason;
  first.reset();
  ASSERT_TRUE(second->make_current());
  EXPECT_TRUE(gles::Framebuffer::create(*second, 4, 4));
}

TEST(Contexts, FunctionTableNamesWhatIsMissing) {
  const auto none = gles::GlApi::load([](const char*) { return nullptr; }, "a backend");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().line().find("a backend"), std::string::npos);
  EXPECT_NE(none.error().line().find("glDrawElements"), std::string::npos);
}

TEST(Contexts, FewUniformsMeanFewerLights) {
  gles::ContextInfo info;
  for (const auto& [vectors, lights] : {std::pair(16, 1), std::pair(0, 0), std::pair(22, 4), std::pair(1024, 4)}) {
    info.max_fragment_uniforms = vectors;
    EXPECT_EQ(gles::usable_lights(info), lights) << vectors;
  }
}

TEST(Pictures, PngKeepsEveryByte) {
  gles::Image image(37, 5);
  for (std::size_t k = 0; k < image.rgb.size(); ++k) image.rgb[k] = static_cast<std::uint8_t>(k * 7);
  const std::string path = testing::TempDir() + "lackwerk_picture.png";
  ASSERT_TRUE(gles::write_png(image, path));
  const auto back = gles::read_png(path);
  ASSERT_TRUE(back) << back.error().line();
  EXPECT_EQ(*back, image);

  // The same picture, the same bytes.
  const std::string again = testing::TempDir() + "lackwerk_picture_again.png";
  ASSERT_TRUE(gles::write_png(image, again));
  const auto bytes = [](const std::string& p) {
    std::ifstream file(p, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(bytes(path), bytes(again));

  // Half a file is an error that names it.
  std::ofstream(again, std::ios::binary | std::ios::trunc) << bytes(path).substr(0, 60);
  const auto damaged = gles::read_png(again);
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().file, again);
  std::filesystem::remove(path);
  std::filesystem::remove(again);
}

TEST(Pictures, ErrorsNameTheFile) {
  const auto missing = gles::read_png("/nonexistent/picture.png");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().file, "/nonexistent/picture.png");
  EXPECT_FALSE(gles::write_png(gles::Image(2, 2), "/nonexistent/picture.png"));
}

}  // namespace
}  // namespace lackwerk::test
