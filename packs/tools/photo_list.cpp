#include "packs/tools/photo_list.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "packs/tools/node_geometry.hpp"
#include "packs/tools/paint_fields.hpp"

namespace lackwerk::packs {
namespace {

constexpr double radians = std::numbers::pi / 180.0;
constexpr std::size_t max_photos = 512;
/// Light or camera lower than this see too little of the panel, and the coat's losses change by the degree.
constexpr double lowest_deg = 80.0;
constexpr double most_px = 16384.0;

/// The cosine outside of a direction inside a coat (Snell); nothing beyond the critical angle.
std::optional<double> cosine_outside(double cos_inside, double index) {
  const double sine2 = index * index * (1.0 - cos_inside * cos_inside);
  if (sine2 >= 1.0) return std::nullopt;
  return std::sqrt(1.0 - sine2);
}

void read_slice_angles(Fields& fields, double index, PanelPhoto& photo) {
  photo.theta_h_deg = fields.number("theta_h_deg", 0.0, 90.0);
  photo.theta_i_deg = fields.number("theta_i_deg", 0.0, 90.0);
  const NodeGeometry node = node_geometry(photo.theta_h_deg * radians, photo.theta_i_deg * radians);
  const auto light = cosine_outside(node.light.z, index);
  if (!light || *light < std::cos(lowest_deg * radians))
    return fields.wrong("theta_h_deg", "light comes there from below 80 degrees outside the coat, or not at all",
                        "check the angles: they are those inside the coat");
  photo.cos_light = photo.cos_camera = *light;
}

void read_directions(Fields& fields, double index, PanelPhoto& photo) {
  const double light = fields.number("light_deg", 0.0, lowest_deg) * radians;
  const double camera = fields.number("camera_deg", -lowest_deg, lowest_deg) * radians;
  const double azimuth = fields.number_or("azimuth_deg", 180.0, 0.0, 180.0) * radians;
  const glm::dvec3 normal(0.0, 0.0, 1.0);
  const glm::dvec3 in(std::sin(light), 0.0, std::cos(light));
  const glm::dvec3 out(std::sin(camera) * std::cos(azimuth), std::sin(camera) * std::sin(azimuth), std::cos(camera));
  core::PaintModel<double> model;
  const auto g =
      model.paint_geometry(normal, model.refract_into(in, normal, index), model.refract_into(out, normal, index));
  photo.theta_h_deg = g.theta_h / radians;
  photo.theta_i_deg = g.theta_i / radians;
  photo.cos_light = in.z;
  photo.cos_camera = out.z;
}

void read_corners(Fields& fields, std::optional<double> mm_per_pixel, glm::dvec2& panel_mm, PanelPhoto& photo) {
  if (fields.has("crop_px")) {
    const auto crop = fields.numbers("crop_px", 0.0, most_px, 4);
    if (crop.size() != 4) return fields.wrong("crop_px", "must be four numbers", "write [left, top, width, height]");
    const glm::dvec2 a(crop[0], crop[1]), b = a + glm::dvec2(crop[2], crop[3]);
    photo.corners_px = {a, glm::dvec2(b.x, a.y), b, glm::dvec2(a.x, b.y)};
    if (!mm_per_pixel) return;
    const glm::dvec2 size = glm::dvec2(crop[2], crop[3]) * *mm_per_pixel;
    if (panel_mm.x == 0.0) panel_mm = size;
    constexpr double same = 0.01;  // a pixel or two of a thousand
    if (std::abs(size.x - panel_mm.x) > same * panel_mm.x || std::abs(size.y - panel_mm.y) > same * panel_mm.y)
      fields.wrong("crop_px", "shows another size of the panel than the others", "crop the same part of the panel");
    return;
  }
  const auto list = fields.numbers("corners_px", -most_px, 2.0 * most_px, 8);
  if (list.size() != 8)
    return fields.wrong("corners_px", "must be eight numbers",
                        "write x, y of top left, top right, bottom right, bottom left");
  for (std::size_t k = 0; k < 4; ++k) photo.corners_px[k] = {list[2 * k], list[2 * k + 1]};
}

void read_camera(Fields& fields, PhotoList& list) {
  using Kind = CameraResponse::Kind;
  const std::vector<std::string> words{"linear", "srgb", "gamma", "table"};
  list.response.kind =
      std::vector<Kind>{Kind::linear, Kind::srgb, Kind::gamma, Kind::table}[read_word(fields, "response", words, true)];
  if (list.response.kind == Kind::gamma) list.response.gamma = fields.number("gamma", 0.2, 5.0);
  if (list.response.kind == Kind::table) {
    const auto number = fields.numbers("table_number", 0.0, 1.0, 4096);
    const auto light = fields.numbers("table_light", 0.0, 1e6, 4096);
    if (number.size() < 2 || number.size() != light.size())
      return fields.wrong("table_number", "needs two or more points, as many as table_light", "");
    for (std::size_t k = 0; k < number.size(); ++k) {
      if (k > 0 && (number[k] <= number[k - 1] || light[k] < light[k - 1]))
        return fields.wrong("table_number", "does not rise", "list the points from dark to bright");
      list.response.points.emplace_back(number[k], light[k]);
    }
  }
  list.response.saturation = fields.number_or("saturation", list.response.saturation, 0.1, 1.0);
  if (fields.has("dark")) list.dark = read_file_name(fields, "dark");
  if (!fields.has("to_linear_srgb")) return;
  const auto rows = fields.rgb_list("to_linear_srgb", -10.0, 10.0, 3);
  if (rows.size() != 3) return fields.wrong("to_linear_srgb", "must be three rows of three numbers", "");
  for (std::size_t k = 0; k < 3; ++k) list.to_srgb[k] = rows[k];
}

WhitePhoto read_white(Fields& fields) {
  WhitePhoto white;
  white.id = fields.has("id") ? fields.text("id") : "";
  white.file = read_file_name(fields, "file");
  if (fields.has("dark")) white.dark = read_file_name(fields, "dark");
  white.exposure_s = fields.number("exposure_s", 1e-6, 1e6);
  white.reflectance = fields.number("reflectance", 0.01, 1.2);
  if (fields.has("light_deg")) white.cos_light = std::cos(fields.number("light_deg", 0.0, lowest_deg) * radians);
  return white;
}

PanelPhoto read_photo(Fields& fields, PhotoList& list, std::optional<double> mm_per_pixel) {
  PanelPhoto photo;
  photo.file = read_file_name(fields, "file");
  photo.place = photo.file;
  if (fields.has("dark")) photo.dark = read_file_name(fields, "dark");
  photo.exposure_s = fields.number("exposure_s", 1e-6, 1e6);
  const double index = list.capture.analytic.refraction_ior;
  if (fields.has("theta_h_deg") || fields.has("theta_i_deg")) {
    read_slice_angles(fields, index, photo);
    if (fields.has("light_deg") || fields.has("camera_deg"))
      fields.wrong("light_deg", "is given beside theta_h_deg", "give theta_h_deg and theta_i_deg, or light and camera");
  } else {
    read_directions(fields, index, photo);
  }
  read_corners(fields, mm_per_pixel, list.panel_mm, photo);
  if (fields.has("white")) {
    const std::string id = fields.text("white");
    const auto at =
        std::find_if(list.whites.begin(), list.whites.end(), [&](const WhitePhoto& w) { return w.id == id; });
    if (at == list.whites.end()) return fields.wrong("white", "no [[white]] has this id", "add it"), photo;
    photo.white = static_cast<std::size_t>(at - list.whites.begin());
  } else if (list.whites.size() != 1) {
    fields.wrong("white", "is missing, and there is not just one [[white]]", "name its id");
  }
  return photo;
}

void read_grid(Fields& fields, PhotoList& list) {
  Capture& capture = list.capture;
  const double least = std::min(list.panel_mm.x, list.panel_mm.y);
  constexpr double rounding = 1e-3;  // texels: 6.4 mm hold 128 of 0.05 mm, whatever 0.05 is in binary
  const double most = std::floor(least / static_cast<double>(capture.texel_mm) + rounding);
  if (!(most >= 1.0)) return fields.wrong("texel_mm", "no texel fits the panel's rectangle", "give smaller texels");
  if (fields.has("edge_texels")) {
    capture.edge_texels = static_cast<std::uint32_t>(fields.whole("edge_texels", 1, max_slice_edge));
    if (capture.edge_texels > most)
      fields.wrong("edge_texels",
                   "the panel's rectangle holds only " + std::to_string(static_cast<int>(most)) + " texels",
                   "give fewer, or smaller ones");
  } else {
    capture.edge_texels = static_cast<std::uint32_t>(std::min(most, double{max_slice_edge}));
  }
  const std::uint64_t texels = std::uint64_t{capture.edge_texels} * capture.edge_texels;
  if (texels * static_cast<std::uint64_t>(capture.layout.slice_count()) > max_slice_texels)
    fields.wrong("texel_mm", "all slices together would have more than 2^27 texels", "give edge_texels");
}

}  // namespace

Result<PhotoList> read_photo_list(const std::filesystem::path& file) {
  auto document = parse_toml(file);
  if (!document) return tl::unexpected(document.error());
  FirstError first{file.string(), std::nullopt};
  PhotoList list;
  Fields fields(first, *document, "",
                {"format",        "name",       "source",      "IOR",        "cc_no_refraction", "refraction_IOR",
                 "provenance",    "texel_mm",   "edge_texels", "panel_mm",   "mm_per_pixel",     "missing",
                 "base_quantile", "num_thetaF", "num_thetaI",  "max_thetaI", "thetaFI_sliceLUT", "camera",
                 "white",         "photo"});
  if (fields.whole("format", 0, 1000000) != 1)
    fields.wrong("format", "is a version this program does not know", "write format = 1");
  read_identity_fields(fields, list.capture.identity, list.capture.analytic);
  list.capture.texel_mm = static_cast<float>(fields.number("texel_mm", 1e-6, 10.0));
  list.capture.layout = fields.has("num_thetaF") ? read_layout_fields(fields) : core::axf_layout();
  if (list.capture.layout.num_theta >= max_layout_theta)
    fields.wrong("num_thetaF", "leaves no node for 90 degrees", "give at most 255");
  list.fill_missing = read_word(fields, "missing", {"nearest", "empty"}, false) == 0;
  list.base_quantile = fields.number_or("base_quantile", list.base_quantile, 0.0, 0.5);
  std::optional<double> mm_per_pixel;
  list.panel_mm = glm::dvec2(0.0);
  if (fields.has("mm_per_pixel")) mm_per_pixel = fields.number("mm_per_pixel", 1e-4, 10.0);
  if (!mm_per_pixel || fields.has("panel_mm")) {
    const auto size = fields.numbers("panel_mm", 0.1, 10000.0, 2);
    if (size.size() == 2)
      list.panel_mm = {size[0], size[1]};
    else
      fields.wrong("panel_mm", "must be two numbers",
                   "write [width, height], or mm_per_pixel where photos are cropped");
  }
  if (auto camera = fields.table(
          "camera", {"response", "gamma", "table_number", "table_light", "saturation", "dark", "to_linear_srgb"}))
    read_camera(*camera, list);
  else
    fields.wrong("camera", "is missing", "say the camera's response");
  for (Fields& white :
       fields.tables("white", {"id", "file", "dark", "exposure_s", "reflectance", "light_deg"}, max_photos))
    list.whites.push_back(read_white(white));
  for (Fields& photo : fields.tables("photo",
                                     {"file", "dark", "exposure_s", "light_deg", "camera_deg", "azimuth_deg",
                                      "theta_h_deg", "theta_i_deg", "corners_px", "crop_px", "white"},
                                     max_photos))
    list.photos.push_back(read_photo(photo, list, mm_per_pixel));
  if (list.photos.empty()) fields.wrong("photo", "there is none", "add [[photo]]");
  if (!first.error) read_grid(fields, list);
  if (first.error) return tl::unexpected(*first.error);
  return list;
}

}  // namespace lackwerk::packs
