// The framebuffer device: numbers that are believed and numbers that are not, pixels where they belong, and a whole
// output on a memory file.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/fb.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "kiosk/display/output/fbdev_layout.hpp"
#include "kiosk/display/output/fbdev_output.hpp"
#include "render_gles/framebuffer.hpp"

namespace lackwerk::test {
namespace {

using kiosk::ChannelOrder;
using kiosk::FbLayout;
using kiosk::FbWriter;

struct Screen {
  fb_var_screeninfo variable{};
  fb_fix_screeninfo fixed{};
};

fb_bitfield bits(unsigned offset, unsigned length) { return {offset, length, 0}; }

/// 32 bits, blue first, with lines 64 bytes longer than a picture's.
Screen xrgb(unsigned width, unsigned height) {
  Screen s;
  s.variable.xres = s.variable.xres_virtual = width;
  s.variable.yres = s.variable.yres_virtual = height;
  s.variable.bits_per_pixel = 32;
  s.variable.red = bits(16, 8);
  s.variable.green = bits(8, 8);
  s.variable.blue = bits(0, 8);
  s.fixed.type = FB_TYPE_PACKED_PIXELS;
  s.fixed.visual = FB_VISUAL_TRUECOLOR;
  s.fixed.line_length = width * 4 + 64;
  s.fixed.smem_len = s.fixed.line_length * height;
  return s;
}

Screen rgb565(unsigned width, unsigned height) {
  Screen s = xrgb(width, height);
  s.variable.bits_per_pixel = 16;
  s.variable.red = bits(11, 5);
  s.variable.green = bits(5, 6);
  s.variable.blue = bits(0, 5);
  s.fixed.line_length = width * 2 + 6;
  s.fixed.smem_len = s.fixed.line_length * height;
  return s;
}

Result<FbLayout> layout_of(const Screen& s) { return kiosk::fb_layout(s.variable, s.fixed, "/dev/fb0"); }

TEST(FbdevLayout, UsualOnesAreTaken) {
  const auto xrgb8888 = layout_of(xrgb(1280, 800));
  ASSERT_TRUE(xrgb8888) << xrgb8888.error().line();
  EXPECT_EQ(xrgb8888->size_px, (std::array<int, 2>{1280, 800}));
  EXPECT_EQ(xrgb8888->pixel_bytes, 4);
  EXPECT_EQ(xrgb8888->line_bytes, 1280u * 4 + 64);
  EXPECT_TRUE(xrgb8888->plain(ChannelOrder::bgr));
  EXPECT_FALSE(xrgb8888->plain(ChannelOrder::rgb));
  EXPECT_EQ(xrgb8888->refresh_hz, 0.0);
  const auto small = layout_of(rgb565(320, 240));
  ASSERT_TRUE(small) << small.error().line();
  EXPECT_EQ(small->pixel_bytes, 2);
  EXPECT_FALSE(small->plain(ChannelOrder::bgr));
}

TEST(FbdevLayout, RefreshComesFromTheTimings) {
  // VESA DMT 1280x1024 at 60 Hz: 108 MHz (9259 ps), 1688 columns and 1066 lines in all.
  Screen s = xrgb(1280, 1024);
  s.variable.pixclock = 9259;
  s.variable.left_margin = 248;
  s.variable.right_margin = 48;
  s.variable.hsync_len = 112;
  s.variable.upper_margin = 38;
  s.variable.lower_margin = 1;
  s.variable.vsync_len = 3;
  EXPECT_NEAR(layout_of(s)->refresh_hz, 60.02, 0.02);
  s.variable.pixclock = 1;
  EXPECT_EQ(layout_of(s)->refresh_hz, 0.0);  // nobody believes that
}

TEST(FbdevLayout, PannedPicturesStartElsewhere) {
  Screen s = xrgb(640, 400);
  s.variable.yres_virtual = 800;
  s.variable.yoffset = 400;
  s.variable.xoffset = 3;
  s.fixed.smem_len *= 2;
  const auto layout = layout_of(s);
  ASSERT_TRUE(layout) << layout.error().line();
  EXPECT_EQ(layout->start, 400u * s.fixed.line_length + 12u);
}

TEST(FbdevLayout, AbsurdNumbersAreRefusedByName) {
  struct Case {
    const char* field;
    std::function<void(Screen&)> change;
  };
  const std::vector<Case> cases = {
      {"size", [](Screen& s) { s.variable.xres = 0; }},
      {"size", [](Screen& s) { s.variable.yres = 0xffffffffu; }},
      {"size", [](Screen& s) { s.variable.xres = 8193; }},
      {"bits_per_pixel", [](Screen& s) { s.variable.bits_per_pixel = 8; }},
      {"bits_per_pixel", [](Screen& s) { s.variable.bits_per_pixel = 24; }},
      {"type", [](Screen& s) { s.fixed.type = FB_TYPE_PLANES; }},
      {"type", [](Screen& s) { s.fixed.visual = FB_VISUAL_PSEUDOCOLOR; }},
      {"type", [](Screen& s) { s.variable.grayscale = 1; }},
      {"channels", [](Screen& s) { s.variable.red = bits(25, 8); }},
      {"channels", [](Screen& s) { s.variable.red = bits(0xfffffff8u, 8); }},
      {"channels", [](Screen& s) { s.variable.green = bits(4, 8); }},
      {"channels", [](Screen& s) { s.variable.blue = bits(0, 0); }},
      {"channels", [](Screen& s) { s.variable.blue = bits(0, 32); }},
      {"channels", [](Screen& s) { s.variable.blue.msb_right = 1; }},
      {"line_length", [](Screen& s) { s.fixed.line_length = 640 * 4 - 1; }},
      {"line_length", [](Screen& s) { s.fixed.line_length = 0; }},
      {"smem_len", [](Screen& s) { s.fixed.smem_len = s.fixed.line_length * 400 - 65; }},
      {"smem_len", [](Screen& s) { s.fixed.smem_len = 0xffffffffu; }},
      {"smem_len", [](Screen& s) { s.variable.yoffset = 0xffffffffu; }},
      {"smem_len", [](Screen& s) { s.variable.xoffset = 0xffffffffu; }},
      {"smem_len", [](Screen& s) { s.fixed.line_length = 0xffffffffu; }},
  };
  ASSERT_TRUE(layout_of(xrgb(640, 400)));
  for (const Case& c : cases) {
    Screen s = xrgb(640, 400);
    c.change(s);
    const auto layout = layout_of(s);
    ASSERT_FALSE(layout) << c.field;
    EXPECT_EQ(layout.error().file, "/dev/fb0");
    EXPECT_EQ(layout.error().field, c.field) << layout.error().line();
    EXPECT_FALSE(layout.error().remedy.empty());
  }
}

/// A picture written into memory that knows whether more than lines was touched.
std::vector<std::byte> written(const FbLayout& layout, const std::vector<std::uint8_t>& picture) {
  std::vector<std::byte> memory(layout.map_bytes, std::byte{0xa5});
  FbWriter(layout).write(picture.data(), memory.data());
  return memory;
}

std::uint32_t pixel(const FbLayout& layout, const std::vector<std::byte>& memory, std::size_t x, std::size_t y) {
  std::uint32_t value = 0;
  const auto size = static_cast<std::size_t>(layout.pixel_bytes);
  std::memcpy(&value, &memory[layout.start + y * layout.line_bytes + x * size], size);
  return value;
}

std::vector<std::uint8_t> random_picture(const FbLayout& layout) {
  std::mt19937 random(3);
  std::vector<std::uint8_t> picture(static_cast<std::size_t>(layout.size_px[0]) *
                                    static_cast<std::size_t>(layout.size_px[1]) * 4);
  for (std::uint8_t& byte : picture) byte = static_cast<std::uint8_t>(random());
  return picture;
}

TEST(FbdevWriter, EightBitChannelsGoWhereTheDeviceSays) {
  // In any order and place, and the bytes between lines are nobody's.
  const std::array<std::array<unsigned, 3>, 4> places = {
      std::array<unsigned, 3>{16, 8, 0}, {0, 8, 16}, {24, 16, 8}, {3, 24, 13}};
  for (const auto& [red, green, blue] : places) {
    Screen s = xrgb(37, 11);
    s.variable.red = bits(red, 8);
    s.variable.green = bits(green, 8);
    s.variable.blue = bits(blue, 8);
    const auto layout = layout_of(s);
    ASSERT_TRUE(layout) << layout.error().line();
    const auto picture = random_picture(*layout);
    const auto memory = written(*layout, picture);
    const bool bgr = FbWriter(*layout).order() == ChannelOrder::bgr;
    EXPECT_EQ(bgr, red == 16 && green == 8 && blue == 0);
    for (std::size_t y = 0; y < 11; ++y) {
      for (std::size_t x = 0; x < 37; ++x) {
        const std::uint8_t* from = &picture[(y * 37 + x) * 4];
        const std::uint32_t value = pixel(*layout, memory, x, y);
        EXPECT_EQ(value >> red & 255u, from[bgr ? 2 : 0]);
        EXPECT_EQ(value >> green & 255u, from[1]);
        EXPECT_EQ(value >> blue & 255u, from[bgr ? 0 : 2]);
      }
      for (std::size_t k = 37 * 4; k < layout->line_bytes; ++k)
        EXPECT_EQ(memory[y * layout->line_bytes + k], std::byte{0xa5});
    }
  }
}

TEST(FbdevWriter, FewBitsKeepTheMeanAndTheEnds) {
  const auto layout = layout_of(rgb565(64, 64));
  ASSERT_TRUE(layout);
  double worst = 0.0;
  for (int value = 0; value < 256; ++value) {
    std::vector<std::uint8_t> picture(64 * 64 * 4, static_cast<std::uint8_t>(value));
    const auto memory = written(*layout, picture);
    std::array<double, 3> sum{};
    for (std::size_t y = 0; y < 64; ++y)
      for (std::size_t x = 0; x < 64; ++x) {
        const std::uint32_t p = pixel(*layout, memory, x, y);
        const std::array<std::uint32_t, 3> rgb = {p >> 11 & 31u, p >> 5 & 63u, p & 31u};
        const std::array<double, 3> most = {31.0, 63.0, 31.0};
        for (std::size_t k = 0; k < 3; ++k) {
          const double shown = rgb[k] * 255.0 / most[k];
          EXPECT_LE(std::abs(shown - value), 255.0 / most[k]);
          sum[k] += shown;
        }
        if (value == 0 || value == 255) {
          EXPECT_EQ(p, value == 0 ? 0u : 0xffffu);
        }
      }
    for (const double s : sum) worst = std::max(worst, std::abs(s / (64.0 * 64.0) - value));
  }
  std::printf("  mean of a field is at most %.3f of 255 off\n", worst);
  EXPECT_LE(worst, 255.0 / 31.0 / 64.0);  // one 64th of the coarser channel's step
}

// ---- a whole output on a memory file

struct Device {
  Screen screen;
  bool blank_works = true, has_blank = false;
  int error = 0;  ///< of every request, once set: the device is gone
  int vsyncs = 0;
  std::vector<std::uintptr_t> blanked;
  int memory = -1;  ///< ours; the output gets a copy

