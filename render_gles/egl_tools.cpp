#include "render_gles/egl_tools.hpp"

#define EGL_NO_X11
#include <EGL/egl.h>

#include <array>

namespace lackwerk::gles {

std::string egl_error_text() {
  const EGLint code = eglGetError();
  static constexpr std::array<const char*, 15> names = {
      "EGL_SUCCESS",       "EGL_NOT_INITIALIZED", "EGL_BAD_ACCESS",        "EGL_BAD_ALLOC",
      "EGL_BAD_ATTRIBUTE", "EGL_BAD_CONFIG",      "EGL_BAD_CONTEXT",       "EGL_BAD_CURRENT_SURFACE",
      "EGL_BAD_DISPLAY",   "EGL_BAD_MATCH",       "EGL_BAD_NATIVE_PIXMAP", "EGL_BAD_NATIVE_WINDOW",
      "EGL_BAD_PARAMETER", "EGL_BAD_SURFACE",     "EGL_CONTEXT_LOST"};
  const EGLint index = code - EGL_SUCCESS;
  if (index >= 0 && index < static_cast<EGLint>(names.size())) return names[static_cast<std::size_t>(index)];
  return "EGL error " + std::to_string(code);
}

bool has_word(const char* list, std::string_view word) {
  if (list == nullptr) return false;
  const std::string padded = " " + std::string(list) + " ";
  return padded.find(" " + std::string(word) + " ") != std::string::npos;
}

GetProc egl_get_proc() {
  return [](const char* name) { return reinterpret_cast<void*>(eglGetProcAddress(name)); };
}

}  // namespace lackwerk::gles
