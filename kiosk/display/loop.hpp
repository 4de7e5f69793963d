// Runs the kiosk: live on a panel, or as a recording on a virtual clock.
//
// Why it exists: it opens what the options name in the right order, waits for the world (poll), and takes everything
// down again. The only state a signal handler may touch is here. One thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "input/script.hpp"
#include "kiosk/display/interface.hpp"
#include "kiosk/display/options.hpp"
#include "kiosk/display/picture.hpp"

namespace lackwerk::kiosk {

struct RunSummary {
  std::uint64_t frames = 0;          ///< times the loop went round
  std::uint64_t drawn = 0;           ///< frames that were drawn, because something had changed
  std::uint64_t refined = 0;         ///< frames that improved a picture that did not change
  std::uint64_t presented = 0;       ///< pictures that reached the panel; 0 in recordings
  std::string quality;               ///< the rung moving pictures were last drawn on
  std::uint64_t uploaded_bytes = 0;  ///< paint textures sent
  double drawn_ms_median = 0.0;      ///< realise + upload + draw + finish, of the last drawn frames
  double realise_ms_median = 0.0;    ///< realise + upload, of the last frames whose weights had changed
};

/// Runs until the frames are done, the script has ended, or a signal asked to stop.
[[nodiscard]] Result<RunSummary> run(const Options& options);

/// Asks a running loop to end; safe in a signal handler.
void request_stop() noexcept;
[[nodiscard]] bool stop_asked() noexcept;

struct OpenedScript {
  std::optional<input::ScriptPlayer> player;  ///< nothing if none is named
  /// It begins by setting values (weights, orbit, ...): nobody would see the attract screen go. One that begins with a
  /// finger or a knob starts as the kiosk does.
  bool visit = false;
};
/// The script of the options, from the state's weights.
[[nodiscard]] Result<OpenedScript> open_script(const Options& options, const State& state);
/// The interface of the options, with what the dealer has chosen over them.
[[nodiscard]] Result<std::unique_ptr<Interface>> open_interface(const Options& options, Stage& stage, bool vouched,
                                                                Log& log);
/// Fills in what stage and picture know, and writes the screenshot if one is asked for.
[[nodiscard]] Result<RunSummary> summarise(const Options& options, Stage& stage, Picture& picture, Interface& interface,
                                           RunSummary summary);

}  // namespace lackwerk::kiosk
