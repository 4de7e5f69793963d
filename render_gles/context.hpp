// One OpenGL ES 2.0 context: EGL surfaceless, OSMesa, or EGL on a card's own buffers (egl_gbm.hpp).
//
// Why it exists: the kiosk, the tools and the tests draw into their own framebuffer objects, so all they need of a
// backend is "make current" and a function table. A context belongs to one thread at a time. Several may live in one
// process; before any GL call the right one must be current, and whatever was made on a context must be destroyed
// before it. EGL displays are shared by the process and stay initialised.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "render_gles/gl_api.hpp"

namespace lackwerk::gles {

enum class Backend {
  egl_surfaceless,  ///< EGL without a surface: a GPU where there is one, else Mesa's software rasteriser
  osmesa,           ///< libOSMesa, loaded at run time: always software
  egl_gbm,          ///< EGL on the buffers of a graphics card; made by GbmContext::create, which has the card
};

/// "egl" (both kinds) or "osmesa", as on the command line.
[[nodiscard]] const char* backend_name(Backend backend);

/// Whether a context hides what OpenGL ES 2.0 does not promise, so that a driver that offers more draws as the weakest
/// one would.
enum class CoreEs2 {
  off,      ///< everything the driver offers
  highp,    ///< no extensions, the promised minima; 32-bit floats in fragment shaders, which are optional but usual
  mediump,  ///< without those too. Really 16 bits on Mesa's llvmpipe where the CPU has F16C
};

/// "highp" or "mediump", as on the command line; null: another word.
[[nodiscard]] std::optional<CoreEs2> parse_core_es2(std::string_view word);

struct ContextSettings {
  /// EGL only. True: of all EGL platforms take the first that is not a software rasteriser, if any.
  /// False: take the first platform that works.
  bool prefer_hardware = true;
  CoreEs2 core_es2 = CoreEs2::off;
};

/// What the driver says about itself. Read once.
struct ContextInfo {
  std::string vendor;            ///< GL_VENDOR
  std::string renderer;          ///< GL_RENDERER
  std::string version;           ///< GL_VERSION
  std::string shading_language;  ///< GL_SHADING_LANGUAGE_VERSION
  std::string platform;          ///< how it was reached: "EGL_MESA_platform_surfaceless", "libOSMesa.so.8", ...
  std::vector<std::string> extensions;
  bool desktop = false;           ///< desktop OpenGL that compiles ES shaders (OSMesa) and may be used as such
  bool fragment_highp = false;    ///< fragment shaders have 32-bit floats
  int max_texture_size = 0;       ///< texels per edge
  int max_renderbuffer_size = 0;  ///< pixels per edge
  int max_texture_units = 0;      ///< in fragment shaders
  int max_vertex_attributes = 0;  ///<
  int max_varying_vectors = 0;    ///<
  int max_vertex_uniforms = 0;    ///< vec4
  int max_fragment_uniforms = 0;  ///< vec4

  [[nodiscard]] bool has_extension(std::string_view name) const;
  /// A rasteriser that runs on the CPU, by its name (llvmpipe, softpipe, swrast).
  [[nodiscard]] bool software() const;
  /// Lines for `--explain` and logs.
  [[nodiscard]] std::vector<std::string> lines() const;
};

/// Asks the current context. `platform` goes into the result as it is. `core_es2` makes it report no extensions and the
/// limits of ES 2.0.25, tables 6.18 to 6.20 (texture sizes stay: 64 texels an edge, the promise, hold no picture).
[[nodiscard]] ContextInfo describe_context(const GlApi& gl, std::string platform, CoreEs2 core_es2 = CoreEs2::off);

/// How many directional lights the shading texts may have on this driver, [0, 4]: everything else takes up to 14
/// fragment uniform vectors, a light takes two, and core ES 2.0 guarantees 16.
[[nodiscard]] int usable_lights(const ContextInfo& info);
/// How many lights of the environment may show single flakes beside that many directional ones, [0, 4].
[[nodiscard]] int usable_sparkle_lights(const ContextInfo& info, int directional_lights);

class Context {
 public:
  virtual ~Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Makes this the calling thread's context. Error: the backend refused (device lost, used by another thread).
  virtual Result<void> make_current() = 0;
  [[nodiscard]] virtual Backend backend() const = 0;

  /// Valid while the context lives; call its functions only while it is current.
  [[nodiscard]] const GlApi& gl() const { return gl_; }
  [[nodiscard]] const ContextInfo& info() const { return info_; }

 protected:
  Context() = default;
  GlApi gl_;
  ContextInfo info_;
};

/// Creates a context that needs no card and makes it current. Error: names every way that was tried and why it failed,
/// and what to install.
[[nodiscard]] Result<std::unique_ptr<Context>> create_context(Backend backend, const ContextSettings& settings = {});

/// The two makers behind create_context.
[[nodiscard]] Result<std::unique_ptr<Context>> create_egl_surfaceless(const ContextSettings& settings);
[[nodiscard]] Result<std::unique_ptr<Context>> create_osmesa(const ContextSettings& settings);

}  // namespace lackwerk::gles