  explicit Device(const Screen& s) : screen(s), memory(memfd_create("lackwerk-fb", MFD_CLOEXEC)) {
    if (ftruncate(memory, s.fixed.smem_len) != 0) std::abort();
  }
  ~Device() { close(memory); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  kiosk::FbdevCalls calls() {
    return {[this](const std::string&) -> Result<int> { return fcntl(memory, F_DUPFD_CLOEXEC, 0); },
            [this](int, unsigned long request, void* data) {
              if (error != 0) {
                errno = error;
                return -1;
              }
              if (request == FBIOGET_VSCREENINFO) {
                *static_cast<fb_var_screeninfo*>(data) = screen.variable;
                return 0;
              }
              if (request == FBIOGET_FSCREENINFO) {
                *static_cast<fb_fix_screeninfo*>(data) = screen.fixed;
                return 0;
              }
              if (request == FBIO_WAITFORVSYNC) ++vsyncs;
              if (request == FBIO_WAITFORVSYNC && has_blank) return 0;
              if (request == FBIOBLANK && blank_works) {
                blanked.push_back(reinterpret_cast<std::uintptr_t>(data));
                return 0;
              }
              errno = ENOTTY;
              return -1;
            }};
  }
  [[nodiscard]] std::vector<std::byte> bytes() const {
    std::vector<std::byte> out(screen.fixed.smem_len);
    if (pread(memory, out.data(), out.size(), 0) != static_cast<ssize_t>(out.size())) std::abort();
    return out;
  }
};

class Fbdev : public testing::Test {
 protected:
  void open(Device& device, const kiosk::OutputSettings& settings = {}) {
    auto output = kiosk::open_fbdev(settings, log_, seat_, device.calls());
    if (!output && output.error().file != "/dev/fb0") GTEST_SKIP() << "no GL: " << output.error().line();
    ASSERT_TRUE(output) << output.error().line();
    output_ = std::move(*output);
  }
  /// One colour, as the panel needs it.
  [[nodiscard]] gles::Framebuffer picture(float red, float green, float blue) {
    const auto& mode = output_->mode();
    const auto size = kiosk::picture_size(mode.rotation, mode.panel_px);
    auto made = gles::Framebuffer::create(output_->context(), size[0], size[1]);
    if (!made) std::abort();
    made->bind();
    const gles::GlApi& gl = output_->context().gl();
    gl.ClearColor(red, green, blue, 1.0f);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    return std::move(*made);
  }
  kiosk::Log log_{nullptr};
  kiosk::Seat* seat_ = nullptr;
  std::unique_ptr<kiosk::Output> output_;
};

/// Taken and given back by the test.
class PlayedSeat final : public kiosk::Seat {
 public:
  Result<int> open_device(const std::string& path) override { return fail(path, "", "not given out"); }
  void close_device(int /*fd*/) override {}
  [[nodiscard]] int fd() const override { return 77; }
  void dispatch() override { active_ = next; }
  [[nodiscard]] bool active() const override { return active_; }
  [[nodiscard]] const std::string& description() const override { return description_; }
  bool next = true;

