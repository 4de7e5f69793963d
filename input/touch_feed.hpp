// Raw touches and the devices they come from, before any sense is made of them.
//
// Why it exists: the sense (merging, cancelling, binding to an output) is tested with a list of events in memory; only
// libinput's side needs devices. A feed owns its devices and descriptors; the kiosk's thread only.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "input/source.hpp"
#include "input/touch_settings.hpp"

namespace lackwerk::input {

enum class TouchKind {
  screen,   ///< many fingers
  pointer,  ///< an absolute pointer with a button: a pen digitiser, a virtual machine's tablet
  mouse,    ///< relative; no pointer is drawn, so it has no place of its own
};

struct AxisRange {
  double least = 0.0, most = 0.0;
};

struct TouchDevice {
  int id = 0;  ///< given by the feed, never used twice
  TouchKind kind = TouchKind::screen;
  std::string name, node;  ///< as the kernel says; node: "event3"
  std::string output;      ///< udev's WL_OUTPUT, usually empty
  unsigned vendor = 0, product = 0;
  AxisRange x, y;  ///< as the device announces them; not looked at for a mouse
  int slots = 1;   ///< fingers it says it can tell apart
};

struct RawTouch {
  enum class Kind {
    added,    ///< a device; `added` has it
    removed,  ///< a device is gone
    down,     ///< slot, x, y
    move,     ///< slot, x, y
    up,       ///< slot
    cancel,   ///< slot
    point,    ///< absolute pointer: x, y
    nudge,    ///< mouse: x, y are counts of a mouse with 1000 of them an inch
    press,    ///< main button of a pointer or mouse
    release,  ///< the same
  };
  Kind kind = Kind::move;
  int device = 0;
  int slot = 0;
  double x = 0.0, y = 0.0;    ///< [0, 1] of the panel after calibration, from its upper left corner
  std::uint64_t time_us = 0;  ///< CLOCK_MONOTONIC
  std::optional<TouchDevice> added;
};

/// Raw events a read() of a feed hands out at most.
inline constexpr std::size_t max_raw_a_read = 4096;

class TouchFeed {
 public:
  virtual ~TouchFeed() = default;
  TouchFeed() = default;
  TouchFeed(const TouchFeed&) = delete;
  TouchFeed& operator=(const TouchFeed&) = delete;

  virtual void add_descriptors(std::vector<int>& out) const = 0;
  /// Appends at most max_raw_a_read events in the order in which they happened. Never blocks.
  virtual void read(std::vector<RawTouch>& out) = 0;
  /// True when read() has more at once, although no descriptor need be readable.
  [[nodiscard]] virtual bool has_more() const = 0;
  /// Replaces the calibration of a device. False: it takes none.
  virtual bool calibrate(int device, const CalibrationMatrix& matrix) = 0;
  /// The seat is lost: close all devices. They come back as new ones after resume().
  virtual void suspend() = 0;
  /// False: the devices cannot be had again now.
  virtual bool resume() = 0;
  virtual void take_notices(std::vector<Notice>& out) = 0;
};

}  // namespace lackwerk::input
