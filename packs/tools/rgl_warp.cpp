#include "packs/tools/rgl_warp.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace lackwerk::packs {
namespace {

/// Part t of [0, 1] at which the integral of a linear density, `left` at 0 and `right` at 1, reaches `area`. In the
/// form that needs no special case for equal ends: t = 2 A / (l + sqrt(l^2 + 2 A (r - l))).
double solve_linear(double left, double right, double area) {
  const double root = std::sqrt(std::max(left * left + 2.0 * area * (right - left), 0.0));
  const double below = left + root;
  return below > 0.0 ? std::clamp(2.0 * area / below, 0.0, 1.0) : 0.0;
}

/// The integral of that density from 0 to t.
double linear_area(double left, double right, double t) { return t * (left + 0.5 * t * (right - left)); }

double mix(double a, double b, double t) { return (1.0 - t) * a + t * b; }

/// The last index k of [0, count - 2] with value(k) < x: the interval that x lies in.
template <class Value>
std::size_t interval(std::size_t count, double x, const Value& value) {
  std::size_t lower = 0, upper = count - 1;
  while (upper - lower > 1) {
    const std::size_t middle = (lower + upper) / 2;
    (value(middle) < x ? lower : upper) = middle;
  }
  return lower;
}

}  // namespace

RglSquare::RglSquare(std::vector<float> nodes, std::size_t width, std::size_t height,
                     std::vector<std::vector<float>> parameters)
    : width_(width), height_(height), nodes_(std::move(nodes)), parameters_(std::move(parameters)) {
  check_at_most(std::size_t{2}, std::min(width, height), "nodes of an RGL square");
  check_at_most(parameters_.size(), max_parameters, "parameters of an RGL square");
  std::size_t slices = 1;
  for (const auto& list : parameters_) slices *= list.size();
  check_equal(nodes_.size(), slices * width * height, "values of an RGL square");
}

RglSquare::Blend RglSquare::blend(std::span<const double> parameters) const {
  check_equal(parameters.size(), parameters_.size(), "parameters of an RGL square");
  Blend out;
  out.weight[0] = 1.0;
  out.count = 1;
  for (std::size_t k = 0; k < parameters_.size(); ++k) {
    const auto& list = parameters_[k];
    std::size_t lower = 0;
    double share = 0.0;
    if (list.size() > 1) {
      lower = interval(list.size(), parameters[k], [&](std::size_t at) { return static_cast<double>(list[at]); });
      const double from = static_cast<double>(list[lower]), to = static_cast<double>(list[lower + 1]);
      share = std::clamp((parameters[k] - from) / (to - from), 0.0, 1.0);
    }
    const std::size_t before = out.count;
    for (std::size_t at = 0; at < before; ++at) {
      const std::size_t slice = out.slice[at] * list.size() + lower;
      const double weight = out.weight[at];
      out.slice[at] = slice;
      out.weight[at] = weight * (1.0 - share);
      if (share > 0.0) {
        out.slice[out.count] = slice + 1;
        out.weight[out.count++] = weight * share;
      }
    }
  }
  return out;
}

RglSquare::Place RglSquare::place(const glm::dvec2& at) const {
  const double x = std::clamp(at.x, 0.0, 1.0) * static_cast<double>(width_ - 1),
               y = std::clamp(at.y, 0.0, 1.0) * static_cast<double>(height_ - 1);
  const std::size_t column = std::min(static_cast<std::size_t>(x), width_ - 2),
                    row = std::min(static_cast<std::size_t>(y), height_ - 2);
  return {column, row, x - static_cast<double>(column), y - static_cast<double>(row)};
}

double RglSquare::eval(const glm::dvec2& at, std::span<const double> parameters) const {
  const Blend slices = blend(parameters);
  const Place p = place(at);
  const std::size_t stride = width_ * height_, index = p.y * width_ + p.x;
  const auto node = [&](std::size_t offset) { return mixed(nodes_, slices, stride, index + offset); };
  return mix(mix(node(0), node(1), p.u), mix(node(width_), node(width_ + 1), p.u), p.v);
}

