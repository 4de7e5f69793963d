#include "kiosk/display/live.hpp"

#include <algorithm>
#include <cmath>

#include "core/colour.hpp"
#include "render_gles/context.hpp"

namespace lackwerk::kiosk {
namespace {

/// Scripts move thirty times a second, as recordings do.
constexpr double script_step_ms = 1000.0 / 30.0;
/// status.json is at most this old while something changes, and not written while nothing does.
constexpr double report_every_ms = 500.0;
/// Of panels without a vertical blank that could be known: a usual panel's.
constexpr double usual_period_ms = 1000.0 / 60.0;

}  // namespace

Live::Live(Output& output, Stage& stage, Picture& picture, State& state, Devices devices,
           std::optional<input::ScriptPlayer> script, Log& log, Service& service, LiveSettings settings)
    : output_(output),
      stage_(stage),
      picture_(picture),
      state_(state),
      devices_(std::move(devices)),
      script_(std::move(script)),
      log_(log),
      service_(service),
      settings_(std::move(settings)),
      gestures_(stage.pack().paint().paints.size(), stage.scene().cameras.front().name),
      started_ms_(monotonic_ms()) {}

void Live::apply(const input::Control& control) {
  const State::Changes changes = state_.apply(control);
  weights_changed_ |= changes.weights;
  report_due_ |= changes.weights;
  if (changes.any()) latency_.input(control.time_us);
}

void Live::take_input(double now_ms) {
  controls_.clear();
  for (const auto& source : devices_.sources) {
    source->read(now_ms, controls_);
    source->take_notices(notices_);
  }
  for (const input::Notice& notice : notices_)
    log_.write(notice.problem ? Priority::warning : Priority::info, notice.text);
  report_due_ |= !notices_.empty();
  notices_.clear();
  if (script_ && !script_->finished()) {
    const auto scripted = script_->advance(now_ms - started_ms_);
    controls_.insert(controls_.end(), scripted.begin(), scripted.end());
  }
  for (const input::Control& control : controls_)
    for (const input::Control& meant : gestures_.take(control)) apply(meant);
  for (const input::Control& meant : gestures_.advance(now_ms)) apply(meant);
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
  gestures_.set_rotation(mode.rotation, mode.panel_px);
  fitted_ = true;
  return {};
}

double Live::frame_period_ms() const {
  const double refresh = output_.mode().refresh_hz > 0.0 ? 1000.0 / output_.mode().refresh_hz : usual_period_ms;
  return std::max(picture_.frame_period_ms(), refresh);
}

bool Live::wants_frame() const {
  return output_.state() == OutputState::running && output_.ready() &&
         (damaged_ || weights_changed_ || !picture_.resting() || picture_.differs(state_));
}

Result<void> Live::show() {
  if (output_.flipped_at_us() != flipped_at_us_) {
    flipped_at_us_ = output_.flipped_at_us();
    latency_.flipped(flipped_at_us_, frame_period_ms());
  }
  // A frame is drawn when the one before has been shown, not earlier: what is drawn then holds the newest input.
  if (!wants_frame()) return {};
  const auto drawn = picture_.step(state_, weights_changed_);
  if (!drawn) return tl::unexpected(drawn.error());
  weights_changed_ = false;
  damaged_ |= *drawn != Picture::Step::nothing;
  if (!damaged_) return {};
  const auto presented = output_.present(stage_.framebuffer());
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
  take_input(now_ms);
  if (auto fitted = fit_output(); !fitted) return fitted;
  if (auto shown = show(); !shown) return shown;
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
  const auto& paints = stage_.pack().paint().paints;
  PackStatus pack{settings_.pack_file, stage_.pack().info().id, stage_.pack().info().serial, {}};
  for (const auto& paint : paints) pack.paints.push_back(paint.identity.name);
  status.packs.push_back(std::move(pack));
  status.weights = state_.weights();
  status.resting = picture_.resting() && !damaged_;
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
  for (const auto& source : devices_.sources) source->add_descriptors(out);
}

double Live::wake_at_ms(double now_ms) const {
  if (wants_frame()) return now_ms;
  double wake = std::min(output_.wake_at_ms(), service_.wake_at_ms());
  wake = std::min(wake, gestures_.wake_at_ms());
  for (const auto& source : devices_.sources) wake = std::min(wake, source->wake_at_ms());
  if (script_ && !script_->finished()) wake = std::min(wake, now_ms + script_step_ms);
  if (report_due_ && !settings_.status_folder.empty()) wake = std::min(wake, reported_ms_ + report_every_ms);
  return wake;
}

bool Live::finished() const { return script_ && script_->finished() && picture_.resting() && !damaged_; }

}  // namespace lackwerk::kiosk
