#include "core/analysis/brdf_fit_start.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/colour.hpp"

namespace lackwerk::core {
namespace {

/// From min_roughness to 1 in even steps of ln m: 1.64 apart, so that the nearest is at most 28 % off.
constexpr int grid_size = 15;
double grid_m(int k) { return std::pow(min_roughness, 1.0 - static_cast<double>(k) / (grid_size - 1)); }

/// Least squares takes this many tuples to the judgement by the fit's own error.
constexpr std::size_t shortlist = 60;
/// Schlick's value of a lobe that shows only at grazing angles is started here: at 0 its s would not show either.
constexpr double least_f0 = 0.02;

using Tuple = std::array<int, max_lobes>;

double luminance(const glm::dvec3& v) {
  return rgb_to_xyz[1][0] * v.x + rgb_to_xyz[1][1] * v.y + rgb_to_xyz[1][2] * v.z;
}

/// min x'Gx/2 - b'x over x >= 0 (Lawson & Hanson 1974, algorithm 23.10, on normal equations).
Eigen::VectorXd non_negative(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right) {
  const Eigen::Index n = right.size();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  std::vector<Eigen::Index> free;
  // Some columns are multiples of each other (a lobe and the diffuse part at m = 1): a ridge of 1e-12 decides.
  const auto solve_free = [&] {
    Eigen::MatrixXd part(free.size(), free.size());
    Eigen::VectorXd r(free.size());
    for (std::size_t i = 0; i < free.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      r[row] = right[free[i]];
      for (std::size_t j = 0; j < free.size(); ++j) part(row, static_cast<Eigen::Index>(j)) = gram(free[i], free[j]);
      part(row, row) *= 1.0 + 1e-12;
    }
    return Eigen::VectorXd(part.ldlt().solve(r));
  };
  for (Eigen::Index round = 0; round < 3 * n; ++round) {
    const Eigen::VectorXd gradient = right - gram * x;
    Eigen::Index best = -1;
    double most = 1e-10;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (gram(k, k) <= 0.0 || std::find(free.begin(), free.end(), k) != free.end()) continue;
      const double gain = gradient[k] / std::sqrt(gram(k, k));
      if (gain > most * std::sqrt(std::abs(right[k]) + 1.0)) most = gain, best = k;
    }
    if (best < 0) break;
    free.push_back(best);
    while (!free.empty()) {
      const Eigen::VectorXd wanted = solve_free();
      double step = 1.0;
      for (std::size_t i = 0; i < free.size(); ++i) {
        const double now = x[free[i]], to = wanted[static_cast<Eigen::Index>(i)];
        if (to <= 0.0) step = std::min(step, now > to ? now / (now - to) : 0.0);
      }
      for (std::size_t i = 0; i < free.size(); ++i)
        x[free[i]] += step * (wanted[static_cast<Eigen::Index>(i)] - x[free[i]]);
      if (step >= 1.0) break;
      std::erase_if(free, [&](Eigen::Index k) {
        if (x[k] > 1e-300) return false;
        x[k] = 0.0;
        return true;
      });
    }
  }
  return x;
}

/// The grid's normal equations: column 0 is the diffuse part, then per roughness the two halves of a lobe.
struct Normal {
  Eigen::MatrixXd gram;
  Eigen::VectorXd right;
  double total = 0.0;  ///< sum of squares of the right side
};

Normal grid_equations(std::span<const FitPoint> points) {
  constexpr int columns = 1 + 2 * grid_size;
  Eigen::MatrixXd rows(points.size(), columns);
  Eigen::VectorXd right(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const FitPoint& p = points[k];
    const auto row = static_cast<Eigen::Index>(k);
    const double y = luminance(p.target);
    const double scale = std::sqrt(p.weight) / (p.dark + y);
    const double base = scale * p.scale * luminance(p.chi);
    rows(row, 0) = base;
    for (int m = 0; m < grid_size; ++m) {
      const double shape = base * lobe_at(p, grid_m(m)).shape;
      rows(row, 1 + 2 * m) = shape * (1.0 - p.schlick);
      rows(row, 2 + 2 * m) = shape * p.schlick;
    }
    right[row] = scale * std::max(0.0, y - luminance(p.known));
  }
  return {rows.transpose() * rows, rows.transpose() * right, right.squaredNorm()};
}

struct Candidate {
  Tuple tuple{};
  std::array<double, max_lobes> f0{};
  double error = 0.0;
};

Candidate candidate(const Normal& normal, const Tuple& tuple, int lobes) {
  const int n = 1 + 2 * lobes;
  std::array<Eigen::Index, 1 + 2 * max_lobes> column{};
  for (int k = 0; k < lobes; ++k) {
    const auto at = static_cast<std::size_t>(k);
    column[1 + 2 * at] = 1 + 2 * tuple[at];
    column[2 + 2 * at] = 2 + 2 * tuple[at];
  }
  Eigen::MatrixXd gram(n, n);
  Eigen::VectorXd right(n);
  for (int i = 0; i < n; ++i) {
    right[i] = normal.right[column[static_cast<std::size_t>(i)]];
    for (int j = 0; j < n; ++j)
      gram(i, j) = normal.gram(column[static_cast<std::size_t>(i)], column[static_cast<std::size_t>(j)]);
  }
  const Eigen::VectorXd x = non_negative(gram, right);
  Candidate out{tuple, {}, normal.total - 2.0 * right.dot(x) + x.dot(gram * x)};
  for (int k = 0; k < lobes; ++k) {
    const double u = x[1 + 2 * k], v = x[2 + 2 * k];
    out.f0[static_cast<std::size_t>(k)] = v > u ? std::max(least_f0, u / v) : 1.0;
  }
  return out;
}

/// All tuples of different grid roughnesses, falling.
std::vector<Tuple> tuples(int lobes) {
  std::vector<Tuple> out;
  if (lobes == 0) return {Tuple{}};
  for (int a = grid_size - 1; a >= 0; --a) {
    if (lobes == 1) out.push_back({a, 0, 0});
    for (int b = a - 1; b >= 0 && lobes > 1; --b) {
      if (lobes == 2) out.push_back({a, b, 0});
      for (int c = b - 1; c >= 0 && lobes > 2; --c) out.push_back({a, b, c});
    }
  }
  return out;
}

/// The weights of all channels for given roughnesses and Fresnel values.
std::vector<double> with_weights(const FitLayout& layout, std::span<const FitPoint> points, const Candidate& from) {
  std::vector<double> out(static_cast<std::size_t>(layout.count()), 0.0);
  for (int k = 0; k < layout.lobes; ++k) {
    out[static_cast<std::size_t>(layout.ln_m(k))] = std::log(grid_m(from.tuple[static_cast<std::size_t>(k)]));
    out[static_cast<std::size_t>(layout.f0(k))] = from.f0[static_cast<std::size_t>(k)];
  }
  const int n = 1 + layout.lobes;
  std::vector<Eigen::MatrixXd> gram(static_cast<std::size_t>(layout.channels), Eigen::MatrixXd::Zero(n, n));
  std::vector<Eigen::VectorXd> right(static_cast<std::size_t>(layout.channels), Eigen::VectorXd::Zero(n));
  Eigen::VectorXd row(n);
  for (const FitPoint& p : points) {
    Eigen::VectorXd shape(n);
    shape[0] = 1.0;
    for (int k = 0; k < layout.lobes; ++k) {
      const double f0 = from.f0[static_cast<std::size_t>(k)];
      shape[1 + k] = lobe_at(p, grid_m(from.tuple[static_cast<std::size_t>(k)])).shape * (f0 + (1.0 - f0) * p.schlick);
    }
    for (int c = 0; c < 3; ++c) {
      const auto at = static_cast<std::size_t>(layout.channels == 1 ? 0 : c);
      const double scale = std::sqrt(p.weight) / (p.dark + p.target[c]);
      row = shape * (scale * p.scale * p.chi[c]);
      gram[at].noalias() += row * row.transpose();
      right[at] += row * (scale * std::max(0.0, p.target[c] - p.known[c]));
    }
  }
  for (int c = 0; c < layout.channels; ++c) {
    const Eigen::VectorXd x = non_negative(gram[static_cast<std::size_t>(c)], right[static_cast<std::size_t>(c)]);
    out[static_cast<std::size_t>(c)] = x[0];
    for (int k = 0; k < layout.lobes; ++k) out[static_cast<std::size_t>(layout.s(k, c))] = x[1 + k];
  }
  return out;
}

/// L1 of the log error: what least squares is judged by.
double judged(const FitLayout& layout, std::span<const FitPoint> points, const std::vector<double>& parameters) {
  double sum = 0.0;
  for (const FitPoint& p : points) {
    const glm::dvec3 e = log_error(p, model_at(layout, parameters.data(), p));
    sum += p.weight * (std::abs(e.x) + std::abs(e.y) + std::abs(e.z));
  }
  return sum;
}

bool is_near(const Tuple& a, const Tuple& b, int lobes) {
  for (int k = 0; k < lobes; ++k)
    if (std::abs(a[static_cast<std::size_t>(k)] - b[static_cast<std::size_t>(k)]) > 1) return false;
  return true;
}

}  // namespace

