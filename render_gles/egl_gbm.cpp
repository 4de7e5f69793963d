#include "render_gles/egl_gbm.hpp"

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <gbm.h>

#include <algorithm>
#include <array>

#include "render_gles/egl_tools.hpp"

namespace lackwerk::gles {
namespace {

constexpr const char* platform = "EGL_KHR_platform_gbm";

class EglGbmContext final : public GbmContext {
 public:
  explicit EglGbmContext(EGLDisplay display) : display_(display) {}
  ~EglGbmContext() override {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (surface_ != EGL_NO_SURFACE) eglDestroySurface(display_, surface_);
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    eglTerminate(display_);  // it belongs to the GBM device, which is about to go
  }

  Result<void> open(const ContextSettings& settings) {
    EGLint major = 0, minor = 0;
    if (eglInitialize(display_, &major, &minor) == EGL_FALSE)
      return fail("EGL", platform, "eglInitialize: " + egl_error_text(), "is there a driver for this card?");
    if (eglBindAPI(EGL_OPENGL_ES_API) == EGL_FALSE) return fail("EGL", platform, "no OpenGL ES: " + egl_error_text());
    if (!has_word(eglQueryString(display_, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
      return fail("EGL", platform, "no EGL_KHR_surfaceless_context, which waiting for a monitor needs");
    if (auto chosen = choose_config(); !chosen) return chosen;
    const std::array<EGLint, 3> attributes = {EGL_CONTEXT_CLIENT_VERSION, 2, EGL_NONE};
    context_ = eglCreateContext(display_, config_, EGL_NO_CONTEXT, attributes.data());
    if (context_ == EGL_NO_CONTEXT) return fail("EGL", platform, "eglCreateContext: " + egl_error_text());
    if (auto current = make_current(); !current) return current;
    auto api = GlApi::load(egl_get_proc(), std::string("EGL ") + platform);
    if (!api) return tl::unexpected(api.error());
    gl_ = *api;
    info_ = describe_context(gl_, platform, settings.core_es2);
    return {};
  }

  Result<void> make_current() override {
    // Letting go first: see EglContext of egl_surfaceless.cpp.
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (eglMakeCurrent(display_, surface_, surface_, context_) == EGL_FALSE)
      return fail("EGL", "eglMakeCurrent", egl_error_text(), "is the context current on another thread?");
    return {};
  }
  [[nodiscard]] Backend backend() const override { return Backend::egl_gbm; }
  [[nodiscard]] std::uint32_t gbm_format() const override { return format_; }

  Result<void> set_window(gbm_surface* surface) override {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (surface_ != EGL_NO_SURFACE) eglDestroySurface(display_, surface_);
    surface_ = EGL_NO_SURFACE;
    std::string why;
    if (surface != nullptr) {
      surface_ = eglCreatePlatformWindowSurface(display_, config_, surface, nullptr);
      if (surface_ == EGL_NO_SURFACE) why = egl_error_text();
    }
    if (auto current = make_current(); !current) return current;
    if (!why.empty()) return fail("EGL", platform, "no window surface: " + why);
    return {};
  }

  Result<void> swap() override {
    if (eglSwapBuffers(display_, surface_) == EGL_TRUE) return {};
    return fail("EGL", platform, "eglSwapBuffers: " + egl_error_text());
  }

 private:
  /// A configuration whose pixels are XRGB8888 (ARGB8888 has the same bytes: the display engine takes it as XRGB8888).
  Result<void> choose_config() {
    const std::array<EGLint, 11> wanted = {EGL_SURFACE_TYPE,
                                           EGL_WINDOW_BIT,
                                           EGL_RENDERABLE_TYPE,
                                           EGL_OPENGL_ES2_BIT,
                                           EGL_RED_SIZE,
                                           8,
                                           EGL_GREEN_SIZE,
                                           8,
                                           EGL_BLUE_SIZE,
                                           8,
                                           EGL_NONE};
    std::array<EGLConfig, 128> configs{};
    EGLint count = 0;
    if (eglChooseConfig(display_, wanted.data(), configs.data(), static_cast<EGLint>(configs.size()), &count) ==
        EGL_FALSE)
      return fail("EGL", platform, "eglChooseConfig: " + egl_error_text());
    for (const std::uint32_t format : {std::uint32_t{GBM_FORMAT_XRGB8888}, std::uint32_t{GBM_FORMAT_ARGB8888}})
      for (EGLint k = 0; k < std::min(count, static_cast<EGLint>(configs.size())); ++k) {
        EGLint visual = 0;
        EGLConfig config = configs[static_cast<std::size_t>(k)];
        if (eglGetConfigAttrib(display_, config, EGL_NATIVE_VISUAL_ID, &visual) == EGL_FALSE) continue;
        if (static_cast<std::uint32_t>(visual) != format) continue;
        config_ = config;
        format_ = format;
        return {};
      }
    return fail("EGL", platform, "no configuration with 8 bits a channel for OpenGL ES 2.0 and a display engine");
  }

  EGLDisplay display_;
  EGLConfig config_ = nullptr;
  EGLContext context_ = EGL_NO_CONTEXT;
  EGLSurface surface_ = EGL_NO_SURFACE;
  std::uint32_t format_ = 0;
};

}  // namespace

Result<std::unique_ptr<GbmContext>> GbmContext::create(gbm_device* device, const ContextSettings& settings) {
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!has_word(client, platform) && !has_word(client, "EGL_MESA_platform_gbm"))
    return fail("EGL", platform, "this EGL knows no GBM", "install Mesa's libegl1");
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_GBM_KHR, device, nullptr);
  if (display == EGL_NO_DISPLAY) return fail("EGL", platform, "no display: " + egl_error_text());
  auto context = std::make_unique<EglGbmContext>(display);
  if (auto opened = context->open(settings); !opened) return tl::unexpected(opened.error());
  return context;
}

}  // namespace lackwerk::gles
