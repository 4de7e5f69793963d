#include "packs/tools/rgl_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "core/environment.hpp"
#include "packs/tools/rgl_tensors.hpp"
#include "packs/tools/whole_file.hpp"

namespace lackwerk::packs {

using std::numbers::pi;

namespace {

constexpr std::uintmax_t max_bytes = 64u << 20;  ///< isotropic rgb files have 0.7 MB
constexpr std::size_t max_edge = 1024;           ///< nodes of a square; real ones have 128 and 32
constexpr std::size_t max_angles = 128;          ///< real isotropic files have 8
constexpr const char* again = "download the file again";

/// Coordinates of a direction in a square. `phi` may be any angle.
glm::dvec2 unit(double theta, double phi) {
  const double turn = (phi + pi) / (2.0 * pi);
  return {std::sqrt(theta * 2.0 / pi), turn - std::floor(turn)};
}
/// Not acos(z), which has no digits left near the pole.
double elevation(const glm::dvec3& v) { return std::clamp(std::atan2(std::hypot(v.x, v.y), v.z), 0.0, pi / 2.0); }
double azimuth(const glm::dvec3& v) { return std::atan2(v.y, v.x); }

std::string entry(std::size_t k) { return "entry " + std::to_string(k); }

}  // namespace

glm::dvec3 RglMaterial::operator()(const glm::dvec3& in, const glm::dvec3& out) const {
  if (in.z <= 0.0 || out.z <= 0.0) return glm::dvec3(0.0);
  const glm::dvec3 half = glm::normalize(in + out);
  const double phi_in = azimuth(in);
  // Isotropic: only the azimuth against the light's counts.
  const glm::dvec2 half_unit = unit(elevation(half), azimuth(half) - phi_in);
  const double angles[]{phi_in, elevation(in)};
  const glm::dvec2 at = vndf_.invert(half_unit, angles);
  glm::dvec3 value;
  for (int channel = 0; channel < 3; ++channel) {
    const double place[]{angles[0], angles[1], static_cast<double>(channel)};
    value[channel] = rgb_.eval(at, place);
  }
  if (has_jacobian_) value *= ndf_.eval(half_unit, {}) / (4.0 * sigma(in));
  return value / out.z;
}

double RglMaterial::ndf(const glm::dvec3& half) const { return ndf_.eval(unit(elevation(half), azimuth(half)), {}); }
double RglMaterial::sigma(const glm::dvec3& in) const { return sigma_.eval(unit(elevation(in), azimuth(in)), {}); }

/// Checks the meaning of the fields, one after the other; the first error stops it.
class RglReader {
 public:
  explicit RglReader(const TensorFile& tensors) : tensors_(tensors) {}

  Result<RglMaterial> read() {
    refuse_other_kinds();
    angles("phi_i", -2.0 * pi, 2.0 * pi, phi_);
    if (phi_.size() > 2)
      wrong("phi_i", "has " + std::to_string(phi_.size()) + " azimuths: the material is anisotropic",
            "paints are isotropic; give a file with one or two");
    angles("theta_i", 0.0, pi / 2.0 + 1e-3, theta_);  // 1e-3: float32 has pi/2 as 1.5707964
    auto ndf = square("ndf", 2, {}, Sign::not_negative);
    auto sigma = square("sigma", 2, {}, Sign::positive);
    auto vndf = square("vndf", 4, {phi_.size(), theta_.size()}, Sign::not_negative);
    const auto luminance = square("luminance", 4, {phi_.size(), theta_.size()}, Sign::not_negative);
    auto rgb = square("rgb", 5, {phi_.size(), theta_.size(), 3}, Sign::any);
    if (!error_) check_colours(*rgb);
    if (error_) return tl::unexpected(*error_);
    RglWarp warp(std::move(vndf->values), vndf->width, vndf->height, {phi_, theta_});
    if (warp.has_empty_slice())
      return fail(tensors_.file(), "vndf", "holds only zeros for an angle of the light", again);
    RglMaterial out(RglSquare(std::move(ndf->values), ndf->width, ndf->height, {}),
                    RglSquare(std::move(sigma->values), sigma->width, sigma->height, {}), std::move(warp),
                    RglSquare(std::move(rgb->values), rgb->width, rgb->height, {phi_, theta_, {0.0f, 1.0f, 2.0f}}));
    out.theta_in_ = theta_;
    out.negative_share_ = negative_share_;
    read_flags(out);
    if (error_) return tl::unexpected(*error_);
    return out;
  }

 private:
  enum class Sign { any, not_negative, positive };
  struct Values {
    std::vector<float> values;
    std::size_t width = 0, height = 0;
  };

  void wrong(const std::string& field, std::string what, std::string remedy = again) {
    if (!error_) error_ = Error{tensors_.file(), field, std::move(what), std::move(remedy), ErrorKind::run};
  }

  void refuse_other_kinds() {
    if (tensors_.find("rgb") == nullptr && tensors_.find("spectra") != nullptr)
      wrong("spectra", "is a spectral material", "download its *_rgb.bsdf file");
  }

