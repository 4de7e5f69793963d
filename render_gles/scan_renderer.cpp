#include "render_gles/scan_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>

#include "core/check.hpp"
#include "render_gles/program.hpp"
#include "render_gles/shader_texts.hpp"

namespace lackwerk::gles {
namespace {

/// Desktop OpenGL has these switched off; ES has no such switches.
constexpr GLenum vertex_program_point_size = 0x8642, point_sprite = 0x8861;

constexpr float world_edge = 1000.0f;  ///< of the pack's cube
constexpr float cube_steps = 65535.0f;
constexpr int shade_texels = 64;
/// The floor's square reaches this many times as far as what stands on it.
constexpr float floor_reach = 2.2f;

glm::vec3 place_of(const std::array<std::uint16_t, 4>& at) { return glm::vec3(at[0], at[1], at[2]) / cube_steps; }

/// Towards the key light, world axes.
glm::vec3 key_direction(const ScanLook& look) {
  const float azimuth = glm::radians(look.key_azimuth_deg), height = glm::radians(look.key_height_deg);
  return {std::cos(height) * std::cos(azimuth), std::cos(height) * std::sin(azimuth), std::sin(height)};
}

/// How much stands above each texel of the floor, blurred: [0, 1], row by row.
class Shade {
 public:
  void add(float u, float v, float height) {
    const float x = u * shade_texels - 0.5f, y = v * shade_texels - 0.5f;
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    // What is high up shades less, and wider than this map blurs.
    const float weight = 1.0f / (1.0f + 3.0f * height);
    for (int k = 0; k < 4; ++k) {
      const int c = column + k % 2, r = row + k / 2;
      if (c < 0 || r < 0 || c >= shade_texels || r >= shade_texels) continue;
      const float share = (1.0f - std::abs(x - static_cast<float>(c))) * (1.0f - std::abs(y - static_cast<float>(r)));
      cells_[index_of(r, shade_texels, c)] += weight * share;
    }
  }
  /// Blurred three times by a box (nearly a Gaussian) and brought to [0, 1] by a curve: half where `typical` points
  /// lie.
  [[nodiscard]] std::vector<float> finished(float typical) {
    for (int round = 0; round < 3; ++round)
      for (const int stride : {1, shade_texels}) blur(stride);
    std::vector<float> out(cells_.size());
    std::transform(cells_.begin(), cells_.end(), out.begin(), [&](float cell) { return cell / (cell + typical); });
    return out;
  }

