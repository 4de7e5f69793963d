// What every EGL context needs of EGL: its errors by name, and its lists of extensions.
//
// Why it exists: contexts without a window and on GBM are made in two files. EGL's own types stay out of headers that
// others read. Any thread (EGL's error is the calling thread's).
#pragma once

#include <string>
#include <string_view>

#include "render_gles/gl_api.hpp"

namespace lackwerk::gles {

/// EGL's last error by its name: the numbers mean nothing to a reader of a log.
[[nodiscard]] std::string egl_error_text();

/// Extension lists are words separated by blanks. `list` may be null.
[[nodiscard]] bool has_word(const char* list, std::string_view word);

/// eglGetProcAddress.
[[nodiscard]] GetProc egl_get_proc();

}  // namespace lackwerk::gles
