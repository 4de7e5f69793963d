// One DRM card as the kernel offers it: connectors, pipes, planes, buffers, commits and flip events, as plain values.
//
// Why it exists: everything that can go wrong with a display (no monitor, unplug between two calls, EBUSY, a flip that
// never comes, master lost) must be tested without a display, so the kernel's interface is an edge with an in-memory
// twin (drm_fake.hpp). No policy here. Errors are errno numbers: what they mean depends on the call. Whoever makes one
// owns it; the descriptor behind it belongs to the seat. One thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::kiosk {

/// A value, or errno.
template <class T>
using DrmResult = tl::expected<T, int>;

/// Kernel object numbers; 0: none.
using DrmId = std::uint32_t;

/// Bytes B, G, R, X in memory, the one format every display engine scans out.
inline constexpr std::uint32_t drm_format_xrgb8888 = 0x34325258;  // drm_fourcc.h: 'X' 'R' '2' '4'

/// One axis of a mode: where the picture ends, the sync pulse begins and ends, and the line or frame ends.
struct DrmTiming {
  std::uint16_t display = 0, sync_start = 0, sync_end = 0, total = 0;
  bool operator==(const DrmTiming&) const = default;
};

/// A video mode, as struct drm_mode_modeinfo.
struct DrmMode {
  std::uint32_t clock_khz = 0;
  DrmTiming horizontal, vertical;
  std::uint16_t hskew = 0, vscan = 0;
  std::uint32_t flags = 0;  ///< DRM_MODE_FLAG_*
  bool preferred = false;
  std::string name;

  [[nodiscard]] std::array<int, 2> size_px() const { return {horizontal.display, vertical.display}; }
  [[nodiscard]] bool interlaced() const;
  /// Pictures a second; 0 for a mode without timings.
  [[nodiscard]] double refresh_hz() const;
  /// "1920x1080 at 59.94 Hz".
  [[nodiscard]] std::string text() const;
  /// The same signal; name and preference do not count.
  [[nodiscard]] bool same_signal(const DrmMode& other) const;
};

struct DrmConnector {
  DrmId id = 0;
  std::string name;  ///< "HDMI-A-1"
  bool connected = false;
  std::array<int, 2> size_mm{0, 0};  ///< of the monitor, as it says; 0: not said
  bool desktop = true;               ///< false: a headset or the like, not for pictures of ours
  std::vector<DrmMode> modes;
  std::uint32_t possible_crtcs = 0;  ///< bit k: the k-th pipe of DrmResources
  DrmId crtc = 0;                    ///< it is fed by now
};

enum class DrmPlaneType { overlay, primary, cursor };
struct DrmPlane {
  DrmId id = 0;
  DrmPlaneType type = DrmPlaneType::overlay;
  std::uint32_t possible_crtcs = 0;
  std::vector<std::uint32_t> formats;
  DrmId crtc = 0;  ///< it is shown on by now
};

struct DrmResources {
  std::vector<DrmId> crtcs, connectors;
  std::array<int, 2> largest_px{0, 0};  ///< of a framebuffer; 0: not said
};

enum class DrmObject { connector, crtc, plane };
struct DrmProperty {
  DrmId id = 0;
  std::string name;
  std::uint64_t value = 0;
};

/// What a pipe shows now, to be put back.
struct DrmPipeState {
  DrmId framebuffer = 0;
  int x = 0, y = 0;
  bool active = false;
  DrmMode mode;  ///< if active
};

/// One property to set in a commit.
struct DrmSetting {
  DrmId object = 0, property = 0;
  std::uint64_t value = 0;
};

struct DrmCommit {
  bool test_only = false;  ///< would it work?
  bool allow_modeset = false;
  bool event = false;  ///< send a flip event with `cookie`
  bool wait = false;   ///< until it is done; else it is only set going
  std::uint32_t cookie = 0;
};

/// A picture has reached the panel.
struct DrmFlip {
  std::uint32_t cookie = 0;
  std::uint64_t at_us = 0;  ///< CLOCK_MONOTONIC
};

/// A buffer of the kernel that the CPU can write, XRGB8888.
struct DrmDumb {
  std::uint32_t handle = 0;
  std::array<int, 2> size_px{0, 0};
  std::uint32_t pitch = 0;  ///< bytes from row to row
  std::uint64_t bytes = 0;
};

