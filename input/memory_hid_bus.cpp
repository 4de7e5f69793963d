#include "input/memory_hid_bus.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace lackwerk::input {
namespace {

/// As in the kernel (HIDRAW_BUFFER_SIZE).
constexpr std::size_t max_waiting_reports = 64;

}  // namespace

class MemoryHidBus::Device : public HidDevice {
 public:
  Device(MemoryHidBus& bus, std::shared_ptr<Plugged> plugged) : bus_(bus), plugged_(std::move(plugged)) {}
  ~Device() override {
    const std::lock_guard lock(bus_.mutex_);
    --plugged_->users;
  }

  int read(std::span<std::uint8_t> report, int timeout_ms) override {
    std::unique_lock lock(bus_.mutex_);
    bus_.arrived_.wait_for(lock, std::chrono::milliseconds(timeout_ms),
                           [&] { return !plugged_->present || !plugged_->reports.empty(); });
    if (!plugged_->present) return -1;
    if (plugged_->reports.empty()) return 0;
    const auto bytes = std::move(plugged_->reports.front());
    plugged_->reports.pop_front();
    const std::size_t size = std::min(bytes.size(), report.size());
    std::copy_n(bytes.begin(), size, report.begin());
    return static_cast<int>(size);
  }

  bool get_feature(std::span<std::uint8_t> bytes) override {
    const std::lock_guard lock(bus_.mutex_);
    const auto found = plugged_->features.find(bytes.empty() ? 0 : bytes[0]);
    if (!plugged_->present || found == plugged_->features.end() || found->second.size() != bytes.size()) return false;
    std::copy(found->second.begin(), found->second.end(), bytes.begin());
    return true;
  }

  bool set_feature(std::span<const std::uint8_t> bytes) override {
    const std::lock_guard lock(bus_.mutex_);
    const auto found = plugged_->features.find(bytes.empty() ? 0 : bytes[0]);
    if (!plugged_->present || found == plugged_->features.end()) return false;
    found->second.assign(bytes.begin(), bytes.end());
    ++bus_.features_sent_;
    return true;
  }

 private:
  MemoryHidBus& bus_;
  std::shared_ptr<Plugged> plugged_;
};

MemoryHidBus::MemoryHidBus() : signal_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

MemoryHidBus::~MemoryHidBus() {
  if (signal_ >= 0) close(signal_);
}

void MemoryHidBus::signal() const { eventfd_write(signal_, 1); }

std::string MemoryHidBus::plug(const std::string& name, std::uint16_t vendor, std::uint16_t product,
                               std::vector<std::uint8_t> descriptor, int fails) {
  const std::lock_guard lock(mutex_);
  std::string key = name + "#" + std::to_string(++serial_);
  auto plugged = std::make_shared<Plugged>();
  plugged->node = {key, "/dev/hidraw" + std::to_string(serial_ % 8), vendor, product, name};
  plugged->descriptor = std::move(descriptor);
  plugged->fails = fails;
  devices_[key] = std::move(plugged);
  signal();
  return key;
}

void MemoryHidBus::unplug(const std::string& key) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = devices_.find(key);
    if (found == devices_.end()) return;
    found->second->present = false;
    devices_.erase(found);
    signal();
  }
  arrived_.notify_all();
}

bool MemoryHidBus::send(const std::string& key, std::vector<std::uint8_t> report) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = devices_.find(key);
    if (found == devices_.end() || found->second->users == 0) return false;
    auto& reports = found->second->reports;
    if (reports.size() == max_waiting_reports) reports.pop_front();
    reports.push_back(std::move(report));
  }
  arrived_.notify_all();
  return true;
}

std::size_t MemoryHidBus::unread(const std::string& key) const {
  const std::lock_guard lock(mutex_);
  const auto found = devices_.find(key);
  return found == devices_.end() ? 0 : found->second->reports.size();
}

void MemoryHidBus::set_feature_report(const std::string& key, std::vector<std::uint8_t> bytes) {
  const std::lock_guard lock(mutex_);
  const auto found = devices_.find(key);
  if (found == devices_.end() || bytes.empty()) return;
  const std::uint8_t id = bytes[0];
  found->second->features[id] = std::move(bytes);
}

std::vector<std::uint8_t> MemoryHidBus::feature_report(const std::string& key, std::uint8_t id) const {
  const std::lock_guard lock(mutex_);
  const auto found = devices_.find(key);
  if (found == devices_.end()) return {};
  const auto feature = found->second->features.find(id);
  return feature == found->second->features.end() ? std::vector<std::uint8_t>{} : feature->second;
}

int MemoryHidBus::opened() const {
  const std::lock_guard lock(mutex_);
  return opened_;
}

int MemoryHidBus::open_now() const {
  const std::lock_guard lock(mutex_);
  int count = 0;
  for (const auto& [key, plugged] : devices_) count += plugged->users;
  return count;
}

int MemoryHidBus::features_sent() const {
  const std::lock_guard lock(mutex_);
  return features_sent_;
}

bool MemoryHidBus::changed() {
  eventfd_t told = 0;
  return eventfd_read(signal_, &told) == 0;
}

std::vector<HidNode> MemoryHidBus::list() {
  const std::lock_guard lock(mutex_);
  std::vector<HidNode> out;
  out.reserve(devices_.size());
  for (const auto& [key, plugged] : devices_) out.push_back(plugged->node);
  return out;
}

tl::expected<std::vector<std::uint8_t>, HidFault> MemoryHidBus::report_descriptor(const HidNode& node) {
  const std::lock_guard lock(mutex_);
  const auto found = devices_.find(node.key);
  if (found == devices_.end()) return tl::unexpected<HidFault>({true, "it is gone", ""});
  return found->second->descriptor;
}

tl::expected<std::unique_ptr<HidDevice>, HidFault> MemoryHidBus::open(const HidNode& node) {
  const std::lock_guard lock(mutex_);
  const auto found = devices_.find(node.key);
  if (found == devices_.end()) return tl::unexpected<HidFault>({true, "it is gone", ""});
  auto& plugged = found->second;
  if (plugged->fails > 0) {
    --plugged->fails;
    return tl::unexpected<HidFault>({false, "permission denied", "check the udev rules"});
  }
  ++opened_;
  ++plugged->users;
  return std::make_unique<Device>(*this, plugged);
}

}  // namespace lackwerk::input
