#include "kiosk/display/output/seat_libseat.hpp"

#include <fcntl.h>
#include <unistd.h>

extern "C" {  // the header does not say so itself
#include <libseat.h>
}

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

namespace lackwerk::kiosk {
namespace {

/// libseat's log handler takes no user data, so where its lines go cannot but be one per process. The mutex keeps a
/// manager's late answer from writing to a log that is gone.
class LibseatLog {
 public:
  static LibseatLog& instance() {
    static LibseatLog one;
    return one;
  }
  void send_to(Log* log) {
    const std::lock_guard lock(mutex_);
    log_ = log;
    last_.clear();
  }
  /// The newest line of an error since send_to().
  [[nodiscard]] std::string last_error() const {
    const std::lock_guard lock(mutex_);
    return last_;
  }
  void write(libseat_log_level level, std::string text) {
    // Without libseat's own source line, "[libseat/libseat.c:58] ".
    if (const auto end = text.find("] "); text.front() == '[' && end != std::string::npos) text.erase(0, end + 2);
    const std::lock_guard lock(mutex_);
    if (level == LIBSEAT_LOG_LEVEL_ERROR) last_ = text;
    if (log_ != nullptr) log_->info("libseat: " + text);
  }

 private:
  mutable std::mutex mutex_;
  Log* log_ = nullptr;
  std::string last_;
};

__attribute__((format(printf, 2, 0))) void on_libseat_log(libseat_log_level level, const char* format, va_list args) {
  std::array<char, 512> line{};
  std::vsnprintf(line.data(), line.size(), format, args);
  LibseatLog::instance().write(level, line.data());
}

/// What callbacks reach: alive as long as libseat may call. Callbacks run inside open_seat() and dispatch().
struct Session {
  const LibseatCalls* calls = nullptr;
  std::atomic<bool> active{false};
};

void on_enable(libseat* /*seat*/, void* userdata) { static_cast<Session*>(userdata)->active = true; }

void on_disable(libseat* seat, void* userdata) {
  auto* session = static_cast<Session*>(userdata);
  session->active = false;
  session->calls->disable_seat(seat);  // the answer a manager waits for; it then takes the devices back
}

const libseat_seat_listener listener = {on_enable, on_disable};

/// One try to open a seat, shared with the thread that waits for the manager.
struct Attempt {
  std::mutex mutex;
  std::condition_variable answered;
  bool done = false, abandoned = false;
  libseat* seat = nullptr;
  int error = 0;
};

class LibseatSeat final : public Seat {
 public:
  LibseatSeat(const LibseatCalls& calls, libseat* seat, std::shared_ptr<Session> session, const std::string& backend,
              Log& log)
      : calls_(&calls), seat_(seat), session_(std::move(session)), log_(&log) {
    const char* name = calls.seat_name(seat);
    description_ = "libseat (" + (backend.empty() ? std::string("its choice") : backend) + "), " +
                   (name == nullptr ? "a seat without a name" : name);
  }
  ~LibseatSeat() override {
    for (const auto& [fd, id] : devices_) {
      calls_->close_device(seat_, id);
      close(fd);
    }
    calls_->close_seat(seat_);
    LibseatLog::instance().send_to(nullptr);
  }

  Result<int> open_device(const std::string& path) override {
    int fd = -1;
    const int id = calls_->open_device(seat_, path.c_str(), &fd);
    if (id < 0 || fd < 0)
      return fail(path, "", "the seat manager does not open it: " + std::string(std::strerror(errno)),
                  active() ? "it opens graphics, input and HID devices of its own seat only"
                           : "another session has the seat: switch back to the kiosk's");
    const int flags = fcntl(fd, F_GETFL);
    if (flags >= 0) fcntl(fd, F_SETFL, flags | O_NONBLOCK);
    fcntl(fd, F_SETFD, FD_CLOEXEC);
    devices_[fd] = id;
    return fd;
  }
  void close_device(int fd) override {
    const auto found = devices_.find(fd);
    if (found == devices_.end()) return;
    calls_->close_device(seat_, found->second);
    close(fd);
    devices_.erase(found);
  }
  [[nodiscard]] int fd() const override { return gone_ ? -1 : calls_->get_fd(seat_); }
  void dispatch() override {
    if (gone_) return;
    while (true) {
      const int handled = calls_->dispatch(seat_, 0);
      if (handled == 0) break;
      if (handled > 0) continue;
      if (errno == EINTR || errno == EAGAIN) break;
      // Never polled again: a closed connection is always readable.
      gone_ = true;
      session_->active = false;
      log_->error({"", "seat", "the seat manager is gone: " + std::string(std::strerror(errno)),
                   "start it again, then the kiosk", ErrorKind::run});
      return;
    }
    if (session_->active != was_active_) {
      was_active_ = session_->active;
      log_->notice(was_active_ ? "seat: given back" : "seat: taken by another session");
    }
  }
  [[nodiscard]] bool active() const override { return session_->active; }
  [[nodiscard]] const std::string& description() const override { return description_; }
  [[nodiscard]] bool holds_console() const override { return true; }
  /// For the wait while it opens: says nothing.
  void remember_active() { was_active_ = session_->active; }

