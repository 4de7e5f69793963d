#include "core/analysis/reference_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace lackwerk::core {

using glm::dvec2;
using glm::dvec3;
using std::numbers::pi;

ReferenceFrame::ReferenceFrame(const dvec3& n) : z(n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  x = {1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  y = {b, sign + n.y * n.y * a, -n.y};
}

double half_vector_pdf(double cos_h, double m) {
  if (cos_h <= 0.0) return 0.0;
  const double cos2 = cos_h * cos_h, m2 = m * m;
  const double tan2 = std::max(1.0 - cos2, 0.0) / cos2;
  if (tan2 > 700.0 * m2) return 0.0;  // exp(-700) is the smallest power of e a double still holds
  return std::exp(-tan2 / m2) / (pi * m2 * cos2 * cos_h);
}

dvec3 sample_half_vector(const dvec2& u, double m) {
  const double tangent = m * std::sqrt(-std::log1p(-u.x));
  const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
  const double phi = 2.0 * pi * u.y;
  return {tangent * cosine * std::cos(phi), tangent * cosine * std::sin(phi), cosine};
}

dvec3 refracted_in(const dvec3& d, const dvec3& n, double eta) {
  const double c = glm::dot(n, d);
  const double cos2 = 1.0 - (1.0 - c * c) / (eta * eta);
  return (d - n * c) / eta + n * std::sqrt(std::max(cos2, 0.0));
}

std::optional<dvec3> refracted_out(const dvec3& d, const dvec3& n, double eta) {
  if (eta == 1.0) return d;
  const double c = glm::dot(n, d);
  const double cos2 = 1.0 - (1.0 - c * c) * (eta * eta);
  if (cos2 <= 0.0) return std::nullopt;
  return (d - n * c) * eta + n * std::sqrt(cos2);
}

LobeSampler::LobeSampler(const dvec3& n, const dvec3& o, double eta)
    : frame_(n), inside_(refracted_in(o, n, eta)), eta_(eta) {}

std::optional<dvec3> LobeSampler::sample(const dvec2& u, double m) const {
  const dvec3 h = frame_.to_world(sample_half_vector(u, m));
  const double ho = glm::dot(h, inside_);
  const dvec3 i = h * (2.0 * ho) - inside_;
  if (ho <= 0.0 || glm::dot(frame_.z, i) <= 0.0) return std::nullopt;
  return refracted_out(i, frame_.z, eta_);
}

LobeSampler::Target LobeSampler::target(const dvec3& i) const {
  const double outside = glm::dot(frame_.z, i);
  if (outside <= 0.0) return {};
  const dvec3 in = refracted_in(i, frame_.z, eta_);
  const dvec3 sum = in + inside_;
  const double length = glm::length(sum);
  if (length <= 0.0) return {};
  const double cos_h = glm::dot(frame_.z, sum) / length;
  // h.o = |i + o| / 2.
  const double mirrored = 1.0 / (2.0 * length);
  return {std::min(cos_h, 1.0), mirrored * outside / (eta_ * eta_ * glm::dot(frame_.z, in))};
}

dvec3 sample_cosine(const ReferenceFrame& frame, const dvec2& u) {
  const double radius = std::sqrt(u.x), phi = 2.0 * pi * u.y;
  return frame.to_world({radius * std::cos(phi), radius * std::sin(phi), std::sqrt(std::max(1.0 - u.x, 0.0))});
}

}  // namespace lackwerk::core
