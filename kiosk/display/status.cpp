#include "kiosk/display/status.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace lackwerk::kiosk {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value, double step) { return std::round(value / step) * step; }

const char* priority_name(Priority priority) {
  switch (priority) {
    case Priority::error:
      return "error";
    case Priority::warning:
      return "warning";
    case Priority::notice:
      return "notice";
    case Priority::info:
      return "info";
    case Priority::debug:
      break;
  }
  return "debug";
}

}  // namespace

std::string status_json(const Status& status, double now_ms) {
  Json out;
  out["version"] = LACKWERK_VERSION;
  out["pid"] = static_cast<std::int64_t>(getpid());
  out["state"] = status.state;
  out["up_s"] = rounded((now_ms - status.started_ms) * 1e-3, 0.1);
  out["backend"] = status.platform;
  out["renderer"] = status.renderer;
  out["refused"] = Json::array();
  for (const RefusedStatus& refused : status.refused)
    out["refused"].push_back({{"backend", refused.platform}, {"why", refused.why}});
  out["mode"] = {{"connector", status.mode.connector},
                 {"width", status.mode.panel_px[0]},
                 {"height", status.mode.panel_px[1]},
                 {"refresh_hz", rounded(status.mode.refresh_hz, 0.01)},
                 {"rotation", degrees_of(status.mode.rotation)}};
  out["packs"] = Json::array();
  for (const PackStatus& pack : status.packs)
    out["packs"].push_back({{"file", pack.file},
                            {"id", pack.id},
                            {"serial", pack.serial},
                            {"signed", pack.is_signed},
                            {"paints", pack.paints},
                            {"scans", pack.scans}});
  out["weights"] = {{"base", status.weights.base},
                    {"flake_lightness", status.weights.flake_lightness},
                    {"flake_colour", status.weights.flake_colour},
                    {"flake_white", status.weights.flake_white}};
  out["time"] = status.time ? Json(rounded(*status.time, 1e-4)) : Json();
  out["resting"] = status.resting;
  out["quality"] = status.quality;
  out["frames"] = {{"drawn", status.drawn},
                   {"refined", status.refined},
                   {"presented", status.presented},
                   {"median_ms", rounded(status.frame_ms, 0.01)}};
  out["latency"] = {{"count", status.latency.count},
                    {"median_ms", rounded(status.latency.median_ms, 0.01)},
                    {"p95_ms", rounded(status.latency.p95_ms, 0.01)},
                    {"p95_frames", rounded(status.latency.p95_frames, 0.01)}};
  out["gamut"] = {{"outside_share", rounded(status.gamut_loss.share, 0.0001)},
                  {"worst", rounded(status.gamut_loss.worst, 0.0001)}};
  out["screen"] = status.screen;
  out["language"] = status.language;
  out["controls"] = Json::array();
  for (const ControlStatus& control : status.controls)
    out["controls"].push_back({{"widget", control.widget},
                               {"index", control.index},
                               {"x", rounded(control.x, 1e-5)},
                               {"y", rounded(control.y, 1e-5)}});
  out["devices"] = Json::array();
  for (const input::DeviceStatus& device : status.devices)
    out["devices"].push_back({{"name", device.name},
                              {"kind", device.kind},
                              {"state", device.state},
                              {"detail", device.detail},
                              {"heard", device.heard}});
  out["errors"] = Json::array();
  for (const Log::Entry& problem : status.problems)
    out["errors"].push_back({{"age_s", rounded((now_ms - problem.at_ms) * 1e-3, 0.1)},
                             {"priority", priority_name(problem.priority)},
                             {"text", problem.text},
                             {"times", problem.times}});
  // Names of devices are whatever a device says: what is not UTF-8 is replaced.
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<void> write_status(const std::string& folder, const std::string& json) {
  const std::string path = (std::filesystem::path(folder) / status_file_name).string();
  const std::string fresh = path + ".new";
  const auto failed = [&](const char* step) {
    const std::string why = std::strerror(errno);
    unlink(fresh.c_str());
    return fail(path, "", std::string(step) + ": " + why, "make the folder writable for the kiosk's user");
  };
  const int fd = open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (fd < 0) return failed("cannot be written");
  std::size_t done = 0;
  while (done < json.size()) {
    const ssize_t wrote = write(fd, json.data() + done, json.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) break;
    done += static_cast<std::size_t>(wrote);
  }
  // Everybody on the machine may read it, whatever the service's umask.
  if (fchmod(fd, 0644) != 0) done = json.size() + 1;
  // The runtime folder lives in memory: no fsync, a status needs to survive nothing.
  const int closed = close(fd);
  if (done != json.size() || closed != 0) return failed("cannot be written");
  if (rename(fresh.c_str(), path.c_str()) != 0) return failed("cannot be replaced");
  return {};
}

}  // namespace lackwerk::kiosk
