#include "kiosk/display/output/kms_output.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <optional>

#include "kiosk/display/output/drm_fake.hpp"
#include "kiosk/display/output/headless_output.hpp"
#include "kiosk/display/output/kms_dumb.hpp"

namespace lackwerk::kiosk {
namespace {

using Call = FakeKmsDevice::Call;
using Rgb = std::array<int, 3>;

constexpr Rgb red{255, 0, 0}, green{0, 255, 0}, blue{0, 0, 255}, white{255, 255, 255};

/// A seat that a test takes and gives back.
class FakeSeat final : public Seat {
 public:
  Result<int> open_device(const std::string& path) override { return fail(path, "", "no devices here"); }
  void close_device(int /*fd*/) override { ++closed; }
  [[nodiscard]] int fd() const override { return -1; }
  void dispatch() override {}
  [[nodiscard]] bool active() const override { return here; }
  [[nodiscard]] const std::string& description() const override { return name_; }
  bool here = true;
  int closed = 0;

 private:
  std::string name_ = "fake";
};

/// Red, green, blue and white in the picture's upper left, upper right, lower left and lower right quarter.
gles::Framebuffer quarters(const gles::Context& context, std::array<int, 2> size_px) {
  auto made = gles::Framebuffer::create(context, size_px[0], size_px[1], gles::PixelFormat::rgba8, false);
  EXPECT_TRUE(made.has_value());
  const gles::GlApi& gl = context.gl();
  gl.BindTexture(GL_TEXTURE_2D, made->texture());
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < size_px[1]; ++y)
    for (int x = 0; x < size_px[0]; ++x) {
      const bool upper = y >= size_px[1] / 2, left = x < size_px[0] / 2;  // row 0 is the bottom
      const Rgb colour = upper ? (left ? red : green) : (left ? blue : white);
      for (const int channel : colour) pixels.push_back(static_cast<std::uint8_t>(channel));
      pixels.push_back(255);
    }
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, size_px[0], size_px[1], 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  return std::move(*made);
}

class DumbOutputTest : public testing::Test {
 protected:
  void open(Rotation rotation = Rotation::none) {
    auto fake = std::make_unique<FakeKmsDevice>();
    device = fake.get();
    device->add_connector("HDMI-A-1");
    // 100 pixels are 400 bytes, padded to 512: rows are longer than the picture.
    device->plug("HDMI-A-1", {simple_mode(100, 60, 60.0, true)});
    OutputSettings settings;
    settings.rotation = rotation;
    auto surface = make_dumb_surface(*fake, settings.context, log);
    if (!surface) GTEST_SKIP() << "no GL here: " << surface.error().line();
    KmsParts parts;
    parts.seat = &seat;
    parts.opened = SeatDevice(seat, 3);
    parts.device = std::move(fake);
    parts.surface = std::move(*surface);
    auto monitor = std::make_unique<input::MemoryDeviceMonitor>();
    hotplug = monitor.get();
    parts.hotplug = std::move(monitor);
    output.emplace(std::move(parts), settings, log, [this] { return now; });
    const auto started = output->start();
    ASSERT_TRUE(started.has_value()) << started.error().line();
  }
  Presented present() {
    const auto size = picture_size(output->mode().rotation, output->mode().panel_px);
    const auto shown = output->present(quarters(output->context(), size));
    EXPECT_TRUE(shown.has_value()) << (shown ? "" : shown.error().line());
    return shown.value_or(Presented::refused);
  }
  void pass(double ms) {
    now += ms;
    const auto done = output->dispatch(now);
    ASSERT_TRUE(done.has_value()) << done.error().line();
  }
  void tell_hotplug() {
    input::DeviceEvent event;
    event.action = input::DeviceEvent::Action::changed;
    event.subsystem = "drm";
    hotplug->tell(event);
  }
  /// A pixel of the panel, from the memory that is scanned out.
  [[nodiscard]] Rgb panel_pixel(int x, int y) const {
    std::uint32_t pitch = 0;
    const std::uint8_t* pixels = device->pixels(device->panel("HDMI-A-1").framebuffer, pitch);
    EXPECT_NE(pixels, nullptr);
    if (pixels == nullptr) return {};
    const std::uint8_t* p = pixels + static_cast<std::size_t>(y) * pitch + static_cast<std::size_t>(x) * 4;
    return {p[2], p[1], p[0]};  // B, G, R, X
  }
  /// Colour that the picture has at a point of [0, 1]^2.
  static Rgb quarter(Point p) { return p[1] < 0.5 ? (p[0] < 0.5 ? red : green) : (p[0] < 0.5 ? blue : white); }