RglWarp::RglWarp(std::vector<float> nodes, std::size_t width, std::size_t height,
                 std::vector<std::vector<float>> parameters)
    : RglSquare(std::move(nodes), width, height, std::move(parameters)) {
  const std::size_t stride = width * height, slices = nodes_.size() / stride;
  conditional_.assign(nodes_.size(), 0.0);
  marginal_.assign(slices * height, 0.0);
  for (std::size_t slice = 0; slice < slices; ++slice) {
    double* rows = &conditional_[slice * stride];
    float* density = &nodes_[slice * stride];
    double* total = &marginal_[slice * height];
    for (std::size_t y = 0; y < height; ++y) {
      for (std::size_t k = y * width; k + 1 < (y + 1) * width; ++k)
        rows[k + 1] = rows[k] + 0.5 * (static_cast<double>(density[k]) + static_cast<double>(density[k + 1]));
    }
    for (std::size_t y = 0; y + 1 < height; ++y)
      total[y + 1] = total[y] + 0.5 * (rows[(y + 1) * width - 1] + rows[(y + 2) * width - 1]);
    const double sum = total[height - 1];
    has_empty_slice_ = has_empty_slice_ || !(sum > 0.0);
    const double scale = sum > 0.0 ? 1.0 / sum : 0.0;
    for (std::size_t k = 0; k < stride; ++k) {
      rows[k] *= scale;
      density[k] = static_cast<float>(static_cast<double>(density[k]) * scale);
    }
    for (std::size_t y = 0; y < height; ++y) total[y] *= scale;
  }
}

/// Everything about one blend that both directions of the warp need.
struct RglWarp::Row {
  const RglWarp& warp;
  const Blend slices;

  [[nodiscard]] double density(std::size_t x, std::size_t y, double v) const {
    const std::size_t stride = warp.width_ * warp.height_, index = y * warp.width_ + x;
    return mix(mixed(warp.nodes_, slices, stride, index), mixed(warp.nodes_, slices, stride, index + warp.width_), v);
  }
  [[nodiscard]] double conditional(std::size_t x, std::size_t y, double v) const {
    const std::size_t stride = warp.width_ * warp.height_, index = y * warp.width_ + x;
    return mix(mixed(warp.conditional_, slices, stride, index),
               mixed(warp.conditional_, slices, stride, index + warp.width_), v);
  }
  /// Of one row of nodes, the last one too: nothing is read beyond it.
  [[nodiscard]] double total(std::size_t y) const {
    const std::size_t stride = warp.width_ * warp.height_;
    return mixed(warp.conditional_, slices, stride, (y + 1) * warp.width_ - 1);
  }
  [[nodiscard]] double marginal(std::size_t y) const { return mixed(warp.marginal_, slices, warp.height_, y); }
};

glm::dvec2 RglWarp::invert(const glm::dvec2& at, std::span<const double> parameters) const {
  const Row row{*this, blend(parameters)};
  const Place p = place(at);
  const double all = row.conditional(width_ - 1, p.y, p.v);
  const double x =
      row.conditional(p.x, p.y, p.v) + linear_area(row.density(p.x, p.y, p.v), row.density(p.x + 1, p.y, p.v), p.u);
  const double y = row.marginal(p.y) + linear_area(row.total(p.y), row.total(p.y + 1), p.v);
  return {all > 0.0 ? std::clamp(x / all, 0.0, 1.0) : 0.0, std::clamp(y, 0.0, 1.0)};
}

glm::dvec2 RglWarp::sample(const glm::dvec2& uniform, std::span<const double> parameters) const {
  const Row row{*this, blend(parameters)};
  const std::size_t y = interval(height_, uniform.y, [&](std::size_t k) { return row.marginal(k); });
  const double v = solve_linear(row.total(y), row.total(y + 1), uniform.y - row.marginal(y));
  const double target = uniform.x * row.conditional(width_ - 1, y, v);
  const std::size_t x = interval(width_, target, [&](std::size_t k) { return row.conditional(k, y, v); });
  const double u = solve_linear(row.density(x, y, v), row.density(x + 1, y, v), target - row.conditional(x, y, v));
  return {(static_cast<double>(x) + u) / static_cast<double>(width_ - 1),
          (static_cast<double>(y) + v) / static_cast<double>(height_ - 1)};
}

}  // namespace lackwerk::packs
