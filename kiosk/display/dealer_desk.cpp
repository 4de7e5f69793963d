#include "kiosk/display/dealer_desk.hpp"

#include <algorithm>
#include <cmath>

namespace lackwerk::kiosk {
namespace {

constexpr int languages = 3;

double within_brightness(double value) { return std::isfinite(value) ? std::clamp(value, least_brightness, 1.0) : 1.0; }

}  // namespace

DealerDesk::DealerDesk(const ExperienceSettings& settings)
    : language_(settings.language), calibration_(settings.calibration) {
  model_.brightness = within_brightness(settings.brightness);
  model_.beyond_allowed = settings.beyond_allowed;
  model_.reduced_motion = settings.reduced_motion;
}

void DealerDesk::open() {
  leave();
  model_.page = ui::DealerPage::packs;
}

void DealerDesk::leave() {
  model_.test_pattern = false;
  model_.calibration_step = -1;
  model_.calibration_failed = false;
}

void DealerDesk::turn_to(int page) {
  if (page < 0 || page >= ui::dealer_pages) return;
  leave();
  model_.page = static_cast<ui::DealerPage>(page);
}

void DealerDesk::step(int value, int direction) {
  if (model_.page != ui::DealerPage::screen || value != static_cast<int>(ui::ScreenValue::brightness)) return;
  // On whole steps, or ten of them would end beside 1.
  const double steps = std::round(model_.brightness / brightness_step) + (direction > 0 ? 1.0 : -1.0);
  const double next = within_brightness(steps * brightness_step);
  changed_ |= next != model_.brightness;
  model_.brightness = next;
}

void DealerDesk::act(int action) {
  if (model_.page == ui::DealerPage::screen) {
    if (action == static_cast<int>(ui::ScreenAction::test_pattern)) model_.test_pattern = !model_.test_pattern;
    if (action == static_cast<int>(ui::ScreenAction::calibrate)) {
      model_.calibration_step = 0;
      model_.calibration_failed = false;
      reported_.clear();
      meant_.clear();
    }
    return;
  }
  if (model_.page != ui::DealerPage::options) return;
  switch (static_cast<ui::OptionAction>(action)) {
    case ui::OptionAction::beyond:
      model_.beyond_allowed = !model_.beyond_allowed;
      break;
    case ui::OptionAction::language:
      language_ = static_cast<ui::Language>((static_cast<int>(language_) + 1) % languages);
      break;
    case ui::OptionAction::reduced_motion:
      model_.reduced_motion = !model_.reduced_motion;
      break;
    default:
      return;
  }
  changed_ = true;
}

void DealerDesk::touch_cross(Point panel, Rotation rotation, const ui::Surface& surface) {
  if (!calibrates()) return;
  const ui::Place cross = ui::calibration_cross(surface, model_.calibration_step);
  reported_.push_back(panel);
  meant_.push_back(panel_point(rotation, {cross[0] / surface.size_px[0], cross[1] / surface.size_px[1]}));
  if (++model_.calibration_step < ui::calibration_steps) return;
  model_.calibration_step = -1;
  // What was reported went through the calibration of today already.
  const auto correction = fit_calibration(reported_, meant_);
  model_.calibration_failed = !correction;
  if (!correction) return;
  calibration_ = composed(*correction, calibration_.value_or(no_calibration));
  changed_ = true;
}

std::optional<DealerChoices> DealerDesk::take_choices() {
  if (!changed_) return std::nullopt;
  changed_ = false;
  return choices();
}

DealerChoices DealerDesk::choices() const {
  DealerChoices choices;
  choices.language = language_;
  choices.beyond_allowed = model_.beyond_allowed;
  choices.reduced_motion = model_.reduced_motion;
  choices.brightness = model_.brightness;
  choices.calibration = calibration_;
  return choices;
}

}  // namespace lackwerk::kiosk
