// Touch screens, and pointers that act like one finger, as controls.
//
// Why it exists: a feed says what every device reports, thousands of times a second if a device is mad; the kiosk wants
// few events that can be trusted: each finger goes down once, moves and ends once (up or cancel), whatever is unplugged
// in between. Owns its feed. No device is a normal state. The kiosk's thread only.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "input/source.hpp"
#include "input/touch_feed.hpp"
#include "input/touch_settings.hpp"

namespace lackwerk::input {

/// Fingers of one device that count at a time: one customer's two hands. Large frames announce 20 to 40; the first ten
/// are taken, the others ignored and said.
inline constexpr int max_fingers = 10;
/// A device that announces more is mad: the largest frames on the market tell about a hundred apart.
inline constexpr int max_slots = 256;
/// Devices that are looked at, at a time.
inline constexpr std::size_t max_touch_devices = 32;
/// Counts of a mouse across the panel: an inch of the hand.
inline constexpr double mouse_counts_a_panel = 1000.0;

/// Why a device cannot be used, or nothing: axes without a range or not finite, an absurd number of fingers.
[[nodiscard]] std::optional<std::string> refusal_of(const TouchDevice& device);
/// The first entry for this device; null if there is none.
[[nodiscard]] const TouchSettings* find_settings(const std::vector<TouchSettings>& settings, const TouchDevice& device);
/// Printable ASCII, at most 80 characters: device names are input too.
[[nodiscard]] std::string clean_name(const std::string& name);

class TouchScreens final : public Source {
 public:
  /// `output`: the connector the kiosk shows on; devices bound to another are ignored. Empty: not known, none is.
  TouchScreens(std::unique_ptr<TouchFeed> feed, std::vector<TouchSettings> settings, std::string output = {});

  /// The kiosk shows on another connector now.
  void set_output(const std::string& output);
  /// The seat is lost: everything held is cancelled with the next read().
  void suspend();
  void resume();

  void add_descriptors(std::vector<int>& out) const override;
  /// Moves of one finger between two other events (down, up, cancel) become one, the newest.
  void read(double now_ms, std::vector<Control>& out) override;
  [[nodiscard]] double wake_at_ms() const override;
  void add_devices(std::vector<DeviceStatus>& out) const override;
  void take_notices(std::vector<Notice>& out) override;

 private:
  struct Device {
    TouchDevice info;
    std::string bound;        ///< connector it is bound to; empty: any
    std::string refused;      ///< why it is not used; empty: it is
    bool too_many = false;    ///< more fingers than max_fingers were said
    double x = 0.5, y = 0.5;  ///< where a pointer is
    std::uint64_t heard = 0;
  };
  struct Contact {
    int device, slot, number;
  };

  void take(const RawTouch& event, bool dying);
  void add(const TouchDevice& device);
  void remove(int device);
  void down(Device& device, const RawTouch& event);
  void move(const Device& device, int slot, double x, double y, std::uint64_t time_us);
  void end(int device, int slot, ControlKind how, std::uint64_t time_us);
  void cancel_all_of(int device);
  void put(Control control, int device);
  void refuse(Device& device, std::string why, bool problem);
  [[nodiscard]] bool is_elsewhere(const Device& device) const;
  void say(bool problem, std::string text);
  std::vector<Contact>::iterator find(int device, int slot);

  std::unique_ptr<TouchFeed> feed_;
  std::vector<TouchSettings> settings_;
  std::string output_;
  std::map<int, Device> devices_;
  std::vector<Contact> contacts_;
  std::deque<Control> queue_;    ///< to be handed out
  std::size_t since_order_ = 0;  ///< moves before this place of the queue are final
  std::vector<RawTouch> raw_;
  std::vector<Notice> notices_;
};

}  // namespace lackwerk::input
