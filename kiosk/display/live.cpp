#include "kiosk/display/live.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "core/colour.hpp"
#include "kiosk/display/choices.hpp"
#include "kiosk/display/interface_words.hpp"
#include "kiosk/display/panel_size.hpp"
#include "kiosk/display/targets.hpp"
#include "render_gles/context.hpp"

namespace lackwerk::kiosk {
namespace {

/// Scripts move thirty times a second, as recordings do.
constexpr double script_step_ms = 1000.0 / 30.0;
/// status.json is at most this old while something changes, and not written while nothing does.
constexpr double report_every_ms = 500.0;
/// Of panels without a vertical blank that could be known: a usual panel's.
constexpr double usual_period_ms = 1000.0 / 60.0;
/// What moves by itself while nobody can see it.
constexpr double unseen_step_ms = 1000.0;
/// Swatches are drawn when nobody has touched anything for so long: each takes some frames.
constexpr double hands_off_ms = 500.0;
/// And when the picture rests, or this long after the first one.
constexpr double most_swatch_delay_ms = 3000.0;

}  // namespace

int local_minute() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  return local.tm_hour * 60 + local.tm_min;
}

Live::Live(Output& output, Stage& stage, Picture& picture, Interface& interface, Devices devices,
           std::optional<input::ScriptPlayer> script, Log& log, Service& service, LiveSettings settings)
    : output_(output),
      stage_(stage),
      picture_(picture),
      interface_(interface),
      devices_(std::move(devices)),
      script_(std::move(script)),
      log_(log),
      service_(service),
      settings_(std::move(settings)),
      started_ms_(monotonic_ms()),
      imports_(settings_.status_folder) {
  if (!settings_.minute_of_day) settings_.minute_of_day = local_minute;
  if (!settings_.wall_s) settings_.wall_s = wall_clock_s;
}

void Live::apply(const Interface::Changes& changes, std::uint64_t time_us) {
  weights_changed_ |= changes.weights;
  report_due_ |= changes.weights || changes.interface;
  if (changes.any()) latency_.input(time_us);
}

void Live::take_script(double now_ms) {
  if (!script_ || script_->finished()) return;
  // Its times are ms since the start; nobody waits for a script, so it says nothing of latency.
  for (const input::Control& event : script_->advance(now_ms - started_ms_)) apply(interface_.take(event, now_ms), 0);
  if (const auto complaint = interface_.take_complaint()) log_.write(Priority::warning, complaint->line());
}

void Live::take_input(double now_ms) {
  if (settings_.visit) apply(interface_.begin_visit(now_ms), 0);
  settings_.visit = false;
  controls_.clear();
  for (const auto& source : devices_.sources) {
    source->read(now_ms, controls_);
    source->take_notices(notices_);
  }
  for (const input::Notice& notice : notices_)
    log_.write(notice.problem ? Priority::warning : Priority::info, notice.text);
  report_due_ |= !notices_.empty();
  notices_.clear();
  if (!controls_.empty()) touched_ms_ = now_ms;
  report_due_ |= !controls_.empty();
  for (const input::Control& control : controls_) apply(interface_.take(control, now_ms), control.time_us);
  take_script(now_ms);
  apply(interface_.advance(now_ms, settings_.minute_of_day()), 0);
  keep_choices();
  sleep_or_wake();
  if (interface_.wants_facts(now_ms)) {
    ui::DealerFacts facts{status(), {}, imports_.last()};
    for (auto entry = facts.status.problems.rbegin(); entry != facts.status.problems.rend(); ++entry)
      facts.log.push_back(entry->text);
    interface_.show_facts(std::move(facts), now_ms);
  }
}

void Live::keep_choices() {
  const auto choices = interface_.take_choices();
  if (!choices || settings_.choices_folder.empty()) return;
  if (auto written = write_choices(settings_.choices_folder, *choices); !written) log_.error(written.error());
}

void Live::sleep_or_wake() {
  const bool asleep = interface_.model().asleep;
  if (asleep == asleep_) return;
  asleep_ = asleep;
  output_.set_power(!asleep);
  damaged_ = true;
  report_due_ = true;
  log_.info(asleep ? "night: the panel is off" : "the panel is on");
}

bool Live::wants_swatch(double now_ms) const {
  return interface_.wants_swatch() && !asleep_ && handed_over_ > 0 && now_ms >= touched_ms_ + hands_off_ms &&
         (picture_.resting() || now_ms >= started_ms_ + most_swatch_delay_ms);
}

void Live::make_swatch(double now_ms) {
  if (!wants_swatch(now_ms)) return;
  interface_.make_swatch();
  report_due_ |= !interface_.wants_swatch();
}

void Live::take_pack(double now_ms) {
  if (settings_.packs == nullptr) return;
  auto news = settings_.packs->poll();
  if (!news) {
    // What is shown stays: a pack that fails here never shows.
    log_.error(news.error());
    report_due_ = true;
    return;
  }
  if (!*news) return;
  ShownPack& next = **news;
  if (auto taken = stage_.set_pack(std::move(next.pack)); !taken) {
    log_.error(taken.error());
    report_due_ = true;
    return;
  }
  settings_.pack_file = next.file;
  settings_.pack_signed = next.is_signed;
  interface_.content_changed(now_ms, next.is_vouched);
  weights_changed_ = true;
  report_due_ = true;
  log_.notice("showing " + stage_.pack().id() + " " + std::to_string(stage_.pack().serial()) +
              (next.is_signed ? "" : ", which is not signed"));
}

