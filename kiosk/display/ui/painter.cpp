#include "kiosk/display/ui/painter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kiosk/display/ui/painter_parts.hpp"

namespace lackwerk::kiosk::ui {
namespace {

/// Swatches beyond what a pack can hold are a caller's mistake, not a reason to take memory.
constexpr std::size_t most_swatches = core::max_paints;

class CairoPainter final : public Painter {
 public:
  explicit CairoPainter(std::unique_ptr<Fonts> fonts) : fonts_(std::move(fonts)) {}

  void set_swatch(std::size_t paint, int edge_px, std::vector<std::uint8_t> rgb) override {
    if (paint >= most_swatches) return;
    const auto edge = static_cast<std::size_t>(std::max(0, edge_px));
    if (rgb.size() != 3 * edge * edge) rgb.clear();
    if (swatches_.size() <= paint) swatches_.resize(paint + 1);
    swatches_[paint] = {rgb.empty() ? 0 : edge_px, std::move(rgb), ++swatch_versions_};
  }

  [[nodiscard]] int swatch_edge_px(const Surface& surface, const Content& /*content*/) const override {
    return static_cast<int>(metrics_of(surface).swatch);
  }

  [[nodiscard]] const Painted& paint(const Surface& surface, const Content& content, const Model& model,
                                     const DealerFacts* dealer) override {
    tiles_.begin();
    if (model.asleep) return tiles_.end();
    if (model.language != language_) fonts_->set_language(language_ = model.language);
    const Arrangement arrangement = arrange(surface, content, model);
    const Metrics metrics = metrics_of(surface);
    const Look look{surface,
                    content,
                    model,
                    dealer,
                    arrangement,
                    metrics,
                    Key(surface.size_px[0], surface.size_px[1], surface.dpi, model.language),
                    std::max(1.0, std::round(metrics.edge / 720.0)),
                    swatches_,
                    *fonts_,
                    tiles_,
                    measured_};
    paint_screen(look);
    paint_toast(look);
    paint_countdown(look);
    return tiles_.end();
  }

  [[nodiscard]] std::uint64_t tiles_drawn() const override { return tiles_.tiles_drawn(); }

 private:
  static void paint_screen(const Look& look) {
    switch (look.model.screen) {
      case Screen::attract:
        return paint_attract(look);
      case Screen::show:
        return paint_show(look);
      case Screen::take_home:
        return paint_take_home(look);
      case Screen::about:
        return paint_about(look);
      case Screen::pin:
        return paint_pin(look);
      case Screen::dealer:
        return paint_dealer(look);
    }
  }

  std::unique_ptr<Fonts> fonts_;
  Language language_ = Language::english;
  TileStore tiles_;
  Measured measured_;
  std::vector<SwatchPicture> swatches_;
  std::uint64_t swatch_versions_ = 0;
};

}  // namespace

Result<std::unique_ptr<Painter>> Painter::create() {
  auto fonts = Fonts::create();
  if (!fonts) return tl::unexpected<Error>(fonts.error());
  return std::make_unique<CairoPainter>(std::move(*fonts));
}

}  // namespace lackwerk::kiosk::ui
