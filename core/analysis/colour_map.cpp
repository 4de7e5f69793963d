#include "core/analysis/colour_map.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "core/check.hpp"
#include "core/colour.hpp"

namespace lackwerk::core {

using glm::dvec2;
using glm::dvec3;
using std::numbers::pi;

namespace {

constexpr double quarter = pi / 2.0;
constexpr double degree = pi / 180.0;

bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// ---- places and nodes

double to_grid(double versine, MapSpacing spacing) {
  return spacing == MapSpacing::cosine ? versine : std::sqrt(versine);
}
double angle_of_grid(double grid, MapSpacing spacing) {
  const double half_sine = spacing == MapSpacing::cosine ? std::sqrt(0.5 * grid) : grid * std::sqrt(0.5);
  return 2.0 * std::asin(std::min(half_sine, std::sqrt(0.5)));
}

/// What a node reads: the gloss line is light = eye, which the cut keeps at its distance with light + eye unchanged.
InPlane read_at(InPlane node, const ColourMapSettings& settings) {
  const double aspecular = node.light - node.eye;
  if (std::abs(aspecular) < settings.gloss_cut) {
    const double middle = 0.5 * (node.light + node.eye), apart = std::copysign(0.5 * settings.gloss_cut, aspecular);
    node = {middle + apart, middle - apart};
    // Near the normal, the reading with light and eye exchanged sides is the same one.
    if (node.light < 0.0) node = {-node.light, -node.eye};
  }
  node.light = std::min(node.light, settings.steepest);
  node.eye = std::clamp(node.eye, -settings.steepest, settings.steepest);
  return node;
}

dvec3 reading(const Brdf& brdf, const ColourMapSettings& settings, const dvec3& in, const dvec3& out) {
  dvec3 factor = brdf(in, out) * pi;
  if (settings.gloss) factor -= settings.gloss(in, out) * pi;
  if (settings.carrier) factor /= settings.carrier(in, out);
  return factor;
}

/// Index of a node in a map this wide.
std::size_t node_at(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

/// Holes take the mean of their filled neighbours, ring by ring.
bool fill(std::vector<dvec3>& nodes, int width, int height) {
  for (;;) {
    std::vector<std::pair<std::size_t, dvec3>> found;
    bool holes = false;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::size_t at = node_at(x, y, width);
        if (finite(nodes[at])) continue;
        holes = true;
        dvec3 sum(0.0);
        int count = 0;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
            if (const dvec3& near = nodes[node_at(u, v, width)]; finite(near)) {
              sum += near;
              ++count;
            }
        if (count > 0) found.emplace_back(at, sum / static_cast<double>(count));
      }
    if (!holes) return true;
    if (found.empty()) return false;
    for (const auto& [at, value] : found) nodes[at] = value;
  }
}

Result<void> check_settings(const ColourMapSettings& settings) {
  const auto bad = [](std::string field, std::string remedy) {
    return fail("", std::move(field), "is out of range", std::move(remedy), ErrorKind::usage);
  };
  if (settings.edge < 2 || settings.edge > 1024) return bad("edge", "give [2, 1024] nodes");
  if (!(settings.index >= 1.0 && settings.index <= 2.5)) return bad("index", "give [1, 2.5]");
  if (!(settings.gloss_cut >= 0.0 && settings.gloss_cut < quarter)) return bad("gloss_cut", "give [0, 90) degrees");
  if (!(settings.steepest > 0.0 && settings.steepest < quarter)) return bad("steepest", "give (0, 90) degrees");
  return {};
}

}  // namespace

Result<ColourMap> colour_map_of(const Brdf& brdf, const ColourMapSettings& settings) {
  if (auto good = check_settings(settings); !good) return tl::unexpected(good.error());
  const int edge = static_cast<int>(settings.edge), height = 2 * edge - 1;
  std::vector<dvec3> nodes(static_cast<std::size_t>(edge * height));
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < edge; ++column) {
      const double eye = angle_of_grid(std::abs(row - (edge - 1)) / (edge - 1.0), settings.spacing);
      const InPlane node{angle_of_grid(column / (edge - 1.0), settings.spacing), row < edge - 1 ? -eye : eye};
      const InPlaneDirections at = in_plane_directions(read_at(node, settings));
      const dvec3 forth = reading(brdf, settings, at.in, at.out), back = reading(brdf, settings, at.out, at.in);
      const dvec3 mean = finite(forth) && finite(back) ? 0.5 * (forth + back) : finite(forth) ? forth : back;
      // max(NaN, 0) would be 0: a hole stays one.
      nodes[node_at(column, row, edge)] = finite(mean) ? glm::max(mean, dvec3(0.0)) : mean;
    }
  if (!fill(nodes, edge, height))
    return fail("", "colour map", "the BRDF has no finite value in the plane of incidence", "measure in the plane");
  ColourMap map;
  map.settings_ = settings;
  map.nodes_.assign(nodes.begin(), nodes.end());
  return map;
}

