#include "input/touch_libinput.hpp"

#include <fcntl.h>
#include <libinput.h>
#include <libudev.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <map>

#include "input/touch.hpp"

namespace lackwerk::input {
namespace {

constexpr std::size_t max_notices = 32;

template <auto destroy>
struct Destroy {
  template <class T>
  void operator()(T* object) const {
    destroy(object);
  }
};
using Udev = std::unique_ptr<udev, Destroy<udev_unref>>;
using Libinput = std::unique_ptr<libinput, Destroy<libinput_unref>>;
using Event = std::unique_ptr<libinput_event, Destroy<libinput_event_destroy>>;
using DeviceRef = std::unique_ptr<libinput_device, Destroy<libinput_device_unref>>;

std::string node_of(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

std::string text_of(const char* text) { return text != nullptr ? text : ""; }

/// What a node announces about its axes: libinput does not tell, and refuses some of the absurd without a word.
struct Axes {
  bool is_absolute = false;
  AxisRange x, y;
  int slots = 1;
  std::string name;
};

std::optional<AxisRange> range_of(int fd, unsigned axis) {
  input_absinfo info{};
  if (ioctl(fd, EVIOCGABS(axis), &info) < 0) return std::nullopt;
  return AxisRange{static_cast<double>(info.minimum), static_cast<double>(info.maximum)};
}

Axes axes_of(int fd) {
  constexpr std::size_t bits = 8 * sizeof(unsigned long);
  std::array<unsigned long, (ABS_CNT + bits - 1) / bits> present{};
  Axes axes;
  if (ioctl(fd, EVIOCGBIT(EV_ABS, sizeof present), present.data()) < 0) return axes;
  const auto has = [&](unsigned axis) { return (present[axis / bits] >> (axis % bits) & 1UL) != 0; };
  const bool many = has(ABS_MT_POSITION_X) && has(ABS_MT_POSITION_Y);
  // Dials and gamepads have such axes too; they are nobody's touch screen.
  std::array<unsigned long, (KEY_CNT + bits - 1) / bits> keys{};
  const auto is_key = [&](unsigned key) { return (keys[key / bits] >> (key % bits) & 1UL) != 0; };
  const bool pressed =
      ioctl(fd, EVIOCGBIT(EV_KEY, sizeof keys), keys.data()) >= 0 && (is_key(BTN_TOUCH) || is_key(BTN_LEFT));
  axes.is_absolute = many || (pressed && has(ABS_X) && has(ABS_Y));
  if (!axes.is_absolute) return axes;
  const auto x = range_of(fd, many ? ABS_MT_POSITION_X : ABS_X);
  const auto y = range_of(fd, many ? ABS_MT_POSITION_Y : ABS_Y);
  if (x) axes.x = *x;
  if (y) axes.y = *y;
  if (has(ABS_MT_SLOT))
    if (const auto slots = range_of(fd, ABS_MT_SLOT)) axes.slots = static_cast<int>(slots->most) + 1;
  std::array<char, 256> name{};
  if (ioctl(fd, EVIOCGNAME(name.size() - 1), name.data()) >= 0) axes.name = name.data();
  return axes;
}

class LibinputFeed final : public TouchFeed {
 public:
  explicit LibinputFeed(DeviceAccess access) : access_(std::move(access)) {}

  Result<void> start(const std::string& seat) {
    static constexpr libinput_interface interface {
      [](const char* path, int flags, void* self) { return static_cast<LibinputFeed*>(self)->open(path, flags); },
          [](int fd, void* self) { static_cast<LibinputFeed*>(self)->access_.close(fd); }
    };
    udev_.reset(udev_new());
    if (!udev_) return fail("udev", "", "does not answer", "is systemd-udevd running?");
    libinput_.reset(libinput_udev_create_context(&interface, this, udev_.get()));
    if (!libinput_) return fail("libinput", "", "cannot begin", "is systemd-udevd running?");
    libinput_log_set_handler(libinput_.get(), &LibinputFeed::log);
    if (libinput_udev_assign_seat(libinput_.get(), seat.c_str()) != 0)
      return fail("libinput", seat, "the seat cannot be watched", "is systemd-udevd running?");
    return {};
  }

  void add_descriptors(std::vector<int>& out) const override { out.push_back(libinput_get_fd(libinput_.get())); }

  void read(std::vector<RawTouch>& out) override {
    if (const int code = libinput_dispatch(libinput_.get()); code != 0)
      say(true, "libinput cannot read: error " + std::to_string(-code));
    for (std::size_t k = 0; k < max_raw_a_read; ++k) {
      const Event event(libinput_get_event(libinput_.get()));
      if (!event) break;
      translate(event.get(), out);
    }
    for (TouchDevice& device : refused_) out.push_back(added(std::move(device)));
    refused_.clear();
  }

  [[nodiscard]] bool has_more() const override {
    return libinput_next_event_type(libinput_.get()) != LIBINPUT_EVENT_NONE;
  }

  bool calibrate(int device, const CalibrationMatrix& matrix) override {
    const auto found = devices_.find(device);
    if (found == devices_.end() || libinput_device_config_calibration_has_matrix(found->second.get()) == 0)
      return false;
    std::array<float, 6> rows{};
    std::transform(matrix.begin(), matrix.end(), rows.begin(), [](double m) { return static_cast<float>(m); });
    return libinput_device_config_calibration_set_matrix(found->second.get(), rows.data()) ==
           LIBINPUT_CONFIG_STATUS_SUCCESS;
  }

  void suspend() override { libinput_suspend(libinput_.get()); }
  bool resume() override { return libinput_resume(libinput_.get()) == 0; }

  void take_notices(std::vector<Notice>& out) override {
    out.insert(out.end(), std::make_move_iterator(notices_.begin()), std::make_move_iterator(notices_.end()));
    notices_.clear();
  }

 private:
  int open(const char* path, int flags) noexcept {
    const int fd = access_.open(path, flags);
    if (fd < 0) {
      say(true, std::string(path) + " cannot be opened: error " + std::to_string(-fd) +
                    "; is the kiosk's user in the group input, or the seat active?");
      return fd;
    }
    const Axes axes = axes_of(fd);
    if (!axes.is_absolute) return fd;
    const std::string node = node_of(path);
    TouchDevice device = with_axes(axes, node);
    // Not shown to libinput at all, which divides by the range.
    if (refusal_of(device)) {
      device.id = next_id_++;
      device.name = axes.name;
      if (refused_.size() < max_touch_devices) refused_.push_back(std::move(device));
      access_.close(fd);
      return -ENODEV;
    }
    axes_[node] = axes;
    return fd;
  }

  static TouchDevice with_axes(const Axes& axes, const std::string& node) {
    TouchDevice device;
    device.node = node;
    device.x = axes.x;
    device.y = axes.y;
    device.slots = axes.slots;
    return device;
  }

  static RawTouch added(TouchDevice device) {
    RawTouch event;
    event.kind = RawTouch::Kind::added;
    event.device = device.id;
    event.added = std::move(device);
    return event;
  }

  void add(libinput_device* device, std::vector<RawTouch>& out) {
    const bool is_screen = libinput_device_has_capability(device, LIBINPUT_DEVICE_CAP_TOUCH) != 0;
    const bool is_pointer = libinput_device_has_capability(device, LIBINPUT_DEVICE_CAP_POINTER) != 0 &&
                            libinput_device_pointer_has_button(device, BTN_LEFT) == 1;
    const std::string node = text_of(libinput_device_get_sysname(device));
    const auto axes = axes_.find(node);
    TouchDevice found = with_axes(axes != axes_.end() ? axes->second : Axes{}, node);
    if (axes != axes_.end()) axes_.erase(axes);
    if (!is_screen && !is_pointer) {
      // Keyboards, switches, pens: nothing here listens, so their events need not wake the kiosk.
      libinput_device_config_send_events_set_mode(device, LIBINPUT_CONFIG_SEND_EVENTS_DISABLED);
      return;
    }
    const bool is_absolute = libinput_device_config_calibration_has_matrix(device) != 0;
    found.kind = is_screen ? TouchKind::screen : is_absolute ? TouchKind::pointer : TouchKind::mouse;
    found.id = next_id_++;
    found.name = text_of(libinput_device_get_name(device));
    found.output = text_of(libinput_device_get_output_name(device));
    found.vendor = libinput_device_get_id_vendor(device);
    found.product = libinput_device_get_id_product(device);
    devices_[found.id] = DeviceRef(libinput_device_ref(device));
    out.push_back(added(std::move(found)));
  }

  /// 0: not one of ours.
  [[nodiscard]] int id_of(libinput_device* device) const {
    for (const auto& [id, known] : devices_)
      if (known.get() == device) return id;
    return 0;
  }

  void translate(libinput_event* event, std::vector<RawTouch>& out) {
    libinput_device* device = libinput_event_get_device(event);
    const libinput_event_type type = libinput_event_get_type(event);
    if (type == LIBINPUT_EVENT_DEVICE_ADDED) return add(device, out);
    RawTouch raw;
    raw.device = id_of(device);
    if (raw.device == 0) return;
    switch (type) {
      case LIBINPUT_EVENT_DEVICE_REMOVED:
        raw.kind = RawTouch::Kind::removed;
        devices_.erase(raw.device);
        break;
      case LIBINPUT_EVENT_TOUCH_DOWN:
      case LIBINPUT_EVENT_TOUCH_MOTION:
      case LIBINPUT_EVENT_TOUCH_UP:
      case LIBINPUT_EVENT_TOUCH_CANCEL:
        translate(libinput_event_get_touch_event(event), type, raw);
        break;
      case LIBINPUT_EVENT_POINTER_MOTION:
      case LIBINPUT_EVENT_POINTER_MOTION_ABSOLUTE:
      case LIBINPUT_EVENT_POINTER_BUTTON:
        if (!translate(libinput_event_get_pointer_event(event), type, raw)) return;
        break;
      default:
        return;
    }
    out.push_back(std::move(raw));
  }

  static void translate(libinput_event_touch* touch, libinput_event_type type, RawTouch& raw) {
    raw.slot = libinput_event_touch_get_slot(touch);  // -1: a device without slots
    raw.time_us = libinput_event_touch_get_time_usec(touch);
    if (type == LIBINPUT_EVENT_TOUCH_UP || type == LIBINPUT_EVENT_TOUCH_CANCEL) {
      raw.kind = type == LIBINPUT_EVENT_TOUCH_UP ? RawTouch::Kind::up : RawTouch::Kind::cancel;
      return;
    }
    raw.kind = type == LIBINPUT_EVENT_TOUCH_DOWN ? RawTouch::Kind::down : RawTouch::Kind::move;
    raw.x = libinput_event_touch_get_x_transformed(touch, 1);
    raw.y = libinput_event_touch_get_y_transformed(touch, 1);
  }

  static bool translate(libinput_event_pointer* pointer, libinput_event_type type, RawTouch& raw) {
    raw.time_us = libinput_event_pointer_get_time_usec(pointer);
    if (type == LIBINPUT_EVENT_POINTER_BUTTON) {
      if (libinput_event_pointer_get_button(pointer) != BTN_LEFT) return false;
      const bool down = libinput_event_pointer_get_button_state(pointer) == LIBINPUT_BUTTON_STATE_PRESSED;
      raw.kind = down ? RawTouch::Kind::press : RawTouch::Kind::release;
    } else if (type == LIBINPUT_EVENT_POINTER_MOTION) {
      raw.kind = RawTouch::Kind::nudge;
      raw.x = libinput_event_pointer_get_dx(pointer);
      raw.y = libinput_event_pointer_get_dy(pointer);
    } else {
      raw.kind = RawTouch::Kind::point;
      raw.x = libinput_event_pointer_get_absolute_x_transformed(pointer, 1);
      raw.y = libinput_event_pointer_get_absolute_y_transformed(pointer, 1);
    }
    return true;
  }

  // NOLINTNEXTLINE(cert-dcl50-cpp): libinput's signature
  static void log(libinput* context, libinput_log_priority priority, const char* format, va_list values) {
    std::array<char, 256> line{};
    std::vsnprintf(line.data(), line.size(), format, values);
    std::string text = line.data();
    text.erase(std::find(text.begin(), text.end(), '\n'), text.end());
    static_cast<LibinputFeed*>(libinput_get_user_data(context))
        ->say(priority >= LIBINPUT_LOG_PRIORITY_ERROR, "libinput: " + text);
  }

  void say(bool problem, std::string text) {
    const bool said = std::any_of(notices_.begin(), notices_.end(), [&](const Notice& n) { return n.text == text; });
    if (!said && notices_.size() < max_notices) notices_.push_back({problem, std::move(text)});
  }

  DeviceAccess access_;
  std::map<std::string, Axes> axes_;  ///< of nodes that are open and not yet added
  std::vector<TouchDevice> refused_;  ///< not yet told
  std::vector<Notice> notices_;
  int next_id_ = 1;
  // Last, so that they go first: closing devices calls back. Of these, device references before their context.
  Udev udev_;
  Libinput libinput_;
  std::map<int, DeviceRef> devices_;
};

}  // namespace

DeviceAccess direct_access() {
  return {[](const std::string& path, int flags) {
            const int fd = ::open(path.c_str(), flags | O_CLOEXEC);
            return fd < 0 ? -errno : fd;
          },
          [](int fd) { ::close(fd); }};
}

Result<std::unique_ptr<TouchFeed>> open_libinput(const std::string& seat, DeviceAccess access) {
  auto feed = std::make_unique<LibinputFeed>(std::move(access));
  if (auto started = feed->start(seat); !started) return tl::unexpected(started.error());
  return feed;
}

}  // namespace lackwerk::input
