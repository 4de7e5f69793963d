#include "kiosk/display/pin_pad.hpp"

#include <algorithm>
#include <cmath>

#include "input/source.hpp"

namespace lackwerk::kiosk {

void PinPad::clear() {
  // What was typed leaves memory too.
  std::fill(digits_.begin(), digits_.end(), '\0');
  digits_.clear();
  refused_ = false;
}

double PinPad::locked_s(double now_ms) const { return std::max(std::ceil((locked_until_ms_ - now_ms) / 1e3), 0.0); }

bool PinPad::press(int key, double now_ms, const std::function<bool(const std::string&)>& check) {
  if (locked_s(now_ms) > 0.0) return false;
  if (key == confirm_key) return confirm(now_ms, check);
  refused_ = false;
  if (key == delete_key && !digits_.empty()) digits_.pop_back();
  if (key >= 0 && key <= 9 && digits_.size() < most_pin_digits) digits_ += static_cast<char>('0' + key);
  return false;
}

bool PinPad::confirm(double now_ms, const std::function<bool(const std::string&)>& check) {
  if (digits_.empty()) return false;
  const bool right = check && check(digits_);
  clear();
  // What is as it was need not be written: a right PIN after no wrong one.
  changed_ |= !right || wrong_ > 0 || lock_s_ > 0.0;
  if (right) {
    wrong_ = 0;
    lock_s_ = 0.0;
    return true;
  }
  refused_ = true;
  if (++wrong_ < pin_attempts) return false;
  wrong_ = 0;
  lock_s_ = lock_s_ > 0.0 ? std::min(2.0 * lock_s_, longest_lock_s) : first_lock_s;
  locked_until_ms_ = now_ms + 1e3 * lock_s_;
  return false;
}

PinRecord PinPad::record(double now_ms, double wall_s) const {
  const double left_s = std::max(locked_until_ms_ - now_ms, 0.0) / 1e3;
  return {wrong_, lock_s_, left_s > 0.0 ? wall_s + left_s : 0.0};
}

void PinPad::restore(const PinRecord& record, double now_ms, double wall_s) {
  const auto within = [](double value, double most) { return value > 0.0 ? std::min(value, most) : 0.0; };
  wrong_ = std::clamp(record.wrong, 0, pin_attempts - 1);
  lock_s_ = within(record.lock_s, longest_lock_s);
  locked_until_ms_ = now_ms + 1e3 * within(record.locked_until_s - wall_s, lock_s_);
}

ui::PinModel PinPad::model(double now_ms) const {
  ui::PinModel model;
  model.digits = static_cast<int>(digits_.size());
  model.locked_s = locked_s(now_ms);
  model.attempts_left = model.locked_s > 0.0 ? 0 : pin_attempts - wrong_;
  model.refused = refused_;
  return model;
}

double PinPad::wake_at_ms(double now_ms) const {
  const double locked = locked_s(now_ms);
  return locked > 0.0 ? locked_until_ms_ - 1e3 * (locked - 1.0) : input::never_ms;
}

}  // namespace lackwerk::kiosk
