// Which output, by name or by trying: never silently a worse one.
#include <algorithm>
#include <array>

#include "kiosk/display/output.hpp"
#include "kiosk/display/output/fbdev_output.hpp"
#include "kiosk/display/output/headless_output.hpp"
#include "kiosk/display/output/kms_display.hpp"
#include "kiosk/display/output/kms_open.hpp"

namespace lackwerk::kiosk {
namespace {

struct PlatformName {
  Platform platform;
  const char* name;
};
constexpr std::array<PlatformName, 6> names = {{{Platform::automatic, "auto"},
                                                {Platform::kms, "kms"},
                                                {Platform::dumb, "dumb"},
                                                {Platform::fbdev, "fbdev"},
                                                {Platform::surfaceless, "surfaceless"},
                                                {Platform::osmesa, "osmesa"}}};

Result<std::unique_ptr<Output>> open_one(Platform platform, const OutputSettings& settings, Seat& seat, Log& log) {
  if (platform == Platform::kms || platform == Platform::dumb) return open_kms(platform, settings, seat, log);
  if (platform == Platform::fbdev) return open_fbdev(settings, log, &seat);
  OutputSettings headless = settings;
  headless.platform = platform;
  auto output = make_headless_output(headless, log);
  if (!output) return tl::unexpected(output.error());
  return std::move(*output);
}

}  // namespace

std::optional<Platform> platform_of(const std::string& name) {
  const auto found =
      std::find_if(names.begin(), names.end(), [&](const PlatformName& one) { return name == one.name; });
  if (found == names.end()) return std::nullopt;
  return found->platform;
}

const char* platform_name(Platform platform) {
  const auto found =
      std::find_if(names.begin(), names.end(), [&](const PlatformName& one) { return platform == one.platform; });
  return found == names.end() ? "auto" : found->name;
}

const char* output_state_name(OutputState state) {
  switch (state) {
    case OutputState::running:
      return "running";
    case OutputState::waiting_for_display:
      return "waiting_for_display";
    case OutputState::suspended:
      return "suspended";
  }
  return "unknown";
}

Result<OpenedOutput> open_output(const OutputSettings& settings, Seat& seat, Log& log) {
  const std::vector<Platform> order = settings.platform == Platform::automatic
                                          ? std::vector{Platform::kms, Platform::dumb, Platform::fbdev}
                                          : std::vector{settings.platform};
  OpenedOutput out;
  std::string reasons;
  if (order.front() == Platform::kms || order.front() == Platform::dumb) wait_for_card(log);
  for (const Platform platform : order) {
    auto output = open_one(platform, settings, seat, log);
    if (output) {
      out.output = std::move(*output);
      log.notice(std::string("output: ") + platform_name(platform) + ", drawing by " +
                 out.output->context().info().renderer +
                 (out.output->context().info().software() ? " (software)" : ""));
      return out;
    }
    // /dev/fb0 would take pictures even then, behind the other program's.
    if (order.size() == 1 || output.error().field == master_field) return tl::unexpected(output.error());
    log.warning(std::string("output: ") + platform_name(platform) + " is not possible: " + output.error().line());
    reasons += (reasons.empty() ? "" : "; ") + std::string(platform_name(platform)) + ": " + output.error().line();
    out.refused.push_back({platform, output.error()});
  }
  return fail("", "platform", "no display output works: " + reasons,
              "see each reason; without a display, use --platform surfaceless");
}

}  // namespace lackwerk::kiosk
