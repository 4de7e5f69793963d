// Each paint of a pack on a small curved sample, for the swatches of the paint pad.
//
// Why it exists: a plain disc of the mean colour says nothing about a metallic; the swatch is drawn with its own paint,
// flakes and clear coat, in the room the car stands in. It draws on the kiosk's context with a renderer of its own,
// which lives only while there is something to draw: one paint a call, so that nobody waits long. The paint must
// outlive it; its context must be current in every call and when it goes. One GL thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/environment.hpp"
#include "core/error.hpp"
#include "core/interpolatable_paint.hpp"
#include "packs/scene.hpp"
#include "render_gles/context.hpp"
#include "render_gles/framebuffer.hpp"
#include "render_gles/renderer.hpp"

namespace lackwerk::kiosk {

struct SwatchPicture {
  std::size_t paint = 0;
  int edge_px = 0;
  std::vector<std::uint8_t> rgb;  ///< square, rows from the top
};

class Swatches {
 public:
  Swatches(gles::Context& context, const core::InterpolatablePaint& paint, core::Environment environment);

  /// All paints anew at this size, px in [16, 1024]; nothing happens if it is the size they have.
  void wants(int edge_px);
  /// Whether next() has something to draw.
  [[nodiscard]] bool pending() const { return next_ < paint_->paints.size() && edge_px_ > 0; }
  /// Draws the next paint; the first call sends textures and compiles instead. After the last paint all GL objects are
  /// gone. Error: paint or size refused by the driver; it is not tried again.
  [[nodiscard]] Result<std::optional<SwatchPicture>> next();

 private:
  struct Studio {
    explicit Studio(gles::Context& context) : renderer(context) {}
    gles::Renderer renderer;
    std::optional<gles::Framebuffer> framebuffer;
  };
  [[nodiscard]] Result<std::optional<SwatchPicture>> step();
  [[nodiscard]] Result<void> set_up();
  [[nodiscard]] Result<void> realise(std::size_t paint);

  gles::Context* context_;
  const core::InterpolatablePaint* paint_;
  core::Environment environment_;
  int edge_px_ = 0;
  std::size_t next_ = 0;
  std::unique_ptr<Studio> studio_;
};

/// The sample: a dome that fills a square picture and turns from face on in the middle to steep at the rim, so that all
/// angles of the paint are there. With its camera; millimetres.
[[nodiscard]] packs::Scene swatch_scene(core::Environment environment);

}  // namespace lackwerk::kiosk
