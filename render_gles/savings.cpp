// Renderer::measure_savings: what leaving things out is worth on this machine.
#include <algorithm>
#include <chrono>

#include "render_gles/renderer.hpp"

namespace lackwerk::gles {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<Saving> Renderer::measure_savings(const View& view, const Lighting& lighting, const Framebuffer& target,
                                              int runs) {
  const auto draw_ms = [&](const Keep& keep) {
    keep_ = keep;
    gl_.Finish();
    const auto start = std::chrono::steady_clock::now();
    draw(view, lighting, target);
    gl_.Finish();
    keep_ = {};
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  };
  std::vector<Saving> out;
  const auto measure = [&](const char* what, const Keep& keep) {
    draw_ms(keep);  // compiles
    draw_ms({});
    std::vector<double> with, without;
    for (int k = 0; k < runs; ++k) {
      with.push_back(draw_ms(keep));
      without.push_back(draw_ms({}));
    }
    out.push_back({what, median(with), median(without)});
  };
  if (lighting.stripes || !paint_ || !mesh_.has(packs::SurfaceKind::paint)) return out;
  Features used;
  paint_->add_features(used);
  if (paint_->has_flakes() && !flakes_show(view, target.height(), moving_contrast) &&
      lighting.quality.flakes > FlakeMode::mean)
    measure("single flakes below the footprint of a pixel", {.single_flakes = true});
  if (used.lobes < static_cast<int>(core::max_lobes)) measure("lobes that no paint of the pack has", {.lobes = true});
  if (!used.coat) measure("clear coat", {.coat = true});
  if (!used.refraction) measure("refraction", {.refraction = true});
  if (used.narrow != 7) measure("sharp environment levels for rough lobes", {.sharp_levels = true});
  draw(view, lighting, target);
  return out;
}

}  // namespace lackwerk::gles
