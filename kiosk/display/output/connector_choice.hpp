// Which card, connector, pipe, plane and mode to use, and why.
//
// Why it exists: card and connector numbers move from boot to boot, monitors come and go, and a modelist's first entry
// is not always the wanted one. All of it is decided here from values, so that every case is a test. Pure; any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kiosk/display/output/drm_device.hpp"

namespace lackwerk::kiosk {

/// What the configuration asks for.
struct WantedPipe {
  std::string connector;             ///< empty: the first connected one
  std::array<int, 2> mode_px{0, 0};  ///< 0: as the preferred mode
  int refresh_hz = 0;                ///< 0: any
};

/// All that is known of a card at one moment.
struct DrmSnapshot {
  DrmResources resources;
  std::vector<DrmConnector> connectors;
  std::vector<DrmPlane> planes;
};

/// Probes everything anew. Connectors that vanish meanwhile are left out. Error: the card does not answer.
[[nodiscard]] DrmResult<DrmSnapshot> take_snapshot(KmsDevice& device);

/// A way from a buffer to a monitor.
struct Pipe {
  DrmConnector connector;
  DrmId crtc = 0;
  DrmId plane = 0;  ///< 0: no primary plane is known, only the older interface can be used
  DrmMode mode;
};

struct PipeSearch {
  std::optional<Pipe> pipe;  ///< empty: nothing to show pictures on
  std::string why;           ///< one line for the log: what was taken and why, or why nothing was
  std::string warning;       ///< a wish that could not be granted; else empty
};

/// `previous` is kept while it stays connected (unless the configuration names another). `refused`: modes the driver
/// has refused on that connector.
[[nodiscard]] PipeSearch choose_pipe(const DrmSnapshot& snapshot, const WantedPipe& wanted, const Pipe* previous,
                                     const std::vector<DrmMode>& refused);

/// The mode to set on a connector, not among `refused`; empty: it has none. `warning` says if a wish was not granted.
[[nodiscard]] std::optional<DrmMode> choose_mode(const DrmConnector& connector, const WantedPipe& wanted,
                                                 std::array<int, 2> largest_px, const std::vector<DrmMode>& refused,
                                                 std::string& warning);

/// A card that could be opened.
struct CardFacts {
  std::vector<std::string> names;  ///< the node first, then links to it and the driver's name
  std::vector<DrmConnector> connectors;
};

struct CardChoice {
  std::size_t index = 0;
  std::string why;
};

/// `card`: one of its names, or empty: the first with a connected connector (that of the given name, if one is given),
/// else the first that has such a connector at all, else the first. Error: no card, or none of that name.
[[nodiscard]] Result<CardChoice> choose_card(const std::vector<CardFacts>& cards, const std::string& card,
                                             const std::string& connector);

}  // namespace lackwerk::kiosk
