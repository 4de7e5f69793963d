// A source of controls: touch screens, knobs, dials, or their in-memory twins.
//
// Why it exists: the kiosk's one thread waits for everything at once (poll) and must never wait for a device. Whoever
// makes a source owns it. Only the kiosk's thread may call it; threads a source needs for itself are its own affair and
// end with it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "input/control.hpp"

namespace lackwerk::input {

/// One device as `status.json` and the dealer's screen list it.
struct DeviceStatus {
  std::string name;         ///< what the device calls itself, cleaned of control characters
  std::string kind;         ///< "touch", "knob", "dial"
  std::string state;        ///< "ready", "waiting" (retried), "refused", "gone"
  std::string detail;       ///< node, and for the latter two why and what to do
  std::uint64_t heard = 0;  ///< turns and presses, or events of fingers, since it was plugged in: does it work at all?
};

/// What a source wants to have said in the log; the kiosk gives each line its priority.
struct Notice {
  bool problem = false;
  std::string text;
};

/// No call of read() hands out more controls than this; motion beyond it is merged, never lost.
inline constexpr std::size_t max_controls_a_read = 256;
/// wake_at_ms() of a source that waits for its descriptors only.
inline constexpr double never_ms = 1e300;

class Source {
 public:
  virtual ~Source() = default;
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// Appends the descriptors to poll for reading. They may change with every read().
  virtual void add_descriptors(std::vector<int>& out) const = 0;
  /// Appends what has arrived. Never blocks and never throws for a device's fault. `now_ms`: CLOCK_MONOTONIC.
  virtual void read(double now_ms, std::vector<Control>& out) = 0;
  /// When read() wants to be called even if no descriptor is readable (a retry is due), ms of CLOCK_MONOTONIC.
  [[nodiscard]] virtual double wake_at_ms() const = 0;
  virtual void add_devices(std::vector<DeviceStatus>& out) const = 0;
  /// Moves out what is to be logged since the last call; at most some tens of lines, repeated ones merged.
  virtual void take_notices(std::vector<Notice>& out) = 0;
};

}  // namespace lackwerk::input