std::vector<std::vector<double>> fit_starts(const FitLayout& layout, std::span<const FitPoint> points, int count) {
  const Normal normal = grid_equations(points);
  std::vector<Candidate> all;
  for (const Tuple& tuple : tuples(layout.lobes)) all.push_back(candidate(normal, tuple, layout.lobes));
  const auto by_error = [](const Candidate& a, const Candidate& b) { return a.error < b.error; };
  std::stable_sort(all.begin(), all.end(), by_error);
  if (all.size() > shortlist) all.resize(shortlist);
  std::vector<std::vector<double>> parameters;
  for (Candidate& c : all) {
    parameters.push_back(with_weights(layout, points, c));
    c.error = judged(layout, points, parameters.back());
  }
  std::vector<std::size_t> order(all.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return all[a].error < all[b].error; });
  std::vector<std::vector<double>> starts;
  std::vector<Tuple> taken;
  for (const std::size_t k : order) {
    const auto near = [&](const Tuple& t) { return is_near(t, all[k].tuple, layout.lobes); };
    if (std::any_of(taken.begin(), taken.end(), near)) continue;
    taken.push_back(all[k].tuple);
    starts.push_back(parameters[k]);
    if (starts.size() >= static_cast<std::size_t>(std::max(1, count))) break;
  }
  return starts;
}

}  // namespace lackwerk::core
