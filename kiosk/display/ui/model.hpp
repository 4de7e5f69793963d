// All that the interface shows at one moment, as values.
//
// Why it exists: behaviour (experience.hpp) writes it, layout and painter read it, and neither knows the other; a test
// compares it. Nothing in here is a pixel but in `Surface`. Values; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lackwerk::kiosk::ui {

/// A place on the pad, [0, 1] from its upper left corner.
using Place = std::array<double, 2>;

enum class Language : std::uint8_t { english, german, arabic };

/// The picture the interface lies on.
struct Surface {
  std::array<int, 2> size_px{1280, 720};  ///< as it is seen (after rotation)
  double dpi = 96.0;                      ///< of the panel; a touch target is at least 12 mm
  bool operator==(const Surface&) const = default;
};

enum class Screen : std::uint8_t {
  attract,    ///< the tour plays; any touch or turn begins a visit
  show,       ///< a visitor at work
  take_home,  ///< the QR code of the mix
  about,      ///< provenance of one paint
  pin,        ///< the dealer's number pad
  dealer,     ///< the dealer's pages
};

/// What can be touched, or focused by a knob.
enum class Widget : std::uint8_t {
  none,
  car,           ///< everything that is not something else: orbit, pinch, double tap
  pad,           ///< the paint pad; its puck follows the finger
  swatch,        ///< index: the paint. A tap takes the paint, a drag after a short hold moves the swatch
  swatch_about,  ///< index: the paint. The small "i"
  sparkle,       ///< slider
  hue,           ///< slider
  beyond,        ///< slider
  sparkle_lock,  ///< closed: the slider follows the pad
  hue_lock,
  light,      ///< index: 0 to 2, the three moods
  dimmer,     ///< slider: day (0) to showroom night (1)
  time,       ///< slider: from the first scan (0) to the last (1)
  compare,    ///< held: the nearest measured paint beside the mix
  take_home,  ///< button
  close,      ///< of take_home, about, pin and dealer
  countdown,  ///< the visible countdown; any touch cancels it
  pin_key,    ///< index: 0 to 9; 10 deletes, 11 confirms
  page,       ///< index: DealerPage
  action,     ///< index: what it does on the dealer's page that is open
  step_down,  ///< index: of a dealer's value: one step less
  step_up,    ///< and one more
};

enum class DealerPage : std::uint8_t { packs, status, devices, errors, screen, options };
inline constexpr int dealer_pages = 6;

/// The dealer's page `screen`: values with steps and actions. Brightness is a value, [0.2, 1].
enum class ScreenValue : std::uint8_t { brightness };
enum class ScreenAction : std::uint8_t { test_pattern, calibrate };
/// The dealer's page `options`: actions that go to the next choice.
enum class OptionAction : std::uint8_t { beyond, language, reduced_motion };

/// The nearest measured paint to the mix, as a paint shop says it.
struct Nearest {
  int paint = 0;
  std::array<double, 3> ciede2000{};  ///< at 15, 45 and 110 degrees from the mirror direction
  bool operator==(const Nearest&) const = default;
};

struct PinModel {
  int digits = 0;         ///< typed so far; never the digits themselves
  int attempts_left = 0;  ///< before it locks
  double locked_s = 0.0;  ///< > 0: whole seconds until another attempt is taken
  bool refused = false;   ///< the last attempt was wrong
  bool operator==(const PinModel&) const = default;
};

struct DealerModel {
  DealerPage page = DealerPage::packs;
  double brightness = 1.0;  ///< [0.2, 1]
  bool beyond_allowed = false;
  bool reduced_motion = false;
  bool test_pattern = false;
  int calibration_step = -1;  ///< 0 to 3: which cross is shown; -1: none
  bool calibration_failed = false;
  bool operator==(const DealerModel&) const = default;
};

/// What came of a stick that was plugged in. Lists by the packs' identifiers.
struct Toast {
  std::vector<std::string> stored;  ///< in use now
  std::vector<std::string> known;   ///< the same were there already
  int refused = 0;                  ///< packs
  std::string reason;               ///< of the first that was refused, or of the stick as a whole; one line
  bool operator==(const Toast&) const = default;
};

// One of these exists: the order is that of reading, not of size.
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding)
struct Model {
  Screen screen = Screen::attract;
  Language language = Language::english;

  std::vector<Place> swatches;  ///< one a paint
  Place puck{0.5, 0.5};
  bool puck_held = false;
  int swatch_held = -1;  ///< the swatch that is being moved

  bool sparkle_free = false, hue_free = false;  ///< the lock is open: the slider is on its own
  double sparkle = 0.0;                         ///< [0, 1] along the paints by rising liveliness
  double hue = 0.0;                             ///< [0, 1]: 0 white flakes, then along the paints in their order
  bool beyond_shown = false;
  double beyond = 0.0;  ///< [0, 1] of the pack's limit

  int light = 0;        ///< [0, 2]
  double dimmer = 0.0;  ///< [0, 1]
  double time = 1.0;    ///< [0, 1] from the first scan to the last

  std::optional<Nearest> nearest;     ///< while compare is held
  std::optional<double> countdown_s;  ///< whole seconds, while it is visible
  double countdown_whole_s = 15.0;    ///< what it counts down from
  Widget focus = Widget::none;        ///< what a knob turns; none: no knob was used on this visit
  int focus_index = 0;
  Widget pressed = Widget::none;  ///< under a finger now, to be shown so
  int pressed_index = 0;

  int about_paint = 0;         ///< on Screen::about
  std::string mix_name;        ///< "72 % Polaris, 28 % Opel Titan, lively", in the model's language
  std::string mix_code;        ///< on Screen::take_home: what the QR code says
  PinModel pin;                ///< on Screen::pin
  DealerModel dealer;          ///< on Screen::dealer
  bool hint = false;           ///< the hand that shows what to do: early in a visit, until something was dragged
  bool asleep = false;         ///< the night schedule: the panel is off
  std::optional<Toast> toast;  ///< for some seconds, over everything but the countdown
  bool operator==(const Model&) const = default;
};

}  // namespace lackwerk::kiosk::ui
