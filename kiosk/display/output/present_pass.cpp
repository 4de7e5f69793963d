#include "kiosk/display/output/present_pass.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/colour.hpp"
#include "kiosk/display/test_pattern.hpp"
#include "render_gles/program.hpp"
#include "render_gles/shader_texts.hpp"

namespace lackwerk::kiosk {
namespace {

/// Entries of the panel's curves. At 2048 the nearest one is at most 0.06 of an 8-bit step away where the panel's curve
/// runs like a square root, and 0.1 where it is steepest for a power of 2.4.
constexpr int most_entries = 2048;
constexpr int table_rows = 4;
/// Rows of the picture's table are read with 256 entries.
constexpr int least_entries = 256;
constexpr std::size_t floats_per_corner = 4;
constexpr int corner_count = 3;

const char* vertex_text =
    "#version 100\n"
    "attribute vec2 a_corner;\n"
    "attribute vec2 a_at;\n"
    "varying vec2 v_at;\n"
    "void main() { v_at = a_at; gl_Position = vec4(a_corner, 0.0, 1.0); }\n";

/// Two bytes of an RGBA texel.
void put(std::uint8_t* texel, double value) {
  const auto number = static_cast<unsigned>(std::lround(std::clamp(value, 0.0, 1.0) * 65535.0));
  texel[0] = static_cast<std::uint8_t>(number >> 8);
  texel[1] = static_cast<std::uint8_t>(number & 255u);
}

void sample_nearest(const gles::GlApi& gl, bool nearest) {
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, nearest ? GL_NEAREST : GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, nearest ? GL_NEAREST : GL_LINEAR);
}

void upload(const gles::GlApi& gl, GLuint texture, std::array<int, 2> size, const std::uint8_t* rgba) {
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  sample_nearest(gl, true);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, size[0], size[1], 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
}

}  // namespace

PresentPass::PresentPass(gles::Context& context)
    : context_(&context), gl_(&context.gl()), program_(make(false, false)), corners_(gles::make_buffer(context.gl())) {
  upload_corners();
}

PresentPass::Program PresentPass::make(bool profile, bool warning) const {
  const auto define = [](const char* name, const std::string& value) {
    return std::string("#define ") + name + " " + value + "\n";
  };
  std::string fragment = gles::shader_prelude(context_->info().fragment_highp);
  fragment += define("PROFILE", profile ? "1" : "0") + define("WARNING", warning ? "1" : "0");
  fragment += define("TABLE_SIZE", std::to_string(table_size_) + ".0");
  fragment += define("GAMUT_TOLERANCE", std::to_string(gamut_tolerance));
  fragment += std::string(gles::shader_text("display.glsl")) + "\n" + std::string(gles::shader_text("present.glsl"));
  Program out;
  out.program = gles::link_program(*gl_, vertex_text, fragment, {"a_corner", "a_at"}, "present");
  const auto location = [&](const char* name) { return gl_->GetUniformLocation(out.program.id(), name); };
  out.picture = location("u_picture");
  out.tables = location("u_tables");
  out.panel = location("u_panel");
  out.bgr = location("u_bgr");
  out.brightness = location("u_brightness");
  return out;
}

void PresentPass::set(Rotation rotation, const DisplayProfile& profile, bool test_pattern, bool gamut_warning) {
  rotation_ = rotation;
  profile_ = profile;
  show_pattern_ = test_pattern;
  if (!test_pattern) {
    pattern_ = gles::GlObject();
    pattern_px_ = {0, 0};
  }
  upload_corners();
  const bool apply = !profile.is_srgb();  // sRGB shows all of sRGB: nothing to warn of
  table_size_ = 0;
  tables_ = gles::GlObject();
  if (apply) upload_tables();
  program_ = make(apply, apply && gamut_warning);
  if (!apply) return;
  const std::array<double, 9> rows = panel_from_srgb(profile);
  std::array<float, 9> columns{};
  for (std::size_t k = 0; k < columns.size(); ++k) columns[k] = static_cast<float>(rows[3 * (k % 3) + k / 3]);
  gl_->UseProgram(program_.program.id());
  gl_->UniformMatrix3fv(program_.panel, 1, GL_FALSE, columns.data());
}

/// One triangle that covers the square [-1, 1]^2, once for windows and once for memory that starts at the panel's upper
/// row. The way from panel to picture is linear, so its values at the corners are all that is needed.
void PresentPass::upload_corners() {
  static constexpr std::array<Point, corner_count> at = {Point{0, 0}, Point{2, 0}, Point{0, 2}};
  std::array<float, 2 * corner_count * floats_per_corner> values{};
  auto* out = values.data();
  for (const bool flip_y : {false, true})
    for (const auto& [x, y] : at) {
      const Point picture = picture_point(rotation_, {x, flip_y ? y : 1.0 - y});
      *out++ = static_cast<float>(2.0 * x - 1.0);
      *out++ = static_cast<float>(2.0 * y - 1.0);
      *out++ = static_cast<float>(picture[0]);
      *out++ = static_cast<float>(1.0 - picture[1]);  // textures start at the picture's lower row
    }
  gl_->BindBuffer(GL_ARRAY_BUFFER, corners_.id());
  gl_->BufferData(GL_ARRAY_BUFFER, sizeof values, values.data(), GL_STATIC_DRAW);
}

