// Keeps from toml++ what it does not survive.
//
// Why it exists: toml++ 3.3 takes some things for granted that a text can break: that a table's name begins with what a
// name begins with ("[=]"), that no letter beyond ASCII stands outside texts and comments, that no brace closes a list,
// that a date is followed by a time.
// It asserts on them, and without assertions promises the compiler that they cannot be. A fuzzer finds each within
// seconds. Pure; any thread.
#pragma once

#include <optional>
#include <string_view>

namespace lackwerk::kiosk {

struct GateRefusal {
  unsigned line;     ///< from 1
  const char* what;  ///< wrong with it
};

/// The first thing in `text` that must not be parsed; nothing: parse it. Texts over several lines (three quotes), dates
/// and tables in braces are refused too, and a line within a list may not begin with an odd list of its own: no key of
/// kiosk.toml needs any of them.
[[nodiscard]] std::optional<GateRefusal> refused_by_gate(std::string_view text);

}  // namespace lackwerk::kiosk
