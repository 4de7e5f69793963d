// What a dealer can change on the screen, behind the PIN: brightness, test pattern, calibration, options.
//
// Why it exists: the dealer's pages have nothing to do with the visitors' behaviour but that they share a screen. Owns
// values only; one thread.
#pragma once

#include <optional>
#include <vector>

#include "kiosk/display/calibration.hpp"
#include "kiosk/display/experience_settings.hpp"
#include "kiosk/display/ui/layout.hpp"
#include "kiosk/display/ui/model.hpp"

namespace lackwerk::kiosk {

inline constexpr double brightness_step = 0.05;

class DealerDesk {
 public:
  explicit DealerDesk(const ExperienceSettings& settings);

  [[nodiscard]] const ui::DealerModel& model() const { return model_; }
  [[nodiscard]] ui::Language language() const { return language_; }

  /// The first page, nothing under way.
  void open();
  /// Ends test pattern and calibration.
  void leave();
  void turn_to(int page);
  /// One step up (+1) or down (-1) of a value of the open page.
  void step(int value, int direction);
  /// An action of the open page.
  void act(int action);
  void end_test_pattern() { model_.test_pattern = false; }

  [[nodiscard]] bool calibrates() const { return model_.calibration_step >= 0; }
  /// A touch at the cross that is shown: `panel` as the panel reported it.
  void touch_cross(Point panel, Rotation rotation, const ui::Surface& surface);

  /// As they are.
  [[nodiscard]] DealerChoices choices() const;
  /// What has changed since the last call.
  [[nodiscard]] std::optional<DealerChoices> take_choices();

 private:
  ui::DealerModel model_;
  ui::Language language_;
  std::optional<input::CalibrationMatrix> calibration_;
  std::vector<Point> reported_, meant_;
  bool changed_ = false;
};

}  // namespace lackwerk::kiosk
