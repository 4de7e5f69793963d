#include "kiosk/tools/report/workbench.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "core/analysis/studio.hpp"
#include "kiosk/tools/find_recipe.hpp"
#include "packs/tools/car/builtin_car.hpp"
#include "packs/tools/recipe.hpp"
#include "packs/tools/scene_bake.hpp"
#include "packs/tools/virtual_goniometer.hpp"

namespace lackwerk::report {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

constexpr std::array demo_recipes = {"gu_polaris_silber_coated", "gu_ford_f8_coated", "pearl_green_violet"};

}  // namespace

Result<const std::vector<packs::Capture>*> Workbench::captures() {
  if (captures_) return &*captures_;
  std::vector<packs::Capture> made;
  for (const char* name : demo_recipes) {
    const auto recipe = packs::read_recipe(tools::find_recipe(name));
    if (!recipe) return tl::unexpected(recipe.error());
    packs::GoniometerSettings settings;
    settings.edge_texels = edge_texels();
    auto capture = packs::measure(*recipe, settings);
    if (!capture) return tl::unexpected(capture.error());
    made.push_back(std::move(*capture));
  }
  captures_ = std::move(made);
  return &*captures_;
}

Result<const packs::BuiltPack*> Workbench::pack() {
  if (pack_) return &*pack_;
  const auto from = captures();
  if (!from) return tl::unexpected(from.error());
  packs::PackBuildSettings settings;
  settings.id = "lackwerk.report";
  auto built = packs::build_pack(**from, settings);
  if (!built) return tl::unexpected(built.error());
  pack_ = std::move(*built);
  return &*pack_;
}

Result<const packs::Scene*> Workbench::car() {
  if (car_) return &*car_;
  packs::Scene scene = packs::build_builtin_car();
  scene.environment = core::build_studio();
  packs::bake_scene(scene, {choose(packs::BakeSettings{}.rays_per_vertex, 64)});
  car_ = std::move(scene);
  return &*car_;
}

Timing Workbench::time(const std::function<void()>& run, double budget_ms, int least, int most) const {
  run();  // caches and allocations: the first one says nothing
  const double budget = choose(budget_ms, 0.25 * budget_ms);
  std::vector<double> ms;
  const auto start = Clock::now();
  while (static_cast<int>(ms.size()) < most && (static_cast<int>(ms.size()) < least || ms_since(start) < budget)) {
    const auto one = Clock::now();
    run();
    ms.push_back(ms_since(one));
  }
  return timing_of(std::move(ms));
}

Timing timing_of(std::vector<double> ms) {
  if (ms.empty()) return {};
  std::sort(ms.begin(), ms.end());
  const std::size_t n = ms.size();
  return {ms[n / 2], ms[n / 4], ms[(3 * n) / 4], static_cast<int>(n)};
}

void set_errors(Setting& setting, std::vector<double> errors) {
  if (errors.empty()) return;
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  setting.error = std::accumulate(errors.begin(), errors.end(), 0.0) / count;
  setting.p95 = errors[static_cast<std::size_t>(std::ceil(0.95 * count)) - 1];
  setting.worst = errors.back();
}

std::string digits(double value) {
  if (!std::isfinite(value)) return std::isnan(value) ? "-" : (value > 0 ? "inf" : "-inf");
  const double size = std::abs(value);
  std::array<char, 40> text{};
  const char* form = size == 0.0                  ? "%.0f"
                     : size >= 1e6 || size < 1e-4 ? "%.2e"
                     : size >= 99.95              ? "%.0f"
                     : size >= 9.995              ? "%.1f"
                     : size >= 0.9995             ? "%.2f"
                     : size >= 0.09995            ? "%.3f"
                                                  : "%.4f";
  std::snprintf(text.data(), text.size(), form, value);
  return text.data();
}

}  // namespace lackwerk::report
