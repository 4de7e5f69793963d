// A simulated HID knob: through /dev/uhid (a Bluetooth-like device: hidraw, no USB) or through a USB gadget's
// /dev/hidgN (a USB device that libusb sees).
//
// Why it exists: the kiosk's knob reader must meet real descriptors and real kernel devices without hardware.
// Usage: dial uhid PROFILE FIFO          creates the device, then obeys the FIFO
//        dial hidg PROFILE FIFO NODE     sends reports to NODE, made by the script dial_gadget
//        dial describe PROFILE           writes the report descriptor to stdout
//        dial ids PROFILE                writes "VENDOR PRODUCT REPORT_BYTES NAME"
// Commands: turn UNITS | turns COUNT UNITS PERIOD_MS | press | release | click | unplug | plug | replug COUNT PERIOD_MS
// |
//           quit. Units are the descriptor's own, relative.
#include <fcntl.h>
#include <linux/uhid.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "command_fifo.hpp"

namespace {

using Bytes = std::vector<std::uint8_t>;

struct Profile {
  std::string name;
  std::uint32_t vendor, product;
  std::uint16_t bus;  ///< 3 USB, 5 Bluetooth
  Bytes descriptor;
  int limit;  ///< largest turn in one report
  Bytes (*report)(int turn, bool pressed);
};

// A knob nobody has heard of: Multi-axis Controller with one relative 8-bit Dial and a button, no report id. The kernel
// makes an evdev device of it too.
const Profile plain{"Plain test knob",
                    0x1209,
                    0x0001,
                    3,
                    {0x05, 0x01,  // usage page: generic desktop
                     0x09, 0x08,  // usage: multi-axis controller
                     0xa1, 0x01,  // application
                     0x05, 0x09,  //   usage page: button
                     0x19, 0x01,  //   usage: button 1
                     0x29, 0x01,  //
                     0x15, 0x00,  //   logical 0 to 1
                     0x25, 0x01,  //
                     0x75, 0x01,  //   1 bit
                     0x95, 0x01,  //   once
                     0x81, 0x02,  //   data, variable, absolute
                     0x75, 0x07,  //   7 bits of nothing
                     0x81, 0x03,  //
                     0x05, 0x01,  //   usage page: generic desktop
                     0x09, 0x37,  //   usage: dial
                     0x15, 0x81,  //   logical -127 to 127
                     0x25, 0x7f,  //
                     0x75, 0x08,  //   8 bits
                     0x95, 0x01,  //
                     0x81, 0x06,  //   data, variable, relative
                     0xc0},
                    127,
                    [](int turn, bool pressed) {
                      return Bytes{static_cast<std::uint8_t>(pressed ? 1 : 0), static_cast<std::uint8_t>(turn)};
                    }};

// The layout Microsoft documents for radial controllers: report id 1, a button bit, a 15-bit relative dial in tenths of
// a degree. Application 0x0e is none the kernel makes an evdev device of: hidraw is the only way in.
const Profile surface{"Surface-like test dial",
                      0x045e,
                      0x091b,
                      5,
                      {0x05, 0x01,        // usage page: generic desktop
                       0x09, 0x0e,        // usage: system multi-axis controller
                       0xa1, 0x01,        // application
                       0x85, 0x01,        //   report id 1
                       0x05, 0x0d,        //   usage page: digitiser
                       0x09, 0x21,        //   usage: puck
                       0xa1, 0x00,        //   physical
                       0x05, 0x09,        //     usage page: button
                       0x09, 0x01,        //     button 1
                       0x95, 0x01,        //
                       0x75, 0x01,        //     1 bit
                       0x15, 0x00,        //
                       0x25, 0x01,        //
                       0x81, 0x02,        //     data, variable, absolute
                       0x05, 0x01,        //     usage page: generic desktop
                       0x09, 0x37,        //     usage: dial
                       0x95, 0x01,        //
                       0x75, 0x0f,        //     15 bits
                       0x55, 0x0f,        //     unit exponent -1
                       0x65, 0x14,        //     unit: degrees
                       0x36, 0xf0, 0xf1,  //     physical -3600 to 3600
                       0x46, 0x10, 0x0e,  //
                       0x16, 0xf0, 0xf1,  //     logical -3600 to 3600
                       0x26, 0x10, 0x0e,  //
                       0x81, 0x06,        //     data, variable, relative
                       0xc0,              //
                       0xc0},
                      3600,
                      [](int turn, bool pressed) {
                        const auto word =
                            static_cast<std::uint16_t>((static_cast<unsigned>(turn) << 1U) | (pressed ? 1U : 0U));
                        return Bytes{1, static_cast<std::uint8_t>(word & 0xffU), static_cast<std::uint8_t>(word >> 8U)};
                      }};

/// Where reports go. Plugging is uhid's: a gadget is plugged by its script.
class Device {
 public:
  Device(const Profile& profile, const std::string& node) : profile_(profile), uhid_(node == "/dev/uhid") {
    fd_ = open(node.c_str(), O_RDWR | O_CLOEXEC);
    if (uhid_) plug();
  }
  ~Device() {
    if (fd_ >= 0) close(fd_);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  [[nodiscard]] bool good() const { return fd_ >= 0; }

  void plug() {
    if (!uhid_ || plugged_) return;
    uhid_event event{};
    event.type = UHID_CREATE2;
    uhid_create2_req& request = event.u.create2;
    std::snprintf(reinterpret_cast<char*>(request.name), sizeof request.name, "%s", profile_.name.c_str());
    std::snprintf(reinterpret_cast<char*>(request.uniq), sizeof request.uniq, "test-%d", static_cast<int>(getpid()));
    request.rd_size = static_cast<std::uint16_t>(profile_.descriptor.size());
    request.bus = profile_.bus;
    request.vendor = profile_.vendor;
    request.product = profile_.product;
    std::copy(profile_.descriptor.begin(), profile_.descriptor.end(), request.rd_data);
    plugged_ = send(event);
  }
  void unplug() {
    if (!uhid_ || !plugged_) return;
    uhid_event event{};
    event.type = UHID_DESTROY;
    send(event);
    plugged_ = false;
  }

  void report(int turn, bool pressed) {
    const Bytes bytes = profile_.report(turn, pressed);
    if (!uhid_) {
      if (write(fd_, bytes.data(), bytes.size()) < 0) std::perror("report");
      return;
    }
    uhid_event event{};
    event.type = UHID_INPUT2;
    event.u.input2.size = static_cast<std::uint16_t>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), event.u.input2.data);
    send(event);
  }

