#include "render_gles/program.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <sstream>

#include "core/check.hpp"
#include "core/colour.hpp"
#include "render_gles/shader_texts.hpp"

namespace lackwerk::gles {
namespace {

/// A float constant that GLSL ES 1.00 reads as a float and that keeps 32 bits.
std::string literal(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9e", value);
  return text.data();
}

/// One row of XYZ-to-linear with the white point folded in, as in core/paint_model.hpp.
std::string linear_row(const char* name, int row) {
  std::string text = std::string("const vec3 ") + name + " = vec3(";
  for (int k = 0; k < 3; ++k) text += (k > 0 ? ", " : "") + literal(core::xyz_to_rgb[row][k] * core::white_xyz[k]);
  return text + ");\n";
}

std::string precision(bool highp) {
  return highp ? "precision highp float;\nprecision highp sampler2D;\n"
               : "precision mediump float;\nprecision mediump sampler2D;\n";
}

std::string define(const char* name, int value) {
  return std::string("#define ") + name + " " + std::to_string(value) + "\n";
}

/// What paint_model.hpp gives the C++ side.
std::string language_prelude() {
  return "#define real float\n#define R(x) (x)\nvec3 make_vec3(vec4 v) { return v.xyz; }\n" +
         linear_row("LINEAR_FROM_XYZ_R", 0) + linear_row("LINEAR_FROM_XYZ_G", 1) + linear_row("LINEAR_FROM_XYZ_B", 2) +
         "const float LAB_DELTA = " + literal(core::lab_delta) + ";\n";
}

std::string numbered(const std::string& source) {
  std::istringstream lines(source);
  std::string out, line;
  for (int k = 1; std::getline(lines, line); ++k) out += std::to_string(k) + "  " + line + "\n";
  return out;
}

[[noreturn]] void refuse(const std::string& what, const std::string& log, const std::string& source) {
  const std::string text = "broken invariant: " + what + ": " + log + "\n" + numbered(source);
  std::fputs(text.c_str(), stderr);
  std::abort();
}

GlObject compile(const GlApi& gl, GLenum stage, const std::string& source, const std::string& what) {
  GlObject shader = make_shader(gl, stage);
  const char* text = source.c_str();
  gl.ShaderSource(shader.id(), 1, &text, nullptr);
  gl.CompileShader(shader.id());
  GLint ok = GL_FALSE;
  gl.GetShaderiv(shader.id(), GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  std::string log(16384, '\0');
  GLsizei length = 0;
  gl.GetShaderInfoLog(shader.id(), static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  refuse("a shader does not compile (" + what + ")", log, source);
}

}  // namespace

const char* surface_name(packs::SurfaceKind kind) {
  static constexpr std::array<const char*, packs::surface_kind_count> names = {
      "paint", "glass", "chrome", "rubber", "trim", "rim", "lamp_clear", "lamp_red", "interior", "floor"};
  return names[static_cast<std::size_t>(kind)];
}

Features Features::canonical() const {
  Features f = *this;
  if (f.surface != packs::SurfaceKind::paint || f.stripes) {
    f.lobes = 0;
    f.table = f.flakes = f.coat = f.refraction = false;
  }
  if (f.surface == packs::SurfaceKind::paint && f.stripes) {
    f.lights = 0;
    f.studio = false;
  }
  if (f.surface != packs::SurfaceKind::paint) f.stripes = f.studio = false;  // they ask the studio's gain instead
  if (!f.flakes) f.flake_lights = 0;
  if (f.flake_lights > f.lights) f.flake_lights = f.lights;
  if (f.flake_lights == 0) f.flake_taps = 1;
  return f;
}

std::string Features::text() const {
  std::string out = surface_name(surface);
  if (lobes > 0) out += ", " + std::to_string(lobes) + (lobes == 1 ? " lobe" : " lobes");
  if (table) out += ", colour table";
  if (coat) out += ", coat";
  if (refraction) out += ", refraction";
  if (flakes)
    out += flake_lights == 0 ? std::string(", mean flakes")
                             : ", flakes of " + std::to_string(flake_lights) +
                                   (flake_lights == 1 ? " light with " : " lights with ") + std::to_string(flake_taps) +
                                   (flake_taps == 1 ? " tap" : " taps");
  out += ", " + std::to_string(lights) + (lights == 1 ? " light" : " lights");
  if (studio) out += ", studio";
  if (stripes) out += ", stripes";
  return out;
}

std::string vertex_source() {
  return "#version 100\n" + precision(true) + std::string(shader_text("surface_vertex.glsl"));
}

std::string fragment_source(const Features& features, bool fragment_highp) {
  std::string text = "#version 100\n" + precision(fragment_highp) + language_prelude();
  text += define("SURFACE", static_cast<int>(features.surface));
  text += define("LOBES", features.lobes);
  text += define("HAS_TABLE", features.table ? 1 : 0);
  text += define("HAS_FLAKES", features.flakes ? 1 : 0);
  text += define("FLAKE_TAPS", features.flake_taps);
  text += define("HAS_COAT", features.coat ? 1 : 0);
  text += define("HAS_REFRACTION", features.refraction ? 1 : 0);
  text += define("NUM_LIGHTS", features.lights);
  text += define("FLAKE_LIGHTS", features.flake_lights);
  text += define("STRIPES", features.stripes ? 1 : 0);
  text += define("STUDIO", features.studio ? 1 : 0);
  for (const char* file :
       {"paint_fetch.glsl", "paint_model.glsl", "studio.glsl", "display.glsl", "surface_fragment.glsl"})
    text += std::string(shader_text(file)) + "\n";
  return text;
}

Program::Program(const GlApi& gl, const Features& features, bool fragment_highp) : gl_(&gl) {
  const auto start = std::chrono::steady_clock::now();
  const std::string what = features.text();
  const std::string fragment_text = fragment_source(features, fragment_highp);
  const GlObject vertex = compile(gl, GL_VERTEX_SHADER, vertex_source(), "vertex, " + what);
  const GlObject fragment = compile(gl, GL_FRAGMENT_SHADER, fragment_text, what);
  program_ = make_program(gl);
  gl.AttachShader(program_.id(), vertex.id());
  gl.AttachShader(program_.id(), fragment.id());
  gl.BindAttribLocation(program_.id(), attribute_position, "a_position");
  gl.BindAttribLocation(program_.id(), attribute_normal, "a_normal");
  gl.BindAttribLocation(program_.id(), attribute_open, "a_open");
  gl.LinkProgram(program_.id());
  GLint ok = GL_FALSE;
  gl.GetProgramiv(program_.id(), GL_LINK_STATUS, &ok);
  if (ok != GL_TRUE) {
    std::string log(16384, '\0');
    GLsizei length = 0;
    gl.GetProgramInfoLog(program_.id(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    refuse("a program does not link (" + what + ")", log, fragment_text);
  }
  GLint count = 0;
  gl.GetProgramiv(program_.id(), GL_ACTIVE_UNIFORMS, &count);
  for (GLint k = 0; k < count; ++k) {
    std::array<char, 128> name{};
    GLsizei length = 0;
    GLint size = 0;
    GLenum type = 0;
    gl.GetActiveUniform(program_.id(), static_cast<GLuint>(k), static_cast<GLsizei>(name.size()), &length, &size, &type,
                        name.data());
    std::string text(name.data(), static_cast<std::size_t>(length));
    if (const auto bracket = text.find('['); bracket != std::string::npos) text.resize(bracket);
    locations_[text] = gl.GetUniformLocation(program_.id(), text.c_str());
    if (type != GL_SAMPLER_2D) uniform_vectors_ += size * (type == GL_FLOAT_MAT4 ? 4 : 1);
  }
  compile_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

GLint Program::location(std::string_view uniform) const {
  const auto found = locations_.find(uniform);
  return found == locations_.end() ? -1 : found->second;
}

const Program& ProgramCache::get(const Features& features) {
  const Features key = features.canonical();
  auto& slot = programs_[key];
  if (!slot) slot = std::make_unique<Program>(context_->gl(), key, context_->info().fragment_highp);
  return *slot;
}

std::vector<std::string> ProgramCache::lines() const {
  std::vector<std::string> out;
  for (const auto& [features, program] : programs_) {
    std::array<char, 64> times{};
    std::snprintf(times.data(), times.size(), " (compiled in %.1f ms, %d uniform vectors)", program->compile_ms(),
                  program->uniform_vectors());
    out.push_back("program: " + features.text() + times.data());
  }
  return out;
}

}  // namespace lackwerk::gles
