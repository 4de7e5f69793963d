#include "kiosk/display/output/fbdev_output.hpp"

#include <fcntl.h>
#include <linux/fb.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "input/source.hpp"
#include "kiosk/display/output/fbdev_layout.hpp"
#include "kiosk/display/output/kms_dumb.hpp"
#include "kiosk/display/output/panel_target.hpp"
#include "kiosk/display/output/present_pass.hpp"

namespace lackwerk::kiosk {
namespace {

/// A vertical blank that takes longer is none: 20 Hz is the slowest panel anybody sells.
constexpr double longest_blank_ms = 50.0;

std::string error_text() { return std::strerror(errno); }

/// Closes what it holds, once.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

/// The device's memory.
class Mapping {
 public:
  [[nodiscard]] static Result<Mapping> create(int fd, std::size_t bytes, const std::string& device) {
    void* at = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    if (at == MAP_FAILED) return fail(device, "memory", "cannot be mapped: " + error_text(), "check the driver");
    Mapping out;
    out.at_ = static_cast<std::byte*>(at);
    out.bytes_ = bytes;
    return out;
  }
  Mapping() = default;
  Mapping(Mapping&& other) noexcept { swap(other); }
  Mapping& operator=(Mapping&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Mapping() {
    if (at_ != nullptr) munmap(at_, bytes_);
  }
  [[nodiscard]] std::byte* data() const { return at_; }

 private:
  void swap(Mapping& other) noexcept {
    std::swap(at_, other.at_);
    std::swap(bytes_, other.bytes_);
  }
  std::byte* at_ = nullptr;
  std::size_t bytes_ = 0;
};

Result<FbLayout> read_layout(const FbdevCalls& calls, int fd, const std::string& device) {
  fb_var_screeninfo variable{};
  fb_fix_screeninfo fixed{};
  if (calls.control(fd, FBIOGET_VSCREENINFO, &variable) != 0 || calls.control(fd, FBIOGET_FSCREENINFO, &fixed) != 0)
    return fail(device, "", "does not tell its mode: " + error_text(), "check the driver");
  return fb_layout(variable, fixed, device);
}

class FbdevOutput final : public Output {
 public:
  FbdevOutput(FbdevCalls calls, std::string device, Descriptor fd, std::unique_ptr<gles::Context> context,
              const OutputSettings& settings, Seat* seat, Log& log)
      : calls_(std::move(calls)),
        device_(std::move(device)),
        fd_(std::move(fd)),
        context_(std::move(context)),
        pass_(std::in_place, *context_),
        seat_(seat),
        log_(&log),
        test_pattern_(settings.test_pattern),
        gamut_warning_(settings.gamut_warning) {
    mode_.connector = device_.substr(device_.rfind('/') + 1);
    mode_.rotation = settings.rotation;
    set_profile(settings.profile);
  }
  ~FbdevOutput() override {
    if (!power_) set_power(true);
    (void)context_->make_current();
    target_.reset();
    pass_.reset();
  }

  /// Maps the memory as the device is now.
  Result<void> adopt(const FbLayout& layout) {
    auto memory = Mapping::create(fd_.get(), layout.map_bytes, device_);
    if (!memory) return tl::unexpected(memory.error());
    auto target = PanelTarget::create(*context_, layout.size_px);
    if (!target) return tl::unexpected(target.error());
    memory_ = std::move(*memory);
    target_ = std::move(*target);
    writer_.emplace(layout);
    layout_ = layout;
    picture_.resize(static_cast<std::size_t>(layout.size_px[0]) * static_cast<std::size_t>(layout.size_px[1]) * 4);
    mode_.panel_px = layout.size_px;
    mode_.refresh_hz = blanks_ ? layout.refresh_hz : 0.0;
    ++revision_;
    log_->notice(device_ + ": " + std::to_string(layout.size_px[0]) + "x" + std::to_string(layout.size_px[1]) + ", " +
                 std::to_string(8 * layout.pixel_bytes) + " bits a pixel");
    return {};
  }

  [[nodiscard]] Platform platform() const override { return Platform::fbdev; }
  [[nodiscard]] gles::Context& context() override { return *context_; }
  [[nodiscard]] OutputState state() const override { return active_ ? OutputState::running : OutputState::suspended; }
  [[nodiscard]] const OutputMode& mode() const override { return mode_; }
  [[nodiscard]] std::uint64_t revision() const override { return revision_; }
  [[nodiscard]] bool ready() const override { return power_ && active_; }

