#include "kiosk/display/output/seat.hpp"

#include <fcntl.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "kiosk/display/output/seat_libseat.hpp"

namespace lackwerk::kiosk {
namespace {

/// The group that may open the node, by name or number; empty if it is not there.
std::string group_of(const std::string& path) {
  struct stat node {};
  if (stat(path.c_str(), &node) != 0) return {};
  struct group entry {};
  struct group* found = nullptr;
  std::array<char, 4096> buffer{};
  getgrgid_r(node.st_gid, &entry, buffer.data(), buffer.size(), &found);
  return found != nullptr ? found->gr_name : std::to_string(node.st_gid);
}

/// No seat manager: the process's own rights decide.
class DirectSeat final : public Seat {
 public:
  Result<int> open_device(const std::string& path) override {
    const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (fd >= 0) return fd;
    const int error = errno;
    std::string remedy = "check the device and its driver";
    if (error == EACCES || error == EPERM) remedy = "put the kiosk's user into group " + group_of(path);
    if (error == ENOENT || error == ENXIO || error == ENODEV)
      remedy = "is the device plugged in, and its driver loaded?";
    return fail(path, "", "cannot be opened: " + std::string(std::strerror(error)), remedy);
  }
  void close_device(int fd) override { ::close(fd); }
  [[nodiscard]] int fd() const override { return -1; }
  void dispatch() override {}
  [[nodiscard]] bool active() const override { return true; }
  [[nodiscard]] const std::string& description() const override { return description_; }

 private:
  std::string description_ = "direct";
};

bool exists(const char* path) {
  struct stat node {};
  return stat(path, &node) == 0;
}

/// Seat managers that may answer here. libseat's third way, "builtin", is none: it forks a manager of its own, with the
/// rights that direct access needs as well.
std::vector<std::string> managers() {
  if (const char* wanted = std::getenv("LIBSEAT_BACKEND"); wanted != nullptr) return {wanted};
  std::vector<std::string> out;
  const char* socket = std::getenv("SEATD_SOCK");
  if (exists(socket != nullptr ? socket : "/run/seatd.sock")) out.emplace_back("seatd");
  if (exists("/run/systemd/seats")) out.emplace_back("logind");
  return out;
}

}  // namespace

Result<std::unique_ptr<Seat>> Seat::open(const std::string& how, Log& log) {
  if (how != "auto" && how != "libseat" && how != "direct")
    return fail("kiosk.toml", "seat", "\"" + how + "\" is none of auto, libseat, direct", "choose one of them",
                ErrorKind::usage);
  std::string why = "as asked for";
  if (how != "direct") {
    std::vector<std::string> backends = managers();
    if (backends.empty() && how == "libseat") backends.emplace_back();  // as libseat itself sees fit
    why.clear();
    Error refused;
    for (const std::string& backend : backends) {
      auto seat = open_libseat(libseat_calls(), backend, seat_wait_ms, log);
      if (seat) {
        log.notice("seat: " + (*seat)->description() + ((*seat)->active() ? "" : ", waiting for its turn"));
        return seat;
      }
      refused = seat.error();
      why += (why.empty() ? "" : "; ") + (backend.empty() ? "libseat" : backend) + ": " + refused.what;
    }
    if (backends.empty()) why = "no seat manager: neither seatd's socket nor logind's seats";
    refused.field.clear();
    refused.what = why;
    if (how == "libseat") return tl::unexpected(refused);
  }
  log.notice("seat: direct, " + why);
  return std::make_unique<DirectSeat>();
}

}  // namespace lackwerk::kiosk
