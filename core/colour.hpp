// Colour: linear sRGB, CIE XYZ, CIE Lab for HDR values, CIEDE2000.
//
// Why it exists: statistics, transport and errors live in Lab, pictures in linear sRGB; each formula stands once,
// here (the shader has its own Lab decoding in paint_model.glsl, compiled as C++ and tested against this file).
// Pure functions; any thread. White is D65 at Y = 1, which is a radiance factor of 1 (a perfect white diffuser).
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace lackwerk::core {

/// IEC 61966-2-1 primaries with D65, row by row: XYZ = M * linear sRGB. Rows sum to the white point (below).
inline constexpr double rgb_to_xyz[3][3] = {
    {0.4123907992659595, 0.3575843393838780, 0.1804807884018343},
    {0.2126390058715104, 0.7151686787677559, 0.0721923153607337},
    {0.0193308187155918, 0.1191947797946259, 0.9505321522496608},
};
/// The inverse of the above, to the same digits.
inline constexpr double xyz_to_rgb[3][3] = {
    {3.2409699419045213, -1.5373831775700935, -0.4986107602930033},
    {-0.9692436362808798, 1.8759675015077206, 0.0415550574071756},
    {0.0556300796969936, -0.2039769588889765, 1.0569715142428784},
};
/// D65 as the sum of the rows above, so that R = G = B = 1 is exactly a = b = 0.
inline constexpr double white_xyz[3] = {0.9504559270516718, 1.0, 1.0890577507598784};

/// CIE 1976 constants in their exact form (CIE 15:2004): delta = 6/29.
inline constexpr double lab_delta = 6.0 / 29.0;

/// f(t) of CIE Lab. Below delta^3 it is the linear toe, which here also carries negative t (extrapolated colours).
template <class T>
[[nodiscard]] T lab_forward(T t) {
  constexpr T delta = T(lab_delta);
  return t > delta * delta * delta ? std::cbrt(t) : t / (T(3) * delta * delta) + T(4.0 / 29.0);
}
/// The inverse of lab_forward, for any real value.
template <class T>
[[nodiscard]] T lab_inverse(T f) {
  constexpr T delta = T(lab_delta);
  return f > delta ? f * f * f : T(3) * delta * delta * (f - T(4.0 / 29.0));
}

/// Linear sRGB (any sign, any size) to Lab with L in [.., 100 at white, far beyond for HDR].
template <class T>
[[nodiscard]] glm::vec<3, T> lab_from_linear(const glm::vec<3, T>& rgb) {
  T f[3];
  for (int row = 0; row < 3; ++row) {
    const T xyz = T(rgb_to_xyz[row][0]) * rgb.x + T(rgb_to_xyz[row][1]) * rgb.y + T(rgb_to_xyz[row][2]) * rgb.z;
    f[row] = lab_forward(xyz / T(white_xyz[row]));
  }
  return {T(116) * f[1] - T(16), T(500) * (f[0] - f[1]), T(200) * (f[1] - f[2])};
}

/// Lab to linear sRGB; may be negative outside the gamut.
template <class T>
[[nodiscard]] glm::vec<3, T> linear_from_lab(const glm::vec<3, T>& lab) {
  const T fy = (lab.x + T(16)) / T(116);
  const T xyz[3] = {lab_inverse(fy + lab.y / T(500)) * T(white_xyz[0]), lab_inverse(fy) * T(white_xyz[1]),
                    lab_inverse(fy - lab.z / T(200)) * T(white_xyz[2])};
  glm::vec<3, T> rgb;
  for (int row = 0; row < 3; ++row)
    rgb[row] = T(xyz_to_rgb[row][0]) * xyz[0] + T(xyz_to_rgb[row][1]) * xyz[1] + T(xyz_to_rgb[row][2]) * xyz[2];
  return rgb;
}

/// sRGB transfer function (IEC 61966-2-1), linear to encoded and back, both in [0, 1].
[[nodiscard]] double srgb_encode(double linear);
[[nodiscard]] double srgb_decode(double encoded);

/// CIEDE2000 colour difference with kL = kC = kH = 1 (CIE 142-2001; Sharma, Wu & Dalal 2005 for the hue cases).
[[nodiscard]] double ciede2000(const glm::dvec3& lab1, const glm::dvec3& lab2);

}  // namespace lackwerk::core