dvec3 ColourMap::at_place(const dvec2& place) const {
  const auto last = static_cast<double>(settings_.edge - 1);
  const double x = to_grid(std::clamp(place.x, 0.0, 1.0), settings_.spacing) * last;
  const double y = to_grid(std::min(std::abs(place.y), 1.0), settings_.spacing) * (place.y < 0.0 ? -last : last) + last;
  const auto left = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(settings_.edge - 2));
  const auto low = std::min(static_cast<std::size_t>(y), static_cast<std::size_t>(height() - 2));
  const double u = x - static_cast<double>(left), v = y - static_cast<double>(low);
  const auto node = [&](std::size_t column, std::size_t row) { return dvec3(nodes_[row * width() + column]); };
  return (node(left, low) * (1.0 - u) + node(left + 1, low) * u) * (1.0 - v) +
         (node(left, low + 1) * (1.0 - u) + node(left + 1, low + 1) * u) * v;
}

dvec3 ColourMap::factor(const dvec3& in, const dvec3& out) const {
  const dvec3 stored = at_place(map_place(in, out, settings_.index, settings_.cure));
  return settings_.carrier ? stored * settings_.carrier(in, out) : stored;
}

// ---- from readings

namespace {

/// Mean dE*ab of 12 in-plane readings (light at 15, 45 and 65 degrees) against the whole BRDF, over 19 recipes and 6
/// measured materials: 5.4, 5.0, 4.9, 5.0, 5.3, 6.4, 10.8 at 0.03, 0.06, 0.1, 0.15, 0.2, 0.35, 1.
constexpr double inc_weight = 0.15;

/// Where a flake stands, in radians, with theta_inc shortened: distances here are differences of colour.
dvec2 flake_place(const FlakeAngles& flake) { return {flake.theta_flake, inc_weight * flake.theta_inc}; }

struct Kriging {
  std::vector<dvec2> at;
  std::vector<dvec3> weight;
  dvec3 base{0.0};

  [[nodiscard]] dvec3 lab(const dvec2& place) const {
    dvec3 sum = base;
    for (std::size_t k = 0; k < at.size(); ++k) sum += weight[k] * glm::length(place - at[k]);
    return sum;
  }
};

/// Solves [D 1; 1^T 0] [w; base] = [values; 0] with D the distances: one linear system, three right sides. Distances
/// between distinct points are conditionally negative definite (Schoenberg 1938; Micchelli 1986), so it has a solution.
Kriging solve(std::vector<dvec2> at, const std::vector<dvec3>& values) {
  const auto n = static_cast<Eigen::Index>(at.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Ones(n + 1, n + 1);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n + 1, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      a(i, j) = glm::length(at[static_cast<std::size_t>(i)] - at[static_cast<std::size_t>(j)]);
    for (int c = 0; c < 3; ++c) b(i, c) = values[static_cast<std::size_t>(i)][c];
  }
  a(n, n) = 0.0;
  const Eigen::MatrixXd x = a.partialPivLu().solve(b);
  Kriging out{std::move(at), {}, {x(n, 0), x(n, 1), x(n, 2)}};
  for (Eigen::Index i = 0; i < n; ++i) out.weight.emplace_back(x(i, 0), x(i, 1), x(i, 2));
  return out;
}

}  // namespace

