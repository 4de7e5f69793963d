#include "kiosk/display/output/kms_open.hpp"

#include <poll.h>

#include <algorithm>
#include <filesystem>

#include "kiosk/display/output/kms_dumb.hpp"
#include "kiosk/display/output/kms_gbm.hpp"
#include "kiosk/display/output/kms_output.hpp"

namespace lackwerk::kiosk {
namespace {

namespace fs = std::filesystem;

constexpr const char* folder = "/dev/dri";
constexpr std::size_t most_cards = 16;
constexpr int look_every_ms = 100;

/// Every name of every card, the node first: "/dev/dri/card1", "/dev/dri/by-path/pci-0000:01:00.0-card".
std::vector<std::vector<std::string>> card_names() {
  std::vector<std::vector<std::string>> out;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code))
    if (entry.path().filename().string().rfind("card", 0) == 0 && out.size() < most_cards)
      out.push_back({entry.path().string()});
  std::sort(out.begin(), out.end());
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(folder) / "by-path", code)) {
    std::error_code broken;
    const std::string node = fs::canonical(entry.path(), broken).string();
    for (std::vector<std::string>& names : out)
      if (!broken && names.front() == node) names.push_back(entry.path().string());
  }
  return out;
}

struct OpenCard {
  SeatDevice opened;
  std::unique_ptr<KmsDevice> device;
};

/// The card that the settings mean, open; the others are closed again.
Result<OpenCard> open_card(const OutputSettings& settings, Seat& seat, Log& log) {
  std::vector<OpenCard> cards;
  std::vector<CardFacts> facts;
  std::string problems;
  const auto problem = [&](const std::string& what) { problems += (problems.empty() ? "" : "; ") + what; };
  for (std::vector<std::string>& names : card_names()) {
    const std::string path = names.front();
    const auto fd = seat.open_device(path);
    if (!fd) {
      problem(fd.error().line());
      continue;
    }
    OpenCard card{SeatDevice(seat, *fd), nullptr};
    auto device = open_kms_device(*fd, path);
    if (!device) {
      problem(device.error().line());
      continue;
    }
    card.device = std::move(*device);
    auto snapshot = take_snapshot(*card.device);
    if (!snapshot) {
      problem(path + ": cannot read the connectors: " + errno_text(snapshot.error()));
      continue;
    }
    names.push_back(card.device->card().driver);
    facts.push_back({std::move(names), std::move(snapshot->connectors)});
    cards.push_back(std::move(card));
  }
  auto choice = choose_card(facts, settings.card, settings.connector);
  if (!choice) {
    Error error = choice.error();
    if (!problems.empty()) error.what += ": " + problems;
    return tl::unexpected(error);
  }
  OpenCard& card = cards[choice->index];
  log.info("card: " + choice->why + ", driver " + card.device->card().driver +
           (card.device->card().atomic ? ", atomic" : ", without atomic commits"));
  return std::move(card);
}

}  // namespace

void wait_for_card(Log& log) {
  if (!card_names().empty()) return;
  log.info("no graphics card yet, waiting for one");
  for (int waited = 0; card_names().empty() && waited < card_wait_ms; waited += look_every_ms)
    poll(nullptr, 0, look_every_ms);
}

Result<std::unique_ptr<Output>> open_kms(Platform platform, const OutputSettings& settings, Seat& seat, Log& log) {
  auto card = open_card(settings, seat, log);
  if (!card) return tl::unexpected(card.error());
  KmsParts parts;
  parts.seat = &seat;
  parts.opened = std::move(card->opened);
  parts.device = std::move(card->device);
  auto surface = platform == Platform::kms ? make_gbm_surface(*parts.device, settings.context)
                                           : make_dumb_surface(*parts.device, settings.context, log);
  if (!surface) return tl::unexpected(surface.error());
  parts.surface = std::move(*surface);
  auto hotplug = input::watch_devices({"drm"});
  if (hotplug)
    parts.hotplug = std::move(*hotplug);
  else
    log.error(hotplug.error());  // monitors are then found by looking now and then
  auto output = std::make_unique<KmsOutput>(std::move(parts), settings, log);
  if (auto started = output->start(); !started) return tl::unexpected(started.error());
  return output;
}

}  // namespace lackwerk::kiosk
