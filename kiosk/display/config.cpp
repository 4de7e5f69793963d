// The only file of the kiosk that includes toml++, which is slow to compile.
#include "kiosk/display/config.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/edit_distance.hpp"
#include "input/touch.hpp"
#include "kiosk/display/config_keys.hpp"
#include "kiosk/display/interface_words.hpp"
#include "kiosk/display/pin.hpp"
#include "kiosk/display/stage.hpp"
#include "packs/toml_gate.hpp"

namespace lackwerk::kiosk {
namespace {

using toml::node;

bool is_plain(const std::string& text) {
  return std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

std::optional<double> number_in(const node& value, double least, double most) {
  const auto number = value.is_number() ? value.value<double>() : std::nullopt;
  if (!number || !(*number >= least && *number <= most)) return std::nullopt;  // NaN lies nowhere
  return number;
}

std::optional<std::vector<double>> numbers_in(const node& value, double least, double most) {
  const toml::array* list = value.as_array();
  if (list == nullptr) return std::nullopt;
  std::vector<double> numbers;
  numbers.reserve(list->size());
  for (const node& entry : *list) {
    const auto number = number_in(entry, least, most);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

/// Puts a node's value where it belongs; false: it is none that the key can take.
struct Taker {
  const node& from;
  double least, most;
  const std::vector<std::string>& words;

  bool operator()(bool* to) const {
    const auto* flag = from.as_boolean();
    if (flag != nullptr) *to = flag->get();
    return flag != nullptr;
  }
  bool operator()(int* to) const {
    const auto* whole = from.as_integer();
    if (whole == nullptr) return false;
    const auto value = static_cast<double>(whole->get());
    if (value < least || value > most) return false;
    *to = static_cast<int>(whole->get());
    return true;
  }
  bool operator()(double* to) const {
    const auto value = number_in(from, least, most);
    if (value) *to = *value;
    return value.has_value();
  }
  [[nodiscard]] static std::optional<std::string> text(const node& value) {
    const auto* text = value.as_string();
    return text != nullptr && is_plain(text->get()) ? std::optional(text->get()) : std::nullopt;
  }
  bool operator()(std::string* to) const {
    auto value = text(from);
    if (!value) return false;
    const auto length = static_cast<double>(value->size());
    if (length < least || length > most) return false;
    if (!words.empty() && std::find(words.begin(), words.end(), *value) == words.end()) return false;
    *to = std::move(*value);
    return true;
  }
  bool operator()(std::vector<std::string>* to) const {
    const toml::array* list = from.as_array();
    if (list == nullptr || static_cast<double>(list->size()) > most) return false;
    std::vector<std::string> texts;
    texts.reserve(list->size());
    for (const node& entry : *list) {
      auto value = text(entry);
      if (!value || value->empty()) return false;
      texts.push_back(std::move(*value));
    }
    *to = std::move(texts);
    return true;
  }
  bool operator()(Platform* to) const {
    const auto value = text(from);
    const auto found = value ? platform_of(*value) : std::nullopt;
    if (found) *to = *found;
    return found.has_value();
  }
  bool operator()(Rotation* to) const {
    const auto value = from.is_integer() ? number_in(from, 0.0, 360.0) : std::nullopt;
    const auto found = value ? rotation_of(static_cast<int>(*value)) : std::nullopt;
    if (found) *to = *found;
    return found.has_value();
  }
  bool operator()(Mode* to) const {
    const auto value = text(from);
    if (!value) return false;
    if (*value == "preferred") {
      *to = {0, 0};
      return true;
    }
    const auto size = parse_size(*value);
    if (size) *to = {size->width, size->height};
    return size.has_value();
  }
  bool operator()(Chromaticity* to) const {
    const auto xy = numbers_in(from, 0.0, 1.0);
    if (!xy || xy->size() != 2) return false;
    *to = {(*xy)[0], (*xy)[1]};
    return true;
  }
  bool operator()(Curves* to) const {
    if (const auto value = text(from)) {
      if (*value == "srgb") *to = {};
      return *value == "srgb";
    }
    if (const auto exponent = number_in(from, least, most)) {
      to->fill(power_curve(*exponent));
      return true;
    }
    // Whether it rises is for check_profile().
    const auto points = numbers_in(from, 0.0, 1.0);
    if (points && !points->empty()) to->fill(*points);
    return points && !points->empty();
  }
  bool operator()(std::optional<input::CalibrationMatrix>* to) const {
    constexpr double farthest = 100.0;  // panels away: wherever a device may think it is
    const auto rows = numbers_in(from, -farthest, farthest);
    if (!rows || (!rows->empty() && rows->size() != 6)) return false;
    if (rows->empty()) {
      to->reset();
      return true;
    }
    input::CalibrationMatrix matrix{};
    std::copy(rows->begin(), rows->end(), matrix.begin());
    if (input::is_usable(matrix)) *to = matrix;
    return input::is_usable(matrix);
  }
  bool operator()(input::KnobProfile* to) const {
    const auto value = text(from);
    const auto found = value ? input::knob_profile_of(*value) : std::nullopt;
    if (found) *to = *found;
    return found.has_value();
  }
  bool operator()(ui::Language* to) const {
    const auto value = text(from);
    const auto found = value ? language_of(*value) : std::nullopt;
    if (found) *to = *found;
    return found.has_value();
  }
  bool operator()(NightHours* to) const {
    const auto value = text(from);
    const auto found = value ? night_hours_of(*value) : std::nullopt;
    if (found) *to = *found;
    return found.has_value();
  }
};

std::string full_name(std::string_view section, std::string_view key) {
  return (section.empty() ? "" : std::string(section) + ".") + std::string(key);
}

class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  void read(const toml::table& root) {
    for (const auto& [key, value] : root) read_top(key, value);
    // Their defaults are those of [knobs], wherever that stands.
    read_list(root, knob_section(), config_.knobs.devices, max_knob_settings, [&] {
      return input::KnobMatch{{}, config_.knobs.tuning};
    });
    read_list(root, touch_section(), config_.touch, input::max_touch_settings, [] { return input::TouchSettings{}; });
    check_panel(root);
    check_interface(root);
  }

  void wrong(unsigned line, const std::string& field, std::string what, std::string remedy) {
    std::string where = line == 0 ? field : "line " + std::to_string(line);
    if (line != 0 && !field.empty()) where += ", " + field;
    errors_.push_back({line, {file_, std::move(where), std::move(what), std::move(remedy)}});
  }

  ConfigReading finish() {
    std::stable_sort(errors_.begin(), errors_.end(), [](const auto& a, const auto& b) { return a.line < b.line; });
    ConfigReading reading{std::move(config_), {}};
    reading.errors.reserve(errors_.size());
    for (Located& error : errors_) reading.errors.push_back(std::move(error.error));
    return reading;
  }

 private:
  struct Located {
    unsigned line;
    Error error;
  };

  void read_top(const toml::key& key, const node& value) {
    const auto& sections = config_sections();
    if (key.str() == knob_section().name || key.str() == touch_section().name) return;
    const auto section = std::find_if(sections.begin() + 1, sections.end(),
                                      [&](const Section<Config>& s) { return s.name == key.str(); });
    if (section == sections.end()) return read_key(sections.front(), config_, key, value, known_at_top());
    const toml::table* table = value.as_table();
    if (table == nullptr) {
      const std::string name(section->name);
      return wrong(key.source().begin.line, name, "must be a table", "write [" + name + "] and its keys below");
    }
    read_table(*section, config_, *table);
  }

  template <class Owner>
  void read_table(const Section<Owner>& section, Owner& owner, const toml::table& table) {
    std::vector<std::string_view> known;
    for (const Key<Owner>& key : section.keys) known.push_back(key.name);
    for (const auto& [key, value] : table) read_key(section, owner, key, value, known);
  }

  template <class Owner>
  void read_key(const Section<Owner>& section, Owner& owner, const toml::key& key, const node& value,
                const std::vector<std::string_view>& known) {
    const auto entry = std::find_if(section.keys.begin(), section.keys.end(),
                                    [&](const Key<Owner>& k) { return k.name == key.str(); });
    const unsigned line = key.source().begin.line;
    if (entry == section.keys.end()) {
      const std::string name = input::clean_name(std::string(key.str()));
      return wrong(line, full_name(section.name, name), "unknown key", advice(section.name, name, known));
    }
    const auto words = entry->words != nullptr ? entry->words() : std::vector<std::string>{};
    const Slot slot = entry->slot(owner);
    if (std::visit([&](auto* to) { return Taker{value, entry->least, entry->most, words}(to); }, slot)) return;
    Owner defaults;  // without braces: with them GCC 12 takes its texts for uninitialised
    const std::string kind = kind_of(*entry, defaults);
    const std::string standard = text_of(entry->slot(defaults));
    wrong(line, full_name(section.name, entry->name), "must be " + kind,
          "the default is " + std::string(entry->name) + " = " + standard);
  }

  static std::vector<std::string_view> known_at_top() {
    std::vector<std::string_view> known;
    for (const Section<Config>& section : config_sections()) {
      if (!section.name.empty()) known.push_back(section.name);
      if (section.name.empty())
        for (const Key<Config>& key : section.keys) known.push_back(key.name);
    }
    known.push_back(knob_section().name);
    known.push_back(touch_section().name);
    return known;
  }

  /// Where an unknown key belongs, or the nearest known one.
  static std::string advice(std::string_view table, const std::string& name,
                            const std::vector<std::string_view>& known) {
    for (const Section<Config>& section : config_sections())
      for (const Key<Config>& key : section.keys)
        if (key.name == name && section.name != table)
          return section.name.empty() ? "it belongs above the first table"
                                      : "it belongs below [" + std::string(section.name) + "]";
    const auto near = std::min_element(known.begin(), known.end(), [&](std::string_view a, std::string_view b) {
      return edit_distance(name, a) < edit_distance(name, b);
    });
    return "did you mean " + std::string(*near) + "?";
  }

  template <class Owner, class Fresh>
  void read_list(const toml::table& root, const Section<Owner>& section, std::vector<Owner>& out, std::size_t most,
                 const Fresh& fresh) {
    const node* value = root.get(section.name);
    if (value == nullptr) return;
    const std::string name(section.name);
    const toml::array* list = value->as_array();
    const bool are_tables =
        list != nullptr && std::all_of(list->begin(), list->end(), [](const node& n) { return n.is_table(); });
    const unsigned line = value->source().begin.line;
    if (!are_tables)
      return wrong(line, name, "must be a list of tables", "write [[" + name + "]] and its keys below, for each");
    if (list->size() > most)
      return wrong(line, name, "has more than " + std::to_string(most) + " entries", "leave out what never comes");
    out.reserve(list->size());
    for (const node& entry : *list) {
      const toml::table& table = *entry.as_table();
      Owner& owner = out.emplace_back(fresh());
      read_table(section, owner, table);
      if constexpr (std::is_same_v<Owner, input::KnobMatch>)
        if (!table.contains("match"))
          wrong(entry.source().begin.line, name + ".match", "is missing", "say which knob is meant");
    }
  }

  void check_panel(const toml::table& root) {
    const toml::table* panel = root["panel"].as_table();
    if (panel == nullptr) return;
    const unsigned line = panel->source().begin.line;
    DisplayProfile& profile = config_.output.profile;
    constexpr std::array<const char*, 5> measured{"white", "red", "green", "blue", "curve"};
    const bool any =
        std::any_of(measured.begin(), measured.end(), [&](const char* name) { return panel->contains(name); });
    if (!any) return;
    if (!config_.icc.empty()) return wrong(line, "panel.icc", "stands beside chromaticities or a curve", "keep one");
    profile.source = "kiosk.toml";
    // A key that was refused above has its default, which says nothing about the others.
    const bool complained = std::any_of(errors_.begin(), errors_.end(), [](const Located& e) {
      return e.error.field.find(", panel.") != std::string::npos;
    });
    if (complained) return;
    if (const auto checked = check_profile(profile, file_); !checked)
      wrong(line, "panel: " + checked.error().field, checked.error().what, checked.error().remedy);
  }

  /// What a range or a list of words cannot say.
  void check_interface(const toml::table& root) {
    InterfaceSettings& interface = config_.interface;
    const auto line_of = [&](const char* key) { return root["interface"][key].node()->source().begin.line; };
    if (interface.dpi > 0.0 && interface.dpi < least_dpi) {
      wrong(line_of("dpi"), "interface.dpi", "is less than any panel has", "0 takes what the panel says");
      interface.dpi = 0.0;
    }
    // A PIN in plain digits is what this catches most often; it is not repeated in the message.
    if (!interface.pin.empty() && !is_pin_hash(interface.pin)) {
      wrong(line_of("pin"), "interface.pin", "is not the hash of a PIN", "lackwerk-kiosk --hash-pin makes one");
      interface.pin.clear();
    }
    interface.experience.has_pin = !interface.pin.empty();
  }

  std::string file_;
  Config config_;
  std::vector<Located> errors_;
};

}  // namespace

ConfigReading parse_config(std::string_view text, const std::string& file) {
  Reader reader(file);
  if (text.size() > max_config_bytes) {
    reader.wrong(0, "", "is longer than 64 KiB", "give a TOML text file");
    return reader.finish();
  }
  if (const auto refused = packs::refused_by_gate(text)) {
    reader.wrong(refused->line, "", refused->what, "mend the TOML syntax");
    return reader.finish();
  }
  try {
    reader.read(toml::parse(text, file));
  } catch (const toml::parse_error& error) {
    reader.wrong(error.source().begin.line, "", input::clean_name(std::string(error.description())),
                 "mend the TOML syntax");
  }
  return reader.finish();
}

Result<Config> read_config(const std::filesystem::path& path) {
  const std::string file = path.string();
  std::ifstream in(path, std::ios::binary);
  if (!in) return fail(file, "", "cannot be read", "check the path and its permissions");
  std::string text(max_config_bytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad() || (in.fail() && !in.eof())) return fail(file, "", "cannot be read", "is it a folder?");
  ConfigReading reading = parse_config(text, file);
  if (reading.errors.empty()) return std::move(reading.config);
  if (reading.errors.size() == 1) return tl::unexpected(std::move(reading.errors.front()));
  std::string lines = std::to_string(reading.errors.size()) + " mistakes";
  for (Error& error : reading.errors) {
    error.file.clear();
    lines += "\n  " + error.line();
  }
  return fail(file, "", std::move(lines));
}

}  // namespace lackwerk::kiosk
