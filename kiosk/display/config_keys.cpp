#include "kiosk/display/config_keys.hpp"

#include "render_gles/accumulator.hpp"
#include "render_gles/governor.hpp"

namespace lackwerk::kiosk {
namespace {

using input::KnobMatch;
using input::KnobTuning;
using input::TouchSettings;

/// Longest path or name: Linux's PATH_MAX.
constexpr double max_text = 4096.0;
constexpr double max_packs = 64.0;
/// Faster than any panel.
constexpr double max_refresh_hz = 1000.0;
constexpr double max_frame_ms = 1000.0;

std::vector<std::string> seat_words() { return {"auto", "libseat", "direct"}; }

std::vector<std::string> quality_words() {
  std::vector<std::string> words{"auto"};
  for (const gles::Rung& rung : gles::quality_ladder()) words.emplace_back(rung.name);
  return words;
}

std::vector<std::string> axis_words() { return {"", "x", "y", "z", "rx", "ry", "rz"}; }

/// The keys that [knobs] and every [[knob]] share: `tuning_of` finds the tuning in its owner.
template <class Owner, KnobTuning& (*tuning_of)(Owner&)>
std::vector<Key<Owner>> tuning_keys() {
  return {
      {"detents_per_turn", [](Owner& o) -> Slot { return &tuning_of(o).detents_per_turn; },
       "What one revolution is worth, in clicks.", 1.0, 1000.0},
      {"counts_per_turn", [](Owner& o) -> Slot { return &tuning_of(o).counts_per_turn; },
       "Counts the device sends in one revolution. 0: as its descriptor or profile says.", 0.0, 100000.0},
      {"acceleration", [](Owner& o) -> Slot { return &tuning_of(o).acceleration; },
       "How much more a fast turn counts than a slow one. 0: nothing.", 0.0, 2.0},
      {"invert", [](Owner& o) -> Slot { return &tuning_of(o).invert; }, "Turn the other way round."},
      {"dead_zone", [](Owner& o) -> Slot { return &tuning_of(o).dead_zone; },
       "Of sticks: part of the full deflection that counts as rest.", 0.0, 0.9},
      {"axis", [](Owner& o) -> Slot { return &tuning_of(o).axis; },
       "Which axis of a device with several turns. Empty: the twist, or the first it has.", 0.0, max_text, axis_words},
  };
}

KnobTuning& common_tuning(Config& config) { return config.knobs.tuning; }
KnobTuning& own_tuning(KnobMatch& match) { return match.tuning; }

std::vector<Key<Config>> knobs_keys() {
  std::vector<Key<Config>> keys{
      {"hidraw", [](Config& c) -> Slot { return &c.knobs.hidraw; }, "Use HID devices with a hidraw node."},
      {"usb", [](Config& c) -> Slot { return &c.knobs.usb; }, "Use USB devices that no kernel driver has."},
      {"evdev", [](Config& c) -> Slot { return &c.knobs.evdev; }, "Use dials that a kernel driver has (PowerMate)."},
  };
  const auto tuning = tuning_keys<Config, common_tuning>();
  keys.insert(keys.end(), tuning.begin(), tuning.end());
  return keys;
}

Section<Config> interface_section() {
  return {"interface",
          "What lies on the picture, and how it behaves towards visitors and dealers.",
          {{"shown", [](Config& c) -> Slot { return &c.interface.shown; },
            "false: the picture alone, as for recordings of paints."},
           {"language", [](Config& c) -> Slot { return &c.interface.experience.language; },
            "Of all texts: English, German or Arabic. The dealer may choose another on the screen."},
           {"dpi", [](Config& c) -> Slot { return &c.interface.dpi; },
            "Dots per inch of the panel, 30 or more: buttons are made large enough for fingers by it. 0: as the panel "
            "says, else 96.",
            0.0, 600.0},
           {"idle_s", [](Config& c) -> Slot { return &c.interface.experience.idle_s; },
            "Seconds without a touch or a turn until the countdown shows.", 5.0, 3600.0},
           {"countdown_s", [](Config& c) -> Slot { return &c.interface.experience.countdown_s; },
            "Seconds of the countdown. Then everything is reset for the next visitor.", 3.0, 60.0},
           {"night", [](Config& c) -> Slot { return &c.interface.experience.night; },
            "Local time in which the panel is off until somebody touches it. Empty: never."},
           {"beyond", [](Config& c) -> Slot { return &c.interface.experience.beyond_allowed; },
            "Visitors may go beyond the measured paints, as far as the pack says."},
           {"reduced_motion", [](Config& c) -> Slot { return &c.interface.experience.reduced_motion; },
            "Nothing moves by itself but the paints."},
           {"tour", [](Config& c) -> Slot { return &c.interface.experience.tour; },
            "false: while nobody is there, the first paint is shown and nothing moves."},
           {"brightness", [](Config& c) -> Slot { return &c.interface.experience.brightness; },
            "Of the picture, as a part of what the panel can. The dealer may choose another on the screen.",
            least_brightness, 1.0},
           {"pin", [](Config& c) -> Slot { return &c.interface.pin; },
            "Opens the dealer's screen: what lackwerk-kiosk --hash-pin prints, not the PIN itself. Empty: there is no "
            "dealer's screen.",
            0.0, max_text},
           {"drift_px", [](Config& c) -> Slot { return &c.interface.drift_px; },
            "The picture wanders slowly by up to this many pixels, against burn-in.", 0.0, 24.0},
           {"attract_brightness", [](Config& c) -> Slot { return &c.interface.attract_brightness; },
            "Of the picture while nobody is there.", least_brightness, 1.0}}};
}

std::vector<Key<KnobMatch>> knob_keys() {
  std::vector<Key<KnobMatch>> keys{
      {"match", [](KnobMatch& k) -> Slot { return &k.match; },
       "Which: \"045e:091b\" (vendor and product) or a part of the name. Must be given.", 1.0, max_text},
      {"profile", [](KnobMatch& k) -> Slot { return &k.tuning.profile; },
       "What it is. automatic: by vendor and product; generic: by its descriptor alone."},
      {"ignore", [](KnobMatch& k) -> Slot { return &k.tuning.ignore; }, "Never open it."},
  };
  const auto tuning = tuning_keys<KnobMatch, own_tuning>();
  keys.insert(keys.end(), tuning.begin(), tuning.end());
  return keys;
}

}  // namespace

std::vector<std::string> platform_words() {
  std::vector<std::string> words;
  for (const Platform platform :
       {Platform::automatic, Platform::kms, Platform::dumb, Platform::fbdev, Platform::surfaceless, Platform::osmesa})
    words.emplace_back(platform_name(platform));
  return words;
}

std::vector<std::string> profile_words() {
  using input::KnobProfile;
  std::vector<std::string> words;
  for (const KnobProfile profile : {KnobProfile::automatic, KnobProfile::generic, KnobProfile::surface_dial,
                                    KnobProfile::powermate, KnobProfile::spacemouse})
    words.emplace_back(word_of(profile));
  return words;
}

const std::vector<Section<Config>>& config_sections() {
  static const std::vector<Section<Config>> sections{
      {"",
       "What is shown.",
       {{"packs", [](Config& c) -> Slot { return &c.packs.files; },
         "Paint packs (.lwp): the first is shown. Empty: what the store holds.", 0.0, max_packs},
        {"store", [](Config& c) -> Slot { return &c.packs.store; },
         "The dealer's store of packs (lackwerk store, USB sticks).", 1.0, max_text},
        {"keyring", [](Config& c) -> Slot { return &c.packs.keyring; },
         "Folder of minisign public keys (*.pub) whose packs are shown.", 1.0, max_text},
        {"allow_unsigned", [](Config& c) -> Slot { return &c.packs.allow_unsigned; },
         "Show packs without a signature too, and say so. One with a bad signature is never shown."},
        {"scene", [](Config& c) -> Slot { return &c.scene; },
         "The car and its surroundings (.lws). Needed here or on the command line.", 0.0, max_text}}},
      {"display",
       "Where it is shown.",
       {{"platform", [](Config& c) -> Slot { return &c.output.platform; },
         "How pictures reach the panel. auto: the first of kms, dumb and fbdev that can be had."},
        {"card", [](Config& c) -> Slot { return &c.output.card; },
         "Graphics card, as /dev/dri/by-path/... Empty: the first with a connected display.", 0.0, max_text},
        {"connector", [](Config& c) -> Slot { return &c.output.connector; },
         "Connector, as HDMI-A-1. Empty: the first connected one.", 0.0, max_text},
        {"mode", [](Config& c) -> Slot { return &c.output.mode_px; },
         "Resolution. preferred: what the display asks for."},
        {"refresh_hz", [](Config& c) -> Slot { return &c.output.refresh_hz; }, "Refresh rate. 0: the mode's own.", 0.0,
         max_refresh_hz},
        {"rotation", [](Config& c) -> Slot { return &c.output.rotation; },
         "Clockwise turn of the picture on the panel, in degrees. Touches turn with it."},
        {"seat", [](Config& c) -> Slot { return &c.seat; },
         "Who opens the devices: a seat manager, or the kiosk itself. auto: the manager if it answers.", 0.0, max_text,
         seat_words}}},
      {"picture",
       "How it is drawn.",
       {{"quality", [](Config& c) -> Slot { return &c.picture.quality; },
         "Of moving pictures. auto: whatever holds frame_ms.", 0.0, max_text, quality_words},
        {"frame_ms", [](Config& c) -> Slot { return &c.picture.frame_ms; },
         "Frame time that auto holds, in milliseconds.", 1.0, max_frame_ms},
        {"quality_table", [](Config& c) -> Slot { return &c.picture.quality_table; },
         "What auto goes by: quality.json of lackwerk report, made on this machine. Empty: figures of another one.",
         0.0, max_text},
        {"still_frames", [](Config& c) -> Slot { return &c.picture.still_frames; },
         "Frames that a resting picture is refined with. 0: it stays as it moved.", 0.0,
         static_cast<double>(gles::Accumulator::max_frames)}}},
      {"panel",
       "What the panel makes of a pixel, measured. Either icc, or chromaticities (CIE 1931 x, y) and a curve.",
       {{"icc", [](Config& c) -> Slot { return &c.icc; }, "ICC profile of the panel, matrix and curve kind.", 0.0,
         max_text},
        {"white", [](Config& c) -> Slot { return &c.output.profile.white; }, "White."},
        {"red", [](Config& c) -> Slot { return &c.output.profile.red; }, "Red primary."},
        {"green", [](Config& c) -> Slot { return &c.output.profile.green; }, "Green primary."},
        {"blue", [](Config& c) -> Slot { return &c.output.profile.blue; }, "Blue primary."},
        {"curve", [](Config& c) -> Slot { return &c.output.profile.curves; },
         "Light over pixel value. A list goes evenly from pixel value 0 to the highest.", least_exponent,
         most_exponent},
        {"gamut_warning", [](Config& c) -> Slot { return &c.output.gamut_warning; },
         "Mark colours that the panel cannot show."}}},
      interface_section(),
      {"input",
       "Fingers.",
       {{"udev_seat", [](Config& c) -> Slot { return &c.input_seat; },
         "udev's seat whose touch screens and pointers are used.", 1.0, max_text}}},
      {"knobs", "All knobs, unless a [[knob]] below names one.", knobs_keys()},
  };
  return sections;
}

const Section<KnobMatch>& knob_section() {
  static const Section<KnobMatch> section{
      "knob", "One kind of knob; what is not said here is as in [knobs]. As many of these as there are kinds.",
      knob_keys()};
  return section;
}

const Section<TouchSettings>& touch_section() {
  static const Section<TouchSettings> section{
      "touch",
      "One kind of touch screen or pointer; the first that matches counts. As many of these as there are kinds.",
      {{"match", [](TouchSettings& t) -> Slot { return &t.match; },
        "Which: \"222a:0001\" (vendor and product) or a part of the name. Empty: every one.", 0.0, max_text},
       {"output", [](TouchSettings& t) -> Slot { return &t.output; },
        "Connector it lies on. On another than the kiosk's it is ignored. Empty: as udev says, or the kiosk's.", 0.0,
        max_text},
       {"calibration", [](TouchSettings& t) -> Slot { return &t.calibration; },
        "As LIBINPUT_CALIBRATION_MATRIX, and instead of it. Empty: udev's."}}};
  return section;
}

}  // namespace lackwerk::kiosk
