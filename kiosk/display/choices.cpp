#include "kiosk/display/choices.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "input/touch.hpp"
#include "kiosk/display/interface_words.hpp"
#include "kiosk/display/json_fields.hpp"
#include "kiosk/display/pin_pad.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr double most_brightness = 1.0;
constexpr const char* language_key = "language";
constexpr const char* beyond_key = "beyond";
constexpr const char* motion_key = "reduced_motion";
constexpr const char* brightness_key = "brightness";
constexpr const char* calibration_key = "calibration";
constexpr const char* pin_wrong_key = "pin_wrong";
constexpr const char* pin_lock_key = "pin_lock_s";
constexpr const char* pin_until_key = "pin_locked_until_s";
/// Seconds since 1970 that a clock may say: until the year 9999.
constexpr double most_wall_s = 253'402'300'799.0;

void take(const JsonFields& fields, const char* key, ui::Language& to) {
  const std::string* word = fields.text(key);
  if (word == nullptr) return;
  const auto named = language_of(*word);
  named ? void(to = *named) : fields.refuse(key);
}

void take(const JsonFields& fields, const char* key, std::optional<input::CalibrationMatrix>& to) {
  const nlohmann::json* value = fields.find(key);
  if (value == nullptr) return;
  if (value->is_null()) return to.reset();
  input::CalibrationMatrix matrix{};
  if (!value->is_array() || value->size() != matrix.size()) return fields.refuse(key);
  for (std::size_t k = 0; k < matrix.size(); ++k) {
    if (!(*value)[k].is_number()) return fields.refuse(key);
    matrix[k] = (*value)[k].get<double>();
  }
  input::is_usable(matrix) ? void(to = matrix) : fields.refuse(key);
}

/// A descriptor that is closed.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

bool write_all(int fd, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t wrote = ::write(fd, text.data() + done, text.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return false;
    done += static_cast<std::size_t>(wrote);
  }
  return true;
}

constexpr const char* discard_remedy = "it is left out; the dealer's next choice replaces it";

}  // namespace

std::filesystem::path choices_folder() {
  const char* folders = std::getenv("STATE_DIRECTORY");
  if (folders == nullptr) return {};
  const std::string_view all = folders;
  return all.substr(0, all.find(':'));
}

DealerChoices choices_of(const ExperienceSettings& settings) {
  return {settings.language, settings.beyond_allowed, settings.reduced_motion, settings.brightness, {}, settings.pin};
}

ExperienceSettings with_choices(ExperienceSettings settings, const DealerChoices& choices) {
  settings.language = choices.language;
  settings.beyond_allowed = choices.beyond_allowed;
  settings.reduced_motion = choices.reduced_motion;
  settings.brightness = choices.brightness;
  settings.calibration = choices.calibration;
  settings.pin = choices.pin;
  return settings;
}

std::string text_of(const DealerChoices& choices) {
  nlohmann::ordered_json out{{language_key, word_of(choices.language)},
                             {beyond_key, choices.beyond_allowed},
                             {motion_key, choices.reduced_motion},
                             {brightness_key, choices.brightness},
                             {calibration_key, nullptr},
                             {pin_wrong_key, choices.pin.wrong},
                             {pin_lock_key, choices.pin.lock_s},
                             {pin_until_key, choices.pin.locked_until_s}};
  if (choices.calibration) out[calibration_key] = *choices.calibration;
  return out.dump(2) + "\n";
}

Result<DealerChoices> parse_choices(const std::string& text, const std::string& file, const DealerChoices& defaults) {
  if (text.size() > max_choices_bytes) return fail(file, "", "is too long for what it may hold", discard_remedy);
  const auto json = parse_object(text, file, discard_remedy);
  if (!json) return tl::unexpected(json.error());
  DealerChoices out = defaults;
  std::string wrong;
  const JsonFields fields(*json, wrong);
  take(fields, language_key, out.language);
  fields.take(beyond_key, out.beyond_allowed);
  fields.take(motion_key, out.reduced_motion);
  fields.take(brightness_key, out.brightness, least_brightness, most_brightness);
  take(fields, calibration_key, out.calibration);
  fields.take(pin_wrong_key, out.pin.wrong, 0, pin_attempts - 1);
  fields.take(pin_lock_key, out.pin.lock_s, 0.0, longest_lock_s);
  fields.take(pin_until_key, out.pin.locked_until_s, 0.0, most_wall_s);
  if (!wrong.empty()) return fail(file, wrong, "is not a value it can have", discard_remedy);
  return out;
}

Result<std::optional<DealerChoices>> read_choices(const std::filesystem::path& folder, const DealerChoices& defaults) {
  const std::string file = (folder / choices_file).string();
  // O_NONBLOCK: a FIFO in its place must not stop the kiosk.
  const Descriptor fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (fd.get() < 0) {
    if (errno == ENOENT) return std::optional<DealerChoices>{};
    return fail(file, "", std::string("cannot be read: ") + std::strerror(errno), discard_remedy);
  }
  std::string text(max_choices_bytes + 1, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t got = ::read(fd.get(), text.data() + size, text.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fail(file, "", std::string("cannot be read: ") + std::strerror(errno), discard_remedy);
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  text.resize(size);
  auto choices = parse_choices(text, file, defaults);
  if (!choices) return tl::unexpected(std::move(choices.error()));
  return std::optional(*choices);
}

Result<void> write_choices(const std::filesystem::path& folder, const DealerChoices& choices) {
  const std::string file = (folder / choices_file).string();
  const std::string fresh = file + ".new";
  const auto failed = [&](const char* step) {
    const std::string why = std::strerror(errno);
    ::unlink(fresh.c_str());
    return fail(file, "", std::string(step) + ": " + why, "make the folder writable for the kiosk's user");
  };
  {
    const Descriptor fd(::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644));
    if (fd.get() < 0) return failed("cannot be written");
    if (!write_all(fd.get(), text_of(choices)) || ::fsync(fd.get()) != 0) return failed("cannot be written");
  }
  if (::rename(fresh.c_str(), file.c_str()) != 0) return failed("cannot be replaced");
  // The new name is on the disk only when the folder is.
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.get() < 0 || ::fsync(directory.get()) != 0)
    return fail(file, "", std::string("is written, but its folder cannot be synced: ") + std::strerror(errno),
                "check the file system");
  return {};
}

}  // namespace lackwerk::kiosk
