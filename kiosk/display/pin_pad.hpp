// The dealer's number pad: digits typed, and how often somebody may be wrong.
//
// Why it exists: a PIN of some digits is only as good as the count of attempts, and the count must outlive the screen
// it is typed on. Knows no PIN: the check is given. Values; one thread; its time is the kiosk's own.
#pragma once

#include <functional>
#include <string>

#include "kiosk/display/ui/model.hpp"

namespace lackwerk::kiosk {

inline constexpr std::size_t most_pin_digits = 12;
inline constexpr int pin_attempts = 5;  ///< wrong ones before it locks
/// The first lock's time; every further one takes twice as long, up to the longest. A thousand PINs take a week.
inline constexpr double first_lock_s = 60.0, longest_lock_s = 3600.0;

class PinPad {
 public:
  static constexpr int delete_key = 10, confirm_key = 11;

  /// A key: 0 to 9, delete or confirm. True: the PIN was right. `check` is asked at most once.
  bool press(int key, double now_ms, const std::function<bool(const std::string&)>& check);
  /// Forgets what was typed, not the attempts.
  void clear();
  [[nodiscard]] ui::PinModel model(double now_ms) const;
  /// Whole seconds until it takes attempts again; 0: now.
  [[nodiscard]] double locked_s(double now_ms) const;
  /// When model() changes by itself; input::never_ms if never.
  [[nodiscard]] double wake_at_ms(double now_ms) const;

 private:
  bool confirm(double now_ms, const std::function<bool(const std::string&)>& check);

  std::string digits_;
  bool refused_ = false;
  int wrong_ = 0;        ///< since the last lock or right one
  double lock_s_ = 0.0;  ///< of the last lock
  double locked_until_ms_ = 0.0;
};

}  // namespace lackwerk::kiosk
