// The attract screen, and the screen a visitor works on.
#include <algorithm>
#include <cmath>

#include "kiosk/display/ui/arrangement.hpp"

namespace lackwerk::kiosk::ui {
namespace {

/// Around the pad's middle, in targets: half of it is the puck's radius.
constexpr double puck_room = 0.25;

class Show {
 public:
  Show(const Metrics& metrics, const Surface& surface, const Content& content, const Model& model, Arrangement& out)
      : m_(metrics), surface_(surface), content_(content), model_(model), out_(out) {}

  void arrange() {
    if (content_.scans) {
      series();
      return;
    }
    if (m_.portrait)
      column();
    else
      wide();
    if (model_.hint && pad_.width > 0.0) hint();
  }

 private:
  void item(Widget widget, int index, const Rect& rect) {
    const Rect drawn = whole(rect);
    out_.items.push_back({widget, index, drawn, whole(at_least(drawn, m_.target, m_))});
  }
  void piece(Part part, const Rect& rect, int index = 0) { out_.pieces.push_back({part, index, whole(rect)}); }

  [[nodiscard]] std::size_t paints() const { return std::min(content_.paints.size(), model_.swatches.size()); }
  /// Two paints are a slider, one is a swatch: a strip is enough.
  [[nodiscard]] bool strip() const { return paints() <= 2; }
  [[nodiscard]] double pad_height(double width) const {
    if (strip()) return m_.swatch + m_.margin + m_.label + (paints() == 2 ? 0.5 * m_.target : 0.0);
    return width + m_.label;
  }
  [[nodiscard]] int sliders() const { return (content_.has_flakes ? 2 : 0) + (beyond() ? 1 : 0); }
  [[nodiscard]] bool beyond() const { return model_.beyond_shown && content_.beyond_limit > 0.0; }

  void pad(const Rect& rect) {
    pad_ = whole(rect);
    piece(Part::pad_glass, pad_);
    out_.items.push_back({Widget::pad, 0, pad_, pad_});
    const Rect field = pad_field(surface_, pad_);
    const double label_width = std::min(pad_.width - m_.margin, std::max(0.46 * pad_.width, 2.0 * m_.target));
    for (std::size_t k = 0; k < paints(); ++k) {
      const Place& place = model_.swatches[k];
      const double x = field.x + std::clamp(place[0], 0.0, 1.0) * field.width;
      const double y = field.y + std::clamp(place[1], 0.0, 1.0) * field.height;
      const int paint = static_cast<int>(k);
      Rect name{x - label_width / 2.0, y + m_.swatch / 2.0, label_width, m_.label};
      name.x = std::clamp(name.x, pad_.x + m_.margin / 2.0, pad_.x + pad_.width - m_.margin / 2.0 - label_width);
      name = whole(name);
      // Downwards from the disc, as far as the surface goes; on a small pad not over its middle, where the puck is at
      // home: rather over the disc, which wins where a finger is nearer to it.
      Rect touch{name.x, name.y, std::max(name.width, m_.target), std::max(name.height, m_.target)};
      touch.y = std::min(touch.y, m_.height - touch.height);
      const double free_from = field.centre()[1] - puck_room * m_.target;
      if (name.y < free_from) touch.y = std::min(touch.y, std::floor(free_from) - touch.height);
      out_.items.push_back({Widget::swatch_about, paint, name, whole(touch)});
      item(Widget::swatch, paint, {x - m_.swatch / 2.0, y - m_.swatch / 2.0, m_.swatch, m_.swatch});
    }
  }

  /// A slider and its lock in a row of one target's height. `rect`: the row.
  void slider(Widget widget, Widget lock, const Rect& rect) {
    item(widget, 0, {rect.x, rect.y, rect.width - m_.target, m_.target});
    if (lock != Widget::none) item(lock, 0, {rect.x + rect.width - m_.target, rect.y, m_.target, m_.target});
  }

