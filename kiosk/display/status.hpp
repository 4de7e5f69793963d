// status.json: what the kiosk says about itself to dealers, scripts and fleets.
//
// Why it exists: nobody should have to read a journal to know whether a screen in a showroom is well. The file is
// replaced in one step (written beside, renamed), so that a reader sees the old one or the new one. Values and two
// functions; the kiosk's thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/interpolatable_paint.hpp"
#include "input/source.hpp"
#include "kiosk/display/latency.hpp"
#include "kiosk/display/log.hpp"
#include "kiosk/display/output.hpp"

namespace lackwerk::kiosk {

struct RefusedStatus {
  std::string platform, why;
};
struct PackStatus {
  std::string file, id;
  std::uint64_t serial = 0;
  bool is_signed = false;            ///< by a key of the keyring
  std::vector<std::string> paints;   ///< of a pack of paints
  std::vector<std::string> scans{};  ///< of a pack of scans
};

/// Something on the screen that can be touched.
struct ControlStatus {
  std::string widget;  ///< name in kiosk/display/targets.hpp
  int index = 0;
  double x = 0.0, y = 0.0;  ///< its middle, in [0, 1] of the panel as it is built
};

struct Status {
  std::string state;     ///< "running", "waiting_for_display", "suspended", "stopped"
  std::string platform;  ///< "kms", "dumb", ...
  std::string renderer;  ///< what the driver calls itself
  std::vector<RefusedStatus> refused;
  OutputMode mode;
  std::vector<PackStatus> packs;
  core::Weights weights;                ///< of paints
  std::optional<double> time;           ///< of scans: [0, 1] from the first to the last
  bool resting = false;                 ///< nothing changes and the picture has converged
  std::string quality;                  ///< rung of moving pictures
  std::uint64_t drawn = 0;              ///< moving frames
  std::uint64_t refined = 0;            ///< frames of still pictures
  std::uint64_t presented = 0;          ///< pictures that reached the panel
  double frame_ms = 0.0;                ///< median of the last moving frames
  LatencySummary latency;               ///< from an input event to the flip that shows it
  GamutLoss gamut_loss;                 ///< of the last picture that came to rest
  std::string screen;                   ///< of the interface: "attract", "show", "dealer", ...; empty: none
  std::string language;                 ///< "en", "de", "ar"
  std::vector<ControlStatus> controls;  ///< lowest first
  std::vector<input::DeviceStatus> devices;
  std::vector<Log::Entry> problems;
  double started_ms = 0.0;  ///< CLOCK_MONOTONIC
};

/// JSON, one object, keys as in docs/kiosk.md. `now_ms`: CLOCK_MONOTONIC, for ages.
[[nodiscard]] std::string status_json(const Status& status, double now_ms);

/// Replaces `folder`/status.json. Error: folder not writable, disk full; the old file stays.
[[nodiscard]] Result<void> write_status(const std::string& folder, const std::string& json);

inline constexpr const char* status_file_name = "status.json";

}  // namespace lackwerk::kiosk
