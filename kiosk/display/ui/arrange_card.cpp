// The screens that are a card over the car: take home, about, the dealer's number pad and pages.
#include <algorithm>
#include <cmath>

#include "kiosk/display/ui/arrangement.hpp"

namespace lackwerk::kiosk::ui {
namespace {

class Card {
 public:
  Card(const Metrics& metrics, const Surface& surface, const Model& model, Arrangement& out)
      : m_(metrics), surface_(surface), model_(model), out_(out) {}

  void arrange() {
    switch (model_.screen) {
      case Screen::take_home:
        take_home();
        break;
      case Screen::about:
        about();
        break;
      case Screen::pin:
        pin();
        break;
      case Screen::dealer:
        dealer();
        break;
      case Screen::attract:
      case Screen::show:
        break;
    }
  }

 private:
  void item(Widget widget, int index, const Rect& rect) {
    const Rect drawn = whole(rect);
    out_.items.push_back({widget, index, drawn, whole(at_least(drawn, m_.target, m_))});
  }
  void piece(Part part, const Rect& rect, int index = 0) { out_.pieces.push_back({part, index, whole(rect)}); }

  [[nodiscard]] Rect card(double width, double height) {
    const Rect rect = whole({(m_.width - width) / 2.0, (m_.height - height) / 2.0, width, height});
    piece(Part::card, rect);
    return rect;
  }
  void close(const Rect& card) {
    item(Widget::close, 0, {card.x + card.width - m_.target, card.y, m_.target, m_.target});
  }
  [[nodiscard]] double most_width() const { return m_.width - 2.0 * m_.margin; }
  [[nodiscard]] double most_height() const { return m_.height - 2.0 * m_.margin; }

  void take_home() {
    const double pad = 1.5 * m_.margin;
    const double qr = std::floor(std::min(0.46 * m_.edge, most_width() - 2.0 * pad));
    const double text = 6.0 * m_.target;
    if (!m_.portrait && qr + text + 3.0 * pad <= most_width()) {
      const Rect rect = card(qr + text + 3.0 * pad, qr + 2.0 * pad);
      piece(Part::qr, {rect.x + pad, rect.y + pad, qr, qr});
      piece(Part::body, {rect.x + 2.0 * pad + qr, rect.y + pad, text, qr});
      close(rect);
      return;
    }
    const double words = std::min(3.0 * m_.target, most_height() - qr - 2.0 * pad - m_.target);
    const Rect rect =
        card(std::min(qr + 2.0 * pad + 1.5 * m_.target, most_width()), m_.target + qr + words + 2.0 * pad);
    piece(Part::qr, {rect.x + (rect.width - qr) / 2.0, rect.y + m_.target, qr, qr});
    piece(Part::body, {rect.x + pad, rect.y + m_.target + qr + pad, rect.width - 2.0 * pad, words});
    close(rect);
  }

  void about() {
    const double pad = 1.5 * m_.margin;
    const Rect rect = card(std::min(most_width(), std::max(0.92 * m_.edge, 7.0 * m_.target)),
                           std::min(most_height(), std::max(0.5 * m_.edge, 5.0 * m_.target)));
    piece(Part::body, {rect.x + pad, rect.y + pad, rect.width - 2.0 * pad, rect.height - 2.0 * pad});
    close(rect);
  }

  void pin() {
    // Title and close, dots, four rows of keys.
    // Whole pixels, or neighbours' rounded edges meet.
    const double key = std::floor(std::min(1.35 * m_.target, (most_height() - 2.1 * m_.target) / 4.0));
    const double inset = std::min(m_.margin, 0.25 * m_.target);
    const Rect rect =
        card(3.0 * key + 2.0 * inset + 0.6 * m_.target, std::min(most_height(), 4.0 * key + 2.1 * m_.target));
    const double left = std::round(rect.x + (rect.width - 3.0 * key) / 2.0);
    piece(Part::title, {left, rect.y, rect.x + rect.width - m_.target - left, m_.target});
    piece(Part::digits, {left, rect.y + m_.target, 3.0 * key, 0.9 * m_.target});
    close(rect);
    const double top = std::round(rect.y + 1.9 * m_.target);
    // As on a telephone; delete and confirm beside the 0.
    for (int at = 0; at < 12; ++at) {
      const int index = at < 9 ? at + 1 : (at == 9 ? 10 : (at == 10 ? 0 : 11));
      const int row = at / 3;
      item(Widget::pin_key, index, {left + (at % 3) * key, top + row * key, key, key});
    }
  }

