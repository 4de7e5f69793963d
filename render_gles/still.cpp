// Renderer::still: the quality that is drawn once nothing changes any more.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.hpp"
#include "core/colour.hpp"
#include "render_gles/renderer.hpp"

namespace lackwerk::gles {
namespace {

std::array<float, 256> decoding_table() {
  std::array<float, 256> table{};
  for (std::size_t k = 0; k < table.size(); ++k)
    table[k] = static_cast<float>(core::srgb_decode(static_cast<double>(k) / 255.0));
  return table;
}

}  // namespace

Image Renderer::still(const View& view, const Lighting& lighting, const Framebuffer& target, int samples) {
  check_at_most(1, samples, "samples of a still picture");
  const std::array<float, 256> decode = decoding_table();
  std::vector<float> sum;
  Image image;
  for (int k = 0; k < samples; ++k) {
    View shifted = view;
    shifted.jitter_px = view.jitter_px + halton_jitter(k);
    draw(shifted, lighting, target);
    image = target.read();
    if (samples == 1) return image;
    sum.resize(image.rgb.size(), 0.0f);
    // At most a few hundred terms between 0 and 1: float keeps more than the 8 bits that come out.
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += decode[image.rgb[i]];
  }
  const double scale = 1.0 / samples;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double encoded = core::srgb_encode(std::min(static_cast<double>(sum[i]) * scale, 1.0));
    image.rgb[i] = static_cast<std::uint8_t>(std::lround(encoded * 255.0));
  }
  return image;
}

}  // namespace lackwerk::gles