 private:
  static std::size_t index_of(int line, int across, int along) {
    return static_cast<std::size_t>(line) * static_cast<std::size_t>(across) + static_cast<std::size_t>(along);
  }
  void blur(int stride) {
    constexpr int radius = 3;
    std::vector<float> next(cells_.size(), 0.0f);
    const int across = stride == 1 ? shade_texels : 1;
    for (int line = 0; line < shade_texels; ++line)
      for (int k = 0; k < shade_texels; ++k) {
        float sum = 0.0f;
        for (int j = std::max(0, k - radius); j <= std::min(shade_texels - 1, k + radius); ++j)
          sum += cells_[index_of(line, across, j * stride)];
        next[index_of(line, across, k * stride)] = sum / (2 * radius + 1);
      }
    cells_ = std::move(next);
  }
  std::vector<float> cells_ = std::vector<float>(std::size_t{shade_texels} * shade_texels, 0.0f);
};

}  // namespace

GLint ScanRenderer::Shader::at(std::string_view name) const {
  const auto found = uniforms.find(name);
  return found == uniforms.end() ? -1 : found->second;
}

ScanRenderer::ScanRenderer(Context& context) : context_(context), gl_(context.gl()) {
  const bool highp = context.info().fragment_highp;
  const std::string display(shader_text("display.glsl"));
  const auto look_up = [this](Shader& shader, std::initializer_list<const char*> names) {
    for (const char* name : names) shader.uniforms[name] = gl_.GetUniformLocation(shader.program.id(), name);
  };
  for (std::size_t k = 0; k < points_.size(); ++k) {
    points_[k].program =
        link_program(gl_,
                     shader_prelude(true) + display + "\n" + std::string(shader_text("scan_light.glsl")) + "\n" +
                         std::string(shader_text("scan_vertex.glsl")),
                     shader_prelude(highp) + "#define ROUND " + std::to_string(k) + "\n" +
                         std::string(shader_text("scan_fragment.glsl")),
                     {"a_from", "a_to", "a_from_normal", "a_to_normal"}, "scan");
    look_up(points_[k],
            {"u_time", "u_clip", "u_up", "u_key", "u_eye", "u_albedo", "u_sky", "u_sun", "u_point", "u_sizes"});
  }
  floor_.program = link_program(gl_, "#version 100\n" + std::string(shader_text("scan_floor_vertex.glsl")),
                                shader_prelude(highp) + display + "\n" + std::string(shader_text("scan_floor.glsl")),
                                {"a_corner"}, "scan floor");
  look_up(floor_, {"u_floor", "u_shade", "u_time", "u_dither", "u_floor_light", "u_backdrop"});
  splats_.program =
      link_program(gl_, "#version 100\n" + std::string(shader_text("scan_splats_vertex.glsl")),
                   shader_prelude(highp) + std::string(shader_text("scan_splats.glsl")), {"a_corner"}, "scan splats");
  look_up(splats_, {"u_splats", "u_rectangle", "u_used"});
  vertices_ = make_buffer(gl_);
  shade_ = make_texture(gl_);
  splat_texture_ = make_texture(gl_);
  corners_ = make_buffer(gl_);
  static constexpr std::array<float, 8> corners = {-1, -1, 1, -1, -1, 1, 1, 1};
  gl_.BindBuffer(GL_ARRAY_BUFFER, corners_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, sizeof corners, corners.data(), GL_STATIC_DRAW);
}

ScanRenderer::~ScanRenderer() { (void)context_.make_current(); }

void ScanRenderer::set_pack(const packs::ScanPack& pack) {
  pack_ = &pack;
  uploaded_ = false;
  last_.reset();
  Box cube;
  for (const packs::ScanStep& step : pack.steps())
    for (const packs::ScanPath& path : step.paths) {
      cube.include(place_of(path.from));
      cube.include(place_of(path.to));
    }
  // The vertical axis becomes z, the others keep their turn.
  const int up = pack.info().up;
  const std::array<int, 3> axis = {(up + 1) % 3, (up + 2) % 3, up};
  world_from_cube_ = glm::mat4(0.0f);
  world_from_cube_[3] = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
  bounds_ = {};
  for (int c = 0; c < 3; ++c) {
    const int from = axis[static_cast<std::size_t>(c)];
    const float origin = c == 2 ? cube.lo[from] : cube.centre()[from];
    world_from_cube_[from][c] = world_edge;
    world_from_cube_[3][c] = -world_edge * origin;
    bounds_.lo[c] = world_edge * (cube.lo[from] - origin);
    bounds_.hi[c] = world_edge * (cube.hi[from] - origin);
  }
}

View ScanRenderer::view_from(double azimuth_deg, double height_deg, double aspect) const {
  View view;
  view.vertical_fov_deg = 30.0f;
  const glm::vec3 centre = bounds_.centre();
  const float radius = std::max(1.0f, 0.5f * glm::distance(bounds_.lo, bounds_.hi));
  const double half = glm::radians(15.0);
  // The sphere around it touches the nearer pair of the picture's edges; a plant never fills its sphere.
  constexpr double fill = 1.12;
  const double narrow = std::min(half, std::atan(std::tan(half) * aspect));
  const double distance = static_cast<double>(radius) / std::sin(narrow) / fill;
  const double azimuth = glm::radians(azimuth_deg - 90.0), height = glm::radians(height_deg);
  view.target_mm = centre;
  view.eye_mm = centre + glm::vec3(glm::dvec3(std::cos(height) * std::cos(azimuth),
                                              std::cos(height) * std::sin(azimuth), std::sin(height)) *
                                   distance);
  return view;
}

void ScanRenderer::upload_shade(const packs::ScanStep& step) {
  Shade earlier, later;
  const float reach = floor_reach * std::max(bounds_.hi.x, bounds_.hi.y);
  const auto add = [&](Shade& shade, const std::array<std::uint16_t, 4>& at) {
    if (at[3] == 0) return;
    const glm::vec4 world = world_from_cube_ * glm::vec4(place_of(at), 1.0f);
    shade.add(0.5f + 0.5f * world.x / reach, 0.5f + 0.5f * world.y / reach, world.z / std::max(1.0f, bounds_.hi.z));
  };
  for (const packs::ScanPath& path : step.paths) {
    add(earlier, path.from);
    add(later, path.to);
  }
  // As many points as a texel would have were all of them on a tenth of the floor.
  const float typical = static_cast<float>(step.paths.size()) / (0.1f * shade_texels * shade_texels);
  const std::vector<float> from = earlier.finished(typical), to = later.finished(typical);
  std::vector<std::uint8_t> texels;
  texels.reserve(2 * from.size());
  for (std::size_t k = 0; k < from.size(); ++k)
    for (const float value : {from[k], to[k]}) texels.push_back(static_cast<std::uint8_t>(std::lround(255.0f * value)));
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, shade_.id());
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_LUMINANCE_ALPHA, shade_texels, shade_texels, 0, GL_LUMINANCE_ALPHA,
                 GL_UNSIGNED_BYTE, texels.data());
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl_.TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
}

