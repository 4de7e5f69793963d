#include "render_gles/program.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <sstream>

#include "core/check.hpp"
#include "core/colour.hpp"
#include "core/environment.hpp"
#include "core/paint_model.hpp"
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
  return highp ? "#define FRAGMENT_HIGHP 1\nprecision highp float;\nprecision highp sampler2D;\n"
               : "#define FRAGMENT_HIGHP 0\nprecision mediump float;\nprecision mediump sampler2D;\n";
}

std::string define(const char* name, int value) {
  return std::string("#define ") + name + " " + std::to_string(value) + "\n";
}

/// What paint_model.hpp gives the C++ side.
std::string language_prelude(bool fragment_highp) {
  return "#define real float\n#define R(x) (x)\nvec3 make_vec3(vec4 v) { return v.xyz; }\n" +
         linear_row("LINEAR_FROM_XYZ_R", 0) + linear_row("LINEAR_FROM_XYZ_G", 1) + linear_row("LINEAR_FROM_XYZ_B", 2) +
         "const float LAB_DELTA = " + literal(core::lab_delta) + ";\n" +
         "const float MAX_EXPONENT = " + literal(fragment_highp ? core::max_exponent_wide : core::max_exponent_16) +
         ";\n" + "const float LEAST = " + literal(fragment_highp ? core::least_wide : core::least_16) + ";\n";
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
  if (f.stripes && f.surface != packs::SurfaceKind::paint) f.stripes = false;
  if (f.stripes) {
    const Features bare;
    f = {.surface = surface,
         .diffuse = bare.diffuse,
         .path = ShaderPath::none,
         .stripes = true,
         .orange_peel = orange_peel,
         .output = output};
    return f;
  }
  if (f.surface != packs::SurfaceKind::paint) {
    f.table = f.flakes = false;
    f.map = MapUse::none;
  }
  if (f.map != MapUse::none) f.table = false;
  // Prefiltered light has chi in its albedo: only a light or a sample asks for one pair of directions.
  if (f.lights == 0 && f.path != ShaderPath::sampled) f.map = MapUse::none;
  const bool looks_up = f.path == ShaderPath::filtered || f.path == ShaderPath::mirror;
  if (f.path == ShaderPath::filtered) f.looked_up = 31;
  if (!looks_up) f.looked_up = 0;
  // No bits of what there is none of.
  f.looked_up &= ((1 << f.lobes) - 1) | (f.flakes ? 8 : 0) | (f.diffuse ? 16 : 0);
  if (f.surface != packs::SurfaceKind::floor || !looks_up) f.floor_mirror = false;
  if (f.path != ShaderPath::filtered) f.sparkle_lights = 0;
  if ((f.looked_up & 16) == 0) f.irradiance = false;
  if (f.surface != packs::SurfaceKind::paint || f.path == ShaderPath::none || !f.coat) f.orange_peel = false;
  if (f.path != ShaderPath::sampled) f.still_flakes = false;
  if (f.path != ShaderPath::filtered) f.diffuse = true;  // the directional model always has the term
  if (!f.flakes) {
    f.flake_lights = f.sparkle_lights = 0;
    f.still_flakes = false;
  }
  f.flake_lights = std::min(f.flake_lights, f.lights);
  if (f.lights == 0) f.room_lights = false;
  if (f.lights == 0 || !f.flakes) f.less_mean_flakes = false;
  if (!f.single_flakes()) f.flake_taps = f.flake_cells = 1;
  f.narrow &= f.looked_up;
  return f;
}

std::string Features::text() const {
  const auto counted = [](int count, const char* what) {
    return ", " + std::to_string(count) + " " + what + (count == 1 ? "" : "s");
  };
  std::string out = surface_name(surface);
  if (stripes) return out + ", stripes";
  static constexpr std::array<const char*, 4> paths = {"no environment", "filtered environment", "sampled environment",
                                                       "environment beside lights"};
  out += std::string(", ") + paths[static_cast<std::size_t>(path)];
  if (lobes > 0) out += counted(lobes, "lobe");
  if (!diffuse) out += ", no diffuse part";
  if (table) out += ", colour table";
  if (map != MapUse::none) out += map == MapUse::slide ? ", sliding colour map" : ", colour map";
  if (coat) out += ", coat";
  if (refraction) out += ", refraction";
  if (flakes && !single_flakes()) out += ", mean flakes";
  if (single_flakes()) {
    out +=
        ", single flakes with" + counted(flake_taps, "tap").substr(1) + " and" + counted(flake_cells, "cell").substr(1);
    if (sparkle_lights > 0) out += counted(sparkle_lights, "sparkle light");
    if (flake_lights > 0) out += counted(flake_lights, "flake light");
  }
  if (lights > 0) out += counted(lights, room_lights ? "environment light" : "directional light");
  if (path == ShaderPath::mirror && looked_up != 0) out += ", some parts looked up";
  if (less_mean_flakes) out += ", mean flakes looked up";
  if (visibility) out += ", visibility";
  if (irradiance) out += ", baked irradiance";
  if (floor_mirror) out += ", mirror image";
  if (orange_peel) out += ", orange peel";
  if (output == ShaderOutput::linear) out += ", linear output";
  if (output == ShaderOutput::mirror_image) out += ", for the mirror image";
  if (output == ShaderOutput::subject) out += ", as a mask";
  return out;
}