  /// The sliders in `columns`, from the upper left; the panel is as high as they need.
  void slider_panel(const Rect& rect, int columns) {
    if (sliders() == 0) return;
    piece(Part::slider_glass, rect);
    const double width = std::floor(rect.width / columns);
    int at = 0;
    const auto next = [&] {
      const int row = at / columns;
      const Rect cell{rect.x + (at % columns) * width, rect.y + row * m_.target, width, m_.target};
      ++at;
      return cell;
    };
    if (content_.has_flakes) {
      slider(Widget::sparkle, Widget::sparkle_lock, next());
      slider(Widget::hue, Widget::hue_lock, next());
    }
    if (beyond()) slider(Widget::beyond, Widget::none, next());
  }
  [[nodiscard]] double slider_height(int columns) const {
    const int rows = (sliders() + columns - 1) / columns;
    return m_.target * rows;
  }

  void lights(const Rect& rect) {
    piece(Part::light_glass, rect);
    for (int k = 0; k < 3; ++k) item(Widget::light, k, {rect.x + k * m_.target, rect.y, m_.target, m_.target});
    item(Widget::dimmer, 0, {rect.x + 3.0 * m_.target, rect.y, rect.width - 3.0 * m_.target, m_.target});
  }
  [[nodiscard]] double lights_width() const {
    return std::min(3.0 * m_.target + std::max(3.5 * m_.target, 0.25 * m_.edge), m_.width - 2.0 * m_.margin);
  }

  /// `bottom`: where the divider ends, above what lies below the car.
  void compare_labels(double bottom) {
    const double middle = std::round(m_.width / 2.0);
    const double width = std::min(std::max(0.36 * m_.edge, 16.0 * m_.text), middle - 1.5 * m_.margin);
    const double height = 8.4 * m_.text;
    // Beside the lights if there is room, else below them.
    const bool beside = middle - 2.0 * m_.margin - width > lights_width() + m_.margin;
    const double y = beside ? m_.margin : 2.0 * m_.margin + m_.target;
    const double line = std::max(1.0, std::round(m_.edge / 720.0));
    // In portrait the lights are in the middle.
    const double top = m_.portrait ? y : m_.margin;
    piece(Part::divider, {middle - line, top, 2.0 * line, std::max(1.0, bottom - m_.margin - top)});
    piece(Part::compare_left, {middle - 0.5 * m_.margin - width, y, width, height});
    piece(Part::compare_right, {middle + 0.5 * m_.margin, y, width, height});
  }

  [[nodiscard]] double name_height() const { return std::round(3.3 * m_.text); }

  /// Pad at the lower right, where the hand is and the floor before the car; sliders at the lower left.
  void wide() {
    const double least_sliders = 3.6 * m_.target;
    const double room = m_.width - 3.0 * m_.margin;
    const double pad_width = std::floor(std::min(
        {std::max(0.4 * m_.edge, 4.5 * m_.target), m_.height - 2.0 * m_.margin - m_.label, room - least_sliders}));
    const double bottom = m_.height - m_.margin, left = m_.margin, right = m_.width - m_.margin;
    const double slider_width = std::floor(std::min(room - pad_width, std::max(0.4 * m_.edge, 5.2 * m_.target)));
    const double sliders_y = bottom - slider_height(1);
    const double pad_h = pad_height(pad_width);
    const double pad_x = right - pad_width;

    if (model_.nearest) compare_labels(bottom - m_.target);
    lights({right - lights_width(), m_.margin, lights_width(), m_.target});
    pad({pad_x, bottom - pad_h, pad_width, pad_h});
    if (sliders() > 0) slider_panel({left, sliders_y, slider_width, slider_height(1)}, 1);
    // Between sliders and pad lie compare, name and take home, if there is room for a name; else above them.
    const double gap_x = sliders() > 0 ? left + slider_width + m_.margin : left;
    const double gap = pad_x - m_.margin - gap_x;
    if (gap >= 6.0 * m_.target) {
      const double width = std::min(gap, 13.0 * m_.target);
      const Rect dock{gap_x + (gap - width) / 2.0, bottom - m_.target, width, m_.target};
      piece(Part::dock_glass, dock);
      item(Widget::compare, 0, {dock.x, dock.y, m_.target, m_.target});
      item(Widget::take_home, 0, {dock.x + dock.width - m_.target, dock.y, m_.target, m_.target});
      piece(Part::mix_name, {dock.x + m_.target, dock.y, dock.width - 2.0 * m_.target, m_.target});
      return;
    }
    const double dock_y = sliders() > 0 ? sliders_y - 0.5 * m_.margin - m_.target : bottom - m_.target;
    const Rect dock{left, dock_y, 2.0 * m_.target, m_.target};
    piece(Part::dock_glass, dock);
    item(Widget::compare, 0, {dock.x, dock.y, m_.target, m_.target});
    item(Widget::take_home, 0, {dock.x + m_.target, dock.y, m_.target, m_.target});
    piece(Part::mix_name, {pad_x, bottom - pad_h - 0.5 * m_.margin - name_height(), pad_width, name_height()});
  }

