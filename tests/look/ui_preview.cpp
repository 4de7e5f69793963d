// The interface's screens over a picture of a car, as PNG files to be looked at.
//
//   ui_preview CAR.png OUT_DIR [DPI] [LANGUAGE...]
//
// The surface is as large as the picture. One file a screen and language: OUT_DIR/SIZE-LANGUAGE-SCREEN.png. Without
// LANGUAGE (en, de, ar): all. Prints how many pixels the sprites cover and what a drag costs.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "kiosk/display/import_notice.hpp"
#include "kiosk/display/ui/strings.hpp"
#include "tests/unit/tile_canvas.hpp"

namespace lackwerk::kiosk::ui {
namespace {

struct Shot {
  std::string name;
  Model model;
  std::size_t paints = 3;
};

PaintFacts paint(std::string name, std::string source, std::array<double, 3> srgb) {
  PaintFacts facts;
  facts.identity.name = std::move(name);
  facts.identity.source = std::move(source);
  facts.srgb = srgb;
  return facts;
}

Content content_of(std::size_t paints) {
  const std::vector<PaintFacts> all{
      paint("Polaris Silber mit Klarlack (Guenther et al. 2005)", "Guenther et al. 2005, Table 1; clear coat simulated",
            {0.70, 0.74, 0.75}),
      paint("Opel Titan", "Guenther et al. 2005, Table 1", {0.33, 0.35, 0.37}),
      paint("Mystic Blue", "Golla and Klein 2018, measured with a goniometer in Bonn", {0.16, 0.34, 0.62}),
      paint("Rubinrot Perleffekt", "simulated", {0.52, 0.07, 0.10}),
      paint("Perlweiß", "simulated", {0.90, 0.89, 0.86})};
  Content content;
  content.pack_id = "lackwerk.demo";
  content.serial = 4;
  content.paints.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(paints));
  content.beyond_limit = 0.35;
  return content;
}

ImportReport some_import() {
  ImportReport out;
  out.time_s = 1'762'000'000;
  out.files.resize(3);
  out.files[0].file = "rogue.lwp";
  out.files[0].error =
      "rogue.lwp: signed with key 0123456789ABCDEF, which is not in the keyring (put the maker's .pub into the "
      "keyring)";
  out.files[1].file = "spring-2026.lwp";
  out.files[1].outcome = ImportedFile::Outcome::stored;
  out.files[1].id = "lackwerk.spring-2026";
  out.files[2].file = "winter-2025.lwp";
  out.files[2].outcome = ImportedFile::Outcome::already_there;
  out.files[2].id = "lackwerk.winter-2025";
  return out;
}

DealerFacts facts() {
  DealerFacts out;
  out.status.state = "running";
  out.status.platform = "kms";
  out.status.renderer = "llvmpipe (LLVM 15.0.6, 256 bits)";
  out.status.mode = {"HDMI-A-1", {1920, 1080}, 60.0, Rotation::none};
  out.status.packs = {{"/var/lib/lackwerk/packs/lackwerk.demo.4.lwp",
                       "lackwerk.demo",
                       4,
                       true,
                       {"Polaris Silber mit Klarlack (Guenther et al. 2005)", "Opel Titan", "Mystic Blue"}}};
  out.status.quality = "moving, 2 angle taps";
  out.status.frame_ms = 14.2;
  out.status.latency.count = 12;
  out.status.latency.median_ms = 31.0;
  out.status.devices = {{"Goodix Capacitive TouchScreen", "touch", "ready", "/dev/input/event4"},
                        {"Griffin PowerMate", "knob", "gone", "/dev/hidraw0: unplugged; plug it in again"}};
  out.status.devices[0].heard = 127;
  out.import = some_import();
  out.log = {"2 min: /dev/hidraw0: unplugged (plug it in again)",
             "1 h: kiosk.toml: interface.dpi: the panel says nothing about its size, 96 is taken (set interface.dpi)"};
  return out;
}

std::string mix_of(Language language) {
  switch (language) {
    case Language::english:
      break;
    case Language::german:
      return "62 % Polaris Silber mit Klarlack (Guenther et al. 2005), 26 % Opel Titan, 12 % Mystic Blue, lebhaft";
    case Language::arabic:
      return "72 % Polaris Silber، 28 % Opel Titan، متلألئ";
  }
  return "72 % Polaris Silber, 28 % Opel Titan, lively";
}

Model show_model(Language language, std::size_t paints) {
  Model model;
  model.screen = Screen::show;
  model.language = language;
  model.swatches = first_places(paints);
  model.puck = {0.42, 0.36};
  model.sparkle = 0.7;
  model.hue = 0.45;
  model.dimmer = 0.2;
  model.mix_name = mix_of(language);
  model.mix_code = "LW1:7F3K2M9Q/4/720-280-0/500-500-0/1000-0-0:8C2F";
  return model;
}

std::vector<std::pair<std::string, Toast>> toasts() {
  ImportReport report = some_import();
  std::vector<std::pair<std::string, Toast>> out;
  out.emplace_back("mixed", toast_of(report));
  report.files.resize(1);
  out.emplace_back("refused", toast_of(report));
  report.files = {some_import().files[1]};
  out.emplace_back("good", toast_of(report));
  return out;
}

std::vector<Shot> visitor_shots(Language language) {
  std::vector<Shot> shots;
  Model model = show_model(language, 3);
  Model attract = model;
  attract.screen = Screen::attract;
  shots.push_back({"attract", attract});
  Model first = model;
  first.hint = true;
  first.puck = first.swatches[0];
  first.mix_name = "Polaris Silber";
  shots.push_back({"show-first", first});
  model.puck_held = true;
  model.pressed = Widget::pad;
  model.sparkle_free = true;
  model.light = 1;
  shots.push_back({"show-drag", model});
  model.nearest = Nearest{0, {1.24, 0.83, 2.05}};
  model.pressed = Widget::compare;
  shots.push_back({"show-compare", model});
  model = show_model(language, 3);
  model.focus = Widget::sparkle;
  shots.push_back({"show-focus-slider", model});
  model.focus = Widget::pad;
  shots.push_back({"show-focus-pad", model});
  model.focus = Widget::light;
  model.focus_index = 2;
  shots.push_back({"show-focus-light", model});
  model.focus = Widget::car;
  shots.push_back({"show-focus-car", model});
  model = show_model(language, 3);
  model.countdown_s = 9.0;
  shots.push_back({"show-countdown", model});
  for (const auto& [name, toast] : toasts()) {
    model = show_model(language, 3);
    model.toast = toast;
    shots.push_back({"toast-" + name, model});
    model.screen = Screen::attract;
    shots.push_back({"toast-" + name + "-attract", model});
    model.screen = Screen::dealer;
    shots.push_back({"toast-" + name + "-dealer", model});
  }
  for (const std::size_t paints : {1U, 2U, 4U, 5U}) {
    model = show_model(language, paints);
    model.beyond_shown = paints > 3;
    shots.push_back({"show-" + std::to_string(paints), model, paints});
  }
  model = show_model(language, 3);
  model.screen = Screen::take_home;
  shots.push_back({"take-home", model});
  model.screen = Screen::about;
  shots.push_back({"about", model});
  return shots;
}

std::vector<Shot> dealer_shots(Language language) {
  std::vector<Shot> shots;
  Model model = show_model(language, 3);
  model.screen = Screen::pin;
  model.pin.digits = 3;
  shots.push_back({"pin", model});
  model.pin = {0, 3, 0.0, true};
  shots.push_back({"pin-refused", model});
  model.screen = Screen::dealer;
  for (int page = 0; page < dealer_pages; ++page) {
    model.dealer.page = static_cast<DealerPage>(page);
    model.dealer.beyond_allowed = true;
    shots.push_back({"dealer-" + std::to_string(page), model});
  }
  model.dealer.test_pattern = true;
  shots.push_back({"dealer-pattern", model});
  model.dealer.calibration_step = 1;
  shots.push_back({"dealer-calibration", model});
  return shots;
}

void time_drag(Painter& painter, const Surface& surface) {
  const Content content = content_of(3);
  Model model = show_model(Language::english, 3);
  TileCanvas canvas;
  canvas.take(painter.paint(surface, content, model, nullptr));
  std::vector<double> changing, still;
  constexpr int frames = 400;
  for (int k = 0; k < frames; ++k) {
    model.puck = {0.2 + 0.6 * k / frames, 0.5};
    const int share = 20 + (k * 7) % 60;
    model.mix_name =
        std::to_string(share) + " % Polaris Silber, " + std::to_string(100 - share) + " % Opel Titan, lively";
    for (std::vector<double>* into : {&changing, &still}) {
      const auto begin = std::chrono::steady_clock::now();
      (void)painter.paint(surface, content, model, nullptr);
      into->push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
    }
  }
  for (std::vector<double>* each : {&changing, &still}) std::sort(each->begin(), each->end());
  std::vector<double> swatch;
  model.swatch_held = 0;
  for (int k = 0; k < frames; ++k) {
    model.swatches[0] = {0.2 + 0.6 * k / frames, 0.2};
    const auto begin = std::chrono::steady_clock::now();
    (void)painter.paint(surface, content, model, nullptr);
    swatch.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
  }
  std::sort(swatch.begin(), swatch.end());
  std::printf(
      "%dx%d: sprites %zu, covered %lld px; paint() median of %d: %.0f us with another name, %.0f us without, "
      "%.0f us while a swatch is moved\n",
      surface.size_px[0], surface.size_px[1], canvas.sprites().size(), canvas.covered_px(), frames,
      changing[frames / 2], still[frames / 2], swatch[frames / 2]);
}

int run(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("usage: ui_preview CAR.png OUT_DIR [DPI] [en|de|ar...]\n", stderr);
    return 2;
  }
  const auto car = gles::read_png(argv[1]);
  if (!car) {
    std::fprintf(stderr, "%s\n", car.error().line().c_str());
    return 1;
  }
  Surface surface{{car->width, car->height}, argc > 3 ? std::atof(argv[3]) : 96.0};
  const std::vector<std::pair<std::string, Language>> all{
      {"en", Language::english}, {"de", Language::german}, {"ar", Language::arabic}};
  auto painter = Painter::create();
  if (!painter) {
    std::fprintf(stderr, "%s\n", painter.error().line().c_str());
    return 1;
  }
  const DealerFacts dealer = facts();
  TileCanvas canvas;
  for (const auto& [tag, language] : all) {
    bool wanted = argc < 5;
    for (int k = 4; k < argc; ++k) wanted = wanted || tag == argv[k];
    if (!wanted) continue;
    std::vector<Shot> shots = visitor_shots(language);
    for (Shot& shot : dealer_shots(language)) shots.push_back(std::move(shot));
    for (const Shot& shot : shots) {
      const Content content = content_of(shot.paints);
      canvas.take((*painter)->paint(surface, content, shot.model, &dealer));
      gles::Image picture = *car;
      canvas.draw_over(picture);
      const std::string path = std::string(argv[2]) + "/" + std::to_string(car->width) + "x" +
                               std::to_string(car->height) + "-" + tag + "-" + shot.name + ".png";
      if (const auto written = gles::write_png(picture, path); !written) {
        std::fprintf(stderr, "%s\n", written.error().line().c_str());
        return 1;
      }
    }
  }
  time_drag(**painter, surface);
  return 0;
}

}  // namespace
}  // namespace lackwerk::kiosk::ui

int main(int argc, char** argv) { return lackwerk::kiosk::ui::run(argc, argv); }
