#include "packs/toml_gate.hpp"

#include <algorithm>

namespace lackwerk::packs {
namespace {

constexpr std::string_view blank = " \t";
constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
/// What a name begins with; ] is toml++'s own to complain of.
constexpr std::string_view name_begins = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-\"']";

/// "[" or "[[" and then no name.
bool is_odd_header(std::string_view line) {
  std::size_t at = line.find_first_not_of(blank);
  if (at == std::string_view::npos || line[at] != '[') return false;
  ++at;
  if (at < line.size() && line[at] == '[') ++at;
  at = line.find_first_not_of(blank, at);
  return at == std::string_view::npos || name_begins.find(line[at]) == std::string_view::npos;
}

/// Whether a quote at `at` cannot be taken for a part of a number: toml++ reads what begins like one up to the next
/// blank or comma, and asks of each letter in it whether it is a blank.
bool stands_alone(std::string_view line, std::size_t at) {
  while (at > 0 && line[at - 1] == '[') --at;
  return at == 0 || line[at - 1] == ',' || blank.find(line[at - 1]) != std::string_view::npos;
}

const char* complaint(std::string_view line) {
  if (is_odd_header(line)) return "a table's name is expected after [";
  char quote = '\0';   // of the text that is open
  char before = '\0';  // the last that is no blank
  bool alone = true;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (quote != '\0') {
      if (!alone && static_cast<unsigned char>(c) >= 0x80)
        return "a blank is expected before a text with letters beyond ASCII";
      if (c == '\\' && quote == '"')
        ++k;  // whatever it is, it ends nothing
      else if (c == quote)
        quote = '\0';
      continue;
    }
    if (c == '#') {
      break;
    } else if (c == '{' || c == '}') {
      return "tables in braces are not taken: give them lines of their own, below [name] or [[name]]";
    } else if (c == ':' || (c == '-' && k > 0 && line[k - 1] >= '0' && line[k - 1] <= '9')) {
      return "dates and times are not taken";
    } else if (c == '"' || c == '\'') {
      if (line.size() - k >= 3 && line[k + 1] == c && line[k + 2] == c) return "texts over several lines are not taken";
      if (before != '\0' && std::string_view("=[,.").find(before) == std::string_view::npos)
        return "a text begins after =, [ or a comma";
      quote = c;
      alone = stands_alone(line, k);
    } else if (static_cast<unsigned char>(c) >= 0x80) {
      return "letters beyond ASCII stand in texts and comments only";
    }
    if (blank.find(c) == std::string_view::npos) before = c;
  }
  return nullptr;
}

}  // namespace

std::optional<GateRefusal> refused_by_gate(std::string_view text) {
  if (text.substr(0, byte_order_mark.size()) == byte_order_mark) text.remove_prefix(byte_order_mark.size());
  for (unsigned line = 1; !text.empty(); ++line) {
    const std::string_view here = text.substr(0, text.find('\n'));
    if (const char* what = complaint(here)) return GateRefusal{line, what};
    text.remove_prefix(std::min(here.size() + 1, text.size()));
  }
  return std::nullopt;
}

}  // namespace lackwerk::packs