Result<Brdf> brdf_of_readings(std::span<const InPlaneReading> readings, double index) {
  if (!(index >= 1.0 && index <= 2.5)) return fail("", "index", "is out of range", "give [1, 2.5]", ErrorKind::usage);
  if (readings.size() > max_readings)
    return fail("", "readings", "are " + std::to_string(readings.size()),
                "give at most " + std::to_string(max_readings));
  // Readings nearer than 0.001 degrees are one flake geometry: told by their rounded angles.
  struct Sum {
    dvec2 at{0.0};
    dvec3 lab{0.0};
    double count = 0.0;
  };
  std::map<std::pair<long, long>, Sum> places;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const InPlaneReading& one = readings[k];
    const std::string name = "reading " + std::to_string(k + 1);
    if (!finite(one.lab)) return fail("", name, "is not a number", "leave it out");
    if (!(one.at.light >= 0.0 && one.at.light < quarter && std::abs(one.at.eye) < quarter))
      return fail("", name, "lies below the horizon", "give angles below 90 degrees from the normal");
    const InPlaneDirections at = in_plane_directions(one.at);
    const dvec2 place = flake_place(flake_angles(at.in, at.out, index));
    Sum& sum = places[{std::lround(place.x / (1e-3 * degree)), std::lround(place.y / (1e-3 * degree))}];
    sum.at += place;
    sum.lab += one.lab;
    sum.count += 1.0;
  }
  if (places.size() < 2)
    return fail("", "readings", "have " + std::to_string(places.size()) + " different flake geometries",
                "measure at 2 angles at least; 6 tell a metallic paint");
  std::vector<dvec2> at;
  std::vector<dvec3> lab;
  for (const auto& [key, sum] : places) {
    at.push_back(sum.at / sum.count);
    lab.push_back(sum.lab / sum.count);
  }
  auto kriging = std::make_shared<const Kriging>(solve(std::move(at), lab));
  return Brdf([kriging, index](const dvec3& in, const dvec3& out) {
    return glm::max(linear_from_lab(kriging->lab(flake_place(flake_angles(in, out, index)))), dvec3(0.0)) / pi;
  });
}

// ---- comparing

namespace {

dvec3 direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

ColourError summary(std::vector<double> errors) {
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  double sum = 0.0;
  for (const double e : errors) sum += e;
  const auto at95 = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(errors.size()))) - 1;
  return {sum / static_cast<double>(errors.size()), errors[at95], errors.back()};
}

}  // namespace

BrdfComparison compare(const Brdf& a, const Brdf& b, const GeometryGrid& grid) {
  check_at_most(0.1, grid.polar_step, "polar step of a comparison");
  check_at_most(0.1, grid.azimuth_step, "azimuth step of a comparison");
  check_at_most(grid.steepest, 90.0, "steepest angle of a comparison");
  const auto steps = [](double last, double step) { return static_cast<int>(std::floor(last / step + 1e-9)); };
  const int polar = steps(grid.steepest, grid.polar_step), azimuth = steps(180.0, grid.azimuth_step);
  BrdfComparison out;
  std::vector<double> ab, e2000;
  for (int i = 0; i <= polar; ++i)
    for (int j = 0; j <= polar; ++j)
      for (int k = 0; k <= azimuth; ++k) {
        const double phi = k * grid.azimuth_step;
        const bool in_plane = i == 0 || j == 0 || k == 0 || phi > 180.0 - 1e-9;
        const dvec3 in = direction(i * grid.polar_step * degree, 0.0);
        const dvec3 eye = direction(j * grid.polar_step * degree, phi * degree);
        const double mirrored = glm::dot(dvec3(-in.x, -in.y, in.z), eye);
        const double aspecular = std::acos(std::clamp(mirrored, -1.0, 1.0)) / degree;
        const dvec3 fa = a(in, eye), fb = b(in, eye);
        if ((in_plane && !grid.in_plane) || aspecular < grid.least_aspecular || (grid.keep && !grid.keep(in, eye)) ||
            !finite(fa) || !finite(fb)) {
          ++out.left_out;
          continue;
        }
        const dvec3 lab_a = lab_from_linear(fa * pi), lab_b = lab_from_linear(fb * pi);
        ab.push_back(glm::length(lab_a - lab_b));
        e2000.push_back(ciede2000(lab_a, lab_b));
      }
  out.geometries = ab.size();
  out.ab = summary(std::move(ab));
  out.e2000 = summary(std::move(e2000));
  return out;
}

}  // namespace lackwerk::core
