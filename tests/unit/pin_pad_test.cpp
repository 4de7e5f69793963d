// The dealer's number pad: digits, attempts, locks that double.
#include "kiosk/display/pin_pad.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "input/source.hpp"

namespace lackwerk::kiosk {
namespace {

class Dealer {
 public:
  bool type(const std::string& pin) {
    for (const char digit : pin) pad.press(digit - '0', now_ms, check);
    return pad.press(PinPad::confirm_key, now_ms, check);
  }
  void fail_until_locked() {
    for (int k = 0; k < pin_attempts; ++k) EXPECT_FALSE(type("0000"));
  }

  PinPad pad;
  double now_ms = 5e6;
  int asked = 0;
  std::function<bool(const std::string&)> check = [this](const std::string& pin) {
    ++asked;
    return pin == "4711";
  };
};

TEST(PinPad, TakesDigitsAndAsksOnce) {
  Dealer dealer;
  EXPECT_TRUE(dealer.type("4711"));
  EXPECT_EQ(dealer.asked, 1);
  EXPECT_EQ(dealer.pad.model(dealer.now_ms).digits, 0);
  EXPECT_FALSE(dealer.pad.press(PinPad::confirm_key, dealer.now_ms, dealer.check)) << "nothing typed";
  EXPECT_EQ(dealer.asked, 1) << "is no attempt";
  for (int k = 0; k < 40; ++k) dealer.pad.press(k % 10, dealer.now_ms, dealer.check);
  EXPECT_EQ(dealer.pad.model(dealer.now_ms).digits, static_cast<int>(most_pin_digits));
  dealer.pad.press(PinPad::delete_key, dealer.now_ms, dealer.check);
  dealer.pad.press(77, dealer.now_ms, dealer.check);
  dealer.pad.press(-1, dealer.now_ms, dealer.check);
  EXPECT_EQ(dealer.pad.model(dealer.now_ms).digits, static_cast<int>(most_pin_digits) - 1);
  dealer.pad.clear();
  EXPECT_EQ(dealer.pad.model(dealer.now_ms).digits, 0);
}

TEST(PinPad, CountsDownAndLocks) {
  Dealer dealer;
  EXPECT_FALSE(dealer.type("1"));
  EXPECT_TRUE(dealer.pad.model(dealer.now_ms).refused);
  EXPECT_EQ(dealer.pad.model(dealer.now_ms).attempts_left, pin_attempts - 1);
  dealer.pad.press(3, dealer.now_ms, dealer.check);
  EXPECT_FALSE(dealer.pad.model(dealer.now_ms).refused) << "the next digit takes the complaint away";
  dealer.pad.clear();
  for (int k = 1; k < pin_attempts; ++k) dealer.type("1");
  EXPECT_EQ(dealer.pad.locked_s(dealer.now_ms), first_lock_s);
  EXPECT_EQ(dealer.pad.model(dealer.now_ms).attempts_left, 0);
  const int asked = dealer.asked;
  EXPECT_FALSE(dealer.type("4711"));
  EXPECT_EQ(dealer.asked, asked) << "nobody is asked while it is locked";
  EXPECT_EQ(dealer.pad.model(dealer.now_ms).digits, 0);
  // Its seconds are shown: it wants to be asked each second.
  EXPECT_EQ(dealer.pad.wake_at_ms(dealer.now_ms), dealer.now_ms + 1000.0);
  dealer.now_ms += 1e3 * first_lock_s - 1.0;
  EXPECT_EQ(dealer.pad.locked_s(dealer.now_ms), 1.0);
  dealer.now_ms += 1.0;
  EXPECT_EQ(dealer.pad.locked_s(dealer.now_ms), 0.0);
  EXPECT_EQ(dealer.pad.wake_at_ms(dealer.now_ms), input::never_ms);
  EXPECT_EQ(dealer.pad.model(dealer.now_ms).attempts_left, pin_attempts);
  EXPECT_TRUE(dealer.type("4711"));
}

TEST(PinPad, EveryFurtherLockIsTwiceAsLongUpToAnHour) {
  Dealer dealer;
  double expected = first_lock_s;
  for (int lock = 0; lock < 9; ++lock) {
    dealer.fail_until_locked();
    EXPECT_EQ(dealer.pad.locked_s(dealer.now_ms), expected);
    dealer.now_ms += 1e3 * expected;
    expected = std::min(2.0 * expected, longest_lock_s);
  }
  EXPECT_EQ(expected, longest_lock_s);
  EXPECT_TRUE(dealer.type("4711"));
  dealer.fail_until_locked();
  EXPECT_EQ(dealer.pad.locked_s(dealer.now_ms), first_lock_s) << "the right one forgives";
}

TEST(PinPad, ARestartForgetsNothing) {
  constexpr double wall_s = 1.7e9;
  Dealer dealer;
  EXPECT_FALSE(dealer.pad.take_changed());
  EXPECT_TRUE(dealer.type("4711"));
  EXPECT_FALSE(dealer.pad.take_changed()) << "nothing to keep";
  dealer.type("1");
  EXPECT_TRUE(dealer.pad.take_changed());
  EXPECT_FALSE(dealer.pad.take_changed()) << "said once";
  Dealer second;
  second.pad.restore(dealer.pad.record(dealer.now_ms, wall_s), second.now_ms, wall_s + 10.0);
  EXPECT_EQ(second.pad.model(second.now_ms).attempts_left, pin_attempts - 1);
  for (int k = 1; k < pin_attempts; ++k) second.type("1");
  ASSERT_EQ(second.pad.locked_s(second.now_ms), first_lock_s);

  const PinRecord locked = second.pad.record(second.now_ms + 20e3, wall_s);
  Dealer third;
  third.pad.restore(locked, third.now_ms, wall_s + 15.0);
  EXPECT_EQ(third.pad.locked_s(third.now_ms), first_lock_s - 35.0) << "time went on while it was off";
  third.now_ms += 1e3 * first_lock_s;
  third.fail_until_locked();
  EXPECT_EQ(third.pad.locked_s(third.now_ms), 2.0 * first_lock_s) << "the next lock is the second";

  third.pad.restore(locked, third.now_ms, wall_s + 1e5);
  EXPECT_EQ(third.pad.locked_s(third.now_ms), 0.0) << "long over";
  third.pad.restore(locked, third.now_ms, wall_s - 1e8);
  EXPECT_EQ(third.pad.locked_s(third.now_ms), first_lock_s) << "a clock that went back: once more, not for years";
  third.now_ms += 1e3 * first_lock_s;
  EXPECT_TRUE(third.type("4711"));
  EXPECT_EQ(third.pad.record(third.now_ms, wall_s), PinRecord{}) << "the right one forgives";
}

TEST(PinPad, RecordsOutOfRangeAreCut) {
  constexpr double far = 1e300, none = std::numeric_limits<double>::quiet_NaN();
  for (const PinRecord& record : {PinRecord{99, far, far}, PinRecord{-5, -far, -far}, PinRecord{0, none, none}}) {
    Dealer dealer;
    dealer.pad.restore(record, dealer.now_ms, 1.7e9);
    EXPECT_LE(dealer.pad.locked_s(dealer.now_ms), longest_lock_s);
    EXPECT_GE(dealer.pad.locked_s(dealer.now_ms), 0.0);
    dealer.now_ms += 1e3 * longest_lock_s;
    EXPECT_GE(dealer.pad.model(dealer.now_ms).attempts_left, 1);
    EXPECT_TRUE(dealer.type("4711"));
  }
}

TEST(PinPad, WithoutACheckNothingIsRight) {
  PinPad pad;
  pad.press(1, 0.0, {});
  EXPECT_FALSE(pad.press(PinPad::confirm_key, 0.0, {}));
}

}  // namespace
}  // namespace lackwerk::kiosk
