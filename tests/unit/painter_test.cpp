// The interface's pixels: drawn only where something changed, readable over every paint, whole at every size.
#include "kiosk/display/ui/painter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "kiosk/display/ui/arrangement.hpp"
#include "kiosk/display/ui/qr.hpp"
#include "kiosk/display/ui/theme.hpp"
#include "tests/unit/tile_canvas.hpp"

namespace lackwerk::kiosk::ui {
namespace {

using Rgb = std::array<int, 3>;
constexpr std::array<Rgb, 5> backgrounds{{{255, 255, 255}, {0, 0, 0}, {255, 0, 0}, {0, 0, 255}, {255, 255, 0}}};
constexpr std::array all_languages{Language::english, Language::german, Language::arabic};
constexpr const char* long_name = "Polaris Silber mit Klarlack (Guenther et al. 2005)";

Content content_of(std::size_t paints) {
  Content content;
  content.pack_id = "test";
  const std::array<std::array<double, 3>, 5> colours{
      {{0.95, 0.95, 0.93}, {0.3, 0.32, 0.35}, {0.1, 0.3, 0.7}, {0.7, 0.05, 0.1}, {0.02, 0.02, 0.02}}};
  for (std::size_t k = 0; k < paints; ++k) {
    PaintFacts facts;
    facts.identity.name = k == 0 ? long_name : "Paint " + std::to_string(k);
    facts.identity.source = "a source that is rather long and goes on for more than one line of the card it stands on";
    facts.srgb = colours[k % colours.size()];
    content.paints.push_back(facts);
  }
  content.beyond_limit = 0.3;
  return content;
}

Model show_model(std::size_t paints = 3) {
  Model model;
  model.screen = Screen::show;
  model.swatches = first_places(paints);
  model.beyond_shown = true;
  model.mix_name = "72 % Paint 1, 28 % Paint 2, lively";
  model.mix_code = "LW1ABCDEFGH0123456789";
  return model;
}

DealerFacts facts() {
  DealerFacts out;
  out.status.state = "running";
  out.status.platform = "kms";
  out.status.packs = {{"demo.lwp", "demo", 3, true, {"A", "B"}}};
  out.status.devices = {{"Panel", "touch", "ready", "/dev/input/event1"}, {"Dial", "dial", "gone", "unplugged"}};
  out.log = {"something went wrong (do this)", "something else"};
  out.import.emplace();
  out.import->error = "lackwerk: something is wrong with the stick";
  out.import->files.resize(2);
  out.import->files[0].error = "a.lwp: not signed";
  out.import->files[1].outcome = ImportedFile::Outcome::stored;
  return out;
}

Toast toast(bool good) {
  Toast out;
  if (good) out.stored = {"demo.spring", "demo.summer"};
  out.refused = 2;
  out.reason = "rogue.lwp: signed with key 0123456789ABCDEF, which is not in the keyring (put the maker's key there)";
  return out;
}

std::vector<Model> show_models(Language language) {
  std::vector<Model> models(9, show_model());
  models[1].hint = true;
  models[2].nearest = Nearest{0, {1.2, 0.8, 12.4}};
  models[3].countdown_s = 12.0;
  models[4].focus = Widget::sparkle;
  models[5].focus = Widget::pad;
  models[6].focus = Widget::car;
  models[6].sparkle_free = true;
  models[6].pressed = Widget::light;
  models[7].toast = toast(true);
  models[8].toast = toast(false);
  models[8].countdown_s = 3.0;
  for (Model& model : models) model.language = language;
  return models;
}

std::vector<Model> models(Language language) {
  std::vector<Model> out = show_models(language);
  Model model = show_model();
  model.language = language;
  for (const Screen screen : {Screen::attract, Screen::take_home, Screen::about, Screen::pin}) {
    model.screen = screen;
    out.push_back(model);
    model.toast = toast(false);
    out.push_back(model);
    model.toast.reset();
  }
  model.pin = {0, 2, 0.0, true};
  model.screen = Screen::pin;
  out.push_back(model);
  model.screen = Screen::dealer;
  for (int page = 0; page < dealer_pages; ++page) {
    model.dealer.page = static_cast<DealerPage>(page);
    out.push_back(model);
  }
  model.dealer.test_pattern = true;
  out.push_back(model);
  model.dealer.calibration_step = 3;
  out.push_back(model);
  return out;
}

class PainterTest : public testing::Test {
 protected:
  void SetUp() override {
    auto made = Painter::create();
    if (!made) GTEST_SKIP() << made.error().line();
    painter_ = std::move(*made);
  }
  /// Draws and keeps; the updates of this call.
  std::vector<TileUpdate> paint(const Model& model, const Surface& surface = {}, const Content* content = nullptr) {
    const Content usual = content_of(model.swatches.size());
    const Painted& painted = painter_->paint(surface, content != nullptr ? *content : usual, model, &facts_);
    EXPECT_TRUE(canvas_.take(painted)) << "screen " << static_cast<int>(model.screen);
    return painted.updates;
  }
  gles::Image over(Rgb colour, const Surface& surface = {}) const {
    gles::Image picture(surface.size_px[0], surface.size_px[1]);
    for (std::size_t k = 0; k < picture.rgb.size(); ++k) picture.rgb[k] = static_cast<std::uint8_t>(colour[k % 3]);
    canvas_.draw_over(picture);
    return picture;
  }

