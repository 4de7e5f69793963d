#include "packs/tools/capture_measured.hpp"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>

#include "packs/tools/csv_table.hpp"

namespace lackwerk::packs {
namespace {

constexpr float highest = 1e9f;  ///< 1/sr; the sharpest mirror lobe (roughness 1e-3) reaches 1e5
constexpr glm::vec3 hole(-1.0f);
constexpr const char* again = "import the measurement again";

Result<void> check_value(const glm::vec3& value, std::size_t at, std::size_t width, const std::string& file) {
  for (int channel = 0; channel < 3; ++channel) {
    if (value[channel] >= 0.0f && value[channel] <= highest) continue;
    return fail(file,
                "pixel " + std::to_string(at % width) + "," + std::to_string(at / width) + " channel " +
                    std::to_string(channel),
                !std::isfinite(value[channel]) ? "is not a finite number"
                : value[channel] < 0.0f        ? "is negative"
                                               : "is beyond 1e9",
                again);
  }
  return {};
}

Result<std::vector<glm::vec3>> read_pixels(const std::filesystem::path& file, const core::BrdfTableSize& size) {
  const std::string name = file.string();
  try {
    if (!std::filesystem::exists(file)) return fail(name, "", "is missing", again);
    auto image = OIIO::ImageInput::create("exr");
    OIIO::ImageSpec spec;
    if (!image || !image->open(name, spec))
      return fail(name, "", "cannot be opened: " + (image ? image->geterror() : OIIO::geterror()), again);
    if (spec.channelnames != std::vector<std::string>{"R", "G", "B"})
      return fail(name, "channels", "are not R, G, B", again);
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
        spec.height != spec.full_height)
      return fail(name, "dataWindow", "differs from displayWindow", again);
    if (spec.depth > 1 || spec.deep || spec.width < 1 || spec.height < 1 ||
        static_cast<std::uint64_t>(spec.width) != size.phi_d ||
        static_cast<std::uint64_t>(spec.height) != std::uint64_t{size.theta_h} * size.theta_d)
      return fail(name, "size", "is " + std::to_string(spec.width) + " x " + std::to_string(spec.height),
                  "paint.toml says num_phi_d x (num_theta_h * num_theta_d)");
    std::vector<glm::vec3> pixels(size.cells());
    if (!image->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, pixels.data()))
      return fail(name, "", "is damaged: " + image->geterror(), again);
    return pixels;
  } catch (const std::exception& error) {
    return fail(name, "", std::string("cannot be read: ") + error.what(), again);
  }
}

// ---- angles.csv

constexpr std::size_t most_readings = 1000;  ///< csv_table.hpp reads 1024 rows

struct Column {
  const char* name;
  double least, most;
};
constexpr double highest_lab = 1e5;  ///< a mirror's radiance factor may be thousands of times white's
constexpr std::array columns{Column{"light_deg", 0.0, 89.99}, Column{"aspecular_deg", -180.0, 180.0},
                             Column{"L", 0.0, highest_lab}, Column{"a", -highest_lab, highest_lab},
                             Column{"b", -highest_lab, highest_lab}};
using Row = std::array<double, columns.size()>;

Row row_of(const AngleReading& reading) {
  return {reading.light_deg, reading.aspecular_deg, reading.lab.x, reading.lab.y, reading.lab.z};
}

/// The column that is out of range, or null.
const Column* wrong_column(const Row& row) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (!(row[k] >= columns[k].least && row[k] <= columns[k].most)) return &columns[k];
  }
  return nullptr;
}

std::string line_text(const Row& row) {
  std::string line;
  for (const double value : row) {
    char text[40];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    if (!line.empty()) line += ',';
    line.append(text, end);
  }
  return line;
}

}  // namespace

