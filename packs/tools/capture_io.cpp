// Reading and writing capture folders. docs/capture.md lists every key of paint.toml.
#include <OpenImageIO/imageio.h>

#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

#include "packs/tools/capture.hpp"
#include "packs/tools/capture_measured.hpp"
#include "packs/tools/paint_fields.hpp"
#include "packs/tools/toml_fields.hpp"

namespace lackwerk::packs {
namespace {

constexpr int format_version = 1;
constexpr std::size_t max_cells = 1u << 23;  ///< of a measured table: 100 MB, six times MERL's
constexpr float max_half = 65504.0f;
constexpr double least_life_deg = 0.1;
constexpr int image_threads = 2;

std::string slice_name(int slice) {
  char name[32];
  std::snprintf(name, sizeof name, "slice_%02d.exr", slice);
  return name;
}

// ---- meaning

Result<void> check_texels(const std::string& file, const std::vector<glm::vec3>& texels, std::uint32_t edge,
                          float highest) {
  for (std::size_t k = 0; k < texels.size(); ++k) {
    for (int channel = 0; channel < 3; ++channel) {
      const float value = texels[k][channel];
      if (value >= 0.0f && value <= highest) continue;
      const std::string where =
          "texel " + std::to_string(k % edge) + "," + std::to_string(k / edge) + " channel " + std::to_string(channel);
      const bool finite = std::isfinite(value);
      return fail(file, where,
                  !finite        ? "is not a finite number"
                  : value < 0.0f ? "is negative"
                                 : "is too bright",
                  "texels are radiance factors in linear sRGB, 0 to 65504");
    }
  }
  return {};
}

/// What both directions promise about a capture, apart from its texels.
Result<void> check_shape(const Capture& capture, const std::string& file) {
  const auto& paint = capture.analytic;
  const auto in = [](double x, double lo, double hi) { return x >= lo && x <= hi; };
  const auto weight = [&](const glm::dvec3& v) {
    return in(v.x, 0.0, max_paint_weight) && in(v.y, 0.0, max_paint_weight) && in(v.z, 0.0, max_paint_weight);
  };
  if (!weight(paint.diffuse)) return fail(file, "CT_diffuse", "is out of range", "give [0, 1000]");
  double rougher = 1.0;
  for (const core::Lobe& lobe : paint.lobes) {
    if (!weight(lobe.s)) return fail(file, "CT_coeffs", "is out of range", "give [0, 1000]");
    if (!in(lobe.f0, 0.0, 1.0)) return fail(file, "CT_F0s", "is out of range", "give [0, 1]");
    if (!in(lobe.m, core::min_roughness, 1.0)) return fail(file, "CT_spreads", "is out of range", "give [0.001, 1]");
    if (lobe.m > rougher) return fail(file, "CT_spreads", "does not fall", "sort the lobes by falling roughness");
    rougher = lobe.m;
  }
  if (!in(paint.coat_ior, 1.0, 4.0)) return fail(file, "IOR", "is out of range", "give [1, 4]");
  if (!in(paint.refraction_ior, 1.0, 4.0)) return fail(file, "refraction_IOR", "is out of range", "give [1, 4]");
  if (paint.table) {
    const std::size_t nodes = paint.table->num_theta;
    if (nodes < 2 || nodes > max_layout_theta || paint.table->linear.size() != nodes * nodes) {
      return fail(file, "BRDFcolors", "is no square table of 2 to 256 nodes", "export it as an N x N image");
    }
  }
  const auto& layout = capture.layout;
  if (layout.slice_count() == 0) return {};
  if (layout.lut.front() != 0 || layout.slice_count() > max_layout_slices || layout.num_theta < 1 ||
      layout.num_theta > max_layout_theta || layout.rows() > layout.num_theta) {
    return fail(file, "thetaFI_sliceLUT", "is no slice layout", "it starts at 0, rises, and ends with at most 256");
  }
  for (std::size_t row = 0; row + 1 < layout.lut.size(); ++row) {
    if (layout.lut[row + 1] >= layout.lut[row] && layout.lut[row + 1] - layout.lut[row] <= layout.num_theta) continue;
    return fail(file, "thetaFI_sliceLUT", "does not rise by 0 to num_thetaF per row", "export it unchanged");
  }
  if (capture.life) {
    for (const double half : {capture.life->half_h_deg, capture.life->half_i_deg})
      if (!in(half, least_life_deg, 90.0)) return fail(file, "life_theta_h_deg", "is out of range", "give [0.1, 90]");
  }
  const std::uint64_t texels = std::uint64_t{capture.edge_texels} * capture.edge_texels;
  if (capture.edge_texels < 1 || capture.edge_texels > max_slice_edge ||
      texels * static_cast<std::uint64_t>(layout.slice_count()) > max_slice_texels) {
    return fail(file, "edge_texels", "is out of range", "give [1, 4096], and at most 2^27 texels in all slices");
  }
  if (!(capture.texel_mm > 0.0f && capture.texel_mm <= 10.0f)) {
    return fail(file, "texel_mm", "is out of range", "give millimetres in (0, 10]");
  }
  return {};
}

// ---- images. OpenImageIO reports by return values, but its plug-ins may throw: both become errors here.

/// Three half-float channels in linear sRGB. `edge * edge` texels.
Result<void> write_image(const std::filesystem::path& file, const std::vector<glm::vec3>& texels, std::uint32_t edge) {
  try {
    auto image = OIIO::ImageOutput::create("exr");
    OIIO::ImageSpec spec(static_cast<int>(edge), static_cast<int>(edge), 3, OIIO::TypeDesc::HALF);
    spec.attribute("compression", "zips");
    spec.attribute("oiio:ColorSpace", "Linear");
    std::string trouble = image ? "" : OIIO::geterror();
    if (image && (!image->open(file.string(), spec) || !image->write_image(OIIO::TypeDesc::FLOAT, texels.data()) ||
                  !image->close())) {
      trouble = image->geterror();
    }
    if (trouble.empty()) return {};
    return fail(file.string(), "", "cannot be written: " + trouble, "check the folder, its permissions and free space");
  } catch (const std::exception& error) {
    return fail(file.string(), "", std::string("cannot be written: ") + error.what(), "check the folder");
  }
}

/// The header is checked before memory is taken. `edge` 0 accepts any square up to max_layout_theta.
Result<std::vector<glm::vec3>> read_image(const std::filesystem::path& file, std::uint32_t edge) {
  const std::string name = file.string();
  try {
    if (!std::filesystem::exists(file)) return fail(name, "", "is missing", "export it again");
    auto image = OIIO::ImageInput::create("exr");
    OIIO::ImageSpec spec;
    if (!image || !image->open(name, spec)) {
      const std::string why = image ? image->geterror() : OIIO::geterror();
      return fail(name, "", "cannot be opened: " + why, "copy it again, or export it as OpenEXR");
    }
    if (spec.nchannels != 3 || spec.channelnames != std::vector<std::string>{"R", "G", "B"}) {
      return fail(name, "channels", "has " + std::to_string(spec.nchannels) + " channels, not R, G, B",
                  "export R, G, B only");
    }
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
        spec.height != spec.full_height) {
      return fail(name, "dataWindow", "differs from displayWindow", "export the whole picture without cropping");
    }
    const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height);
    if (spec.width != spec.height || spec.depth > 1 || spec.deep || spec.width < 1) {
      return fail(name, "size", "is " + size, "export a square picture");
    }
    const auto width = static_cast<std::uint32_t>(spec.width);
    if (edge == 0 && (width < 2 || width > static_cast<std::uint32_t>(max_layout_theta))) {
      return fail(name, "size", "is " + size, "a colour table has 2 to 256 nodes per axis");
    }
    if (edge != 0 && width != edge) {
      return fail(name, "size", "is " + size, "edge_texels says " + std::to_string(edge));
    }
    std::vector<glm::vec3> texels(static_cast<std::size_t>(width) * width);
    if (!image->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, texels.data())) {
      return fail(name, "", "is damaged: " + image->geterror(), "copy or export it again");
    }
    if (auto ok = check_texels(name, texels, width, max_half); !ok) return tl::unexpected(ok.error());
    return texels;
  } catch (const std::exception& error) {
    return fail(name, "", std::string("cannot be read: ") + error.what(), "export it again");
  }
}

