// `lackwerk render --backend reference`: a pack and a scene, handed to the integrator of core/analysis/reference.hpp.
//
// Why it exists: core knows neither packs nor moods; somebody has to say which bytes the integrator reads. The picture
// is the one `--backend egl` would draw from the same options: same camera, light, detail, paint. Free functions; one
// thread (the integrator starts its own).
#pragma once

#include <cstdint>
#include <string>

#include "core/analysis/reference.hpp"
#include "core/error.hpp"
#include "core/interpolatable_paint.hpp"
#include "packs/scene.hpp"
#include "render_gles/view.hpp"

namespace CLI {
class App;
}

namespace lackwerk::tools {

/// The options that only the reference knows.
struct ReferenceSettings {
  int samples = 256;                 ///< a pixel
  double seconds = 0.0;              ///< > 0: an upper bound of the time
  std::string visibility = "baked";  ///< or "traced"
  std::string error_image;           ///< PNG of the error bars; empty = none
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0 = one per core
};

/// Adds --reference-samples, --reference-seconds, --reference-seed, --reference-threads, --visibility, --error-image.
void add_reference_options(CLI::App& command, ReferenceSettings& settings);

struct ReferenceJob {
  const packs::Scene* scene;
  const core::InterpolatablePaint* paint;
  const core::Weights* weights;  ///< have passed check_weights
  gles::View view;
  gles::Lighting lighting;
  int width, height;  ///< pixels
  std::string out;    ///< PNG to write
  bool json = false;
};

/// The picture itself; `out` and `json` are not read. Errors: what the reference cannot draw, no ray tracing device.
[[nodiscard]] Result<core::ReferenceImage> reference_image(const ReferenceJob& job, const ReferenceSettings& settings,
                                                           const core::ReferenceProgress& progress = {});

/// Renders, writes the pictures and prints what was done. Returns the exit code.
[[nodiscard]] int run_reference(const ReferenceJob& job, const ReferenceSettings& settings);

}  // namespace lackwerk::tools