void Live::take_import(double now_ms) {
  const auto news = imports_.poll(now_ms, settings_.wall_s());
  if (!news) {
    log_.error(news.error());
    report_due_ = true;
    return;
  }
  if (*news) apply(interface_.tell(toast_of(**news), now_ms), 0);
}

Result<void> Live::fit_output() {
  if (fitted_ && output_revision_ == output_.revision()) return {};
  output_revision_ = output_.revision();
  report_due_ = true;
  damaged_ = true;
  if (devices_.touch != nullptr) {
    const bool suspended = output_.state() == OutputState::suspended;
    if (suspended && !suspended_) devices_.touch->suspend();
    if (!suspended && suspended_) devices_.touch->resume();
    suspended_ = suspended;
    devices_.touch->set_output(output_.mode().connector);
  }
  if (output_.state() != OutputState::running) {
    service_.ready("waiting for a display");
    return {};
  }
  const OutputMode& mode = output_.mode();
  const auto size = picture_size(mode.rotation, mode.panel_px);
  const gles::Framebuffer& now = stage_.framebuffer();
  if (now.width() != size[0] || now.height() != size[1]) {
    if (auto sized = stage_.resize(size[0], size[1]); !sized) return sized;
    picture_.lost();
  }
  const double dpi = panel_dpi(mode.panel_px, mode.panel_mm);
  if (mode.panel_mm[0] > 0 && mode.panel_mm[1] > 0)
    log_.info("the panel says " + std::to_string(mode.panel_mm[0]) + " x " + std::to_string(mode.panel_mm[1]) +
              " mm: " + (dpi > 0.0 ? std::to_string(std::lround(dpi)) + " dpi" : "not believed"));
  interface_.set_surface(mode.rotation, mode.panel_px, dpi);
  fitted_ = true;
  return {};
}

double Live::frame_period_ms() const {
  const double refresh = output_.mode().refresh_hz > 0.0 ? 1000.0 / output_.mode().refresh_hz : usual_period_ms;
  return std::max(picture_.frame_period_ms(), refresh);
}

bool Live::wants_frame() const {
  return output_.state() == OutputState::running && output_.ready() && !asleep_ &&
         (damaged_ || weights_changed_ || interface_.stale() || !picture_.resting() ||
          picture_.differs(interface_.shown()));
}

Result<void> Live::show() {
  if (output_.flipped_at_us() != flipped_at_us_) {
    flipped_at_us_ = output_.flipped_at_us();
    latency_.flipped(flipped_at_us_, frame_period_ms());
  }
  // A frame is drawn when the one before has been shown, not earlier: what is drawn then holds the newest input.
  if (!wants_frame()) return {};
  weights_changed_ |= interface_.compare(!weights_changed_ && !picture_.differs(interface_.shown()));
  const auto drawn = picture_.step(interface_.shown(), weights_changed_);
  if (!drawn) return tl::unexpected(drawn.error());
  weights_changed_ = false;
  damaged_ |= *drawn != Picture::Step::nothing || interface_.stale();
  if (!damaged_) return {};
  const bool dimmed = output_.set_brightness(interface_.brightness());
  const auto composed =
      interface_.compose(stage_.framebuffer(), dimmed ? Interface::Dimming::later : Interface::Dimming::here);
  if (!composed) return tl::unexpected(composed.error());
  const auto presented = output_.present(**composed);
  if (!presented) return tl::unexpected(presented.error());
  if (*presented == Presented::refused) return {};
  damaged_ = false;
  report_due_ |= *drawn == Picture::Step::drawn || picture_.resting();
  ++handed_over_;
  if (picture_.resting()) check_gamut();
  latency_.handed_over();
  if (*presented == Presented::shown)
    latency_.flipped(static_cast<std::uint64_t>(monotonic_ms() * 1e3), frame_period_ms());
  if (handed_over_ == 1) {
    log_.info("first picture " + std::to_string(static_cast<int>(monotonic_ms() - started_ms_)) + " ms after start");
    service_.ready("showing " + settings_.pack_file);
  }
  return {};
}

void Live::check_gamut() {
  if (settings_.profile.is_srgb()) return;
  // Every fourth pixel both ways: some ten thousand of them, enough for a share in whole per cents.
  constexpr int stride = 4;
  const gles::Image image = stage_.framebuffer().read();
  std::vector<std::array<double, 3>> colours;
  colours.reserve(image.rgb.size() / 3 / (stride * stride) + image.rgb.size() / 3 / stride);
  for (int y = 0; y < image.height; y += stride)
    for (int x = 0; x < image.width; x += stride) {
      std::array<double, 3> colour{};
      for (std::size_t c = 0; c < 3; ++c) colour[c] = core::srgb_decode(image.pixel(x, y)[c] / 255.0);
      colours.push_back(colour);
    }
  const GamutLoss loss = gamut_loss(settings_.profile, colours);
  report_due_ |= loss.share != gamut_loss_.share;
  gamut_loss_ = loss;
  // Less than this is a highlight's edge.
  constexpr double worth_saying = 0.01;
  if (loss.share > worth_saying)
    log_.notice(std::to_string(std::lround(loss.share * 100.0)) + " % of the picture is outside the panel's colours (" +
                settings_.profile.source + ")");
}

