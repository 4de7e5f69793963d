// What the customer does and what comes of it: the whole behaviour of the kiosk as a state machine over control events
// and time.
//
// Why it exists: every transition can be tested without GL, devices or a clock, and a random walk can show that no
// state is a dead end. It decides what is shown (State: weights, camera, light) and what lies on it (ui::Model). Owns
// values only; one thread; nothing in it takes time but check_pin.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/interpolatable_paint.hpp"
#include "input/control.hpp"
#include "kiosk/display/attract_tour.hpp"
#include "kiosk/display/car_fingers.hpp"
#include "kiosk/display/dealer_desk.hpp"
#include "kiosk/display/experience_settings.hpp"
#include "kiosk/display/growth_loop.hpp"
#include "kiosk/display/mix_desk.hpp"
#include "kiosk/display/orientation.hpp"
#include "kiosk/display/pin_pad.hpp"
#include "kiosk/display/state.hpp"
#include "kiosk/display/ui/content.hpp"
#include "kiosk/display/ui/layout.hpp"
#include "kiosk/display/ui/model.hpp"

namespace lackwerk::kiosk {

/// What the behaviour needs from outside. Empty functions: the feature is left out.
struct ExperienceLinks {
  std::function<ui::Nearest(const core::Weights&)> nearest;
  std::function<bool(const std::string&)> check_pin;
  /// Name of a mix in a language, and its code (packs/mix_code.hpp).
  std::function<std::string(const core::Weights&, ui::Language)> mix_name;
  std::function<std::string(const core::Weights&)> mix_code;
  /// Seconds since 1970: PIN locks outlast a restart by it.
  std::function<double()> wall_s;
};

/// A finger that rests this long on a swatch takes hold of it.
inline constexpr double hold_ms = 350.0;
/// The camera's way home.
inline constexpr double home_ms = 600.0;
/// A series of scans' way back to its newest.
inline constexpr double newest_ms = 1200.0;
/// A knob that is held this long resets mix and view.
inline constexpr double long_press_ms = 1000.0;
/// A dial with 24 detents a turn orbits half round with each of them.
inline constexpr double orbit_degrees_a_detent = 7.5;
/// A dial with 24 detents a turn halves the distance twice with each turn.
inline constexpr double zoom_detents_a_halving = 12.0;
/// Detents of a knob from one end of a slider to the other, and from one mood of the light to the next.
inline constexpr double detents_a_slider = 24.0, detents_a_mood = 2.0;
/// From the first scan to the last: two turns of a dial with 24 detents, for growth is looked at closely.
inline constexpr double detents_a_series = 48.0;
/// The dealer's gesture: two fingers this long in both upper corners, each within this of both edges: once and a half
/// the least touch target.
inline constexpr double corners_ms = 3000.0, corner_mm = 1.5 * ui::least_touch_mm;
/// From one mood of the light to the next.
inline constexpr double light_fade_ms = 400.0;
/// How long a notice stays.
inline constexpr double toast_ms = 6000.0;
/// Names and differences of a mix that changes are worked out anew this often.
inline constexpr double words_every_ms = 100.0;

class Experience {
 public:
  Experience(ui::Content content, std::vector<packs::Camera> cameras, ExperienceSettings settings,
             ExperienceLinks links = {}, Room room = {});

  /// Another mode, mounting or density. `panel_px` as the panel is built. Fingers that are down are forgotten if it
  /// changes anything.
  void set_surface(Rotation rotation, std::array<int, 2> panel_px, double dpi);
  /// Another pack or scene is shown: a visit goes on with the first paint, everything that belonged to the old is gone.
  void set_content(ui::Content content, std::vector<packs::Camera> cameras, Room room = {});
  /// What belongs to the pack that is shown now; with set_content.
  void set_links(ExperienceLinks links) { links_ = std::move(links); }

  struct Changes {
    bool weights = false;  ///< state().weights()
    bool view = false;     ///< camera, light, dimmer or the scans' time
    bool interface = false;
    Changes& operator|=(const Changes& other) {
      weights |= other.weights;
      view |= other.view;
      interface |= other.interface;
      return *this;
    }
    [[nodiscard]] bool any() const { return weights || view || interface; }
  };

  /// One event. Scripted controls (weights, orbit, camera, ...) act at once and count as a visitor's.
  Changes take(const input::Control& event, double now_ms);
  /// A notice for whoever is here; one after another, the newest shows. It is no input: nobody is woken or kept.
  Changes tell(ui::Toast toast, double now_ms);
  /// What has come to pass by time alone. `minute_of_day`: local time, [0, 1439].
  Changes advance(double now_ms, int minute_of_day);
  /// When advance() wants to be called; now_ms while something moves by itself, input::never_ms if never.
  [[nodiscard]] double wake_at_ms(double now_ms) const;

  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] const ui::Model& model() const { return model_; }
  [[nodiscard]] const ui::Content& content() const { return content_; }
  [[nodiscard]] const ui::Surface& surface() const { return surface_; }
  /// What the dealer has changed since the last call, to be kept; nothing most of the time.
  [[nodiscard]] std::optional<DealerChoices> take_choices();

