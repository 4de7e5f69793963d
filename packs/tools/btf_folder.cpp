#include "packs/tools/btf_folder.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/colour.hpp"
#include "packs/tools/node_geometry.hpp"
#include "packs/tools/paint_fields.hpp"
#include "packs/tools/picture_file.hpp"

namespace lackwerk::packs {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_files = 4096;
constexpr int max_table = 256;
constexpr float max_half = 65504.0f;
/// Names are written with one decimal, so they are up to 0.05 degrees off; twice that and a little.
constexpr double same_node_deg = 0.12;
constexpr double deg_per_rad = 180.0 / std::numbers::pi;

/// What paint.toml says.
struct BtfDescription {
  Capture capture;
  std::string table;            ///< file name of BRDFcolors; empty: none
  std::string folder;           ///< of the pictures, relative
  double to_radiance = 1.0;     ///< scale, and pi where the unit is brdf
  double name_unit_deg = 1.0;   ///< degrees per unit of a name
  bool outside = false;         ///< angles before the light enters the coat
  std::optional<bool> is_srgb;  ///< how whole numbers are coded; absent: not said
};

struct Picture {
  fs::path file;
  double theta_h_deg = 0.0, theta_i_deg = 0.0;  ///< inside the coat
  bool used = false;
};

std::string node_name(double theta_h_deg, double theta_i_deg) {
  char text[64];
  std::snprintf(text, sizeof text, "th%04.1f_ti%04.1f", theta_h_deg, theta_i_deg);
  return text;
}

void read_flake_fields(Fields& fields, BtfDescription& out) {
  Capture& capture = out.capture;
  out.folder = read_file_name(fields, "BTFflakes");
  if (fields.has("edge_texels"))
    capture.edge_texels = static_cast<std::uint32_t>(fields.whole("edge_texels", 1, max_slice_edge));
  capture.texel_mm = static_cast<float>(fields.number("texel_mm", 1e-6, 10.0));
  capture.layout = read_layout_fields(fields);
  if (fields.has("life_theta_h_deg") || fields.has("life_theta_i_deg"))
    capture.life =
        MeasuredLife{fields.number("life_theta_h_deg", 0.1, 90.0), fields.number("life_theta_i_deg", 0.1, 90.0)};
  out.to_radiance = fields.number_or("scale", 1.0, 1e-6, 1e6);
  if (read_word(fields, "unit", {"radiance_factor", "brdf"}, true) == 1) out.to_radiance *= std::numbers::pi;
  if (read_word(fields, "angle_unit", {"deg", "rad"}, false) == 1) out.name_unit_deg = deg_per_rad;
  out.outside = read_word(fields, "angles", {"inside", "outside"}, false) == 1;
  if (fields.has("encoding")) out.is_srgb = read_word(fields, "encoding", {"linear", "srgb"}, true) == 1;
}

Result<BtfDescription> read_description(const fs::path& file) {
  auto document = parse_toml(file);
  if (!document) return tl::unexpected(document.error());
  FirstError first{file.string(), std::nullopt};
  BtfDescription out;
  Fields fields(first, *document, "",
                {"format", "name", "source", "IOR", "cc_no_refraction", "refraction_IOR", "CT_diffuse", "CT_coeffs",
                 "CT_F0s", "CT_spreads", "BRDFcolors", "provenance", "flakes"});
  if (fields.whole("format", 0, 1000000) != 1)
    fields.wrong("format", "is a version this program does not know", "write format = 1");
  read_identity_fields(fields, out.capture.identity, out.capture.analytic);
  read_lobe_fields(fields, out.capture.analytic);
  if (fields.has("BRDFcolors")) out.table = read_file_name(fields, "BRDFcolors");
  auto flakes = fields.table(
      "flakes", {"BTFflakes", "edge_texels", "texel_mm", "num_thetaF", "num_thetaI", "max_thetaI", "thetaFI_sliceLUT",
                 "life_theta_h_deg", "life_theta_i_deg", "unit", "angle_unit", "angles", "scale", "encoding"});
  if (flakes) read_flake_fields(*flakes, out);
  if (first.error) return tl::unexpected(*first.error);
  return out;
}

// ---- pictures

/// A square picture of `edge` pixels (0: of 2 to `most`), linear, times `scale`.
Result<std::vector<glm::vec3>> read_square(const fs::path& file, std::uint32_t edge, std::uint32_t most, double scale,
                                           std::optional<bool> is_srgb) {
  const std::string name = file.string();
  const auto limit = static_cast<int>(edge == 0 ? most : edge);
  const PictureLimits limits{limit,
                             limit,
                             std::size_t{most} * most,
                             3,
                             "all pictures are squares of one size, at most 4096",
                             "copy or export it again"};
  if (!fs::exists(file)) return fail(name, "", "is missing", "export it again");
  Result<PictureFile> picture = [&]() -> Result<PictureFile> {
    try {
      return read_picture(file, limits);
    } catch (const std::exception& error) {  // plug-ins of the picture library may throw
      return fail(name, "", std::string("cannot be read: ") + error.what(), "export it again");
    }
  }();
  if (!picture) return tl::unexpected(picture.error());
  const std::string size = std::to_string(picture->width) + " x " + std::to_string(picture->height);
  if (picture->width != picture->height) return fail(name, "size", "is " + size, "export square pictures");
  if (edge != 0 && picture->width != static_cast<int>(edge))
    return fail(name, "size", "is " + size + ", not " + std::to_string(edge), "all pictures have one size");
  if (picture->channels != 3)
    return fail(name, "channels", "are " + std::to_string(picture->channels), "export R, G, B only");
  if (!picture->is_linear && !is_srgb)
    return fail(name, "encoding", "whole numbers may be linear or sRGB", "say flakes.encoding in paint.toml");
  const bool decode = !picture->is_linear && *is_srgb;
  std::vector<glm::vec3> out(picture->values.size() / 3);
  for (std::size_t k = 0; k < picture->values.size(); ++k) {
    const auto value = static_cast<double>(picture->values[k]);
    const auto texel = static_cast<float>((decode ? core::srgb_decode(value) : value) * scale);
    if (texel >= 0.0f && texel <= max_half) {
      out[k / 3][static_cast<int>(k % 3)] = texel;
      continue;
    }
    const auto width = static_cast<std::size_t>(picture->width);
    return fail(name,
                "texel " + std::to_string(k / 3 % width) + "," + std::to_string(k / 3 / width) + " channel " +
                    std::to_string(k % 3),
                !std::isfinite(texel) ? "is not a finite number"
                : texel < 0.0f        ? "is negative"
                                      : "is too bright",
                "texels are 0 to 65504 as radiance factors");
  }
  return out;
}

/// Angles that the light has once it is inside the coat.
Picture bent_inside(const Picture& outside, double index) {
  core::PaintModel<double> model;
  const NodeGeometry node = node_geometry(outside.theta_h_deg / deg_per_rad, outside.theta_i_deg / deg_per_rad);
  const glm::dvec3 normal(0.0, 0.0, 1.0);
  const auto g = model.paint_geometry(normal, model.refract_into(node.light, normal, index),
                                      model.refract_into(node.eye, normal, index));
  return {outside.file, g.theta_h * deg_per_rad, g.theta_i * deg_per_rad, false};
}

Result<std::vector<Picture>> list_pictures(const fs::path& folder, const BtfDescription& btf, ImportNotes* notes) {
  std::vector<Picture> out;
  std::vector<std::string> strangers;
  std::error_code code;
  fs::directory_iterator entries(folder, code);
  if (code) return fail(folder.string(), "", "cannot be read: " + code.message(), "check flakes.BTFflakes");
  std::size_t seen = 0;
  for (; entries != fs::directory_iterator(); entries.increment(code)) {
    if (code || ++seen > max_files)
      return fail(folder.string(), "", "holds more than 4096 files", "keep one paint's pictures in a folder");
    if (!entries->is_regular_file(code)) continue;
    const fs::path file = entries->path();
    const std::string name = file.filename().string();
    const auto angles = angles_of_name(file.stem().string());
    if (!angles) {
      if (name != "paint.toml" && name != btf.table) strangers.push_back(name);
      continue;
    }
    Picture picture{file, angles->theta_h * btf.name_unit_deg, angles->theta_i * btf.name_unit_deg, false};
    if (picture.theta_h_deg > 90.0 || picture.theta_i_deg > 90.0)
      return fail(file.string(), "name", "has an angle above 90 degrees", "check flakes.angle_unit");
    out.push_back(btf.outside ? bent_inside(picture, btf.capture.analytic.refraction_ior) : picture);
  }
  std::sort(out.begin(), out.end(), [](const Picture& a, const Picture& b) { return a.file < b.file; });
  std::sort(strangers.begin(), strangers.end());
  if (notes != nullptr && !strangers.empty())
    notes->push_back(std::to_string(strangers.size()) + " other files in the folder were not read, " + strangers[0] +
                     " among them");
  return out;
}

/// The picture of each slice.
Result<std::vector<std::size_t>> assign(const BtfDescription& btf, const fs::path& folder,
                                        std::vector<Picture>& pictures, ImportNotes* notes) {
  const core::SliceLayout& layout = btf.capture.layout;
  const double width_deg = layout.bin_width_rad() * deg_per_rad;
  std::vector<std::size_t> out;
  int beyond = 0;
  double farthest = 0.0;
  for (int slice = 0; slice < layout.slice_count(); ++slice) {
    const auto node = layout.node_of(slice);
    const double h = node.bin_h * width_deg, i = node.bin_i * width_deg;
    std::size_t best = pictures.size();
    double best_deg = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < pictures.size(); ++k) {
      const double away = std::hypot(pictures[k].theta_h_deg - h, pictures[k].theta_i_deg - i);
      if (away < best_deg) best = k, best_deg = away;
    }
    const bool reachable = !btf.outside || core::reachable_below_coat(h / deg_per_rad, i / deg_per_rad,
                                                                      btf.capture.analytic.refraction_ior);
    const double allowed = btf.outside ? 0.5 * width_deg * std::numbers::sqrt2 : same_node_deg;
    if (best == pictures.size() || (reachable && best_deg > allowed))
      return fail(folder.string(), node_name(h, i), "the picture of slice " + std::to_string(slice) + " is missing",
                  "add it, with its angles as its name, or shorten thetaFI_sliceLUT");
    if (!reachable && best_deg > allowed) ++beyond;
    farthest = std::max(farthest, best_deg);
    pictures[best].used = true;
    out.push_back(best);
  }
  for (const Picture& picture : pictures) {
    if (picture.used || btf.outside) continue;
    return fail(
        picture.file.string(), "name", "belongs to no slice, or is there twice",
        "its angles must be a node of thetaFI_sliceLUT, multiples of " + std::to_string(width_deg) + " degrees");
  }
  if (notes != nullptr && btf.outside) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "angles were bent into the coat: pictures lie up to %.1f degrees from their nodes; %d nodes that no "
                  "light reaches got the nearest picture",
                  farthest, beyond);
    notes->emplace_back(text);
    const auto unused = std::count_if(pictures.begin(), pictures.end(), [](const Picture& p) { return !p.used; });
    if (unused > 0) notes->push_back(std::to_string(unused) + " pictures are nearest to no node and were not read");
  }
  return out;
}