 private:
  bool active_ = true;
  std::string description_ = "played";
};

TEST_F(Fbdev, NothingIsWrittenWhileAnotherSessionHasTheSeat) {
  Device device(xrgb(32, 32));
  PlayedSeat seat;
  seat_ = &seat;
  ASSERT_NO_FATAL_FAILURE(open(device));
  if (IsSkipped()) return;
  std::vector<int> descriptors;
  output_->add_descriptors(descriptors);
  EXPECT_EQ(descriptors, std::vector<int>{77});
  { ASSERT_TRUE(output_->present(picture(1.0f, 0.0f, 0.0f))); }
  const auto memory = device.bytes();
  for (const bool active : {false, true}) {
    const auto before = output_->revision();
    seat.next = active;
    ASSERT_TRUE(output_->dispatch(0.0));
    EXPECT_GT(output_->revision(), before);
    EXPECT_EQ(output_->ready(), active);
    EXPECT_EQ(output_->state(), active ? kiosk::OutputState::running : kiosk::OutputState::suspended);
    const auto presented = output_->present(picture(0.0f, 1.0f, 0.0f));
    ASSERT_TRUE(presented);
    EXPECT_EQ(*presented, active ? kiosk::Presented::shown : kiosk::Presented::refused);
    EXPECT_EQ(device.bytes() == memory, !active);
  }
  output_.reset();
}

TEST_F(Fbdev, PicturesReachTheMemory) {
  Device device(xrgb(48, 20));
  ASSERT_NO_FATAL_FAILURE(open(device));
  if (IsSkipped()) return;
  EXPECT_EQ(output_->platform(), kiosk::Platform::fbdev);
  EXPECT_EQ(output_->state(), kiosk::OutputState::running);
  EXPECT_EQ(output_->mode().connector, "fb0");
  EXPECT_EQ(output_->mode().panel_px, (std::array<int, 2>{48, 20}));
  EXPECT_GT(output_->revision(), 0u);
  EXPECT_TRUE(output_->ready());
  {
    const auto red = picture(1.0f, 0.2f, 0.0f);
    const auto presented = output_->present(red);
    ASSERT_TRUE(presented) << presented.error().line();
    EXPECT_EQ(*presented, kiosk::Presented::shown);
  }
  EXPECT_EQ(output_->presented(), 1u);
  EXPECT_GT(output_->flipped_at_us(), 0u);
  const auto layout = layout_of(device.screen);
  const auto memory = device.bytes();
  for (std::size_t y = 0; y < 20; ++y)
    for (std::size_t x = 0; x < 48; ++x)
      EXPECT_EQ(pixel(*layout, memory, x, y) & 0xffffffu, 0xff3300u) << x << ',' << y;
  output_.reset();
}

TEST_F(Fbdev, TurnedPatternStandsWhereItShould) {
  Device device(rgb565(200, 120));
  kiosk::OutputSettings settings;
  settings.rotation = kiosk::Rotation::quarter;
  settings.test_pattern = true;
  ASSERT_NO_FATAL_FAILURE(open(device, settings));
  if (IsSkipped()) return;
  { ASSERT_TRUE(output_->present(picture(0.0f, 0.0f, 0.0f))); }
  const auto layout = layout_of(device.screen);
  const auto memory = device.bytes();
  EXPECT_EQ(pixel(*layout, memory, 0, 60), 0xffffu);  // the frame
  EXPECT_EQ(pixel(*layout, memory, 199, 0), 0xffffu);
  // The picture's upper left corner, with the red triangle, is the panel's upper right one.
  EXPECT_EQ(pixel(*layout, memory, 197, 2), 0xf800u);
  EXPECT_NE(pixel(*layout, memory, 2, 2), 0xf800u);
  output_.reset();
}

TEST_F(Fbdev, NoVerticalBlankIsAskedForOnce) {
  Device device(xrgb(32, 32));
  ASSERT_NO_FATAL_FAILURE(open(device));
  if (IsSkipped()) return;
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(output_->present(picture(0.0f, 1.0f, 0.0f)));
  }
  EXPECT_EQ(device.vsyncs, 1);
  EXPECT_EQ(output_->mode().refresh_hz, 0.0);
  output_.reset();
}

TEST_F(Fbdev, VerticalBlankIsUsedWhereThereIsOne) {
  Device device(xrgb(32, 32));
  device.has_blank = true;
  ASSERT_NO_FATAL_FAILURE(open(device));
  if (IsSkipped()) return;
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(output_->present(picture(0.0f, 1.0f, 0.0f)));
  }
  EXPECT_EQ(device.vsyncs, 3);
  output_.reset();
}

TEST_F(Fbdev, AnotherModeIsTakenUp) {
  Device device(xrgb(64, 64));
  ASSERT_NO_FATAL_FAILURE(open(device));
  if (IsSkipped()) return;
  { ASSERT_TRUE(output_->present(picture(0.0f, 1.0f, 0.0f))); }
  const auto before = output_->revision();
  const Screen small = rgb565(40, 30);
  device.screen.variable = small.variable;
  device.screen.fixed.line_length = small.fixed.line_length;
  {
    const auto presented = output_->present(picture(0.0f, 0.0f, 1.0f));
    ASSERT_TRUE(presented) << presented.error().line();
    EXPECT_EQ(*presented, kiosk::Presented::refused);
  }
  EXPECT_GT(output_->revision(), before);
  EXPECT_EQ(output_->mode().panel_px, (std::array<int, 2>{40, 30}));
  {
    const auto presented = output_->present(picture(0.0f, 0.0f, 1.0f));
    ASSERT_TRUE(presented);
    EXPECT_EQ(*presented, kiosk::Presented::shown);
  }
  const auto layout = layout_of(device.screen);
  EXPECT_EQ(pixel(*layout, device.bytes(), 39, 29), 0x001fu);
  output_.reset();
}

TEST_F(Fbdev, LostDeviceIsAnError) {
  Device device(xrgb(32, 32));
  ASSERT_NO_FATAL_FAILURE(open(device));
  if (IsSkipped()) return;
  device.error = ENODEV;
  {
    const auto presented = output_->present(picture(0.0f, 0.0f, 1.0f));
    ASSERT_FALSE(presented);
    EXPECT_EQ(presented.error().file, "/dev/fb0");
  }
  output_.reset();
}

TEST_F(Fbdev, PowerGoesOffAndOn) {
  for (const bool works : {true, false}) {
    Device device(xrgb(32, 32));
    device.blank_works = works;
    ASSERT_NO_FATAL_FAILURE(open(device));
    if (IsSkipped()) return;
    { ASSERT_TRUE(output_->present(picture(1.0f, 1.0f, 1.0f))); }
    output_->set_power(false);
    EXPECT_FALSE(output_->ready());
    {
      const auto presented = output_->present(picture(1.0f, 1.0f, 1.0f));
      ASSERT_TRUE(presented);
      EXPECT_EQ(*presented, kiosk::Presented::refused);
    }
    if (works) {
      EXPECT_EQ(device.blanked, (std::vector<std::uintptr_t>{FB_BLANK_UNBLANK, FB_BLANK_POWERDOWN}));
    } else {
      const auto memory = device.bytes();
      EXPECT_TRUE(std::all_of(memory.begin(), memory.end(), [](std::byte b) { return b == std::byte{0}; }));
    }
    const auto before = output_->revision();
    output_->set_power(true);
    EXPECT_GT(output_->revision(), before);  // draw again
    EXPECT_TRUE(output_->ready());
    output_.reset();
  }
}

TEST_F(Fbdev, NonsenseAndAbsenceAreErrors) {
  Device device(xrgb(32, 32));
  device.screen.fixed.smem_len = 100;
  auto refused = kiosk::open_fbdev({}, log_, nullptr, device.calls());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "smem_len");
  device.error = ENOTTY;  // a file that is no framebuffer
  refused = kiosk::open_fbdev({}, log_, nullptr, device.calls());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("does not tell its mode"), std::string::npos);
  kiosk::OutputSettings settings;
  settings.card = "/dev/fb9";
  refused = kiosk::open_fbdev(settings, log_);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().file, "/dev/fb9");
}

}  // namespace
}  // namespace lackwerk::test
