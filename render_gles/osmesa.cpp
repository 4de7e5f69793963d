// OSMesa: Mesa's off-screen software rasteriser, loaded at run time because Mesa dropped it in 25.1.
// Its context is desktop OpenGL in the compatibility profile; ARB_ES2_compatibility lets it compile #version 100.
#include <dlfcn.h>

#include <array>

#include "render_gles/context.hpp"

namespace lackwerk::gles {
namespace {

// From osmesa.h, which a build machine need not have: the interface has been frozen since Mesa 11.2.
struct OsMesaHandle;
using OsMesaContextPtr = OsMesaHandle*;
using OsMesaProc = void (*)();
constexpr int osmesa_format = 0x22;
constexpr int osmesa_profile = 0x33;
constexpr int osmesa_compat_profile = 0x35;

struct OsMesaApi {
  OsMesaContextPtr (*create_attribs)(const int*, OsMesaContextPtr) = nullptr;
  void (*destroy)(OsMesaContextPtr) = nullptr;
  GLboolean (*make_current)(OsMesaContextPtr, void*, GLenum, GLsizei, GLsizei) = nullptr;
  OsMesaContextPtr (*get_current)() = nullptr;
  OsMesaProc (*get_proc)(const char*) = nullptr;
};

class OsMesaContext final : public Context {
 public:
  explicit OsMesaContext(const OsMesaApi& api) : api_(api) {}
  ~OsMesaContext() override {
    if (context_ == nullptr) return;
    if (api_.get_current() == context_) api_.make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
    api_.destroy(context_);
  }

  Result<void> make_current() override {
    if (api_.make_current(context_, buffer_.data(), GL_UNSIGNED_BYTE, edge, edge) == GL_FALSE)
      return fail("OSMesa", "OSMesaMakeCurrent", "refused", "is the context current on another thread?");
    return {};
  }
  [[nodiscard]] Backend backend() const override { return Backend::osmesa; }

  Result<void> open(const std::string& library, CoreEs2 core_es2) {
    const std::array<int, 6> attributes = {osmesa_format, GL_RGBA, osmesa_profile, osmesa_compat_profile, 0, 0};
    context_ = api_.create_attribs(attributes.data(), nullptr);
    if (context_ == nullptr) return fail("OSMesa", library, "OSMesaCreateContextAttribs failed");
    if (auto current = make_current(); !current) return current;
    const auto get = api_.get_proc;
    auto api = GlApi::load([get](const char* name) { return reinterpret_cast<void*>(get(name)); }, "OSMesa " + library);
    if (!api) return tl::unexpected(api.error());
    gl_ = *api;
    info_ = describe_context(gl_, library);
    if (!info_.has_extension("GL_ARB_ES2_compatibility"))
      return fail("OSMesa", library, "no ARB_ES2_compatibility: " + info_.version + " cannot compile ES shaders",
                  "install a newer libosmesa6, or use the egl backend");
    if (core_es2 != CoreEs2::off) info_ = describe_context(gl_, library, core_es2);
    return {};
  }

 private:
  static constexpr GLsizei edge = 16;  ///< of its own picture, which nobody looks at: drawing goes to our framebuffer
  OsMesaApi api_;
  OsMesaContextPtr context_ = nullptr;
  std::array<unsigned char, edge * edge * 4> buffer_{};
};

}  // namespace

Result<std::unique_ptr<Context>> create_osmesa(const ContextSettings& settings) {
  void* library = nullptr;
  std::string name, reasons;
  for (const char* candidate : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}) {
    // Never closed: its LLVM registers exit handlers, which must find their code.
    library = dlopen(candidate, RTLD_NOW | RTLD_LOCAL);
    if (library != nullptr) {
      name = candidate;
      break;
    }
    const char* why = dlerror();
    reasons += (reasons.empty() ? "" : "; ") + std::string(why == nullptr ? candidate : why);
  }
  if (library == nullptr)
    return fail("OSMesa", "", reasons, "install libosmesa6 (Mesa before 25.1), or use the egl backend");

  OsMesaApi api;
  const auto find = [&](auto& slot, const char* symbol) {
    slot = reinterpret_cast<std::remove_reference_t<decltype(slot)>>(dlsym(library, symbol));
    return slot != nullptr;
  };
  if (!find(api.create_attribs, "OSMesaCreateContextAttribs") || !find(api.destroy, "OSMesaDestroyContext") ||
      !find(api.make_current, "OSMesaMakeCurrent") || !find(api.get_current, "OSMesaGetCurrentContext") ||
      !find(api.get_proc, "OSMesaGetProcAddress"))
    return fail("OSMesa", name, "not an OSMesa of version 11.2 or later", "install libosmesa6");
  auto context = std::make_unique<OsMesaContext>(api);
  if (auto opened = context->open(name, settings.core_es2); !opened) return tl::unexpected(opened.error());
  return context;
}

}  // namespace lackwerk::gles