  /// Answers what the kernel asks; it would wait five seconds for a report nobody sends.
  void answer() {
    uhid_event event{};
    if (read(fd_, &event, sizeof event) <= 0) return;
    uhid_event reply{};
    if (event.type == UHID_GET_REPORT) {
      reply.type = UHID_GET_REPORT_REPLY;
      reply.u.get_report_reply.id = event.u.get_report.id;
      reply.u.get_report_reply.err = 5;  // EIO
      send(reply);
    } else if (event.type == UHID_SET_REPORT) {
      reply.type = UHID_SET_REPORT_REPLY;
      reply.u.set_report_reply.id = event.u.set_report.id;
      send(reply);
    }
  }
  [[nodiscard]] int to_answer() const { return uhid_ ? fd_ : -1; }

 private:
  bool send(const uhid_event& event) const {
    const bool sent = write(fd_, &event, sizeof event) == static_cast<ssize_t>(sizeof event);
    if (!sent) std::perror("uhid");
    return sent;
  }

  const Profile& profile_;
  bool uhid_;
  bool plugged_ = false;
  int fd_ = -1;
};

int obey(const Profile& profile, const std::string& node, const std::string& fifo_path) {
  Device device(profile, node);
  if (!device.good()) {
    std::perror(node.c_str());
    return 1;
  }
  vm::CommandFifo fifo(fifo_path);
  if (!fifo.good()) {
    std::perror(fifo_path.c_str());
    return 1;
  }
  bool pressed = false;
  const auto pause = [](int ms) { usleep(static_cast<useconds_t>(std::clamp(ms, 0, 60'000)) * 1000); };
  for (;;) {
    pollfd wanted[2] = {{fifo.descriptor(), POLLIN, 0}, {device.to_answer(), POLLIN, 0}};
    if (poll(wanted, 2, -1) < 0) continue;
    if (wanted[1].revents != 0) device.answer();
    if (wanted[0].revents == 0) continue;
    auto words = fifo.next();
    std::string command;
    words >> command;
    int count = 1, units = 0, period_ms = 0;
    if (command == "turn" || command == "turns") {
      if (command == "turns") words >> count;
      words >> units >> period_ms;
      for (int i = 0; i < count; ++i) {
        device.report(std::clamp(units, -profile.limit, profile.limit), pressed);
        if (period_ms > 0) pause(period_ms);
      }
    } else if (command == "press" || command == "release") {
      pressed = command == "press";
      device.report(0, pressed);
    } else if (command == "click") {
      device.report(0, true);
      pause(50);
      device.report(0, false);
    } else if (command == "unplug") {
      device.unplug();
    } else if (command == "plug") {
      device.plug();
    } else if (command == "replug") {
      words >> count >> period_ms;
      for (int i = 0; i < count; ++i) {
        device.unplug();
        pause(period_ms);
        device.plug();
        pause(period_ms);
      }
    } else if (command == "quit") {
      return 0;
    } else {
      std::fprintf(stderr, "dial: unknown command '%s'\n", command.c_str());
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const std::string mode = words.empty() ? "" : words[0];
  const std::string name = words.size() > 1 ? words[1] : "";
  if (name != "plain" && name != "surface") {
    std::fputs("usage: dial uhid|hidg|describe|ids plain|surface [FIFO [NODE]]\n", stderr);
    return 2;
  }
  const Profile& profile = name == "plain" ? plain : surface;
  if (mode == "describe") {
    std::fwrite(profile.descriptor.data(), 1, profile.descriptor.size(), stdout);
    return 0;
  }
  if (mode == "ids") {
    std::printf("0x%04x 0x%04x %zu %s\n", profile.vendor, profile.product, profile.report(0, false).size(),
                profile.name.c_str());
    return 0;
  }
  if (mode == "uhid" && words.size() == 3) return obey(profile, "/dev/uhid", words[2]);
  if (mode == "hidg" && words.size() == 4) return obey(profile, words[3], words[2]);
  return 2;
}
