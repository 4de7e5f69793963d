#include "core/analysis/brdf_fit_solve.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace lackwerk::core {
namespace {

/// 10 % in each of three channels.
constexpr double loss_scale = 0.1 * 1.7320508075688772;

/// Curvature of ln chi is held to this per node step of the table where data are thin; a node with one point of weight
/// 1 outweighs it a hundredfold.
constexpr double smoothness = 0.1;

class PointCost final : public ceres::CostFunction {
 public:
  PointCost(const FitLayout& layout, const FitPoint& point) : layout_(layout), point_(point) {
    set_num_residuals(3);
    mutable_parameter_block_sizes()->push_back(layout.count());
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    double* jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
    const glm::dvec3 y = model_at(layout_, parameters[0], point_, jacobian);
    const glm::dvec3 e = log_error(point_, y);
    const int n = layout_.count();
    for (int c = 0; c < 3; ++c) {
      residuals[c] = e[c];
      if (jacobian == nullptr) continue;
      for (int k = 0; k < n; ++k) jacobian[c * n + k] /= point_.dark + y[c];
    }
    return std::isfinite(e.x) && std::isfinite(e.y) && std::isfinite(e.z);
  }

 private:
  FitLayout layout_;
  const FitPoint& point_;
};

/// Soft-L1 times the point's weight. All losses of a problem share nothing, so that Ceres may own them.
ceres::LossFunction* loss_of(double weight) {
  return new ceres::ScaledLoss(new ceres::SoftLOneLoss(loss_scale), weight, ceres::TAKE_OWNERSHIP);
}

ceres::Solver::Options options_of(int most_iterations) {
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = most_iterations;
  options.function_tolerance = 1e-10;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-10;
  return options;
}

/// One channel of one point before a table: the four nodes' values are the parameters.
class TableCost final : public ceres::SizedCostFunction<1, 1, 1, 1, 1> {
 public:
  /// y = `base` * chi + `known`.
  TableCost(const TableTaps& taps, double base, double known, double dark, double target)
      : taps_(taps), base_(base), dark_(dark + known), log_target_(std::log(dark + target)) {}

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    double chi = 0.0;
    for (int k = 0; k < 4; ++k) chi += taps_.weight[k] * parameters[k][0];
    const double shown = base_ * chi + dark_;
    residuals[0] = std::log(shown) - log_target_;
    if (jacobians == nullptr) return true;
    for (int k = 0; k < 4; ++k)
      if (jacobians[k] != nullptr) jacobians[k][0] = base_ * taps_.weight[k] / shown;
    return true;
  }

 private:
  TableTaps taps_;
  double base_, dark_, log_target_;
};

class CurvatureCost final : public ceres::SizedCostFunction<1, 1, 1, 1> {
 public:
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    static constexpr std::array<double, 3> second = {smoothness, -2.0 * smoothness, smoothness};
    residuals[0] = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      residuals[0] += second[k] * parameters[k][0];
      if (jacobians != nullptr && jacobians[k] != nullptr) jacobians[k][0] = second[k];
    }
    return true;
  }
};

/// One channel of the table. The three channels share no parameter, so each is a problem of its own.
void solve_channel(const AnalyticPaint& paint, std::span<const FitPoint> points, std::uint16_t num_theta, int channel,
                   int most_iterations, std::vector<double>& nodes) {
  const FitLayout layout;
  const std::vector<double> parameters = parameters_of(layout, paint);
  ceres::Problem problem;
  for (const FitPoint& point : points) {
    FitPoint bare = point;
    bare.chi = glm::dvec3(1.0);
    bare.known = glm::dvec3(0.0);
    const double base = model_at(layout, parameters.data(), bare)[channel];
    if (!(base > 0.0)) continue;
    const TableTaps taps = table_taps(num_theta, point.theta_h, point.theta_d);
    problem.AddResidualBlock(new TableCost(taps, base, point.known[channel], point.dark, point.target[channel]),
                             loss_of(point.weight), &nodes[taps.node[0]], &nodes[taps.node[1]], &nodes[taps.node[2]],
                             &nodes[taps.node[3]]);
  }
  const std::size_t n = num_theta;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t h = 0; h < n; ++h) {
      double* at = &nodes[i * n + h];
      if (h + 2 < n) problem.AddResidualBlock(new CurvatureCost, nullptr, at, at + 1, at + 2);
      if (i + 2 < n) problem.AddResidualBlock(new CurvatureCost, nullptr, at, at + n, at + 2 * n);
    }
  }
  for (double& node : nodes) {
    problem.SetParameterLowerBound(&node, 0, 0.0);
    problem.SetParameterUpperBound(&node, 0, max_fitted_chi);
  }
  ceres::Solver::Options options = options_of(most_iterations);
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.function_tolerance = 1e-4;  // a table is smoothed anyway
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
}

}  // namespace

LobeSolution solve_lobes(const FitLayout& layout, std::span<const FitPoint> points, std::vector<double> start,
                         int most_iterations) {
  LobeSolution out{std::move(start), 0.0, 0, false};
  for (int k = 0; k < layout.count(); ++k) {
    double& value = out.parameters[static_cast<std::size_t>(k)];
    value = std::clamp(value, layout.lower(k), layout.upper(k));
  }
  ceres::Problem problem;
  for (const FitPoint& point : points)
    problem.AddResidualBlock(new PointCost(layout, point), loss_of(point.weight), out.parameters.data());
  for (int k = 0; k < layout.count(); ++k) {
    problem.SetParameterLowerBound(out.parameters.data(), k, layout.lower(k));
    problem.SetParameterUpperBound(out.parameters.data(), k, layout.upper(k));
  }
  ceres::Solver::Options options = options_of(most_iterations);
  options.linear_solver_type = ceres::DENSE_QR;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  out.cost = summary.final_cost;
  out.iterations = static_cast<int>(summary.iterations.size());
  out.has_converged = summary.termination_type == ceres::CONVERGENCE;
  return out;
}

ColourTable solve_table(const AnalyticPaint& paint, std::span<const FitPoint> points, std::uint16_t num_theta,
                        int most_iterations) {
  ColourTable table{num_theta, std::vector<glm::vec3>(std::size_t{num_theta} * num_theta, glm::vec3(1.0f))};
  if (paint.table && paint.table->num_theta == num_theta) table = *paint.table;
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<double> nodes(table.linear.size());
    for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] = static_cast<double>(table.linear[k][channel]);
    solve_channel(paint, points, num_theta, channel, most_iterations, nodes);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      table.linear[k][channel] = static_cast<float>(std::clamp(nodes[k], 0.0, max_fitted_chi));
  }
  return table;
}

}  // namespace lackwerk::core