std::string vertex_source(const Features& features) {
  return "#version 100\n" + precision(true) + define("HAS_VISIBILITY", features.visibility ? 1 : 0) +
         define("HAS_IRRADIANCE", features.irradiance ? 1 : 0) + std::string(shader_text("surface_vertex.glsl"));
}

std::string fragment_source(const Features& features, bool fragment_highp) {
  std::string text = shader_prelude(fragment_highp);
  text += define("SURFACE", static_cast<int>(features.surface));
  text += define("PATH", static_cast<int>(features.path));
  text += define("OUTPUT", static_cast<int>(features.output));
  text += define("LOBES", features.lobes);
  text += define("HAS_DIFFUSE", features.diffuse ? 1 : 0);
  text += define("HAS_TABLE", features.table ? 1 : 0);
  text += define("COLOUR_MAP", static_cast<int>(features.map));
  text += define("HAS_FLAKES", features.flakes ? 1 : 0);
  text += define("SINGLE_FLAKES", features.single_flakes() ? 1 : 0);
  text += define("FLAKE_TAPS", features.flake_taps);
  text += define("FLAKE_CELLS", features.flake_cells);
  text += define("HAS_COAT", features.coat ? 1 : 0);
  text += define("HAS_REFRACTION", features.refraction ? 1 : 0);
  text += define("NUM_LIGHTS", features.lights);
  text += define("FLAKE_LIGHTS", features.flake_lights);
  text += define("SPARKLE_LIGHTS", features.sparkle_lights);
  text += define("ROOM_LIGHTS", features.room_lights ? 1 : 0);
  text += define("LESS_MEAN_FLAKES", features.less_mean_flakes ? 1 : 0);
  text += define("ORANGE_PEEL", features.orange_peel ? 1 : 0);
  for (int k = 0; k < 5; ++k)
    text += define(("LOOKUP" + std::to_string(k)).c_str(), (features.looked_up >> k & 1) != 0 ? 1 : 0);
  for (int k = 0; k < 3; ++k)
    text += define(("NARROW" + std::to_string(k)).c_str(), (features.narrow >> k & 1) != 0 ? 1 : 0);
  text += define("HAS_VISIBILITY", features.visibility ? 1 : 0);
  text += define("HAS_IRRADIANCE", features.irradiance ? 1 : 0);
  text += define("FLOOR_MIRROR", features.floor_mirror ? 1 : 0);
  text += define("STRIPES", features.stripes ? 1 : 0);
  text += "#define ENVIRONMENT_WIDTH " + literal(core::environment_width) + "\n#define ENVIRONMENT_HEIGHT " +
          literal(core::environment_height) + "\n";
  const auto append = [&](const char* file) { text += std::string(shader_text(file)) + "\n"; };
  for (const char* file : {"paint_fetch.glsl", "surface_inputs.glsl", "environment.glsl", "surface_visible.glsl"})
    append(file);
  if (features.map != MapUse::none) {
    append("isochromatic.glsl");
    append("mapped_paint.glsl");
  }
  append("paint_model.glsl");
  append("display.glsl");
  if (features.path == ShaderPath::filtered || features.path == ShaderPath::mirror) append("filtered_light.glsl");
  if (features.path == ShaderPath::sampled) append("sampled_light.glsl");
  if (features.orange_peel) append("orange_peel.glsl");
  append("surface_fragment.glsl");
  return text;
}

std::string shader_prelude(bool fragment_highp) {
  return "#version 100\n" + precision(fragment_highp) + language_prelude(fragment_highp);
}

GlObject link_program(const GlApi& gl, const std::string& vertex, const std::string& fragment,
                      const std::vector<const char*>& attributes, const std::string& what) {
  const GlObject vertex_shader = compile(gl, GL_VERTEX_SHADER, vertex, "vertex, " + what);
  const GlObject fragment_shader = compile(gl, GL_FRAGMENT_SHADER, fragment, what);
  GlObject program = make_program(gl);
  gl.AttachShader(program.id(), vertex_shader.id());
  gl.AttachShader(program.id(), fragment_shader.id());
  for (GLuint slot = 0; slot < attributes.size(); ++slot) gl.BindAttribLocation(program.id(), slot, attributes[slot]);
  gl.LinkProgram(program.id());
  GLint ok = GL_FALSE;
  gl.GetProgramiv(program.id(), GL_LINK_STATUS, &ok);
  if (ok == GL_TRUE) return program;
  std::string log(16384, '\0');
  GLsizei length = 0;
  gl.GetProgramInfoLog(program.id(), static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  refuse("a program does not link (" + what + ")", log, fragment);
}

Program::Program(const GlApi& gl, const Features& features, bool fragment_highp) : gl_(&gl) {
  const auto start = std::chrono::steady_clock::now();
  // Slots as attribute_position and its neighbours say.
  program_ = link_program(gl, vertex_source(features), fragment_source(features, fragment_highp),
                          {"a_position", "a_normal", "a_irradiance", "a_visible0", "a_visible1", "a_visible2"},
                          features.text());
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
    uniforms_[text] = {gl.GetUniformLocation(program_.id(), text.c_str()), size};
    if (type != GL_SAMPLER_2D) uniform_vectors_ += size * (type == GL_FLOAT_MAT4 ? 4 : 1);
  }
  compile_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

GLint Program::location(std::string_view uniform) const {
  const auto found = uniforms_.find(uniform);
  return found == uniforms_.end() ? -1 : found->second.location;
}

int Program::size(std::string_view uniform) const {
  const auto found = uniforms_.find(uniform);
  return found == uniforms_.end() ? 0 : found->second.size;
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