  std::unique_ptr<Painter> painter_;
  DealerFacts facts_ = facts();
  TileCanvas canvas_;
};

TEST_F(PainterTest, NothingChangesNothingIsDrawn) {
  for (const Language language : all_languages)
    for (const Model& model : models(language)) {
      (void)paint(model);
      const std::vector<Sprite> before = canvas_.sprites();
      const auto drawn = painter_->tiles_drawn();
      EXPECT_TRUE(paint(model).empty());
      EXPECT_EQ(canvas_.sprites(), before);
      EXPECT_EQ(painter_->tiles_drawn(), drawn);
    }
}

TEST_F(PainterTest, TilesAreFewLieInsideAndAreGivenUp) {
  for (const Surface surface : {Surface{{1280, 720}, 96.0}, Surface{{1080, 1920}, 96.0}, Surface{{2560, 1440}, 110.0},
                                Surface{{1890, 1063}, 300.0}, Surface{{800, 480}, 120.0}})
    for (const std::size_t paints : {1U, 2U, 5U})
      for (Model model : models(Language::arabic)) {
        model.swatches = first_places(paints);
        (void)paint(model, surface);
        EXPECT_LE(canvas_.sprites().size(), 64U);
        EXPECT_EQ(canvas_.tiles().size(), canvas_.sprites().size()) << "a tile nobody shows was kept";
        for (const Sprite& sprite : canvas_.sprites()) {
          EXPECT_TRUE(sprite.x_px >= 0 && sprite.y_px >= 0 && sprite.x_px + sprite.width_px <= surface.size_px[0] &&
                      sprite.y_px + sprite.height_px <= surface.size_px[1])
              << "screen " << static_cast<int>(model.screen) << " at " << sprite.x_px << ", " << sprite.y_px << " size "
              << sprite.width_px << "x" << sprite.height_px << " on " << surface.size_px[0] << "x"
              << surface.size_px[1];
        }
      }
}

TEST_F(PainterTest, WhatMovesIsNotDrawnAnew) {
  Model model = show_model();
  (void)paint(model);
  const std::vector<Sprite> before = canvas_.sprites();
  model.puck = {0.2, 0.7};
  model.sparkle = 0.6;
  model.hue = 0.3;
  model.beyond = 0.5;
  model.dimmer = 0.9;
  EXPECT_TRUE(paint(model).empty());
  EXPECT_NE(canvas_.sprites(), before);
}

TEST_F(PainterTest, DraggingThePuckDrawsTheNameOnly) {
  Model model = show_model();
  model.puck_held = true;
  (void)paint(model);
  const auto everything = canvas_.covered_px();
  model.puck = {0.3, 0.3};
  model.mix_name = "71 % Paint 1, 29 % Paint 2, lively";
  const auto updates = paint(model);
  ASSERT_EQ(updates.size(), 1U);
  EXPECT_LT(static_cast<long long>(updates[0].width) * updates[0].height, everything / 5);
}

TEST_F(PainterTest, MovingASwatchDrawsNothingUntilItIsLetGo) {
  Model model = show_model();
  (void)paint(model);
  model.swatch_held = 1;
  EXPECT_EQ(paint(model).size(), 2U) << "lifted off, and the pad's colours are gone";
  model.swatches[1] = {0.8, 0.8};
  EXPECT_TRUE(paint(model).empty());
  model.swatch_held = -1;
  EXPECT_EQ(paint(model).size(), 2U);
}

TEST_F(PainterTest, SwatchShowsItsOwnPicture) {
  const Surface surface;
  const Content content = content_of(3);
  const Model model = show_model();
  (void)paint(model);
  const int edge = painter_->swatch_edge_px(surface, content);
  ASSERT_GT(edge, 16);
  std::vector<std::uint8_t> green(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge) * 3, 0);
  for (std::size_t k = 1; k < green.size(); k += 3) green[k] = 200;
  painter_->set_swatch(1, edge, green);
  EXPECT_EQ(paint(model).size(), 1U);
  const auto item = find_item(layout(surface, content, model), Widget::swatch, 1);
  const Place centre = item->rect.centre();
  const gles::Image picture = over({0, 0, 0});
  const std::uint8_t* pixel =
      picture.pixel(static_cast<int>(centre[0]), static_cast<int>(centre[1] + item->rect.height / 4));
  EXPECT_GT(pixel[1], 180);
  EXPECT_LT(pixel[0], 30);
  // A picture of another size than it says, or of no paint, is not taken.
  painter_->set_swatch(1, edge, {1, 2, 3});
  painter_->set_swatch(1'000'000, 1, {1, 2, 3});
  EXPECT_EQ(paint(model).size(), 1U) << "back to a plain disc";
}

TEST_F(PainterTest, LongNamesStayOnThePad) {
  for (const auto& size : {std::array{1280, 720}, std::array{1080, 1920}, std::array{1024, 768}}) {
    const Surface surface{size, 96.0};
    for (std::size_t paints = 1; paints <= 5; ++paints) {
      Content content = content_of(paints);
      for (PaintFacts& paint : content.paints) paint.identity.name = "Polaris Silber mit sehr vielem Klarlack darüber";
      Model model = show_model(paints);
      for (Place& place : model.swatches) place = {place[0] < 0.5 ? 0.0 : 1.0, place[1]};
      (void)paint(model, surface, &content);
      const Rect pad = find_item(layout(surface, content, model), Widget::pad)->rect;
      int labels = 0;
      for (const Sprite& sprite : canvas_.sprites()) {
        // Names are as high as the layout gives them, nothing else is.
        if (sprite.height_px != static_cast<int>(metrics_of(surface).label)) continue;
        ++labels;
        EXPECT_GE(sprite.x_px, pad.x);
        EXPECT_LE(sprite.x_px + sprite.width_px, pad.x + pad.width);
      }
      EXPECT_EQ(labels, static_cast<int>(paints));
    }
  }
}

TEST_F(PainterTest, CodeIsWholePixelsWithItsQuietZone) {
  for (const auto& size : {std::array{1280, 720}, std::array{1080, 1920}, std::array{640, 480}}) {
    const Surface surface{size, 96.0};
    Model model = show_model();
    model.screen = Screen::take_home;
    model.mix_code = "LW1" + std::string(110, 'A');  // longer than any of five paints
    (void)paint(model, surface);
    const auto code = qr_of(model.mix_code);
    ASSERT_TRUE(code);
    const Rect box = *arrange(surface, content_of(3), model).find(Part::qr);
    const int modules = code->side + 2 * quiet_zone;
    const int module = static_cast<int>(box.width) / modules;
    ASSERT_GE(module, 3);
    const gles::Image picture = over({128, 128, 128}, surface);
    const int x0 = static_cast<int>(std::lround(box.x + (box.width - module * modules) / 2.0));
    const int y0 = static_cast<int>(std::lround(box.y + (box.height - module * modules) / 2.0));
    int wrong = 0;
    for (int y = 0; y < modules * module; ++y)
      for (int x = 0; x < modules * module; ++x) {
        const int column = x / module - quiet_zone, row = y / module - quiet_zone;
        const bool inside = column >= 0 && row >= 0 && column < code->side && row < code->side;
        // The quiet zone's corners are round.
        if (!inside && (x < 2 * module || x >= (modules - 2) * module) &&
            (y < 2 * module || y >= (modules - 2) * module))
          continue;
        const int expected = inside && code->is_dark(column, row) ? 0 : 255;
        if (picture.pixel(x0 + x, y0 + y)[1] != expected) ++wrong;
      }
    EXPECT_EQ(wrong, 0);
  }
}

TEST_F(PainterTest, AsleepIsDark) {
  (void)paint(show_model());
  Model model = show_model();
  model.asleep = true;
  (void)paint(model);
  EXPECT_TRUE(canvas_.sprites().empty());
  EXPECT_TRUE(canvas_.tiles().empty());
}

TEST_F(PainterTest, OddModelsAreNotAFailure) {
  Model model = show_model(3);
  Content content = content_of(3);
  model.swatches.resize(1);
  model.nearest = Nearest{99, {}};
  model.about_paint = -4;
  model.mix_code.clear();
  model.pin.digits = 1'000'000;
  model.dealer.page = static_cast<DealerPage>(77);
  for (const Screen screen :
       {Screen::attract, Screen::show, Screen::take_home, Screen::about, Screen::pin, Screen::dealer})
    for (const std::array<int, 2> size : {std::array{1280, 720}, std::array{64, 64}, std::array{1, 1}}) {
      model.screen = screen;
      EXPECT_TRUE(canvas_.take(painter_->paint({size, 96.0}, content, model, nullptr)));
    }
  content.paints.clear();
  model.screen = Screen::show;
  EXPECT_TRUE(canvas_.take(painter_->paint({}, content, model, nullptr)));
}

TEST_F(PainterTest, SameModelsSamePixels) {
  auto other = Painter::create();
  ASSERT_TRUE(other);
  TileCanvas second;
  for (const Model& model : models(Language::german)) {
    (void)paint(model);
    const Content content = content_of(3);
    second.take((*other)->paint({}, content, model, &facts_));
    gles::Image a(1280, 720), b(1280, 720);
    canvas_.draw_over(a);
    second.draw_over(b);
    EXPECT_TRUE(a == b) << static_cast<int>(model.screen);
  }
}

TEST_F(PainterTest, PanelsLeaveThePictureToTheCar) {
  (void)paint(show_model());
  EXPECT_LT(canvas_.covered_px(), 1280LL * 720 * 3 / 10);
}

// ---- contrast, as WCAG 2.1 reckons it

double linear(double value) { return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4); }
double luminance(double r, double g, double b) { return 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b); }
/// Relative luminance of pixels; the curve is reckoned once for its 256 values.
class Luminance {
 public:
  Luminance() {
    for (std::size_t k = 0; k < linear_.size(); ++k) linear_[k] = linear(static_cast<double>(k) / 255.0);
  }
  double operator()(const std::uint8_t* pixel) const {
    return 0.2126 * linear_[pixel[0]] + 0.7152 * linear_[pixel[1]] + 0.0722 * linear_[pixel[2]];
  }

