#include "kiosk/display/config_text.hpp"

#include <charconv>

#include "kiosk/display/config_keys.hpp"
#include "kiosk/display/interface_words.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr std::size_t line_width = 100;

/// Shortest text that reads back as the same number.
std::string number(double value) {
  std::array<char, 512> text{};  // enough for any double
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed).ptr;
  return {text.data(), end};
}

template <class Numbers>
std::string list(const Numbers& numbers) {
  std::string out = "[";
  for (const double value : numbers) out += (out.size() > 1 ? ", " : "") + number(value);
  return out + "]";
}

/// Texts of ours hold no quotes and no control characters: the reader lets none in.
std::string in_quotes(std::string_view text) { return "\"" + std::string(text) + "\""; }

struct Writer {
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const int* value) const { return std::to_string(*value); }
  std::string operator()(const double* value) const { return number(*value); }
  std::string operator()(const std::string* value) const { return in_quotes(*value); }
  std::string operator()(const std::vector<std::string>* value) const {
    std::string out = "[";
    for (const std::string& text : *value) out += (out.size() > 1 ? ", " : "") + in_quotes(text);
    return out + "]";
  }
  std::string operator()(const Platform* value) const { return in_quotes(platform_name(*value)); }
  std::string operator()(const Rotation* value) const { return std::to_string(degrees_of(*value)); }
  std::string operator()(const Mode* value) const {
    if ((*value)[0] == 0) return in_quotes("preferred");
    return in_quotes(std::to_string((*value)[0]) + "x" + std::to_string((*value)[1]));
  }
  std::string operator()(const Chromaticity* value) const { return list(std::array{value->x, value->y}); }
  std::string operator()(const Curves* value) const {
    return (*value)[0].empty() ? in_quotes("srgb") : list((*value)[0]);
  }
  std::string operator()(const std::optional<input::CalibrationMatrix>* value) const {
    return *value ? list(**value) : "[]";
  }
  std::string operator()(const input::KnobProfile* value) const { return in_quotes(word_of(*value)); }
  std::string operator()(const ui::Language* value) const { return in_quotes(word_of(*value)); }
  std::string operator()(const NightHours* value) const { return in_quotes(text_of(*value)); }
};

/// What each kind of value is called.
struct Namer {
  double least, most;
  const std::vector<std::string>& words;

  [[nodiscard]] std::string range() const { return number(least) + " to " + number(most); }
  static std::string one_of(const std::vector<std::string>& words) {
    std::string out;
    for (std::size_t k = 0; k < words.size(); ++k)
      out += (k == 0 ? "" : k + 1 == words.size() ? " or " : ", ") + in_quotes(words[k]);
    return out;
  }

  std::string operator()(const bool* /*value*/) const { return "true or false"; }
  std::string operator()(const int* /*value*/) const { return "a whole number, " + range(); }
  std::string operator()(const double* /*value*/) const { return "a number, " + range(); }
  std::string operator()(const std::string* /*value*/) const {
    if (!words.empty()) return one_of(words);
    return (least > 0.0 ? "a text, not empty, of at most " : "a text of at most ") + number(most) + " characters";
  }
  std::string operator()(const std::vector<std::string>* /*value*/) const {
    return "a list of at most " + number(most) + " texts";
  }
  std::string operator()(const Platform* /*value*/) const { return one_of(platform_words()); }
  std::string operator()(const Rotation* /*value*/) const { return "0, 90, 180 or 270"; }
  std::string operator()(const Mode* /*value*/) const { return "\"preferred\" or a size as \"1920x1080\""; }
  std::string operator()(const Chromaticity* /*value*/) const { return "[x, y], each 0 to 1"; }
  std::string operator()(const Curves* /*value*/) const {
    return "\"srgb\", an exponent " + range() + ", or a list of 2 to 4096 rising numbers, 0 to 1";
  }
  std::string operator()(const std::optional<input::CalibrationMatrix>* /*value*/) const {
    return "[], or six numbers, two rows of a matrix that can be inverted";
  }
  std::string operator()(const input::KnobProfile* /*value*/) const { return one_of(profile_words()); }
  std::string operator()(const ui::Language* /*value*/) const { return one_of(language_words()); }
  std::string operator()(const NightHours* /*value*/) const { return "\"\" or hours as \"20:00-08:00\""; }
};

/// Comment lines of at most line_width.
void comment(std::string& out, std::string_view text) {
  while (!text.empty()) {
    std::size_t cut = text.size();
    if (cut + 2 > line_width) cut = text.rfind(' ', line_width - 2);
    out += "# " + std::string(text.substr(0, cut)) + "\n";
    text.remove_prefix(cut == text.size() ? cut : cut + 1);
  }
}

template <class Owner>
void write_section(std::string& out, const Section<Owner>& section, bool repeated) {
  out += "\n";
  comment(out, section.help);
  // The header of a repeated table is a setting too: it makes an entry.
  if (repeated)
    out += "#[[" + std::string(section.name) + "]]\n";
  else if (!section.name.empty())
    out += "[" + std::string(section.name) + "]\n";
  Owner defaults;  // without braces: see config.cpp
  for (const Key<Owner>& key : section.keys) {
    out += "\n";
    comment(out, key.help);
    // That a switch is true or false, or a path a text, goes without saying.
    const Slot slot = key.slot(defaults);
    const bool plain = std::holds_alternative<bool*>(slot) ||
                       (std::holds_alternative<std::string*>(slot) && key.words == nullptr && key.least == 0.0);
    if (!plain) comment(out, "Takes " + kind_of(key, defaults) + ".");
    out += "#" + std::string(key.name) + " = " + text_of(slot) + "\n";
  }
}

}  // namespace

std::string text_of(const Slot& slot) {
  return std::visit([](const auto* value) { return Writer{}(value); }, slot);
}

std::string kind_of(const Slot& slot, double least, double most, const std::vector<std::string>& words) {
  return std::visit([&](const auto* value) { return Namer{least, most, words}(value); }, slot);
}

std::string config_text() {
  std::string out;
  comment(out, "kiosk.toml of the Lackwerk kiosk. A key that is commented out has the value that stands there.");
  comment(out, "The command line wins over this file. The kiosk reads it once, when it starts.");
  for (const Section<Config>& section : config_sections()) write_section(out, section, false);
  write_section(out, knob_section(), true);
  write_section(out, touch_section(), true);
  return out;
}

}  // namespace lackwerk::kiosk