Result<void> read_slices(const BtfDescription& btf, const std::vector<Picture>& pictures,
                         const std::vector<std::size_t>& of_slice, Capture& capture) {
  for (const std::size_t k : of_slice) {
    const bool first = capture.slices.empty();
    auto texels = read_square(pictures[k].file, capture.edge_texels, max_slice_edge, btf.to_radiance, btf.is_srgb);
    if (!texels) return tl::unexpected(texels.error());
    if (first) {
      const std::uint64_t all = std::uint64_t{texels->size()} * of_slice.size();
      if (all > max_slice_texels)
        return fail(pictures[k].file.string(), "size", "all slices together have more than 2^27 texels",
                    "export smaller pictures");
      capture.edge_texels = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(texels->size()))));
    }
    capture.slices.push_back({std::move(*texels)});
  }
  return {};
}

/// Digits with at most one point among them, at the start of `text`, which is shortened by them.
std::optional<double> take_number(std::string_view& text) {
  std::size_t length = 0;
  while (length < text.size() && length < 16 && ((text[length] >= '0' && text[length] <= '9') || text[length] == '.'))
    ++length;
  double value = 0.0;
  const auto [stop, code] = std::from_chars(text.data(), text.data() + length, value, std::chars_format::fixed);
  if (length == 0 || code != std::errc() || stop != text.data() + length) return std::nullopt;
  text.remove_prefix(length);
  return value;
}

}  // namespace

