// The dealer's number pad: digits typed, and how often somebody may be wrong.
//
// Why it exists: a PIN of some digits is only as good as the count of attempts, and the count must outlive the screen
// it is typed on. Knows no PIN: the check is given. Values; one thread; its time is the kiosk's own.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "kiosk/display/experience_settings.hpp"
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
  /// What a restart must not make forgotten has changed since the last call.
  [[nodiscard]] bool take_changed() { return std::exchange(changed_, false); }
  /// `wall_s`: seconds since 1970.
  [[nodiscard]] PinRecord record(double now_ms, double wall_s) const;
  /// Goes on from a record. A lock lasts for what is left of it by the wall clock, but never longer than it was long: a
  /// clock that has gone back locks for one whole time more, and not for years. Numbers out of range are cut.
  void restore(const PinRecord& record, double now_ms, double wall_s);
  /// When model() changes by itself; input::never_ms if never.
  [[nodiscard]] double wake_at_ms(double now_ms) const;

 private:
  bool confirm(double now_ms, const std::function<bool(const std::string&)>& check);

  std::string digits_;
  bool refused_ = false;
  int wrong_ = 0;        ///< since the last lock or right one
  double lock_s_ = 0.0;  ///< of the last lock
  double locked_until_ms_ = 0.0;
  bool changed_ = false;
};

}  // namespace lackwerk::kiosk
