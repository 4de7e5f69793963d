// What a commit says: the properties that make a pipe show a framebuffer, flip, sleep or end.
//
// Why it exists: an atomic commit is a list of numbers, and a forgotten one shows up as another program's gamma table
// or a left-over plane over the picture. Built here from values and tested as such. Pure but for the reading; any
// thread.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "kiosk/display/output/connector_choice.hpp"

namespace lackwerk::kiosk {

struct PipeProperties {
  using Names = std::map<std::string, DrmProperty>;
  Names connector, crtc, plane;
  std::vector<DrmSetting> others_off;  ///< planes and connectors another program left on this pipe

  /// Whether atomic commits can say all that is needed.
  [[nodiscard]] bool atomic() const;
};

[[nodiscard]] DrmResult<PipeProperties> read_properties(KmsDevice& device, const Pipe& pipe,
                                                        const DrmSnapshot& snapshot);

/// Everything: mode, route, plane, and plain colour (no gamma tables, no rotation of the engine's).
[[nodiscard]] std::vector<DrmSetting> full_state(const Pipe& pipe, const PipeProperties& properties, DrmId framebuffer,
                                                 DrmId mode_blob);
/// Another picture, nothing else.
[[nodiscard]] std::vector<DrmSetting> flip_state(const Pipe& pipe, const PipeProperties& properties, DrmId framebuffer);
/// The panel sleeps; everything else stays set.
[[nodiscard]] std::vector<DrmSetting> sleep_state(const Pipe& pipe, const PipeProperties& properties);
/// The pipe is free again.
[[nodiscard]] std::vector<DrmSetting> off_state(const Pipe& pipe, const PipeProperties& properties);

}  // namespace lackwerk::kiosk
