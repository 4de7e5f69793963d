#include "kiosk/tools/report/picture_stage.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <glm/trigonometric.hpp>
#include <utility>

#include "core/check.hpp"
#include "core/colour.hpp"
#include "kiosk/display/mood.hpp"
#include "kiosk/display/state.hpp"
#include "kiosk/tools/reference_render.hpp"

namespace lackwerk::report {
namespace {

using Clock = std::chrono::steady_clock;

/// The pack as the kiosk has it: out of a file, with everything a file rounds.
Result<packs::PaintPack> as_file(const packs::BuiltPack& built) {
  const auto path = std::filesystem::temp_directory_path() / ("lackwerk_report_" + std::to_string(getpid()) + ".lwp");
  const auto written = packs::write_paint_pack(path, built.contents());
  if (!written) return tl::unexpected(written.error());
  auto pack = packs::PaintPack::open(path, packs::Backing::copy);
  std::filesystem::remove(path);
  return pack;
}

}  // namespace

Result<std::unique_ptr<PictureStage>> PictureStage::make(Workbench& bench) {
  std::unique_ptr<PictureStage> out(new PictureStage);  // the constructor is private
  out->on_progress = [&bench](double fraction) { bench.progress(fraction); };
  if (auto opened = out->open(bench); !opened) return tl::unexpected(opened.error());
  if (auto ready = out->render_reference(bench.choose(1024, 256)); !ready) return tl::unexpected(ready.error());
  return out;
}

Result<void> PictureStage::open(Workbench& bench) {
  const auto built = bench.pack();
  if (!built) return tl::unexpected(built.error());
  const auto car = bench.car();
  if (!car) return tl::unexpected(car.error());
  const int width = bench.choose(320, 160), height = bench.choose(180, 90);
  for (const gles::Backend backend : {gles::Backend::egl_surfaceless, gles::Backend::osmesa}) {
    auto pack = as_file(**built);
    if (!pack) return tl::unexpected(pack.error());
    auto stage = kiosk::Stage::create(backend, width, height, std::move(*pack), **car);
    if (!stage && backend == gles::Backend::osmesa) return tl::unexpected(stage.error());
    if (!stage) continue;
    stage_ = std::move(*stage);
    break;
  }
  auto timed = gles::Framebuffer::create(stage_->context(), timed_width_px, timed_height_px);
  if (!timed) return tl::unexpected(timed.error());
  timed_ = std::make_unique<gles::Framebuffer>(std::move(*timed));
  weights_ = kiosk::first_paint(static_cast<int>(stage_->pack().paints()->paint().paints.size()));
  if (auto updated = stage_->renderer().update(weights_); !updated) return updated;
  const packs::Camera& camera = stage_->scene().cameras.front();
  view_ = gles::View::from(camera);
  lighting_ = kiosk::lighting_of(kiosk::usual_mood(camera.name));
  subject_ = packs::mask_of(linear(stage_->renderer().subject(view_, stage_->framebuffer())));
  return {};
}

Result<void> PictureStage::render_reference(int samples) {
  const int width = stage_->framebuffer().width(), height = stage_->framebuffer().height();
  const tools::ReferenceJob job{
      &stage_->scene(), &stage_->pack().paints()->paint(), &weights_, view_, lighting_, width, height, {}};
  const auto exposure = static_cast<double>(lighting_.exposure);
  const auto shown = [&](const core::ReferenceImage& image) {
    gles::Image out(width, height);
    out.rgb = core::reference_bytes(image, exposure);
    return linear(out);
  };
  std::array<core::ReferenceImage, 2> halves;
  double furthest = 0.0;  // its threads report one at a time, but not in order
  for (std::size_t k = 0; k < halves.size(); ++k) {
    tools::ReferenceSettings settings;
    settings.samples = samples / 2;
    settings.seed = k + 1;
    // A third of the part goes into the reference.
    auto half = tools::reference_image(job, settings, [&](double fraction, int /*samples*/) {
      furthest = std::max(furthest, (static_cast<double>(k) + fraction) / 6.0);
      on_progress(furthest);
    });
    if (!half) return tl::unexpected(half.error());
    halves[k] = std::move(*half);
  }
  core::ReferenceImage mean = halves[0];
  for (std::size_t k = 0; k < mean.mean.size(); ++k) mean.mean[k] = 0.5 * (mean.mean[k] + halves[1].mean[k]);
  reference_ = shown(mean);
  reference_samples_ = halves[0].samples + halves[1].samples;
  // The halves' difference has four times the variance of their mean's error.
  const auto between = packs::compare_images(shown(halves[0]), shown(halves[1]), nullptr, subject_);
  if (!between) return tl::unexpected(between.error());
  noise_ = 0.5 * between->mean;
  return {};
}

packs::LinearImage PictureStage::linear(const gles::Image& image) const {
  packs::LinearImage out{image.width, image.height, {}};
  out.pixels.reserve(image.rgb.size() / 3);
  for (std::size_t k = 0; k + 2 < image.rgb.size(); k += 3) {
    glm::vec3 pixel;
    for (int c = 0; c < 3; ++c)
      pixel[c] = static_cast<float>(core::srgb_decode(image.rgb[k + static_cast<std::size_t>(c)] / 255.0));
    out.pixels.push_back(pixel);
  }
  return out;
}

std::string PictureStage::size_text() const {
  return std::to_string(reference_.width) + " x " + std::to_string(reference_.height);
}

gles::Image PictureStage::still(const gles::Quality& quality, int samples, double* ms) {
  gles::Lighting lighting = lighting_;
  lighting.quality = quality;
  const auto start = Clock::now();
  gles::Image image = stage_->renderer().still(view_, lighting, stage_->framebuffer(), samples);
  if (ms != nullptr) *ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  return image;
}

void PictureStage::judge(const gles::Image& image, Setting& setting) const {
  const auto difference = packs::compare_images(linear(image), reference_, nullptr, subject_);
  check_equal(difference.has_value(), true, "pictures of one size, a mask that counts");
  setting.error = difference->mean;
  setting.p95 = difference->p95;
  setting.worst = difference->max;
}

void PictureStage::time_moving(std::vector<DrawnSetting>& settings, int rounds) {
  std::vector<std::vector<double>> ms(settings.size());
  for (int round = 0; round <= rounds; ++round)
    for (std::size_t k = 0; k < settings.size(); ++k) {
      gles::Lighting lighting = lighting_;
      lighting.quality = settings[k].quality;
      gles::View view = view_;
      const float angle = glm::radians(0.1f * static_cast<float>(round));
      const float c = std::cos(angle), s = std::sin(angle);
      const glm::vec3 from = view.eye_mm - view.target_mm;
      view.eye_mm = view.target_mm + glm::vec3(c * from.x - s * from.y, s * from.x + c * from.y, from.z);
      const auto start = Clock::now();
      stage_->renderer().draw(view, lighting, *timed_);
      stage_->context().gl().Finish();
      // The first round compiles and uploads.
      if (round > 0) ms[k].push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
  for (std::size_t k = 0; k < settings.size(); ++k) settings[k].setting.time = timing_of(std::move(ms[k]));
}

}  // namespace lackwerk::report
