// EGL without a window. Three ways to a display are tried in order: Mesa's surfaceless platform, each device of
// EGL_EXT_platform_device (how proprietary drivers offer a GPU without a display server), and the default display.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>

#include "render_gles/context.hpp"
#include "render_gles/egl_tools.hpp"

namespace lackwerk::gles {
namespace {

struct Candidate {
  std::string name;
  EGLDisplay display = EGL_NO_DISPLAY;
};

class EglContext final : public Context {
 public:
  explicit EglContext(EGLDisplay display) : display_(display) {}
  ~EglContext() override {
    if (context_ != EGL_NO_CONTEXT && eglGetCurrentContext() == context_)
      eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (surface_ != EGL_NO_SURFACE) eglDestroySurface(display_, surface_);
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    // The display stays initialised: other contexts of the process may share it.
  }

  Result<void> make_current() override {
    // Letting go first: EGL skips the call when it believes this context is still current, and cannot know that
    // OSMesa has taken the thread meanwhile.
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (eglMakeCurrent(display_, surface_, surface_, context_) == EGL_FALSE)
      return fail("EGL", "eglMakeCurrent", egl_error_text(), "is the context current on another thread?");
    return {};
  }
  [[nodiscard]] Backend backend() const override { return Backend::egl_surfaceless; }

  /// Initialises the display, makes the context current and loads its functions.
  Result<void> open(const std::string& platform, CoreEs2 core_es2) {
    EGLint major = 0, minor = 0;
    if (eglInitialize(display_, &major, &minor) == EGL_FALSE)
      return fail("EGL", platform, "eglInitialize: " + egl_error_text());
    if (eglBindAPI(EGL_OPENGL_ES_API) == EGL_FALSE) return fail("EGL", platform, "no OpenGL ES: " + egl_error_text());
    const char* extensions = eglQueryString(display_, EGL_EXTENSIONS);
    const bool surfaceless = has_word(extensions, "EGL_KHR_surfaceless_context");

    const std::array<EGLint, 5> wanted = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES2_BIT, EGL_SURFACE_TYPE,
                                          surfaceless ? EGL_DONT_CARE : EGL_PBUFFER_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display_, wanted.data(), &config, 1, &count) == EGL_FALSE || count < 1)
      return fail("EGL", platform, "no configuration for OpenGL ES 2.0: " + egl_error_text());
    const std::array<EGLint, 3> attributes = {EGL_CONTEXT_CLIENT_VERSION, 2, EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, attributes.data());
    if (context_ == EGL_NO_CONTEXT) return fail("EGL", platform, "eglCreateContext: " + egl_error_text());
    if (!surfaceless) {
      const std::array<EGLint, 5> size = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
      surface_ = eglCreatePbufferSurface(display_, config, size.data());
      if (surface_ == EGL_NO_SURFACE)
        return fail("EGL", platform, "neither surfaceless contexts nor pbuffers: " + egl_error_text());
    }
    if (auto current = make_current(); !current) return current;
    auto api = GlApi::load(egl_get_proc(), "EGL " + platform);
    if (!api) return tl::unexpected(api.error());
    gl_ = *api;
    info_ = describe_context(gl_, platform + (surfaceless ? "" : " (pbuffer)"), core_es2);
    return {};
  }

 private:
  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
  EGLSurface surface_ = EGL_NO_SURFACE;
};

/// Every display worth trying, best first.
std::vector<Candidate> candidates() {
  std::vector<Candidate> list;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (has_word(client, "EGL_MESA_platform_surfaceless"))
    list.push_back({"EGL_MESA_platform_surfaceless",
                    eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
  if (has_word(client, "EGL_EXT_platform_device") || has_word(client, "EGL_EXT_platform_base")) {
    const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    std::array<EGLDeviceEXT, 8> devices{};
    EGLint count = 0;
    if (query != nullptr && query(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_TRUE)
      for (EGLint k = 0; k < count; ++k)
        list.push_back({"EGL_EXT_platform_device " + std::to_string(k),
                        eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(k)], nullptr)});
  }
  list.push_back({"default display", eglGetDisplay(EGL_DEFAULT_DISPLAY)});
  return list;
}

}  // namespace

Result<std::unique_ptr<Context>> create_egl_surfaceless(const ContextSettings& settings) {
  std::unique_ptr<EglContext> fallback;
  std::string reasons;
  for (const Candidate& candidate : candidates()) {
    if (candidate.display == EGL_NO_DISPLAY) {
      reasons += (reasons.empty() ? "" : "; ") + candidate.name + ": no display";
      continue;
    }
    auto context = std::make_unique<EglContext>(candidate.display);
    if (auto opened = context->open(candidate.name, settings.core_es2); !opened) {
      reasons += (reasons.empty() ? "" : "; ") + candidate.name + ": " + opened.error().what;
      continue;
    }
    if (!settings.prefer_hardware || !context->info().software()) return context;
    if (!fallback) fallback = std::move(context);
  }
  if (fallback) {
    if (auto current = fallback->make_current(); !current) return tl::unexpected(current.error());
    return fallback;
  }
  return fail("EGL", "", reasons.empty() ? "no display" : reasons,
              "install a driver with OpenGL ES 2.0 (Mesa: libegl1 and libgl1-mesa-dri) or use the osmesa backend");
}

}  // namespace lackwerk::gles