  /// A rising list of angles, radians.
  void angles(const std::string& name, double least, double most, std::vector<float>& out) {
    if (error_) return;
    const auto tensor = tensors_.need(name, TensorType::f32, 1);
    if (!tensor) {
      error_ = tensor.error();
      return;
    }
    if ((*tensor)->count > max_angles) return wrong(name, "has " + std::to_string((*tensor)->count) + " angles");
    out = (*tensor)->floats();
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double angle = static_cast<double>(out[k]);
      if (!(angle >= least && angle <= most)) return wrong(name, entry(k) + " is out of range");
      if (k > 0 && !(out[k] > out[k - 1])) return wrong(name, entry(k) + " does not rise");
    }
  }

  std::optional<Values> square(const std::string& name, std::size_t dimensions, const std::vector<std::size_t>& slices,
                               Sign sign) {
    if (error_) return std::nullopt;
    const auto tensor = tensors_.need(name, TensorType::f32, dimensions);
    if (!tensor) {
      error_ = tensor.error();
      return std::nullopt;
    }
    const auto& shape = (*tensor)->shape;
    for (std::size_t k = 0; k < slices.size(); ++k) {
      if (shape[k] == slices[k]) continue;
      wrong(name, "has " + std::to_string(shape[k]) + " entries in dimension " + std::to_string(k) + ", not " +
                      std::to_string(slices[k]));
      return std::nullopt;
    }
    Values out;
    out.width = shape[dimensions - 1];
    out.height = shape[dimensions - 2];
    if (std::min(out.width, out.height) < 2 || std::max(out.width, out.height) > max_edge) {
      wrong(name, "is a square of " + std::to_string(out.width) + " x " + std::to_string(out.height) + " nodes");
      return std::nullopt;
    }
    out.values = (*tensor)->floats();
    for (std::size_t k = 0; k < out.values.size(); ++k) {
      const float value = out.values[k];
      const char* fault = !std::isfinite(value)                            ? " is not a finite number"
                          : sign != Sign::any && value < 0.0f              ? " is negative"
                          : sign == Sign::positive && value < least_sigma_ ? " is zero"
                          : std::abs(value) > most_                        ? " is beyond 1e30"
                                                                           : nullptr;
      if (fault == nullptr) continue;
      wrong(name, entry(k) + fault);
      return std::nullopt;
    }
    return out;
  }

  /// A colour may lie outside sRGB, light may not be negative.
  void check_colours(const Values& rgb) {
    const std::size_t plane = rgb.width * rgb.height;
    double negative = 0.0, positive = 0.0;
    for (std::size_t slice = 0; slice * plane * 3 < rgb.values.size(); ++slice) {
      for (std::size_t k = 0; k < plane; ++k) {
        glm::dvec3 colour;
        double size = 0.0;
        for (int channel = 0; channel < 3; ++channel) {
          const std::size_t at = (slice * 3 + static_cast<std::size_t>(channel)) * plane + k;
          colour[channel] = static_cast<double>(rgb.values[at]);
          (colour[channel] < 0.0 ? negative : positive) += std::abs(colour[channel]);
          size = std::max(size, std::abs(colour[channel]));
        }
        // 1e-3: rounding of a colour at the edge of what the eye sees.
        if (core::luminance_of(colour) < -1e-3 * size)
          return wrong("rgb", entry(slice * 3 * plane + k) + " has a negative luminance");
      }
    }
    if (!(positive > 0.0)) return wrong("rgb", "holds no light at all");
    negative_share_ = negative / positive;
  }

  void read_flags(RglMaterial& out) {
    if (const auto jacobian = tensors_.need("jacobian", TensorType::bytes, 1); !jacobian) {
      error_ = jacobian.error();
    } else {
      out.has_jacobian_ = (*jacobian)->bytes.front() != 0;
    }
    const auto description = tensors_.need("description", TensorType::bytes, 1);
    if (!description || (*description)->count > 1024) return;  // only text, for people
    for (const std::uint8_t byte : (*description)->bytes)
      out.description_ += byte >= ' ' && byte <= '~' ? static_cast<char>(byte) : ' ';
  }

  static constexpr float least_sigma_ = 1e-6f;  ///< divided by; real files go down to 0.018
  static constexpr float most_ = 1e30f;         ///< no product of two runs over a double, no sum over a float

  const TensorFile& tensors_;
  std::optional<Error> error_;
  std::vector<float> phi_, theta_;
  double negative_share_ = 0.0;
};

Result<RglMaterial> read_rgl(std::span<const std::uint8_t> bytes, const std::string& file) {
  const auto tensors = TensorFile::parse(bytes, file);
  if (!tensors) return tl::unexpected(tensors.error());
  return RglReader(*tensors).read();
}

Result<RglMaterial> read_rgl(const std::filesystem::path& path) {
  const auto bytes = read_whole_file(path, max_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return read_rgl(*bytes, path.string());
}

}  // namespace lackwerk::packs