void ScanRenderer::upload(std::size_t step, bool on_cpu) {
  const packs::ScanStep& what = pack_->steps()[step];
  if (!uploaded_ || step != step_) {
    upload_shade(what);
    step_ = step;
    uploaded_ = true;
    vertices_uploaded_ = false;
    uploaded_bytes_ += 2 * shade_texels * shade_texels;
  }
  if (on_cpu || vertices_uploaded_) return;
  vertex_bytes_ = what.paths.size_bytes();
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertex_bytes_), what.paths.data(), GL_STATIC_DRAW);
  uploaded_bytes_ += vertex_bytes_;
  vertices_uploaded_ = true;
}

std::size_t ScanRenderer::gpu_bytes() const {
  return vertex_bytes_ + 4 * static_cast<std::size_t>(splat_width_) * static_cast<std::size_t>(splat_height_);
}

void ScanRenderer::draw_floor(const Frame& frame, const glm::mat4& clip, float t) {
  gl_.UseProgram(floor_.program.id());
  gl_.Uniform1i(floor_.at("u_shade"), 0);
  gl_.Uniform1f(floor_.at("u_time"), t);
  gl_.Uniform1f(floor_.at("u_dither"), frame.look.dither ? 1.0f : 0.0f);
  gl_.Uniform3fv(floor_.at("u_floor_light"), 1, &frame.look.floor.x);
  gl_.Uniform3fv(floor_.at("u_backdrop"), 1, &frame.look.backdrop.x);
  const float reach = floor_reach * std::max(bounds_.hi.x, bounds_.hi.y);
  glm::mat4 world(1.0f);
  world[0][0] = world[1][1] = reach;
  const glm::mat4 floor = clip * world;
  gl_.UniformMatrix4fv(floor_.at("u_floor"), 1, GL_FALSE, &floor[0][0]);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, shade_.id());
  draw_corners();
}

