#include "core/analysis/brdf_fit_report.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace lackwerk::core {
namespace {

/// How much worse a fit may get before somebody minds: the repeatability of a good goniometer.
constexpr double allowed_rms = 0.01;
/// Slack from which a parameter counts as not determined, as a part of its value; Fresnel values, which run from 0 to
/// 1 and mean little below a few percent, get this much at least.
constexpr double loose = 0.5, loose_f0 = 0.1;
/// Eigenvalues of a scaled J'J below this are rounding.
constexpr double singular = 1e-15;
/// A column is without effect if it moves the log errors by less than this per unit (m: per factor e) at all.
constexpr double no_effect = 1e-9;

class ErrorSum {
 public:
  void add(const glm::dvec3& e) {
    ++values_;
    for (int c = 0; c < 3; ++c) {
      sum_ += e[c];
      squares_ += e[c] * e[c];
      sizes_.push_back(static_cast<float>(std::abs(e[c])));
    }
  }
  [[nodiscard]] FitError result() {
    FitError out{values_, 0.0, 0.0, 0.0};
    if (values_ == 0) return out;
    const double n = static_cast<double>(sizes_.size());
    out.bias = sum_ / n;
    out.rms = std::sqrt(squares_ / n);
    const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.95 * n)) - 1;
    std::nth_element(sizes_.begin(), sizes_.begin() + rank, sizes_.end());
    out.p95 = static_cast<double>(sizes_[static_cast<std::size_t>(rank)]);
    return out;
  }

 private:
  std::size_t values_ = 0;
  double sum_ = 0.0, squares_ = 0.0;
  std::vector<float> sizes_;
};

class ErrorSums {
 public:
  explicit ErrorSums(const AnalyticPaint& paint) : paint_(paint), parameters_(parameters_of(layout_, paint)) {}

  void add(FitPoint point) {
    point.chi = chi_at(paint_, point.theta_h, point.theta_d);
    const glm::dvec3 e = log_error(point, model_at(layout_, parameters_.data(), point));
    regions_[static_cast<std::size_t>(point.region)].add(e);
    whole_.add(e);
  }
  [[nodiscard]] FitErrors result() {
    FitErrors out;
    for (std::size_t k = 0; k < regions_.size(); ++k) out.regions[k] = regions_[k].result();
    out.whole = whole_.result();
    return out;
  }

 private:
  const AnalyticPaint& paint_;
  FitLayout layout_;
  std::vector<double> parameters_;
  std::array<ErrorSum, fit_region_count> regions_;
  ErrorSum whole_;
};

bool is_f0(const FitLayout& layout, int parameter) {
  for (int k = 0; k < layout.lobes; ++k)
    if (parameter == layout.f0(k)) return true;
  return false;
}
bool is_ln_m(const FitLayout& layout, int parameter) {
  for (int k = 0; k < layout.lobes; ++k)
    if (parameter == layout.ln_m(k)) return true;
  return false;
}

bool at_bound(const FitLayout& layout, int parameter, double value) {
  constexpr double near = 1e-7;  // Ceres stops a little short of a bound it creeps along
  if (value <= layout.lower(parameter) + near) return true;
  return (is_f0(layout, parameter) || is_ln_m(layout, parameter)) && value >= layout.upper(parameter) - near;
}

/// J'J of the log errors.
Eigen::MatrixXd normal_matrix(const FitLayout& layout, std::span<const double> parameters,
                              std::span<const FitPoint> points) {
  const int n = layout.count();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  std::vector<double> jacobian(static_cast<std::size_t>(3 * n));
  for (const FitPoint& point : points) {
    const glm::dvec3 y = model_at(layout, parameters.data(), point, jacobian.data());
    for (int c = 0; c < 3; ++c) {
      const Eigen::VectorXd row =
          Eigen::Map<const Eigen::VectorXd>(jacobian.data() + static_cast<std::ptrdiff_t>(c) * n, n) /
          (point.dark + y[c]);
      sum.noalias() += row * row.transpose() * point.weight;
    }
  }
  return sum;
}

}  // namespace

FitErrors fit_errors(const AnalyticPaint& paint, std::span<const FitPoint> points) {
  ErrorSums sums(paint);
  for (const FitPoint& point : points) sums.add(point);
  return sums.result();
}

FitErrors fit_errors(const AnalyticPaint& paint, const BrdfTable& table, const std::vector<std::uint8_t>& filled,
                     const Brdf& known) {
  ErrorSums sums(paint);
  for (std::size_t cell = 0; cell < table.size().cells(); ++cell) {
    if (cell < filled.size() && filled[cell] != 0) continue;
    const auto value = table.value(cell);
    if (!value) continue;
    const DirectionPair pair = directions(table.middle(cell));
    if (pair.in.z < fit_min_cosine || pair.out.z < fit_min_cosine) continue;
    const glm::dvec3 known_part = known ? known(pair.in, pair.out) : glm::dvec3(0.0);
    sums.add(fit_point(BrdfSample{pair.in, pair.out, glm::dvec3(*value), 1.0, known_part}));
  }
  return sums.result();
}

const char* standing_name(Standing standing) {
  switch (standing) {
    case Standing::determined:
      return "determined";
    case Standing::undetermined:
      return "undetermined";
    case Standing::at_bound:
      return "at-bound";
    case Standing::without_effect:
      break;
  }
  return "without-effect";
}

FitCondition fit_condition(const FitLayout& layout, std::span<const double> parameters,
                           std::span<const FitPoint> points) {
  const Eigen::MatrixXd normal = normal_matrix(layout, parameters, points);
  const double count = 3.0 * static_cast<double>(points.size());
  FitCondition out;
  std::vector<Eigen::Index> free;
  for (int k = 0; k < layout.count(); ++k) {
    const double value = parameters[static_cast<std::size_t>(k)];
    FitParameter parameter{layout.name(k), is_ln_m(layout, k) ? std::exp(value) : value,
                           std::numeric_limits<double>::infinity(), Standing::determined};
    if (std::sqrt(normal(k, k) / std::max(count, 1.0)) < no_effect)
      parameter.standing = Standing::without_effect;
    else if (at_bound(layout, k, value))
      parameter.standing = Standing::at_bound;
    else
      free.push_back(k);
    out.parameters.push_back(parameter);
  }
  if (free.empty()) return out;
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd scaled(n, n);
  const auto length = [&](Eigen::Index k) {
    return std::sqrt(normal(free[static_cast<std::size_t>(k)], free[static_cast<std::size_t>(k)]));
  };
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      scaled(i, j) =
          normal(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]) / (length(i) * length(j));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  const double least = eigen.eigenvalues()[0], most = eigen.eigenvalues()[n - 1];
  out.number = least > singular * most ? most / least : std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < n; ++k) {
    double inverse = 0.0;  // of the diagonal of (J'J)^-1, scaled
    for (Eigen::Index e = 0; e < n; ++e) {
      const double part = eigen.eigenvectors()(k, e);
      inverse += part * part / std::max(eigen.eigenvalues()[e], singular * most);
    }
    FitParameter& parameter = out.parameters[static_cast<std::size_t>(free[static_cast<std::size_t>(k)])];
    const auto index = static_cast<int>(free[static_cast<std::size_t>(k)]);
    const double slack = allowed_rms * std::sqrt(count * inverse) / length(k);
    parameter.slack = is_ln_m(layout, index) ? slack * parameter.value : slack;
    const double unit = is_f0(layout, index) ? std::max(parameter.value, loose_f0) : parameter.value;
    if (!(parameter.slack < loose * unit)) parameter.standing = Standing::undetermined;
  }
  return out;
}

}  // namespace lackwerk::core
