// Settings of knobs: which device gets which, and what is out of range.
#include "input/knob_settings.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace lackwerk::input {
namespace {

TEST(KnobSettings, ProfilesHaveWords) {
  for (const auto profile : {KnobProfile::automatic, KnobProfile::generic, KnobProfile::surface_dial,
                             KnobProfile::powermate, KnobProfile::spacemouse})
    EXPECT_EQ(knob_profile_of(word_of(profile)), profile);
  EXPECT_EQ(knob_profile_of("surface dial"), std::nullopt);
}

TEST(KnobSettings, KnownDevicesByTheirIds) {
  EXPECT_EQ(known_profile(0x045e, 0x091b), KnobProfile::surface_dial);
  EXPECT_EQ(known_profile(0x077d, 0x0410), KnobProfile::powermate);
  EXPECT_EQ(known_profile(0x046d, 0xc626), KnobProfile::spacemouse);
  EXPECT_EQ(known_profile(0x256f, 0xc62e), KnobProfile::spacemouse);  // wireless, by cable
  EXPECT_EQ(known_profile(0x256f, 0xc62f), KnobProfile::spacemouse);  // the same by radio
  EXPECT_EQ(known_profile(0x046d, 0xc52b), KnobProfile::automatic);   // Logitech's mice
}

TEST(KnobSettings, TheFirstMatchWins) {
  KnobSettings settings;
  settings.tuning.detents_per_turn = 10.0;
  KnobMatch by_name{"Dial", {}}, by_id{"045E:091B", {}}, empty{"", {}};
  by_name.tuning.detents_per_turn = 20.0;
  by_id.tuning.detents_per_turn = 30.0;
  by_id.tuning.profile = KnobProfile::generic;
  empty.tuning.detents_per_turn = 40.0;
  settings.devices = {empty, by_id, by_name};
  EXPECT_EQ(tuning_for(settings, 0x045e, 0x091b, "Surface Dial").detents_per_turn, 30.0);
  EXPECT_EQ(tuning_for(settings, 0x045e, 0x091b, "Surface Dial").profile, KnobProfile::generic);
  EXPECT_EQ(tuning_for(settings, 0x1234, 0x0001, "my dial").detents_per_turn, 20.0);
  EXPECT_EQ(tuning_for(settings, 0x1234, 0x0001, "wheel").detents_per_turn, 10.0);
  EXPECT_EQ(tuning_for(settings, 0x077d, 0x0410, "wheel").profile, KnobProfile::powermate);
}

TEST(KnobSettings, ComplaintsNameTheKey) {
  EXPECT_EQ(complaint(KnobTuning{}), std::nullopt);
  const auto key_of = [](auto change) {
    KnobTuning tuning;
    change(tuning);
    const auto text = complaint(tuning).value_or("none");
    return text.substr(0, text.find(' '));
  };
  EXPECT_EQ(key_of([](KnobTuning& t) { t.detents_per_turn = 0.0; }), "detents_per_turn");
  EXPECT_EQ(key_of([](KnobTuning& t) { t.counts_per_turn = -1.0; }), "counts_per_turn");
  EXPECT_EQ(key_of([](KnobTuning& t) { t.acceleration = std::nan(""); }), "acceleration");
  EXPECT_EQ(key_of([](KnobTuning& t) { t.dead_zone = 1.0; }), "dead_zone");
  EXPECT_EQ(key_of([](KnobTuning& t) { t.axis = "w"; }), "axis");
}

}  // namespace
}  // namespace lackwerk::input