/// Runs `one(slice)` for all slices on a few threads; the error of the lowest slice wins.
template <class F>
Result<void> for_each_slice(int count, const F& one) {
  std::atomic<int> next{0};
  std::mutex guard;
  std::optional<Error> first;
  int first_slice = count;
  const auto work = [&] {
    for (int slice = next++; slice < count; slice = next++) {
      const Result<void> ok = one(slice);
      if (ok) continue;
      const std::scoped_lock lock(guard);
      if (slice < first_slice) first = ok.error();
      first_slice = std::min(first_slice, slice);
      next = count;
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (int k = 1; k < image_threads; ++k) helpers.emplace_back(work);
    work();
  }
  if (first) return tl::unexpected(*first);
  return {};
}

// ---- paint.toml

/// The shortest text that reads back as the same value.
template <class T>
std::string number_text(T value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}
std::string rgb_text(const glm::dvec3& v) {
  return "[" + number_text(v.x) + ", " + number_text(v.y) + ", " + number_text(v.z) + "]";
}
std::string list_text(const std::vector<std::string>& entries) {
  std::string out = "[";
  for (const std::string& entry : entries) out += (out.size() > 1 ? ", " : "") + entry;
  return out + "]";
}
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    char code[8];
    std::snprintf(code, sizeof code, "\\u%04x", byte);
    if (byte < 0x20 || byte == 0x7f) {
      out += code;
    } else {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
  }
  return out + "\"";
}
std::string measured_toml(const Capture& capture) {
  if (!capture.measured && capture.angles.empty()) return "";
  std::string out = "\n[measured]\n";
  if (capture.measured) {
    const core::BrdfTableSize& size = capture.measured->size();
    out += "BRDF = \"brdf.exr\"\nnum_theta_h = " + number_text(size.theta_h) +
           "\nnum_theta_d = " + number_text(size.theta_d) + "\nnum_phi_d = " + number_text(size.phi_d) + "\n";
  }
  if (!capture.angles.empty()) out += "angles = \"angles.csv\"\n";
  return out;
}
std::string paint_toml(const Capture& capture) {
  const auto& paint = capture.analytic;
  std::ostringstream out;
  out << "# A Lackwerk capture. Keys with CT_, theta and IOR mean what they mean in AxF's CarPaint2 "
         "(docs/capture.md).\n"
      << "format = " << format_version << "\nname = " << quoted(capture.identity.name)
      << "\nsource = " << quoted(capture.identity.source) << "\nIOR = " << number_text(paint.coat_ior)
      << "\ncc_no_refraction = " << (paint.refraction_ior == 1.0 ? "true" : "false") << "\n";
  if (paint.refraction_ior != 1.0) out << "refraction_IOR = " << number_text(paint.refraction_ior) << "\n";
  std::vector<std::string> s, f0, m, lut;
  for (const core::Lobe& lobe : paint.lobes) {
    s.push_back(rgb_text(lobe.s));
    f0.push_back(number_text(lobe.f0));
    m.push_back(number_text(lobe.m));
  }
  out << "CT_diffuse = " << rgb_text(paint.diffuse) << "\nCT_coeffs = " << list_text(s)
      << "\nCT_F0s = " << list_text(f0) << "\nCT_spreads = " << list_text(m) << "\n";
  if (paint.table) out << "BRDFcolors = \"colour.exr\"\n";
  if (!capture.is_fitted) out << "fitted = false\n";
  if (capture.form != PaintForm::given) out << "form = \"" << form_name(capture.form) << "\"\n";
  out << "\n[provenance]\nlobes = \"" << core::provenance_name(capture.identity.lobes) << "\"\nflakes = \""
      << core::provenance_name(capture.identity.flakes) << "\"\ncoat = \""
      << core::provenance_name(capture.identity.coat) << "\"\n";
  out << measured_toml(capture);
  if (capture.layout.slice_count() == 0) return out.str();
  for (const std::uint16_t entry : capture.layout.lut) lut.push_back(number_text(entry));
  out << "\n[flakes]\nBTFflakes = \"flakes\"\nedge_texels = " << capture.edge_texels
      << "\ntexel_mm = " << number_text(capture.texel_mm) << "\nnum_thetaF = " << capture.layout.num_theta
      << "\nnum_thetaI = " << capture.layout.num_theta << "\nmax_thetaI = " << capture.layout.rows()
      << "\nthetaFI_sliceLUT = " << list_text(lut) << "\n";
  if (capture.life)
    out << "life_theta_h_deg = " << number_text(capture.life->half_h_deg)
        << "\nlife_theta_i_deg = " << number_text(capture.life->half_i_deg) << "\n";
  return out.str();
}

