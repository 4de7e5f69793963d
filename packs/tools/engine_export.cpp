#include "packs/tools/engine_export.hpp"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

namespace lackwerk::packs {
namespace {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<std::uint8_t>;

static_assert(std::endian::native == std::endian::little, "glTF's buffers are little endian, and so are these");

/// Squares along an edge of the cube that is blown up to the sphere. 6 x 25^2 = 3750 corners fit 16-bit indices; an
/// edge of 90 / 24 = 3.75 degrees leaves the outline within 0.05 % of a circle.
constexpr int cube_squares = 24;
// From the specification's appendix: the only numbers JSON has for these words.
constexpr int component_u16 = 5123, component_f32 = 5126, target_vertices = 34962, target_indices = 34963;
constexpr int filter_linear = 9729, filter_mip_linear = 9987, wrap_repeat = 10497;

struct Mesh {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
  std::vector<std::uint16_t> indices;
};

/// A cube's faces with equal angles between lines (tangent of the place on the face): tiles of flakes keep their size
/// within 30 % and no pole pinches them. The flakes are random, so that seams between faces do not show.
Mesh sphere(double tile_m) {
  static constexpr int n = cube_squares;
  Mesh mesh;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double sign = face % 2 == 0 ? 1.0 : -1.0;
    const auto first = static_cast<std::uint16_t>(mesh.positions.size());
    for (int row = 0; row <= n; ++row)
      for (int column = 0; column <= n; ++column) {
        const double a = (static_cast<double>(column) / n - 0.5) * std::numbers::pi / 2.0;
        const double b = (static_cast<double>(row) / n - 0.5) * std::numbers::pi / 2.0;
        glm::dvec3 p(0.0);
        p[axis] = sign;
        p[(axis + 1) % 3] = std::tan(a) * sign;  // mirrored with the face, so that all faces turn alike
        p[(axis + 2) % 3] = std::tan(b);
        const glm::dvec3 normal = glm::normalize(p);
        mesh.normals.emplace_back(normal);
        mesh.positions.emplace_back(normal * engine_sphere_radius_m);
        mesh.uvs.emplace_back(glm::dvec2(a, b) * (engine_sphere_radius_m / tile_m));
      }
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) {
        const auto corner = static_cast<std::uint16_t>(first + row * (n + 1) + column);
        const auto right = static_cast<std::uint16_t>(corner + 1), up = static_cast<std::uint16_t>(corner + n + 1);
        const auto across = static_cast<std::uint16_t>(up + 1);
        mesh.indices.insert(mesh.indices.end(), {corner, right, across, corner, across, up});
      }
  }
  return mesh;
}

/// The binary and what JSON says of it.
struct Buffer {
  Bytes bytes;
  Json views = Json::array(), accessors = Json::array();

  /// Appends at a multiple of four, which every component type accepts.
  template <class T>
  std::size_t view(const std::vector<T>& values, std::optional<int> target) {
    bytes.resize((bytes.size() + 3) / 4 * 4, 0);
    const std::size_t offset = bytes.size(), length = values.size() * sizeof(T);
    bytes.resize(offset + length);
    std::memcpy(bytes.data() + offset, values.data(), length);
    Json json{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}};
    if (target) json["target"] = *target;
    views.push_back(json);
    return views.size() - 1;
  }
  template <class T>
  std::size_t accessor(const std::vector<T>& values, int component, const char* type, int target) {
    accessors.push_back(
        {{"bufferView", view(values, target)}, {"componentType", component}, {"count", values.size()}, {"type", type}});
    return accessors.size() - 1;
  }
};

Json json_of(const glm::dvec3& v) { return Json::array({v.x, v.y, v.z}); }

Json texture_info() { return {{"index", 0}}; }