 private:
  std::array<double, 256> linear_{};
};
double contrast(double a, double b) { return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05); }

struct Lettering {
  double ink = 0.0;     ///< brightest of the region
  double ground = 0.0;  ///< what most of it shows
};
Lettering lettering(const gles::Image& picture, const Rect& region) {
  const Luminance luminance_of;
  std::vector<double> values;
  for (int y = static_cast<int>(region.y); y < static_cast<int>(region.y + region.height); ++y)
    for (int x = static_cast<int>(region.x); x < static_cast<int>(region.x + region.width); ++x)
      values.push_back(luminance_of(picture.pixel(x, y)));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return {*std::max_element(middle, values.end()), *middle};
}

/// Where there is text on this model's screen.
std::vector<Rect> text_regions(const Arrangement& arrangement, const Model& model) {
  std::vector<Rect> out;
  for (const Piece& piece : arrangement.pieces)
    if (model.dealer.calibration_step >= 0 && piece.part == Part::title)
      // A pill in the middle of the line.
      out.push_back({piece.rect.centre()[0] - 60.0, piece.rect.y, 120.0, piece.rect.height});
    else if (piece.part == Part::mix_name || piece.part == Part::title || piece.part == Part::digits ||
             piece.part == Part::value || piece.part == Part::compare_right)
      out.push_back(piece.rect);
    else if (piece.part == Part::body && model.screen != Screen::about && model.dealer.page < DealerPage::screen)
      out.push_back({piece.rect.x, piece.rect.y, piece.rect.width, std::min(piece.rect.height, 120.0)});
  for (const Item& item : arrangement.items)
    if (item.widget == Widget::swatch_about || item.widget == Widget::page || item.widget == Widget::action ||
        item.widget == Widget::pin_key || item.widget == Widget::countdown)
      out.push_back(item.rect);
  return out;
}