Result<core::BrdfTable> read_brdf_image(const std::filesystem::path& file, const core::BrdfTableSize& size) {
  const auto pixels = read_pixels(file, size);
  if (!pixels) return tl::unexpected(pixels.error());
  core::BrdfTable table(size);
  std::size_t known = 0;
  for (std::size_t cell = 0; cell < pixels->size(); ++cell) {
    const glm::vec3& value = (*pixels)[cell];
    if (value == hole) continue;
    if (auto ok = check_value(value, cell, size.phi_d, file.string()); !ok) return tl::unexpected(ok.error());
    table.set(cell, value);
    ++known;
  }
  if (known == 0) return fail(file.string(), "", "holds nothing but holes", again);
  return table;
}

Result<void> write_brdf_image(const core::BrdfTable& table, const std::filesystem::path& file) {
  const core::BrdfTableSize& size = table.size();
  std::vector<glm::vec3> pixels;
  pixels.reserve(size.cells());
  for (std::size_t cell = 0; cell < size.cells(); ++cell) {
    pixels.push_back(table.value(cell).value_or(hole));
    if (pixels.back() == hole) continue;
    if (auto ok = check_value(pixels.back(), cell, size.phi_d, file.string()); !ok) return ok;
  }
  try {
    auto image = OIIO::ImageOutput::create("exr");
    OIIO::ImageSpec spec(static_cast<int>(size.phi_d), static_cast<int>(size.theta_h * size.theta_d), 3,
                         OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    std::string trouble = image ? "" : OIIO::geterror();
    if (image && (!image->open(file.string(), spec) || !image->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) ||
                  !image->close()))
      trouble = image->geterror();
    if (trouble.empty()) return {};
    return fail(file.string(), "", "cannot be written: " + trouble, "check the folder, its permissions and free space");
  } catch (const std::exception& error) {
    return fail(file.string(), "", std::string("cannot be written: ") + error.what(), "check the folder");
  }
}

Result<std::vector<AngleReading>> read_readings(const std::filesystem::path& file) {
  const auto table = read_csv(file);
  if (!table) return tl::unexpected(table.error());
  const std::string name = file.string();
  const auto& header = table->rows.front();
  const bool same = std::equal(header.begin(), header.end(), columns.begin(), columns.end(),
                               [](const CsvCell& cell, const Column& column) { return cell.text == column.name; });
  if (!same) return fail(name, "line 1", "has other columns", "write light_deg,aspecular_deg,L,a,b");
  std::vector<AngleReading> out;
  for (std::size_t at = 1; at < table->rows.size(); ++at) {
    Row row{};
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const CsvCell& cell = table->rows[at][k];
      const auto number = csv_number(cell.text, table->decimal_comma);
      if (!number)
        return fail(name, "line " + std::to_string(cell.line) + ", " + columns[k].name, "is not a number", again);
      row[k] = *number;
    }
    if (const Column* wrong = wrong_column(row))
      return fail(name, "line " + std::to_string(table->rows[at][0].line) + ", " + wrong->name, "is out of range",
                  again);
    out.push_back({row[0], row[1], {row[2], row[3], row[4]}});
  }
  if (out.empty()) return fail(name, "", "holds no readings", again);
  return out;
}

Result<void> write_readings(const std::vector<AngleReading>& readings, const std::filesystem::path& file) {
  if (readings.size() > most_readings)
    return fail(file.string(), "", "has " + std::to_string(readings.size()) + " readings", "keep at most 1000");
  std::ofstream stream(file, std::ios::binary);
  for (const Column& column : columns) stream << (&column == columns.data() ? "" : ",") << column.name;
  stream << '\n';
  for (const AngleReading& reading : readings) {
    const Row row = row_of(reading);
    if (const Column* wrong = wrong_column(row))
      return fail(file.string(), wrong->name, "is out of range", "check the reading");
    stream << line_text(row) << '\n';
  }
  stream.close();
  if (!stream) return fail(file.string(), "", "cannot be written", "check permissions and free space");
  return {};
}

}  // namespace lackwerk::packs
