// Keeps from toml++ what it does not survive.
//
// Why it exists: toml++ 3.3 takes some things for granted that a text can break: that a table's name begins with what a
// name begins with ("[=]"), that no letter beyond ASCII stands outside texts and comments or in what it takes for a
// number (it looks ahead to the next blank or comma, into a text too), that no brace closes a list, that a date is
// followed by a time.
// It asserts on them, and without assertions promises the compiler that they cannot be. A fuzzer finds each within
// seconds. Pure; any thread.
#pragma once

#include <optional>
#include <string_view>

namespace lackwerk::packs {

struct GateRefusal {
  unsigned line;     ///< from 1
  const char* what;  ///< wrong with it
};

/// The first thing in `text` that must not be parsed; nothing: parse it. A quoted text with letters beyond ASCII stands
/// by itself: a = "ä", not a="ä". Before its quote is the start of the line, a blank, a comma, or one or more [ after
/// one of these; toml++ would read it wrongly otherwise. Texts over several lines (three quotes), dates and tables in
/// braces are refused too, and a line within a list may not begin with an odd list of its own: none of our files
/// needs any of them.
[[nodiscard]] std::optional<GateRefusal> refused_by_gate(std::string_view text);

}  // namespace lackwerk::packs
