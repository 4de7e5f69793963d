#include "kiosk/display/output/kms_display.hpp"

#include <poll.h>

#include <algorithm>
#include <cerrno>

namespace lackwerk::kiosk {
namespace {

/// A link is trained and a backlight started in up to about a second; a picture that comes with a mode may take that.
constexpr double modeset_wait_ms = 2000.0;
/// A connector that chatters must not keep the kiosk probing: a probe takes tens of milliseconds.
constexpr double between_scans_ms = 250.0;
constexpr double look_again_ms = 5000.0;
/// After "no memory", "not master" and other states that pass.
constexpr double retry_ms = 500.0;
/// Every mode was refused: the cable may be half in.
constexpr double retry_modes_ms = 2000.0;
/// A predecessor that was killed may hold the card for a moment.
constexpr int master_tries = 20, master_try_ms = 50;
/// What is left of a flip when the pipe is to be turned off: a few frame periods.
constexpr int last_flip_ms = 100;
/// DRM_MODE_DPMS_ON and _OFF.
constexpr std::uint64_t dpms_on = 0, dpms_off = 3;

bool not_master(int code) { return code == EACCES || code == EPERM; }

Error gone(const DrmCard& card, int code) {
  return {card.path, "", "the card is gone: " + errno_text(code), "the kiosk ends and is started again by its service"};
}

}  // namespace

bool passes(int code) { return code == EBUSY || code == ENOMEM || code == EINTR || code == EAGAIN || not_master(code); }
bool card_gone(int code) { return code == ENODEV || code == ENXIO || code == EBADF; }

KmsDisplay::KmsDisplay(KmsDevice& device, WantedPipe wanted, OutputMode until_then, Log& log)
    : device_(device), wanted_(std::move(wanted)), log_(log), mode_(std::move(until_then)) {}

KmsDisplay::~KmsDisplay() {
  if (state_ == OutputState::suspended) return;  // another session has the screen: it is not ours to change
  wait_for_flip();
  if (!restore_console()) disable_pipe();
}

Result<void> KmsDisplay::start(double now_ms) {
  DrmResult<void> master = device_.set_master();
  for (int k = 1; !master && k < master_tries; ++k) {
    poll(nullptr, 0, master_try_ms);
    master = device_.set_master();
  }
  if (!master)
    return fail(device_.card().path, master_field, "another program has the display: " + errno_text(master.error()),
                "end the desktop or the other kiosk first");
  auto scanned = scan(now_ms);
  if (scanned && state_ == OutputState::waiting_for_display) ++revision_;
  return scanned;
}

bool KmsDisplay::ready(double now_ms) const {
  return state_ == OutputState::running && power_ && queued_ == 0 && now_ms >= retry_at_ms_;
}

// ---- what is connected

Result<void> KmsDisplay::scan(double now_ms) {
  scan_at_ms_ = input::never_ms;
  scanned_at_ms_ = now_ms;
  const auto snapshot = take_snapshot(device_);
  if (!snapshot) {
    if (card_gone(snapshot.error())) return tl::unexpected(gone(device_.card(), snapshot.error()));
    log_.warning(device_.card().path + ": cannot read the connectors, trying again: " + errno_text(snapshot.error()));
    scan_at_ms_ = now_ms + retry_ms;
    return {};
  }
  PipeSearch found = choose_pipe(*snapshot, wanted_, pipe_ ? &*pipe_ : nullptr, refused_modes_);
  if (!found.warning.empty()) log_.warning("display: " + found.warning);
  if (!found.pipe) {
    say(found.why);
    // Some drivers never tell of a monitor; looking now and then costs nothing.
    scan_at_ms_ = now_ms + (refused_modes_.empty() ? look_again_ms : retry_modes_ms);
    refused_modes_.clear();
    drop_pipe();
    change_state(OutputState::waiting_for_display);
    return {};
  }
  say(found.why);
  const bool same = pipe_ && pipe_->connector.id == found.pipe->connector.id && pipe_->crtc == found.pipe->crtc &&
                    pipe_->plane == found.pipe->plane && pipe_->mode.same_signal(found.pipe->mode);
  if (!same) drop_pipe();
  if (auto taken = take_pipe(std::move(*found.pipe), *snapshot); !taken) {
    if (card_gone(taken.error())) return tl::unexpected(gone(device_.card(), taken.error()));
    log_.warning("display: the connector changed while it was read, trying again: " + errno_text(taken.error()));
    drop_pipe();
    scan_at_ms_ = now_ms + retry_ms;
    change_state(OutputState::waiting_for_display);
    return {};
  }
  ++revision_;
  state_ = OutputState::running;
  return {};
}

DrmResult<void> KmsDisplay::take_pipe(Pipe pipe, const DrmSnapshot& snapshot) {
  auto properties = read_properties(device_, pipe, snapshot);
  if (!properties) return tl::unexpected<int>(properties.error());
  properties_ = std::move(*properties);
  if (!saved_)
    if (const auto state = device_.pipe_state(pipe.crtc)) saved_ = Saved{pipe.connector.id, pipe.crtc, *state};
  mode_.connector = pipe.connector.name;
  mode_.panel_px = pipe.mode.size_px();
  mode_.panel_mm = pipe.connector.size_mm;
  mode_.refresh_hz = pipe.mode.refresh_hz();
  pipe_ = std::move(pipe);
  full_ = true;
  return {};
}

void KmsDisplay::drop_pipe() {
  disable_pipe();
  pipe_.reset();
}

void KmsDisplay::disable_pipe() {
  if (!pipe_ || !lit_) return;
  wait_for_flip();
  const DrmResult<void> done =
      atomic_ ? tested_commit(off_state(*pipe_, properties_), {.allow_modeset = true, .wait = true})
              : device_.set_crtc(pipe_->crtc, 0, {0, 0}, 0, nullptr);
  if (!done) log_.info("display: the pipe could not be turned off: " + errno_text(done.error()));
  lit_ = false;
  sleep_due_ = false;
  shown_ = queued_ = 0;
}

bool KmsDisplay::restore_console() {
  if (!saved_ || !saved_->state.active || saved_->state.framebuffer == 0) return false;
  if (pipe_ && saved_->crtc != pipe_->crtc) disable_pipe();
  const auto& [connector, crtc, state] = *saved_;
  const auto done = device_.set_crtc(crtc, state.framebuffer, {state.x, state.y}, connector, &state.mode);
  if (!done) log_.info("display: the console's picture could not be put back: " + errno_text(done.error()));
  return done.has_value();
}

void KmsDisplay::say(const std::string& why) {
  if (why != said_) log_.notice("display: " + why);
  said_ = why;
}

void KmsDisplay::change_state(OutputState state) {
  if (state_ == state) return;
  state_ = state;
  ++revision_;
}

void KmsDisplay::rescan(double now_ms) {
  refused_modes_.clear();
  scan_at_ms_ = std::min(scan_at_ms_, std::max(now_ms, scanned_at_ms_ + between_scans_ms));
}

// ---- what is set

DrmResult<void> KmsDisplay::tested_commit(const std::vector<DrmSetting>& settings, const DrmCommit& how) {
  if (auto tested = device_.commit(settings, {.test_only = true, .allow_modeset = how.allow_modeset}); !tested)
    return tested;
  return device_.commit(settings, how);
}

DrmResult<void> KmsDisplay::set_atomic(DrmId framebuffer) {
  const auto blob = device_.create_mode_blob(pipe_->mode);
  if (!blob) return tl::unexpected<int>(blob.error());
  auto done = tested_commit(full_state(*pipe_, properties_, framebuffer, *blob),
                            {.allow_modeset = true, .event = true, .cookie = cookie_ + 1});
  device_.destroy_blob(*blob);  // the kernel keeps its own hold on the state's
  return done;
}

DrmResult<void> KmsDisplay::set_legacy(DrmId framebuffer) {
  auto done = device_.set_crtc(pipe_->crtc, framebuffer, {0, 0}, pipe_->connector.id, &pipe_->mode);
  if (!done) return done;
  if (const auto dpms = properties_.connector.find("DPMS"); dpms != properties_.connector.end())
    (void)device_.set_connector_property(pipe_->connector.id, dpms->second.id, dpms_on);
  return done;
}

Result<Presented> KmsDisplay::set_everything(DrmId framebuffer, double now_ms) {
  if (device_.card().atomic && properties_.atomic()) {
    const auto done = set_atomic(framebuffer);
    if (done) {
      atomic_ = lit_ = true;
      full_ = false;
      queue(framebuffer, now_ms + modeset_wait_ms);
      return Presented::queued;
    }
    if (passes(done.error()) || card_gone(done.error())) return refused(done.error(), "setting the mode", now_ms);
    log_.warning("display: the driver refuses the atomic state for " + pipe_->mode.text() + ": " +
                 errno_text(done.error()) + "; the older interface is used");
  }
  const auto done = set_legacy(framebuffer);
  if (!done) {
    if (passes(done.error()) || card_gone(done.error())) return refused(done.error(), "setting the mode", now_ms);
    if (auto other = try_another_mode(done.error(), now_ms); !other) return tl::unexpected(other.error());
    return Presented::refused;
  }
  // Done when the call returns: no event follows.
  atomic_ = false;
  lit_ = true;
  full_ = false;
  shown_ = framebuffer;
  busy_since_ms_ = -1.0;
  flipped_at_us_ = static_cast<std::uint64_t>(now_ms * 1000.0);
  ++presented_;
  return Presented::shown;
}

Result<Presented> KmsDisplay::show(DrmId framebuffer, double now_ms) {
  if (!ready(now_ms)) return Presented::refused;
  if (full_) return set_everything(framebuffer, now_ms);
  const DrmResult<void> done =
      atomic_ ? device_.commit(flip_state(*pipe_, properties_, framebuffer), {.event = true, .cookie = cookie_ + 1})
              : device_.page_flip(pipe_->crtc, framebuffer, cookie_ + 1);
  if (done) {
    queue(framebuffer, now_ms + present_wait_ms);
    return Presented::queued;
  }
  if (!passes(done.error()) && !card_gone(done.error())) {
    // The pipe is not as it was left: an unplug on its way, or the driver's own recovery.
    log_.warning("display: a flip was refused, the mode is set again: " + errno_text(done.error()));
    full_ = true;
    rescan(now_ms);
    return Presented::refused;
  }
  return refused(done.error(), "flipping", now_ms);
}

void KmsDisplay::set_power(bool on, double now_ms) {
  if (on == power_) return;
  power_ = on;
  sleep_due_ = !on && lit_;
  if (on) full_ = true;  // the next picture brings everything back
  retry_at_ms_ = now_ms;
  ++revision_;
}

Result<void> KmsDisplay::put_to_sleep(double now_ms) {
  if (queued_ != 0) return {};  // after the flip
  DrmResult<void> done;
  if (atomic_) {
    done = tested_commit(sleep_state(*pipe_, properties_), {.allow_modeset = true});
  } else if (const auto dpms = properties_.connector.find("DPMS"); dpms != properties_.connector.end()) {
    done = device_.set_connector_property(pipe_->connector.id, dpms->second.id, dpms_off);
  } else {
    disable_pipe();  // the signal ends, which monitors understand as well
  }
  sleep_due_ = false;
  if (done) return {};
  if (card_gone(done.error())) return tl::unexpected(gone(device_.card(), done.error()));
  if (passes(done.error())) {
    sleep_due_ = true;
    retry_at_ms_ = now_ms + retry_ms;
  } else {
    log_.warning("display: the panel cannot be put to sleep: " + errno_text(done.error()));
  }
  return {};
}

// ---- what is on its way, and what went wrong

void KmsDisplay::queue(DrmId framebuffer, double give_up_at_ms) {
  ++cookie_;
  queued_ = framebuffer;
  give_up_at_ms_ = give_up_at_ms;
  busy_since_ms_ = -1.0;
}

Result<void> KmsDisplay::read_flips(int timeout_ms) {
  const auto flips = device_.read_flips(timeout_ms);
  if (!flips) {
    if (card_gone(flips.error())) return tl::unexpected(gone(device_.card(), flips.error()));
    return {};
  }
  for (const DrmFlip& flip : *flips) {
    if (queued_ == 0 || flip.cookie != cookie_) continue;
    shown_ = queued_;
    queued_ = 0;
    flipped_at_us_ = flip.at_us;
    ++presented_;
  }
  return {};
}

void KmsDisplay::wait_for_flip() {
  if (queued_ != 0) (void)read_flips(last_flip_ms);
}

Result<Presented> KmsDisplay::refused(int code, const std::string& doing, double now_ms) {
  if (card_gone(code)) return tl::unexpected(gone(device_.card(), code));
  if (not_master(code)) {
    lose_master(code, now_ms);
    return Presented::refused;
  }
  if (code != EBUSY) {
    log_.warning("display: " + doing + " failed, trying again: " + errno_text(code));
    retry_at_ms_ = now_ms + retry_ms;
    return Presented::refused;
  }
  // An earlier change is still under way: half a frame later it may be over.
  retry_at_ms_ = now_ms + (mode_.refresh_hz > 0.0 ? 500.0 / mode_.refresh_hz : 8.0);
  if (busy_since_ms_ < 0.0) busy_since_ms_ = now_ms;
  if (now_ms - busy_since_ms_ > present_wait_ms) {
    log_.warning("display: busy for " + std::to_string(static_cast<int>(present_wait_ms)) +
                 " ms, the mode is set again");
    full_ = true;
    busy_since_ms_ = now_ms;
  }
  return Presented::refused;
}

Result<void> KmsDisplay::try_another_mode(int code, double now_ms) {
  log_.warning("display: the driver refuses " + pipe_->mode.text() + " at " + pipe_->connector.name + ": " +
               errno_text(code));
  refused_modes_.push_back(pipe_->mode);
  return scan(now_ms);  // which may find that the monitor has gone meanwhile
}

void KmsDisplay::lose_master(int code, double now_ms) {
  log_.warning("display: another program has taken the screen, waiting for it: " + errno_text(code));
  shown_ = queued_ = 0;
  master_at_ms_ = now_ms + retry_ms;
  change_state(OutputState::suspended);
}

void KmsDisplay::suspend() {
  session_ = false;
  master_at_ms_ = input::never_ms;
  shown_ = queued_ = 0;
  device_.drop_master();
  change_state(OutputState::suspended);
}

void KmsDisplay::resume(double now_ms) {
  session_ = true;
  if (state_ == OutputState::suspended) master_at_ms_ = now_ms;
}

Result<void> KmsDisplay::dispatch(double now_ms) {
  if (auto read = read_flips(0); !read) return read;
  if (retry_at_ms_ <= now_ms) retry_at_ms_ = 0.0;
  if (state_ == OutputState::suspended) {
    if (!session_ || now_ms < master_at_ms_) return {};
    if (!device_.set_master()) {
      master_at_ms_ = now_ms + retry_ms;
      return {};
    }
    master_at_ms_ = input::never_ms;
    log_.notice("display: the screen is ours again");
    sleep_due_ = !power_ && lit_;
    state_ = OutputState::waiting_for_display;  // until the connectors have been read, which may take more than one try
    return scan(now_ms);
  }
  if (queued_ != 0 && now_ms >= give_up_at_ms_) {
    log_.warning("display: no word of a flip for " + std::to_string(static_cast<int>(present_wait_ms)) +
                 " ms or more, the mode is set again");
    queued_ = 0;
    full_ = true;
    ++revision_;
  }
  if (sleep_due_ && pipe_ && retry_at_ms_ == 0.0)
    if (auto slept = put_to_sleep(now_ms); !slept) return slept;
  if (now_ms >= scan_at_ms_) return scan(now_ms);
  return {};
}

double KmsDisplay::wake_at_ms() const {
  if (state_ == OutputState::suspended) return session_ ? master_at_ms_ : input::never_ms;
  double at = scan_at_ms_;
  if (queued_ != 0) at = std::min(at, give_up_at_ms_);
  if (retry_at_ms_ > 0.0) at = std::min(at, retry_at_ms_);
  return at;
}

}  // namespace lackwerk::kiosk