/// What paint.toml says besides the capture itself.
struct PaintFile {
  Capture capture;
  bool has_table = false;
  std::optional<core::BrdfTableSize> measured;
  bool has_angles = false;
};

void read_layout(Fields& fields, Capture& capture) {
  if (fields.text("BTFflakes") != "flakes") fields.wrong("BTFflakes", "must be \"flakes\"", "keep images in flakes/");
  capture.edge_texels = static_cast<std::uint32_t>(fields.whole("edge_texels", 1, max_slice_edge));
  capture.texel_mm = static_cast<float>(fields.number("texel_mm", 1e-6, 10.0));
  capture.layout = read_layout_fields(fields);
  if (fields.has("life_theta_h_deg") || fields.has("life_theta_i_deg"))
    capture.life = MeasuredLife{fields.number("life_theta_h_deg", least_life_deg, 90.0),
                                fields.number("life_theta_i_deg", least_life_deg, 90.0)};
}

void read_form(Fields& fields, Capture& capture) {
  if (!fields.has("form")) return;
  const std::string wanted = fields.text("form");
  for (const PaintForm form : {PaintForm::given, PaintForm::fitted, PaintForm::mapped}) {
    if (wanted != form_name(form)) continue;
    capture.form = form;
    return;
  }
  fields.wrong("form", "is none of \"given\", \"fitted\", \"mapped\"", "leave it out where nothing was fitted");
}

