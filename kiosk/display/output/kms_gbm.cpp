// A gbm_surface is used rather than buffers of our own behind EGLImages: it is the way every driver is tested with, and
// it works on Mesa's software rasteriser for cards without a GPU (kms_swrast) as well.
#include "kiosk/display/output/kms_gbm.hpp"

#include <gbm.h>

#include <cerrno>
#include <optional>
#include <vector>

#include "kiosk/display/output/present_pass.hpp"
#include "render_gles/egl_gbm.hpp"

namespace lackwerk::kiosk {
namespace {

struct GbmFree {
  void operator()(gbm_device* object) const { gbm_device_destroy(object); }
  void operator()(gbm_surface* object) const { gbm_surface_destroy(object); }
};

/// Hangs on a buffer as its user data: GBM calls back when the buffer goes.
struct BufferMark {
  KmsDevice* device;
  DrmId framebuffer;
};
void forget_mark(gbm_bo* /*buffer*/, void* data) {
  const std::unique_ptr<BufferMark> mark(static_cast<BufferMark*>(data));
  mark->device->remove_framebuffer(mark->framebuffer);
}

class GbmSurface final : public KmsSurface {
 public:
  explicit GbmSurface(KmsDevice& device) : device_(device) {}
  ~GbmSurface() override {
    if (!context_) return;
    (void)context_->make_current();
    pass_.reset();
    drop_window();
  }

  Result<void> open(const gles::ContextSettings& settings) {
    gbm_.reset(gbm_create_device(device_.fd()));
    if (!gbm_)
      return fail(device_.card().path, "GBM", "no buffers from driver " + device_.card().driver,
                  "install its Mesa driver");
    auto context = gles::GbmContext::create(gbm_.get(), settings);
    if (!context) return tl::unexpected(context.error());
    context_ = std::move(*context);
    pass_.emplace(*context_);
    return {};
  }

  [[nodiscard]] Platform platform() const override { return Platform::kms; }
  [[nodiscard]] gles::Context& context() override { return *context_; }
  void set_look(const Look& look) override {
    pass_->set(look.rotation, look.profile, look.test_pattern, look.gamut_warning);
  }
  void set_brightness(float brightness) override { pass_->set_brightness(brightness); }

  Result<void> resize(std::array<int, 2> panel_px) override {
    drop_window();
    const auto width = static_cast<std::uint32_t>(panel_px[0]), height = static_cast<std::uint32_t>(panel_px[1]);
    window_.reset(gbm_surface_create(gbm_.get(), width, height, context_->gbm_format(),
                                     GBM_BO_USE_SCANOUT | GBM_BO_USE_RENDERING));
    if (!window_)
      return fail(device_.card().path, "GBM",
                  "no buffers of " + std::to_string(width) + "x" + std::to_string(height) + ": " + errno_text(errno));
    if (auto set = context_->set_window(window_.get()); !set) {
      window_.reset();
      return set;
    }
    panel_px_ = panel_px;
    return {};
  }

  Result<DrmId> draw(const gles::Framebuffer& picture) override {
    if (!window_) return fail(device_.card().path, "GBM", "no buffers");
    if (gbm_surface_has_free_buffers(window_.get()) == 0) return DrmId{0};
    pass_->draw(picture, panel_px_, 0, false);
    // A GPU's buffer carries a fence that the display engine waits for; what the CPU draws carries none.
    if (context_->info().software()) context_->gl().Finish();
    if (auto swapped = context_->swap(); !swapped) return tl::unexpected(swapped.error());
    gbm_bo* buffer = gbm_surface_lock_front_buffer(window_.get());
    if (buffer == nullptr) return fail(device_.card().path, "GBM", "no front buffer: " + errno_text(errno));
    auto framebuffer = framebuffer_of(buffer);
    if (!framebuffer) {
      gbm_surface_release_buffer(window_.get(), buffer);
      return framebuffer;
    }
    held_.push_back({buffer, *framebuffer});
    return framebuffer;
  }

  void keep(DrmId shown, DrmId queued) override {
    for (std::size_t k = 0; k < held_.size();) {
      if (held_[k].framebuffer == shown || held_[k].framebuffer == queued) {
        ++k;
        continue;
      }
      gbm_surface_release_buffer(window_.get(), held_[k].buffer);
      held_.erase(held_.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }

 private:
  struct Held {
    gbm_bo* buffer;
    DrmId framebuffer;
  };

  Result<DrmId> framebuffer_of(gbm_bo* buffer) {
    if (const void* data = gbm_bo_get_user_data(buffer); data != nullptr)
      return static_cast<const BufferMark*>(data)->framebuffer;
    DrmFramebuffer what;
    what.size_px = {static_cast<int>(gbm_bo_get_width(buffer)), static_cast<int>(gbm_bo_get_height(buffer))};
    what.handle = gbm_bo_get_handle(buffer).u32;
    what.pitch = gbm_bo_get_stride(buffer);
    what.offset = gbm_bo_get_offset(buffer, 0);
    const auto made = device_.add_framebuffer(what);
    if (!made)
      return fail(device_.card().path, "framebuffer", "refused for a buffer of the GPU: " + errno_text(made.error()));
    gbm_bo_set_user_data(buffer, new BufferMark{&device_, *made}, forget_mark);
    return *made;
  }

  void drop_window() {
    keep(0, 0);
    // Buffers go with EGL's surface, and their framebuffers with them.
    if (auto set = context_->set_window(nullptr); !set) return;
    window_.reset();
  }

  KmsDevice& device_;
  std::unique_ptr<gbm_device, GbmFree> gbm_;
  std::unique_ptr<gles::GbmContext> context_;
  std::optional<PresentPass> pass_;
  std::unique_ptr<gbm_surface, GbmFree> window_;
  std::vector<Held> held_;
  std::array<int, 2> panel_px_{0, 0};
};

}  // namespace

Result<std::unique_ptr<KmsSurface>> make_gbm_surface(KmsDevice& device, const gles::ContextSettings& settings) {
  auto surface = std::make_unique<GbmSurface>(device);
  if (auto opened = surface->open(settings); !opened) return tl::unexpected(opened.error());
  return surface;
}

}  // namespace lackwerk::kiosk
