#include "render_gles/context.hpp"

#include <algorithm>
#include <sstream>

namespace lackwerk::gles {
namespace {

std::string text_of(const GlApi& gl, GLenum name) {
  const GLubyte* text = gl.GetString(name);
  return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}

int integer_of(const GlApi& gl, GLenum name) {
  GLint value = 0;
  gl.GetIntegerv(name, &value);
  return value;
}

/// Whatever looks at the result finds no more than this; nothing else knows of the mode.
void limit_to_core(ContextInfo& info, CoreEs2 core_es2) {
  info.platform += ", limited to core ES 2.0";
  info.extensions.clear();
  info.desktop = false;
  info.fragment_highp = info.fragment_highp && core_es2 == CoreEs2::highp;
  info.max_texture_units = std::min(info.max_texture_units, 8);
  info.max_vertex_attributes = std::min(info.max_vertex_attributes, 8);
  info.max_varying_vectors = std::min(info.max_varying_vectors, 8);
  info.max_vertex_uniforms = std::min(info.max_vertex_uniforms, 128);
  info.max_fragment_uniforms = std::min(info.max_fragment_uniforms, 16);
}

}  // namespace

std::optional<CoreEs2> parse_core_es2(std::string_view word) {
  if (word == "highp") return CoreEs2::highp;
  if (word == "mediump") return CoreEs2::mediump;
  return std::nullopt;
}

const char* backend_name(Backend backend) { return backend == Backend::osmesa ? "osmesa" : "egl"; }

bool ContextInfo::has_extension(std::string_view name) const {
  return std::find(extensions.begin(), extensions.end(), name) != extensions.end();
}

bool ContextInfo::software() const {
  return renderer.find("llvmpipe") != std::string::npos || renderer.find("softpipe") != std::string::npos ||
         renderer.find("swrast") != std::string::npos || renderer.find("Software Rasterizer") != std::string::npos;
}

std::vector<std::string> ContextInfo::lines() const {
  const auto number = [](const char* name, int value) { return std::string(name) + ": " + std::to_string(value); };
  return {
      "platform: " + platform,
      "vendor: " + vendor,
      "renderer: " + renderer + (software() ? " (software)" : ""),
      "version: " + version,
      "shading language: " + shading_language,
      std::string("fragment floats: ") + (fragment_highp ? "32 bits (highp)" : "16 bits (mediump only)"),
      number("largest texture edge", max_texture_size),
      number("largest renderbuffer edge", max_renderbuffer_size),
      number("fragment texture units", max_texture_units),
      number("vertex attributes", max_vertex_attributes),
      number("varying vectors", max_varying_vectors),
      number("vertex uniform vectors", max_vertex_uniforms),
      number("fragment uniform vectors", max_fragment_uniforms),
  };
}

ContextInfo describe_context(const GlApi& gl, std::string platform, CoreEs2 core_es2) {
  ContextInfo info;
  info.platform = std::move(platform);
  info.vendor = text_of(gl, GL_VENDOR);
  info.renderer = text_of(gl, GL_RENDERER);
  info.version = text_of(gl, GL_VERSION);
  info.shading_language = text_of(gl, GL_SHADING_LANGUAGE_VERSION);
  info.desktop = info.version.rfind("OpenGL ES", 0) != 0;
  std::istringstream words(text_of(gl, GL_EXTENSIONS));
  for (std::string word; words >> word;) info.extensions.push_back(word);

  GLint range[2] = {0, 0};
  GLint precision = 0;
  gl.GetShaderPrecisionFormat(GL_FRAGMENT_SHADER, GL_HIGH_FLOAT, range, &precision);
  info.fragment_highp = precision >= 16;  // ES 2.0.25, 4.5.2: highp, where offered, has at least 16 bits of mantissa
  info.max_texture_size = integer_of(gl, GL_MAX_TEXTURE_SIZE);
  info.max_renderbuffer_size = integer_of(gl, GL_MAX_RENDERBUFFER_SIZE);
  info.max_texture_units = integer_of(gl, GL_MAX_TEXTURE_IMAGE_UNITS);
  info.max_vertex_attributes = integer_of(gl, GL_MAX_VERTEX_ATTRIBS);
  info.max_varying_vectors = integer_of(gl, GL_MAX_VARYING_VECTORS);
  info.max_vertex_uniforms = integer_of(gl, GL_MAX_VERTEX_UNIFORM_VECTORS);
  info.max_fragment_uniforms = integer_of(gl, GL_MAX_FRAGMENT_UNIFORM_VECTORS);
  while (gl.GetError() != GL_NO_ERROR) {
  }  // an unknown limit stays 0 and must not look like an error of the next caller
  if (core_es2 != CoreEs2::off) limit_to_core(info, core_es2);
  return info;
}

int usable_lights(const ContextInfo& info) { return std::clamp((info.max_fragment_uniforms - 14) / 2, 0, 4); }
int usable_sparkle_lights(const ContextInfo& info, int directional_lights) {
  return std::clamp((info.max_fragment_uniforms - 14) / 2 - directional_lights, 0, 4);
}

Result<std::unique_ptr<Context>> create_context(Backend backend, const ContextSettings& settings) {
  if (backend == Backend::egl_gbm)
    return fail("EGL", "GBM", "needs a graphics card", "open an output of the kms platform", ErrorKind::usage);
  return backend == Backend::osmesa ? create_osmesa(settings) : create_egl_surfaceless(settings);
}

}  // namespace lackwerk::gles