 private:
  /// A finger that is down belongs to what it went down on.
  struct Finger {
    int contact = 0;
    ui::Item item{};  ///< widget none: it is known and does nothing
    ui::Place start_px{}, at_px{};
    Point panel{};  ///< as the panel reported it
    double down_ms = 0.0;
    bool moved = false;        ///< has left the place where it went down
    bool holds = false;        ///< a swatch
    bool on_cross = false;     ///< of a calibration
    bool beside_card = false;  ///< it went down outside of everything a card holds
    int corner = -1;           ///< 0: upper left, 1: upper right; -1: none
    ui::Rect field{};          ///< of the pad, for pad and swatches
    ui::Track track{};         ///< of a slider
  };
  struct Press {
    double since_ms = 0.0;
    bool spent = false;   ///< it has done something already: its release means nothing
    bool begins = false;  ///< it has begun the visit: only a long one means more
  };
  struct Ease {
    RigPlace from, to;
    double since_ms = 0.0;
  };
  /// What take() and advance() compare with.
  struct Before {
    core::Weights weights;
    packs::Camera camera;
    int light;
    LightShares shares;
    double dimmer;
    double time;
    ui::Model model;
  };
  struct TimeEase {
    double from = 0.0;
    double since_ms = 0.0;
  };
  struct LightFade {
    LightShares from;
    double since_ms = 0.0;
  };
  using Focus = std::pair<ui::Widget, int>;

  // experience.cpp: time, visits, resets
  [[nodiscard]] double tick(double now_ms);
  [[nodiscard]] Before before() const;
  Changes finish(const Before& before, double now_ms);
  void show_model(double now_ms);
  void find_words(double now_ms);
  void fade_light(const Before& before, double now_ms);
  void make_tour();
  void note_input(double now_ms);
  void begin_visit(double now_ms);
  /// Whether a touch or turn is used up by waking the kiosk or ending the countdown or the test pattern.
  [[nodiscard]] bool swallows(double now_ms);
  void reset_visit(double now_ms);
  void reset_all(double now_ms);
  void go_to(ui::Screen screen);
  void leave_card();
  void move_home(double now_ms);
  void stop_camera();
  void advance_visit(double now_ms);
  void advance_tour(double now_ms);
  void advance_camera(double now_ms);
  void advance_time(double now_ms);
  void advance_toast(double now_ms);
  void take_script(const input::Control& event, double now_ms);
  [[nodiscard]] double wall_s() const { return links_.wall_s ? links_.wall_s() : 0.0; }
  [[nodiscard]] bool reduced_motion() const { return dealer_.model().reduced_motion; }
  [[nodiscard]] bool beyond_shown() const;

  // experience_touch.cpp
  void touch_down(const input::Control& event, double now_ms);
  void touch_move(const input::Control& event, double now_ms);
  void touch_up(const input::Control& event, double now_ms);
  void touch_cancel(int contact);
  [[nodiscard]] Finger* find_finger(int contact);
  [[nodiscard]] bool is_taken(ui::Widget widget, int index) const;
  [[nodiscard]] ui::Place pixel_of(Point panel) const;
  [[nodiscard]] int corner_of(ui::Place px) const;
  void watch_corners(double now_ms);
  void put_on(Finger& finger, const input::Control& event, double now_ms);
  void drag(Finger& finger, double now_ms);
  void drag_swatch(Finger& finger, ui::Place from_px, double now_ms);
  void advance_fingers(double now_ms);
  void activate(const Finger& finger, double now_ms);
  void press_pin(int key, double now_ms);
  void act_for_dealer(int action, double now_ms);
  void take_home();
  void let_go();
  void show_pressed();
  [[nodiscard]] std::uint64_t time_us(const input::Control& event, double now_ms) const;

  // experience_knob.cpp
  void turn(const input::Control& event, double now_ms);
  void press(const input::Control& event, double now_ms);
  void release(const input::Control& event, double now_ms);
  void advance_knobs(double now_ms);
  [[nodiscard]] std::vector<Focus> focuses() const;
  void show_focus();
  void next_focus();
  void hide_focus();
  void turn_focus(double detents, double now_ms);

  ExperienceSettings settings_;
  ExperienceLinks links_;
  ui::Content content_;
  State state_;
  ui::Model model_;
  ui::Surface surface_;

  MixDesk desk_;
  DealerDesk dealer_;
  PinPad pin_;
  AttractTour tour_;
  GrowthLoop growth_;
  std::uint64_t tours_ = 0;  ///< made so far

  double now_ms_ = 0.0;
  double input_ms_ = 0.0;
  double minute_asked_ms_ = 0.0;
  double words_ms_ = 0.0;

  std::vector<Finger> fingers_;
  CarFingers car_;
  std::optional<Coasting> coasting_;
  std::optional<Ease> ease_;
  std::optional<LightFade> light_fade_;
  std::optional<TimeEase> time_ease_;  ///< towards the newest scan
  double corners_since_ms_ = 0.0;
  double dragged_ms_ = 0.0;  ///< when swatches were last moved on
  double toast_since_ms_ = 0.0;

  std::map<std::string, Press> presses_;
  double mood_detents_ = 0.0;
  Focus focus_{ui::Widget::none, 0};

  // Small ones together: a class with holes is larger than it needs to be.
  int minute_ = -1;
  Rotation rotation_ = Rotation::none;
  bool began_ = false;  ///< the first time is known
  bool touring_ = false;
  bool corners_held_ = false;
  bool swatch_lags_ = false;
  bool focus_seen_ = false;
  bool compare_by_knob_ = false;
  bool words_stale_ = true;
};

}  // namespace lackwerk::kiosk
