#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "core/analysis/ggx_fit.hpp"
#include "core/isochromatic.hpp"
#include "kiosk/tools/report/stiff_numbers.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

glm::dvec3 direction(double theta_deg, double phi_deg) {
  const double theta = theta_deg * degree, phi = phi_deg * degree;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

core::AnalyticPaint one_lobe(double m, double f0, double index, double s) {
  core::AnalyticPaint paint;
  paint.lobes[0] = {glm::dvec3(s, 0.0, s), m, f0};
  paint.coat_ior = paint.refraction_ior = index;
  return paint;
}

void judge_engine_fits(Findings& findings) {
  int no_numbers = 0, wrong = 0;
  double energy = 0.0;
  std::string where, energy_at;
  for (const double m : {1e-3, 3e-3, 0.02, 0.3, 1.0})
    for (const double f0 : {0.0, 0.04, 1.0})
      for (const double index : {1.0, 1.33, 2.5})
        for (const double s : {0.0, 1e-9, 1.0, 1e3}) {
          const std::string at =
              "m " + digits(m) + ", F0 " + digits(f0) + ", index " + digits(index) + ", s " + digits(s);
          const core::GgxFit fit = core::fit_ggx(one_lobe(m, f0, index, s));
          const glm::dvec3 scale = fit.scale();
          if (!std::isfinite(scale.x) || !std::isfinite(fit.alpha) || !std::isfinite(fit.error)) {
            ++no_numbers;
            where = at;
          }
          if (scale.x < 0.0 || scale.y != 0.0 || fit.alpha < core::least_engine_alpha || fit.alpha > 1.0) ++wrong;
          // Twice the lobe is twice the energy: the fit is linear in s.
          if (s != 1.0 || f0 == 0.0) continue;
          const core::GgxFit twice = core::fit_ggx(one_lobe(m, f0, index, 2.0));
          const double off = std::abs(twice.scale().x / scale.x - 2.0);
          if (off <= energy) continue;
          energy = off;
          energy_at = at;
        }
  add_case(findings, "engine fit", "m 1e-3 to 1, F0 0 to 1, index 1 to 2.5, s 0 to 1e3", "results that are no numbers",
           no_numbers, 0.0, where);
  add_case(findings, "engine fit", "m 1e-3 to 1, F0 0 to 1, index 1 to 2.5, s 0 to 1e3", "results outside their ranges",
           wrong, 0.0);
  // Sums of 1,536 terms, each off by a rounding.
  add_case(findings, "engine fit", "a lobe twice as strong", "scale off twice the scale", energy, 1e-10, energy_at);
}

struct LineErrors {
  int no_numbers = 0;
  double off_line = 0.0;  ///< radians between the flake's angles of the pair and of its in-plane geometries
  std::string where;
};

void try_pair(double light, double eye, double azimuth, double index, core::CriticalAngleCure cure, LineErrors& out) {
  const glm::dvec3 in = direction(light, 0.0), to = direction(eye, azimuth);
  const core::FlakeAngles wanted = core::flake_angles(in, to, index);
  const bool cured = core::needs_cure(in, to, index);
  for (const core::InPlane& geometry : core::in_plane(in, to, index, cure)) {
    if (!std::isfinite(geometry.light) || !std::isfinite(geometry.eye)) {
      ++out.no_numbers;
      continue;
    }
    if (cured || cure == core::CriticalAngleCure::index_one) continue;
    const core::InPlaneDirections back = core::in_plane_directions(geometry);
    const core::FlakeAngles got = core::flake_angles(back.in, back.out, index);
    const double off =
        std::max(std::abs(got.theta_inc - wanted.theta_inc), std::abs(got.theta_flake - wanted.theta_flake));
    if (off <= out.off_line) continue;
    out.off_line = off;
    out.where =
        "light " + digits(light) + ", eye " + digits(eye) + ", azimuth " + digits(azimuth) + ", index " + digits(index);
  }
  const glm::dvec2 place = core::map_place(in, to, index, cure);
  if (!(place.x >= -1e-12 && place.x <= 1.0 + 1e-12 && std::abs(place.y) <= 1.0 + 1e-12)) ++out.no_numbers;
}

void judge_lines(Findings& findings) {
  struct Named {
    const char* name;
    core::CriticalAngleCure cure;
  };
  for (const Named& one :
       {Named{"A, clip", core::CriticalAngleCure::clip}, Named{"B, slide", core::CriticalAngleCure::slide},
        Named{"C, index 1", core::CriticalAngleCure::index_one}}) {
    LineErrors grid, critical, equal;
    for (const double index : {1.0, 1.05, 1.5, 2.5}) {
      for (int light = 0; light <= 90; light += 5)
        for (int eye = 0; eye <= 90; eye += 5)
          for (int azimuth = 0; azimuth <= 180; azimuth += 15) try_pair(light, eye, azimuth, index, one.cure, grid);
      // Both at the horizon and a hair above it, on the same side: theta_inc + theta_flake is the critical angle.
      for (const double beside : {0.0, 1e-9, 1e-6, 1e-3, 0.1})
        for (const double azimuth : {0.0, 1e-6, 90.0, 179.999, 180.0})
          try_pair(90.0 - beside, 90.0 - 2.0 * beside, azimuth, index, one.cure, critical);
      // Mirror (the flake lies flat), retro (it faces the light), and next to them.
      for (const double theta : {0.0, 1e-6, 30.0, 89.0})
        for (const double beside : {0.0, 1e-9, 1e-4})
          for (const double azimuth : {0.0, 180.0}) try_pair(theta, theta + beside, azimuth, index, one.cure, equal);
    }
    const std::string cure = std::string(", cure ") + one.name;
    const auto add = [&](const std::string& name, const LineErrors& errors) {
      add_case(findings, "isochromatic lines", name + cure, "results that are no numbers or outside the map",
               errors.no_numbers, 0.0);
      // acos near 1 turns a rounding of 1e-16 into 1.5e-8 rad; sine and cosine in between make a few of these.
      add_case(findings, "isochromatic lines", name + cure, "flake angles off the line, radians", errors.off_line, 1e-6,
               errors.where);
    };
    add("all angles by 5 degrees", grid);
    add("at the critical angle", critical);
    add("mirror and retro directions", equal);
  }
}

}  // namespace

void add_stiff_fits(Findings& findings) {
  judge_engine_fits(findings);
  judge_lines(findings);
}

}  // namespace lackwerk::report
