#include "kiosk/tools/report/transport_cases.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <utility>

namespace lackwerk::report {

namespace {

constexpr std::int64_t texels = 480 * 480;

void add(std::vector<TransportCase>& cases, const char* name, const MassCloud& from, const MassCloud& to) {
  TransportCase made;
  made.name = name;
  made.from = from;
  made.to = to;
  cases.push_back(std::move(made));
}

MassCloud lattice(double shift) {
  MassCloud out;
  for (int i = 0; i < 64; ++i) {
    const int layer = i / 16;
    out.centres.emplace_back(i % 4 + shift, i / 4 % 4 + shift, layer + shift);
    out.mass.push_back(texels / 64);
  }
  return out;
}

MassCloud moved(MassCloud cloud, const glm::dvec3& by) {
  for (glm::dvec3& centre : cloud.centres) centre += by;
  return cloud;
}

}  // namespace

MassCloud flake_like_cloud(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  MassCloud out;
  std::int64_t left = texels;
  for (std::size_t i = 0; i < count; ++i) {
    const double light = 250.0 * std::pow(uniform(), 3.0);
    out.centres.emplace_back(light, 0.05 * light + 4.0 * uniform(), 0.02 * light + 4.0 * uniform());
    const auto others = static_cast<std::int64_t>(count - 1 - i);
    const std::int64_t share =
        others == 0 ? left : 1 + static_cast<std::int64_t>(0.2 * uniform() * static_cast<double>(left - others));
    out.mass.push_back(share);
    left -= share;
  }
  return out;
}

std::vector<TransportCase> transport_cases() {
  std::vector<TransportCase> cases;
  const MassCloud some = flake_like_cloud(11);
  const MassCloud other = flake_like_cloud(12);
  add(cases, "two flake slices", some, other);
  add(cases, "identical", some, some);
  MassCloud permuted = some;
  std::reverse(permuted.centres.begin(), permuted.centres.end());
  std::reverse(permuted.mass.begin(), permuted.mass.end());
  add(cases, "permuted", some, permuted);
  MassCloud heavy = other;
  std::fill(heavy.mass.begin(), heavy.mass.end(), texels / 100 / 49);
  heavy.mass[7] = texels - 49 * (texels / 100 / 49);
  add(cases, "one mass of 0.99", some, heavy);
  MassCloud light = some;
  std::fill(light.mass.begin(), light.mass.end(), std::int64_t{1} << 40);
  MassCloud light_to = light;
  light_to.centres = other.centres;
  for (const std::size_t i : {std::size_t{3}, std::size_t{20}, std::size_t{41}}) {
    light.mass[i + 1] += light.mass[i] - 1;
    light.mass[i] = 1;
  }
  add(cases, "masses to 1e-12 of the total", light, light_to);
  MassCloud one_place = some;
  std::fill(one_place.centres.begin(), one_place.centres.end(), glm::dvec3(0.0));
  MassCloud sphere = flake_like_cloud(12);
  for (glm::dvec3& centre : sphere.centres) centre = 50.0 * glm::normalize(centre);
  add(cases, "all costs equal", one_place, sphere);
  add(cases, "lattice", lattice(0.0), lattice(0.5));
  MassCloud doubled = some;
  MassCloud doubled_to = other;
  for (std::size_t i = 0; i < 25; ++i) {
    doubled.centres[i + 25] = doubled.centres[i];
    doubled_to.centres[i + 25] = doubled_to.centres[i];
  }
  add(cases, "duplicates", doubled, doubled_to);
  add(cases, "both offset by 1e6", moved(some, glm::dvec3(1e6)), moved(other, glm::dvec3(1e6)));
  add(cases, "one offset by 1e6", some, moved(other, glm::dvec3(1e6, 0.0, 0.0)));
  add(cases, "1 x 50", flake_like_cloud(13, 1), other);
  add(cases, "empty", {}, {});
  return cases;
}

std::vector<double> distances(const MassCloud& from, const MassCloud& to) {
  std::vector<double> out;
  out.reserve(from.centres.size() * to.centres.size());
  for (const glm::dvec3& one : from.centres)
    for (const glm::dvec3& two : to.centres) out.push_back(glm::distance(one, two));
  return out;
}

double total_mass(const MassCloud& cloud) {
  double sum = 0.0;
  for (const std::int64_t mass : cloud.mass) sum += static_cast<double>(mass);
  return sum;
}

}  // namespace lackwerk::report
