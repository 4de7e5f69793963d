#include "render_gles/shader_texts.hpp"

#include "core/check.hpp"

namespace lackwerk::gles {
namespace {

struct ShaderText {
  std::string_view name;
  std::string_view text;
};

constexpr ShaderText shader_texts[] = {
#include "render_gles/shader_texts.inc"
};

}  // namespace

std::string_view shader_text(std::string_view name) {
  for (const ShaderText& entry : shader_texts)
    if (entry.name == name) return entry.text;
  check_equal(name, std::string_view("an embedded shader file"), "shader text");
  return {};
}

}  // namespace lackwerk::gles