Json material_json(const EngineMaterial& m, const core::PaintIdentity& identity) {
  const bool textured = m.flakes.edge > 0;
  // Below a specular weight of w the base keeps 1 - w; see engine_fit.hpp.
  const glm::dvec3 base = glm::clamp(m.diffuse / std::max(1.0 - m.mean_weight, 1e-6), 0.0, 1.0);
  const glm::dvec3 colour = m.specular_weight > 0.0 ? m.specular / m.specular_weight : glm::dvec3(1.0);
  Json specular{{"specularFactor", m.specular_weight},
                {"specularColorFactor", textured ? json_of(glm::dvec3(1.0)) : json_of(glm::min(colour, 1.0))}};
  if (textured) {
    specular["specularTexture"] = texture_info();
    specular["specularColorTexture"] = texture_info();
  }
  Json material{{"name", identity.name},
                {"pbrMetallicRoughness",
                 {{"baseColorFactor", Json::array({base.x, base.y, base.z, 1.0})},
                  {"metallicFactor", 0.0},
                  {"roughnessFactor", std::sqrt(m.alpha)}}},
                {"extensions", {{"KHR_materials_ior", {{"ior", 0.0}}}, {"KHR_materials_specular", specular}}},
                {"extras",
                 {{"source", identity.source},
                  {"provenance_lobes", core::provenance_name(identity.lobes)},
                  {"provenance_flakes", core::provenance_name(identity.flakes)},
                  {"provenance_coat", core::provenance_name(identity.coat)}}}};
  if (textured) material["extras"]["flake_tile_m"] = m.flakes.edge * m.flakes.texel_mm * 1e-3;
  if (m.clearcoat > 0.0)
    material["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", m.clearcoat},
                                                         {"clearcoatRoughnessFactor", std::sqrt(m.clearcoat_alpha)}};
  return material;
}

/// The whole document but for where the binary and the image lie.
Json document_of(const EngineMaterial& material, const core::PaintIdentity& identity, const Mesh& mesh,
                 Buffer& buffer) {
  const std::size_t position = buffer.accessor(mesh.positions, component_f32, "VEC3", target_vertices);
  glm::vec3 lo = mesh.positions.front(), hi = lo;
  for (const glm::vec3& p : mesh.positions) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  buffer.accessors[position]["min"] = Json::array({lo.x, lo.y, lo.z});
  buffer.accessors[position]["max"] = Json::array({hi.x, hi.y, hi.z});
  Json attributes{{"POSITION", position},
                  {"NORMAL", buffer.accessor(mesh.normals, component_f32, "VEC3", target_vertices)}};
  if (material.flakes.edge > 0)
    attributes["TEXCOORD_0"] = buffer.accessor(mesh.uvs, component_f32, "VEC2", target_vertices);
  const std::size_t indices = buffer.accessor(mesh.indices, component_u16, "SCALAR", target_indices);

  const Json material_part = material_json(material, identity);
  Json used = Json::array();
  for (const auto& [name, value] : material_part["extensions"].items()) used.push_back(name);
  Json document{{"asset", {{"version", "2.0"}, {"generator", "Lackwerk " LACKWERK_VERSION}}}};
  document["extensionsUsed"] = used;
  document["scene"] = 0;
  document["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
  document["nodes"] = Json::array({{{"name", "sphere"}, {"mesh", 0}}});
  Json primitive{{"attributes", attributes}, {"indices", indices}, {"material", 0}};
  document["meshes"] = Json::array({{{"name", "sphere"}, {"primitives", Json::array({primitive})}}});
  document["materials"] = Json::array({material_part});
  if (material.flakes.edge > 0) {
    document["textures"] = Json::array({{{"sampler", 0}, {"source", 0}}});
    document["samplers"] = Json::array({{{"magFilter", filter_linear},
                                         {"minFilter", filter_mip_linear},
                                         {"wrapS", wrap_repeat},
                                         {"wrapT", wrap_repeat}}});
  }
  return document;
}

void finish(Json& document, const Buffer& buffer) {
  document["accessors"] = buffer.accessors;
  document["bufferViews"] = buffer.views;
}

std::string text_of(const Json& document, int indent) {
  return document.dump(indent, ' ', false, Json::error_handler_t::replace);
}

void append_u32(Bytes& out, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// Header, JSON padded with spaces, binary padded with zeros (glTF 2.0, 4.4).
Bytes glb_of(std::string text, Bytes binary) {
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, 0);
  Bytes out;
  append_u32(out, 0x46546C67);  // "glTF"
  append_u32(out, 2);
  append_u32(out, 12 + 8 + text.size() + 8 + binary.size());
  append_u32(out, text.size());
  append_u32(out, 0x4E4F534A);  // "JSON"
  out.insert(out.end(), text.begin(), text.end());
  append_u32(out, binary.size());
  append_u32(out, 0x004E4942);  // "BIN"
  out.insert(out.end(), binary.begin(), binary.end());
  return out;
}

Result<void> write_file(const std::filesystem::path& file, const void* bytes, std::size_t size) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  stream.close();
  if (stream) return {};
  return fail(file.string(), "", "cannot be written", "check the folder, its permissions and free space");
}

