#include "kiosk/display/display_profile.hpp"

#include <lcms2.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <memory>

#include "core/colour.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr std::size_t most_icc_bytes = std::size_t{16} << 20;
constexpr std::size_t most_curve_points = 4096;
/// Points a curve of an ICC file is read at.
constexpr int icc_curve_points = 1024;
/// Twice the area of the smallest triangle of primaries that counts as one; sRGB's is 0.2241.
constexpr double least_area = 0.02;

/// X, Y, Z of a chromaticity at Y = 1.
glm::dvec3 xyz_of(Chromaticity c) { return {c.x / c.y, 1.0, (1.0 - c.x - c.y) / c.y}; }

Chromaticity chromaticity_of(const glm::dvec3& xyz) {
  const double sum = xyz.x + xyz.y + xyz.z;
  return {xyz.x / sum, xyz.y / sum};
}

/// XYZ of linear RGB: columns are the primaries, weighed so that (1, 1, 1) is the white (SMPTE RP 177-1993, 3.3).
glm::dmat3 xyz_from_rgb(const DisplayProfile& p) {
  const glm::dmat3 primaries(xyz_of(p.red), xyz_of(p.green), xyz_of(p.blue));
  const glm::dvec3 weights = glm::inverse(primaries) * xyz_of(p.white);
  return {primaries[0] * weights.x, primaries[1] * weights.y, primaries[2] * weights.z};
}

/// XYZ seen under one white to XYZ that looks the same under another: Bradford (Lam 1985; the matrix as in ICC.1:2022,
/// annex E). Whites as XYZ.
glm::dmat3 bradford(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dmat3 cone = glm::transpose(glm::dmat3(
      glm::dvec3(0.8951, 0.2664, -0.1614), glm::dvec3(-0.7502, 1.7135, 0.0367), glm::dvec3(0.0389, -0.0685, 1.0296)));
  const glm::dvec3 ratio = (cone * to) / (cone * from);
  const glm::dmat3 scale(glm::dvec3(ratio.x, 0, 0), glm::dvec3(0, ratio.y, 0), glm::dvec3(0, 0, ratio.z));
  return glm::inverse(cone) * scale * cone;
}

double cross(Chromaticity a, Chromaticity b, Chromaticity c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

Result<std::vector<char>> read_bounded(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return fail(path, "", "cannot be opened", "check the path in kiosk.toml and the file's permissions");
  std::vector<char> bytes;
  std::array<char, 65536> piece{};
  while (file.read(piece.data(), piece.size()) || file.gcount() > 0) {
    bytes.insert(bytes.end(), piece.data(), piece.data() + file.gcount());
    if (bytes.size() > most_icc_bytes)
      return fail(path, "", "is larger than 16 MiB", "a matrix profile has a few kilobytes: give that one");
  }
  return bytes;
}

using Lcms = std::unique_ptr<std::remove_pointer_t<cmsContext>, decltype(&cmsDeleteContext)>;
using Profile = std::unique_ptr<void, decltype(&cmsCloseProfile)>;

Result<glm::dvec3> xyz_tag(cmsHPROFILE profile, cmsTagSignature tag, const std::string& path, const char* name) {
  const auto* xyz = static_cast<const cmsCIEXYZ*>(cmsReadTag(profile, tag));
  if (xyz == nullptr) return fail(path, name, "is damaged", "make the profile again");
  const glm::dvec3 out(xyz->X, xyz->Y, xyz->Z);
  const double sum = out.x + out.y + out.z;
  if (!std::isfinite(sum) || sum < 1e-6) return fail(path, name, "is no colour", "make the profile again");
  return out;
}

/// From the profile's D50 to the white the panel really has: the inverse of the `chad` tag; in version 2 files, which
/// may lack it, Bradford to the media white.
Result<glm::dmat3> panel_from_d50(cmsHPROFILE profile, const std::string& path) {
  const glm::dvec3 d50(cmsD50_XYZ()->X, cmsD50_XYZ()->Y, cmsD50_XYZ()->Z);
  if (cmsIsTag(profile, cmsSigChromaticAdaptationTag) != 0) {
    const auto* rows = static_cast<const cmsFloat64Number*>(cmsReadTag(profile, cmsSigChromaticAdaptationTag));
    if (rows == nullptr) return fail(path, "chad", "is damaged", "make the profile again");
    glm::dmat3 chad;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) chad[column][row] = rows[3 * row + column];
    const double size = glm::determinant(chad);
    if (!std::isfinite(size) || std::abs(size) < 1e-3)
      return fail(path, "chad", "has no inverse", "make the profile again");
    return glm::inverse(chad);
  }
  if (cmsIsTag(profile, cmsSigMediaWhitePointTag) == 0) return glm::dmat3(1.0);
  const auto white = xyz_tag(profile, cmsSigMediaWhitePointTag, path, "wtpt");
  if (!white) return tl::unexpected(white.error());
  if (white->y < 1e-6) return fail(path, "wtpt", "is black", "make the profile again");
  return bradford(d50, *white / white->y);
}

