// A simulated touch screen through /dev/uinput: ten slots, protocol B, as panels behave.
//
// Why it exists: the emulator's own pointer is a tablet, not a screen under fingers; two of them are needed to pinch.
// Usage: touch FIFO [NAME]
// Commands, places as fractions of the screen from its top left corner:
//   tap X Y | drag X0 Y0 X1 Y1 STEPS PERIOD_MS | pinch X Y R0 R1 STEPS PERIOD_MS (two fingers level with each other) |
//   down SLOT X Y | move SLOT X Y | up SLOT | quit
#include <fcntl.h>
#include <linux/uinput.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "command_fifo.hpp"

namespace {

constexpr int slots = 10;
constexpr int range = 4095;  // of both axes
constexpr int units_per_mm = 12;

class Screen {
 public:
  explicit Screen(const std::string& name) {
    fd_ = open("/dev/uinput", O_WRONLY | O_CLOEXEC);
    if (fd_ < 0) return;
    bool made = ioctl(fd_, UI_SET_EVBIT, EV_KEY) == 0 && ioctl(fd_, UI_SET_KEYBIT, BTN_TOUCH) == 0 &&
                ioctl(fd_, UI_SET_EVBIT, EV_ABS) == 0 && ioctl(fd_, UI_SET_PROPBIT, INPUT_PROP_DIRECT) == 0;
    const auto axis = [&](int code, int maximum, int resolution) {
      uinput_abs_setup setup{};
      setup.code = static_cast<__u16>(code);
      setup.absinfo.maximum = maximum;
      setup.absinfo.resolution = resolution;
      made = made && ioctl(fd_, UI_ABS_SETUP, &setup) == 0;
    };
    axis(ABS_X, range, units_per_mm);
    axis(ABS_Y, range, units_per_mm);
    axis(ABS_MT_SLOT, slots - 1, 0);
    axis(ABS_MT_TRACKING_ID, 65535, 0);
    axis(ABS_MT_POSITION_X, range, units_per_mm);
    axis(ABS_MT_POSITION_Y, range, units_per_mm);
    uinput_setup setup{};
    setup.id = {BUS_USB, 0x1209, 0x0002, 1};
    std::snprintf(setup.name, sizeof setup.name, "%s", name.c_str());
    made = made && ioctl(fd_, UI_DEV_SETUP, &setup) == 0 && ioctl(fd_, UI_DEV_CREATE) == 0;
    if (!made) {
      close(fd_);
      fd_ = -1;
    }
  }
  ~Screen() {
    if (fd_ >= 0) close(fd_);
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  [[nodiscard]] bool good() const { return fd_ >= 0; }

  void down(int slot, double x, double y) {
    select(slot);
    emit(EV_ABS, ABS_MT_TRACKING_ID, next_id_++ % 65536);
    place(slot, x, y);
    if (held_++ == 0) emit(EV_KEY, BTN_TOUCH, 1);
  }
  void move(int slot, double x, double y) {
    select(slot);
    place(slot, x, y);
  }
  void up(int slot) {
    select(slot);
    emit(EV_ABS, ABS_MT_TRACKING_ID, -1);
    if (held_ > 0 && --held_ == 0) emit(EV_KEY, BTN_TOUCH, 0);
  }
  void sync() { emit(EV_SYN, SYN_REPORT, 0); }

 private:
  void select(int slot) { emit(EV_ABS, ABS_MT_SLOT, std::clamp(slot, 0, slots - 1)); }
  void place(int slot, double x, double y) {
    const int px = static_cast<int>(std::lround(std::clamp(x, 0.0, 1.0) * range));
    const int py = static_cast<int>(std::lround(std::clamp(y, 0.0, 1.0) * range));
    emit(EV_ABS, ABS_MT_POSITION_X, px);
    emit(EV_ABS, ABS_MT_POSITION_Y, py);
    if (slot != 0) return;  // the single-touch axes follow the first finger
    emit(EV_ABS, ABS_X, px);
    emit(EV_ABS, ABS_Y, py);
  }
  void emit(int type, int code, int value) const {
    input_event event{};
    event.type = static_cast<__u16>(type);
    event.code = static_cast<__u16>(code);
    event.value = value;
    if (write(fd_, &event, sizeof event) != static_cast<ssize_t>(sizeof event)) std::perror("uinput");
  }

  int fd_ = -1;
  int next_id_ = 1;
  int held_ = 0;
};

void pause(int ms) { usleep(static_cast<useconds_t>(std::clamp(ms, 0, 10'000)) * 1000); }

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: touch FIFO [NAME]\n", stderr);
    return 2;
  }
  Screen screen(argc > 2 ? argv[2] : "Test touch screen");
  if (!screen.good()) {
    std::perror("/dev/uinput");
    return 1;
  }
  vm::CommandFifo fifo(argv[1]);
  if (!fifo.good()) {
    std::perror(argv[1]);
    return 1;
  }
  for (;;) {
    auto words = fifo.next();
    std::string command;
    words >> command;
    int slot = 0, steps = 10, period_ms = 20;
    double x = 0, y = 0, x1 = 0, y1 = 0;
    if (command == "tap") {
      words >> x >> y;
      screen.down(0, x, y);
      screen.sync();
      pause(80);
      screen.up(0);
      screen.sync();
    } else if (command == "drag") {
      words >> x >> y >> x1 >> y1 >> steps >> period_ms;
      screen.down(0, x, y);
      screen.sync();
      for (int i = 1; i <= steps; ++i) {
        pause(period_ms);
        const double t = static_cast<double>(i) / steps;
        screen.move(0, x + t * (x1 - x), y + t * (y1 - y));
        screen.sync();
      }
      pause(period_ms);
      screen.up(0);
      screen.sync();
    } else if (command == "pinch") {
      words >> x >> y >> x1 >> y1 >> steps >> period_ms;  // x1, y1: radius at first and at last
      screen.down(0, x - x1, y);
      screen.down(1, x + x1, y);
      screen.sync();
      for (int i = 1; i <= steps; ++i) {
        pause(period_ms);
        const double radius = x1 + static_cast<double>(i) / steps * (y1 - x1);
        screen.move(0, x - radius, y);
        screen.move(1, x + radius, y);
        screen.sync();
      }
      pause(period_ms);
      screen.up(0);
      screen.up(1);
      screen.sync();
    } else if (command == "down" || command == "move") {
      words >> slot >> x >> y;
      if (command == "down")
        screen.down(slot, x, y);
      else
        screen.move(slot, x, y);
      screen.sync();
    } else if (command == "up") {
      words >> slot;
      screen.up(slot);
      screen.sync();
    } else if (command == "quit") {
      return 0;
    } else {
      std::fprintf(stderr, "touch: unknown command '%s'\n", command.c_str());
    }
  }
}