  void column() {
    const double room = m_.width - 2.0 * m_.margin;
    const double bottom = m_.height - m_.margin;
    const double pad_width = std::min(std::max(0.5 * m_.edge, 4.3 * m_.target), room - 2.0 * m_.target - m_.margin);
    const double pad_h = pad_height(pad_width);
    const Rect pad_rect{(m_.width - pad_width) / 2.0, bottom - pad_h, pad_width, pad_h};
    const double gap = 0.6 * m_.margin;
    const double sliders_y = pad_rect.y - gap - slider_height(2);
    const double name_y = (sliders() > 0 ? sliders_y : pad_rect.y) - gap - name_height();

    if (model_.nearest) compare_labels(name_y);
    lights({(m_.width - lights_width()) / 2.0, m_.margin, lights_width(), m_.target});
    pad(pad_rect);
    if (sliders() > 0) slider_panel({m_.margin, sliders_y, room, slider_height(2)}, 2);
    const double side = (pad_rect.x - m_.margin - m_.target) / 2.0;
    const double beside_y = pad_rect.y + (pad_h - m_.target) / 2.0;
    item(Widget::compare, 0, {m_.margin + side, beside_y, m_.target, m_.target});
    item(Widget::take_home, 0, {m_.width - m_.margin - side - m_.target, beside_y, m_.target, m_.target});
    piece(Part::mix_name, {m_.margin, name_y, room, name_height()});
  }

  /// Scans: one slider across the lower edge, its words above it.
  void series() {
    const double width = std::min(m_.width - 2.0 * m_.margin, std::max(1.1 * m_.edge, 13.0 * m_.target));
    const double words = std::round(2.2 * m_.text), height = words + m_.target;
    const Rect glass{(m_.width - width) / 2.0, m_.height - m_.margin - height, width, height};
    piece(Part::time_glass, glass);
    const double side = 0.35 * m_.target;
    piece(Part::time_words, {glass.x + side, glass.y + 0.3 * m_.text, glass.width - 2.0 * side, words});
    item(Widget::time, 0, {glass.x, glass.y + words, glass.width, m_.target});
    if (!model_.hint) return;
    const Track track = slider_track(surface_, out_.items.back(), Language::english);
    hint_at(track.at(std::clamp(model_.time, 0.0, 1.0)));
  }

  void hint() {
    const Rect field = pad_field(surface_, pad_);
    hint_at({field.x + model_.puck[0] * field.width, field.y + model_.puck[1] * field.height});
  }

  /// The finger's tip on the puck.
  void hint_at(Place puck) {
    const double side = 1.4 * m_.target;
    piece(Part::hint, {std::clamp(puck[0] - side / 2.0, 0.0, m_.width - side),
                       std::clamp(puck[1] - 0.05 * side, 0.0, m_.height - side), side, side});
  }

  const Metrics& m_;
  const Surface& surface_;
  const Content& content_;
  const Model& model_;
  Arrangement& out_;
  Rect pad_;
};

}  // namespace

void arrange_show(const Metrics& metrics, const Surface& surface, const Content& content, const Model& model,
                  Arrangement& out) {
  // On attract there is nothing to touch but the picture: the painter's few words have no place to share.
  if (model.screen == Screen::attract) return;
  Show(metrics, surface, content, model, out).arrange();
}

}  // namespace lackwerk::kiosk::ui
