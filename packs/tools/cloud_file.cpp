#include "packs/tools/cloud_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>
#include <type_traits>

#include "packs/tools/whole_file.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::uintmax_t max_bytes = std::uintmax_t{1} << 30;
constexpr std::size_t max_points = 8'000'000;  // twenty times the largest scan of Golla 2021
constexpr double max_far = 1e9;  // in any unit a plant is nearer; squares of differences stay exact enough
constexpr std::size_t max_properties = 64;
constexpr const char* remedy = "export the scan again, as xyz or PLY";

std::optional<double> number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);  // one sign
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<std::int32_t> whole(double value) {
  if (!(std::abs(value) <= 2147483647.0) || value != std::floor(value)) return std::nullopt;
  return static_cast<std::int32_t>(value);
}

/// Takes a line off `rest`, without its end.
std::string_view take_line(std::string_view& rest) {
  const std::size_t end = std::min(rest.find('\n'), rest.size());
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// The words of a line, at most `most` of them.
std::vector<std::string_view> words_of(std::string_view line, std::size_t most) {
  constexpr std::string_view between = " \t,;";
  std::vector<std::string_view> out;
  while (out.size() < most) {
    line.remove_prefix(std::min(line.find_first_not_of(between), line.size()));
    if (line.empty()) break;
    const std::size_t end = std::min(line.find_first_of(between), line.size());
    out.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return out;
}

/// What is wrong with a coordinate, or nothing.
const char* fault_of(const std::optional<double>& value) {
  if (!value) return "is no number";
  if (!std::isfinite(*value)) return "is not finite";
  return std::abs(*value) > max_far ? "is larger than 1e9" : nullptr;
}

Result<core::PointCloud> read_xyz(const std::string& file, std::string_view rest) {
  core::PointCloud cloud;
  bool labelled = true;
  for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
    const auto words = words_of(take_line(rest), 4);
    if (words.empty() || words[0].starts_with('#') || words[0].starts_with("//")) continue;
    const std::string field = "line " + std::to_string(line_number);
    if (words.size() < 3) return fail(file, field, "has fewer than three numbers", remedy);
    if (cloud.points.size() == max_points) return fail(file, field, "is past the 8 millionth point", "thin the scan");
    glm::dvec3 point(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = number(words[static_cast<std::size_t>(axis)]);
      if (const char* fault = fault_of(value))
        return fail(file, field, std::string("column ") + "xyz"[axis] + " " + fault, remedy);
      point[axis] = *value;
    }
    cloud.points.push_back(point);
    const auto fourth = words.size() == 4 ? number(words[3]) : std::nullopt;
    const auto label = fourth ? whole(*fourth) : std::nullopt;
    labelled = labelled && label.has_value();
    if (labelled) cloud.labels.push_back(*label);
  }
  if (!labelled) cloud.labels.clear();
  if (cloud.points.empty()) return fail(file, "", "has no points", remedy);
  return cloud;
}

enum class Scalar { i8, u8, i16, u16, i32, u32, f32, f64 };

std::optional<Scalar> scalar_named(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, Scalar>, 16> names{{{"char", Scalar::i8},
                                                                       {"int8", Scalar::i8},
                                                                       {"uchar", Scalar::u8},
                                                                       {"uint8", Scalar::u8},
                                                                       {"short", Scalar::i16},
                                                                       {"int16", Scalar::i16},
                                                                       {"ushort", Scalar::u16},
                                                                       {"uint16", Scalar::u16},
                                                                       {"int", Scalar::i32},
                                                                       {"int32", Scalar::i32},
                                                                       {"uint", Scalar::u32},
                                                                       {"uint32", Scalar::u32},
                                                                       {"float", Scalar::f32},
                                                                       {"float32", Scalar::f32},
                                                                       {"double", Scalar::f64},
                                                                       {"float64", Scalar::f64}}};
  for (const auto& [known, scalar] : names)
    if (known == name) return scalar;
  return std::nullopt;
}

std::size_t bytes_of(Scalar scalar) {
  constexpr std::array<std::size_t, 8> bytes{1, 1, 2, 2, 4, 4, 4, 8};
  return bytes[static_cast<std::size_t>(scalar)];
}

template <class T>
double load_as(const char* at, bool big) {
  std::array<char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), at, sizeof(T));
  if (big != (std::endian::native == std::endian::big)) std::reverse(bytes.begin(), bytes.end());
  return static_cast<double>(std::bit_cast<T>(bytes));
}

double load(Scalar scalar, const char* at, bool big) {
  switch (scalar) {
    case Scalar::i8:
      return load_as<std::int8_t>(at, big);
    case Scalar::u8:
      return load_as<std::uint8_t>(at, big);
    case Scalar::i16:
      return load_as<std::int16_t>(at, big);
    case Scalar::u16:
      return load_as<std::uint16_t>(at, big);
    case Scalar::i32:
      return load_as<std::int32_t>(at, big);
    case Scalar::u32:
      return load_as<std::uint32_t>(at, big);
    case Scalar::f32:
      return load_as<float>(at, big);
    case Scalar::f64:
      return load_as<double>(at, big);
  }
  return 0.0;
}

struct Property {
  std::string_view name;
  Scalar scalar = Scalar::f32;
};
enum class PlyFormat { ascii, little, big };
struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::size_t vertices = 0;
  std::vector<Property> properties;
  std::size_t lines = 0;  ///< of the header
};

tl::unexpected<Error> header_fault(const std::string& file, std::size_t line, const char* what) {
  return fail(file, "line " + std::to_string(line), what, remedy);
}

