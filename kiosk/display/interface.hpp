// The interface on the picture: behaviour, drawing and composition as one thing, for the live kiosk and recordings.
//
// Why it exists: what a touch means, what is painted and what reaches the panel must be the same at every place that
// shows pictures. It owns the behaviour and, if it is shown at all, the painter, the overlay and the maker of swatches;
// without them the behaviour works alike and costs no memory. Refers to a stage, whose context must be current in every
// call and when it goes. One GL thread.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/display/drift.hpp"
#include "kiosk/display/experience.hpp"
#include "kiosk/display/log.hpp"
#include "kiosk/display/stage.hpp"
#include "kiosk/display/status.hpp"
#include "kiosk/display/swatches.hpp"
#include "kiosk/display/ui/painter.hpp"
#include "render_gles/overlay.hpp"

namespace lackwerk::kiosk {

/// Seconds since 1970 by the machine's clock.
[[nodiscard]] double wall_clock_s();

class Interface {
 public:
  using Changes = Experience::Changes;

  /// `settings` with the dealer's choices over them. `log` must outlive it. Error: no font, or the driver refuses what
  /// the overlay needs.
  [[nodiscard]] static Result<std::unique_ptr<Interface>> create(Stage& stage, const InterfaceSettings& settings,
                                                                 Log& log);

  /// Another mode or mounting; at the stage's framebuffer's size once rotated. `panel_px` as the panel is built;
  /// `panel_dpi`: what it says of its density (panel_size.hpp), which the settings' counts over; 0: nothing.
  void set_surface(Rotation rotation, std::array<int, 2> panel_px, double panel_dpi = 0.0);
  /// The stage shows another pack or scene; `vouched`: ui::Content::is_vouched. The picture that was shown fades into
  /// the next ones.
  void content_changed(double now_ms, bool vouched);

  /// One event of a device, as the panel is built; or one of a script (input/script.hpp), whose places are found here.
  /// A scripted touch of something that is not there does nothing and is told by take_complaint().
  Changes take(const input::Control& event, double now_ms);
  /// What time alone brings. `minute_of_day`: local time.
  Changes advance(double now_ms, int minute_of_day);
  /// When advance() wants to be called; input::never_ms if never.
  [[nodiscard]] double wake_at_ms(double now_ms) const;

  /// A notice for some seconds: Experience::tell().
  Changes tell(ui::Toast toast, double now_ms);

  /// A visit begins, as if somebody had touched the screen without doing anything.
  Changes begin_visit(double now_ms);

  [[nodiscard]] const Experience& experience() const { return experience_; }
  [[nodiscard]] const ui::Model& model() const { return experience_.model(); }
  /// What the picture has to show: the visitor's mix, or while it is compared the nearest measured paint.
  [[nodiscard]] const State& shown() const { return compared_ ? *compared_ : experience_.state(); }
  /// Begins and ends comparing. `current`: the stage's framebuffer shows shown(). True: shown() has other weights now.
  [[nodiscard]] bool compare(bool current);

  /// compose() would give another picture than the last time, although the picture below is the same.
  [[nodiscard]] bool stale() const;
  /// Who makes the picture as dark as brightness() says.
  enum class Dimming {
    here,   ///< compose(), with a pass over all pixels
    later,  ///< the output, in the pass it needs anyway (Output::set_brightness)
  };
  /// The dealer's brightness and the attract screen's as one factor on display values, [0, 1]; 1 under the test
  /// pattern.
  [[nodiscard]] float brightness() const;
  /// The picture with the interface on it; the picture itself where nothing is on it. Valid until the next call.
  [[nodiscard]] Result<const gles::Framebuffer*> compose(const gles::Framebuffer& picture,
                                                         Dimming dimming = Dimming::here);

  /// The dealer's screen is open and has not had news for a while (or never): show() them.
  [[nodiscard]] bool wants_facts(double now_ms) const;
  void show_facts(ui::DealerFacts facts, double now_ms);

  /// Swatches are still plain discs: make_swatch() draws the next one, which takes as long as some frames. Errors are
  /// logged.
  [[nodiscard]] bool wants_swatch() const { return swatches_ && swatches_->pending(); }
  void make_swatch();

  /// What can be touched, with its middle in [0, 1] of the panel as it is built: for status.json.
  [[nodiscard]] std::vector<ControlStatus> controls() const;
  /// Why the last scripted touch did nothing; nothing: all is well.
  [[nodiscard]] std::optional<Error> take_complaint();
  [[nodiscard]] std::optional<DealerChoices> take_choices();

  [[nodiscard]] bool is_shown() const { return painter_ != nullptr; }
  [[nodiscard]] const gles::Overlay* overlay() const { return overlay_.get(); }
  [[nodiscard]] const ui::Painter* painter() const { return painter_.get(); }

 private:
  Interface(Stage& stage, const InterfaceSettings& settings, Log& log);
  [[nodiscard]] Result<void> set_up();
  void make_swatches();
  void size_swatches();
  [[nodiscard]] input::Control calibrated_and_moved(input::Control event) const;
  /// Nothing: its target is not there.
  [[nodiscard]] std::optional<input::Control> placed(const input::Control& event);
  [[nodiscard]] gles::OverlayLook look() const;
  void paint();
  [[nodiscard]] Result<const gles::Framebuffer*> pattern(const gles::Framebuffer& picture);
  void note(const Changes& changes);

  Stage& stage_;
  InterfaceSettings settings_;
  Log& log_;
  Experience experience_;
  std::unique_ptr<ui::Painter> painter_;
  std::unique_ptr<gles::Overlay> overlay_;
  std::unique_ptr<Swatches> swatches_;
  std::vector<gles::OverlaySprite> sprites_;
  gles::OverlayLook composed_;  ///< with this look, the last time
  bool painted_ = false;        ///< sprites_ are those of the model
  bool dirty_ = true;           ///< the sprites have changed since the last compose()
  std::optional<double> fading_since_ms_;
  double now_ms_ = 0.0;  ///< of the last advance()
  std::optional<State> compared_;
  int compared_paint_ = -1;
  std::optional<gles::Framebuffer> pattern_;
  bool pattern_shown_ = false;
  std::optional<ui::DealerFacts> facts_;
  double facts_ms_ = -1e300;
  Rotation rotation_ = Rotation::none;
  Drift drift_;
  double input_ms_ = 0.0;
  std::map<int, ui::Place> script_fingers_;  ///< where they went down or last stopped, px
  std::optional<Error> complaint_;
};

}  // namespace lackwerk::kiosk