/// Alpha is no coverage here: it must not be multiplied into the colours.
Result<void> write_png(const std::filesystem::path& file, const FlakeTexture& texture) {
  try {
    const auto edge = static_cast<int>(texture.edge);
    OIIO::ImageSpec spec(edge, edge, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const auto image = OIIO::ImageOutput::create("png");
    std::string trouble = image ? "" : OIIO::geterror();
    if (image && (!image->open(file.string(), spec) ||
                  !image->write_image(OIIO::TypeDesc::UINT8, texture.rgba.data()) || !image->close()))
      trouble = image->geterror();
    if (trouble.empty()) return {};
    return fail(file.string(), "", "cannot be written: " + trouble, "check the folder, its permissions and free space");
  } catch (const std::exception& error) {
    return fail(file.string(), "", std::string("cannot be written: ") + error.what(), "check the folder");
  }
}

Result<Bytes> read_back(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  Bytes bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream && !bytes.empty()) return bytes;
  return fail(file.string(), "", "cannot be read back", "check the folder");
}

}  // namespace

Result<void> write_engine_material(const EngineMaterial& material, const core::PaintIdentity& identity,
                                   const std::filesystem::path& folder) {
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  if (trouble) return fail(folder.string(), "", "cannot be made: " + trouble.message(), "check the path");
  const bool textured = material.flakes.edge > 0;
  const auto png = folder / "flakes.png";
  if (textured) {
    if (auto ok = write_png(png, material.flakes); !ok) return ok;
  } else {
    std::filesystem::remove(png, trouble);
  }
  const double tile_m = textured ? material.flakes.edge * material.flakes.texel_mm * 1e-3 : 1.0;
  Buffer buffer;
  const Json document = document_of(material, identity, sphere(tile_m), buffer);

  Json apart = document;
  finish(apart, buffer);
  if (textured) apart["images"] = Json::array({{{"uri", "flakes.png"}, {"mimeType", "image/png"}}});
  apart["buffers"] = Json::array({{{"uri", "paint.bin"}, {"byteLength", buffer.bytes.size()}}});
  const std::string text = text_of(apart, 1) + "\n";
  if (auto ok = write_file(folder / "paint.gltf", text.data(), text.size()); !ok) return ok;
  if (auto ok = write_file(folder / "paint.bin", buffer.bytes.data(), buffer.bytes.size()); !ok) return ok;

  Json together = document;
  if (textured) {
    const auto image = read_back(png);
    if (!image) return tl::unexpected(image.error());
    const std::size_t view = buffer.view(*image, std::nullopt);
    together["images"] = Json::array({{{"bufferView", view}, {"mimeType", "image/png"}}});
  }
  finish(together, buffer);
  together["buffers"] = Json::array({{{"byteLength", buffer.bytes.size()}}});
  const Bytes glb = glb_of(text_of(together, -1), buffer.bytes);
  return write_file(folder / "paint.glb", glb.data(), glb.size());
}

}  // namespace lackwerk::packs
