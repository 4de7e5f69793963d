// Twins of the live kiosk's edges: a panel that can be pulled out, and a hand.
//
// Why it exists: tests of the live kiosk decide when a flip comes and what is touched. Test code; one thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "input/source.hpp"
#include "kiosk/display/output.hpp"
#include "render_gles/image.hpp"

namespace lackwerk::test {

/// A panel whose flips come when the test says so.
class Panel final : public kiosk::Output {
 public:
  explicit Panel(gles::Context& context) : context_(context) { mode_.panel_px = {96, 54}; }

  [[nodiscard]] kiosk::Platform platform() const override { return kiosk::Platform::kms; }
  [[nodiscard]] gles::Context& context() override { return context_; }
  [[nodiscard]] kiosk::OutputState state() const override { return state_; }
  [[nodiscard]] const kiosk::OutputMode& mode() const override { return mode_; }
  [[nodiscard]] std::uint64_t revision() const override { return revision_; }
  [[nodiscard]] bool ready() const override { return state_ == kiosk::OutputState::running && !pending_; }
  [[nodiscard]] Result<kiosk::Presented> present(const gles::Framebuffer& picture) override {
    if (lost_) return fail("/dev/dri/card9", "", "device lost", "restart");
    if (busy_ > 0) {
      --busy_;
      return kiosk::Presented::refused;
    }
    size_px = {picture.width(), picture.height()};
    if (keeps) last = picture.read();
    pending_ = true;
    ++taken;
    return kiosk::Presented::queued;
  }
  void add_descriptors(std::vector<int>& /*out*/) const override {}
  [[nodiscard]] Result<void> dispatch(double /*now_ms*/) override { return {}; }
  [[nodiscard]] double wake_at_ms() const override { return input::never_ms; }
  [[nodiscard]] std::uint64_t flipped_at_us() const override { return flipped_us_; }
  [[nodiscard]] std::uint64_t presented() const override { return taken; }
  [[nodiscard]] bool set_brightness(float factor) override {
    brightness = factor;
    return dims;
  }
  void set_power(bool on) override { powered = on; }
  void set_profile(const kiosk::DisplayProfile& /*profile*/) override {}

  void flip(std::uint64_t at_us) {
    pending_ = false;
    flipped_us_ = at_us;
  }
  void plug(std::array<int, 2> panel_px, kiosk::Rotation rotation = kiosk::Rotation::none,
            std::array<int, 2> panel_mm = {0, 0}) {
    mode_.panel_px = panel_px;
    mode_.panel_mm = panel_mm;
    mode_.rotation = rotation;
    set(kiosk::OutputState::running);
  }
  void unplug() { set(kiosk::OutputState::waiting_for_display); }
  void refuse(int times) { busy_ = times; }
  void lose() { lost_ = true; }

  std::uint64_t taken = 0;
  std::array<int, 2> size_px{};
  bool powered = true;
  bool keeps = false;  ///< what is presented, in `last`
  gles::Image last;
  bool dims = false;  ///< says that it dims by itself
  float brightness = 1.0f;

 private:
  void set(kiosk::OutputState state) {
    state_ = state;
    pending_ = false;
    ++revision_;
  }
  gles::Context& context_;
  kiosk::OutputState state_ = kiosk::OutputState::running;
  kiosk::OutputMode mode_;
  std::uint64_t revision_ = 1, flipped_us_ = 0;
  bool pending_ = false, lost_ = false;
  int busy_ = 0;
};

/// What the test wants to be turned and touched.
struct Hand {
  std::vector<input::Control> next;
};
class HandSource final : public input::Source {
 public:
  explicit HandSource(Hand& hand) : hand_(hand) {}
  void add_descriptors(std::vector<int>& /*out*/) const override {}
  void read(double /*now_ms*/, std::vector<input::Control>& out) override {
    out.insert(out.end(), hand_.next.begin(), hand_.next.end());
    hand_.next.clear();
  }
  [[nodiscard]] double wake_at_ms() const override { return input::never_ms; }
  void add_devices(std::vector<input::DeviceStatus>& out) const override {
    out.push_back({"hand", "knob", "ready", ""});
  }
  void take_notices(std::vector<input::Notice>& /*out*/) override {}

 private:
  Hand& hand_;
};

}  // namespace lackwerk::test
