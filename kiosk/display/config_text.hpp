// The commented sample of kiosk.toml.
//
// Why it exists: systemd/kiosk.toml is this text, so that documentation and program cannot differ (a test compares
// them). Pure; any thread.
#pragma once

#include <string>

namespace lackwerk::kiosk {

/// Every key with its help, what it takes and its default. Settings are commented out by a # without a space after it,
/// help by one with a space: taking away the former gives a file that sets the defaults.
[[nodiscard]] std::string config_text();

}  // namespace lackwerk::kiosk
