#include "input/script.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

namespace lackwerk::input {
namespace {

/// What a line may say; several commands give steps of the same kind.
enum class Command {
  weights,
  base,
  lightness,
  colour,
  white,
  orbit,
  zoom,
  camera,
  light,
  dimmer,
  time,
  turn,
  press,
  release,
  click,
  down,
  move,
  up,
  tap,
  hold,
  drag
};

struct CommandForm {
  const char* word;
  Command command;
  ControlKind kind;  ///< of its (first) step
  int places;        ///< how many it takes
  int least_numbers, most_numbers;
  bool may_take_time;  ///< "over"
  const char* wants;   ///< for the error
};

constexpr int most_weights = 16;
constexpr std::array<CommandForm, 21> forms = {{
    {"weights", Command::weights, ControlKind::weights, 0, 1, most_weights, true, "weights needs one number per paint"},
    {"base", Command::base, ControlKind::base, 0, 1, most_weights, true, "base needs one number per paint"},
    {"lightness", Command::lightness, ControlKind::flake_lightness, 0, 1, most_weights, true,
     "lightness needs one number per paint"},
    {"colour", Command::colour, ControlKind::flake_colour, 0, 1, most_weights, true,
     "colour needs one number per paint"},
    {"white", Command::white, ControlKind::flake_white, 0, 1, 1, true, "white needs one number from 0 to 1"},
    {"orbit", Command::orbit, ControlKind::orbit, 0, 2, 2, true, "orbit needs azimuth and elevation in degrees"},
    {"zoom", Command::zoom, ControlKind::zoom, 0, 1, 1, true, "zoom needs one factor above 0"},
    {"camera", Command::camera, ControlKind::camera, 0, 0, 0, false, "camera needs a name"},
    {"light", Command::light, ControlKind::light, 0, 1, 1, false, "light needs a whole number from 0 to 2"},
    {"dimmer", Command::dimmer, ControlKind::dimmer, 0, 1, 1, true, "dimmer needs one number from 0 to 1"},
    {"time", Command::time, ControlKind::time, 0, 1, 1, true, "time needs one number from 0 to 1"},
    {"turn", Command::turn, ControlKind::turn, 0, 1, 1, true, "turn needs a number of detents"},
    {"press", Command::press, ControlKind::press, 0, 0, 0, false, "press needs nothing"},
    {"release", Command::release, ControlKind::release, 0, 0, 0, false, "release needs nothing"},
    {"click", Command::click, ControlKind::press, 0, 0, 0, false, "click needs nothing"},
    {"down", Command::down, ControlKind::touch_down, 1, 0, 0, false, "down needs a place"},
    {"move", Command::move, ControlKind::touch_move, 1, 0, 0, true, "move needs a place"},
    {"up", Command::up, ControlKind::touch_up, 0, 0, 0, false, "up needs nothing but 'finger N'"},
    {"tap", Command::tap, ControlKind::touch_down, 1, 0, 0, false, "tap needs a place"},
    {"hold", Command::hold, ControlKind::touch_down, 1, 1, 1, false, "hold needs a place and milliseconds"},
    {"drag", Command::drag, ControlKind::touch_down, 2, 0, 0, true, "drag needs two places and 'over MS'"},
}};

constexpr const char* place_help = "write X Y in [0, 1], or @NAME[:A[,B]]";
constexpr int most_fingers = 32;
constexpr const char* knob_name = "script";
constexpr const char* hand_name = "script";

std::vector<std::string> split_words(const std::string& line) {
  std::istringstream in(line.substr(0, line.find('#')));
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::optional<double> number(std::string_view word) {
  double value = 0.0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<double> duration(const std::string& word) {
  const auto ms = number(word);
  return ms && *ms >= 0.0 && *ms <= max_script_ms ? ms : std::nullopt;
}

bool is_share(double value) { return value >= 0.0 && value <= 1.0; }

/// A line, taken apart.
struct Parsed {
  double at_ms = 0.0;
  double over_ms = 0.0;
  bool has_over = false;
  int finger = 0;
  std::string name;  ///< camera's
  std::vector<std::string> places;
  std::vector<double> numbers;
};

/// Takes "KEYWORD VALUE" out of the words, wherever it stands.
std::optional<std::string> take_option(std::vector<std::string>& words, std::string_view keyword) {
  const auto found = std::find(words.begin(), words.end(), keyword);
  if (found == words.end()) return std::nullopt;
  if (found + 1 == words.end()) {
    words.erase(found);
    return "";
  }
  std::string value = *(found + 1);
  words.erase(found, found + 2);
  return value;
}

/// Takes a place off the front of the words. Nothing: there is none.
std::optional<std::string> take_place(std::vector<std::string>& words) {
  if (words.empty()) return std::nullopt;
  if (words[0].starts_with('@')) {
    if (!parse_target(words[0])) return std::nullopt;
    std::string target = words[0];
    words.erase(words.begin());
    return target;
  }
  if (words.size() < 2) return std::nullopt;
  const auto x = number(words[0]), y = number(words[1]);
  if (!x || !y || !is_share(*x) || !is_share(*y)) return std::nullopt;
  std::string target = "@picture:" + words[0] + "," + words[1];
  words.erase(words.begin(), words.begin() + 2);
  return target;
}

/// Whether the numbers are what the command can take.
bool numbers_fit(const CommandForm& form, const Parsed& line) {
  const auto& n = line.numbers;
  if (n.size() < static_cast<std::size_t>(form.least_numbers) || n.size() > static_cast<std::size_t>(form.most_numbers))
    return false;
  switch (form.command) {
    case Command::zoom:
      return n[0] > 0.0;
    case Command::white:
    case Command::dimmer:
    case Command::time:
      return is_share(n[0]);
    case Command::light:
      return n[0] == 0.0 || n[0] == 1.0 || n[0] == 2.0;
    case Command::hold:
      return n[0] >= 0.0 && n[0] <= max_script_ms;
    case Command::camera:
      return !line.name.empty();
    case Command::drag:
      return line.has_over;
    default:
      return true;
  }
}

Result<Parsed> take_apart(const CommandForm& form, std::vector<std::string> words, const std::string& file,
                          const std::string& field) {
  Parsed line;
  if (form.command == Command::camera) {
    // A camera may be called anything.
    if (words.size() == 1) line.name = words[0];
    if (words.size() != 1) return fail(file, field, form.wants);
    return line;
  }
  if (const auto over = take_option(words, "over")) {
    const auto ms = duration(*over);
    if (!ms) return fail(file, field, "'" + *over + "' is not a duration", "write 'over MILLISECONDS'");
    if (!form.may_take_time) return fail(file, field, std::string(form.word) + " takes no time", "leave 'over' out");
    line.over_ms = *ms;
    line.has_over = true;
  }
  if (const auto finger = take_option(words, "finger")) {
    const auto index = number(*finger);
    if (!index || *index != std::floor(*index) || *index < 0.0 || *index >= most_fingers)
      return fail(file, field, "'" + *finger + "' is no finger", "give a number from 0 to 31");
    line.finger = static_cast<int>(*index);
  }
  for (int k = 0; k < form.places; ++k) {
    auto place = take_place(words);
    if (!place) return fail(file, field, form.wants, place_help);
    line.places.push_back(std::move(*place));
  }
  for (const std::string& word : words) {
    const auto value = number(word);
    if (!value) return fail(file, field, "'" + word + "' is not a number");
    line.numbers.push_back(*value);
  }
  if (!numbers_fit(form, line)) return fail(file, field, form.wants);
  return line;
}

/// The steps a line gives.
void add_steps(const CommandForm& form, const Parsed& line, std::vector<ScriptStep>& out) {
  const auto add = [&](ControlKind kind, double at_ms, double over_ms, std::vector<double> values, std::string name) {
    out.push_back({at_ms, over_ms, {kind, std::move(values), std::move(name), line.finger}});
  };
  const double at = line.at_ms;
  switch (form.command) {
    case Command::press:
    case Command::release:
      return add(form.kind, at, 0.0, {0.0}, knob_name);
    case Command::click:
      add(ControlKind::press, at, 0.0, {0.0}, knob_name);
      return add(ControlKind::release, at + script_tap_ms, 0.0, {0.0}, knob_name);
    case Command::turn:
      return add(form.kind, at, line.over_ms, line.numbers, knob_name);
    case Command::down:
    case Command::move:
      return add(form.kind, at, line.over_ms, {1.0}, line.places[0]);
    case Command::up:
      return add(form.kind, at, 0.0, {}, hand_name);
    case Command::tap:
    case Command::hold:
      add(ControlKind::touch_down, at, 0.0, {1.0}, line.places[0]);
      return add(ControlKind::touch_up, at + (line.numbers.empty() ? script_tap_ms : line.numbers[0]), 0.0, {},
                 hand_name);
    case Command::drag:
      add(ControlKind::touch_down, at, 0.0, {1.0}, line.places[0]);
      add(ControlKind::touch_move, at, line.over_ms, {1.0}, line.places[1]);
      return add(ControlKind::touch_up, at + line.over_ms, 0.0, {}, hand_name);
    default:
      return add(form.kind, at, line.over_ms, line.numbers, line.name);
  }
}

}  // namespace

std::optional<TouchTarget> parse_target(std::string_view text) {
  constexpr std::size_t most_letters = 32;
  if (!text.starts_with('@')) return std::nullopt;
  text.remove_prefix(1);
  const std::size_t colon = std::min(text.find(':'), text.size());
  TouchTarget target{std::string(text.substr(0, colon)), {}};
  const bool is_name =
      !target.name.empty() && target.name.size() <= most_letters &&
      std::all_of(target.name.begin(), target.name.end(), [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
  if (!is_name) return std::nullopt;
  if (colon == text.size()) return target;
  text.remove_prefix(colon + 1);
  for (;;) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const auto value = number(text.substr(0, comma));
    if (!value || target.values.size() == 2) return std::nullopt;
    target.values.push_back(*value);
    if (comma == text.size()) return target;
    text.remove_prefix(comma + 1);
  }
}

Result<std::vector<ScriptStep>> parse_script(std::string_view text, const std::string& file) {
  std::vector<ScriptStep> steps;
  std::istringstream in{std::string(text)};
  int line_number = 0;
  double last_ms = 0.0;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    auto words = split_words(line);
    if (words.empty()) continue;
    const std::string field = "line " + std::to_string(line_number);
    const auto at = duration(words[0]);
    if (!at)
      return fail(file, field, "'" + words[0] + "' is not a time in milliseconds", "begin the line with a time from 0");
    if (*at < last_ms) return fail(file, field, "goes back in time", "sort the lines by time");
    last_ms = *at;
    const std::string word = words.size() > 1 ? words[1] : "";
    const auto form = std::find_if(forms.begin(), forms.end(), [&](const CommandForm& f) { return word == f.word; });
    if (form == forms.end()) {
      std::string known;
      for (const CommandForm& f : forms) known += (known.empty() ? "" : ", ") + std::string(f.word);
      return fail(file, field, "unknown command '" + word + "'", "use one of " + known);
    }
    words.erase(words.begin(), words.begin() + 2);
    auto parsed = take_apart(*form, std::move(words), file, field);
    if (!parsed) return tl::unexpected(parsed.error());
    parsed->at_ms = *at;
    add_steps(*form, *parsed, steps);
  }
  // A finger that goes up after the next line has begun comes after it.
  std::stable_sort(steps.begin(), steps.end(),
                   [](const ScriptStep& a, const ScriptStep& b) { return a.at_ms < b.at_ms; });
  return steps;
}

Result<std::vector<ScriptStep>> read_script(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return fail(path.string(), "", "cannot be read", "check the path");
  std::string text(max_script_bytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad() || (in.fail() && !in.eof())) return fail(path.string(), "", "cannot be read", "is it a folder?");
  if (text.size() > max_script_bytes) return fail(path.string(), "", "is larger than 1 MiB", "split the tour");
  return parse_script(text, path.string());
}

}  // namespace lackwerk::input