Result<void> Live::step(double now_ms) {
  if (auto dispatched = output_.dispatch(now_ms); !dispatched) return dispatched;
  stepped_ms_ = now_ms;
  take_pack(now_ms);
  take_import(now_ms);
  take_input(now_ms);
  if (auto fitted = fit_output(); !fitted) return fitted;
  if (auto shown = show(); !shown) return shown;
  make_swatch(now_ms);
  report(now_ms);
  service_.progress(now_ms);
  return {};
}

Status Live::status() const {
  Status status;
  status.state = output_state_name(output_.state());
  status.platform = platform_name(output_.platform());
  status.renderer = output_.context().info().renderer;
  status.refused = settings_.refused;
  status.mode = output_.mode();
  PackStatus pack{settings_.pack_file, stage_.pack().id(), stage_.pack().serial(), settings_.pack_signed, {}, {}};
  if (const packs::PaintPack* paints = stage_.pack().paints()) {
    for (const auto& paint : paints->paint().paints) pack.paints.push_back(paint.identity.name);
    status.weights = interface_.experience().state().weights();
  } else {
    for (const packs::ScanState& state : stage_.pack().scans()->info().states) pack.scans.push_back(state.name);
    status.time = interface_.experience().state().time();
  }
  status.packs.push_back(std::move(pack));
  if (interface_.is_shown()) {
    status.screen = screen_name(interface_.model().screen);
    status.controls = interface_.controls();
  }
  status.language = word_of(interface_.model().language);
  status.resting = picture_.resting() && !damaged_ && !interface_.stale() && !interface_.wants_swatch();
  status.quality = picture_.quality();
  status.drawn = picture_.drawn();
  status.refined = picture_.refined();
  status.presented = output_.presented();
  status.frame_ms = picture_.drawn_ms_median();
  status.latency = latency_.summary();
  status.gamut_loss = gamut_loss_;
  for (const auto& source : devices_.sources) source->add_devices(status.devices);
  status.problems = log_.problems();
  status.started_ms = started_ms_;
  return status;
}

void Live::report(double now_ms) {
  if (settings_.status_folder.empty() || !report_due_ || now_ms - reported_ms_ < report_every_ms) return;
  report_due_ = false;
  reported_ms_ = now_ms;
  if (auto written = write_status(settings_.status_folder, status_json(status(), now_ms)); !written)
    log_.error(written.error());
}

void Live::stop() {
  service_.stopping();
  if (settings_.status_folder.empty()) return;
  Status last = status();
  last.state = "stopped";
  if (auto written = write_status(settings_.status_folder, status_json(last, monotonic_ms())); !written)
    log_.error(written.error());
}

void Live::add_descriptors(std::vector<int>& out) const {
  output_.add_descriptors(out);
  if (settings_.packs != nullptr && settings_.packs->fd() >= 0) out.push_back(settings_.packs->fd());
  if (imports_.fd() >= 0) out.push_back(imports_.fd());
  for (const auto& source : devices_.sources) source->add_descriptors(out);
}

/// When the interface wants its next step. What moves by itself goes on with the next frame: a panel that is busy wakes
/// us with its flip, and one that is never busy must not be driven faster than eyes see.
double Live::moves_at_ms(double now_ms) const {
  const double wake = interface_.wake_at_ms(now_ms);
  if (wake > now_ms) return wake;
  if (output_.state() != OutputState::running) return stepped_ms_ + unseen_step_ms;
  return output_.ready() ? stepped_ms_ + usual_period_ms : output_.wake_at_ms();
}

double Live::wake_at_ms(double now_ms) const {
  if (wants_frame()) return now_ms;
  double wake = std::min(output_.wake_at_ms(), service_.wake_at_ms());
  wake = std::min(wake, moves_at_ms(now_ms));
  if (interface_.wants_swatch() && !asleep_ && handed_over_ > 0)
    wake = std::min(
        wake, std::max(touched_ms_ + hands_off_ms, picture_.resting() ? now_ms : started_ms_ + most_swatch_delay_ms));
  for (const auto& source : devices_.sources) wake = std::min(wake, source->wake_at_ms());
  if (script_ && !script_->finished()) wake = std::min(wake, now_ms + script_step_ms);
  if (report_due_ && !settings_.status_folder.empty()) wake = std::min(wake, reported_ms_ + report_every_ms);
  return wake;
}

bool Live::finished() const {
  return script_ && script_->finished() && picture_.resting() && !damaged_ && !interface_.stale() &&
         !interface_.wants_swatch();
}

}  // namespace lackwerk::kiosk