void ScanRenderer::draw_corners() {
  for (GLuint slot = 1; slot <= attribute_visible + 2; ++slot) gl_.DisableVertexAttribArray(slot);
  gl_.BindBuffer(GL_ARRAY_BUFFER, corners_.id());
  gl_.EnableVertexAttribArray(0);
  gl_.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl_.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

bool ScanRenderer::on_cpu(const ScanLook& look) const {
  // Texel for pixel takes texture coordinates finer than mediump.
  if (look.way == ScanWay::quickest) return context_.info().software() && context_.info().fragment_highp;
  return look.way == ScanWay::cpu;
}

void ScanRenderer::draw_splats(std::span<const packs::ScanPath> paths, const SplatShot& shot, const Frame& frame) {
  splatter_.draw(paths, shot, frame.width, frame.height);
  const ScanSplatter::Rectangle part = splatter_.rectangle();
  if (part.width == 0) return;
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, splat_texture_.id());
  if (splat_width_ != frame.width || splat_height_ != frame.height) {
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, frame.width, frame.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
      gl_.TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    splat_width_ = frame.width;
    splat_height_ = frame.height;
  }
  gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, part.width, part.height, GL_RGBA, GL_UNSIGNED_BYTE,
                    splatter_.texels().data());
  const auto width = static_cast<float>(frame.width), height = static_cast<float>(frame.height);
  const glm::vec2 half(static_cast<float>(part.width) / width, static_cast<float>(part.height) / height);
  const glm::vec2 low(2.0f * static_cast<float>(part.x) / width - 1.0f,
                      2.0f * static_cast<float>(part.y) / height - 1.0f);
  // All points stand above the floor, and are seen from above when there is one.
  gl_.Disable(GL_DEPTH_TEST);
  gl_.UseProgram(splats_.program.id());
  gl_.Uniform1i(splats_.at("u_splats"), 0);
  gl_.Uniform4f(splats_.at("u_rectangle"), low.x + half.x, low.y + half.y, half.x, half.y);
  gl_.Uniform2f(splats_.at("u_used"), half.x, half.y);
  draw_corners();
}

void ScanRenderer::draw_points(const Frame& frame, const glm::mat4& clip, float t) {
  const packs::ScanStep& step = pack_->steps()[step_];
  const View& view = frame.view;
  // Pixels between neighbours at the middle of the scans; points too close for it are left out, evenly.
  const float spacing = world_edge * static_cast<float>(pack_->info().spacing / pack_->info().edge);
  const float per_unit = 1.0f / pixel_size_per_mm(view, frame.height);
  const float near_px = spacing * per_unit / std::max(1.0f, glm::distance(view.eye_mm, bounds_.centre()));
  const float kept = std::min(1.0f, near_px * near_px / (frame.look.least_spacing_px * frame.look.least_spacing_px));
  const auto all = static_cast<float>(step.paths.size());
  const std::size_t count =
      std::min({step.paths.size(), frame.look.most_points, static_cast<std::size_t>(std::ceil(kept * all))});
  // Splats half as wide again as the spacing close every gap of an uneven surface; fewer points are wider.
  constexpr float overlap = 1.5f;
  const float width = overlap * spacing * std::sqrt(all / static_cast<float>(std::max<std::size_t>(count, 1)));
  drawn_points_ = count;

  // From here on in the pack's cube, where the vertices are.
  const glm::mat4 cube_clip = clip * world_from_cube_;
  const glm::mat3 axes = glm::mat3(world_from_cube_) / world_edge;  // a turn of the axes: its inverse is its transpose
  const glm::vec3 key = glm::transpose(axes) * key_direction(frame.look);
  const glm::vec3 up = glm::transpose(axes) * glm::vec3(0.0f, 0.0f, 1.0f);
  const glm::vec3 eye = glm::vec3(glm::inverse(world_from_cube_) * glm::vec4(view.eye_mm, 1.0f));
  const float typical_px = width * per_unit / std::max(1.0f, glm::distance(view.eye_mm, bounds_.centre()));
  constexpr float round_from_px = 3.0f;  // a smaller disc is a square anyway
  const bool round = typical_px >= round_from_px;
  if (on_cpu(frame.look)) {
    const SplatShot shot{t,
                         cube_clip,
                         up,
                         key,
                         eye,
                         frame.look.albedo,
                         frame.look.sky,
                         frame.look.sun,
                         width * per_unit,
                         frame.look.least_splat_px,
                         frame.look.most_splat_px,
                         round};
    draw_splats(step.paths.first(count), shot, frame);
    return;
  }
  const Shader& shader = points_[round ? 1 : 0];
  gl_.UseProgram(shader.program.id());
  gl_.UniformMatrix4fv(shader.at("u_clip"), 1, GL_FALSE, &cube_clip[0][0]);
  gl_.Uniform1f(shader.at("u_time"), t);
  gl_.Uniform3fv(shader.at("u_up"), 1, &up.x);
  gl_.Uniform3fv(shader.at("u_key"), 1, &key.x);
  gl_.Uniform3fv(shader.at("u_eye"), 1, &eye.x);
  gl_.Uniform3fv(shader.at("u_albedo"), 1, &frame.look.albedo.x);
  gl_.Uniform3fv(shader.at("u_sky"), 1, &frame.look.sky.x);
  gl_.Uniform3fv(shader.at("u_sun"), 1, &frame.look.sun.x);
  gl_.Uniform1f(shader.at("u_point"), width * per_unit);
  gl_.Uniform2f(shader.at("u_sizes"), frame.look.least_splat_px, frame.look.most_splat_px);
  for (GLuint slot = 4; slot <= attribute_visible + 2; ++slot) gl_.DisableVertexAttribArray(slot);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  const auto attribute = [&](GLuint slot, GLenum type, std::size_t offset) {
    gl_.EnableVertexAttribArray(slot);
    gl_.VertexAttribPointer(slot, 4, type, GL_TRUE, sizeof(packs::ScanPath),
                            reinterpret_cast<const void*>(offset));  // NOLINT(performance-no-int-to-ptr)
  };
  attribute(0, GL_UNSIGNED_SHORT, offsetof(packs::ScanPath, from));
  attribute(1, GL_UNSIGNED_SHORT, offsetof(packs::ScanPath, to));
  attribute(2, GL_BYTE, offsetof(packs::ScanPath, from_normal));
  attribute(3, GL_BYTE, offsetof(packs::ScanPath, to_normal));
  gl_.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(count));
}