std::optional<NamedAngles> angles_of_name(std::string_view stem) {
  if (!stem.starts_with("th")) return std::nullopt;
  stem.remove_prefix(2);
  const auto theta_h = take_number(stem);
  if (!theta_h || !stem.starts_with("_ti")) return std::nullopt;
  stem.remove_prefix(3);
  const auto theta_i = take_number(stem);
  if (!theta_i || !stem.empty()) return std::nullopt;
  return NamedAngles{*theta_h, *theta_i};
}

Result<Capture> import_btf_folder(const fs::path& folder, ImportNotes* notes) {
  auto btf = read_description(folder / "paint.toml");
  if (!btf) return tl::unexpected(btf.error());
  Capture capture = btf->capture;
  if (!btf->table.empty()) {
    auto table = read_square(folder / btf->table, 0, max_table, 1.0, std::nullopt);
    if (!table) return tl::unexpected(table.error());
    const auto nodes = static_cast<std::uint16_t>(std::lround(std::sqrt(static_cast<double>(table->size()))));
    if (nodes < 2) return fail((folder / btf->table).string(), "size", "is 1 x 1", "a colour table has 2 to 256 nodes");
    capture.analytic.table = core::ColourTable{nodes, std::move(*table)};
  }
  if (capture.layout.slice_count() == 0) return capture;
  const fs::path pictures_folder = folder / btf->folder;
  auto pictures = list_pictures(pictures_folder, *btf, notes);
  if (!pictures) return tl::unexpected(pictures.error());
  const auto of_slice = assign(*btf, pictures_folder, *pictures, notes);
  if (!of_slice) return tl::unexpected(of_slice.error());
  if (auto ok = read_slices(*btf, *pictures, *of_slice, capture); !ok) return tl::unexpected(ok.error());
  return capture;
}

}  // namespace lackwerk::packs