void read_measured(Fields& fields, PaintFile& out) {
  if (fields.has("BRDF")) {
    if (fields.text("BRDF") != "brdf.exr") fields.wrong("BRDF", "must be \"brdf.exr\"", "rename the image");
    const auto count = [&](const char* key) { return static_cast<std::uint32_t>(fields.whole(key, 2, 512)); };
    out.measured = core::BrdfTableSize{count("num_theta_h"), count("num_theta_d"), count("num_phi_d")};
    if (out.measured->cells() > max_cells) fields.wrong("num_theta_h", "makes too many cells", "give at most 2^23");
  }
  out.has_angles = fields.has("angles");
  if (out.has_angles && fields.text("angles") != "angles.csv")
    fields.wrong("angles", "must be \"angles.csv\"", "rename the table");
}

Result<PaintFile> read_paint_file(const std::filesystem::path& file) {
  auto document = parse_toml(file);
  if (!document) return tl::unexpected(document.error());
  FirstError first{file.string(), std::nullopt};
  PaintFile out;
  Fields fields(first, *document, "",
                {"format", "name", "source", "IOR", "cc_no_refraction", "refraction_IOR", "CT_diffuse", "CT_coeffs",
                 "CT_F0s", "CT_spreads", "BRDFcolors", "fitted", "form", "provenance", "measured", "flakes"});
  if (fields.whole("format", 0, 1000000) != format_version) {
    fields.wrong("format", "is a version this program does not know", "write format = 1");
  }
  auto& identity = out.capture.identity;
  auto& paint = out.capture.analytic;
  read_identity_fields(fields, identity, paint);
  read_lobe_fields(fields, paint);
  out.has_table = fields.has("BRDFcolors");
  if (out.has_table && fields.text("BRDFcolors") != "colour.exr") {
    fields.wrong("BRDFcolors", "must be \"colour.exr\"", "rename the image");
  }
  out.capture.is_fitted = fields.flag("fitted", true);
  read_form(fields, out.capture);
  if (auto measured = fields.table("measured", {"BRDF", "num_theta_h", "num_theta_d", "num_phi_d", "angles"}))
    read_measured(*measured, out);
  if (auto flakes =
          fields.table("flakes", {"BTFflakes", "edge_texels", "texel_mm", "num_thetaF", "num_thetaI", "max_thetaI",
                                  "thetaFI_sliceLUT", "life_theta_h_deg", "life_theta_i_deg"})) {
    read_layout(*flakes, out.capture);
  }
  if (first.error) return tl::unexpected(*first.error);
  if (auto ok = check_shape(out.capture, file.string()); !ok) return tl::unexpected(ok.error());
  return out;
}

}  // namespace