void ScanRenderer::draw(const View& view, const ScanLook& look, double time, const Framebuffer& target) {
  check_equal(pack_ != nullptr, true, "a scan pack is set");
  const std::vector<packs::ScanState>& states = pack_->info().states;
  const double now = std::clamp(time, states.front().time, states.back().time);
  std::size_t step = 0;
  while (step + 2 < states.size() && now >= states[step + 1].time) ++step;
  const double span = states[step + 1].time - states[step].time;
  const auto t = static_cast<float>((now - states[step].time) / span);
  upload(step, on_cpu(look));
  const Frame frame{view, look, now, target.width(), target.height(), target.texture()};
  const float reach = floor_reach * std::max(bounds_.hi.x, bounds_.hi.y);
  const std::array<Box, 2> boxes = {bounds_, Box{{-reach, -reach, 0.0f}, {reach, reach, 0.0f}}};
  const glm::mat4 clip = clip_from_world(view, target.width(), target.height(), boxes);
  target.bind();
  if (context_.info().desktop) {
    gl_.Enable(vertex_program_point_size);
    gl_.Enable(point_sprite);
  }
  gl_.Disable(GL_BLEND);
  gl_.Disable(GL_CULL_FACE);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LEQUAL);
  gl_.DepthMask(GL_TRUE);
  // The backdrop as the floor's rim has it, through the same curve; what is that dark lies on the curve's straight
  // part.
  const auto encoded = [](float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
  };
  gl_.ClearColor(encoded(look.backdrop.x), encoded(look.backdrop.y), encoded(look.backdrop.z), 1.0f);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  // Seen from below, the floor would hide everything.
  if (view.eye_mm.z > 0.0f) draw_floor(frame, clip, t);
  draw_points(frame, clip, t);
  last_ = frame;
  ++draws_;
}

bool ScanRenderer::needs_draw(const View& view, const ScanLook& look, double time, const Framebuffer& target) const {
  if (pack_ == nullptr) return false;
  const std::vector<packs::ScanState>& states = pack_->info().states;
  const double now = std::clamp(time, states.front().time, states.back().time);
  return last_ != Frame{view, look, now, target.width(), target.height(), target.texture()};
}

}  // namespace lackwerk::gles
