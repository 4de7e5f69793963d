// Where finished pictures go: a KMS plane, a dumb buffer, /dev/fb0, or nowhere (headless).
//
// Why it exists: the loop draws into its own framebuffer and must not know what a connector is. An output owns its GL
// context (renderers made on it must go first) and the devices it opened. It never blocks longer than `present_wait_ms`
// and never ends the kiosk because of a monitor: no display is a state. One thread, the one that made it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "kiosk/display/display_profile.hpp"
#include "kiosk/display/log.hpp"
#include "kiosk/display/orientation.hpp"
#include "render_gles/context.hpp"
#include "render_gles/framebuffer.hpp"

namespace lackwerk::kiosk {

class Seat;

enum class Platform { automatic, kms, dumb, fbdev, surfaceless, osmesa };

/// As on the command line: "auto", "kms", "dumb", "fbdev", "surfaceless", "osmesa".
[[nodiscard]] std::optional<Platform> platform_of(const std::string& name);
[[nodiscard]] const char* platform_name(Platform platform);

struct OutputSettings {
  Platform platform = Platform::automatic;
  std::string card;       ///< "/dev/dri/by-path/...", or empty: the first card with a connected connector
  std::string connector;  ///< "HDMI-A-1", or empty: the first connected one
  std::array<int, 2> size_px{1280, 720};  ///< headless only; elsewhere the mode decides
  std::array<int, 2> mode_px{0, 0};       ///< wanted mode; 0: the preferred one. Not there: preferred, and said
  int refresh_hz = 0;                     ///< wanted; 0: the mode's own
  Rotation rotation = Rotation::none;
  DisplayProfile profile;
  bool gamut_warning = false;  ///< colours the panel cannot show are hatched
  bool test_pattern = false;   ///< shown in the picture's place
  gles::ContextSettings context;
};

enum class OutputState {
  running,
  waiting_for_display,  ///< nothing is connected
  suspended,            ///< another session has the seat
};
[[nodiscard]] const char* output_state_name(OutputState state);

/// What is shown, for the log and status.json.
struct OutputMode {
  std::string connector;              ///< "HDMI-A-1", "fb0", "headless"
  std::array<int, 2> panel_px{0, 0};  ///< as the panel is built; the picture's size is picture_size(rotation, panel_px)
  double refresh_hz = 0.0;            ///< 0: no vertical blank
  Rotation rotation = Rotation::none;
  std::array<int, 2> panel_mm{0, 0};  ///< as the panel says, along panel_px; 0: it does not
};

enum class Presented {
  queued,   ///< on its way to the panel; ready() turns false until it is there
  shown,    ///< there (outputs without a vertical blank)
  refused,  ///< busy or no display: the damage stays, present again when ready()
};

/// A bounded wait: longer than any refresh, shorter than a customer's patience. A flip event that has not come after
/// this is taken as lost, said, and the mode is set again.
inline constexpr double present_wait_ms = 500.0;

class Output {
 public:
  virtual ~Output() = default;
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  [[nodiscard]] virtual Platform platform() const = 0;
  [[nodiscard]] virtual gles::Context& context() = 0;
  [[nodiscard]] virtual OutputState state() const = 0;
  [[nodiscard]] virtual const OutputMode& mode() const = 0;
  /// Rises whenever mode() or state() has changed, or what was shown is lost: draw and present again.
  [[nodiscard]] virtual std::uint64_t revision() const = 0;
  /// True when present() would be taken now.
  [[nodiscard]] virtual bool ready() const = 0;
  /// Hands over a picture of picture_size(rotation, panel_px). Error: the device is lost for good (the process should
  /// end and be started again); everything that may pass is `refused`.
  [[nodiscard]] virtual Result<Presented> present(const gles::Framebuffer& picture) = 0;
  /// Appends the descriptors to poll for reading: flips, hot-plug (the seat is the caller's to poll).
  virtual void add_descriptors(std::vector<int>& out) const = 0;
  /// Drains events and does what is due. `now_ms`: CLOCK_MONOTONIC. Error: as present().
  [[nodiscard]] virtual Result<void> dispatch(double now_ms) = 0;
  /// When dispatch() wants to be called even if nothing is readable; input::never_ms if never.
  [[nodiscard]] virtual double wake_at_ms() const = 0;
  /// CLOCK_MONOTONIC time of the newest flip, µs; 0 before the first.
  [[nodiscard]] virtual std::uint64_t flipped_at_us() const = 0;
  /// Flips (or writes) that reached the panel.
  [[nodiscard]] virtual std::uint64_t presented() const = 0;
  /// Panel off (DPMS) and on. Survives hot-plug.
  virtual void set_power(bool on) = 0;
  /// Dims all pictures from the next one on: a factor on their display values, [0, 1], in the pass that takes them to
  /// the panel anyway. False: this output has none; whoever composes the picture dims it.
  [[nodiscard]] virtual bool set_brightness(float /*brightness*/) { return false; }
  /// What the present pass does from the next picture on.
  virtual void set_profile(const DisplayProfile& profile) = 0;

 protected:
  Output() = default;
};

/// A platform that was tried and why it was not taken: for the log and status.json.
struct RefusedPlatform {
  Platform platform;
  Error why;
};

struct OpenedOutput {
  std::unique_ptr<Output> output;
  std::vector<RefusedPlatform> refused;  ///< better ones, in the order they were tried
};

/// automatic: kms, dumb, fbdev in this order, each refusal kept and logged. A card without a monitor is taken and
/// waits. `seat` opens the devices and must outlive the output. Touch screens share it, so it is the caller's, who
/// polls and dispatches it; outputs ask seat.active() in dispatch(). Error: none of them could be opened.
[[nodiscard]] Result<OpenedOutput> open_output(const OutputSettings& settings, Seat& seat, Log& log);

}  // namespace lackwerk::kiosk
