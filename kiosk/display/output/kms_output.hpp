// Pictures on a monitor by the kernel's mode setting: the GPU's output and the dumb buffers' alike.
//
// Why it exists: joins the display's state machine, what pictures are drawn into, the seat and the hot-plug messages.
// Owns them all but the seat. One thread.
#pragma once

#include <functional>
#include <memory>

#include "input/udev_monitor.hpp"
#include "kiosk/display/output.hpp"
#include "kiosk/display/output/kms_display.hpp"
#include "kiosk/display/output/kms_surface.hpp"
#include "kiosk/display/output/seat.hpp"

namespace lackwerk::kiosk {

/// A device that a seat has opened: closed when it goes, after everything that was made on it.
class SeatDevice {
 public:
  SeatDevice() = default;
  SeatDevice(Seat& seat, int fd) : seat_(&seat), fd_(fd) {}
  SeatDevice(SeatDevice&& other) noexcept : seat_(std::exchange(other.seat_, nullptr)), fd_(other.fd_) {}
  SeatDevice& operator=(SeatDevice&& other) noexcept {
    std::swap(seat_, other.seat_);
    std::swap(fd_, other.fd_);
    return *this;
  }
  SeatDevice(const SeatDevice&) = delete;
  SeatDevice& operator=(const SeatDevice&) = delete;
  ~SeatDevice() {
    if (seat_ != nullptr) seat_->close_device(fd_);
  }
  [[nodiscard]] int fd() const { return fd_; }

 private:
  Seat* seat_ = nullptr;
  int fd_ = -1;
};

/// What an output is made of, the first to go last. `seat` (the caller's, which outlives all this) and `hotplug` may be
/// null.
struct KmsParts {
  Seat* seat = nullptr;
  SeatDevice opened;
  std::unique_ptr<KmsDevice> device;
  std::unique_ptr<KmsSurface> surface;
  std::unique_ptr<input::DeviceMonitor> hotplug;  ///< of the subsystem "drm"
};

class KmsOutput final : public Output {
 public:
  using Clock = std::function<double()>;
  /// `clock`: CLOCK_MONOTONIC in ms, or a test's.
  KmsOutput(KmsParts parts, const OutputSettings& settings, Log& log, Clock clock = monotonic_ms);

  /// Takes the display. Error: as KmsDisplay::start().
  [[nodiscard]] Result<void> start();

  [[nodiscard]] Platform platform() const override { return parts_.surface->platform(); }
  [[nodiscard]] gles::Context& context() override { return parts_.surface->context(); }
  [[nodiscard]] OutputState state() const override { return display_.state(); }
  [[nodiscard]] const OutputMode& mode() const override { return display_.mode(); }
  [[nodiscard]] std::uint64_t revision() const override { return display_.revision(); }
  [[nodiscard]] bool ready() const override;
  [[nodiscard]] Result<Presented> present(const gles::Framebuffer& picture) override;
  void add_descriptors(std::vector<int>& out) const override;
  [[nodiscard]] Result<void> dispatch(double now_ms) override;
  [[nodiscard]] double wake_at_ms() const override;
  [[nodiscard]] std::uint64_t flipped_at_us() const override { return display_.flipped_at_us(); }
  [[nodiscard]] std::uint64_t presented() const override { return display_.presented(); }
  void set_power(bool on) override { display_.set_power(on, clock_()); }
  [[nodiscard]] bool set_brightness(float brightness) override {
    parts_.surface->set_brightness(brightness);
    return true;
  }
  void set_profile(const DisplayProfile& profile) override {
    look_.profile = profile;
    parts_.surface->set_look(look_);
  }

 private:
  [[nodiscard]] bool hotplug_came();
  [[nodiscard]] Result<Presented> not_now(const Error& why, double now_ms);

  KmsParts parts_;
  Log& log_;
  Clock clock_;
  KmsDisplay display_;
  Look look_;
  std::array<int, 2> buffers_px_{0, 0};
  double retry_at_ms_ = 0.0;                ///< buffers could not be had
  int failures_ = 0;                        ///< in a row
  bool active_ = true;                      ///< the seat, as last seen
  std::vector<input::DeviceEvent> events_;  ///< scratch
};

}  // namespace lackwerk::kiosk
