// What the dealer has changed on the screen, kept over restarts.
//
// Why it exists: kiosk.toml belongs to the integrator and the kiosk may not write it. One small file, dealer.json, in
// the folder systemd gives the service (StateDirectory=, /var/lib/lackwerk), stands over it. A power cut leaves the old
// file or the new one, never a half; a file that cannot be understood is said and left alone, never the end of the
// kiosk. Functions over values; one thread writes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "kiosk/display/experience_settings.hpp"

namespace lackwerk::kiosk {

inline constexpr const char* choices_file = "dealer.json";
inline constexpr std::size_t max_choices_bytes = 4096;

/// The first folder that STATE_DIRECTORY names (systemd separates them with colons); empty if it is not set: nothing is
/// kept.
[[nodiscard]] std::filesystem::path choices_folder();

/// What kiosk.toml says of the things that a dealer can change.
[[nodiscard]] DealerChoices choices_of(const ExperienceSettings& settings);
/// What counts: the settings with the dealer's choices over them.
[[nodiscard]] ExperienceSettings with_choices(ExperienceSettings settings, const DealerChoices& choices);

/// Nothing where there is no file. A key that is absent is as in `defaults`; unknown keys of a newer kiosk are passed
/// over. Error: cannot be read, too long, no JSON object, or a value that is none; nothing of such a file is used.
[[nodiscard]] Result<std::optional<DealerChoices>> read_choices(const std::filesystem::path& folder,
                                                                const DealerChoices& defaults);

/// Writes a new file and puts it in the old one's place. Error: the folder cannot be written; the old file stays.
[[nodiscard]] Result<void> write_choices(const std::filesystem::path& folder, const DealerChoices& choices);

/// As the file has it.
[[nodiscard]] std::string text_of(const DealerChoices& choices);
/// The reverse; errors as for read_choices. `file` is for them.
[[nodiscard]] Result<DealerChoices> parse_choices(const std::string& text, const std::string& file,
                                                  const DealerChoices& defaults);

}  // namespace lackwerk::kiosk