Result<Capture> read_capture(const std::filesystem::path& folder) {
  auto paint = read_paint_file(folder / "paint.toml");
  if (!paint) return tl::unexpected(paint.error());
  Capture& capture = paint->capture;
  if (paint->has_table) {
    auto table = read_image(folder / "colour.exr", 0);
    if (!table) return tl::unexpected(table.error());
    const auto nodes = static_cast<std::uint16_t>(std::lround(std::sqrt(static_cast<double>(table->size()))));
    capture.analytic.table = core::ColourTable{nodes, std::move(*table)};
  }
  if (paint->measured) {
    auto measured = read_brdf_image(folder / "brdf.exr", *paint->measured);
    if (!measured) return tl::unexpected(measured.error());
    capture.measured = std::move(*measured);
  }
  if (paint->has_angles) {
    auto angles = read_readings(folder / "angles.csv");
    if (!angles) return tl::unexpected(angles.error());
    capture.angles = std::move(*angles);
  }
  capture.slices.resize(static_cast<std::size_t>(capture.layout.slice_count()));
  const auto ok = for_each_slice(capture.layout.slice_count(), [&](int slice) -> Result<void> {
    auto texels = read_image(folder / "flakes" / slice_name(slice), capture.edge_texels);
    if (!texels) return tl::unexpected(texels.error());
    capture.slices[static_cast<std::size_t>(slice)].texels = std::move(*texels);
    return {};
  });
  if (!ok) return tl::unexpected(ok.error());
  return std::move(capture);
}

Result<void> write_capture(const Capture& capture, const std::filesystem::path& folder) {
  const std::filesystem::path paint_file = folder / "paint.toml";
  const auto slices = static_cast<std::size_t>(capture.layout.slice_count());
  if (auto ok = check_shape(capture, paint_file.string()); !ok) return ok;
  if (capture.measured && capture.measured->size().cells() > max_cells)
    return fail(paint_file.string(), "num_theta_h", "makes too many cells", "give at most 2^23");
  if (capture.slices.size() != slices) {
    return fail(paint_file.string(), "thetaFI_sliceLUT", "does not match the number of slices", "fill all slices");
  }
  const auto& table = capture.analytic.table;
  if (table) {
    auto ok = check_texels((folder / "colour.exr").string(), table->linear, table->num_theta, max_half);
    if (!ok) return ok;
  }
  const std::size_t texels = static_cast<std::size_t>(capture.edge_texels) * capture.edge_texels;
  std::error_code code;
  std::filesystem::create_directories(folder / "flakes", code);
  // paint.toml goes first and comes last: a write that was interrupted leaves no capture rather than a mixed one.
  for (const char* name : {"paint.toml", "colour.exr", "brdf.exr", "angles.csv"}) {
    if (!code) std::filesystem::remove(folder / name, code);
  }
  if (code) return fail(folder.string(), "", "cannot be written: " + code.message(), "choose another folder");
  for (int slice = static_cast<int>(slices); slice < max_layout_slices; ++slice) {
    std::filesystem::remove(folder / "flakes" / slice_name(slice), code);  // left over from a longer capture
  }
  if (table) {
    if (auto ok = write_image(folder / "colour.exr", table->linear, table->num_theta); !ok) return ok;
  }
  if (capture.measured) {
    if (auto ok = write_brdf_image(*capture.measured, folder / "brdf.exr"); !ok) return ok;
  }
  if (!capture.angles.empty()) {
    if (auto ok = write_readings(capture.angles, folder / "angles.csv"); !ok) return ok;
  }
  auto ok = for_each_slice(static_cast<int>(slices), [&](int slice) -> Result<void> {
    const auto file = folder / "flakes" / slice_name(slice);
    const auto& image = capture.slices[static_cast<std::size_t>(slice)].texels;
    if (image.size() != texels) return fail(file.string(), "size", "is not edge_texels squared", "fill all texels");
    if (auto good = check_texels(file.string(), image, capture.edge_texels, max_half); !good) return good;
    return write_image(file, image, capture.edge_texels);
  });
  if (!ok) return ok;
  std::ofstream stream(paint_file, std::ios::binary);
  stream << paint_toml(capture);
  stream.close();
  if (!stream) return fail(paint_file.string(), "", "cannot be written", "check permissions and free space");
  return {};
}

}  // namespace lackwerk::packs
