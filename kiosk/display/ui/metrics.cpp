#include "kiosk/display/ui/metrics.hpp"

#include <algorithm>
#include <cmath>

namespace lackwerk::kiosk::ui {
namespace {

/// A finger's share of the shorter edge: 48 px of 720, as phones have it.
constexpr double target_share = 1.0 / 15.0;
/// The least surface with room for least_touch_mm is 90 mm along the shorter edge: 7.5 targets.
constexpr double targets_along_edge = 7.5;
/// 15 px of 720; not below 2.4 mm (x-height 1.3 mm), which is read from half a metre.
constexpr double text_share = 15.0 / 720.0;
constexpr double least_text_mm = 2.4;
constexpr double margin_share = 1.0 / 30.0;
/// Wider than this against its width, a surface is arranged as a column.
constexpr double portrait_from = 1.25;
constexpr double mm_per_inch = 25.4;

}  // namespace

Metrics metrics_of(const Surface& surface) {
  Metrics m;
  m.width = std::max(1, surface.size_px[0]);
  m.height = std::max(1, surface.size_px[1]);
  m.edge = std::min(m.width, m.height);
  m.portrait = m.height >= portrait_from * m.width;
  const double px_per_mm = (std::isfinite(surface.dpi) && surface.dpi > 0.0 ? surface.dpi : 96.0) / mm_per_inch;
  // Rounded up: a target of 11.99 mm would be one that is too small.
  m.target =
      std::ceil(std::min(std::max(least_touch_mm * px_per_mm, target_share * m.edge), m.edge / targets_along_edge));
  m.margin = std::max(1.0, std::round(margin_share * m.edge));
  // A third of a target is what a line of text may take of a row.
  m.text = std::min(std::max(text_share * m.edge, least_text_mm * px_per_mm), m.target / 3.0);
  m.swatch = std::round(1.15 * m.target);
  m.label = std::round(1.7 * m.text);
  return m;
}

Rect whole(const Rect& rect) {
  return {std::round(rect.x), std::round(rect.y), std::max(1.0, std::round(rect.width)),
          std::max(1.0, std::round(rect.height))};
}

Rect at_least(const Rect& rect, double side, const Metrics& metrics) {
  Rect out = rect;
  out.width = std::min(std::max(rect.width, side), metrics.width);
  out.height = std::min(std::max(rect.height, side), metrics.height);
  out.x = std::clamp(rect.x + (rect.width - out.width) / 2.0, 0.0, metrics.width - out.width);
  out.y = std::clamp(rect.y + (rect.height - out.height) / 2.0, 0.0, metrics.height - out.height);
  return out;
}

}  // namespace lackwerk::kiosk::ui