struct DrmFramebuffer {
  std::array<int, 2> size_px{0, 0};
  std::uint32_t handle = 0, pitch = 0, offset = 0;
  std::uint32_t format = drm_format_xrgb8888;
};

struct DrmCard {
  std::string path;    ///< "/dev/dri/card1"
  std::string driver;  ///< "i915", "virtio_gpu"
  bool atomic = false;
  bool dumb = false;
};

class KmsDevice {
 public:
  virtual ~KmsDevice() = default;
  KmsDevice(const KmsDevice&) = delete;
  KmsDevice& operator=(const KmsDevice&) = delete;

  [[nodiscard]] virtual const DrmCard& card() const = 0;
  /// Readable when read_flips() has something; -1: none (the twin).
  [[nodiscard]] virtual int fd() const = 0;

  [[nodiscard]] virtual DrmResult<DrmResources> resources() = 0;
  /// Asks the monitor, which takes tens of milliseconds. ENOENT: the connector has gone (docks come and go).
  [[nodiscard]] virtual DrmResult<DrmConnector> probe_connector(DrmId id) = 0;
  [[nodiscard]] virtual DrmResult<std::vector<DrmPlane>> planes() = 0;
  [[nodiscard]] virtual DrmResult<std::vector<DrmProperty>> properties(DrmId object, DrmObject kind) = 0;
  [[nodiscard]] virtual DrmResult<DrmPipeState> pipe_state(DrmId crtc) = 0;

  [[nodiscard]] virtual DrmResult<DrmId> create_mode_blob(const DrmMode& mode) = 0;
  virtual void destroy_blob(DrmId id) = 0;
  [[nodiscard]] virtual DrmResult<DrmId> add_framebuffer(const DrmFramebuffer& framebuffer) = 0;
  /// Turns off whatever still shows it.
  virtual void remove_framebuffer(DrmId id) = 0;

  [[nodiscard]] virtual DrmResult<DrmDumb> create_dumb(std::array<int, 2> size_px) = 0;
  /// The buffer's bytes, valid until unmap_dumb().
  [[nodiscard]] virtual DrmResult<std::uint8_t*> map_dumb(const DrmDumb& buffer) = 0;
  virtual void unmap_dumb(const DrmDumb& buffer, std::uint8_t* mapped) = 0;
  virtual void destroy_dumb(const DrmDumb& buffer) = 0;

  /// Errors: EBUSY (an earlier one is under way), EINVAL (no such state), EACCES (not
  /// master), ENODEV (card gone), and others.
  [[nodiscard]] virtual DrmResult<void> commit(const std::vector<DrmSetting>& settings, const DrmCommit& how) = 0;
  /// The older interface. `mode` null: the pipe is turned off.
  [[nodiscard]] virtual DrmResult<void> set_crtc(DrmId crtc, DrmId framebuffer, std::array<int, 2> from,
                                                 DrmId connector, const DrmMode* mode) = 0;
  [[nodiscard]] virtual DrmResult<void> page_flip(DrmId crtc, DrmId framebuffer, std::uint32_t cookie) = 0;
  [[nodiscard]] virtual DrmResult<void> set_connector_property(DrmId connector, DrmId property,
                                                               std::uint64_t value) = 0;
  /// Flips that have been reported; waits at most `timeout_ms` for the first.
  [[nodiscard]] virtual DrmResult<std::vector<DrmFlip>> read_flips(int timeout_ms) = 0;

  /// The right to set modes. EACCES, EPERM, EBUSY, EINVAL: another program has it.
  [[nodiscard]] virtual DrmResult<void> set_master() = 0;
  virtual void drop_master() = 0;

 protected:
  KmsDevice() = default;
};

/// The kernel's. `fd` stays the caller's and must outlive the result. Error: not a card that sets modes.
[[nodiscard]] Result<std::unique_ptr<KmsDevice>> open_kms_device(int fd, const std::string& path);

/// "EBUSY (Device or resource busy)": numbers mean nothing to a reader of a log.
[[nodiscard]] std::string errno_text(int code);

}  // namespace lackwerk::kiosk
