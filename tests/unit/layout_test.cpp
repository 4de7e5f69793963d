// What is seen and touched has a place on every surface, in both directions of writing.
#include "kiosk/display/ui/layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "kiosk/display/ui/arrangement.hpp"

namespace lackwerk::kiosk::ui {
namespace {

Content content_of(std::size_t paints) {
  Content content;
  content.paints.resize(paints);
  content.beyond_limit = 0.3;
  return content;
}

Model model_of(std::size_t paints, Screen screen) {
  Model model;
  model.screen = screen;
  model.swatches = first_places(paints);
  model.beyond_shown = true;
  model.hint = true;
  return model;
}

/// Every screen, every dealer's page, with a countdown and without.
std::vector<Model> models(std::size_t paints, Language language) {
  std::vector<Model> out;
  for (const Screen screen :
       {Screen::attract, Screen::show, Screen::take_home, Screen::about, Screen::pin, Screen::dealer}) {
    Model model = model_of(paints, screen);
    model.language = language;
    if (screen != Screen::dealer) {
      out.push_back(model);
      model.countdown_s = 9.0;
      model.nearest = Nearest{};
      model.toast.emplace();
      out.push_back(model);
      continue;
    }
    for (int page = 0; page < dealer_pages; ++page) {
      model.dealer.page = static_cast<DealerPage>(page);
      out.push_back(model);
    }
    model.dealer.test_pattern = true;
    out.push_back(model);
    model.dealer.calibration_step = 2;
    out.push_back(model);
  }
  return out;
}

bool inside(const Rect& rect, const Surface& surface) {
  return rect.width > 0.0 && rect.height > 0.0 && rect.x >= 0.0 && rect.y >= 0.0 &&
         rect.x + rect.width <= surface.size_px[0] && rect.y + rect.height <= surface.size_px[1];
}

bool overlap(const Rect& a, const Rect& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

/// Pad, its swatches and their names lie on one another, the countdown over everything: item_at tells them apart.
bool lies_on_others(Widget widget) {
  return widget == Widget::pad || widget == Widget::swatch || widget == Widget::swatch_about ||
         widget == Widget::countdown;
}

std::string described(const Surface& surface, const Model& model, const Item& item) {
  return std::to_string(surface.size_px[0]) + "x" + std::to_string(surface.size_px[1]) + " at " +
         std::to_string(surface.dpi) + " dpi, screen " + std::to_string(static_cast<int>(model.screen)) + ", page " +
         std::to_string(static_cast<int>(model.dealer.page)) + ", paints " + std::to_string(model.swatches.size()) +
         ", widget " + std::to_string(static_cast<int>(item.widget)) + " " + std::to_string(item.index);
}

void check(const Surface& surface, const Content& content, const Model& model) {
  const auto items = layout(surface, content, model);
  const double shorter_mm = std::min(surface.size_px[0], surface.size_px[1]) / surface.dpi * 25.4;
  const double least_px = least_touch_mm * surface.dpi / 25.4;
  for (const Item& item : items) {
    SCOPED_TRACE(described(surface, model, item));
    EXPECT_TRUE(inside(item.rect, surface));
    EXPECT_TRUE(inside(item.touch, surface));
    if (shorter_mm >= 90.0) {
      EXPECT_GE(item.touch.width, least_px);
      EXPECT_GE(item.touch.height, least_px);
    }
  }
  for (std::size_t i = 0; i < items.size(); ++i)
    for (std::size_t j = i + 1; j < items.size(); ++j) {
      if (items[i].widget == Widget::countdown || items[j].widget == Widget::countdown) continue;
      if (lies_on_others(items[i].widget) && lies_on_others(items[j].widget)) continue;
      EXPECT_FALSE(overlap(items[i].touch, items[j].touch))
          << described(surface, model, items[i]) << " over " << described(surface, model, items[j]);
    }
  for (const Piece& piece : arrange(surface, content, model).pieces)
    EXPECT_TRUE(inside(piece.rect, surface))
        << described(surface, model, {}) << " part " << static_cast<int>(piece.part);
}

constexpr std::array<int, 2> sizes[] = {{640, 480},   {1024, 600},  {1024, 768},  {1280, 720},  {720, 1280},
                                        {1080, 1080}, {1280, 1024}, {1024, 1280}, {1920, 1080}, {1080, 1920},
                                        {2560, 1080}, {3840, 2160}, {2160, 3840}};

TEST(Layout, TouchTargetsAreLargeApartAndInsideOnEverySurface) {
  for (const auto& size : sizes)
    for (const double dpi : {60.0, 96.0, 120.0, 160.0, 220.0, 300.0})
      for (std::size_t paints = 1; paints <= 5; ++paints)
        for (const Language language : {Language::english, Language::arabic})
          for (const Model& model : models(paints, language)) check({size, dpi}, content_of(paints), model);
}

TEST(Layout, TheSliderOfTimeHasAPlaceOnEverySurface) {
  Content content = content_of(1);
  content.scans = ScanFacts{"Tomato", "days", {5.0, 6.0, 8.0}};
  for (const auto& size : sizes)
    for (const double dpi : {60.0, 96.0, 160.0, 300.0})
      for (const Language language : {Language::english, Language::arabic})
        for (const Model& model : models(1, language)) {
          check({size, dpi}, content, model);
          if (model.screen != Screen::show) continue;
          const auto items = layout({size, dpi}, content, model);
          const auto time = find_item(items, Widget::time);
          ASSERT_TRUE(time);
          EXPECT_FALSE(find_item(items, Widget::pad));
          // The hand points at its knob.
          const Track track = slider_track({size, dpi}, *time, language);
          const auto hint = arrange({size, dpi}, content, model).find(Part::hint);
          ASSERT_TRUE(hint);
          if (model.nearest) continue;
          EXPECT_NEAR(hint->centre()[0],
                      std::clamp(track.at(model.time)[0], 0.5 * hint->width, size[0] - 0.5 * hint->width), 2.0);
        }
}

TEST(Layout, SmallestSurfaceWithRoomStillHasTwelveMillimetres) {
  // 90 mm along the shorter edge at 300 dpi.
  for (const std::array<int, 2> size : {std::array{1063, 1063}, std::array{1890, 1063}, std::array{1063, 1890}})
    for (const Model& model : models(5, Language::german)) check({size, 300.0}, content_of(5), model);
}

TEST(Layout, AnySurfaceGivesSomething) {
  for (const std::array<int, 2> size : {std::array{1, 1}, std::array{0, 0}, std::array{3, 900}, std::array{320, 200}})
    for (const Model& model : models(3, Language::english))
      for (const Item& item : layout({size, 96.0}, content_of(3), model)) {
        EXPECT_GE(item.rect.width, 1.0);
        EXPECT_GE(item.rect.height, 1.0);
      }
}

TEST(Layout, EveryFeatureHasItsWidget) {
  const Surface surface;
  const Content content = content_of(3);
  Model model = model_of(3, Screen::show);
  const auto there = [&](Widget widget, int index = 0) {
    return find_item(layout(surface, content, model), widget, index).has_value();
  };
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(there(Widget::swatch, k));
    EXPECT_TRUE(there(Widget::swatch_about, k));
    EXPECT_TRUE(there(Widget::light, k));
  }
  for (const Widget widget : {Widget::pad, Widget::sparkle, Widget::hue, Widget::beyond, Widget::sparkle_lock,
                              Widget::hue_lock, Widget::dimmer, Widget::compare, Widget::take_home})
    EXPECT_TRUE(there(widget)) << static_cast<int>(widget);
  EXPECT_FALSE(there(Widget::countdown));
  model.beyond_shown = false;
  EXPECT_FALSE(there(Widget::beyond));
}

TEST(Layout, WithoutFlakesThereIsNothingToSetOnThem) {
  Content content = content_of(2);
  content.has_flakes = false;
  content.beyond_limit = 0.0;
  const auto items = layout({}, content, model_of(2, Screen::show));
  for (const Widget widget : {Widget::sparkle, Widget::hue, Widget::beyond, Widget::sparkle_lock, Widget::hue_lock})
    EXPECT_FALSE(find_item(items, widget)) << static_cast<int>(widget);
}

TEST(Layout, SleepingKioskShowsNothing) {
  Model model = model_of(3, Screen::attract);
  model.asleep = true;
  EXPECT_TRUE(layout({}, content_of(3), model).empty());
}

TEST(Layout, TouchFindsWhatIsThere) {
  const Surface surface;
  const Content content = content_of(5);
  for (const Language language : {Language::english, Language::arabic})
    for (const Model& model : models(5, language)) {
      const auto items = layout(surface, content, model);
      const bool counting = model.countdown_s.has_value();
      for (const Item& item : items) {
        if (item.widget == Widget::pad) continue;  // its middle may be a swatch's
        const Item found = item_at(items, model.screen, item.rect.centre());
        EXPECT_EQ(found.widget, counting ? Widget::countdown : item.widget) << described(surface, model, item);
        if (!counting) {
          EXPECT_EQ(found.index, item.index) << described(surface, model, item);
        }
      }
    }
}

TEST(Layout, BesideEverythingIsTheCar) {
  const Place middle{640.0, 300.0};
  const Content content = content_of(3);
  const auto hit = [&](Screen screen) {
    return item_at(layout({}, content, model_of(3, screen)), screen, middle).widget;
  };
  EXPECT_EQ(hit(Screen::show), Widget::car);
  EXPECT_EQ(hit(Screen::attract), Widget::car);
  EXPECT_EQ(hit(Screen::about), Widget::none);
}

TEST(Layout, NearestSwatchWinsWhereTwoMeet) {
  const Surface surface;
  Model model = model_of(3, Screen::show);
  model.swatches = {{0.3, 0.5}, {0.45, 0.5}, {0.9, 0.9}};
  const auto items = layout(surface, content_of(3), model);
  const Rect a = find_item(items, Widget::swatch, 0)->rect, b = find_item(items, Widget::swatch, 1)->rect;
  ASSERT_TRUE(overlap(a, b));
  const double middle = (a.centre()[0] + b.centre()[0]) / 2.0;
  EXPECT_EQ(item_at(items, Screen::show, {middle - 2.0, a.centre()[1]}).index, 0);
  EXPECT_EQ(item_at(items, Screen::show, {middle + 2.0, a.centre()[1]}).index, 1);
}

TEST(Layout, ArabicMirrorsThePageButNotThePad) {
  const Surface surface;
  const Content content = content_of(3);
  Model model = model_of(3, Screen::show);
  model.swatches = {{0.0, 0.0}, {1.0, 0.2}, {0.3, 1.0}};
  const auto left_to_right = layout(surface, content, model);
  model.language = Language::arabic;
  const auto right_to_left = layout(surface, content, model);
  const auto rect = [](const std::vector<Item>& items, Widget widget, int index = 0) {
    return find_item(items, widget, index)->rect;
  };
  const Rect pad = rect(left_to_right, Widget::pad), mirrored = rect(right_to_left, Widget::pad);
  EXPECT_DOUBLE_EQ(mirrored.x, surface.size_px[0] - pad.x - pad.width);
  EXPECT_GT(pad.centre()[0], surface.size_px[0] / 2.0);
  for (int k = 0; k < 3; ++k)
    EXPECT_DOUBLE_EQ(rect(right_to_left, Widget::swatch, k).x - mirrored.x,
                     rect(left_to_right, Widget::swatch, k).x - pad.x);
  const Item slider = *find_item(left_to_right, Widget::sparkle);
  const Track along = slider_track(surface, slider, Language::english);
  EXPECT_LT(along.from[0], along.to[0]);
  const Track back = slider_track(surface, *find_item(right_to_left, Widget::sparkle), Language::arabic);
  EXPECT_GT(back.from[0], back.to[0]);
}

TEST(Layout, TrackAndItsPositionsAreInverse) {
  const Surface surface;
  const auto items = layout(surface, content_of(3), model_of(3, Screen::show));
  for (const Widget widget : {Widget::sparkle, Widget::hue, Widget::beyond, Widget::dimmer})
    for (const Language language : {Language::english, Language::arabic}) {
      const Item slider = *find_item(items, widget);
      const Track track = slider_track(surface, slider, language);
      EXPECT_TRUE(slider.rect.contains(track.from) && slider.rect.contains(track.to));
      for (const double position : {0.0, 0.3, 1.0}) EXPECT_NEAR(track.position(track.at(position)), position, 1e-12);
      EXPECT_EQ(track.position({-1e6, 0.0}), language == Language::arabic ? 1.0 : 0.0);
    }
}

TEST(Layout, FieldLiesInsideThePadAndKeepsSwatchesWhole) {
  for (const auto& size : sizes) {
    const Surface surface{size, 110.0};
    for (std::size_t paints = 2; paints <= 5; ++paints) {
      Model model = model_of(paints, Screen::show);
      for (Place& place : model.swatches) place = {place[0] < 0.5 ? 0.0 : 1.0, place[1] < 0.5 ? 0.0 : 1.0};
      const auto items = layout(surface, content_of(paints), model);
      const Rect pad = find_item(items, Widget::pad)->rect;
      for (const Item& item : items) {
        if (item.widget != Widget::swatch) continue;
        EXPECT_GE(item.rect.x, pad.x);
        EXPECT_GE(item.rect.y, pad.y);
        EXPECT_LE(item.rect.x + item.rect.width, pad.x + pad.width);
        EXPECT_LE(item.rect.y + item.rect.height, pad.y + pad.height);
      }
    }
  }
}

TEST(Layout, ThePadsMiddleIsThePucks) {
  const auto check_middle = [](const Surface& surface, std::size_t paints, Language language) {
    Model model = model_of(paints, Screen::show);
    model.language = language;
    const auto items = layout(surface, content_of(paints), model);
    const auto pad = find_item(items, Widget::pad);
    ASSERT_TRUE(pad);
    const Place middle = pad_field(surface, pad->rect).centre();
    EXPECT_EQ(item_at(items, Screen::show, middle).widget, Widget::pad) << described(surface, model, *pad);
  };
  for (const Language language : {Language::english, Language::arabic})
    for (const std::size_t paints : {3U, 4U, 5U}) {
      check_middle({{640, 360}, 96.0}, paints, language);
      check_middle({{360, 640}, 96.0}, paints, language);
      // At 300 dpi the square of 1080 is so small that a disc and its name reach the middle by themselves.
      for (const auto& size : sizes)
        for (const double dpi : {60.0, 96.0, 160.0, 220.0}) check_middle({size, dpi}, paints, language);
    }
}

TEST(Layout, SwatchesBeginApartAndInside) {
  for (std::size_t paints = 1; paints <= 5; ++paints) {
    const auto places = first_places(paints);
    ASSERT_EQ(places.size(), paints);
    for (std::size_t i = 0; i < paints; ++i) {
      for (const double c : places[i]) EXPECT_TRUE(c >= 0.0 && c <= 1.0);
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GT(std::hypot(places[i][0] - places[j][0], places[i][1] - places[j][1]), 0.4);
    }
  }
}

TEST(Layout, CalibrationCrossesAreFarApart) {
  const Surface surface;
  for (int a = 0; a < calibration_steps; ++a)
    for (int b = 0; b < a; ++b) {
      const Place pa = calibration_cross(surface, a), pb = calibration_cross(surface, b);
      EXPECT_GT(std::hypot(pa[0] - pb[0], pa[1] - pb[1]), 0.5 * 720);
    }
}

}  // namespace
}  // namespace lackwerk::kiosk::ui
