#include "kiosk/display/output/kms_output.hpp"

#include <algorithm>

namespace lackwerk::kiosk {
namespace {

constexpr double retry_ms = 500.0;
/// No buffer is free: a flip that was given up holds it.
constexpr double free_again_ms = 10.0;
/// Ten seconds without a buffer are no passing shortage: a fresh process does better.
constexpr int most_failures = 20;

}  // namespace

KmsOutput::KmsOutput(KmsParts parts, const OutputSettings& settings, Log& log, Clock clock)
    : parts_(std::move(parts)),
      log_(log),
      clock_(std::move(clock)),
      display_(*parts_.device, {settings.connector, settings.mode_px, settings.refresh_hz},
               {"", settings.mode_px[0] > 0 && settings.mode_px[1] > 0 ? settings.mode_px : settings.size_px, 0.0,
                settings.rotation},
               log),
      look_{settings.rotation, settings.profile, settings.test_pattern, settings.gamut_warning} {
  parts_.surface->set_look(look_);
}

Result<void> KmsOutput::start() { return display_.start(clock_()); }

bool KmsOutput::ready() const {
  const double now = clock_();
  return display_.ready(now) && now >= retry_at_ms_;
}

Result<Presented> KmsOutput::not_now(const Error& why, double now_ms) {
  if (++failures_ >= most_failures) return tl::unexpected(why);
  log_.error(why);
  retry_at_ms_ = now_ms + retry_ms;
  return Presented::refused;
}

Result<Presented> KmsOutput::present(const gles::Framebuffer& picture) {
  const double now = clock_();
  if (!display_.ready(now) || now < retry_at_ms_) return Presented::refused;
  const OutputMode& mode = display_.mode();
  // Drawn for the mode before this one: revision() has said so.
  if (std::array{picture.width(), picture.height()} != picture_size(mode.rotation, mode.panel_px))
    return Presented::refused;
  if (buffers_px_ != mode.panel_px) {
    buffers_px_ = {0, 0};
    if (auto made = parts_.surface->resize(mode.panel_px); !made) return not_now(made.error(), now);
    buffers_px_ = mode.panel_px;
  }
  parts_.surface->keep(display_.shown(), display_.queued());
  const auto drawn = parts_.surface->draw(picture);
  if (!drawn) return not_now(drawn.error(), now);
  if (*drawn == 0) {
    retry_at_ms_ = now + free_again_ms;
    return Presented::refused;
  }
  failures_ = 0;
  // Drawing took a while: deadlines count from the commit.
  auto shown = display_.show(*drawn, clock_());
  parts_.surface->keep(display_.shown(), display_.queued());
  return shown;
}

bool KmsOutput::hotplug_came() {
  if (!parts_.hotplug) return false;
  // What exactly has changed is read from the connectors, so all that counts is that something has.
  events_.clear();
  parts_.hotplug->read(events_);
  return !events_.empty();
}

void KmsOutput::add_descriptors(std::vector<int>& out) const {
  for (const int fd : {parts_.device->fd(), parts_.hotplug ? parts_.hotplug->descriptor() : -1})
    if (fd >= 0) out.push_back(fd);
}

Result<void> KmsOutput::dispatch(double now_ms) {
  if (const bool active = parts_.seat == nullptr || parts_.seat->active(); active != active_) {
    active_ = active;
    log_.notice(active ? "seat: the screen comes back" : "seat: another session has the screen");
    if (active)
      display_.resume(now_ms);
    else
      display_.suspend();
  }
  if (hotplug_came()) display_.rescan(now_ms);
  if (retry_at_ms_ <= now_ms) retry_at_ms_ = 0.0;
  auto done = display_.dispatch(now_ms);
  parts_.surface->keep(display_.shown(), display_.queued());
  return done;
}

double KmsOutput::wake_at_ms() const {
  const double at = display_.wake_at_ms();
  return retry_at_ms_ > 0.0 ? std::min(at, retry_at_ms_) : at;
}

}  // namespace lackwerk::kiosk