  FakeSeat seat;
  input::MemoryDeviceMonitor* hotplug = nullptr;
  Log log{nullptr};
  double now = 1000.0;
  FakeKmsDevice* device = nullptr;
  std::optional<KmsOutput> output;
};

class DumbRotation : public DumbOutputTest, public testing::WithParamInterface<Rotation> {};

TEST_P(DumbRotation, PixelsGoWhereTouchesComeFrom) {
  ASSERT_NO_FATAL_FAILURE(open(GetParam()));
  if (IsSkipped()) return;
  ASSERT_EQ(present(), Presented::queued);
  pass(17.0);
  ASSERT_EQ(output->mode().panel_px, (std::array{100, 60}));
  for (const Point panel : {Point{0.02, 0.02}, Point{0.98, 0.02}, Point{0.02, 0.98}, Point{0.98, 0.98}, Point{0.4, 0.4},
                            Point{0.6, 0.4}, Point{0.4, 0.6}, Point{0.6, 0.6}})
    EXPECT_EQ(panel_pixel(static_cast<int>(panel[0] * 100), static_cast<int>(panel[1] * 60)),
              quarter(picture_point(GetParam(), panel)))
        << panel[0] << ", " << panel[1];
}
INSTANTIATE_TEST_SUITE_P(AllFour, DumbRotation,
                         testing::Values(Rotation::none, Rotation::quarter, Rotation::half, Rotation::three_quarters));

TEST_F(DumbOutputTest, TwoBuffersTakeTurns) {
  ASSERT_NO_FATAL_FAILURE(open());
  if (IsSkipped()) return;
  EXPECT_EQ(output->platform(), Platform::dumb);
  std::vector<DrmId> seen;
  for (int k = 0; k < 6; ++k) {
    ASSERT_TRUE(output->ready());
    ASSERT_EQ(present(), Presented::queued);
    EXPECT_FALSE(output->ready());
    EXPECT_EQ(present(), Presented::refused) << "one at a time";
    pass(17.0);
    seen.push_back(device->panel("HDMI-A-1").framebuffer);
    if (k > 0) {
      EXPECT_NE(seen[static_cast<std::size_t>(k)], seen[static_cast<std::size_t>(k) - 1]);
    }
  }
  EXPECT_EQ(seen[0], seen[2]);
  EXPECT_EQ(device->dumb_buffers(), 2u);
  EXPECT_EQ(output->presented(), 6u);
}

TEST_F(DumbOutputTest, AnotherMonitorGetsBuffersOfItsOwn) {
  ASSERT_NO_FATAL_FAILURE(open());
  if (IsSkipped()) return;
  ASSERT_EQ(present(), Presented::queued);
  pass(17.0);
  const auto before = output->revision();
  const auto old = quarters(output->context(), {100, 60});
  device->plug("HDMI-A-1", {simple_mode(200, 120, 60.0, true)});
  tell_hotplug();
  pass(300.0);
  pass(300.0);
  EXPECT_GT(output->revision(), before);
  EXPECT_EQ(output->mode().panel_px, (std::array{200, 120}));
  const auto stale = output->present(old);
  ASSERT_TRUE(stale.has_value());
  EXPECT_EQ(*stale, Presented::refused) << "a picture of the mode before";
  ASSERT_EQ(present(), Presented::queued);
  pass(17.0);
  EXPECT_EQ(panel_pixel(198, 118), white);
  EXPECT_EQ(device->dumb_buffers(), 2u);
  EXPECT_EQ(device->framebuffers(), 2u);
}

TEST_F(DumbOutputTest, UnplugReplugAndTheSeat) {
  ASSERT_NO_FATAL_FAILURE(open());
  if (IsSkipped()) return;
  ASSERT_EQ(present(), Presented::queued);
  pass(17.0);
  device->unplug("HDMI-A-1");
  tell_hotplug();
  pass(1.0);
  pass(300.0);
  EXPECT_EQ(output->state(), OutputState::waiting_for_display);
  EXPECT_EQ(present(), Presented::refused);
  device->plug("HDMI-A-1", {simple_mode(100, 60, 60.0, true)});
  tell_hotplug();
  pass(1.0);
  pass(300.0);
  EXPECT_EQ(output->state(), OutputState::running);
  ASSERT_EQ(present(), Presented::queued);
  pass(17.0);
  seat.here = false;
  pass(1.0);
  EXPECT_EQ(output->state(), OutputState::suspended);
  EXPECT_FALSE(device->master());
  seat.here = true;
  pass(1.0);
  EXPECT_EQ(output->state(), OutputState::running);
  ASSERT_EQ(present(), Presented::queued);
  pass(17.0);
  EXPECT_EQ(panel_pixel(2, 2), red);
}

TEST_F(DumbOutputTest, NoMemoryForBuffersPassesButNotForEver) {
  ASSERT_NO_FATAL_FAILURE(open());
  if (IsSkipped()) return;
  device->fail_next(Call::dumb, ENOMEM, 2);
  EXPECT_EQ(present(), Presented::refused);
  EXPECT_FALSE(output->ready());
  EXPECT_LT(output->wake_at_ms(), now + 1000.0);
  pass(output->wake_at_ms() - now);
  EXPECT_EQ(present(), Presented::refused);
  pass(output->wake_at_ms() - now);
  EXPECT_EQ(present(), Presented::queued);
  EXPECT_EQ(device->dumb_buffers(), 2u);
  pass(17.0);

  device->plug("HDMI-A-1", {simple_mode(200, 120, 60.0, true)});
  tell_hotplug();
  pass(300.0);
  pass(300.0);
  device->fail_next(Call::dumb, ENOMEM, 1000);
  int tries = 0;
  for (; tries < 100; ++tries) {
    const auto shown = output->present(quarters(output->context(), {200, 120}));
    if (!shown) break;
    EXPECT_EQ(*shown, Presented::refused);
    pass(output->wake_at_ms() - now);
  }
  EXPECT_GT(tries, 5);
  EXPECT_LT(tries, 100) << "a fresh process does better";
}

TEST_F(DumbOutputTest, PollsTheHotPlugAndGivesTheDeviceBack) {
  ASSERT_NO_FATAL_FAILURE(open());
  if (IsSkipped()) return;
  std::vector<int> descriptors;
  output->add_descriptors(descriptors);
  EXPECT_EQ(descriptors, std::vector<int>{hotplug->descriptor()});  // the fake card has none
  EXPECT_EQ(seat.closed, 0);
  output.reset();
  EXPECT_EQ(seat.closed, 1);
}

TEST_F(DumbOutputTest, ACardWithoutDumbBuffersIsRefusedWithTheReason) {
  FakeKmsDevice card;
  card.remove_dumb_buffers();
  const auto surface = make_dumb_surface(card, {}, log);
  ASSERT_FALSE(surface.has_value());
  EXPECT_NE(surface.error().line().find("driver fake has none"), std::string::npos) << surface.error().line();
}

TEST(HeadlessOutput, ShowsPicturesAsAPanelWould) {
  Log log(nullptr);
  OutputSettings settings;
  settings.size_px = {40, 30};
  settings.rotation = Rotation::quarter;
  for (const Platform platform : {Platform::surfaceless, Platform::osmesa}) {
    settings.platform = platform;
    auto output = make_headless_output(settings, log);
    if (!output) GTEST_SKIP() << output.error().line();
    EXPECT_EQ((*output)->platform(), platform);
    EXPECT_EQ((*output)->last().width, 0);
    const auto picture = quarters((*output)->context(), {30, 40});
    ASSERT_EQ((*output)->present(picture).value_or(Presented::refused), Presented::shown);
    EXPECT_EQ((*output)->presented(), 1u);
    EXPECT_GT((*output)->flipped_at_us(), 0u);
    const gles::Image image = (*output)->last();
    ASSERT_EQ(image.width, 40);
    ASSERT_EQ(image.height, 30);
    // A clockwise quarter turn: the picture's upper left corner stands at the panel's upper right one.
    EXPECT_EQ(std::memcmp(image.pixel(39, 0), "\xff\x00\x00", 3), 0);
    EXPECT_EQ(std::memcmp(image.pixel(39, 29), "\x00\xff\x00", 3), 0);
    EXPECT_EQ(std::memcmp(image.pixel(0, 0), "\x00\x00\xff", 3), 0);
    (*output)->set_power(false);
    EXPECT_FALSE((*output)->ready());
    EXPECT_EQ((*output)->present(picture).value_or(Presented::shown), Presented::refused);
  }
}

TEST(OpenOutput, NamesGoBothWays) {
  for (const char* name : {"auto", "kms", "dumb", "fbdev", "surfaceless", "osmesa"}) {
    const auto platform = platform_of(name);
    ASSERT_TRUE(platform.has_value()) << name;
    EXPECT_STREQ(platform_name(*platform), name);
  }
  EXPECT_FALSE(platform_of("x11").has_value());
}

TEST(OpenOutput, SaysWhyEachPlatformIsNotPossible) {
  FakeSeat seat;
  Log log(nullptr);
  OutputSettings settings;
  settings.platform = Platform::kms;
  settings.card = "/dev/dri/no-such-card";
  const auto opened = open_output(settings, seat, log);
  ASSERT_FALSE(opened.has_value());
  EXPECT_NE(opened.error().line().find("/dev/dri"), std::string::npos) << opened.error().line();
}

}  // namespace
}  // namespace lackwerk::kiosk
