#include "packs/tools/angle_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/edit_distance.hpp"
#include "core/in_plane.hpp"
#include "packs/tools/angle_names.hpp"
#include "packs/tools/cie_observer.hpp"
#include "packs/tools/csv_table.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::size_t max_readings = 64;
/// White is 100; the glint at -15 degrees of a bright effect paint reaches a few hundred.
constexpr double max_lab = 1000.0, max_factor = 100.0;
/// A table that does not say what it holds: no paint's largest factor is above 10 as a factor, and none (at the angles
/// near the mirror direction, which all instruments have) is below 1 percent.
constexpr double surely_factor = 1.0, surely_percent = 10.0;
constexpr double highest_light_deg = 89.9;  ///< a table at the horizon has no light on it
constexpr double least_nm = 300.0, most_nm = 1100.0, needed_from_nm = 400.0, needed_to_nm = 700.0;

/// Where a cell stands, for errors.
std::string place(const CsvCell& cell, const std::string& column) {
  return "line " + std::to_string(cell.line) + ", column " + column;
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

enum class Column : std::uint8_t { angle, light, aspecular, l, a, b, sample, ignored, wavelength };

struct ColumnName {
  const char* name;
  Column column;
};
constexpr std::array<ColumnName, 20> known_columns{{{"angle", Column::angle},
                                                    {"geometry", Column::angle},
                                                    {"light_deg", Column::light},
                                                    {"aspecular_deg", Column::aspecular},
                                                    {"l", Column::l},
                                                    {"a", Column::a},
                                                    {"b", Column::b},
                                                    {"l*", Column::l},
                                                    {"a*", Column::a},
                                                    {"b*", Column::b},
                                                    {"sample", Column::sample},
                                                    {"name", Column::sample},
                                                    {"date", Column::ignored},
                                                    {"time", Column::ignored},
                                                    {"comment", Column::ignored},
                                                    {"instrument", Column::ignored},
                                                    {"c", Column::ignored},
                                                    {"h", Column::ignored},
                                                    {"c*", Column::ignored},
                                                    {"h*", Column::ignored}}};

/// "400", "400nm", "R400", "400 nm [%]"; `percent` is set where the heading says so.
std::optional<double> wavelength_of(std::string text, bool& percent) {
  std::string plain;
  for (const char c : lower(std::move(text))) {
    if (c == '%') percent = true;
    if (c != ' ' && c != '%' && c != '[' && c != ']' && c != '(' && c != ')' && c != '_') plain += c;
  }
  if (plain.starts_with('r')) plain.erase(0, 1);
  if (plain.ends_with("nm")) plain.resize(plain.size() - 2);
  const auto value = csv_number(plain, false);
  return value && *value >= least_nm && *value <= most_nm ? value : std::nullopt;
}

/// What the comments say.
struct Settings {
  std::string name, source;
  std::optional<bool> percent;
  AngleOrder order = AngleOrder::unknown;
  std::string illuminant, observer;  ///< "line N" where it is another than D65 and 2
};

/// What the header says.
struct Columns {
  std::vector<std::optional<Column>> of;  ///< per column
  std::vector<double> nm;                 ///< rising
  std::vector<std::size_t> nm_column;
  bool percent = false;
  [[nodiscard]] std::optional<std::size_t> find(Column wanted) const {
    for (std::size_t k = 0; k < of.size(); ++k)
      if (of[k] == wanted) return k;
    return std::nullopt;
  }
  [[nodiscard]] bool has_lab() const { return find(Column::l) || find(Column::a) || find(Column::b); }
};

class Reader {
 public:
  Reader(const std::filesystem::path& path, CsvTable table) : path_(path), table_(std::move(table)) {}

  Result<Capture> read() {
    if (auto ok = read_settings(); !ok) return tl::unexpected(ok.error());
    turn();
    if (auto ok = read_header(); !ok) return tl::unexpected(ok.error());
    if (auto ok = read_angles(); !ok) return tl::unexpected(ok.error());
    Capture capture;
    capture.is_fitted = false;
    capture.identity.name = settings_.name.empty() ? path_.stem().string() : settings_.name;
    capture.identity.source = settings_.source.empty() ? path_.filename().string() : settings_.source;
    capture.identity.lobes = capture.identity.flakes = capture.identity.coat = core::Provenance::measured;
    if (auto ok = columns_.has_lab() ? read_lab(capture) : read_spectra(capture); !ok)
      return tl::unexpected(ok.error());
    return capture;
  }

 private:
  [[nodiscard]] tl::unexpected<Error> bad(std::string field, std::string what, std::string remedy) const {
    return fail(path_.string(), std::move(field), std::move(what), std::move(remedy));
  }
  [[nodiscard]] std::string heading(std::size_t column) const { return table_.rows[0][column].text; }

  Result<void> read_settings() {
    for (const CsvSetting& s : table_.settings) {
      const std::string where = "line " + std::to_string(s.line) + ", " + s.key;
      const std::string key = lower(s.key), value = lower(s.value);
      if (key == "name") settings_.name = s.value;
      if (key == "source") settings_.source = s.value;
      if (key == "illuminant" && value != "d65") settings_.illuminant = where;
      if (key == "observer" && value != "2" && value != "2 degrees" && value != "1931") settings_.observer = where;
      if (key == "reflectance") {
        if (value != "factor" && value != "percent") return bad(where, "unknown", "write factor or percent");
        settings_.percent = value == "percent";
      }
      if (key == "order") {
        if (value != "aspecular-first" && value != "light-first")
          return bad(where, "unknown", "write aspecular-first or light-first");
        settings_.order = value == "light-first" ? AngleOrder::light_first : AngleOrder::aspecular_first;
      }
    }
    return {};
  }

  /// One column per angle: turned into one row per angle.
  void turn() {
    const auto& header = table_.rows[0];
    if (header.size() < 2 || !parse_angle_name(header[1].text)) return;
    table_ = transposed(table_);
    table_.rows[0][0].text = "angle";
  }

  Result<void> read_header() {
    std::vector<std::pair<double, std::size_t>> waves;
    for (std::size_t k = 0; k < table_.rows[0].size(); ++k) {
      const CsvCell& cell = table_.rows[0][k];
      const std::string where = place(cell, std::to_string(k + 1));
      const std::string name = lower(cell.text);
      const auto known =
          std::find_if(known_columns.begin(), known_columns.end(), [&](const ColumnName& c) { return name == c.name; });
      if (known != known_columns.end()) {
        if (known->column != Column::ignored && columns_.find(known->column))
          return bad(where, cell.text + " is there twice", "leave one of them out");
        columns_.of.emplace_back(known->column);
        continue;
      }
      const auto nm = wavelength_of(cell.text, columns_.percent);
      if (!nm) return bad(where, "unknown column '" + cell.text.substr(0, 40) + "'", nearest(name.substr(0, 40)));
      columns_.of.emplace_back(Column::wavelength);
      waves.emplace_back(*nm, k);
    }
    std::sort(waves.begin(), waves.end());
    for (const auto& [nm, column] : waves) {
      if (!columns_.nm.empty() && nm == columns_.nm.back())
        return bad(place(table_.rows[0][column], heading(column)), "is there twice", "leave one of them out");
      columns_.nm.push_back(nm);
      columns_.nm_column.push_back(column);
    }
    return check_columns();
  }

  [[nodiscard]] static std::string nearest(const std::string& name) {
    const auto near = std::min_element(known_columns.begin(), known_columns.end(), [&](const auto& a, const auto& b) {
      return edit_distance(name, a.name) < edit_distance(name, b.name);
    });
    return std::string("did you mean ") + near->name + "? Spectra have wavelengths from 300 to 1100 nm as headings";
  }

  [[nodiscard]] Result<void> check_columns() const {
    const std::string where = "line " + std::to_string(table_.rows[0][0].line);
    const bool pair = columns_.find(Column::light) && columns_.find(Column::aspecular);
    if (!columns_.find(Column::angle) && !pair)
      return bad(where, "has no angles", "add a column angle (15as45, ...), or light_deg and aspecular_deg");
    if (columns_.has_lab()) {
      for (const auto& [column, name] : {std::pair{Column::l, "L"}, {Column::a, "a"}, {Column::b, "b"}})
        if (!columns_.find(column)) return bad(where, std::string("has no column ") + name, "give L, a and b");
      if (!columns_.nm.empty()) return bad(where, "has both Lab and spectra", "leave one of them out");
      const std::string& other = settings_.illuminant.empty() ? settings_.observer : settings_.illuminant;
      if (!other.empty()) return bad(other, "is not D65 and 2 degrees", "export Lab for D65/2, or spectra");
    } else {
      if (columns_.nm.empty()) return bad(where, "has neither Lab nor spectra", "add columns L, a, b or wavelengths");
      if (columns_.nm.front() > needed_from_nm || columns_.nm.back() < needed_to_nm)
        return bad(where, "spectra do not reach from 400 to 700 nm", "export the whole visible range");
      constexpr double widest_step_nm = 20.0;  // ASTM E308 has weights up to 20 nm
      for (std::size_t k = 1; k < columns_.nm.size(); ++k)
        if (columns_.nm[k] - columns_.nm[k - 1] > widest_step_nm)
          return bad(where, "spectra have a gap of more than 20 nm before " + heading(columns_.nm_column[k]),
                     "export all wavelengths");
    }
    if (table_.rows.size() < 2) return bad(where, "has no readings below it", "export the table again");
    if (table_.rows.size() - 1 > max_readings) return bad(where, "has more than 64 readings", "give one paint's table");
    return {};
  }

  Result<double> number(std::size_t row, std::size_t column, double lo, double hi) const {
    const CsvCell& cell = table_.rows[row][column];
    const auto value = csv_number(cell.text, table_.decimal_comma);
    const std::string where = place(cell, heading(column));
    if (!value) return bad(where, "'" + cell.text.substr(0, 40) + "' is not a number", "write a finite number");
    if (*value < lo && lo == 0.0) return bad(where, "is negative", "measure the dark again");
    if (*value < lo || *value > hi) return bad(where, "is out of range", "export the table again");
    return *value;
  }

  Result<void> read_angles() {
    const auto named = columns_.find(Column::angle);
    if (named) {
      std::vector<AngleName> names;
      for (std::size_t row = 1; row < table_.rows.size(); ++row) {
        const CsvCell& cell = table_.rows[row][*named];
        const auto name = parse_angle_name(cell.text);
        if (!name)
          return bad(place(cell, "angle"), "'" + cell.text.substr(0, 40) + "' is no angle", "write 15as45 or the like");
        names.push_back(*name);
      }
      WrongName wrong;
      auto angles = settle_angles(names, settings_.order, wrong);
      if (!angles) {
        const CsvCell& cell = table_.rows[wrong.index + 1][*named];
        return bad(place(cell, "angle"), "'" + cell.text + "': " + wrong.what,
                   "add a line # order = aspecular-first (or light-first), or columns light_deg and aspecular_deg");
      }
      angles_ = std::move(*angles);
    } else {
      for (std::size_t row = 1; row < table_.rows.size(); ++row) {
        const auto light = number(row, *columns_.find(Column::light), 0.0, highest_light_deg);
        if (!light) return tl::unexpected(light.error());
        const auto aspecular = number(row, *columns_.find(Column::aspecular), -180.0, 180.0);
        if (!aspecular) return tl::unexpected(aspecular.error());
        angles_.push_back({*light, *aspecular});
      }
    }
    return check_angles();
  }

  [[nodiscard]] Result<void> check_angles() const {
    const std::size_t column = columns_.find(Column::angle).value_or(columns_.find(Column::aspecular).value_or(0));
    const auto sample = columns_.find(Column::sample);
    for (std::size_t k = 0; k < angles_.size(); ++k) {
      const CsvCell& cell = table_.rows[k + 1][column];
      const std::string name = core::angle_name(angles_[k]);
      if (!(angles_[k].light_deg >= 0.0 && angles_[k].light_deg <= highest_light_deg))
        return bad(place(cell, heading(column)), name + " has its light below the horizon or beyond the normal",
                   "light angles are 0 to 89.9 degrees; aspecular angles may be negative");
      if (std::abs(core::eye_deg(angles_[k].light_deg, angles_[k].aspecular_deg)) >= 90.0)
        return bad(place(cell, heading(column)), name + " looks from below the horizon",
                   "check light and aspecular angle");
      if (std::find(angles_.begin(), angles_.begin() + static_cast<std::ptrdiff_t>(k), angles_[k]) !=
          angles_.begin() + static_cast<std::ptrdiff_t>(k))
        return bad(place(cell, heading(column)), name + " is there twice", "leave one of them out, or average them");
      if (sample && table_.rows[k + 1][*sample].text != table_.rows[1][*sample].text)
        return bad(place(cell, heading(*sample)), "another sample begins", "give each paint its own file");
    }
    return {};
  }

  Result<void> read_lab(Capture& capture) const {
    constexpr std::array<Column, 3> axes{Column::l, Column::a, Column::b};
    for (std::size_t k = 0; k < angles_.size(); ++k) {
      AngleReading reading{angles_[k].light_deg, angles_[k].aspecular_deg, glm::dvec3(0.0)};
      for (int axis = 0; axis < 3; ++axis) {
        const auto column = *columns_.find(axes[static_cast<std::size_t>(axis)]);
        const auto value = number(k + 1, column, axis == 0 ? 0.0 : -max_lab, max_lab);
        if (!value) return tl::unexpected(value.error());
        reading.lab[axis] = *value;
      }
      capture.angles.push_back(reading);
    }
    return {};
  }

  Result<void> read_spectra(Capture& capture) const {
    std::vector<std::vector<double>> spectra;
    double most = 0.0;
    for (std::size_t k = 0; k < angles_.size(); ++k) {
      spectra.emplace_back();
      for (const std::size_t column : columns_.nm_column) {
        const auto value = number(k + 1, column, 0.0, max_factor * 100.0);
        if (!value) return tl::unexpected(value.error());
        spectra.back().push_back(*value);
        most = std::max(most, *value);
      }
    }
    if (!settings_.percent && !columns_.percent && most > surely_factor && most <= surely_percent)
      return bad("line " + std::to_string(table_.rows[0][0].line), "reflectance may be percent or a factor",
                 "add a line # reflectance = percent (or factor)");
    const bool percent = settings_.percent.value_or(columns_.percent || most > surely_percent);
    if (most > max_factor * (percent ? 100.0 : 1.0))
      return bad("line " + std::to_string(table_.rows[0][0].line), "a reflectance is out of range", "check the unit");
    for (std::size_t k = 0; k < angles_.size(); ++k) {
      for (double& value : spectra[k]) value *= percent ? 0.01 : 1.0;
      capture.angles.push_back(
          {angles_[k].light_deg, angles_[k].aspecular_deg, lab_from_reflectance(columns_.nm, spectra[k])});
    }
    return {};
  }

  std::filesystem::path path_;
  CsvTable table_;
  Settings settings_;
  Columns columns_;
  std::vector<core::MeasuringAngle> angles_;
};

}  // namespace

Result<Capture> read_angle_table(const std::filesystem::path& file) {
  auto table = read_csv(file);
  if (!table) return tl::unexpected(table.error());
  return Reader(file, std::move(*table)).read();
}

Result<Capture> parse_angle_table(std::string_view text, const std::filesystem::path& file) {
  auto table = parse_csv(text, file.string());
  if (!table) return tl::unexpected(table.error());
  return Reader(file, std::move(*table)).read();
}

}  // namespace lackwerk::packs
