#include "kiosk/display/output/kms_dumb.hpp"

#include <optional>
#include <utility>

#include "kiosk/display/output/panel_target.hpp"
#include "kiosk/display/output/present_pass.hpp"

namespace lackwerk::kiosk {
namespace {

/// A dumb buffer, mapped, with its framebuffer.
class DumbBuffer {
 public:
  DumbBuffer() = default;
  DumbBuffer(DumbBuffer&& other) noexcept { swap(other); }
  DumbBuffer& operator=(DumbBuffer&& other) noexcept {
    swap(other);
    return *this;
  }
  DumbBuffer(const DumbBuffer&) = delete;
  DumbBuffer& operator=(const DumbBuffer&) = delete;
  ~DumbBuffer() {
    if (framebuffer_ != 0) device_->remove_framebuffer(framebuffer_);
    if (mapped_ != nullptr) device_->unmap_dumb(dumb_, mapped_);
    if (dumb_.handle != 0) device_->destroy_dumb(dumb_);
  }

  static DrmResult<DumbBuffer> create(KmsDevice& device, std::array<int, 2> size_px) {
    DumbBuffer out;
    out.device_ = &device;
    const auto dumb = device.create_dumb(size_px);
    if (!dumb) return tl::unexpected<int>(dumb.error());
    out.dumb_ = *dumb;
    const auto mapped = device.map_dumb(out.dumb_);
    if (!mapped) return tl::unexpected<int>(mapped.error());
    out.mapped_ = *mapped;
    const auto framebuffer = device.add_framebuffer({size_px, dumb->handle, dumb->pitch, 0});
    if (!framebuffer) return tl::unexpected<int>(framebuffer.error());
    out.framebuffer_ = *framebuffer;
    return out;
  }

  [[nodiscard]] DrmId framebuffer() const { return framebuffer_; }
  [[nodiscard]] std::uint32_t pitch() const { return dumb_.pitch; }
  [[nodiscard]] std::uint64_t bytes() const { return dumb_.bytes; }
  [[nodiscard]] std::uint8_t* data() { return mapped_; }

 private:
  void swap(DumbBuffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(dumb_, other.dumb_);
    std::swap(mapped_, other.mapped_);
    std::swap(framebuffer_, other.framebuffer_);
  }
  KmsDevice* device_ = nullptr;
  DrmDumb dumb_;
  std::uint8_t* mapped_ = nullptr;
  DrmId framebuffer_ = 0;
};

class DumbSurface final : public KmsSurface {
 public:
  DumbSurface(KmsDevice& device, std::unique_ptr<gles::Context> context)
      : device_(device), context_(std::move(context)), pass_(std::in_place, *context_) {}
  ~DumbSurface() override {
    (void)context_->make_current();
    target_.reset();
    pass_.reset();
  }

  [[nodiscard]] Platform platform() const override { return Platform::dumb; }
  [[nodiscard]] gles::Context& context() override { return *context_; }
  void set_look(const Look& look) override {
    pass_->set(look.rotation, look.profile, look.test_pattern, look.gamut_warning);
  }
  void set_brightness(float brightness) override { pass_->set_brightness(brightness); }

  Result<void> resize(std::array<int, 2> panel_px) override {
    target_.reset();
    buffers_ = {};
    shown_ = queued_ = 0;
    for (DumbBuffer& buffer : buffers_) {
      auto made = DumbBuffer::create(device_, panel_px);
      if (!made)
        return fail(device_.card().path, "dumb buffer",
                    std::to_string(panel_px[0]) + "x" + std::to_string(panel_px[1]) + ": " + errno_text(made.error()));
      buffer = std::move(*made);
    }
    // The target is as wide as the buffer's rows are long: they are then read in one call, padding and all.
    const int row_px = static_cast<int>(buffers_[0].pitch() / 4);
    const bool rows_fit =
        buffers_[0].pitch() % 4 == 0 && row_px >= panel_px[0] && buffers_[0].pitch() == buffers_[1].pitch() &&
        buffers_[0].bytes() >= std::uint64_t{buffers_[0].pitch()} * static_cast<unsigned>(panel_px[1]);
    if (!rows_fit) return fail(device_.card().path, "dumb buffer", "rows of odd length", "use the fbdev platform");
    auto target = PanelTarget::create(*context_, {row_px, panel_px[1]});
    if (!target) return tl::unexpected(target.error());
    target_ = std::move(*target);
    panel_px_ = panel_px;
    return {};
  }

  Result<DrmId> draw(const gles::Framebuffer& picture) override {
    if (!target_) return fail(device_.card().path, "dumb buffer", "none");
    for (DumbBuffer& buffer : buffers_) {
      if (buffer.framebuffer() == shown_ || buffer.framebuffer() == queued_) continue;
      pass_->draw(picture, panel_px_, target_->framebuffer(), true, ChannelOrder::bgr);
      target_->read(buffer.data());
      return buffer.framebuffer();
    }
    return DrmId{0};
  }

  void keep(DrmId shown, DrmId queued) override {
    shown_ = shown;
    queued_ = queued;
  }

 private:
  KmsDevice& device_;
  std::unique_ptr<gles::Context> context_;
  std::optional<PresentPass> pass_;
  std::optional<PanelTarget> target_;
  std::array<DumbBuffer, 2> buffers_;
  std::array<int, 2> panel_px_{0, 0};
  DrmId shown_ = 0, queued_ = 0;
};

}  // namespace

Result<std::unique_ptr<gles::Context>> make_offscreen_context(const gles::ContextSettings& settings, Log& log) {
  auto egl = gles::create_context(gles::Backend::egl_surfaceless, settings);
  if (!egl) log.warning("EGL is not used: " + egl.error().line());
  auto context = egl ? std::move(egl) : gles::create_context(gles::Backend::osmesa, settings);
  if (context) log.info("drawing by " + (*context)->info().renderer + " (" + (*context)->info().platform + ")");
  return context;
}

Result<std::unique_ptr<KmsSurface>> make_dumb_surface(KmsDevice& device, const gles::ContextSettings& settings,
                                                      Log& log) {
  if (!device.card().dumb)
    return fail(device.card().path, "dumb buffer", "driver " + device.card().driver + " has none",
                "use the fbdev platform");
  auto context = make_offscreen_context(settings, log);
  if (!context) return tl::unexpected(context.error());
  return std::make_unique<DumbSurface>(device, std::move(*context));
}

}  // namespace lackwerk::kiosk
