#include "kiosk/display/output/headless_output.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "input/source.hpp"
#include "kiosk/display/output/panel_target.hpp"
#include "kiosk/display/output/present_pass.hpp"

namespace lackwerk::kiosk {
namespace {

class OffscreenOutput final : public HeadlessOutput {
 public:
  OffscreenOutput(Platform platform, std::unique_ptr<gles::Context> context, PanelTarget target,
                  const OutputSettings& settings)
      : platform_(platform),
        context_(std::move(context)),
        pass_(std::in_place, *context_),
        target_(std::move(target)),
        mode_{"headless", settings.size_px, 0.0, settings.rotation},
        test_pattern_(settings.test_pattern),
        gamut_warning_(settings.gamut_warning) {
    set_profile(settings.profile);
  }
  ~OffscreenOutput() override {
    (void)context_->make_current();
    target_.reset();
    pass_.reset();
  }

  [[nodiscard]] Platform platform() const override { return platform_; }
  [[nodiscard]] gles::Context& context() override { return *context_; }
  [[nodiscard]] OutputState state() const override { return OutputState::running; }
  [[nodiscard]] const OutputMode& mode() const override { return mode_; }
  [[nodiscard]] std::uint64_t revision() const override { return revision_; }
  [[nodiscard]] bool ready() const override { return power_; }
  [[nodiscard]] Result<Presented> present(const gles::Framebuffer& picture) override {
    if (!power_) return Presented::refused;
    pass_->draw(picture, mode_.panel_px, target_->framebuffer(), true);
    ++presented_;
    flipped_at_us_ = static_cast<std::uint64_t>(monotonic_ms() * 1000.0);
    return Presented::shown;
  }
  void add_descriptors(std::vector<int>& /*out*/) const override {}
  [[nodiscard]] Result<void> dispatch(double /*now_ms*/) override { return {}; }
  [[nodiscard]] double wake_at_ms() const override { return input::never_ms; }
  [[nodiscard]] std::uint64_t flipped_at_us() const override { return flipped_at_us_; }
  [[nodiscard]] std::uint64_t presented() const override { return presented_; }
  void set_power(bool on) override {
    if (on != power_) ++revision_;
    power_ = on;
  }
  [[nodiscard]] bool set_brightness(float brightness) override {
    pass_->set_brightness(brightness);
    return true;
  }
  void set_profile(const DisplayProfile& profile) override {
    pass_->set(mode_.rotation, profile, test_pattern_, gamut_warning_);
  }

  [[nodiscard]] gles::Image last() const override {
    if (presented_ == 0) return {};
    gles::Image image(mode_.panel_px[0], mode_.panel_px[1]);
    std::vector<std::uint8_t> rgba(image.rgb.size() / 3 * 4);
    target_->read(rgba.data());
    for (std::size_t k = 0; k < image.rgb.size() / 3; ++k) std::copy_n(&rgba[k * 4], 3, &image.rgb[k * 3]);
    return image;
  }

 private:
  Platform platform_;
  std::unique_ptr<gles::Context> context_;
  std::optional<PresentPass> pass_;
  std::optional<PanelTarget> target_;
  OutputMode mode_;
  bool test_pattern_, gamut_warning_;
  bool power_ = true;
  std::uint64_t revision_ = 1, presented_ = 0, flipped_at_us_ = 0;
};

}  // namespace

Result<std::unique_ptr<HeadlessOutput>> make_headless_output(const OutputSettings& settings, Log& log) {
  const bool osmesa = settings.platform == Platform::osmesa;
  auto context =
      gles::create_context(osmesa ? gles::Backend::osmesa : gles::Backend::egl_surfaceless, settings.context);
  if (!context) return tl::unexpected(context.error());
  auto target = PanelTarget::create(**context, settings.size_px);
  if (!target) return tl::unexpected(target.error());
  log.info("headless, drawing by " + (*context)->info().renderer + " (" + (*context)->info().platform + ")");
  return std::make_unique<OffscreenOutput>(osmesa ? Platform::osmesa : Platform::surfaceless, std::move(*context),
                                           std::move(*target), settings);
}

}  // namespace lackwerk::kiosk