  void dealer() {
    if (model_.dealer.calibration_step >= 0) {
      const Place at = calibration_cross(surface_, model_.dealer.calibration_step);
      const double arm = std::round(0.5 * m_.target);
      piece(Part::cross, {at[0] - 0.5 - arm, at[1] - 0.5 - arm, 2.0 * arm + 1.0, 2.0 * arm + 1.0});
      piece(Part::title, {m_.margin, (m_.height - m_.target) / 2.0, most_width(), m_.target});
      return;
    }
    if (model_.dealer.test_pattern) {
      // The pattern is the picture: only the way back lies on it.
      item(Widget::action, static_cast<int>(ScreenAction::test_pattern),
           {(m_.width - 4.0 * m_.target) / 2.0, m_.height - m_.margin - m_.target, 4.0 * m_.target, m_.target});
      return;
    }
    const Rect rect = whole({m_.margin, m_.margin, most_width(), most_height()});
    piece(Part::card, rect);
    close(rect);
    const Rect page = m_.portrait ? tabs_above(rect) : tabs_beside(rect);
    if (model_.dealer.page == DealerPage::screen)
      screen_page(page);
    else if (model_.dealer.page == DealerPage::options)
      options_page(page);
    else
      piece(Part::body, page);
  }

  [[nodiscard]] Rect tabs_beside(const Rect& rect) {
    const double width = std::round(std::min(4.2 * m_.target, 0.3 * rect.width));
    const double height = std::floor(std::min(1.15 * m_.target, rect.height / dealer_pages));
    for (int k = 0; k < dealer_pages; ++k) item(Widget::page, k, {rect.x, rect.y + k * height, width, height});
    const double x = rect.x + width + m_.margin;
    piece(Part::title, {x, rect.y, rect.x + rect.width - m_.target - x, m_.target});
    const double y = rect.y + m_.target + 0.4 * m_.margin;
    return {x, y, rect.x + rect.width - m_.margin - x, rect.y + rect.height - m_.margin - y};
  }
  [[nodiscard]] Rect tabs_above(const Rect& rect) {
    piece(Part::title, {rect.x + m_.margin, rect.y, rect.width - m_.target - m_.margin, m_.target});
    const double width = std::floor(rect.width / 3.0);
    for (int k = 0; k < dealer_pages; ++k) {
      const int row = 1 + k / 3;
      item(Widget::page, k, {rect.x + (k % 3) * width, rect.y + row * m_.target, width, m_.target});
    }
    const double y = rect.y + 3.0 * m_.target + m_.margin;
    return {rect.x + m_.margin, y, rect.width - 2.0 * m_.margin, rect.y + rect.height - m_.margin - y};
  }

  [[nodiscard]] Rect row(const Rect& page, int at) const {
    const double height = std::floor(std::min(1.15 * m_.target, std::max(m_.target, page.height / 4.0)));
    return {page.x, page.y + at * height, std::min(page.width, 12.0 * m_.target), m_.target};
  }
  void screen_page(const Rect& page) {
    const Rect first = row(page, 0);
    const int brightness = static_cast<int>(ScreenValue::brightness);
    // The name and the value, then the two steps at the end of the row.
    piece(Part::value, {first.x, first.y, first.width - 2.0 * m_.target, first.height}, brightness);
    const double x = first.x + first.width - 2.0 * m_.target;
    item(Widget::step_down, brightness, {x, first.y, m_.target, m_.target});
    item(Widget::step_up, brightness, {x + m_.target, first.y, m_.target, m_.target});
    item(Widget::action, static_cast<int>(ScreenAction::test_pattern), row(page, 1));
    item(Widget::action, static_cast<int>(ScreenAction::calibrate), row(page, 2));
    const Rect last = row(page, 3);
    piece(Part::body, {last.x, last.y, last.width, std::max(1.0, page.y + page.height - last.y)});
  }
  void options_page(const Rect& page) {
    item(Widget::action, static_cast<int>(OptionAction::beyond), row(page, 0));
    item(Widget::action, static_cast<int>(OptionAction::language), row(page, 1));
    item(Widget::action, static_cast<int>(OptionAction::reduced_motion), row(page, 2));
  }

  const Metrics& m_;
  const Surface& surface_;
  const Model& model_;
  Arrangement& out_;
};

}  // namespace

void arrange_card(const Metrics& metrics, const Surface& surface, const Model& model, Arrangement& out) {
  Card(metrics, surface, model, out).arrange();
}

}  // namespace lackwerk::kiosk::ui
