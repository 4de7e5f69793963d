#include "kiosk/tools/report/picture_knobs.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "kiosk/display/picture.hpp"
#include "render_gles/governor.hpp"

namespace lackwerk::report {
namespace {

using gles::FlakeMode;
using gles::Quality;

constexpr const char* ladder_line = "ladder";
constexpr const char* quality_id = "quality";
constexpr const char* colour_error = "CIEDE2000 against the reference, over the car";

std::string moving_frame() {
  return "one moving frame of " + std::to_string(timed_width_px) + " x " + std::to_string(timed_height_px);
}

std::string reference_text(const PictureStage& stage) {
  return "Reference: Monte Carlo at double precision, " + std::to_string(stage.reference_samples()) +
         " samples a pixel at " + stage.size_text() + ", itself uncertain by " + digits(stage.noise()) +
         " in the mean (two halves of other seeds).";
}

const Setting& find(const Knob& knob, const std::string& label) {
  const auto found = std::find_if(knob.settings.begin(), knob.settings.end(),
                                  [&](const Setting& setting) { return setting.label == label; });
  return found == knob.settings.end() ? knob.settings.front() : *found;
}

DrawnSetting drawn(std::string label, std::string line, const Quality& quality) {
  DrawnSetting out;
  out.setting.label = std::move(label);
  out.setting.line = std::move(line);
  out.quality = quality;
  return out;
}

std::vector<DrawnSetting> ladder() {
  std::vector<DrawnSetting> out;
  out.reserve(gles::rung_count);
  for (const gles::Rung& rung : gles::quality_ladder())
    out.push_back(drawn(std::string(rung.name), ladder_line, rung.quality));
  return out;
}

/// The best rung with one switch changed, a line for each switch; `quick`: the outermost of each only.
void add_variants(std::vector<DrawnSetting>& to, bool quick) {
  const Quality best = gles::quality_ladder().front().quality;
  const auto variant = [&](const char* label, const char* line, auto change) {
    Quality quality = best;
    change(quality);
    to.push_back(drawn(label, line, quality));
  };
  if (!quick) variant("flakes of the nearest slice", "flakes", [](Quality& q) { q.flakes = FlakeMode::nearest; });
  if (!quick) variant("flakes as their mean", "flakes", [](Quality& q) { q.flakes = FlakeMode::mean; });
  variant("no flakes", "flakes", [](Quality& q) { q.flakes = FlakeMode::off; });
  variant("cells switch in steps", "cross-fade", [](Quality& q) { q.flake_cross_fade = false; });
  if (!quick) variant("2 sparkle lights", "sparkle lights", [](Quality& q) { q.sparkle_lights = 2; });
  if (!quick) variant("1 sparkle light", "sparkle lights", [](Quality& q) { q.sparkle_lights = 1; });
  variant("no sparkle light", "sparkle lights", [](Quality& q) { q.sparkle_lights = 0; });
  variant("no mirror in the floor", "mirror", [](Quality& q) { q.floor_mirror = false; });
  variant("coarse mesh", "mesh", [](Quality& q) { q.coarse = true; });
  variant("one lobe for all", "lobes", [](Quality& q) { q.one_lobe = true; });
  if (!quick) variant("scale 0.75", "scale", [](Quality& q) { q.scale = 0.75f; });
  variant("scale 0.5", "scale", [](Quality& q) { q.scale = 0.5f; });
  variant("edges as they are", "edges", [](Quality& q) { q.smooth_edges = false; });
}

/// What the governor takes where frames take what was measured: each rung its median, again and again.
std::string chosen_rung(const Knob& knob, const gles::RungCosts& costs, double target_ms) {
  gles::Governor governor(target_ms, 0, costs);
  constexpr int frames = 1000;  // more than it needs from one end of the ladder to the other and back
  for (int k = 0; k < frames; ++k)
    governor.measured(knob.settings[static_cast<std::size_t>(governor.index())].time.median_ms);
  return std::string(governor.rung().name);
}

kiosk::QualityTable table_of(const Knob& knob) {
  kiosk::QualityTable table;
  double first_ms = none;
  for (const Setting& setting : knob.settings) {
    if (setting.line != ladder_line) continue;
    if (table.rungs.empty()) {
      first_ms = setting.time.median_ms;
      table.renderer = setting.note;
    }
    table.rungs.push_back({setting.label, setting.time.median_ms / first_ms, setting.error, setting.p95});
  }
  return table;
}

std::string why_quality(const Knob& knob, const kiosk::QualityTable& table, const gles::RungCosts& costs,
                        double target_ms, const PictureStage& stage) {
  const Setting &best = knob.settings.front(), &chosen = find(knob, knob.chosen);
  std::string why = "The default is \"auto\", no setting: a governor takes the best rung that holds " +
                    digits(target_ms) + " ms; on this machine (" + table.renderer + ") that is \"" + knob.chosen +
                    "\" with " + digits(chosen.time.median_ms) + " ms and an error of " + digits(chosen.error) +
                    ", where \"" + best.label + "\" takes " + digits(best.time.median_ms) + " ms with " +
                    digits(best.error) + ". ";
  if (chosen.time.median_ms > target_ms) why += "Nothing on the ladder holds the time here. ";
  std::string skipped;
  for (std::size_t k = 0; k < table.rungs.size(); ++k)
    if (costs.dominated(static_cast<int>(k))) skipped += (skipped.empty() ? "\"" : ", \"") + table.rungs[k].name + "\"";
  if (std::none_of(knob.settings.begin(), knob.settings.end(),
                   [&](const Setting& setting) { return setting.line == "cross-fade" && setting.error != best.error; }))
    why +=
        "From so far single flakes are too small to show and are drawn as their mean: what only changes them costs "
        "and changes nothing in this view. ";
  if (!skipped.empty()) why += "It leaves out " + skipped + ": no cheaper here than a better one. ";
  return why + "Most of the error is edges of one sample a pixel, which a resting picture has not (knob \"still\"). " +
         reference_text(stage);
}

}  // namespace

Knob quality_knob(Workbench& bench, PictureStage& stage) {
  Knob knob;
  knob.id = quality_id;
  knob.title = "Quality of a moving picture";
  knob.what =
      "The rungs of the quality ladder, best first, and each switch of the best one alone, on the built-in car "
      "in its first view and the pack's first paint. Errors are of pictures of " +
      stage.size_text() + ".";
  knob.error_unit = colour_error;
  knob.time_of = moving_frame();
  std::vector<DrawnSetting> settings = ladder();
  add_variants(settings, bench.quick());
  for (DrawnSetting& one : settings) stage.judge(stage.still(one.quality, 1), one.setting);
  stage.time_moving(settings, bench.choose(15, 2));
  settings.front().setting.note = stage.renderer_name();
  knob.settings.reserve(settings.size());
  for (DrawnSetting& one : settings) knob.settings.push_back(std::move(one.setting));
  const kiosk::QualityTable table = table_of(knob);
  const gles::RungCosts costs = table.costs();
  const double target_ms = kiosk::PictureSettings{}.frame_ms;
  knob.chosen = chosen_rung(knob, costs, target_ms);
  knob.why = why_quality(knob, table, costs, target_ms, stage);
  return knob;
}

Knob still_knob(Workbench& bench, PictureStage& stage) {
  Knob knob;
  knob.id = "still";
  knob.title = "Frames of a resting picture";
  knob.what = "Frames that are summed once nothing moves: one is the moving picture, from " +
              std::to_string(gles::sampled_still_frames) + " on every frame samples the environment. The car at " +
              stage.size_text() + ".";
  knob.error_unit = colour_error;
  knob.time_of = "all frames at " + stage.size_text();
  const Quality best = gles::quality_ladder().front().quality;
  constexpr std::array all = {1, 8, gles::sampled_still_frames, 64, gles::still_frames, 256};
  const int most = bench.choose(256, 32);
  (void)stage.still(best, gles::sampled_still_frames);  // compiles what sampled frames need
  for (const int frames : all) {
    if (frames > most) continue;
    Setting setting;
    setting.label = std::to_string(frames);
    setting.value = frames;
    setting.line = frames < gles::sampled_still_frames ? "moving, smoothed" : "sampled";
    const int runs = bench.choose(3, 1);
    std::vector<double> times(static_cast<std::size_t>(runs), 0.0);
    gles::Image image;
    for (double& ms : times) image = stage.still(best, frames, &ms);
    setting.time = timing_of(std::move(times));
    stage.judge(image, setting);
    knob.settings.push_back(std::move(setting));
  }
  // A quick report does not draw as many as the default has.
  knob.chosen = std::to_string(std::min(gles::still_frames, most));
  const Setting &chosen = find(knob, knob.chosen), &moving = knob.settings.front(), &last = knob.settings.back();
  knob.why = "The kiosk rests after " + std::to_string(gles::still_frames) + " frames" +
             (most < gles::still_frames ? ", of which this quick report draws " + std::to_string(most) : "") + ": " +
             digits(chosen.error) + " after " + digits(chosen.time.median_ms) + " ms, down from " +
             digits(moving.error) + " of one moving frame";
  if (last.label != knob.chosen)
    knob.why += "; " + last.label + " frames reach " + digits(last.error) + " in " +
                digits(last.time.median_ms / chosen.time.median_ms) + " times the time";
  knob.why += ". " + reference_text(stage);
  return knob;
}

Knob light_path_knob(Workbench& bench, PictureStage& stage) {
  Knob knob;
  knob.id = "light_path";
  knob.title = "Light of a moving picture";
  const int smoothed_frames = bench.choose(16, 4);
  knob.what =
      "Where the environment's light comes from: prefiltered levels for each lobe (path P), or directional "
      "lights cut from the map with the whole model (path L). Errors are of " +
      std::to_string(smoothed_frames) + " smoothed frames at " + stage.size_text() +
      ", so that edges do not hide them.";
  knob.error_unit = colour_error;
  knob.time_of = moving_frame();
  Quality quality = gles::quality_ladder().front().quality;
  quality.sparkle_lights = 1;
  std::vector<DrawnSetting> settings;
  settings.push_back(drawn("prefiltered", "path P", quality));
  quality.path = gles::LightPath::lights;
  constexpr std::array counts = {1, 4, 16, 64};
  for (const int count : counts) {
    if (count > bench.choose(64, 16)) continue;  // 64 lights are 16 passes, seconds a frame
    quality.cut_lights = count;
    settings.push_back(drawn(std::to_string(count) + (count == 1 ? " light" : " lights"), "path L", quality));
    settings.back().setting.value = count;
  }
  for (DrawnSetting& one : settings) stage.judge(stage.still(one.quality, smoothed_frames), one.setting);
  stage.time_moving(settings, bench.choose(7, 2));
  knob.settings.reserve(settings.size());
  for (DrawnSetting& one : settings) knob.settings.push_back(std::move(one.setting));
  knob.chosen = "prefiltered";
  const Setting &filtered = knob.settings.front(), &most = knob.settings.back();
  knob.why = "Prefiltered light costs " + digits(filtered.time.median_ms) + " ms a frame at an error of " +
             digits(filtered.error) + "; " + most.label + " cost " +
             digits(most.time.median_ms / filtered.time.median_ms) + " times as much for " + digits(most.error) +
             ", and one light, the cheapest cut, takes " + digits(knob.settings[1].time.median_ms) + " ms with " +
             digits(knob.settings[1].error) + ". The pack's cut ends at 64 lights (see knob \"cut_lights\"). " +
             reference_text(stage);
  return knob;
}

Result<void> add_pictures(Workbench& bench, Findings& findings) {
  auto stage = PictureStage::make(bench);
  if (!stage) return tl::unexpected(stage.error());
  bench.progress(0.34);
  findings.knobs.push_back(quality_knob(bench, **stage));
  bench.progress(0.5);
  findings.knobs.push_back(still_knob(bench, **stage));
  bench.progress(0.9);
  findings.knobs.push_back(light_path_knob(bench, **stage));
  bench.progress(1.0);
  return {};
}

Result<kiosk::QualityTable> quality_table_of(const Findings& findings) {
  const auto knob = std::find_if(findings.knobs.begin(), findings.knobs.end(),
                                 [](const Knob& candidate) { return candidate.id == quality_id; });
  if (knob == findings.knobs.end())
    return fail("", quality_id, "was not measured", "run lackwerk report with the part pictures, on a machine with GL");
  kiosk::QualityTable table = table_of(*knob);
  if (auto good = kiosk::check_quality_table(table, ""); !good) return tl::unexpected(good.error());
  return table;
}

}  // namespace lackwerk::report