/// Leaves `rest` at the first vertex.
Result<PlyHeader> read_header(const std::string& file, std::string_view& rest) {
  PlyHeader header;
  bool has_format = false;
  bool in_vertices = false;
  bool has_vertices = false;
  while (!rest.empty()) {
    const auto words = words_of(take_line(rest), 5);
    ++header.lines;
    if (header.lines > 1024) return header_fault(file, header.lines, "is past the longest header read");
    if (header.lines == 1) {
      if (words.size() != 1 || words[0] != "ply") return header_fault(file, 1, "is not \"ply\"");
      continue;
    }
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") {
      if (!has_format) return header_fault(file, header.lines, "ends a header without a format");
      if (!has_vertices) return header_fault(file, header.lines, "ends a header without vertices");
      return header;
    }
    if (words[0] == "format" && words.size() == 3) {
      has_format = true;
      if (words[1] == "ascii")
        header.format = PlyFormat::ascii;
      else if (words[1] == "binary_little_endian")
        header.format = PlyFormat::little;
      else if (words[1] == "binary_big_endian")
        header.format = PlyFormat::big;
      else
        return header_fault(file, header.lines, "names an unknown format");
    } else if (words[0] == "element" && words.size() == 3) {
      in_vertices = words[1] == "vertex";
      if (!in_vertices && !has_vertices) return header_fault(file, header.lines, "has an element before the vertices");
      if (!in_vertices) continue;
      if (has_vertices) return header_fault(file, header.lines, "names vertices again");
      has_vertices = true;
      const auto [end, code] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), header.vertices);
      if (code != std::errc{} || end != words[2].data() + words[2].size() || header.vertices == 0)
        return header_fault(file, header.lines, "has no number of vertices");
      if (header.vertices > max_points) return header_fault(file, header.lines, "names more than 8 million vertices");
    } else if (words[0] == "property" && words.size() >= 3) {
      if (!in_vertices) continue;
      const auto scalar = scalar_named(words[1]);
      if (!scalar) return header_fault(file, header.lines, "has a property of a type that is not read");
      if (header.properties.size() == max_properties)
        return header_fault(file, header.lines, "has too many properties");
      header.properties.push_back({words[2], *scalar});
    } else {
      return header_fault(file, header.lines, "is no line of a PLY header");
    }
  }
  return fail(file, "end_header", "is missing", remedy);
}

Result<core::PointCloud> read_ply(const std::string& file, std::string_view rest) {
  const auto header = read_header(file, rest);
  if (!header) return tl::unexpected(header.error());
  constexpr std::size_t none = max_properties;
  std::array<std::size_t, 4> place{none, none, none, none};  // x, y, z, label
  std::vector<std::size_t> offset;
  std::size_t stride = 0;
  for (std::size_t k = 0; k < header->properties.size(); ++k) {
    const std::string_view name = header->properties[k].name;
    if (name == "x") place[0] = k;
    if (name == "y") place[1] = k;
    if (name == "z") place[2] = k;
    if (name == "label" || name == "segment" || name == "class" || name == "scalar_Label") place[3] = k;
    offset.push_back(stride);
    stride += bytes_of(header->properties[k].scalar);
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (place[axis] == none) return fail(file, std::string("property ") + "xyz"[axis], "is missing", remedy);
  const bool text = header->format == PlyFormat::ascii;
  const std::size_t least = text ? 2 * header->properties.size() - 1 : stride;  // a digit and a blank each
  if (rest.size() / least < header->vertices && !(text && (rest.size() + 1) / (least + 1) >= header->vertices))
    return fail(file, "vertex", "the file ends before its " + std::to_string(header->vertices) + " vertices do",
                "copy or download it again");

  core::PointCloud cloud;
  cloud.points.reserve(header->vertices);
  const bool labelled = place[3] != none;
  for (std::size_t v = 0; v < header->vertices; ++v) {
    std::vector<std::string_view> words;
    if (text) {
      words = words_of(take_line(rest), header->properties.size());
      if (words.size() < header->properties.size())
        return fail(file, "line " + std::to_string(header->lines + v + 1), "has fewer numbers than properties", remedy);
    }
    const auto value = [&](std::size_t k) -> std::optional<double> {
      if (text) return number(words[k]);
      return load(header->properties[k].scalar, rest.data() + v * stride + offset[k], header->format == PlyFormat::big);
    };
    glm::dvec3 point(0.0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto coordinate = value(place[axis]);
      if (const char* fault = fault_of(coordinate))
        return fail(file, "vertex " + std::to_string(v) + ", " + "xyz"[axis], fault, remedy);
      point[static_cast<int>(axis)] = *coordinate;
    }
    cloud.points.push_back(point);
    if (!labelled) continue;
    const auto given = value(place[3]);
    const auto label = given ? whole(*given) : std::nullopt;
    if (!label) return fail(file, "vertex " + std::to_string(v) + ", label", "is no whole number", remedy);
    cloud.labels.push_back(*label);
  }
  return cloud;
}

}  // namespace

Result<core::PointCloud> read_cloud(const std::filesystem::path& path) {
  const auto bytes = read_whole_file(path, max_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse_cloud(*bytes, path);
}

Result<core::PointCloud> parse_cloud(std::span<const std::uint8_t> bytes, const std::filesystem::path& path) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string extension = path.extension().string();
  if (extension == ".ply") return read_ply(path.string(), text);
  if (extension == ".xyz" || extension == ".txt" || extension == ".asc") return read_xyz(path.string(), text);
  return fail(path.string(), "", "is neither .ply nor .xyz", remedy);
}

}  // namespace lackwerk::packs
