// The paint model at emulated 16 bits: core::PaintModel's text with vectors of Half.
//
// Why it exists: many ES 2.0 GPUs have no highp in fragments, and glm's vectors accept only scalars that the standard
// calls floating. Values; any thread.
#pragma once

#include "core/paint_model.hpp"
#include "kiosk/tools/report/half.hpp"

namespace lackwerk::report {

struct Half2 {
  Half x, y;
  Half2() = default;
  explicit Half2(Half all) : x(all), y(all) {}
  Half2(Half x_, Half y_) : x(x_), y(y_) {}
};
struct Half3 {
  Half x, y, z;
  Half3() = default;
  explicit Half3(Half all) : x(all), y(all), z(all) {}
  Half3(Half x_, Half y_, Half z_) : x(x_), y(y_), z(z_) {}
};
struct Half4 {
  Half x, y, z, w;
  Half4() = default;
  explicit Half4(Half all) : x(all), y(all), z(all), w(all) {}
  Half4(Half x_, Half y_, Half z_, Half w_) : x(x_), y(y_), z(z_), w(w_) {}
};

inline Half2 operator+(Half2 a, Half2 b) { return {a.x + b.x, a.y + b.y}; }
inline Half2 operator-(Half2 a, Half2 b) { return {a.x - b.x, a.y - b.y}; }
inline Half2 operator*(Half2 a, Half2 b) { return {a.x * b.x, a.y * b.y}; }
inline Half2 operator*(Half2 a, Half b) { return {a.x * b, a.y * b}; }
inline Half3 operator+(Half3 a, Half3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Half3 operator-(Half3 a, Half3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Half3 operator*(Half3 a, Half3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Half3 operator*(Half3 a, Half b) { return {a.x * b, a.y * b, a.z * b}; }
inline Half3& operator+=(Half3& a, Half3 b) { return a = a + b; }
inline Half3& operator*=(Half3& a, Half3 b) { return a = a * b; }
inline Half4 operator+(Half4 a, Half4 b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
inline Half4 operator*(Half4 a, Half b) { return {a.x * b, a.y * b, a.z * b, a.w * b}; }

using HalfModel = core::PaintModel<Half, Half2, Half3, Half4>;

}  // namespace lackwerk::report
