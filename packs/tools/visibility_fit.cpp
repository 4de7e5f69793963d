#include "packs/tools/visibility_fit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/check.hpp"

namespace lackwerk::packs {
namespace {

constexpr double pi = 3.14159265358979323846;

// Mirror images at grazing angles are what one sees of a car's flanks: without this share they would hardly count.
constexpr double grazing_share = 0.15;
// Pulls what the hemisphere does not determine (a linear and a quadratic term look alike there) towards the mean.
// Smaller follows the rays better, but the bytes end at 2.
constexpr double ridge = 3e-3;
constexpr int refits = 8;

/// Factors that give each function a mean square of 1 over the sphere, so that the ridge has no favourite axis.
const std::array<double, 9> basis_scale = {1.0,
                                           std::sqrt(3.0),
                                           std::sqrt(3.0),
                                           std::sqrt(3.0),
                                           std::sqrt(15.0),
                                           std::sqrt(15.0),
                                           std::sqrt(15.0),
                                           0.5 * std::sqrt(15.0),
                                           0.5 * std::sqrt(5.0)};

std::array<double, 9> basis_at(const glm::dvec3& d) {
  std::array<double, 9> b = {
      1.0, d.x, d.y, d.z, d.x * d.y, d.y * d.z, d.z * d.x, d.x * d.x - d.y * d.y, 3.0 * d.z * d.z - 1.0};
  for (std::size_t j = 0; j < b.size(); ++j) b[j] *= basis_scale[j];
  return b;
}

using Matrix = std::array<std::array<double, 9>, 9>;

/// In place: the lower triangle becomes the Cholesky factor of a positive definite matrix.
void factorise(Matrix& a) {
  for (std::size_t j = 0; j < 9; ++j) {
    for (std::size_t k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
    a[j][j] = std::sqrt(a[j][j]);
    for (std::size_t i = j + 1; i < 9; ++i) {
      for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] /= a[j][j];
    }
  }
}

void solve(const Matrix& factor, std::array<double, 9>& x) {
  for (std::size_t i = 0; i < 9; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= factor[i][k] * x[k];
    x[i] /= factor[i][i];
  }
  for (std::size_t i = 9; i-- > 0;) {
    for (std::size_t k = i + 1; k < 9; ++k) x[i] -= factor[k][i] * x[k];
    x[i] /= factor[i][i];
  }
}

/// From the frame's axes to the scene's: the linear part is a vector, the quadratic one a symmetric matrix.
std::array<double, 9> turned(const std::array<double, 9>& c, const NormalFrame& frame) {
  const glm::dmat3 to_scene(frame.tangent, frame.bitangent, frame.normal);
  const glm::dvec3 linear = to_scene * glm::dvec3(c[1], c[2], c[3]);
  const glm::dmat3 local(glm::dvec3(c[7] - c[8], 0.5 * c[4], 0.5 * c[6]),
                         glm::dvec3(0.5 * c[4], -c[7] - c[8], 0.5 * c[5]),
                         glm::dvec3(0.5 * c[6], 0.5 * c[5], 2.0 * c[8]));
  const glm::dmat3 m = to_scene * local * glm::transpose(to_scene);
  return {c[0],          linear.x,      linear.y,      linear.z,
          2.0 * m[1][0], 2.0 * m[2][1], 2.0 * m[0][2], 0.5 * (m[0][0] - m[1][1]),
          0.5 * m[2][2]};
}

}  // namespace

NormalFrame frame_around(const glm::dvec3& normal) {
  // Frisvad 2012.
  if (normal.z < -0.99999) return {{0.0, -1.0, 0.0}, {-1.0, 0.0, 0.0}, normal};
  const double a = 1.0 / (1.0 + normal.z);
  const double b = -normal.x * normal.y * a;
  return {{1.0 - normal.x * normal.x * a, b, -normal.x}, {b, 1.0 - normal.y * normal.y * a, -normal.y}, normal};
}

std::array<double, 9> visibility_coefficients(const Visibility& visibility) {
  std::array<double, 9> out{};
  for (std::size_t j = 0; j < out.size(); ++j) out[j] = (visibility[j] - 128) / 64.0;
  return out;
}

Visibility quantised_visibility(const std::array<double, 9>& coefficients) {
  Visibility out{};
  for (std::size_t j = 0; j < out.size(); ++j)
    out[j] = static_cast<std::uint8_t>(std::clamp(std::lround(coefficients[j] * 64.0) + 128L, 0L, 255L));
  return out;
}

VisibilityFit::VisibilityFit(int rays) {
  check_at_most(1, rays, "rays of a visibility fit");
  check_at_most(rays, 65536, "rays of a visibility fit");
  constexpr double golden_angle = 2.39996322972865332;
  Matrix normal_matrix{};
  double share_sum = 0.0;
  for (int i = 0; i < rays; ++i) {
    // z by the inverse of the integral of (z + grazing_share), from the pole to the rim.
    const double u = 1.0 - (i + 0.5) / rays;
    const double z = std::sqrt(grazing_share * grazing_share + u * (1.0 + 2.0 * grazing_share)) - grazing_share;
    const double radius = std::sqrt(1.0 - z * z);
    const double angle = std::fmod(golden_angle * i, 2.0 * pi);
    rays_.push_back({{radius * std::cos(angle), radius * std::sin(angle), z}, z / (z + grazing_share)});
    share_sum += rays_.back().share;
    const std::array<double, 9> b = basis_at(rays_.back().direction);
    for (std::size_t j = 0; j < 9; ++j)
      for (std::size_t k = 0; k < 9; ++k) normal_matrix[j][k] += b[j] * b[k] / rays;
  }
  for (std::size_t j = 0; j < 9; ++j) normal_matrix[j][j] += ridge;
  factorise(normal_matrix);
  for (Ray& ray : rays_) {
    ray.share /= share_sum;
    const std::array<double, 9> b = basis_at(ray.direction);
    std::array<double, 9> column = b;
    for (double& value : column) value /= rays;
    solve(normal_matrix, column);
    std::array<float, 9> row{}, answer{};
    for (std::size_t j = 0; j < 9; ++j) {
      row[j] = static_cast<float>(b[j]);
      answer[j] = static_cast<float>(column[j]);
    }
    basis_.push_back(row);
    solver_.push_back(answer);
  }
}

Visibility VisibilityFit::fit(std::span<const float> seen, const NormalFrame& frame) const {
  check_equal(seen.size(), rays_.size(), "one value per ray");
  double sum = 0.0;
  for (const float value : seen) sum += static_cast<double>(value);
  if (sum == static_cast<double>(seen.size())) return open_visibility;  // exact: a sum of ones
  const auto mean = static_cast<float>(sum / static_cast<double>(seen.size()));
  std::array<float, 9> c{};
  for (int round = 0; round <= refits; ++round) {
    std::array<float, 9> next{};
    for (std::size_t i = 0; i < seen.size(); ++i) {
      float target = seen[i];
      if (round > 0 && (target >= 1.0f || target <= 0.0f)) {
        float value = mean;
        for (std::size_t j = 0; j < 9; ++j) value += c[j] * basis_[i][j];
        target = target >= 1.0f ? std::max(target, value) : std::min(target, value);
      }
      for (std::size_t j = 0; j < 9; ++j) next[j] += (target - mean) * solver_[i][j];
    }
    c = next;
  }
  std::array<double, 9> local{};
  for (std::size_t j = 0; j < 9; ++j) local[j] = static_cast<double>(c[j]) * basis_scale[j];
  local[0] += static_cast<double>(mean);
  return quantised_visibility(turned(local, frame));
}

}  // namespace lackwerk::packs
