// Fuzz target: any text as kiosk.toml.
//
// Input: the text. Whatever comes: no sanitizer finding, every mistake named with its line, and a configuration whose
// values all lie in their ranges, with or without mistakes.
// Build and run: see docs of the fuzz label in CMakeLists.txt; it needs clang's libFuzzer.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kiosk/display/config.hpp"
#include "kiosk/display/config_keys.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

bool is_line(const lackwerk::Error& error, std::size_t bytes) {
  return error.field.rfind("line ", 0) == 0 || bytes > lackwerk::kiosk::max_config_bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lackwerk;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  auto [config, errors] = kiosk::parse_config(text, "fuzz.toml");
  for (const Error& error : errors) require(is_line(error, size) && !error.what.empty() && !error.remedy.empty());
  require(config.packs.files.size() <= 64 && config.picture.frame_ms >= 1 && config.picture.frame_ms <= 1000);
  require(config.output.refresh_hz >= 0 && config.output.mode_px[0] >= 0 && config.output.mode_px[0] <= 8192);
  require(config.touch.size() <= input::max_touch_settings);
  require(config.knobs.devices.size() <= kiosk::max_knob_settings);
  require(!input::complaint(config.knobs.tuning));
  for (const auto& knob : config.knobs.devices) require(!input::complaint(knob.tuning));
  for (const auto& touch : config.touch) require(!touch.calibration || input::is_usable(*touch.calibration));
  if (errors.empty()) require(kiosk::check_profile(config.output.profile, "").has_value());
  // Every value can be written.
  for (const auto& section : kiosk::config_sections())
    for (const auto& key : section.keys) require(!kiosk::text_of(key.slot(config)).empty());
  return 0;
}