std::string description_of(cmsHPROFILE profile) {
  std::array<char, 128> text{};
  cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", text.data(), text.size());
  text.back() = '\0';
  std::string out = text.data();
  std::replace_if(
      out.begin(), out.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7f; }, '?');
  return out;
}

}  // namespace

bool DisplayProfile::is_srgb() const {
  // The standard gives its chromaticities in four digits.
  constexpr double digit = 5e-4;
  const DisplayProfile srgb;
  const auto same = [](Chromaticity a, Chromaticity b) {
    return std::abs(a.x - b.x) < digit && std::abs(a.y - b.y) < digit;
  };
  if (!same(red, srgb.red) || !same(green, srgb.green) || !same(blue, srgb.blue) || !same(white, srgb.white))
    return false;
  // A quarter of an 8-bit step would not change a pixel by more than one.
  return std::all_of(curves.begin(), curves.end(), [](const std::vector<double>& curve) {
    for (std::size_t k = 0; k < curve.size(); ++k) {
      const double pixel = static_cast<double>(k) / static_cast<double>(curve.size() - 1);
      if (!(std::abs(core::srgb_encode(curve[k]) - pixel) < 0.25 / 255.0)) return false;
    }
    return true;
  });
}

std::vector<double> power_curve(double exponent, int n) {
  std::vector<double> curve(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) curve[static_cast<std::size_t>(k)] = std::pow(static_cast<double>(k) / (n - 1), exponent);
  return curve;
}

double pixel_of_light(const DisplayProfile& profile, int channel, double light) {
  const std::vector<double>& curve = profile.curves[static_cast<std::size_t>(channel)];
  if (curve.empty()) return light < 1.0 ? core::srgb_encode(std::max(light, 0.0)) : 1.0;
  // The first point that is at least as bright; the way there is a straight line.
  const auto above = std::lower_bound(curve.begin(), curve.end(), light);
  if (above == curve.begin()) return 0.0;
  if (above == curve.end()) return 1.0;
  const double low = *(above - 1);
  const auto index = static_cast<double>(above - 1 - curve.begin());
  return (index + (light - low) / (*above - low)) / static_cast<double>(curve.size() - 1);
}

Result<DisplayProfile> read_icc(const std::string& path) {
  const auto bytes = read_bounded(path);
  if (!bytes) return tl::unexpected(bytes.error());
  const Lcms lcms(cmsCreateContext(nullptr, nullptr), &cmsDeleteContext);
  const Profile opened(cmsOpenProfileFromMemTHR(lcms.get(), bytes->data(), static_cast<cmsUInt32Number>(bytes->size())),
                       &cmsCloseProfile);
  cmsHPROFILE icc = opened.get();
  if (icc == nullptr) return fail(path, "", "is not an ICC profile, or cut short", "make the profile again");
  if (cmsGetColorSpace(icc) != cmsSigRgbData)
    return fail(path, "colour space", "is not RGB", "give the profile of the display, not of a printer");
  if (cmsGetDeviceClass(icc) != cmsSigDisplayClass)
    return fail(path, "class", "is not a display profile", "give the profile of the display");
  if (cmsIsMatrixShaper(icc) == 0)
    return fail(path, "", "has tables only", "make a profile of the matrix and curve kind (\"single gamma + matrix\")");

  const auto adapt = panel_from_d50(icc, path);
  if (!adapt) return tl::unexpected(adapt.error());
  DisplayProfile out;
  struct Channel {
    cmsTagSignature colour, curve;
    const char *colour_name, *curve_name;
    Chromaticity* to;
  };
  const std::array<Channel, 3> channels = {
      Channel{cmsSigRedColorantTag, cmsSigRedTRCTag, "rXYZ", "rTRC", &out.red},
      Channel{cmsSigGreenColorantTag, cmsSigGreenTRCTag, "gXYZ", "gTRC", &out.green},
      Channel{cmsSigBlueColorantTag, cmsSigBlueTRCTag, "bXYZ", "bTRC", &out.blue}};
  glm::dvec3 white(0.0);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const Channel& channel = channels[k];
    const auto colorant = xyz_tag(icc, channel.colour, path, channel.colour_name);
    if (!colorant) return tl::unexpected(colorant.error());
    const glm::dvec3 native = *adapt * *colorant;
    *channel.to = chromaticity_of(native);
    white += native;
    const auto* curve = static_cast<const cmsToneCurve*>(cmsReadTag(icc, channel.curve));
    if (curve == nullptr) return fail(path, channel.curve_name, "is damaged", "make the profile again");
    out.curves[k].resize(icc_curve_points);
    for (int i = 0; i < icc_curve_points; ++i)
      out.curves[k][static_cast<std::size_t>(i)] =
          cmsEvalToneCurveFloat(curve, static_cast<float>(i) / static_cast<float>(icc_curve_points - 1));
  }
  // The colorants' own sum, so that equal pixels stay grey whatever rounding the tags went through.
  out.white = chromaticity_of(white);
  out.source = path + " (" + description_of(icc) + ")";
  if (cmsIsTag(icc, cmsSigVcgtTag) != 0) out.source += "; its video card table (vcgt) is not applied";
  if (auto checked = check_profile(out, path); !checked) return tl::unexpected(checked.error());
  return out;
}