void PresentPass::upload_tables() {
  table_size_ = most_entries;
  while (table_size_ > least_entries && table_size_ > context_->info().max_texture_size) table_size_ /= 2;
  const auto entries = static_cast<std::size_t>(table_size_);
  std::vector<std::uint8_t> texels(entries * table_rows * 4);
  for (std::size_t k = 0; k < entries; ++k) {
    const double root = static_cast<double>(k) / static_cast<double>(entries - 1);
    for (int channel = 0; channel < 3; ++channel)
      put(&texels[(static_cast<std::size_t>(channel) * entries + k) * 4],
          pixel_of_light(profile_, channel, root * root));
    const std::size_t byte = k * least_entries / entries;
    put(&texels[(3 * entries + k) * 4], std::sqrt(core::srgb_decode(static_cast<double>(byte) / 255.0)));
  }
  tables_ = gles::make_texture(*gl_);
  upload(*gl_, tables_.id(), {table_size_, table_rows}, texels.data());
}

void PresentPass::upload_pattern(std::array<int, 2> size_px) {
  const gles::Image image = test_pattern(size_px[0], size_px[1]);
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  std::vector<std::uint8_t> rgba(width * height * 4, 255);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x)
      std::copy_n(&image.rgb[((height - 1 - y) * width + x) * 3], 3, &rgba[(y * width + x) * 4]);
  if (!pattern_) pattern_ = gles::make_texture(*gl_);
  upload(*gl_, pattern_.id(), size_px, rgba.data());
  pattern_px_ = size_px;
}

void PresentPass::draw(const gles::Framebuffer& picture, std::array<int, 2> panel_px, GLuint target_framebuffer,
                       bool flip_y, ChannelOrder order) {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target_framebuffer);
  const std::array<int, 2> wanted = picture_size(rotation_, panel_px);
  if (show_pattern_ && pattern_px_ != wanted) upload_pattern(wanted);
  gl_->Viewport(0, 0, panel_px[0], panel_px[1]);
  gl_->Disable(GL_DEPTH_TEST);
  gl_->Disable(GL_CULL_FACE);
  gl_->Disable(GL_BLEND);
  gl_->Disable(GL_SCISSOR_TEST);
  gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);

  gl_->UseProgram(program_.program.id());
  gl_->Uniform1i(program_.picture, 0);
  gl_->Uniform1i(program_.tables, 1);
  gl_->Uniform1f(program_.brightness, show_pattern_ ? 1.0f : brightness_);
  gl_->Uniform1f(program_.bgr, order == ChannelOrder::bgr ? 1.0f : 0.0f);
  if (tables_) {
    gl_->ActiveTexture(GL_TEXTURE1);
    gl_->BindTexture(GL_TEXTURE_2D, tables_.id());
  }
  gl_->ActiveTexture(GL_TEXTURE0);
  gl_->BindTexture(GL_TEXTURE_2D, show_pattern_ ? pattern_.id() : picture.texture());
  // Exact where sizes agree; the picture gets its own filter back, which other passes rely on.
  const bool exact = show_pattern_ || (picture.width() == wanted[0] && picture.height() == wanted[1]);
  sample_nearest(*gl_, exact);

  for (GLuint slot = 2; slot <= gles::attribute_visible + 2; ++slot) gl_->DisableVertexAttribArray(slot);
  gl_->BindBuffer(GL_ARRAY_BUFFER, corners_.id());
  constexpr auto stride = static_cast<GLsizei>(floats_per_corner * sizeof(float));
  const auto offset = [](std::uintptr_t bytes) {
    return reinterpret_cast<const void*>(bytes);  // NOLINT(performance-no-int-to-ptr): GL's offset into the buffer
  };
  for (GLuint slot = 0; slot < 2; ++slot) {
    gl_->EnableVertexAttribArray(slot);
    gl_->VertexAttribPointer(slot, 2, GL_FLOAT, GL_FALSE, stride, offset(slot * 2 * sizeof(float)));
  }
  gl_->DrawArrays(GL_TRIANGLES, flip_y ? corner_count : 0, corner_count);
  gl_->DisableVertexAttribArray(1);
  if (!show_pattern_) sample_nearest(*gl_, false);
}

}  // namespace lackwerk::kiosk
