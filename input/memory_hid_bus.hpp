// The twin of every HID bus: devices that exist only in memory.
//
// Why it exists: unplugging in the middle of a turn, permissions that come late and a thousand replugs are tested in
// milliseconds and without root. Owns its devices' state; all its calls may come from any thread. Destroy it after
// whatever opened devices through it.
#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "input/hid_bus.hpp"

namespace lackwerk::input {

class MemoryHidBus : public HidBus {
 public:
  MemoryHidBus();
  ~MemoryHidBus() override;

  // ---- what a test does
  /// Plugs a device in and returns its key. `fails`: how often opening it is refused first (an EACCES race).
  std::string plug(const std::string& name, std::uint16_t vendor, std::uint16_t product,
                   std::vector<std::uint8_t> descriptor, int fails = 0);
  void unplug(const std::string& key);
  /// An input report; false when nobody has the device open. At most 64 wait, as in the kernel, the oldest go first.
  bool send(const std::string& key, std::vector<std::uint8_t> report);
  /// Reports handed in and not yet read.
  [[nodiscard]] std::size_t unread(const std::string& key) const;
  /// A feature report the device has: id first. Without it reading and sending fail.
  void set_feature_report(const std::string& key, std::vector<std::uint8_t> bytes);
  [[nodiscard]] std::vector<std::uint8_t> feature_report(const std::string& key, std::uint8_t id) const;
  [[nodiscard]] int opened() const;         ///< how often a device was opened
  [[nodiscard]] int open_now() const;       ///< devices open at this moment
  [[nodiscard]] int features_sent() const;  ///< how often a feature report was accepted

  // ---- what the kiosk does
  void add_descriptors(std::vector<int>& out) const override { out.push_back(signal_); }
  bool changed() override;
  [[nodiscard]] std::vector<HidNode> list() override;
  [[nodiscard]] tl::expected<std::vector<std::uint8_t>, HidFault> report_descriptor(const HidNode& node) override;
  [[nodiscard]] tl::expected<std::unique_ptr<HidDevice>, HidFault> open(const HidNode& node) override;

 private:
  class Device;
  struct Plugged {
    HidNode node;
    std::vector<std::uint8_t> descriptor;
    int fails = 0;
    bool present = true;
    int users = 0;
    std::deque<std::vector<std::uint8_t>> reports;
    std::map<std::uint8_t, std::vector<std::uint8_t>> features;
  };
  void signal() const;

  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  int signal_ = -1;
  int serial_ = 0;
  int opened_ = 0;
  int features_sent_ = 0;
  std::map<std::string, std::shared_ptr<Plugged>> devices_;
};

}  // namespace lackwerk::input