 private:
  const LibseatCalls* calls_;
  libseat* seat_;
  std::shared_ptr<Session> session_;
  Log* log_;
  std::map<int, int> devices_;  ///< descriptor to libseat's id
  std::string description_;
  bool gone_ = false, was_active_ = false;
};

/// LIBSEAT_BACKEND as it was, put back at the end: libseat takes the backend from nowhere else.
class BackendChoice {
 public:
  explicit BackendChoice(const std::string& backend) {
    if (backend.empty()) return;
    if (const char* before = std::getenv(name); before != nullptr) before_ = before;
    changed_ = setenv(name, backend.c_str(), 1) == 0;
  }
  ~BackendChoice() {
    if (!changed_) return;
    if (before_)
      setenv(name, before_->c_str(), 1);
    else
      unsetenv(name);
  }
  BackendChoice(const BackendChoice&) = delete;
  BackendChoice& operator=(const BackendChoice&) = delete;

 private:
  static constexpr const char* name = "LIBSEAT_BACKEND";
  std::optional<std::string> before_;
  bool changed_ = false;
};

/// The manager's answer within the time; afterwards `attempt` belongs to the thread alone. Null: none, or refused.
libseat* wait_for_seat(const LibseatCalls& calls, const std::shared_ptr<Session>& session,
                       const std::shared_ptr<Attempt>& attempt, int wait_ms) {
  std::thread([attempt, session, calls = &calls] {
    libseat* seat = calls->open_seat(&listener, session.get());
    const int error = errno;
    const std::lock_guard lock(attempt->mutex);
    attempt->seat = seat;
    attempt->error = error;
    attempt->done = true;
    if (attempt->abandoned && seat != nullptr) calls->close_seat(seat);
    attempt->answered.notify_all();
  }).detach();
  std::unique_lock lock(attempt->mutex);
  attempt->answered.wait_for(lock, std::chrono::milliseconds(wait_ms), [&] { return attempt->done; });
  attempt->abandoned = !attempt->done;
  return attempt->done ? attempt->seat : nullptr;
}

}  // namespace

const LibseatCalls& libseat_calls() {
  static constexpr LibseatCalls calls = {libseat_open_seat,   libseat_disable_seat, libseat_close_seat,
                                         libseat_open_device, libseat_close_device, libseat_seat_name,
                                         libseat_get_fd,      libseat_dispatch};
  return calls;
}

Result<std::unique_ptr<Seat>> open_libseat(const LibseatCalls& calls, const std::string& backend, int wait_ms,
                                           Log& log) {
  libseat_set_log_handler(on_libseat_log);
  libseat_set_log_level(LIBSEAT_LOG_LEVEL_INFO);
  LibseatLog::instance().send_to(&log);
  const BackendChoice choice(backend);

  const auto session = std::make_shared<Session>();
  session->calls = &calls;
  const auto attempt = std::make_shared<Attempt>();
  libseat* seat = wait_for_seat(calls, session, attempt, wait_ms);
  if (seat == nullptr) {
    std::string what = attempt->abandoned ? "no answer within " + std::to_string(wait_ms) + " ms"
                                          : std::string(std::strerror(attempt->error));
    if (const std::string said = LibseatLog::instance().last_error(); !said.empty()) what += "; libseat says: " + said;
    LibseatLog::instance().send_to(nullptr);
    return fail("libseat", backend, what,
                "start seatd and put the user into its group, or give the service a logind session, or use seat = "
                "\"direct\"");
  }
  auto out = std::make_unique<LibseatSeat>(calls, seat, session, backend, log);
  // Active comes as a message. A seat that is not active yet is one, too: its time comes.
  const double until = monotonic_ms() + wait_ms;
  while (!session->active && monotonic_ms() < until)
    if (calls.dispatch(seat, static_cast<int>(until - monotonic_ms()) + 1) < 0 && errno != EINTR) break;
  out->remember_active();
  return std::unique_ptr<Seat>(std::move(out));
}

}  // namespace lackwerk::kiosk
