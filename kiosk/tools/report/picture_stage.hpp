// What the report's pictures are drawn on and judged by: the car in the first paint of the pack, its reference, the
// mask of the car.
//
// Why it exists: every setting of every picture knob is the same view of the same car, so that their errors can be
// compared; and the reference takes longer than all of them. Owns the stage with its GL context; the bench's car and
// pack are copied. One GL thread.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "kiosk/display/stage.hpp"
#include "kiosk/tools/report/findings.hpp"
#include "kiosk/tools/report/workbench.hpp"
#include "packs/tools/image_compare.hpp"
#include "render_gles/view.hpp"

namespace lackwerk::report {

/// Frames are timed at what panels have, errors taken on pictures small enough for a reference.
inline constexpr int timed_width_px = 1280, timed_height_px = 720;

/// A way to draw, with what was measured of it.
struct DrawnSetting {
  Setting setting;  ///< time and error are filled in
  gles::Quality quality;
};

class PictureStage {
 public:
  /// On EGL without a surface, else on OSMesa. Renders the reference. Errors: no GL context, no ray tracing device,
  /// what the bench cannot make.
  [[nodiscard]] static Result<std::unique_ptr<PictureStage>> make(Workbench& bench);

  [[nodiscard]] const std::string& renderer_name() const { return stage_->context().info().renderer; }
  /// "320 x 180".
  [[nodiscard]] std::string size_text() const;
  /// How far the reference is from itself: half the mean CIEDE2000 between its two halves, which have other seeds.
  [[nodiscard]] double noise() const { return noise_; }
  [[nodiscard]] int reference_samples() const { return reference_samples_; }

  /// A picture of `samples` frames at the reference's size; `ms`, if given, is how long it took.
  [[nodiscard]] gles::Image still(const gles::Quality& quality, int samples, double* ms = nullptr);
  /// Puts CIEDE2000 against the reference, over the car, into error, p95 and worst.
  void judge(const gles::Image& image, Setting& setting) const;

  /// Draws a moving frame of each quality in turn, `rounds` times, at the timed size, and fills in their times. The
  /// camera turns from round to round; every round waits until each frame is drawn.
  void time_moving(std::vector<DrawnSetting>& settings, int rounds);

  /// Called with the fraction done by what takes long.
  std::function<void(double fraction)> on_progress;

 private:
  PictureStage() = default;
  [[nodiscard]] Result<void> open(Workbench& bench);
  [[nodiscard]] Result<void> render_reference(int samples);
  [[nodiscard]] packs::LinearImage linear(const gles::Image& image) const;

  std::unique_ptr<kiosk::Stage> stage_;
  std::unique_ptr<gles::Framebuffer> timed_;
  core::Weights weights_;
  gles::View view_;
  gles::Lighting lighting_;  ///< of the view's mood; its quality is each setting's
  packs::LinearImage reference_;
  packs::PixelMask subject_;
  double noise_ = none;
  int reference_samples_ = 0;
};

}  // namespace lackwerk::report
