#include "kiosk/display/output/connector_choice.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>

namespace lackwerk::kiosk {
namespace {

/// 59.94 is what a customer calls 60.
constexpr double same_refresh_hz = 0.5;

std::string size_text(std::array<int, 2> px) { return std::to_string(px[0]) + "x" + std::to_string(px[1]); }

bool usable(const DrmConnector& connector) {
  return connector.connected && connector.desktop && !connector.modes.empty() && connector.possible_crtcs != 0;
}

const DrmConnector* find_connector(const std::vector<DrmConnector>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const DrmConnector& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

/// "HDMI-A-1 connected, DP-1 not".
std::string list(const std::vector<DrmConnector>& all) {
  std::string out;
  for (const DrmConnector& one : all)
    out += (out.empty() ? "" : ", ") + one.name +
           (!one.connected      ? " not connected"
            : !one.desktop      ? " is no desktop display"
            : one.modes.empty() ? " connected without a mode"
            : usable(one)       ? " connected"
                                : " connected without a pipe");
  return out.empty() ? "the card has no connectors" : out;
}

/// The pipe it is fed by already (no needless change, and the console's), else the first it can have.
DrmId choose_crtc(const DrmSnapshot& snapshot, const DrmConnector& connector, const Pipe* previous) {
  const auto& crtcs = snapshot.resources.crtcs;
  const auto possible = [&](DrmId id) {
    const auto at = static_cast<std::size_t>(std::find(crtcs.begin(), crtcs.end(), id) - crtcs.begin());
    return at < crtcs.size() && at < 32 && ((connector.possible_crtcs >> at) & 1u) != 0;
  };
  if (previous != nullptr && previous->connector.id == connector.id && possible(previous->crtc)) return previous->crtc;
  if (connector.crtc != 0 && possible(connector.crtc)) return connector.crtc;
  // One that feeds no other monitor first: taking that away would be a surprise.
  const auto taken = [&](DrmId id) {
    return std::any_of(snapshot.connectors.begin(), snapshot.connectors.end(),
                       [&](const DrmConnector& other) { return other.id != connector.id && other.crtc == id; });
  };
  for (const DrmId id : crtcs)
    if (possible(id) && !taken(id)) return id;
  const auto any = std::find_if(crtcs.begin(), crtcs.end(), possible);
  return any == crtcs.end() ? 0 : *any;
}

DrmId choose_plane(const DrmSnapshot& snapshot, DrmId crtc) {
  const auto& crtcs = snapshot.resources.crtcs;
  const auto at = static_cast<std::size_t>(std::find(crtcs.begin(), crtcs.end(), crtc) - crtcs.begin());
  if (at >= crtcs.size() || at >= 32) return 0;
  DrmId found = 0;
  for (const DrmPlane& plane : snapshot.planes) {
    if (plane.type != DrmPlaneType::primary || ((plane.possible_crtcs >> at) & 1u) == 0) continue;
    if (std::find(plane.formats.begin(), plane.formats.end(), drm_format_xrgb8888) == plane.formats.end()) continue;
    if (plane.crtc == crtc) return plane.id;  // the one the driver itself pairs with this pipe
    if (found == 0 && plane.crtc == 0) found = plane.id;
  }
  return found;
}

}  // namespace

DrmResult<DrmSnapshot> take_snapshot(KmsDevice& device) {
  DrmSnapshot out;
  auto resources = device.resources();
  if (!resources) return tl::unexpected<int>(resources.error());
  out.resources = std::move(*resources);
  out.connectors.reserve(out.resources.connectors.size());
  for (const DrmId id : out.resources.connectors) {
    auto connector = device.probe_connector(id);
    if (connector)
      out.connectors.push_back(std::move(*connector));
    else if (connector.error() != ENOENT)
      return tl::unexpected<int>(connector.error());
  }
  auto planes = device.planes();
  if (planes) out.planes = std::move(*planes);  // without: the older interface
  return out;
}

std::optional<DrmMode> choose_mode(const DrmConnector& connector, const WantedPipe& wanted,
                                   std::array<int, 2> largest_px, const std::vector<DrmMode>& refused,
                                   std::string& warning) {
  std::vector<const DrmMode*> modes;
  modes.reserve(connector.modes.size());
  for (const DrmMode& mode : connector.modes) {
    const auto [width, height] = mode.size_px();
    const bool too_large =
        (largest_px[0] > 0 && width > largest_px[0]) || (largest_px[1] > 0 && height > largest_px[1]);
    const bool bad = std::any_of(refused.begin(), refused.end(), [&](const DrmMode& r) { return r.same_signal(mode); });
    if (width > 0 && height > 0 && mode.refresh_hz() > 0.0 && !too_large && !bad) modes.push_back(&mode);
  }
  if (modes.empty()) return std::nullopt;
  // Half pictures flicker on still lines: only if there is nothing else. The order otherwise is the monitor's.
  std::stable_partition(modes.begin(), modes.end(), [](const DrmMode* mode) { return !mode->interlaced(); });

  const auto preferred = std::find_if(modes.begin(), modes.end(),
                                      [](const DrmMode* mode) { return mode->preferred && !mode->interlaced(); });
  const DrmMode* fallback = preferred == modes.end() ? modes.front() : *preferred;
  const bool any_size = wanted.mode_px[0] <= 0 || wanted.mode_px[1] <= 0;
  const std::array<int, 2> size = any_size ? fallback->size_px() : wanted.mode_px;
  const DrmMode* best = nullptr;
  for (const DrmMode* mode : modes) {
    if (mode->size_px() != size) continue;
    if (wanted.refresh_hz <= 0) {
      if (best == nullptr || (mode == fallback)) best = mode;
    } else if (std::abs(mode->refresh_hz() - wanted.refresh_hz) <= same_refresh_hz) {
      const auto off = [&](const DrmMode* m) { return std::abs(m->refresh_hz() - wanted.refresh_hz); };
      if (best == nullptr || off(mode) < off(best)) best = mode;
    }
  }
  if (best != nullptr) return *best;
  warning = connector.name + " has no mode " + size_text(size) +
            (wanted.refresh_hz > 0 ? " at " + std::to_string(wanted.refresh_hz) + " Hz" : "") + ": " +
            fallback->text() + " is used instead";
  return *fallback;
}

PipeSearch choose_pipe(const DrmSnapshot& snapshot, const WantedPipe& wanted, const Pipe* previous,
                       const std::vector<DrmMode>& refused) {
  PipeSearch out;
  const DrmConnector* connector = nullptr;
  std::string because;
  if (!wanted.connector.empty()) {
    connector = find_connector(snapshot.connectors, wanted.connector);
    because = "as configured";
    if (connector == nullptr || !usable(*connector)) {
      out.why = "waiting for a monitor at " + wanted.connector +
                (connector == nullptr ? ", which the card lacks" : "") + ": " + list(snapshot.connectors);
      return out;
    }
  } else {
    if (previous != nullptr) connector = find_connector(snapshot.connectors, previous->connector.name);
    if (connector != nullptr && usable(*connector)) {
      because = "still connected";
    } else {
      const auto first = std::find_if(snapshot.connectors.begin(), snapshot.connectors.end(), usable);
      connector = first == snapshot.connectors.end() ? nullptr : &*first;
      because = "the first connected one";
    }
    if (connector == nullptr) {
      out.why = "waiting for a monitor: " + list(snapshot.connectors);
      return out;
    }
  }
  Pipe pipe;
  pipe.connector = *connector;
  pipe.crtc = choose_crtc(snapshot, *connector, previous);
  if (pipe.crtc == 0) {
    out.why = "waiting: no pipe of the card can feed " + connector->name;
    return out;
  }
  pipe.plane = choose_plane(snapshot, pipe.crtc);
  const auto mode = choose_mode(*connector, wanted, snapshot.resources.largest_px, refused, out.warning);
  if (!mode) {
    out.why = "waiting: " + connector->name + " has no mode that the card can show";
    return out;
  }
  pipe.mode = *mode;
  out.why = connector->name + " (" + because + "), " + pipe.mode.text() +
            (pipe.mode.preferred ? ", the monitor's preferred mode" : "");
  out.pipe = std::move(pipe);
  return out;
}

Result<CardChoice> choose_card(const std::vector<CardFacts>& cards, const std::string& card,
                               const std::string& connector) {
  if (cards.empty())
    return fail("/dev/dri", "", "no card that drives a display could be opened",
                "load the graphics driver, and let the kiosk's user open /dev/dri/card* (group video)");
  const auto has = [&](const CardFacts& facts, bool connected) {
    return std::any_of(facts.connectors.begin(), facts.connectors.end(), [&](const DrmConnector& one) {
      return (connector.empty() || one.name == connector) && (!connected || usable(one));
    });
  };
  const auto found = [&](auto&& test, const char* why) -> std::optional<CardChoice> {
    const auto at = std::find_if(cards.begin(), cards.end(), test);
    if (at == cards.end()) return std::nullopt;
    return CardChoice{static_cast<std::size_t>(at - cards.begin()), at->names.front() + " (" + why + ")"};
  };
  if (!card.empty()) {
    const auto named = [&](const CardFacts& facts) {
      return std::find(facts.names.begin(), facts.names.end(), card) != facts.names.end();
    };
    if (auto choice = found(named, "as configured")) return *choice;
    std::string there;
    for (const CardFacts& facts : cards) there += (there.empty() ? "" : ", ") + facts.names.front();
    return fail(card, "card", "no such card that drives a display; there is " + there,
                "leave the card empty to take the one with a monitor");
  }
  if (auto choice = found([&](const CardFacts& facts) { return has(facts, true); }, "has a monitor")) return *choice;
  if (auto choice = found([&](const CardFacts& facts) { return has(facts, false); }, "no card has a monitor yet"))
    return *choice;
  return CardChoice{0, cards.front().names.front() + " (no card has a connector " + connector + ")"};
}

}  // namespace lackwerk::kiosk
