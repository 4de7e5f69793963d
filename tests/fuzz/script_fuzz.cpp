// Fuzz target: any text as a tour.
//
// Input: the text. Whatever comes: no sanitizer finding, every refusal with its line, and a tour that is taken plays to
// its end, forward, with finite numbers.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "input/script.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lackwerk;
  using fuzz::require;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  auto steps = input::parse_script(text, "fuzz.tour");
  if (!steps) {
    require(steps.error().field.rfind("line ", 0) == 0 && !steps.error().what.empty());
    return 0;
  }
  double end_ms = 0.0;
  for (const input::ScriptStep& step : *steps) {
    require(step.at_ms >= 0.0 && step.over_ms >= 0.0 && step.over_ms <= input::max_script_ms);
    end_ms = std::max(end_ms, step.at_ms + step.over_ms);
    for (const double value : step.control.values) require(std::isfinite(value));
  }
  require(end_ms <= 2.0 * input::max_script_ms + input::script_tap_ms);
  input::ScriptPlayer player(std::move(*steps), {1.0, 0.0, 0.0});
  constexpr int looks = 16;
  for (int k = 0; k <= looks; ++k) {
    const double now_ms = end_ms * k / looks;
    for (const input::Control& control : player.advance(now_ms)) {
      require(static_cast<double>(control.time_us) <= now_ms * 1e3 + 1.0);
      for (const double value : control.values) require(!std::isnan(value));
    }
  }
  require(player.finished());
  return 0;
}