  [[nodiscard]] Result<Presented> present(const gles::Framebuffer& picture) override {
    if (!ready()) return Presented::refused;
    // Two system calls a picture: nobody announces a new mode, and writing by the old one would tear the picture apart.
    auto now = read_layout(calls_, fd_.get(), device_);
    if (!now) return tl::unexpected(now.error());
    if (*now != layout_) {
      if (auto adopted = adopt(*now); !adopted) return tl::unexpected(adopted.error());
      return Presented::refused;  // drawn for another size
    }
    pass_->draw(picture, layout_.size_px, target_->framebuffer(), true, writer_->order());
    target_->read(picture_.data());
    wait_for_blank();
    writer_->write(picture_.data(), memory_.data());
    flipped_at_us_ = static_cast<std::uint64_t>(monotonic_ms() * 1000.0);
    ++presented_;
    return Presented::shown;
  }
  void add_descriptors(std::vector<int>& out) const override {
    if (seat_ != nullptr && seat_->fd() >= 0) out.push_back(seat_->fd());
  }
  [[nodiscard]] Result<void> dispatch(double /*now_ms*/) override {
    if (seat_ == nullptr) return {};
    seat_->dispatch();
    if (seat_->active() != active_) {
      active_ = !active_;
      ++revision_;  // whoever had the screen has drawn on it
    }
    return {};
  }
  [[nodiscard]] double wake_at_ms() const override { return input::never_ms; }
  [[nodiscard]] std::uint64_t flipped_at_us() const override { return flipped_at_us_; }
  [[nodiscard]] std::uint64_t presented() const override { return presented_; }

  void set_power(bool on) override {
    if (on == power_) return;
    power_ = on;
    ++revision_;
    if (blank(on ? FB_BLANK_UNBLANK : FB_BLANK_POWERDOWN)) return;
    if (!on) {
      log_->info(device_ + " has no power switch: black instead");
      std::memset(memory_.data(), 0, layout_.map_bytes);
    }
  }
  [[nodiscard]] bool set_brightness(float brightness) override {
    pass_->set_brightness(brightness);
    return true;
  }
  void set_profile(const DisplayProfile& profile) override {
    (void)context_->make_current();
    pass_->set(mode_.rotation, profile, test_pattern_, gamut_warning_);
  }

  /// FB_BLANK_*. False: the driver cannot.
  bool blank(std::uintptr_t level) {
    // The request takes a number where others take an address.
    void* const number = reinterpret_cast<void*>(level);  // NOLINT(performance-no-int-to-ptr)
    return calls_.control(fd_.get(), FBIOBLANK, number) == 0;
  }

 private:
  /// Where the driver knows one; asked again until it fails or takes too long, then never.
  void wait_for_blank() {
    if (!blanks_) return;
    const double start = monotonic_ms();
    std::uint32_t screen = 0;
    if (calls_.control(fd_.get(), FBIO_WAITFORVSYNC, &screen) == 0 && monotonic_ms() - start < longest_blank_ms) return;
    blanks_ = false;
    if (mode_.refresh_hz > 0.0) ++revision_;
    mode_.refresh_hz = 0.0;
    log_->info(device_ + ": no vertical blank: pictures may tear");
  }

  FbdevCalls calls_;
  std::string device_;
  Descriptor fd_;
  std::unique_ptr<gles::Context> context_;
  std::optional<PresentPass> pass_;
  std::optional<PanelTarget> target_;
  std::optional<FbWriter> writer_;
  Mapping memory_;
  FbLayout layout_;
  OutputMode mode_;
  std::vector<std::uint8_t> picture_;
  Seat* seat_;
  Log* log_;
  bool test_pattern_, gamut_warning_;
  bool power_ = true, blanks_ = true;
  bool active_ = true;  ///< the seat, as last seen
  std::uint64_t revision_ = 0, presented_ = 0, flipped_at_us_ = 0;
};

}  // namespace

FbdevCalls fbdev_calls() {
  return {[](const std::string& path) -> Result<int> {
            const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
            if (fd >= 0) return fd;
            return fail(path, "", "cannot be opened: " + error_text(),
                        errno == EACCES ? "put the kiosk's user into group video"
                                        : "load the framebuffer driver of the display, or use another platform");
          },
          [](int fd, unsigned long request, void* data) { return ioctl(fd, request, data); }};
}

Result<std::unique_ptr<Output>> open_fbdev(const OutputSettings& settings, Log& log, Seat* seat,
                                           const FbdevCalls& calls) {
  const std::string device = settings.card.rfind("/dev/fb", 0) == 0 ? settings.card : "/dev/fb0";
  auto opened = calls.open(device);
  if (!opened) return tl::unexpected(opened.error());
  Descriptor fd(*opened);
  const auto layout = read_layout(calls, fd.get(), device);
  if (!layout) return tl::unexpected(layout.error());
  auto context = make_offscreen_context(settings.context, log);
  if (!context) return tl::unexpected(context.error());
  auto output = std::make_unique<FbdevOutput>(calls, device, std::move(fd), std::move(*context), settings, seat, log);
  if (auto adopted = output->adopt(*layout); !adopted) return tl::unexpected(adopted.error());
  output->blank(FB_BLANK_UNBLANK);  // whoever was here before may have switched it off
  return std::unique_ptr<Output>(std::move(output));
}

}  // namespace lackwerk::kiosk