Result<void> check_profile(const DisplayProfile& profile, const std::string& file) {
  const auto measure = "use the values of a measured display";
  const std::array<std::pair<Chromaticity, const char*>, 4> points = {
      std::pair{profile.red, "red"}, std::pair{profile.green, "green"}, std::pair{profile.blue, "blue"},
      std::pair{profile.white, "white"}};
  for (const auto& [c, name] : points)
    // Deep red is x + y = 1, and rounded in files. The form of the question also refuses NaN.
    if (!(c.x >= 0.0 && c.y >= 1e-3 && c.x + c.y <= 1.001))
      return fail(file, name, "is not a chromaticity: x >= 0, y >= 0.001 and x + y <= 1", measure);
  const double area = cross(profile.red, profile.green, profile.blue);
  if (area < least_area)
    return fail(file, "primaries",
                area < -least_area ? "red, green and blue have changed places" : "lie on one line, or nearly so",
                measure);
  // Each of the three triangles with the white must turn the same way: then every primary has a positive share.
  const std::array<double, 3> shares = {cross(profile.white, profile.green, profile.blue),
                                        cross(profile.red, profile.white, profile.blue),
                                        cross(profile.red, profile.green, profile.white)};
  if (std::any_of(shares.begin(), shares.end(), [&](double s) { return s < 1e-3 * area; }))
    return fail(file, "white", "lies outside the primaries", measure);
  static constexpr std::array<const char*, 3> names = {"red curve", "green curve", "blue curve"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::vector<double>& curve = profile.curves[k];
    if (curve.empty()) continue;
    if (curve.size() < 2 || curve.size() > most_curve_points)
      return fail(file, names[k], std::to_string(curve.size()) + " points are not within 2 and 4096", measure);
    if (!std::all_of(curve.begin(), curve.end(), [](double v) { return v >= 0.0 && v <= 1.0; }))
      return fail(file, names[k], "has values outside [0, 1]", measure);
    if (!std::is_sorted(curve.begin(), curve.end())) return fail(file, names[k], "falls somewhere", measure);
    if (curve.back() - curve.front() < 0.5)
      return fail(file, names[k], "is nearly flat: less than half of the light between black and white", measure);
  }
  return {};
}

std::array<double, 9> panel_from_srgb(const DisplayProfile& profile) {
  const DisplayProfile srgb;
  const glm::dmat3 m =
      glm::inverse(xyz_from_rgb(profile)) * bradford(xyz_of(srgb.white), xyz_of(profile.white)) * xyz_from_rgb(srgb);
  std::array<double, 9> rows{};
  for (std::size_t k = 0; k < rows.size(); ++k)
    rows[k] = m[static_cast<glm::length_t>(k % 3)][static_cast<glm::length_t>(k / 3)];
  return rows;
}

GamutLoss gamut_loss(const DisplayProfile& profile, const std::vector<std::array<double, 3>>& colours,
                     double tolerance) {
  GamutLoss loss;
  if (colours.empty()) return loss;
  const std::array<double, 9> m = panel_from_srgb(profile);
  std::size_t lost = 0;
  for (const auto& c : colours) {
    double excess = 0.0;
    for (std::size_t row = 0; row < 9; row += 3) {
      const double v = m[row] * c[0] + m[row + 1] * c[1] + m[row + 2] * c[2];
      excess = std::max({excess, -v, v - 1.0});
    }
    loss.worst = std::max(loss.worst, excess);
    if (excess > tolerance) ++lost;
  }
  loss.share = static_cast<double>(lost) / static_cast<double>(colours.size());
  return loss;
}

}  // namespace lackwerk::kiosk
