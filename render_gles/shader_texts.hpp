// The GLSL files of core/ and render_gles/, embedded at build time: the programs need no data folder.
// Constant data; any thread.
#pragma once

#include <string_view>

namespace lackwerk::gles {

/// The text of a shader file by its name ("paint_model.glsl"). Aborts for a name that was not embedded.
[[nodiscard]] std::string_view shader_text(std::string_view name);

}  // namespace lackwerk::gles