TEST_F(PainterTest, TextIsReadableOverEveryPaint) {
  const Surface surface;
  int regions = 0;
  for (const Language language : all_languages)
    for (Model model : models(language)) {
      model.puck = {0.5, 0.55};  // off the names
      model.hint = false;
      (void)paint(model);
      const Arrangement arrangement = arrange(surface, content_of(3), model);
      for (const Rgb& background : backgrounds) {
        const gles::Image picture = over(background);
        for (const Rect& region : text_regions(arrangement, model)) {
          const Lettering found = lettering(picture, region);
          ++regions;
          EXPECT_GE(contrast(found.ink, found.ground), 4.5)
              << "screen " << static_cast<int>(model.screen) << ", page " << static_cast<int>(model.dealer.page)
              << ", language " << static_cast<int>(language) << ", background " << background[0] << " " << background[1]
              << " " << background[2] << ", region at " << region.x << ", " << region.y;
        }
      }
    }
  EXPECT_GT(regions, 1000);
}

TEST_F(PainterTest, EveryTextColourIsReadableOnGlassAsItIsDrawn) {
  const auto of = [](const Colour& colour) { return luminance(colour.r, colour.g, colour.b); };
  const Surface surface;
  for (const Rgb& background : backgrounds) {
    // The pad is the lightest glass: it carries names in `text_colour`; the others carry the quiet colour and the
    // accent.
    (void)paint(show_model());
    const Arrangement show = arrange(surface, content_of(3), show_model());
    const gles::Image picture = over(background);
    const Rect pad = find_item(show.items, Widget::pad)->rect;
    EXPECT_GE(contrast(of(text_colour), lettering(picture, pad).ground), 4.5);
    for (const Part part : {Part::light_glass, Part::slider_glass, Part::dock_glass}) {
      const double ground = lettering(picture, *show.find(part)).ground;
      for (const Colour& colour : {text_colour, quiet, accent}) EXPECT_GE(contrast(of(colour), ground), 4.5);
    }
  }
}

TEST_F(PainterTest, AttractIsReadableOverEveryPaint) {
  for (const Language language : all_languages) {
    Model model = show_model();
    model.screen = Screen::attract;
    model.language = language;
    (void)paint(model);
    ASSERT_EQ(canvas_.sprites().size(), 2U);
    for (const Rgb& background : backgrounds) {
      const gles::Image picture = over(background);
      for (const Sprite& sprite : canvas_.sprites()) {
        // The middle of the pill, where its words are.
        const Rect words{sprite.x_px + 0.3 * sprite.width_px, sprite.y_px + 0.2 * sprite.height_px,
                         0.5 * sprite.width_px, 0.6 * sprite.height_px};
        const Lettering found = lettering(picture, words);
        EXPECT_GE(contrast(found.ink, found.ground), 4.5);
      }
    }
  }
}

}  // namespace
}  // namespace lackwerk::kiosk::ui
